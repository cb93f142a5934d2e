// Keys of the studies of solvers: [problem].
#include "coupling/studies/solvers/keys.h"

#include "coupling/case/declare.h"
#include "coupling/studies/solvers/setup.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(ProblemSetup, MEMBER)

namespace grainfield::coupling {

void declare_problem_keys(SectionKeys s) {
  s.number("force", "N", IN(force), kForce,
           "point load on the surface (2D: force as on one grain)");
  s.number("height", "m", IN(height), kLength,
           "height h of the layer or the heap; elastic-half-space has none", "Roul table 5.1");
  s.number("dim", "-", IN(dim), {2, 3},
           "2: plane strain, 3: space; models of the other dimension are left out");
  s.word("base", IN(base), {"smooth", "rough"},
         "elastic-layer, orthotropic-layer: base of every model that has one and does not set it",
         "Roul 5.5");
  s.number("depths", "m", IN(depths), kLength, "profiles below the surface");
  s.number("half_width", "m", IN(half_width), kLength,
           "profiles reach this far to either side of the load");
  s.number("points", "-", IN(points), {3, 10000}, "of a profile");
  s.number("r", "-", IN(r), {-1e6, 1e6},
           "(E_x/G - 2 nu_xy)/2, above -sqrt(t); isotropic: 1; a half plane has "
           "two peaks below 0",
           "Otto et al. 2003");
  s.number("t", "-", IN(t), {1e-6, 1e6}, "E_x/E_y; isotropic: 1", "Otto et al. 2003");
}

}  // namespace grainfield::coupling

#undef IN
