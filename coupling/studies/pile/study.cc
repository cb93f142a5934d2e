#include "coupling/studies/pile/study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupling/fit/fit_keys.h"
#include "coupling/models/subject.h"
#include "coupling/observe/setup.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/measured_base.h"
#include "coupling/specimen/setup.h"
#include "coupling/studies/pile/keys.h"
#include "coupling/studies/pile/pile_run.h"
#include "coupling/studies/pile/simulation.h"

namespace grainfield::coupling {

Study pile_study() {
  Study out;
  out.name = "pile";
  out.meaning =
      "grains poured into a pile: base pressure and dip, repose, stress and density, and stress "
      "models compared with them or fitted to them";
  out.former = {
      {"pile-fit", {fmt::format("fit.models=[\"{}\"]", fmt::join(kUsualHeapModels, "\", \""))}}};
  describe_piles(out);
  out.sections.push_back(kChangeKeys);
  out.sections.push_back(kAverageKeys);
  out.sections.push_back(kHeapKeys);
  fit_heap_models(out);
  out.sections.push_back(kMeasuredKeys);
  out.figures.push_back(measured_figures);
  out.check = [](const Case& value) {
    check_heap_windows(value.get<HeapSetup>());
    require_subject(value.models, Subject::heap, 2, "compare.models");
    check_fit(value);
    const MeasuredSetup& measured = value.get<MeasuredSetup>();
    if (!measured.field.empty()) measured_base(measured);
  };
  out.averaged = [](const Case& value) {
    return averaged_values(value.get<AverageSetup>(), value.get<HeapSetup>().heights.size() + 1);
  };
  out.without = {"average.depths", "average.half_width", "fit.base", "fit.coverage",
                 "fit.coverage_draws"};
  out.fills = {"rho_g", "phi_deg", "left_deg", "right_deg", "h", "dim", "depth"};
  out.make_run = [](const Case& value, std::int64_t number, int threads) {
    return make_pile(value, value.get<dem::PileSetup>(), number, threads);
  };
  out.foresee = [](const Case& value, std::int64_t draws) {
    return foresee_pile(value, value.get<dem::PileSetup>(), draws);
  };
  out.analyse = analyse_pile;
  return out;
}

}  // namespace grainfield::coupling
