// The report of a lattice pile: forces of the base disks beside the closed forms.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupling/compare/compare.h"
#include "coupling/report/report.h"
#include "coupling/result/figure.h"
#include "coupling/run/measured_base.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

struct LatticePileReport {
  std::string title, subtitle;
  const dem::Snapshot* pile = nullptr;  ///< of the first realization; may be null
  Comparison comparison;                ///< profiles "base" (N/spacing), "base_shear" (H/spacing)
  double weight = 0;                    ///< m g of a disk, N
  double width = 0;                     ///< base B, m
  double spacing = 0;                   ///< of the base disks, m
  std::optional<Picture> beside;        ///< the measurement and the grains
  ReportRows figures, made;
};

/// Frames of N and H in units of m g over x/B, grains and models.
std::vector<Frame> base_frames(const Comparison& comparison, double weight, double width,
                               double spacing, const std::string& title);

Report lattice_pile_report(const LatticePileReport& input);

/// N down and H to the right on every base disk, N.
struct BaseForces {
  Eigen::VectorXd normal, horizontal;
};

/// A lattice pile as all realizations together tell it.
struct LatticeFacts {
  int rows = 0, base_grains = 0;
  double weight = 0;          ///< of a disk, N
  double stiffness = 0;       ///< times the diameter, N
  BaseForces grains;          ///< means over the realizations
  BaseForces lattice, lines;  ///< by the closed form of hard disks, and by the line model
  BaseProfile profile, line_profile;

  bool pushes_sideways() const { return grains.horizontal.cwiseAbs().maxCoeff() > 0; }
};

/// Their rows in summary.json; those without a function are means of add_samples.
const std::vector<RunFigure<LatticeFacts>>& lattice_rows();

}  // namespace grainfield::coupling
