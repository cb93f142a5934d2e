#include "continuum/fe/plugin.h"

/// Looked up by name in the loaded library (fe::kMakeSymbol).
extern "C" void grainfield_fe_make(const char* name,
                                   const grainfield::continuum::Settings& settings,
                                   grainfield::continuum::Ranks ranks,
                                   std::unique_ptr<grainfield::continuum::Model>& model) {
  grainfield::continuum::fe::choose_ranks(ranks);
  model = grainfield::continuum::fe::make_model(name, settings);
}
