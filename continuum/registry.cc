#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "continuum/closed/models.h"
#include "continuum/fe_models.h"
#include "continuum/model.h"
#include "continuum/osl/models.h"
#include "continuum/own_models.h"
#include "continuum/settings.h"
#include "continuum/size.h"
#include "continuum/without_effect.h"

namespace grainfield::continuum {

namespace {

std::vector<ModelInfo> shipped_models() {
  std::vector<ModelInfo> all{flamant_info(),
                             boussinesq_info(),
                             transverse_half_space_info(),
                             transverse_layer_info(),
                             layer_info(),
                             hydrostatic_info(),
                             liffman_info(),
                             cantelaube_info(),
                             cantelaube_asymmetric_info(),
                             osl_info(),
                             fpa_info(),
                             bcc_info(),
                             ife_info(),
                             cone_osl_info(),
                             cone_fpa_info(),
                             cone_fpa_levy_info(),
                             cone_bcc_info(),
                             osl_layer_info(),
                             orthotropic_half_plane_info(),
                             orthotropic_layer_info()};
  for (const auto& group : {elastic_models(), osl_models(), heap_models()})
    all.insert(all.end(), group.begin(), group.end());
  return all;
}

// Never destroyed: added models may hold what ends before this library.
std::vector<ModelInfo>& all_models() {
  static auto* const models = new std::vector(shipped_models());
  return *models;
}

void require_plain_name(const std::string& name) {
  const auto plain = [](char ch) {
    return std::isalnum(static_cast<unsigned char>(ch)) || ch == '_';
  };
  if (!name.empty() && std::all_of(name.begin(), name.end(), plain)) return;
  throw BadParameter(
      fmt::format("model: found the name '{}', allowed: letters, digits and _", name));
}

}  // namespace

const std::vector<ModelInfo>& registry() { return all_models(); }

void add_own_model(ModelInfo info) {
  static const auto shipped = static_cast<std::ptrdiff_t>(all_models().size());
  std::vector<ModelInfo>& models = all_models();
  require_plain_name(info.name);
  const auto there = std::find_if(models.begin(), models.end(),
                                  [&](const ModelInfo& one) { return one.name == info.name; });
  if (there - models.begin() < shipped)
    throw BadParameter(fmt::format(
        "model: found the name '{}', which grainfield's own model has, allowed: another",
        info.name));
  if (there == models.end()) {
    models.push_back(std::move(info));
  } else {
    *there = std::move(info);
  }
}

const ModelInfo& find_model(const std::string& name) {
  std::vector<std::string> names;
  for (const auto& info : registry()) {
    if (info.name == name) return info;
    names.push_back(info.name);
  }
  throw BadParameter(fmt::format("no model '{}'; did you mean '{}'? known: {}", name,
                                 nearest(name, names), fmt::join(names, ", ")));
}

int dimension(const ModelInfo& info, const Settings& settings) {
  return info.dim != 0 ? info.dim : static_cast<int>(number_of(complete(info, settings), "dim"));
}

std::unique_ptr<Model> make_model(const std::string& name, const Settings& settings) {
  const ModelInfo& info = find_model(name);
  if (const auto found = find_without_effect(info, settings)) throw BadParameter(found->refusal);
  const Settings full = complete(info, settings);
  require_possible(info, full);
  return info.make(full);
}

}  // namespace grainfield::continuum
