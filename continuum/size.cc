#include "continuum/size.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "continuum/osl/models.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

// The settings by name; 0 for a parameter that the model does not have or that is unset.
class Numbers {
 public:
  explicit Numbers(const Settings& settings) : settings_(settings) {}
  bool has(const char* name) const { return settings_.count(name) != 0; }
  double operator()(const char* name) const {
    const double value = has(name) ? number_of(settings_, name) : 0;
    return std::isfinite(value) ? value : 0;
  }
  double or_else(const char* name, double standard) const {
    const double value = (*this)(name);
    return value > 0 ? value : standard;
  }

 private:
  const Settings& settings_;
};

struct Mesh {
  double unknowns = 0;
  std::vector<const char*> parameters;  // that make it fine
};

Mesh mesh_of(const std::string& name, const Settings& settings) {
  const Numbers n(settings);
  const bool transverse = name == "fe_transverse_layer" || name == "fe_transverse_half_space";
  const bool space = n("dim") == 3 || transverse;
  if (name == "fe_elastic_layer" || name == "fe_transverse_layer" ||
      name == "fe_orthotropic_layer") {
    const double down = n("cells") * n.or_else("degree", space ? 2 : 3);
    const double across = 2 * n("half_width") * down;
    return {space ? 3 * down * across * across : 2 * down * across,
            {"cells", "half_width", "degree"}};
  }
  if (name == "fe_elastic_half_space" || transverse) {
    // Rings around the load, each twice as wide as the one before.
    const double rings = 1 + std::log2(n.or_else("radius", space ? 50 : 10000) /
                                       n.or_else("patch", space ? 0.02 : 0.05));
    const double along = n.or_else("cells", space ? 1 : 2) * n.or_else("degree", 3);
    return {rings * (space ? 12 * along * along * along : 8 * along * along), {"cells", "degree"}};
  }
  if (name == "fe_cantelaube_core") {
    const double across = std::exp2(n("refinement")) * n("degree");
    return {2 * 3 * across * across, {"refinement", "degree"}};
  }
  if (name == "fe_mohr_coulomb_wedge") return {4 * n("cells") * n("cells"), {"cells"}};
  return {};
}

}  // namespace

void require_possible(const ModelInfo& info, const Settings& complete) {
  if (info.name == "fe_osl_wedge" || info.name == "fe_osl_layer") {
    osl::make_task(info.name, complete);
    return;
  }
  const Mesh mesh = mesh_of(info.name, complete);
  if (mesh.unknowns <= kMostUnknowns) return;
  std::vector<std::string> given;
  for (const char* name : mesh.parameters) {
    const auto at = complete.find(name);
    if (at != complete.end()) given.push_back(fmt::format("{} = {}", name, at->second));
  }
  throw BadParameter(fmt::format(
      "model {}: {} ask for {:.2g} unknowns; allowed: up to {:g}; lower {}", info.name,
      fmt::join(given, ", "), mesh.unknowns, kMostUnknowns, fmt::join(mesh.parameters, ", ")));
}

void require_unknowns(const std::string& name, double unknowns, double most, const char* by) {
  if (unknowns <= most) return;
  throw ComputationFailed(fmt::format(
      "{}: the next refinement would have about {:.2g} unknowns, allowed: up to most_unknowns = "
      "{:g}; lower {}, or raise most_unknowns where there is memory",
      name, unknowns, most, by));
}

}  // namespace grainfield::continuum
