// The one door of the finite-element library: the program loads it when a model of it is made.
#pragma once
#include <memory>
#include <string>

#include "continuum/fe/elastic.h"
#include "continuum/model.h"
#include "continuum/progress.h"

namespace grainfield::continuum::fe {

/// The named model ("fe_elastic_layer") with complete settings. Throws BadParameter.
std::unique_ptr<Model> make_model(const std::string& name, const Settings& settings);
/// "fe_orthotropic_layer" with complete settings. Throws BadParameter.
std::unique_ptr<Model> make_orthotropic_layer(const Settings& settings);
/// "fe_cantelaube_core" with complete settings. Throws BadParameter.
std::unique_ptr<Model> make_cantelaube_core(const Settings& settings);
/// The same for "fe_osl_wedge" and "fe_osl_layer".
std::unique_ptr<Model> make_osl_model(const std::string& name, const Settings& settings);

/// Who solves from now on; see continuum::solve_on.
void choose_ranks(Ranks ranks);

/// Its own copy of what continuum/progress.h holds is set by this one.
inline constexpr char kWatchSymbol[] = "grainfield_fe_watch";
using WatchFunction = void (*)(ProgressFunction watcher);

inline constexpr char kMakeSymbol[] = "grainfield_fe_make";
using MakeFunction = void (*)(const char* name, const Settings& settings, Ranks ranks,
                              std::unique_ptr<Model>& model);

}  // namespace grainfield::continuum::fe
