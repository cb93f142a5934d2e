// The funnel of a point source: two immobile plates that grains slide down and fall between.
#pragma once
#include <vector>

#include "dem/engine/engine.h"
#include "dem/pouring/source_setup.h"

namespace grainfield::dem {

/// Width of the narrowest mouth that lets single grains through, in largest diameters.
inline constexpr double kLeastOpening = 1.5;

/// Height of the plates' upper ends above the mouth, m; 0 without a funnel (source.opening = 0).
double funnel_rise(const SourceSetup& source);
/// Half the width between the plates' upper ends, m; 0 without a funnel.
double funnel_half_width(const SourceSetup& source);
/// How far from the axis a grain of this radius may start between the upper ends, m.
double funnel_room(const SourceSetup& source, double radius);
/// Half the width of the whole funnel with its plates, m; 0 without one.
double funnel_half_span(const SourceSetup& source);
/// The left and the right plate, fixed: parallelograms at 60 degrees whose inner faces leave
/// source.opening free at source.height. Empty without a funnel.
std::vector<NewGrain> funnel_plates(const SourceSetup& source, double density);

}  // namespace grainfield::dem
