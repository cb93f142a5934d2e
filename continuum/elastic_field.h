// Elastic constants of the plane that vary from place to place, as measured on grains.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "continuum/closed/orthotropic.h"
#include "continuum/model.h"
#include "continuum/osl/field_map.h"

namespace grainfield::continuum {

/// Share of either half of a body for which a map must have constants of its own. Averages over
/// 100 grains of a pile of 2000 leave out some 60 % of it, along its borders.
inline constexpr double kLeastCover = 0.25;

/// Orthotropic stiffness with vertical and horizontal axes on a regular grid.
class ElasticField {
 public:
  /// Stress xx, yy, xy of strains xx, yy, 2 xy at a point (y up), positive definite everywhere: its
  /// components are bilinear between the nodes, and beyond the grid as on its border.
  Eigen::Matrix3d at(double x, double y) const;
  /// The moduli of at().
  PlaneModuli moduli(double x, double y) const;
  /// Share of a body that the map has constants of its own for: of these points, which stand for
  /// equal parts of it, those inside the grid whose nearest node is not filled in. Throws
  /// BadParameter naming the model, the body ("heap") and the remedy where it is below kLeastCover
  /// on either side of x = 0.
  double require_cover(const std::string& model, const std::string& body, const Points& points,
                       const std::string& remedy) const;

 private:
  friend ElasticField read_elastic_field(const std::string& file);
  osl::FieldMap map_;        // c11, c22, c12, c66
  std::vector<bool> known_;  // of the nodes; the others are filled in
};

/// CSV as `elastic_map.csv` of a study of elastic constants: comment lines (#), a header x,y and
/// either young,poisson (isotropic, plane strain) or E_x,E_y,nu_xy,G (PlaneModuli), in any order;
/// young_error,poisson_error are read and not used. One line per node, x ascending fastest; SI
/// units. A node without values (nan) takes those of the nearest node that has them. Throws
/// BadParameter "FILE:LINE: ..." as osl::read_field_map, and "FILE: ..." for constants of no stable
/// material and for a map without any.
ElasticField read_elastic_field(const std::string& file);

}  // namespace grainfield::continuum
