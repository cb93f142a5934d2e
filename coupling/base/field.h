// Values on points, with their spread: what averaging, models and comparison exchange.
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <variant>
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

/// What is known of a field: a text, a number, or one number per realization.
using Attribute = std::variant<std::string, double, std::vector<double>>;
using Attributes = std::map<std::string, Attribute>;
/// For people: "lucy", "0.3", "31.2,30.7".
std::string attribute_text(const Attribute& attribute);

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
  /// Their names and units: docs/file-formats.md.
  Attributes attributes;

  const Column* find(const std::string& name) const;
  Column& add(const std::string& name, const std::string& unit);
  bool has(const std::string& attribute) const { return attributes.count(attribute) > 0; }
  /// An attribute that is a text; empty: there is none.
  std::string word(const std::string& attribute) const;
  /// An attribute that is a number, the mean of one per realization; nan: there is none.
  double number(const std::string& attribute) const;
  /// Whether import-field made it, not grains.
  bool is_measured() const { return word("method") == "measured"; }
  /// In the frame of heaps, apex at the origin; its lengths may be over the height.
  bool is_of_heap() const { return word("frame") == "heap"; }
  bool is_over_height() const { return is_of_heap() && word("lengths") != "m"; }
  /// Its points are radius and height of rings about the frame's axis.
  bool is_of_rings() const { return has("rings"); }
};

}  // namespace grainfield::coupling
