// `grainfield fit`: snapshots or averaged fields from files, fitted and written.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coupling/base/field.h"
#include "coupling/case/case.h"
#include "coupling/compare/compare.h"
#include "coupling/fit/ensemble_fit.h"
#include "coupling/observe/setup.h"
#include "coupling/result/tables.h"
#include "coupling/tasks/average_task.h"

namespace grainfield::coupling {

struct FitRequest {
  std::vector<std::string> inputs;  ///< FILE.h5, FILE.h5:GROUP (snapshots) or FILE.h5:FIELD
  std::vector<SnapshotName> heaps;  ///< instead of inputs: snapshots in memory; or
  std::optional<Field> field{};     ///< one field in memory
  std::string case_file;            ///< or a shipped case: its [fit] counts; empty: the defaults
  Overrides overrides;              ///< "fit.heights=[0.2]"
  std::vector<std::string> models;  ///< these four choose keys of [fit]; empty: nothing is chosen
  std::vector<double> heights;
  std::vector<std::string> components;
  std::optional<double> width_diameters{};
  std::string folder;  ///< of the outputs, made where missing; empty: nothing is written
  int threads = 1;
  std::vector<int> coverage;  ///< realizations to draw, coverage.h; empty: that is not done
  int draws = 100;
};

/// What was fitted, for people.
struct FitOutcome {
  std::vector<std::string> packings;  ///< names of the heaps, or of the field
  std::string note;                   ///< weights and what is missing for better ones
  std::vector<std::string> warnings;  ///< what makes the constants doubtful: also judgement.doubts
  std::string constants;              ///< a table: model, constant, value with error, unit
  std::string lacks;                  ///< of the report (ReportResult::complaint)
  Comparison comparison;              ///< profiles and judgement
  Summary summary;
  std::shared_ptr<const EnsembleFits> fits;
  std::string coverage;   ///< tables; empty: not asked for
  std::string carried;    ///< share_text() of what was measured; empty: grains, or not known
  std::string gone;       ///< earlier results that are gone (gone_note); empty: none
  bool measured = false;  ///< the field is of no grains (Field::is_measured)
};

/// Fits the models to the heaps and writes fits.csv/.md/.tex, profiles.csv/.md/.tex, fit.toml (the
/// settings, every default spelled out), report.html and summary.json into the folder, and
/// coverage.md where asked for.
/// Fits, of a file without group, its snapshots named "pile" where there are such, else all; or its
/// field of a heap. Throws std::invalid_argument for inputs that are neither or of both kinds,
/// several time steps of one packing, and what reading, averaging and fitting throw.
FitOutcome run_fit(const FitRequest& request);

}  // namespace grainfield::coupling
