// Keys of superellipsoids that are drawn at random, as several sections have them.
#pragma once
#include "coupling/case/declare.h"

namespace grainfield::coupling {

/// The members that the keys set.
struct SuperellipsoidMembers {
  Binding axis_min, axis_max, exponent_min, exponent_max;
};

/// axis_min, axis_max, exponent_min, exponent_max; they have an effect where `shape`
/// ("sample.shape") is "superellipsoid".
void declare_superellipsoid_keys(SectionKeys& s, const std::string& shape,
                                 const SuperellipsoidMembers& where);

}  // namespace grainfield::coupling
