#include "continuum/idle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

bool one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Where a map gives what the parameter would.
std::string beside_map(const Settings& s) {
  return fmt::format("beside map = {}, which replaces it; leave one of the two out", s.at("map"));
}

std::string orthotropic_layer(const std::string& parameter, const Settings& s) {
  const bool constant = one_of(parameter, {"r", "t", "E_x", "E_y", "G", "nu_xy"});
  if (constant && !s.at("map").empty()) return beside_map(s);
  if (!one_of(parameter, {"r", "t"})) return {};
  for (const char* modulus : {"E_x", "E_y", "G"})
    if (!std::isnan(number_of(s, modulus)))
      return fmt::format("beside {} = {}, which replaces it; leave it out, or E_x, E_y and G",
                         modulus, s.at(modulus));
  return {};
}

std::string cantelaube_core(const std::string& parameter, const Settings& s) {
  const std::string &axis = s.at("axis"), &branch = s.at("branch"), &base = s.at("base");
  if (parameter == "base_stiffness" && base != "elastic")
    return fmt::format("with base = {}; leave it out or set base = elastic", base);
  if (parameter == "axis_iterations" &&
      (axis == "continuous" || (axis == "branch" && branch == "zero")))
    return fmt::format(
        "with axis = {}, branch = {}: the axis does not yield; leave it out, or set axis = yields "
        "or branch = minus or plus",
        axis, branch);
  const double chosen = number_of(s, "beta_hat_deg");
  // A yielding axis takes from the branch which stress is the largest.
  if (parameter == "branch" && !std::isnan(chosen) && axis == "continuous")
    return fmt::format(
        "beside beta_hat_deg = {:g}, which replaces its angle; leave one of the two "
        "out, or set axis = yields",
        chosen);
  return {};
}

std::string wedge(const std::string& parameter, const Settings& s) {
  const std::string &base = s.at("base"), &history = s.at("history");
  if (one_of(parameter, {"E", "nu"}) && !s.at("map").empty()) return beside_map(s);
  if (one_of(parameter, {"base_friction_deg", "base_stiffness"}) && base != "frictional")
    return fmt::format("with base = {}; leave it out or set base = frictional", base);
  if (parameter == "layers" && history == "at_once")
    return "with history = at_once; leave it out or set history = rise or grow";
  return {};
}

}  // namespace

std::string idle_because(const std::string& model, const std::string& parameter,
                         const Settings& complete) {
  if (model == "fe_orthotropic_layer") return orthotropic_layer(parameter, complete);
  if (model == "fe_cantelaube_core") return cantelaube_core(parameter, complete);
  if (model == "fe_mohr_coulomb_wedge") return wedge(parameter, complete);
  return {};
}

std::optional<IdleSetting> find_idle(const ModelInfo& info, const Settings& given) {
  const Settings all = complete(info, given);
  for (const auto& [parameter, value] : given) {
    const std::string because = idle_because(info.name, parameter, all);
    if (!because.empty())
      return IdleSetting{parameter, fmt::format("model {}: {} = {} has no effect {}", info.name,
                                                parameter, value, because)};
  }
  return std::nullopt;
}

}  // namespace grainfield::continuum
