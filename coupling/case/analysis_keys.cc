// Keys of everything around the grains: the study, ensemble, averaging, models, output, sweep.
#include "coupling/case/apply.h"
#include "coupling/case/declare.h"
#include "coupling/run/studies.h"

#define IN(TYPE, MEMBER) [](Case& c) -> TYPE& { return c.MEMBER; }

namespace grainfield::coupling {
namespace {

using std::string;
using Numbers = std::vector<double>;
using Words = std::vector<string>;
using Integer = std::int64_t;

void top(Section s) {
  s.word("title", +IN(string, title), {}, "one line for people: what the study shows");
  std::vector<string> names;
  string meaning = "kind of study";
  for (const Study& study : studies()) {
    names.push_back(study.name);
    meaning += (names.size() == 1 ? ": " : "; ") + study.name + ": " + study.meaning;
  }
  s.word("study", +IN(string, study), names, meaning);
}

void ensemble(Section s) {
  s.number("realizations", "-", +IN(Integer, ensemble.realizations), {1, 10000},
           "independent packings; the standard error falls with the square root of their number");
  s.number("seed", "-", +IN(Integer, ensemble.seed), {0, 9007199254740992.0},
           "every realization derives its own seed from this one and its number");
}

void average(Section s) {
  s.word("methods", +IN(Words, average.methods),
         {"coarse_graining", "particle_centre", "area_exact"},
         "averagings to report; the first one is compared with the models",
         "Weinhart et al. 2012; Roul 2.6");
  s.word("kernel", +IN(string, average.kernel), {"lucy", "gaussian", "heaviside"}, "the weight",
         "Weinhart et al. 2012");
  s.only("average.methods", {"coarse_graining"});
  s.number("width", "m", +IN(double, average.width), kLength.with_zero(),
           "w of the kernel (lucy ends at 2 w); wider is smoother and blurs "
           "peaks; 0: width_diameters mean diameters");
  s.only("average.methods", {"coarse_graining"});
  s.number("width_diameters", "-", +IN(double, average.width_diameters), {0.01, 100},
           "the same in mean grain diameters, used where width is 0");
  s.only("average.width", {"0.0"});
  s.word("rve_shape", +IN(string, average.rve_shape), {"circle", "square"},
         "shape of the representative volume element");
  s.only("average.methods", {"particle_centre", "area_exact"});
  s.number("rve_radius", "m", +IN(double, average.rve_radius), kLength.with_zero(),
           "radius or half side; larger is smoother; 0: rve_diameters mean "
           "diameters",
           "Roul 3.2");
  s.only("average.methods", {"particle_centre", "area_exact"});
  s.number("rve_diameters", "-", +IN(double, average.rve_diameters), {0.01, 100},
           "the same in mean grain diameters, used where rve_radius is 0");
  s.only("average.rve_radius", {"0.0"});
  s.number("depths", "-", +IN(Numbers, average.depths), {1e-6, 1},
           "profiles below the surface, as shares of the layer's height; the base is always added");
  s.number("points", "-", +IN(Integer, average.points), {3, 10000}, "of a profile");
  s.number("half_width", "m", +IN(double, average.half_width), kLength.with_zero(),
           "profiles reach this far to either side of the load; 0: to the nearer side wall");
  s.number("map_columns", "-", +IN(Integer, average.map_columns), {2, 2000},
           "points of the maps along x");
  s.number("map_rows", "-", +IN(Integer, average.map_rows), {2, 2000},
           "points of the maps along y");
}

void elastic(Section s) {
  s.number("force", "N", +IN(double, elastic.force), kForce,
           "point load on the surface (2D: force as on one grain)");
  s.number("height", "m", +IN(double, elastic.height), kLength,
           "height h of the layer or the heap; elastic-half-space has none", "Roul table 5.1");
  s.number("dim", "-", +IN(Integer, elastic.dim), {2, 3},
           "2: plane strain, 3: space; models of the other dimension are left out");
  s.word("base", +IN(string, elastic.base), {"smooth", "rough"},
         "elastic-layer, orthotropic-layer: base of every model that has one and does not set it",
         "Roul 5.5");
  s.number("depths", "m", +IN(Numbers, elastic.depths), kLength, "profiles below the surface");
  s.number("half_width", "m", +IN(double, elastic.half_width), kLength,
           "profiles reach this far to either side of the load");
  s.number("points", "-", +IN(Integer, elastic.points), {3, 10000}, "of a profile");
  s.number("r", "-", +IN(double, elastic.r), {-1e6, 1e6},
           "(E_x/G - 2 nu_xy)/2, above -sqrt(t); isotropic: 1; a half plane has "
           "two peaks below 0",
           "Otto et al. 2003");
  s.number("t", "-", +IN(double, elastic.t), {1e-6, 1e6}, "E_x/E_y; isotropic: 1",
           "Otto et al. 2003");
}

void wedge(Section s) {
  s.number("phi_deg", "deg", +IN(double, wedge.phi_deg), {1, 60}, "friction angle");
  s.number("left_deg", "deg", +IN(double, wedge.left_deg), {1, 80}, "slope on the left");
  s.number("right_deg", "deg", +IN(double, wedge.right_deg), {1, 80}, "slope on the right");
  s.number("rho_g", "N/m2", +IN(double, wedge.rho_g), {1e-6, 1e9}, "weight of a unit area");
  s.number("height", "m", +IN(double, wedge.height), kLength, "of the heap");
  s.number("depths", "-", +IN(Numbers, wedge.depths), {1e-6, 1},
           "profiles below the apex, as shares of the height; the base, 1, is always one");
  s.number("points", "-", +IN(Integer, wedge.points), {11, 10000}, "of a profile");
  s.word("histories", +IN(Words, wedge.histories), {"at_once", "rise", "grow"},
         "every finite-element heap is solved for each of these, with each of dilations_deg and "
         "bases; empty: as its own settings say");
  s.or_none();
  s.number("dilations_deg", "deg", +IN(Numbers, wedge.dilations_deg), {0, 60}, "likewise");
  s.or_none();
  s.word("bases", +IN(Words, wedge.bases), {},
         "likewise: rough, smooth, or the friction angle of a frictional base, e.g. \"20\"");
  s.or_none();
}

void compare(Section s) {
  s.word(
      "models", +[](Case& c) -> Words& { return model_names(c); }, {},
      "models by name (`grainfield model` lists them) or by the label of a [model.LABEL] table, "
      "which may set name = \"...\" and the model's parameters; F, h, dim, depth (and base of "
      "elastic-layer; base, r and t of orthotropic-layer) are filled from the run unless set");
  s.or_none();
}

void output(Section s) {
  s.flag("snapshots", +IN(bool, output.snapshots), "snapshots.h5: grains and contacts");
  s.flag("vtu", +IN(bool, output.vtu), "VTU files of the first realization for ParaView");
  s.flag("fields", +IN(bool, output.fields), "fields.h5 and .xdmf: averaged and modelled fields");
  s.flag("report", +IN(bool, output.report), "report.html");
}

void sweep(Section s) {
  s.word(
      "key", +IN(string, sweep.key), {},
      "the case is run once for every value of this key; empty: no sweep; variant: once for every "
      "named set of keys of tables [variant.NAME.SECTION]");
  s.word("values", +IN(Words, sweep.values), {}, "values of that key");
  s.or_none();
}

}  // namespace

void declare_analysis_keys(std::vector<Key>& keys) {
  top({keys, ""});
  ensemble({keys, "ensemble"});
  average({keys, "average"});
  elastic({keys, "elastic"});
  wedge({keys, "wedge"});
  compare({keys, "compare"});
  output({keys, "output"});
  sweep({keys, "sweep"});
}

}  // namespace grainfield::coupling

#undef IN
