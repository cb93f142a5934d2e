#include "coupling/fit/heap_maps.h"

#include <fmt/format.h>

#include <cmath>

#include "continuum/constants.h"
#include "coupling/averaging/points.h"
#include "coupling/compare/smooth.h"
#include "coupling/fit/fit_tables.h"
#include "coupling/fit/layer_models.h"
#include "coupling/structure/yield.h"

namespace grainfield::coupling {
namespace {

constexpr int kColumns = 101, kRows = 33;

// Depth below the mean flank, over h.
double depth_of(const HeapFacts& facts, double x, double y) {
  return -y - std::fabs(x) * std::tan((x < 0 ? facts.left() : facts.right()) * kDegree);
}

// The expression over (sigma_xx + sigma_yy)^2. Nearer to the surface than `margin` the stress is
// made of single contacts and its direction means nothing: nan.
Eigen::VectorXd expression(const HeapFits& fits, const Eigen::MatrixXd& stress, double margin) {
  const StressMaps& m = fits.heaps.maps;
  const HeapFacts& facts = fits.heaps.facts;
  Eigen::VectorXd out = Eigen::VectorXd::Constant(stress.rows(), kNan);
  for (Eigen::Index p = 0; p < stress.rows(); ++p) {
    const double slope = (m.points(p, 0) < 0 ? facts.left() : facts.right()) * kDegree;
    if (depth_of(facts, m.points(p, 0), m.points(p, 1)) * std::cos(slope) < margin) continue;
    const double sum = stress(p, 0) + stress(p, 1);
    out[p] = mohr_coulomb_expression(stress(p, 0), stress(p, 1), stress(p, 2), facts.friction()) /
             (sum * sum);
  }
  return out;
}

}  // namespace

StressMaps heap_map_grid(const HeapSlopes& slopes) {
  StressMaps out;
  out.columns = kColumns;
  out.rows = kRows;
  out.points = grid_points(-1 / slopes.left(), 1 / slopes.right(), kColumns, -1, 0, kRows);
  return out;
}

void fill_heap_maps(const Eigen::MatrixXd& samples, const HeapFacts& facts, double margin,
                    StressMaps& maps) {
  const Eigen::Index n = maps.points.rows();
  const auto count = static_cast<double>(samples.cols());
  maps.mean = maps.error = Eigen::MatrixXd::Constant(n, 3, kNan);
  for (Eigen::Index p = 0; p < n; ++p) {
    const double x = maps.points(p, 0), y = maps.points(p, 1);
    if (depth_of(facts, x, y) < 0 || 1 + y < margin) continue;
    for (Eigen::Index c = 0; c < 3; ++c) {
      const auto row = samples.row(c * n + p);
      maps.mean(p, c) = row.mean();
      if (count > 1) {
        maps.error(p, c) =
            std::sqrt((row.array() - row.mean()).square().sum() / (count - 1) / count);
      }
    }
  }
}

Eigen::MatrixXd model_on_maps(const HeapFits& fits, const std::string& name) {
  const StressMaps& m = fits.heaps.maps;
  const FitModel& model = find_fit_model(fits.models, name);
  const Eigen::VectorXd parameters = parameters_of(fit_named(fits.fits, name));
  std::vector<Eigen::Index> inside;
  for (Eigen::Index p = 0; p < m.points.rows(); ++p) {
    if (m.mean.row(p).allFinite()) inside.push_back(p);
  }
  // There is nothing outside of the heap.
  const StressFunction stress = [&](const Eigen::MatrixXd& points) -> Eigen::MatrixXd {
    const auto& exact = model.at_point ? model.at_point : model.stress;
    return exact(points, parameters).unaryExpr([](double v) { return std::isnan(v) ? 0.0 : v; });
  };
  const Eigen::MatrixXd seen =
      smooth_in_plane(stress, m.points(inside, Eigen::all), *fits.heaps.kernel, 1);
  Eigen::MatrixXd out = Eigen::MatrixXd::Constant(m.points.rows(), 3, kNan);
  for (std::size_t k = 0; k < inside.size(); ++k) {
    out.row(inside[k]) = seen.row(static_cast<Eigen::Index>(k));
  }
  return out;
}

std::vector<Section> heap_map_sections(const HeapFits& fits, const std::string& name) {
  const StressMaps& m = fits.heaps.maps;
  if (m.points.rows() == 0 || !m.mean.array().isFinite().any()) return {};
  const Eigen::MatrixXd model = model_on_maps(fits, name);
  std::vector<Section> out = map_sections(
      m, model, name,
      {"ρ g h",
       "Every pile scaled by its own h and rho g h; one colour scale for all three, which ends at "
       "the 99 % quantile. The model has its fitted constants and is smoothed with the kernel of "
       "the averaging. Without values nearer to the floor than the averaging width.",
       ""});
  const double margin = fits.heaps.kernel->range() / 2;
  const HeapFacts& facts = fits.heaps.facts;
  Picture yield = maps("Mohr-Coulomb expression", "x / h", "y / h", "expression",
                       {{"grains", m.columns, m.rows, m.points, expression(fits, m.mean, margin)},
                        {name, m.columns, m.rows, m.points, expression(fits, model, margin)}});
  yield.caption = fmt::format(
      "((σxx - σyy)² + 4σxy²) / (σxx + σyy)² - sin²φ with φ = {:.1f} degrees (Roul 4.2), of the "
      "mean stress: 0 at the limit of friction, below 0 (blue) inside, above 0 (red) beyond it. "
      "Without values nearer to surface or floor than the averaging width.",
      facts.friction());
  out.emplace_back(std::move(yield));
  return out;
}

}  // namespace grainfield::coupling
