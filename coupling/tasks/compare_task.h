// Averaged fields from a file against continuum models.
#pragma once
#include <string>
#include <vector>

#include "coupling/compare/compare.h"
#include "coupling/observe/field_observations.h"
#include "coupling/result/tables.h"
#include "coupling/store/field_io.h"

namespace grainfield::coupling {

struct CompareRequest {
  std::string file;                 ///< of write_fields
  NamedFields held{};               ///< instead: fields in memory; `file` only names them
  std::vector<std::string> fields;  ///< empty: see run_compare
  std::vector<std::string> models;  ///< as of parse_choices
  LineOptions lines;
  std::string folder;  ///< of the outputs, made where missing; empty: nothing is written
};

struct CompareOutcome {
  Comparison comparison;  ///< profiles, models and judgement
  Summary summary;
  std::string lacks;                 ///< of the report (ReportResult::complaint)
  std::vector<std::string> carried;  ///< share_text() of what was measured, by field
  std::string gone;                  ///< earlier results that are gone (gone_note); empty: none
  bool measured = false;             ///< the field is of no grains (Field::is_measured)
};

/// Compares any models of the registry with any field whose origin is known: responses to a load
/// (facts F, h), heaps (rho_g, phi_deg, left_deg, right_deg, h) and layers (h). Without `fields`:
/// the lines of the file's responses, or a map's rows; in a file without responses the lines of the
/// first heap average, or its map; else the first field. Models are seen through each field's own
/// kernel: lines whose name starts with "base" along x, others in the plane. Writes profiles.*,
/// summary.json and report.html into the folder. Throws std::invalid_argument for fields of
/// different scenes, loads or sizes together, missing attributes, and what models throw.
CompareOutcome run_compare(const CompareRequest& request);

}  // namespace grainfield::coupling
