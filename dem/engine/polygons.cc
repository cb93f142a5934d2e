// The engine for polygons, and disks among them.
#include "dem/engine/combine.h"
#include "dem/shapes/polygon_store.h"

namespace grainfield::dem {

template std::unique_ptr<Engine> engine_of<PolygonStore>(const EngineSettings& settings);

}  // namespace grainfield::dem
