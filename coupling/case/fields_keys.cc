// Keys of averaged fields: [grains], where finished piles come from, and [fields].
#include "coupling/case/declare.h"
#include "coupling/fields/topic.h"
#include "coupling/strain/strain.h"

#define IN(TYPE, MEMBER) [](Case& c) -> TYPE& { return c.MEMBER; }

namespace grainfield::coupling {
namespace {

using std::string;
using Integer = std::int64_t;
using Numbers = std::vector<double>;
using Words = std::vector<string>;

void grains(Section s) {
  s.word("files", +IN(Words, grains.files), {},
         "finished piles, one a realization, in this order: snapshots.h5 of earlier runs of study "
         "pile or pile-fields; only the changes of gravity that they do not hold are computed. "
         "[material] must be that of the piles; [shape], [source] and [floor] are not used. []: "
         "the piles are poured");
  s.or_none();
}

void fields(Section s) {
  std::vector<string> names;
  string meaning = "what is looked at";
  for (const Topic& topic : topics()) {
    names.push_back(topic.name);
    meaning += (names.size() == 1 ? ": " : "; ") + topic.name + ": " + topic.meaning;
  }
  s.word("topics", +IN(Words, fields.topics), names, meaning);
  s.number("rve_diameters", "-", +IN(double, fields.rve_diameters), {0.1, 1000},
           "radius of the circular RVE in mean grain diameters; 6 holds about 110 grains; larger "
           "is smoother and sees less of the heap's edges",
           "Roul 2.7 (100-200 grains)");
  s.number("sizes", "-", +IN(Numbers, fields.sizes), {0.1, 1000},
           "radii that are tried, mean grain diameters", "Roul figs 2.8-2.10");
  s.only("fields.topics", {"rve_size"});
  s.number("tolerance", "-", +IN(double, fields.tolerance), {1e-6, 1},
           "an RVE is large enough when larger ones change its mean by less than half of "
           "this and it scatters between piles by less than this; smaller asks for larger RVEs");
  s.only("fields.topics", {"rve_size"});
  s.word("measure", +IN(string, fields.measure), strain_measures(),
         "strain of elastic, fabric and forces", "Roul 2.6.2, 3.8");
  s.only("fields.topics", {"elastic", "fabric", "forces"});
  s.number("columns", "-", +IN(Integer, fields.columns), {3, 2000},
           "points of the maps along x, over the whole heap");
  s.number("rows", "-", +IN(Integer, fields.rows), {3, 2000}, "points of the maps along y");
  s.number("heights", "-", +IN(Numbers, fields.heights), {1e-6, 1},
           "profiles at the map's rows nearest to these shares of the height above the base");
  s.number("resamples", "-", +IN(Integer, fields.resamples), {10, 100000},
           "draws of the bootstrap over realizations");
}

}  // namespace

void declare_grain_files_keys(std::vector<Key>& keys) { grains({keys, "grains"}); }

void declare_fields_keys(std::vector<Key>& keys) { fields({keys, "fields"}); }

}  // namespace grainfield::coupling

#undef IN
