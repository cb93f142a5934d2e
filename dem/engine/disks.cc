// The engine for disks.
#include "dem/engine/combine.h"
#include "dem/shapes/disk_store.h"

namespace grainfield::dem {

template std::unique_ptr<Engine> engine_of<DiskStore>(const EngineSettings& settings);

}  // namespace grainfield::dem
