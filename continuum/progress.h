// How far a long computation is, for whoever waits for it.
#pragma once
#include <string>

namespace grainfield::continuum {

/// Told on the computing thread: what is computed ("fe_cone"), and the share of it that is done, 0
/// to 1; of a solve in steps the share of its load.
using ProgressFunction = void (*)(const std::string& task, double share);

/// From now on this function is told of every such computation; null: nobody.
void watch_progress(ProgressFunction watcher);
ProgressFunction progress_watcher();
void tell_progress(const std::string& task, double share);

}  // namespace grainfield::continuum
