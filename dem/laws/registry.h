// Every contact law, by its word. A new one is a header beside this one and an entry in AnyLaw.
#pragma once
#include <variant>

#include "dem/laws/energy.h"
#include "dem/laws/hertz.h"
#include "dem/laws/hertz_elliptic.h"
#include "dem/laws/law.h"
#include "dem/laws/linear.h"
#include "dem/laws/overlap_area.h"
#include "dem/laws/penalty.h"
#include "dem/words/choice.h"

namespace grainfield::dem {

using AnyLaw =
    std::variant<OverlapAreaLaw, EnergyLaw, LinearLaw, HertzLaw, PenaltyLaw, HertzEllipticLaw>;

/// The law that the material names, with its numbers. Throws std::invalid_argument naming
/// material.law.
inline AnyLaw law_of(const MaterialSetup& material) {
  return kind_named<AnyLaw>("material.law", material.law,
                            [&]<LawEntry Law>() { return AnyLaw(Law::of(material)); });
}

/// Words of the laws that hold in D dimensions.
template <int D>
std::vector<std::string> laws_in() {
  return words_where<AnyLaw>([]<LawEntry Law>() { return ContactLaw<Law, D>; });
}

/// Words of the laws whose force grows with the width of a contact: those that polygons need.
inline std::vector<std::string> laws_that_feel_edges() {
  return words_where<AnyLaw>([]<LawEntry Law>() { return Law::edges != EdgeMeasure::none; });
}

}  // namespace grainfield::dem
