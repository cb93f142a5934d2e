// An ensemble of piles, averaged in scaled coordinates.
#pragma once
#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "coupling/case/case.h"
#include "coupling/observe/method_averages.h"
#include "coupling/run/realization_file.h"
#include "coupling/specimen/dip.h"
#include "coupling/specimen/pile_frame.h"

namespace grainfield::coupling {

/// Every method's lines lie on the floor and at heap.heights. Points are scaled (pile_frame.h),
/// stresses in units of each pile's rho g h.
struct PileEnsemble {
  /// Measures every pile; adds nothing yet. Throws std::invalid_argument for a file without a
  /// snapshot "pile".
  PileEnsemble(const Case& value, const std::vector<std::string>& files, int threads);
  /// Adds the realizations in order.
  void collect();
  /// Mean over realizations.
  double mean(double PileFrame::*member) const;
  /// Height of a method's line, a share of the pile's: the floor's, then heap.heights.
  double share(std::size_t line) const;

  const Case& value;
  const std::vector<std::string>& files;
  std::vector<PileFrame> frames;
  double height = 0, pressure = 0;  ///< means of h, m, and of rho g h, N/m
  Eigen::VectorXd x;                ///< scaled abscissas of profiles
  Eigen::MatrixXd grid;
  int columns = 0, rows = 0;
  std::shared_ptr<const Kernel> kernel;  ///< of the first method
  std::vector<MethodAverages> methods;
  Ensemble base;  ///< forces on the floor, smeared along x
  std::vector<BaseWindows> windows;
  /// Figures of runs and analysis by summary key, one value per realization.
  std::map<std::string, std::vector<double>> figures;

 private:
  Eigen::MatrixXd line(double height_share) const;
  void add(const Realization& realization, const PileFrame& frame);
  void add_change(const std::string& name, const dem::Snapshot& pile, const dem::Snapshot& changed,
                  const PileFrame& frame);
};

/// Mean number of contacts of a free grain; one with the floor counts once.
double coordination(const dem::Snapshot& snapshot);

}  // namespace grainfield::coupling
