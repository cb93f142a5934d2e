#include "continuum/fe/plugin.h"

/// Looked up by name in the loaded library (fe::kMakeSymbol).
extern "C" void grainfield_fe_make(const char* name,
                                   const grainfield::continuum::Settings& settings,
                                   grainfield::continuum::Ranks ranks,
                                   std::unique_ptr<grainfield::continuum::Model>& model) {
  grainfield::continuum::fe::choose_ranks(ranks);
  const std::string model_name = name;
  model = model_name.rfind("fe_osl_", 0) == 0
              ? grainfield::continuum::fe::make_osl_model(model_name, settings)
              : grainfield::continuum::fe::make_model(model_name, settings);
}
