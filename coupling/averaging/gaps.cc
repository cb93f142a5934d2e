#include "coupling/averaging/gaps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace grainfield::coupling {
namespace {

constexpr Eigen::Index named = 3;

std::string place(const Eigen::MatrixXd& at, Eigen::Index p) {
  std::string text;
  for (Eigen::Index a = 0; a < at.cols(); ++a)
    text += fmt::format("{}{:.4g}", a == 0 ? '(' : ' ', at(p, a));
  return text + ")";
}

}  // namespace

void Gaps::add(const Gaps& other) {
  points = std::max(points, other.points);
  least_grains = other.least_grains;
  for (const auto& [p, grains] : other.few_grains) {
    const auto [entry, added] = few_grains.emplace(p, grains);
    if (!added) entry->second = std::min(entry->second, grains);
  }
  outside.insert(other.outside.begin(), other.outside.end());
}

std::string Gaps::text(const Eigen::MatrixXd& at) const {
  std::vector<std::string> lines;
  std::string places;
  Eigen::Index few = 0, empty = 0;
  for (const auto& [p, grains] : few_grains) {
    if (grains == 0) {
      ++empty;
    } else if (++few <= named) {
      places += fmt::format("{} {} with {:.3g}", few == 1 ? "" : ",", place(at, p), grains);
    }
  }
  if (few > 0) {
    lines.push_back(fmt::format(
        "{} of {} points{} have fewer than {} grains in the averaging volume and are nan:{}{}; a "
        "larger width takes in more",
        few, points - empty, empty > 0 ? " within the packing" : "", least_grains, places,
        few > named ? ", ..." : ""));
  }
  if (empty > 0) {
    lines.push_back(
        fmt::format("{} of {} points lie outside the packing, without a grain in the "
                    "averaging volume, and are nan",
                    empty, points));
  }
  if (!outside.empty()) {
    places.clear();
    Eigen::Index n = 0;
    for (const auto& entry : outside) {
      if (n == named) break;
      places += fmt::format("{} {}", n++ == 0 ? "" : ",", place(at, entry.first));
    }
    lines.push_back(fmt::format(
        "{} of {} points have less than a tenth of the averaging volume inside the packing and are "
        "nan:{}{}",
        outside.size(), points, places,
        static_cast<Eigen::Index>(outside.size()) > named ? ", ..." : ""));
  }
  return fmt::format("{}", fmt::join(lines, "\n"));
}

}  // namespace grainfield::coupling
