// Particle-steps per second of superellipsoids beside spheres: all awake and in contact, in a cell
// that repeats itself.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "dem/engine/engine.h"
#include "dem/study/sample_grains.h"

namespace grainfield::dem {
namespace {

enum class Kind { spheres, round, ellipsoids, superellipsoids };

/// Loose grains, compressed to the solid fraction of the source's sample and damped.
std::unique_ptr<Engine> packing(Kind kind, const AnyLaw& law, int threads) {
  SamplePlan plan;
  plan.dim = 3;
  plan.shape = kind == Kind::spheres ? "sphere" : "superellipsoid";
  plan.radius = 1;
  plan.grains = 1600;
  plan.sizes = "uniform";
  plan.start_fraction = 0.12;
  if (kind == Kind::round) plan.axis_min = plan.axis_max = 1;
  if (kind != Kind::superellipsoids) plan.exponent_min = plan.exponent_max = 1;
  Random random(3);
  const std::vector<ShapedGrain> grains = draw_sample(plan, random);
  const auto box = sample_box(plan, total_area(grains));
  EngineSettings s;
  s.law = law;
  s.shape = kind == Kind::spheres ? ShapeKind::sphere : ShapeKind::superellipsoid;
  s.friction = 0.25;
  s.gravity_y = 0;
  s.threads = threads;
  s.cell.periodic = {true, true, true};
  for (int a = 0; a < 3; ++a) s.cell.edges(a, a) = box[a];
  s.time_step = stable_time_step(s, sample_extremes(plan, 1, grains).least_mass,
                                 sample_extremes(plan, 1, grains).least_radius);
  auto engine = make_engine(s);
  for (const NewGrain& g : place_sample(plan, grains, box, 1, random)) engine->add(g);
  constexpr double kDense = 0.66;
  const double rate = 1, strain = std::log(kDense / plan.start_fraction) / 3;
  engine->set_velocity_gradient(-rate * Eigen::Matrix3d::Identity());
  engine->set_background_damping(5);
  engine->step(static_cast<long>(strain / rate / s.time_step));
  engine->set_velocity_gradient(Eigen::Matrix3d::Zero());
  engine->step(2000);
  return engine;
}

void steps(benchmark::State& state, Kind kind, const AnyLaw& law) {
  const auto engine = packing(kind, law, static_cast<int>(state.range(0)));
  constexpr long kSteps = 100;
  for (auto _ : state) engine->step(kSteps);
  state.SetItemsProcessed(state.iterations() * kSteps * engine->grains());
  const Diagnostics d = engine->measure();
  state.counters["contacts_per_grain"] = 2.0 * d.contacts / engine->grains();
}

const PenaltyLaw kPenalty{1e4, 1e4, 1};
const HertzEllipticLaw kHertz{1e5, 0.22, 1};

BENCHMARK_CAPTURE(steps, spheres_penalty, Kind::spheres, AnyLaw(kPenalty))->Arg(1)->UseRealTime();
BENCHMARK_CAPTURE(steps, round_penalty, Kind::round, AnyLaw(kPenalty))->Arg(1)->UseRealTime();
BENCHMARK_CAPTURE(steps, ellipsoids_penalty, Kind::ellipsoids, AnyLaw(kPenalty))
    ->Arg(1)
    ->UseRealTime();
BENCHMARK_CAPTURE(steps, superellipsoids_penalty, Kind::superellipsoids, AnyLaw(kPenalty))
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime();
BENCHMARK_CAPTURE(steps, spheres_hertz, Kind::spheres, AnyLaw(kHertz))->Arg(1)->UseRealTime();
BENCHMARK_CAPTURE(steps, superellipsoids_hertz, Kind::superellipsoids, AnyLaw(kHertz))
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime();

}  // namespace
}  // namespace grainfield::dem
