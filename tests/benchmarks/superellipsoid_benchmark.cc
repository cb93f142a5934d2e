// Grain-steps per second of superellipsoids beside spheres and ellipsoids: the source's number of
// grains, 1,609, and 10,000, all awake and in contact, in a cell that repeats itself. A packing is
// made once a program, or once a folder GRAINFIELD_PACKINGS, where it is kept.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numbers>

#include "coupling/studies/sample/simulation/grains.h"
#include "dem/engine/engine.h"
#include "dem/motion/runge_kutta3.h"
#include "tests/dem/gas_scene.h"
#include "tests/dem/top_scene.h"

namespace grainfield::dem {
namespace {

enum class Kind { spheres, round, ellipsoids, superellipsoids };

constexpr int kGrains = 1609, kMany = 10000;
constexpr double kStartFraction = 0.12, kDense = 0.66;

struct Scene {
  EngineSettings settings;
  std::vector<NewGrain> loose;
};
Scene scene(Kind kind, const AnyLaw& law, int count) {
  SamplePlan plan;
  plan.dim = 3;
  plan.shape = kind == Kind::spheres ? "sphere" : "superellipsoid";
  plan.radius = 1;
  plan.grains = count;
  plan.sizes = "uniform";
  plan.start_fraction = kStartFraction;
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
  s.cell.periodic = {true, true, true};
  for (int a = 0; a < 3; ++a) s.cell.edges(a, a) = box[a];
  s.time_step = stable_time_step(s, sample_extremes(plan, 1, grains).least_mass,
                                 sample_extremes(plan, 1, grains).least_radius);
  return {s, place_sample(plan, grains, box, 1, random)};
}

/// Loose grains, compressed to the solid fraction of the source's sample and damped.
Snapshot packed(const Scene& scene) {
  const auto engine = make_engine(scene.settings);
  for (const NewGrain& g : scene.loose) engine->add(g);
  const double rate = 1, strain = std::log(kDense / kStartFraction) / 3;
  engine->set_velocity_gradient(-rate * Eigen::Matrix3d::Identity());
  engine->set_background_damping(5);
  engine->step(static_cast<long>(strain / rate / scene.settings.time_step));
  engine->set_velocity_gradient(Eigen::Matrix3d::Zero());
  engine->step(2000);
  return engine->snapshot();
}
const Snapshot& packing(const std::string& name, const Scene& scene) {
  static std::map<std::string, Snapshot> packings;
  if (packings.contains(name)) return packings[name];
  const char* folder = std::getenv("GRAINFIELD_PACKINGS");
  const std::string file = folder == nullptr ? "" : folder + ("/" + name + ".h5");
  if (!file.empty() && std::filesystem::exists(file)) {
    return packings[name] = read_snapshot(file, "packing");
  }
  packings[name] = packed(scene);
  if (!file.empty()) write_snapshot(file, "packing", packings[name]);
  return packings[name];
}

void steps(benchmark::State& state, const char* name, Kind kind, const AnyLaw& law,
           IntegratorKind integrator = IntegratorKind::verlet, int count = kGrains) {
  Scene start = scene(kind, law, count);
  start.settings.integrator = integrator;
  const Snapshot& dense = packing(name, start);
  start.settings.cell = dense.cell;
  start.settings.cell.velocity_gradient.setZero();
  start.settings.threads = static_cast<int>(state.range(0));
  const auto engine = make_engine(start.settings, dense);
  engine->step(200);
  constexpr long kSteps = 100;
  for (auto _ : state) engine->step(kSteps);
  const auto done = static_cast<double>(state.iterations() * kSteps * engine->grains());
  state.counters["grain_steps"] = benchmark::Counter(done, benchmark::Counter::kIsRate);
  const Diagnostics d = engine->measure();
  state.counters["contacts_per_grain"] = 2.0 * d.contacts / engine->grains();
}

const PenaltyLaw kPenalty{1e4, 1e4, 1};
const HertzEllipticLaw kHertz{1e5, 0.22, 1};

BENCHMARK_CAPTURE(steps, spheres_penalty, "spheres_penalty", Kind::spheres, AnyLaw(kPenalty))
    ->Arg(1)
    ->UseRealTime();
BENCHMARK_CAPTURE(steps, round_penalty, "round_penalty", Kind::round, AnyLaw(kPenalty))
    ->Arg(1)
    ->UseRealTime();
BENCHMARK_CAPTURE(steps, ellipsoids_penalty, "ellipsoids_penalty", Kind::ellipsoids,
                  AnyLaw(kPenalty))
    ->Arg(1)
    ->UseRealTime();
BENCHMARK_CAPTURE(steps, superellipsoids_penalty, "superellipsoids_penalty", Kind::superellipsoids,
                  AnyLaw(kPenalty))
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime();
BENCHMARK_CAPTURE(steps, spheres_hertz, "spheres_hertz", Kind::spheres, AnyLaw(kHertz))
    ->Arg(1)
    ->UseRealTime();
BENCHMARK_CAPTURE(steps, ellipsoids_hertz, "ellipsoids_hertz", Kind::ellipsoids, AnyLaw(kHertz))
    ->Arg(1)
    ->UseRealTime();
BENCHMARK_CAPTURE(steps, superellipsoids_hertz, "superellipsoids_hertz", Kind::superellipsoids,
                  AnyLaw(kHertz))
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime();

BENCHMARK_CAPTURE(steps, superellipsoids_hertz_10k, "superellipsoids_hertz_10k",
                  Kind::superellipsoids, AnyLaw(kHertz), IntegratorKind::verlet, kMany)
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime();

BENCHMARK_CAPTURE(steps, superellipsoids_hertz_runge_kutta, "superellipsoids_hertz",
                  Kind::superellipsoids, AnyLaw(kHertz), IntegratorKind::runge_kutta)
    ->Arg(1)
    ->UseRealTime();

/// What an integrator does to energies: the largest |E/E(0) - 1| of a gas of 27 superellipsoids in
/// a box, penalty law without damping and friction, until a time of 50; steps in millionths. The
/// gas is the same for all, so its collisions are the first ones alike.
void gas_drift(benchmark::State& state, IntegratorKind integrator) {
  const double step = 1e-6 * static_cast<double>(state.range(0));
  gas::Drift drift;
  for (auto _ : state) {
    EngineSettings s = gas::settings_of(PenaltyLaw{2e3, 0, 0}, step);
    s.integrator = integrator;
    const auto engine = make_engine(s);
    gas::add_box(*engine, 3 * 2.6);
    gas::add_gas(*engine, 3, 2.6, 0.7, 1.3, 2);
    drift = gas::drift_of(*engine, 100, std::lround(0.5 / step));
  }
  state.counters["step"] = step;
  state.counters["drift"] = drift.worst;
}
BENCHMARK_CAPTURE(gas_drift, verlet, IntegratorKind::verlet)
    ->RangeMultiplier(2)
    ->Range(128, 4096)
    ->Iterations(1)
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(gas_drift, runge_kutta, IntegratorKind::runge_kutta)
    ->RangeMultiplier(2)
    ->Range(128, 4096)
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

/// The same of a free top (moments 1, 2, 3; about a turn in 5 units of time) after so many steps of
/// 0.05.
template <class Integrator>
void top_drift(benchmark::State& state) {
  double drift = 0;
  for (auto _ : state) {
    const auto steps = static_cast<int>(state.range(0));
    const top::Ended end = top::turned<Integrator>(0.05 * steps, steps);
    drift = std::fabs(top::energy_of(end.spin) / top::energy_of(top::kStart) - 1);
  }
  state.counters["time"] = 0.05 * static_cast<double>(state.range(0));
  state.counters["drift"] = drift;
}
BENCHMARK_TEMPLATE(top_drift, VerletIntegrator<3>)
    ->RangeMultiplier(4)
    ->Range(16, 1 << 18)
    ->Iterations(1);
BENCHMARK_TEMPLATE(top_drift, RungeKuttaIntegrator<3>)
    ->RangeMultiplier(4)
    ->Range(16, 1 << 18)
    ->Iterations(1);

}  // namespace
}  // namespace grainfield::dem
