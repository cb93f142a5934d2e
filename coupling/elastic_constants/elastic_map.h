// Smooth maps E(x, y), nu(x, y) of the plane, as a finite-element solve takes them.
#pragma once
#include <Eigen/Core>
#include <string>

#include "coupling/elastic_constants/constants.h"

namespace grainfield::coupling {

/// Values on a regular grid: node ix + nx * iy at (x0 + ix dx, y0 + iy dy), the axes of the points
/// it was fitted on.
struct ElasticMap {
  double x0 = 0, y0 = 0, dx = 0, dy = 0;   ///< m
  int nx = 0, ny = 0;                      ///< at least 2 each
  Eigen::VectorXd young, young_error;      ///< N/m (plane strain); nan where there is none
  Eigen::VectorXd poisson, poisson_error;  ///< 1; errors nan with one realization

  struct Values {
    double young = 0, poisson = 0;
  };
  /// Bilinear between the nodes; nan outside the grid and where a node with a weight is nan.
  Values at(double x, double y) const;
  /// Every nan node takes the values of the nearest node that has them (errors stay nan), so that a
  /// mesh may reach beyond the grains. Throws std::invalid_argument when no node has a value.
  ElasticMap filled() const;
};

struct ElasticMapOptions {
  double x0 = 0, x1 = 0, y0 = 0, y1 = 0;  ///< first and last node, m
  int nx = 0, ny = 0;
  std::string kernel = "lucy";  ///< weight of the points around a node
  double width = 0;             ///< w of the kernel, m
  /// Fewer points (of any realization) with a weight than this around a node: nan.
  int least_points = 3;
  /// Degree 1 by default: exact where K and G vary linearly.
  ElasticOptions fit{.samples = "pooled", .degree = 1, .bootstrap = elastic_bootstrap()};
};

/// Local fits of K and G around every node, from which E and nu. nan where there are too few
/// points, where the fit is degenerate, and where K, G or E is not positive. Throws
/// std::invalid_argument as isotropic_constants() and for a bad grid.
ElasticMap elastic_map(const Increments& increments, const ElasticMapOptions& options);

/// What write_elastic_map writes.
std::string elastic_map_text(const ElasticMap& map);
/// CSV: comment lines (#), header x,y,young,poisson,young_error,poisson_error, one line per node, x
/// fastest, in SI units; numbers come back to the same bits. Complete or not at all. Throws as
/// write_text_file().
void write_elastic_map(const std::string& file, const ElasticMap& map);
/// Throws std::invalid_argument "FILE:LINE: ..." for a missing file, another header, a row with
/// other than six numbers, nodes that form no regular grid, E that is not positive or nu outside
/// (-1, 0.5).
ElasticMap read_elastic_map(const std::string& file);

}  // namespace grainfield::coupling
