// Keys of averaged fields: [fields].
#include "coupling/studies/pile_fields/keys.h"

#include "coupling/case/declare.h"
#include "coupling/strain/strain.h"
#include "coupling/studies/pile_fields/setup.h"
#include "coupling/studies/pile_fields/topic.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(FieldsSetup, MEMBER)

namespace grainfield::coupling {
namespace {

using std::string;

}  // namespace

void declare_fields_keys(SectionKeys s) {
  std::vector<string> names;
  string meaning = "what is looked at";
  for (const Topic& topic : topics()) {
    names.push_back(topic.name);
    meaning += (names.size() == 1 ? ": " : "; ") + topic.name + ": " + topic.meaning;
  }
  s.word("topics", IN(topics), names, meaning);
  s.number("rve_diameters", "-", IN(rve_diameters), {0.1, 1000},
           "radius of the circular RVE in mean grain diameters; 6 holds about 110 grains; larger "
           "is smoother and sees less of the heap's edges",
           "Roul 2.7 (100-200 grains)");
  s.number("sizes", "-", IN(sizes), {0.1, 1000}, "radii that are tried, mean grain diameters",
           "Roul figs 2.8-2.10");
  s.only("fields.topics", {"rve_size"});
  s.number("tolerance", "-", IN(tolerance), {1e-6, 1},
           "an RVE is large enough when larger ones change its mean by less than half of "
           "this and it scatters between piles by less than this; smaller asks for larger RVEs");
  s.only("fields.topics", {"rve_size"});
  s.word("measure", IN(measure), strain_measures(), "strain of elastic, fabric and forces",
         "Roul 2.6.2, 3.8");
  s.only("fields.topics", {"elastic", "fabric", "forces"});
  s.number("columns", "-", IN(columns), {3, 2000},
           "points of the maps along x, over the whole heap");
  s.number("rows", "-", IN(rows), {3, 2000}, "points of the maps along y");
  s.number("heights", "-", IN(heights), {1e-6, 1},
           "profiles at the map's rows nearest to these shares of the height above the base");
  s.number("resamples", "-", IN(resamples), {10, 100000},
           "draws of the bootstrap over realizations");
}

}  // namespace grainfield::coupling

#undef IN
