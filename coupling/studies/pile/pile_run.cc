#include "coupling/studies/pile/pile_run.h"

#include "coupling/run/ensemble.h"
#include "coupling/run/finished_runs.h"
#include "coupling/run/grain_keys.h"
#include "coupling/studies/pile/keys.h"
#include "coupling/studies/pile/simulation.h"

namespace grainfield::coupling {

std::unique_ptr<dem::Run> make_pile(const Case& value, const dem::PileSetup& setup,
                                    std::int64_t number, int threads) {
  if (value.get<GrainFiles>().files.empty()) {
    return dem::make_pile_run(setup, realization_seed(value, number), threads);
  }
  const FinishedRun pile = finished_run(value, number, {"pile"}, "pile");
  return dem::make_pile_change_run(setup, pile.file, pile.group, threads);
}

dem::Outlook foresee_pile(const Case& value, const dem::PileSetup& setup, std::int64_t draws) {
  if (value.get<GrainFiles>().files.empty()) {
    return dem::foresee_pile(setup, realization_seeds(value), draws);
  }
  try_finished_runs(value, {"pile"}, "pile", [&](const FinishedRun& pile) {
    dem::make_pile_change_run(setup, pile.file, pile.group, 1);
  });
  return dem::foresee_changes(setup.change);
}

void describe_piles(Study& out) {
  out.sections = {kGrainFilesKeys, kMaterialKeys, kMotionKeys, kRestKeys,
                  kShapeKeys,      kSourceKeys,   kFloorKeys,  kSleepKeys};
  out.material = [](Case& c) -> dem::MaterialSetup& { return c.get<dem::PileSetup>().material; };
  out.grain_radius = [](const Case& c) { return c.get<dem::PileSetup>().shape.radius; };
  out.motion = [](Case& c) -> dem::MotionSetup& { return c.get<dem::PileSetup>().motion; };
  out.rest = [](Case& c) -> dem::RestSetup& { return c.get<dem::PileSetup>().rest; };
  out.figures = {pile_figures};
  out.models_optional = true;
  out.left_unused = [](const Case& value) { return unused_runs(value, {"pile"}, "pile"); };
  out.longest_part = [](const Case& value, const dem::Outlook& outlook) -> LongestPart {
    if (outlook.time_key != "source.interval") return {};
    if (!value.get<dem::PileSetup>().sleep.on) return {"pouring", ""};
    return {"pouring",
            "; sleeping makes it less, several times when a pile is large and poured slowly"};
  };
}

}  // namespace grainfield::coupling
