// The one door of the finite-element library: the program loads it when a model of it is made.
#pragma once
#include <memory>
#include <string>

#include "continuum/fe_models.h"
#include "continuum/progress.h"

namespace grainfield::continuum::fe {

/// A model of the library: an object in the solver's file,
///     const ModelRow cone_row{"fe_cone", made<ConeModel>};
/// puts it among those that the library makes. Its ModelInfo is in a list of continuum/fe_models.h.
struct ModelRow {
  /// From its name and complete settings; throws BadParameter.
  using Make = std::unique_ptr<Model> (*)(const std::string& name, const Settings& settings);
  ModelRow(const std::string& name, Make make);
};

/// Makes a model of this class from its settings.
template <class Kind>
std::unique_ptr<Model> made(const std::string&, const Settings& settings) {
  return std::make_unique<Kind>(settings);
}

/// Who solves from now on; see continuum::solve_on.
void choose_ranks(Ranks ranks);

/// Its own copy of what continuum/progress.h holds is set by this one.
inline constexpr char kWatchSymbol[] = "grainfield_fe_watch";
using WatchFunction = void (*)(ProgressFunction watcher);

inline constexpr char kMakeSymbol[] = "grainfield_fe_make";
using MakeFunction = void (*)(const char* name, const Settings& settings, Ranks ranks,
                              std::unique_ptr<Model>& model);

}  // namespace grainfield::continuum::fe
