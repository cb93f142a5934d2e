// Elastic constants of the plane that vary from place to place, as measured on grains.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>

#include "continuum/closed/orthotropic.h"
#include "continuum/osl/field_map.h"

namespace grainfield::continuum {

/// Orthotropic stiffness with vertical and horizontal axes on a regular grid.
class ElasticField {
 public:
  /// Stress xx, yy, xy of strains xx, yy, 2 xy at a point (y up), positive definite everywhere: its
  /// components are bilinear between the nodes, and beyond the grid as on its border.
  Eigen::Matrix3d at(double x, double y) const;
  /// The moduli of at().
  PlaneModuli moduli(double x, double y) const;

 private:
  friend ElasticField read_elastic_field(const std::string& file);
  osl::FieldMap map_;  // c11, c22, c12, c66
};

/// CSV as `elastic_map.csv` of a study of elastic constants: comment lines (#), a header x,y and
/// either young,poisson (isotropic, plane strain) or E_x,E_y,nu_xy,G (PlaneModuli), in any order;
/// young_error,poisson_error are read and not used. One line per node, x ascending fastest; SI
/// units. A node without values (nan) takes those of the nearest node that has them. Throws
/// BadParameter "FILE:LINE: ..." as osl::read_field_map, and "FILE: ..." for constants of no stable
/// material and for a map without any.
ElasticField read_elastic_field(const std::string& file);

}  // namespace grainfield::continuum
