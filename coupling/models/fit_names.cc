#include "coupling/models/fit_names.h"

#include <fmt/format.h>

#include <algorithm>

namespace grainfield::coupling {

const std::vector<FitName>& fit_names() {
  static const std::vector<FitName> all{
      {"cantelaube_minus", "cantelaube", {{"branch", "minus"}}, ""},
      {"cantelaube_zero", "cantelaube", {{"branch", "zero"}}, ""},
      {"cantelaube_plus", "cantelaube", {{"branch", "plus"}}, ""},
      {"cantelaube_continuous", "cantelaube", {}, "beta_hat_deg"},
      {"osl_yield", "osl", {}, "mu"},
      {"cantelaube_asymmetric_zero", "cantelaube_asymmetric", {{"branch", "zero"}}, ""},
      {"cantelaube_asymmetric_minus", "cantelaube_asymmetric", {{"branch", "minus"}}, ""},
      {"cantelaube_asymmetric_plus", "cantelaube_asymmetric", {{"branch", "plus"}}, ""},
      {"cantelaube_asymmetric_friction", "cantelaube_asymmetric", {}, "phi_deg"},
      {"cantelaube_asymmetric_flanks", "", {}, ""},
      {"layer_smooth", "layer", {{"base", "smooth"}}, ""},
      {"layer_rough", "layer", {{"base", "rough"}}, ""},
      {"orthotropic_layer_smooth", "orthotropic_layer", {{"base", "smooth"}}, ""},
      {"orthotropic_layer_rough", "orthotropic_layer", {{"base", "rough"}}, ""},
      {"osl_layer_absorbing", "osl_layer", {{"base", "absorbing"}}, ""},
      {"osl_layer_reflecting", "osl_layer", {{"base", "reflecting"}}, ""}};
  return all;
}

const FitName* find_fit_name(const std::string& name) {
  const auto& all = fit_names();
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const FitName& one) { return one.name == name; });
  return at == all.end() ? nullptr : &*at;
}

ModelChoice in_registry(ModelChoice choice) {
  const FitName* known = find_fit_name(choice.name);
  if (known == nullptr) return choice;
  if (known->registry.empty()) {
    throw continuum::BadParameter(
        fmt::format("model {}: is a description with numbers that only `grainfield fit` finds, "
                    "not a stress field of its own",
                    known->name));
  }
  for (const auto& [parameter, value] : known->fixed) {
    const auto [given, fresh] = choice.settings.emplace(parameter, value);
    if (!fresh && given->second != value) {
      throw continuum::BadParameter(
          fmt::format("model {}: found {} = {}, but the name says {}; write {}:{}={}", known->name,
                      parameter, given->second, value, known->registry, parameter, given->second));
    }
  }
  if (!known->needs.empty() && choice.settings.count(known->needs) == 0) {
    throw continuum::BadParameter(
        fmt::format("model {}: {} is missing, which `grainfield fit` finds; give it: {}:{}=...",
                    known->name, known->needs, known->name, known->needs));
  }
  choice.name = known->registry;
  return choice;
}

}  // namespace grainfield::coupling
