#include "coupling/observe/stress_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cctype>
#include <cmath>

#include "continuum/constants.h"

namespace grainfield::coupling {
namespace {

const char* const kLabels[] = {"-sigma_xx", "-sigma_yy", "sigma_xy"};
constexpr double kSigns[] = {-1, -1, 1};

}  // namespace

void average_maps(const Eigen::MatrixXd& samples, const std::function<bool(double, double)>& shown,
                  StressMaps& maps) {
  const Eigen::Index n = maps.points.rows();
  const auto count = static_cast<double>(samples.cols());
  maps.realizations = static_cast<int>(samples.cols());
  maps.mean = maps.error = Eigen::MatrixXd::Constant(n, 3, kNan);
  for (Eigen::Index p = 0; p < n; ++p) {
    if (!shown(maps.points(p, 0), maps.points(p, 1))) continue;
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

std::vector<Section> map_sections(const StressMaps& m, const Eigen::MatrixXd& model,
                                  const std::string& name, const MapWords& words) {
  const auto map = [&](const std::string& title, const Eigen::VectorXd& values) {
    return Map{title, m.columns, m.rows, m.points, values};
  };
  const auto titled = [&](const std::string& text, const std::string& start) {
    return words.of.empty() ? start + text
                            : words.of + ": " + static_cast<char>(std::tolower(start[0])) + text;
  };
  std::vector<Section> out;
  Picture side = maps(titled("rains, model and residual", "G"), "x / h", "y / h",
                      "-σ_{yy}  (" + words.unit + ")",
                      {map("grains", -m.mean.col(1)), map(name, -model.col(1)),
                       map("grains - " + name, model.col(1) - m.mean.col(1))});
  side.caption = words.caption;
  out.emplace_back(std::move(side));
  if (m.error.array().isNaN().all()) return out;
  std::vector<Map> residuals;
  for (int c = 0; c < 3; ++c) {
    const Eigen::VectorXd off =
        kSigns[c] * (m.mean.col(c) - model.col(c)).cwiseQuotient(m.error.col(c));
    residuals.push_back(map(
        kLabels[c], off.unaryExpr([](double v) { return std::isfinite(v) ? v : std::nan(""); })));
  }
  Picture where = maps(titled(fmt::format("here {} fails", name), "W"), "x / h", "y / h",
                       "(grains - model) / standard error", residuals);
  const double rare =
      boost::math::quantile(boost::math::students_t(std::max(1, m.realizations - 1)), 0.995);
  where.caption = fmt::format(
      "Residuals in standard errors of the mean of {} realizations. Chance alone puts one place in "
      "a hundred beyond {:.1f} (Student's t); a coherent region beyond it is where the model is "
      "wrong.",
      m.realizations, rare);
  out.emplace_back(std::move(where));
  return out;
}

}  // namespace grainfield::coupling
