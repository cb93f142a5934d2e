// The effect of a load on the grains of layers, and whether models of small changes apply.
#pragma once
#include <string>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Largest displacement of a grain that carries the load, over its radius. Throws
/// std::invalid_argument when the states have different numbers of grains.
double pushed_over_radius(const dem::Snapshot& unloaded, const dem::Snapshot& loaded);

/// The effect in all layers.
struct LoadEffect {
  double force = 0;                  ///< N
  double moved = 0;                  ///< largest displacement over the radius: mean over layers
  double changed = 0, contacts = 0;  ///< contacts that the load opened or closed, all: means
  std::vector<double> pushed{};      ///< pushed_over_radius of every layer
};
/// That grains rearrange, so no model applies, with `key` to lower; empty where they do not.
std::string rearrangement_doubt(const LoadEffect& effect, const std::string& key);

}  // namespace grainfield::coupling
