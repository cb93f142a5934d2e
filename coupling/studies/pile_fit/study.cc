// Study "pile-fit": stress models fitted to poured or finished piles, and ranked.
#include "coupling/case/study.h"

#include <memory>

#include "coupling/fit/figures.h"
#include "coupling/fit/heap_result.h"
#include "coupling/observe/setup.h"
#include "coupling/run/study_result.h"
#include "coupling/studies/pile/pile_run.h"
#include "coupling/studies/pile_fit/keys.h"
#include "dem/study/setup.h"

namespace grainfield::coupling {
namespace {

// The piles as they are.
dem::PileSetup setup_of(const Case& value) {
  dem::PileSetup setup = value.get<dem::PileSetup>();
  setup.change.gravity.clear();
  return setup;
}

std::unique_ptr<dem::Run> make_run(const Case& value, std::int64_t number, int threads) {
  return make_pile(value, setup_of(value), number, threads);
}

dem::Outlook foresee(const Case& value, std::int64_t draws) {
  return foresee_pile(value, setup_of(value), draws);
}

StudyResult analyse(const Case& value, const std::vector<std::string>& files, int threads) {
  const auto observe = [&](const FitSetup& setup) {
    return observe_heaps(setup, heaps_of_runs(files), threads);
  };
  StudyResult out = heap_result(value, observe(value.get<FitSetup>()), threads, observe).study;
  out.realizations = files;
  add_identity(out.summary, value);
  return out;
}

}  // namespace

Study pile_fit_study() {
  Study out;
  out.name = "pile-fit";
  out.meaning = "stress models fitted to piles and ranked: Cantelaube, OSL, hydrostatic";
  describe_piles(out);
  out.sections.push_back(kFitKeys);
  out.figures.push_back(figures_of_fits);
  out.without = {"compare.models"};
  out.make_run = make_run;
  out.foresee = foresee;
  out.analyse = analyse;
  return out;
}

}  // namespace grainfield::coupling
