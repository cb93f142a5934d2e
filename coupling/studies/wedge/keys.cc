// Keys of the heap: [wedge].
#include "coupling/studies/wedge/keys.h"

#include "coupling/case/declare.h"
#include "coupling/studies/wedge/setup.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(WedgeSetup, MEMBER)

namespace grainfield::coupling {
namespace {

using std::string;

}  // namespace

void declare_wedge_keys(SectionKeys s) {
  s.number("phi_deg", "deg", IN(phi_deg), {1, 60}, "friction angle");
  s.number("left_deg", "deg", IN(left_deg), {1, 80}, "slope on the left");
  s.number("right_deg", "deg", IN(right_deg), {1, 80}, "slope on the right");
  s.number("rho_g", "N/m2", IN(rho_g), {1e-6, 1e9}, "weight of a unit area");
  s.number("height", "m", IN(height), kLength, "of the heap");
  s.number("depths", "-", IN(depths), {1e-6, 1},
           "profiles below the apex, as shares of the height; the base, 1, is always one");
  s.number("points", "-", IN(points), {11, 10000}, "of a profile");
  s.word("histories", IN(histories), {"at_once", "rise", "grow"},
         "every finite-element heap is solved for each of these, with each of dilations_deg and "
         "bases; empty: as its own settings say");
  s.or_none();
  s.number("dilations_deg", "deg", IN(dilations_deg), {0, 60}, "likewise");
  s.or_none();
  s.word("bases", IN(bases), {},
         "likewise: rough, smooth, or the friction angle of a frictional base, e.g. \"20\"");
  s.or_none();
}

}  // namespace grainfield::coupling

#undef IN
