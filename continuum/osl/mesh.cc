#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "continuum/model.h"
#include "continuum/osl/problem.h"

namespace grainfield::continuum::osl {
namespace {

/// Columns end on a slope when they miss it by less.
constexpr double kOnBorder = 1e-12;

void check_ascending(const Problem& problem, const char* what, const std::vector<double>& values) {
  if (values.size() < 2)
    throw BadParameter(fmt::format("model {}: the mesh has {} borders of {}; allowed: 2 or more",
                                   problem.name, values.size(), what));
  for (std::size_t i = 1; i < values.size(); ++i)
    if (!(values[i] > values[i - 1]))
      throw BadParameter(
          fmt::format("model {}: the mesh's border {} of {} is at {:.6g} after {:.6g}; allowed: "
                      "ascending",
                      problem.name, i + 1, what, values[i], values[i - 1]));
}

/// n cells from a to b, without a.
void append(std::vector<double>& out, double a, double b, int n) {
  for (int i = 1; i <= n; ++i) out.push_back(i == n ? b : a + (b - a) * i / n);
}

}  // namespace

void check_mesh(const Problem& problem, const StripMesh& mesh) {
  check_ascending(problem, "columns", mesh.columns);
  check_ascending(problem, "rows", mesh.rows);
  if (mesh.rows.front() != 0)
    throw BadParameter(
        fmt::format("model {}: the mesh begins at depth {:.6g}; allowed: 0, the surface",
                    problem.name, mesh.rows.front()));
  if (mesh.spread > 0 && (std::abs(mesh.columns.front() + 1) > kOnBorder ||
                          std::abs(mesh.columns.back() - 1) > kOnBorder))
    throw BadParameter(
        fmt::format("model {}: the mesh does not fit the heap, its rays end at {:.6g} and {:.6g} "
                    "of the slopes; allowed: -1 and 1",
                    problem.name, mesh.columns.front(), mesh.columns.back()));
  if (problem.mirrored && mesh.columns.front() < 0 && mesh.columns.back() > 0 &&
      std::find(mesh.columns.begin(), mesh.columns.end(), 0.) == mesh.columns.end())
    throw BadParameter(
        fmt::format("model {}: the mesh has no border of columns at x = 0, where the closure "
                    "changes; allowed: an even number of columns on both sides of it",
                    problem.name));
}

StripMesh heap_mesh(double spread, double depth, int n, int rows, double characteristic) {
  StripMesh mesh;
  mesh.spread = spread;
  std::vector<double> half;
  if (characteristic > 0) {
    if (n < 2)
      throw BadParameter(
          fmt::format("columns = {} does not fit the heap; allowed with mesh = aligned: at "
                      "least 2, one on either side of the characteristic from the apex",
                      n));
    const double ray = characteristic / spread;
    const int inner = std::clamp(static_cast<int>(std::lround(n * ray)), 1, n - 1);
    append(half, 0, ray, inner);
    append(half, ray, 1, n - inner);
    mesh.kinks = {-ray, ray};
  } else {
    append(half, 0, 1, n);
  }
  for (auto s = half.rbegin(); s != half.rend(); ++s) mesh.columns.push_back(-*s);
  mesh.columns.push_back(0);
  mesh.columns.insert(mesh.columns.end(), half.begin(), half.end());
  mesh.rows = {0};
  append(mesh.rows, 0, depth, rows);
  return mesh;
}

StripMesh box_mesh(double half_width, double depth, int n, int rows) {
  StripMesh mesh = heap_mesh(1, depth, n, rows, 0);
  mesh.spread = 0;
  for (double& column : mesh.columns) column *= half_width;
  return mesh;
}

}  // namespace grainfield::continuum::osl
