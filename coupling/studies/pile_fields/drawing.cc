#include "coupling/studies/pile_fields/drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainfield::coupling {

Map map_of(const PileSet& piles, const std::string& title, const Eigen::VectorXd& value) {
  Map out{title, piles.columns(), piles.rows(), piles.grid(), value};
  for (Eigen::Index p = 0; p < value.size(); ++p) {
    if (!piles.shown(p)) out.value[p] = std::nan("");
  }
  return out;
}

Series row_of(const PileSet& piles, const std::string& label, int row, const Eigen::VectorXd& value,
              const Eigen::VectorXd& error, bool simulation) {
  std::vector<Eigen::Index> shown;
  for (int c = 0; c < piles.columns(); ++c) {
    const Eigen::Index p = c + static_cast<Eigen::Index>(piles.columns()) * row;
    if (piles.shown(p) && std::isfinite(value[p])) shown.push_back(p);
  }
  Series out{label, piles.grid().col(0)(shown), value(shown), {}, simulation};
  if (error.size() == value.size()) out.error = error(shown);
  return out;
}

Frame rows_of(const PileSet& piles, const std::string& title, const Eigen::VectorXd& value) {
  Frame out;
  out.title = title;
  for (const double height : piles.setup().get<FieldsSetup>().heights) {
    const int row = piles.row_at(height);
    Series s =
        row_of(piles, fmt::format("height {:.2f} h", static_cast<double>(row) / (piles.rows() - 1)),
               row, value, {}, false);
    if (s.x.size() > 1) out.series.push_back(std::move(s));
  }
  return out;
}

Series binned(const std::string& label, const std::vector<double>& x, const std::vector<double>& y,
              int bins) {
  std::vector<std::pair<double, double>> pairs;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (std::isfinite(x[k]) && std::isfinite(y[k])) pairs.emplace_back(x[k], y[k]);
  }
  std::sort(pairs.begin(), pairs.end());
  const std::size_t n = pairs.size(), count = std::min<std::size_t>(bins, n / 3);
  Series out{label, Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::VectorXd(count), true};
  for (std::size_t b = 0; b < count; ++b) {
    const std::size_t first = n * b / count, last = n * (b + 1) / count;
    const auto m = static_cast<double>(last - first);
    double sx = 0, sy = 0, squares = 0;
    for (std::size_t k = first; k < last; ++k) {
      sx += pairs[k].first;
      sy += pairs[k].second;
    }
    for (std::size_t k = first; k < last; ++k) squares += std::pow(pairs[k].second - sy / m, 2);
    const auto at = static_cast<Eigen::Index>(b);
    out.x[at] = sx / m;
    out.y[at] = sy / m;
    out.error[at] = std::sqrt(squares / (m - 1) / m);
  }
  return out;
}

std::string how_averaged(const PileSet& piles) {
  return fmt::format(
      "Particle-centre averaging, circular RVE of radius {:.3g} m ({:g} mean diameters); {} "
      "pile{}, "
      "h = {:.3g} m.",
      piles.radius(), piles.setup().get<FieldsSetup>().rve_diameters, piles.count(),
      piles.count() == 1 ? "" : "s", piles.height());
}

}  // namespace grainfield::coupling
