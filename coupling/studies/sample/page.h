// The report of a sample under compression and shear.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "coupling/judge/judgement.h"
#include "coupling/report/report.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Curves of one ensemble against the imposed strain, with bands of one standard error.
struct SampleCurve {
  std::string title;  ///< quantity with its unit: "q/p", "p (Pa)"
  Eigen::VectorXd mean, error;
};

struct SampleReport {
  std::string title, subtitle;
  Judgement judgement;
  std::string strain_name;  ///< "shear strain", "axial strain"
  std::string label;        ///< of the curves: "grains, mean of 4"
  Eigen::VectorXd strain;
  std::vector<SampleCurve> main;      ///< q/p, volumetric strain, p, contacts
  std::vector<SampleCurve> stresses;  ///< in one frame
  std::string stress_unit;
  std::vector<SampleCurve> structure;  ///< coordination, fabric: a frame each
  std::vector<SampleCurve> energies;   ///< in one frame, J
  /// States of the realization that is drawn; may be null.
  const dem::Snapshot *first = nullptr, *last = nullptr;
  std::vector<Section> rves;    ///< pictures of RVEs (rve_page.h); may be empty
  std::vector<Section> moduli;  ///< table of small strains (moduli.h); may be empty
  ReportRows figures, made;
};

Report sample_report(const SampleReport& input);

/// One curve of the ensemble, as a series named `label`.
Series sample_series(const SampleReport& input, const SampleCurve& curve, const std::string& label,
                     bool simulation);

}  // namespace grainfield::coupling
