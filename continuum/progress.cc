#include "continuum/progress.h"

#include <atomic>

namespace grainfield::continuum {
namespace {

std::atomic<ProgressFunction> watching = nullptr;

}  // namespace

void watch_progress(ProgressFunction watcher) { watching = watcher; }

ProgressFunction progress_watcher() { return watching; }

void tell_progress(const std::string& task, double share) {
  if (const ProgressFunction watcher = watching) watcher(task, share);
}

}  // namespace grainfield::continuum
