#include "continuum/fe/plugin.h"

#include "continuum/fe/block.h"

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

/// Likewise (fe::kBlockSymbol).
extern "C" void grainfield_fe_block(const grainfield::continuum::BlockMaterial& material,
                                    const Eigen::Matrix3d& initial_stress,
                                    const std::vector<grainfield::continuum::BlockLoad>& path,
                                    int cells,
                                    std::vector<grainfield::continuum::BlockState>& states) {
  states = grainfield::continuum::fe::solve_block(material, initial_stress, path, cells);
}

extern "C" void grainfield_fe_watch(grainfield::continuum::ProgressFunction watcher) {
  grainfield::continuum::watch_progress(watcher);
}
