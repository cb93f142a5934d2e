#include "coupling/elastic_constants/elastic_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "continuum/constants.h"
#include "coupling/statistics/parallel.h"

namespace grainfield::coupling {
namespace {

void check(const ElasticMapOptions& o) {
  if (o.nx < 2 || o.ny < 2)
    throw std::invalid_argument(
        fmt::format("an elastic map of {} x {} nodes; at least 2 x 2 are needed", o.nx, o.ny));
  if (!(o.x1 > o.x0) || !(o.y1 > o.y0) || !std::isfinite(o.x1 - o.x0) ||
      !std::isfinite(o.y1 - o.y0))
    throw std::invalid_argument(
        fmt::format("an elastic map over x {} to {} m, y {} to {} m; the ends must be finite and "
                    "ascending",
                    o.x0, o.x1, o.y0, o.y1));
  if (!(o.width > 0) || !std::isfinite(o.width))
    throw std::invalid_argument(
        fmt::format("width of the elastic map's kernel is {} m; it must be positive", o.width));
  if (o.least_points < 1)
    throw std::invalid_argument(
        fmt::format("elastic map from at least {} points; it must be 1 or more", o.least_points));
}

// Points that have stress and strain in some realization and a weight.
int points_with_data(const Increments& increments, const Eigen::VectorXd& weights) {
  int count = 0;
  for (Eigen::Index p = 0; p < weights.size(); ++p) {
    bool there = false;
    for (std::size_t r = 0; weights[p] > 0 && !there && r < increments.stress.size(); ++r)
      there = increments.stress[r].row(p).allFinite() && increments.strain[r].row(p).allFinite();
    count += there;
  }
  return count;
}

}  // namespace

ElasticMap::Values ElasticMap::at(double x, double y) const {
  const double u = (x - x0) / dx, v = (y - y0) / dy;
  if (!(u >= 0 && u <= nx - 1 && v >= 0 && v <= ny - 1)) return {kNan, kNan};
  const int ix = std::min(static_cast<int>(u), nx - 2), iy = std::min(static_cast<int>(v), ny - 2);
  Values sum;
  for (int jy = 0; jy < 2; ++jy)
    for (int jx = 0; jx < 2; ++jx) {
      const double weight = (jx ? u - ix : 1 - (u - ix)) * (jy ? v - iy : 1 - (v - iy));
      if (weight == 0) continue;  // a node without value does not spoil its neighbours
      const Eigen::Index node = ix + jx + static_cast<Eigen::Index>(nx) * (iy + jy);
      sum.young += weight * young[node];
      sum.poisson += weight * poisson[node];
    }
  return sum;
}

ElasticMap ElasticMap::filled() const {
  std::vector<Eigen::Index> known;
  for (Eigen::Index k = 0; k < young.size(); ++k)
    if (!std::isnan(young[k]) && !std::isnan(poisson[k])) known.push_back(k);
  if (known.empty())
    throw std::invalid_argument("an elastic map without any value cannot be filled");
  ElasticMap map = *this;
  for (Eigen::Index k = 0; k < young.size(); ++k) {
    if (!std::isnan(young[k]) && !std::isnan(poisson[k])) continue;
    const auto distance = [&](Eigen::Index other) {
      return std::hypot(static_cast<double>(k % nx - other % nx) * dx,
                        static_cast<double>(k / nx - other / nx) * dy);
    };
    const Eigen::Index nearest = *std::min_element(
        known.begin(), known.end(),
        [&](Eigen::Index a, Eigen::Index b) { return distance(a) < distance(b); });
    map.young[k] = young[nearest];
    map.poisson[k] = poisson[nearest];
    map.young_error[k] = map.poisson_error[k] = kNan;
  }
  return map;
}

ElasticMap elastic_map(const Increments& increments, const ElasticMapOptions& options) {
  check(options);
  check_increments(increments, everywhere(increments.points));
  ElasticMap map;
  map.x0 = options.x0;
  map.y0 = options.y0;
  map.nx = options.nx;
  map.ny = options.ny;
  map.dx = (options.x1 - options.x0) / (options.nx - 1);
  map.dy = (options.y1 - options.y0) / (options.ny - 1);
  const Eigen::Index nodes = static_cast<Eigen::Index>(options.nx) * options.ny;
  map.young = map.poisson = map.young_error = map.poisson_error =
      Eigen::VectorXd::Constant(nodes, kNan);
  ElasticOptions fit = options.fit;
  fit.bootstrap.threads = 1;  // the nodes are shared among the threads instead
  in_parts(nodes, options.fit.bootstrap.threads, [&](Eigen::Index first, Eigen::Index last) {
    for (Eigen::Index k = first; k < last; ++k) {
      const Eigen::Vector2d node(map.x0 + static_cast<double>(k % map.nx) * map.dx,
                                 map.y0 + static_cast<double>(k / map.nx) * map.dy);
      const Locality where = locality(increments.points, node, options.kernel, options.width);
      if (points_with_data(increments, where.weights) < options.least_points) continue;
      const IsotropicConstants c = isotropic_constants(increments, where, fit);
      // Not a stable material (or undefined): no value that a solve could take.
      if (!(c.bulk.value > 0) || !(c.shear.value > 0) || !(c.young.value > 0)) continue;
      map.young[k] = c.young.value;
      map.poisson[k] = c.poisson.value;
      map.young_error[k] = c.young.error;
      map.poisson_error[k] = c.poisson.error;
    }
  });
  return map;
}

}  // namespace grainfield::coupling
