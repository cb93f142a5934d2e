// Keys of the studies of solvers: [elastic].
#include "coupling/studies/solvers/keys.h"

#include "coupling/case/declare.h"
#include "coupling/studies/solvers/setup.h"

// A key bound to the member of the same name: the default is that member's.
#define IN(TYPE, MEMBER) [](Case& c) -> TYPE& { return c.get<ElasticSetup>().MEMBER; }

namespace grainfield::coupling {
namespace {

using std::string;
using Integer = std::int64_t;
using Numbers = std::vector<double>;

}  // namespace

void declare_elastic_keys(SectionKeys s) {
  s.number("force", "N", +IN(double, force), kForce,
           "point load on the surface (2D: force as on one grain)");
  s.number("height", "m", +IN(double, height), kLength,
           "height h of the layer or the heap; elastic-half-space has none", "Roul table 5.1");
  s.number("dim", "-", +IN(Integer, dim), {2, 3},
           "2: plane strain, 3: space; models of the other dimension are left out");
  s.word("base", +IN(string, base), {"smooth", "rough"},
         "elastic-layer, orthotropic-layer: base of every model that has one and does not set it",
         "Roul 5.5");
  s.number("depths", "m", +IN(Numbers, depths), kLength, "profiles below the surface");
  s.number("half_width", "m", +IN(double, half_width), kLength,
           "profiles reach this far to either side of the load");
  s.number("points", "-", +IN(Integer, points), {3, 10000}, "of a profile");
  s.number("r", "-", +IN(double, r), {-1e6, 1e6},
           "(E_x/G - 2 nu_xy)/2, above -sqrt(t); isotropic: 1; a half plane has "
           "two peaks below 0",
           "Otto et al. 2003");
  s.number("t", "-", +IN(double, t), {1e-6, 1e6}, "E_x/E_y; isotropic: 1", "Otto et al. 2003");
}

}  // namespace grainfield::coupling

#undef IN
