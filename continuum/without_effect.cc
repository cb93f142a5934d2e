#include "continuum/without_effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "continuum/osl/field_map.h"
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

std::string ratios_beside_moduli(const std::string& parameter, const Settings& s) {
  if (!one_of(parameter, {"r", "t"})) return {};
  for (const char* modulus : {"E_x", "E_y", "G"})
    if (!std::isnan(number_of(s, modulus)))
      return fmt::format("beside {} = {}, which replaces it; leave it out, or E_x, E_y and G",
                         modulus, s.at(modulus));
  return {};
}

std::string orthotropic_layer(const std::string& parameter, const Settings& s) {
  const bool constant = one_of(parameter, {"r", "t", "E_x", "E_y", "G", "nu_xy"});
  if (constant && !s.at("map").empty()) return beside_map(s);
  return ratios_beside_moduli(parameter, s);
}

// A closed layer's nu_xy counts on a rough base, which a run may fill in later: it is not refused.
std::string orthotropic_half_plane(const std::string& parameter, const Settings& s) {
  if (parameter == "nu_xy" && std::isnan(number_of(s, "E_x")))
    return "beside r and t; leave it out or set E_x, E_y and G";
  return ratios_beside_moduli(parameter, s);
}

std::string beside_angle(double beta_hat_deg) {
  return fmt::format(
      "beside beta_hat_deg = {:g}, which replaces its angle; leave one of the two out",
      beta_hat_deg);
}

std::string cantelaube(const std::string& parameter, const Settings& s) {
  const double chosen = number_of(s, "beta_hat_deg");
  return parameter == "branch" && !std::isnan(chosen) ? beside_angle(chosen) : std::string();
}

std::string cantelaube_asymmetric(const std::string& parameter, const Settings& s) {
  if (parameter == "yield_ray_deg" && s.at("branch") == "zero")
    return "with branch = zero; leave it out or set branch = minus or plus";
  return {};
}

std::string liffman(const std::string& parameter, const Settings& s) {
  const double top = number_of(s, "top_alpha_deg"), bend = number_of(s, "bend");
  if (parameter == "bend" && top == 0)
    return "with top_alpha_deg = 0, a triangle; leave it out or set top_alpha_deg";
  if (parameter == "top_alpha_deg" && top != 0 && bend == 0.5)
    return "with bend = 0.5, on the axis; leave it out or set bend below 0.5";
  return {};
}

std::string osl_layer(const std::string& parameter, const Settings& s) {
  if (parameter == "returns" && s.at("base") == "absorbing")
    return "with base = absorbing; leave it out or set base = reflecting";
  return {};
}

std::string osl_field(const std::string& model, const std::string& parameter, const Settings& s) {
  if (one_of(parameter, {"rho_g", "eta", "mu"})) {
    const auto columns = osl::map_columns(s.at("map"));
    if (std::find(columns.begin(), columns.end(), parameter) != columns.end()) return beside_map(s);
  }
  const std::string& solver = s.at("solver");
  if (solver == "march" && one_of(parameter, {"order", "rows"}))
    return "with solver = march; leave it out or set solver = dg";
  if (solver == "dg" && one_of(parameter, {"tolerance", "steps"}))
    return "with solver = dg; leave it out or set solver = march";
  if (model == "fe_osl_layer" && parameter == "wall_friction" && s.at("sides") == "far")
    return "with sides = far; leave it out or set sides = walls";
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
    return beside_angle(chosen) + ", or set axis = yields";
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

std::string without_effect_because(const std::string& model, const std::string& parameter,
                                   const Settings& complete) {
  if (model == "cantelaube") return cantelaube(parameter, complete);
  if (model == "cantelaube_asymmetric") return cantelaube_asymmetric(parameter, complete);
  if (model == "liffman") return liffman(parameter, complete);
  if (model == "osl_layer") return osl_layer(parameter, complete);
  if (model == "orthotropic_half_plane") return orthotropic_half_plane(parameter, complete);
  if (model == "orthotropic_layer") return ratios_beside_moduli(parameter, complete);
  if (model == "fe_osl_wedge" || model == "fe_osl_layer")
    return osl_field(model, parameter, complete);
  if (model == "fe_orthotropic_layer") return orthotropic_layer(parameter, complete);
  if (model == "fe_cantelaube_core") return cantelaube_core(parameter, complete);
  if (model == "fe_mohr_coulomb_wedge") return wedge(parameter, complete);
  return {};
}

std::optional<SettingWithoutEffect> find_without_effect(const ModelInfo& info,
                                                        const Settings& given) {
  const Settings all = complete(info, given);
  for (const auto& [parameter, value] : given) {
    const std::string because = without_effect_because(info.name, parameter, all);
    if (!because.empty())
      return SettingWithoutEffect{parameter, fmt::format("model {}: {} = {} has no effect {}",
                                                         info.name, parameter, value, because)};
  }
  return std::nullopt;
}

}  // namespace grainfield::continuum
