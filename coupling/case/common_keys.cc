#include "coupling/case/common_keys.h"

#include "coupling/case/apply.h"
#include "coupling/case/declare.h"
#include "coupling/case/study.h"

#define IN(MEMBER)         \
  +[](Case & c) -> auto& { \
    return c.MEMBER;       \
  }

namespace grainfield::coupling {
namespace {

using std::string;
using Words = std::vector<string>;

void top(SectionKeys s) {
  s.word("title", IN(title), {}, "one line for people: what the study shows");
  std::vector<string> names;
  string meaning = "kind of study";
  for (const Study& study : studies()) {
    names.push_back(study.name);
    meaning += (names.size() == 1 ? ": " : "; ") + study.name + ": " + study.meaning;
  }
  s.word("study", IN(study), names, meaning);
}

void ensemble(SectionKeys s) {
  s.number("realizations", "-", IN(ensemble.realizations), {1, 10000},
           "independent packings; the standard error falls with the square root of their number");
  s.number("seed", "-", IN(ensemble.seed), {0, 9007199254740992.0},
           "every realization derives its own seed from this one and its number");
}

void compare(SectionKeys s) {
  s.word(
      "models", +[](Case& c) -> Words& { return model_names(c); }, {},
      "models by name (`grainfield model` lists them) or by the label of a [model.LABEL] table, "
      "which may set name = \"...\" and the model's parameters; F, h, dim, depth (and base of "
      "elastic-layer; base, r and t of orthotropic-layer) are filled from the run unless set");
  s.or_none();
}

void output(SectionKeys s) {
  s.flag("snapshots", IN(output.snapshots), "snapshots.h5: grains and contacts");
  s.flag("vtu", IN(output.vtu), "VTU files of the first realization for ParaView");
  s.flag("fields", IN(output.fields), "fields.h5 and .xdmf: averaged and modelled fields");
  s.flag("report", IN(output.report), "report.html");
}

void sweep(SectionKeys s) {
  s.word(
      "key", IN(sweep.key), {},
      "the case is run once for every value of this key; empty: no sweep; variant: once for every "
      "named set of keys of tables [variant.NAME.SECTION]");
  s.word("values", IN(sweep.values), {}, "values of that key");
  s.or_none();
}

}  // namespace

void declare_first_keys(std::vector<Key>& keys) {
  top({keys, ""});
  ensemble({keys, "ensemble"});
}

void declare_last_keys(std::vector<Key>& keys) {
  compare({keys, "compare"});
  output({keys, "output"});
  sweep({keys, "sweep"});
}

}  // namespace grainfield::coupling

#undef IN
