#include "coupling/fit/study.h"

#include <chrono>
#include <memory>

#include "coupling/fit/heap_result.h"
#include "coupling/run/finished_runs.h"

namespace grainfield::coupling {
namespace {

// The piles as they are.
dem::PileSetup setup_of(const Case& value) {
  dem::PileSetup setup = value.pile;
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
  const auto start = std::chrono::steady_clock::now();
  StudyResult out =
      heap_result(value, heap_data(value.fit, heaps_of_runs(files), threads), threads);
  out.realizations = files;
  add_identity(out.summary, value);
  out.summary["time.analysis_s"] =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace

Study pile_fit_study() {
  Study out;
  out.name = "pile-fit";
  out.meaning = "stress models fitted to piles and ranked: Cantelaube, OSL, hydrostatic";
  out.sections = {"grains", "shape", "source", "floor",    "material",
                  "motion", "rest",  "sleep",  "ensemble", "fit"};
  out.without = {"compare.models"};
  out.models_optional = true;
  out.make_run = make_run;
  out.foresee = foresee;
  out.analyse = analyse;
  return out;
}

}  // namespace grainfield::coupling
