#include "coupling/fit/heap_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "coupling/averaging/average.h"
#include "coupling/averaging/kernel.h"
#include "coupling/run/realization_file.h"

namespace grainfield::coupling {
namespace {

constexpr int kLeastValues = 10;
constexpr double kRange = 2;  // of the Lucy kernel, widths
const std::vector<std::string> kComponents{"sigma_xx", "sigma_yy", "sigma_xy"};

double mean_slope(const PileFrame& f) {
  double sum = 0;
  int count = 0;
  for (const double slope : {f.repose_left_deg, f.repose_right_deg}) {
    if (!std::isfinite(slope)) continue;
    sum += slope;
    ++count;
  }
  return count > 0 ? sum / count : std::nan("");
}

}  // namespace

HeapData heap_data(const Case& value, const std::vector<std::string>& files, int threads) {
  HeapData out;
  const FitSetup& setup = value.fit;
  double slope = 0, height = 0, diameter = 0;
  int measured = 0;
  for (const std::string& file : files) {
    const Realization one = read_realization(file);
    out.frames.push_back(pile_frame(one["pile"]));
    const double own = mean_slope(out.frames.back());
    if (std::isfinite(own)) {
      slope += own;
      ++measured;
    }
    height += out.frames.back().height / static_cast<double>(files.size());
    diameter += out.frames.back().diameter / static_cast<double>(files.size());
  }
  if (measured == 0) {
    throw std::invalid_argument(
        "fit: no pile has flanks long enough for a slope; use more grains (source.grains)");
  }
  slope /= measured;
  const double tangent = std::tan(slope * std::numbers::pi / 180);
  out.width = setup.width_diameters * diameter;
  AverageOptions options;
  options.method = "coarse_graining";
  options.kernel = "lucy";
  options.width = out.width;
  options.threads = threads;
  options.quantities = {"sigma"};
  const auto kernel = make_kernel(options.kernel, out.width);
  const double length = kernel->independent_length();
  out.facts = {slope, 1, 1, length / (2 * std::sqrt(std::numbers::pi)) / height};

  FitData& data = out.data;
  data.components = setup.components;
  std::vector<Eigen::Vector2d> places;
  std::vector<int> level;
  for (const double share : setup.heights) {
    const double depth = 1 - share, half = depth / tangent - kRange * out.width / height;
    data.levels.push_back(fmt::format("{:g}", share));
    if (half <= 0) continue;
    const int n = 2 * static_cast<int>(half * height / (0.5 * length)) + 1;
    for (int k = 0; k < n; ++k) {
      places.emplace_back(n > 1 ? half * (2.0 * k / (n - 1) - 1) : 0, -depth);
      level.push_back(static_cast<int>(data.levels.size()) - 1);
    }
  }
  Eigen::MatrixXd points(places.size(), 2);
  for (std::size_t k = 0; k < places.size(); ++k) {
    points.row(static_cast<Eigen::Index>(k)) = places[k].transpose();
  }
  const auto n = points.rows();
  Eigen::MatrixXd all(n * static_cast<Eigen::Index>(kComponents.size()),
                      static_cast<Eigen::Index>(files.size()));
  for (std::size_t r = 0; r < files.size(); ++r) {
    const PileFrame& frame = out.frames[r];
    const Realization one = read_realization(files[r]);
    const Field field = average(one["pile"], frame.to_packing(points), options);
    for (std::size_t c = 0; c < kComponents.size(); ++c) {
      all.block(static_cast<Eigen::Index>(c) * n, static_cast<Eigen::Index>(r), n, 1) =
          field.find(kComponents[c])->value / frame.pressure();
    }
  }
  std::vector<Eigen::Index> rows;
  for (std::size_t c = 0; c < setup.components.size(); ++c) {
    const auto at = std::find(kComponents.begin(), kComponents.end(), setup.components[c]);
    const Eigen::Index first = (at - kComponents.begin()) * n;
    for (Eigen::Index p = 0; p < n; ++p) {
      if (!all.row(first + p).allFinite()) {
        ++out.left_out;
        continue;
      }
      rows.push_back(first + p);
      data.component.push_back(static_cast<int>(c));
      data.level.push_back(level[static_cast<std::size_t>(p)]);
    }
  }
  if (static_cast<int>(rows.size()) < kLeastValues) {
    throw std::invalid_argument(fmt::format(
        "fit.heights: found {} values in the heaps, needed: {} or more; choose lower heights, a "
        "smaller fit.width_diameters or larger piles",
        rows.size(), kLeastValues));
  }
  data.points.resize(static_cast<Eigen::Index>(rows.size()), 2);
  data.samples.resize(static_cast<Eigen::Index>(rows.size()), all.cols());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    data.points.row(static_cast<Eigen::Index>(k)) = points.row(rows[k] % n);
    data.samples.row(static_cast<Eigen::Index>(k)) = all.row(rows[k]);
  }
  return out;
}

}  // namespace grainfield::coupling
