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
  /// "3 of 120 points have fewer than 3 grains in the averaging volume and are nan: (0, 0.1)
  /// with 1, ...; take a larger width"; the first three are named. `at`: the coordinates to print.
  /// Empty without gaps.
  std::string text(const Eigen::MatrixXd& at) const;
};

}  // namespace grainfield::coupling
