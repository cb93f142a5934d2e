#include "coupling/run/grain_keys.h"
#include "dem/shapes/superellipsoid.h"

namespace grainfield::coupling {

void declare_superellipsoid_keys(SectionKeys& s, const std::string& shape,
                                 const SuperellipsoidMembers& where) {
  constexpr const char* kSource = "Wellmann 25, 26";
  constexpr Range kAxis{0.05, 20}, kExponent{dem::kLeastExponent, dem::kMostExponent};
  const auto number = [&](const char* name, Binding member, Range range, const char* meaning) {
    s.number(name, "-", member, range, meaning, kSource);
    s.space();
    s.only(shape, {"superellipsoid"});
  };
  number("axis_min", where.axis_min, kAxis, "least semi-axis of a superellipsoid over its radius");
  number("axis_max", where.axis_max, kAxis,
         "largest one; each of the three is uniform between both");
  number("exponent_min", where.exponent_min, kExponent,
         "least exponent: 1 is an ellipsoid, below it faces are flat");
  number("exponent_max", where.exponent_max, kExponent,
         "largest one: above 1 there are edges; both of a grain are uniform between these");
}

}  // namespace grainfield::coupling
