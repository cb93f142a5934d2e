// Sections of grains that studies share: what they are made of, how they move, when they rest.
#pragma once
#include "coupling/case/declare.h"
#include "coupling/case/study.h"

namespace grainfield::coupling {

void declare_material_keys(SectionKeys s);
void declare_motion_keys(SectionKeys s);
void declare_rest_keys(SectionKeys s);

inline constexpr KeySection kMaterialKeys{"material", KeyRole::grains, declare_material_keys};
inline constexpr KeySection kMotionKeys{"motion", KeyRole::grains, declare_motion_keys};
inline constexpr KeySection kRestKeys{"rest", KeyRole::grains, declare_rest_keys};

/// The members that the keys set.
struct SuperellipsoidMembers {
  Binding axis_min, axis_max, exponent_min, exponent_max;
};

/// axis_min, axis_max, exponent_min, exponent_max; they have an effect where `shape`
/// ("sample.shape") is "superellipsoid".
void declare_superellipsoid_keys(SectionKeys& s, const std::string& shape,
                                 const SuperellipsoidMembers& where);

}  // namespace grainfield::coupling
