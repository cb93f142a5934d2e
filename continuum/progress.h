// How far a long solve is, for whoever waits for it.
#pragma once
#include <string>

namespace grainfield::continuum {

/// Told on the solving thread: who solves, and the share of the load that is there, 0 to 1.
using ProgressFunction = void (*)(const std::string& solver, double share);

/// From now on this function is told of every such solve; null: nobody.
void watch_progress(ProgressFunction watcher);
ProgressFunction progress_watcher();
void tell_progress(const std::string& solver, double share);

}  // namespace grainfield::continuum
