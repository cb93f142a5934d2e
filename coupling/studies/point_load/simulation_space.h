// A point load on a layer of spheres.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "coupling/studies/point_load/simulation.h"
#include "dem/engine/engine.h"
#include "dem/grains/grain_family.h"
#include "dem/run/run.h"

namespace grainfield::dem {

/// Settings of its engine. `grains`: those of superellipsoids, `reserve`: engine_settings, where
/// not all of them were drawn. Throws as make_point_load_run.
EngineSettings space_load_settings(const PointLoadSetup& setup, int threads,
                                   const std::vector<ShapedGrain>& grains = {}, double reserve = 1);

/// As make_point_load_run, of packing.dim = 3: snapshots "unloaded" and "loaded".
std::unique_ptr<Run> make_space_load_run(const PointLoadSetup& setup, std::uint64_t seed,
                                         int threads);

}  // namespace grainfield::dem
