// How far a grain reaches. The one place of averaging that knows a grain's shape.
#pragma once
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Heights and abscissas of a grain's edges, m.
inline double top_of(const dem::Grain& grain) { return grain.position.y() + grain.radius; }
inline double bottom_of(const dem::Grain& grain) { return grain.position.y() - grain.radius; }
inline double left_of(const dem::Grain& grain) { return grain.position.x() - grain.radius; }
inline double right_of(const dem::Grain& grain) { return grain.position.x() + grain.radius; }

}  // namespace grainfield::coupling
