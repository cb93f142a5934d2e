// An ensemble of piles, averaged in scaled coordinates.
#pragma once
#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "coupling/averaging/average.h"
#include "coupling/averaging/ensemble.h"
#include "coupling/averaging/kernel.h"
#include "coupling/case/case.h"
#include "coupling/heap/dip.h"
#include "coupling/heap/pile_frame.h"
#include "coupling/run/realization_file.h"

namespace grainfield::coupling {

/// One averaging method over the ensemble. Points are scaled (pile_frame.h), stresses in units of
/// each pile's rho g h.
struct PileAverages {
  std::string method;
  AverageOptions options;
  Ensemble base;               ///< on the floor
  std::vector<Ensemble> cuts;  ///< one per heap.heights
  Ensemble map;
  double balance_rms = 0, balance_largest = 0;
};

class PileEnsemble {
 public:
  /// Measures every pile; adds nothing yet. Throws std::invalid_argument for a file without a
  /// snapshot "pile".
  PileEnsemble(const Case& value, const std::vector<std::string>& files, int threads);
  /// Adds the realizations in order.
  void collect();

  /// Means over realizations.
  double height() const { return height_; }      ///< h, m
  double pressure() const { return pressure_; }  ///< rho g h, N/m
  double mean(double PileFrame::*member) const;

  const std::vector<PileFrame>& frames() const { return frames_; }
  const Eigen::VectorXd& x() const { return x_; }  ///< scaled abscissas of profiles
  const Eigen::MatrixXd& grid() const { return grid_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  const Kernel& kernel() const { return *kernel_; }  ///< of the first method
  const std::vector<PileAverages>& methods() const { return methods_; }
  const Ensemble& base() const { return base_; }  ///< forces on the floor, smeared along x
  const std::vector<BaseWindows>& windows() const { return windows_; }
  /// Figures of the runs and of the analysis by summary key, one value per realization.
  const std::map<std::string, std::vector<double>>& figures() const { return figures_; }
  /// Points of the base, or of the cut at a height above it, scaled.
  Eigen::MatrixXd line(double height_share) const;

 private:
  void add(const Realization& realization, const PileFrame& frame);
  void add_change(const std::string& name, const dem::Snapshot& pile, const dem::Snapshot& changed,
                  const PileFrame& frame);

  const Case& value_;
  const std::vector<std::string>& files_;
  std::vector<PileFrame> frames_;
  double height_ = 0, pressure_ = 0;
  Eigen::VectorXd x_;
  Eigen::MatrixXd grid_;
  int columns_ = 0, rows_ = 0;
  std::unique_ptr<Kernel> kernel_;
  std::vector<PileAverages> methods_;
  Ensemble base_;
  std::vector<BaseWindows> windows_;
  std::map<std::string, std::vector<double>> figures_;
};

/// Mean number of contacts of a free grain; one with the floor counts once.
double coordination(const dem::Snapshot& snapshot);

}  // namespace grainfield::coupling
