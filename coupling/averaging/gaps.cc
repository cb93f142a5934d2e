#include "coupling/averaging/gaps.h"

#include <fmt/format.h>

#include <algorithm>

namespace grainfield::coupling {
namespace {

constexpr std::size_t named = 3;

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
  std::string text;
  if (!few_grains.empty()) {
    text = fmt::format(
        "{} of {} points have fewer than {} grains in the averaging volume and are nan:",
        few_grains.size(), points, least_grains);
    std::size_t n = 0;
    for (const auto& [p, grains] : few_grains) {
      if (n == named) break;
      text += fmt::format("{} {} with {:.3g}", n++ == 0 ? "" : ",", place(at, p), grains);
    }
    if (few_grains.size() > named) text += ", ...";
    text += "; a larger width takes in more";
  }
  if (!outside.empty()) {
    text += fmt::format(
        "{}{} of {} points have less than a tenth of the averaging volume inside "
        "the packing and are nan:",
        text.empty() ? "" : "\n", outside.size(), points);
    std::size_t n = 0;
    for (const auto& entry : outside) {
      if (n == named) break;
      text += fmt::format("{} {}", n++ == 0 ? "" : ",", place(at, entry.first));
    }
    if (outside.size() > named) text += ", ...";
  }
  return text;
}

}  // namespace grainfield::coupling
