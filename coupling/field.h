// Values on points, with their spread: what averaging, models and comparison exchange.
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

namespace grainfield::coupling {

/// One scalar quantity on the points of a Field, e.g. "sigma_yy".
struct Column {
  std::string name;
  std::string unit;         ///< "N/m", "1", ...
  Eigen::VectorXd value;    ///< mean over realizations; nan where there is none
  Eigen::VectorXd error;    ///< standard error of the mean; nan with one realization; may be empty
  Eigen::MatrixXd samples;  ///< points x realizations: the single values; empty: not kept
};

/// The components of stress in the plane, in the order of tables.
inline const std::vector<std::string> kPlaneStress{"sigma_xx", "sigma_yy", "sigma_xy"};
/// The same in space, in the order of the models.
inline const std::vector<std::string> kSpaceStress{"sigma_xx", "sigma_yy", "sigma_zz",
                                                   "sigma_yz", "sigma_xz", "sigma_xy"};

/// Points with columns. A regular grid also knows its shape, so that it can be drawn as a map.
struct Field {
  Eigen::MatrixXd points;  ///< n x dim, m
  /// Grid: points[ix + nx * (iy + ny * iz)]; 0 = scattered points. nz: 0 in the plane.
  int nx = 0, ny = 0, nz = 0;
  int realizations = 1;
  std::vector<Column> columns;
  std::map<std::string, std::string> attributes;  ///< what, kernel, width, units, versions

  const Column* find(const std::string& name) const;
  Column& add(const std::string& name, const std::string& unit);
  /// Of import-field, not of grains.
  bool is_measured() const;
};

}  // namespace grainfield::coupling
