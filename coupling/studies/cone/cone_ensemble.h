// An ensemble of cones, averaged in scaled coordinates.
#pragma once
#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "coupling/averaging/cone.h"
#include "coupling/case/case.h"
#include "coupling/observe/method_averages.h"
#include "coupling/observe/seen_models.h"
#include "coupling/run/realization_file.h"
#include "coupling/specimen/dip.h"

namespace grainfield::coupling {

/// (r, 0, z) of radii and heights, n x 2.
Eigen::MatrixXd rings_in_space(const Eigen::MatrixXd& rings);

/// Every method's lines are rings at each of heap.heights, its map is inside. Points are scaled
/// (averaging/cone.h), stresses in units of each cone's rho g h.
struct ConeEnsemble {
  /// Measures every cone; adds nothing yet. Throws std::invalid_argument for cones of heights that
  /// do not belong together, or a file without a snapshot "pile".
  ConeEnsemble(const Case& value, const std::vector<std::string>& files, int threads);
  /// Adds the realizations in order.
  void collect();
  /// Mean over realizations.
  double mean(double ConeFrame::*member) const;
  /// Height of the models' cone over h: its flanks are the grains' own, and its apex is above a
  /// round one.
  double spanned() const;
  /// Scaled radii and heights (n x 2) at this share of the height above the floor.
  Eigen::MatrixXd rings_at(double share) const;
  /// The mean in Pa on points in m, in the heap's frame, with what `grainfield compare` needs.
  Field in_metres(const Ensemble& ensemble, const AverageOptions& options) const;
  /// On the base and at heap.heights, in Pa and m.
  std::vector<ObservedLine> lines() const;
  /// What to mind of them: a kernel that is wide against the height, grains that left the floor.
  std::vector<std::string> warnings() const;

  const Case& value;
  const std::vector<std::string>& files;
  std::vector<ConeFrame> frames;
  double height = 0, pressure = 0;  ///< means of h, m, and of rho g h, Pa
  Eigen::VectorXd radii;            ///< scaled, from 0
  Eigen::MatrixXd square, inside;   ///< scaled grids: of the base; of radius and height
  int columns = 0, rows = 0;
  std::vector<MethodAverages> methods;
  Ensemble base, base_rings;  ///< on the square; by radius: pressure and radial shear
  std::vector<BaseWindows> windows;
  /// Figures of runs and analysis by summary key, one value per realization.
  std::map<std::string, std::vector<double>> figures;
  std::shared_ptr<const Kernel> kernel;  ///< of the first method

 private:
  void add(const Realization& realization, const ConeFrame& frame);
  /// Returns the force within the rings, N.
  double add_base(const dem::Snapshot& cone, const ConeFrame& frame);
};

}  // namespace grainfield::coupling
