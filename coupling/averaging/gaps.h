// Points without a value, by name.
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>

namespace grainfield::coupling {

/// Points where an average is nan, gathered over one or several snapshots on the same points.
struct Gaps {
  /// Index of the point -> least number of grains found in its support there.
  std::map<Eigen::Index, double> few_grains;
  /// Index of the point -> 1: less than a tenth of its support is inside the packing.
  std::map<Eigen::Index, double> outside;
  Eigen::Index points = 0;  ///< all of them
  int least_grains = 0;

  void add(const Gaps& other);
  /// "3 of 120 points within the packing have fewer than 3 grains in the averaging volume and are
  /// nan: (0, 0.1) with 1, ...; a larger width takes in more"; the first three are named. Points
  /// without any grain are counted by themselves. `at`: the coordinates to print. Empty without
  /// gaps.
  std::string text(const Eigen::MatrixXd& at) const;
};

}  // namespace grainfield::coupling
