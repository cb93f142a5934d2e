#include "coupling/studies/boussinesq_limit/limits.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "coupling/compare/beyond_noise.h"

namespace grainfield::coupling {
namespace {

constexpr double kEvidence = 0.1;  // "right to x %" is told below this

// Samples and model at some of the comparison's places, one below the other.
struct Taken {
  Eigen::MatrixXd samples;
  Eigen::VectorXd model;
};
template <class Wanted>
Taken taken(const Comparison& c, const ModelProfiles& model, const Wanted& wanted) {
  std::vector<std::pair<std::size_t, Eigen::Index>> places;
  for (std::size_t p = 0; p < c.profiles.size(); ++p) {
    for (Eigen::Index k = 0; k < c.profiles[p].x.size(); ++k) {
      if (c.profiles[p].samples.rows() > 0 && wanted(c.profiles[p], k)) places.emplace_back(p, k);
    }
  }
  Taken out;
  if (places.empty()) return out;
  out.samples.resize(static_cast<Eigen::Index>(places.size()), c.profiles.front().samples.cols());
  out.model.resize(out.samples.rows());
  for (Eigen::Index row = 0; row < out.model.size(); ++row) {
    const auto& [p, k] = places[static_cast<std::size_t>(row)];
    out.samples.row(row) = c.profiles[p].samples.row(k);
    out.model[row] = model.values[p][k];
  }
  return out;
}

}  // namespace

void add_limits(StudyResult& out) {
  const Comparison& c = out.comparison;
  for (const ModelProfiles& model : c.models) {
    for (const std::string width : {"w_diameters", "w_depths"}) {
      const auto of_width = [&](const Profile& p) { return p.key.ends_with(width); };
      const auto add = [&](const std::string& region, const auto& wanted) {
        const Taken t = taken(c, model, wanted);
        if (t.samples.cols() < 2) return;
        const BeyondNoise b = misfit_beyond_noise(t.samples, t.model);
        const std::string key = fmt::format("limit.{}.{}.{}", model.key, region, width);
        const auto put = [&](const char* name, double number) {
          if (std::isfinite(number)) out.summary[key + name] = number;
        };
        put(".squared", b.squared);
        put(".squared.standard_error", b.error);
        put(".noise", b.noise);
        put(".right_to", b.right_to());
      };
      add("base",
          [&](const Profile& p, Eigen::Index) { return of_width(p) && p.key.starts_with("base"); });
      add("axis", [&](const Profile& p, Eigen::Index k) {
        return of_width(p) && std::fabs(p.x[k]) <= 1e-9 * c.scale.h;
      });
      add("all", [&](const Profile& p, Eigen::Index) { return of_width(p); });
    }
  }
}

std::string told_limits(const StudyResult& r) {
  const auto number = [&](const std::string& key) -> std::optional<double> {
    const auto found = r.summary.find(key);
    if (found == r.summary.end()) return std::nullopt;
    return std::get<double>(found->second);
  };
  std::string out;
  for (const ModelProfiles& model : r.comparison.models) {
    const auto right = number(fmt::format("limit.{}.base.w_depths.right_to", model.key));
    if (!right) continue;
    if (!out.empty()) out += "; ";
    out += *right < kEvidence ? fmt::format("{} is right to {:.2g} %", model.key, 100 * *right)
                              : fmt::format("{} only to {:.2g} %", model.key, 100 * *right);
  }
  const double deep = number("layer.depth_diameters").value_or(0);
  if (out.empty()) {
    return fmt::format("Fewer than three layers, {:.3g} diameters deep, bound no misfit.", deep);
  }
  return fmt::format(
      "On the base of layers {:.3g} diameters deep, seen at a fixed share of the "
      "depth, with 95 %: {}.",
      deep, out);
}

std::vector<SummaryKey> limit_keys() {
  return {
      {"limit.*.*.*.squared", "-",
       "misfit beyond noise: sum of (grains - MODEL)^2 less the variance of the mean, over the sum "
       "of MODEL^2; of region base | axis | all, averaged at w_diameters | w_depths"},
      {"limit.*.*.*.noise", "-", "the variance that was taken away"},
      {"limit.*.*.*.right_to", "-",
       "root of its upper bound, 95 % one-sided: the model is right to this share"},
  };
}

}  // namespace grainfield::coupling
