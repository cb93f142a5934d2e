// The report of a lattice pile: forces of the base disks beside the closed forms.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupling/compare/compare.h"
#include "coupling/report/report.h"
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

}  // namespace grainfield::coupling
