#include "coupling/averaging/balance.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coupling/averaging/average.h"
#include "coupling/averaging/extent.h"
#include "coupling/averaging/kernel.h"
#include "coupling/averaging/region.h"
#include "coupling/averaging/weights.h"

namespace grainfield::coupling {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Differences {
  std::vector<double> offset, weight;  // in steps; over the step
};

Differences differences(int order) {
  if (order == 2) return {{-1, 1}, {-0.5, 0.5}};
  if (order == 4) return {{-2, -1, 1, 2}, {1. / 12, -8. / 12, 8. / 12, -1. / 12}};
  throw std::invalid_argument(
      fmt::format("differences of order {} for the balance; known: 2, 4", order));
}

std::string component(const char* name, int a, int b) {
  const char axes[] = "xyz";
  return fmt::format("{}_{}{}", name, axes[a], axes[b]);
}

std::string component(const char* name, int a) { return fmt::format("{}_{}", name, "xyz"[a]); }

// Keeps the larger of two errors; an undefined one is the worst.
void worse(double& worst, double error) {
  if (std::isnan(error) || std::abs(error) > std::abs(worst)) worst = error;
}

// Places over a packing where an averaging is asked.
struct Places {
  MatrixXd base, inside, surface;
};

// Per column over the plane that is at least four diameters high: half a diameter above the floor
// and below the surface, and nine heights between.
Places places_over(const MatrixXd& columns, const Region& region, double diameter) {
  const Index dim = columns.cols() + 1, n = columns.rows();
  Places out{MatrixXd(n, dim), MatrixXd(9 * n, dim), MatrixXd(n, dim)};
  Index high = 0, rows = 0;
  for (Index k = 0; k < n; ++k) {
    const double top =
        dim == 2 ? region.surface(columns(k, 0)) : region.surface(columns(k, 0), columns(k, 1));
    const double height = top - region.floor();
    if (height < 4 * diameter) continue;
    out.base.row(high) << columns.row(k), region.floor() + diameter / 2;
    out.surface.row(high++) << columns.row(k), top - diameter / 2;
    for (int j = 0; j < 9; ++j)
      out.inside.row(rows++) << columns.row(k),
          region.floor() + diameter + (height - 2 * diameter) * (j + 0.5) / 9;
  }
  out.base.conservativeResize(high, dim);
  out.surface.conservativeResize(high, dim);
  out.inside.conservativeResize(rows, dim);
  return out;
}

// In the plane 41 columns a diameter off the sides; in space 9 x 9 from side to side.
Places places_over(const Region& region, double diameter) {
  if (region.dim() == 2) {
    const MatrixXd line =
        line_points(region.left() + diameter, region.right() - diameter, 41, 0).leftCols(1);
    return places_over(line, region, diameter);
  }
  const double half_x = (region.right() - region.left()) / 18,
               half_y = (region.back() - region.front()) / 18;
  return places_over(grid_points(region.left() + half_x, region.right() - half_x, 9,
                                 region.front() + half_y, region.back() - half_y, 9),
                     region, diameter);
}

}  // namespace

BalanceResidual balance_residual(const dem::Snapshot& snapshot, const MatrixXd& points,
                                 const AverageOptions& given, double step, int order) {
  AverageOptions options = given;
  options.quantities = {"sigma", "kinetic", "density", "traction", "load", "grains"};
  if (step <= 0) step = options.width * (options.method == "coarse_graining" ? 0.05 : 0.5);
  const Differences d = differences(order);
  const int dim = snapshot.dim;
  // The point itself, then its neighbours along every axis.
  const auto arm = static_cast<Index>(d.offset.size());
  const Index n = points.rows(), stride = 1 + dim * arm;
  MatrixXd stencil(stride * n, points.cols());
  for (Index p = 0; p < n; ++p) {
    stencil.middleRows(stride * p, stride).rowwise() = points.row(p);
    for (int axis = 0; axis < std::min<Index>(dim, points.cols()); ++axis)
      for (Index k = 0; k < arm; ++k)
        stencil(stride * p + 1 + axis * arm + k, axis) +=
            d.offset[static_cast<std::size_t>(k)] * step;
  }
  const Field field = average(snapshot, stencil, options);
  BalanceResidual result;
  result.step = step;
  MatrixXd residual(n, dim);
  const VectorXd& density = field.find("density")->value;
  for (int a = 0; a < dim; ++a) {
    const VectorXd body = density * snapshot.gravity[a] +
                          field.find(component("traction", a))->value +
                          field.find(component("load", a))->value;
    for (Index p = 0; p < n; ++p) residual(p, a) = body[stride * p];
    for (int b = 0; b < dim; ++b) {
      const VectorXd stress =
          field.find(component("sigma", a, b))->value +
          field.find(component("kinetic", std::min(a, b), std::max(a, b)))->value;
      for (Index p = 0; p < n; ++p)
        for (Index k = 0; k < arm; ++k)
          residual(p, a) +=
              d.weight[static_cast<std::size_t>(k)] / step * stress[stride * p + 1 + b * arm + k];
    }
  }
  double mass = 0, squares = 0, largest = 0;
  for (Index p = 0; p < n; ++p) {
    if (!residual.row(p).allFinite()) continue;
    ++result.points;
    mass += density[stride * p];
    squares += residual.row(p).squaredNorm();
    largest = std::max(largest, residual.row(p).norm());
  }
  result.rho_g = mass / result.points * snapshot.gravity.norm();
  result.rms = std::sqrt(squares / (dim * result.points)) / result.rho_g;
  result.largest = largest / result.rho_g;
  return result;
}

std::vector<BalanceRow> balance_table(const dem::Snapshot& snapshot, AverageOptions options,
                                      const std::function<void(double)>& progress) {
  const double diameter = mean_diameter(snapshot), width = options.width;
  const int up = up_axis(snapshot.dim);
  if (!(snapshot.gravity[up] < 0))
    throw std::invalid_argument(fmt::format(
        "the packing's gravity is {:g} m/s2; what the averagings carry is compared with its "
        "weight along -{}",
        fmt::join(snapshot.gravity.data(), snapshot.gravity.data() + snapshot.dim, " "),
        "xyz"[up]));
  if (snapshot.cell.periodic[static_cast<std::size_t>(up)])
    throw std::invalid_argument(
        fmt::format("the packing repeats along {}: no height has a weight above it", "xyz"[up]));
  const Region region(snapshot);
  const LayerFrame frame = layer_frame(snapshot);
  const Places places = places_over(region, diameter);
  if (places.inside.rows() == 0)
    throw std::invalid_argument(
        "the packing is nowhere four mean diameters high; too low to "
        "compare averagings on (without --balance it is averaged all the same)");
  std::vector<BalanceRow> out;
  constexpr int cuts = 9;
  double rows = 0, done = 0;
  for (const Method& method : methods()) rows += static_cast<double>(method.kernels().size());
  const auto tell = [&] {
    done += 1 / (rows * (cuts + 1));
    if (progress) progress(std::min(done, 1.0));
  };
  for (const Method& method : methods())
    for (const std::string& kernel : method.kernels()) {
      options.method = method.name;
      options.kernel = kernel;
      // One w for all: standard deviations along an axis of 0.60 w (lucy), 0.97 w and 0.50 w.
      options.width = width * diameter * (method.name == "coarse_graining" ? 1 : 2.5);
      BalanceRow row;
      row.method = method.name;
      row.kernel = kernel;
      row.width = options.width;
      // RVEs: short arms, so that the stencil near the edges keeps part of the RVE inside.
      const bool kernels = method.name == "coarse_graining";
      const double step = kernels ? 0 : options.width / 4;
      const int order = kernels ? 4 : 2;
      row.base = balance_residual(snapshot, places.base, options, step, order);
      row.inside = balance_residual(snapshot, places.inside, options, step, order);
      row.surface = balance_residual(snapshot, places.surface, options, step, order);
      tell();
      for (int k = 0; k < cuts; ++k) {
        const double share = 0.1 * k;
        const CutForce cut =
            cut_force(snapshot, frame.floor + share * (region.highest() - frame.floor), options);
        worse(row.worst_cut, cut.error());
        worse(row.worst_sharp, cut.force / cut.sharp - 1);
        tell();
      }
      out.push_back(row);
    }
  return out;
}

}  // namespace grainfield::coupling
