// Measured fields on a regular grid, for the coefficients of a heap or a layer.
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "continuum/osl/problem.h"

namespace grainfield::continuum::osl {

/// Node ix + nx * iy at (x0 + ix dx, y0 + iy dy), the project's axes: y up, a heap's apex or a
/// layer's load at (0, 0).
struct FieldMap {
  std::string file;
  double x0 = 0, y0 = 0, dx = 0, dy = 0;          ///< m
  int nx = 0, ny = 0;                             ///< at least 2 each
  std::map<std::string, Eigen::VectorXd> values;  ///< by name, e.g. rho_g, eta, mu

  /// Bilinear between the nodes; beyond the grid as on its border.
  double at(const std::string& name, double x, double y) const;
  /// The named field as the solvers take it, or `otherwise` everywhere when the map lacks it.
  Field field(const std::string& name, double otherwise) const;
  /// Throws BadParameter when the grid does not cover |x| <= half_width, -depth <= y <= 0.
  void require_cover(const std::string& model, double half_width, double depth) const;
};

/// CSV: comment lines (#), header x,y and one or more of rho_g, eta, mu in any order, one line per
/// node, x ascending fastest. Throws BadParameter "FILE:LINE: ..." for a missing file, another
/// header, numbers that are not finite, nodes that form no regular grid. An empty name: no fields.
FieldMap read_field_map(const std::string& file);
/// The same with these columns instead. `may_lack`: a value (not a place) may be nan.
FieldMap read_field_map(const std::string& file, const std::vector<std::string>& fields,
                        bool may_lack);

/// Names after x,y in the header of such a file; none for an empty name and for a file that cannot
/// be opened, which read_field_map refuses.
std::vector<std::string> map_columns(const std::string& file);

}  // namespace grainfield::continuum::osl
