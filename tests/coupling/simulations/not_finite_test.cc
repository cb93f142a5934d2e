// The first number that is not finite ends a run, and a step that never gets anywhere is refused.
// The settings go round the ranges of the keys.
#include <gmock/gmock.h>

#include "coupling/studies/pile/simulation.h"
#include "coupling/studies/point_load/simulation.h"
#include "tests/coupling/pile_scene.h"
#include "tests/refusal.h"

namespace grainfield::dem {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

PointLoadSetup small_layer() {
  PointLoadSetup s;
  s.packing.kind = "triangular";
  s.packing.sizes = "mono";
  s.packing.columns = 8;
  s.packing.rows = 4;
  s.load.force = 5;
  s.load.ramp_time = 0;  // at once
  return s;
}

// What ComputationFailed says within two slices.
std::string failure(const PointLoadSetup& s) {
  const auto run = make_point_load_run(s, 3, 1);
  try {
    for (int k = 0; k < 2; ++k) {
      run->advance(300);
      run->progress();
    }
  } catch (const ComputationFailed& e) {
    return e.what();
  }
  return "nothing fails";
}

// Their moment of inertia is 0: the first turn is 0 times infinity. No search ever notices.
TEST(NotFinite, ASpinEndsTheRun) {
  PointLoadSetup s = small_layer();
  s.packing.radius = 1e-100;
  EXPECT_THAT(failure(s), AllOf(HasSubstr("diverged at t = "), HasSubstr("): grain "),
                                HasSubstr("m has a place, speed or spin that is not a finite "
                                          "number; lower motion.time_step (now 6.05e-103 s), "
                                          "damping or stiffness, or give grains of a usual size")));
}

TEST(NotFinite, AnEnergyEndsTheRun) {
  PointLoadSetup s = small_layer();
  s.material.young = 1e300;
  EXPECT_THAT(failure(s), AllOf(HasSubstr("the energy is not a finite number at t = "),
                                HasSubstr("elastic inf J; lower motion.time_step (now ")));
}

TEST(NotFinite, APlaceEndsTheRun) {
  PointLoadSetup s = small_layer();
  s.material.gravity = 1e308;
  EXPECT_THAT(failure(s), HasSubstr("diverged at t = "));
  // One of several grains: the engine names it.
  EngineSettings settings;
  settings.law = LinearLaw{};
  const auto engine = make_engine(settings);
  NewGrain g;
  g.radius = g.density = 1;
  for (int k = 0; k < 3; ++k) {
    engine->add(g);
    g.x += 10;
  }
  engine->step(1);
  engine->apply({1, std::nan(""), 0, 0, 0});
  for (int again = 0; again < 2; ++again) {
    try {
      engine->step(1);
      FAIL();
    } catch (const ComputationFailed& e) {
      EXPECT_THAT(e.what(), HasSubstr("grain 1 last seen near (10, 0) m has a place"));
    }
  }
}

TEST(NotFinite, StepsThatNobodyCanCountAreRefused) {
  PointLoadSetup layer = small_layer();
  layer.motion.time_step = 1e-300;
  layer.load.ramp_time = 0.05;
  EXPECT_THAT(refusal_of([&] { make_point_load_run(layer, 3, 1); }),
              AllOf(HasSubstr("load.ramp_time: found "),
                    HasSubstr("steps of 1e-300 s, see motion.time_step)")));
  layer = small_layer();
  layer.load.ramp_time = 1e300;
  EXPECT_THAT(refusal_of([&] { make_point_load_run(layer, 3, 1); }),
              HasSubstr("load.ramp_time: found 1e+300 s in all, allowed: at most "));
  PileSetup pile = small_pile("point", "disk");
  pile.motion.time_step = 1e-300;
  EXPECT_THAT(refusal_of([&] { make_pile_run(pile, 3, 1); }), HasSubstr("source.interval: found "));
  pile = small_pile("point", "disk");
  pile.change.gravity = {5};
  pile.change.method = "damped";
  pile.change.ramp_time = 1e300;
  EXPECT_THAT(refusal_of([&] { make_pile_run(pile, 3, 1); }),
              HasSubstr("change.ramp_time: found "));
}

}  // namespace
}  // namespace grainfield::dem
