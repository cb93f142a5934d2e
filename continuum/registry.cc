#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "continuum/closed/models.h"
#include "continuum/fe/elastic.h"
#include "continuum/model.h"
#include "continuum/osl/models.h"
#include "continuum/settings.h"
#include "continuum/size.h"
#include "continuum/without_effect.h"

namespace grainfield::continuum {

const std::vector<ModelInfo>& registry() {
  static const std::vector<ModelInfo> models = {flamant_info(),
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
                                                cone_bcc_info(),
                                                osl_layer_info(),
                                                orthotropic_half_plane_info(),
                                                orthotropic_layer_info(),
                                                fe_elastic_layer_info(),
                                                fe_orthotropic_layer_info(),
                                                fe_elastic_half_space_info(),
                                                fe_transverse_layer_info(),
                                                fe_transverse_half_space_info(),
                                                fe_cantelaube_core_info(),
                                                fe_osl_wedge_info(),
                                                fe_osl_layer_info(),
                                                fe_mohr_coulomb_wedge_info(),
                                                fe_cone_info()};
  return models;
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
