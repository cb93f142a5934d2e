// An ensemble of cones, averaged in scaled coordinates.
#pragma once
#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "coupling/averaging/cone.h"
#include "coupling/averaging/ensemble.h"
#include "coupling/averaging/kernel.h"
#include "coupling/averaging/options.h"
#include "coupling/case/case.h"
#include "coupling/compare/compare.h"
#include "coupling/heap/dip.h"
#include "coupling/run/realization_file.h"

namespace grainfield::coupling {

/// One averaging method over the ensemble: by radius at each of heap.heights, and inside. Points
/// are scaled (averaging/cone.h), stresses in units of each cone's rho g h.
struct ConeAverages {
  std::string method;
  AverageOptions options;
  std::vector<Ensemble> cuts;
  Ensemble inside;
  double balance_rms = 0, balance_largest = 0;
};

/// (r, 0, z) of radii and heights, n x 2.
Eigen::MatrixXd rings_in_space(const Eigen::MatrixXd& rings);

class ConeEnsemble {
 public:
  /// Measures every cone; adds nothing yet. Throws std::invalid_argument for cones of heights that
  /// do not belong together, or a file without a snapshot "pile".
  ConeEnsemble(const Case& value, const std::vector<std::string>& files, int threads);
  /// Adds the realizations in order.
  void collect();

  /// Means over realizations.
  double height() const { return height_; }      ///< h, m
  double pressure() const { return pressure_; }  ///< rho g h, Pa
  double mean(double ConeFrame::*member) const;
  /// Height of the models' cone over h: its flanks are the grains' own, and its apex is above a
  /// round one.
  double spanned() const;

  const Eigen::VectorXd& radii() const { return radii_; }    ///< scaled, from 0
  const Eigen::MatrixXd& inside() const { return inside_; }  ///< scaled radii and heights, a grid
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  const Kernel& kernel() const { return *kernel_; }  ///< of the first method
  const std::vector<ConeAverages>& methods() const { return methods_; }
  const Ensemble& base() const { return base_; }              ///< on a square grid
  const Ensemble& base_rings() const { return base_rings_; }  ///< pressure and radial shear
  const std::vector<BaseWindows>& windows() const { return windows_; }
  /// Figures of the runs and of the analysis by summary key, one value per realization.
  const std::map<std::string, std::vector<double>>& figures() const { return figures_; }

  /// Scaled radii and heights (n x 2) at this share of the height above the floor.
  Eigen::MatrixXd rings_at(double share) const;
  /// The mean in Pa on points in m, in the heap's frame, with what `grainfield compare` needs.
  Field in_metres(const Ensemble& ensemble, const AverageOptions& options) const;
  /// On the base and at heap.heights, in Pa and m.
  std::vector<Profile> profiles() const;
  /// What to mind of them: a kernel that is wide against the height, grains that left the floor.
  std::vector<std::string> warnings() const;

 private:
  void add(const Realization& realization, const ConeFrame& frame);
  /// Returns the force within the rings, N.
  double add_base(const dem::Snapshot& cone, const ConeFrame& frame);
  Profile profile(const Ensemble& ensemble, const std::string& name, const std::string& key,
                  double share) const;

  const Case& value_;
  const std::vector<std::string>& files_;
  std::vector<ConeFrame> frames_;
  double height_ = 0, pressure_ = 0;
  Eigen::VectorXd radii_;            // over h
  Eigen::MatrixXd square_, inside_;  // over h: of the base; radius and height
  int columns_ = 0, rows_ = 0;
  std::vector<ConeAverages> methods_;
  Ensemble base_, base_rings_;
  std::vector<BaseWindows> windows_;
  std::map<std::string, std::vector<double>> figures_;
  std::unique_ptr<Kernel> kernel_;
};

}  // namespace grainfield::coupling
