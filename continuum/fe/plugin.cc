#include "continuum/fe/plugin.h"

#include <map>

#include "continuum/fe/block.h"

namespace grainfield::continuum::fe {
namespace {

std::map<std::string, ModelRow::Make>& rows() {
  static std::map<std::string, ModelRow::Make> all;
  return all;
}

}  // namespace

ModelRow::ModelRow(const std::string& name, Make make) { rows().emplace(name, make); }

}  // namespace grainfield::continuum::fe

/// Looked up by name in the loaded library (fe::kMakeSymbol).
extern "C" void grainfield_fe_make(const char* name,
                                   const grainfield::continuum::Settings& settings,
                                   grainfield::continuum::Ranks ranks,
                                   std::unique_ptr<grainfield::continuum::Model>& model) {
  grainfield::continuum::fe::choose_ranks(ranks);
  const auto& rows = grainfield::continuum::fe::rows();
  const auto row = rows.find(name);
  if (row == rows.end())
    throw grainfield::ComputationFailed("the finite-element library has no model " +
                                        std::string(name) + ": it is of another version");
  model = row->second(name, settings);
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
