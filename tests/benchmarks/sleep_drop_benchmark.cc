// What sleeping saves on a heap that stands already, while single grains fall on it:
//   sleep_drop_benchmark GRAINS|FILE.h5:/GROUP [DROPS [KEY=VALUE ...]]
// Lays so many grains of cases/pile-point-source.toml in rows that narrow upwards and brings them
// to rest with every grain awake and much damping, or takes a heap that was poured. KEY: of
// [sleep], or `asleep=1` for the first of the three times alone. Then it drops one grain each
// source.interval from source.height, with sleeping and with every grain awake. Prints the grains
// awake at every tenth of an interval, and what a snapshot costs, of which a pour makes one for
// each grain. It needs no pour: pile_sleep_benchmark times the real one. A third time every grain
// is awake, and at the end of each interval Newton's method is to carry the heap to rest.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "coupling/specimen/relaxation.h"
#include "coupling/studies/pile/simulation.h"
#include "dem/engine/engine.h"
#include "dem/grains/grain_family.h"
#include "dem/quasistatic/quasistatic.h"
#include "dem/random/random.h"
#include "dem/run/common.h"
#include "dem/run/setup.h"
#include "dem/shared/computation_failed.h"
#include "dem/snapshot/snapshot.h"

namespace {

namespace dem = grainfield::dem;
using dem::PileSetup;
using dem::ShapedGrain;

constexpr double kSlope = 0.45;         // of the flanks as laid
constexpr double kEntryDiameters = 10;  // a grain joins so far above the top
constexpr double kFallDamping = 10, kRestDamping = 60, kFall = 0.3, kRest = 0.6;  // 1/s, s
constexpr int kSamples = 10;
constexpr double kNewtonRatio = 1e-3;  // unbalanced force at which Newton ends

dem::EngineSettings settings_of(const PileSetup& setup, const std::vector<ShapedGrain>& grains) {
  dem::EngineSettings s = dem::engine_settings(
      setup.material, setup.motion, dem::extremes_of(grains, setup.material.density), 1, true);
  s.shape = dem::ShapeKind::polygon;
  return s;
}

/// Rows, the lowest `length` wide, of all grains or as many as they hold.
std::vector<std::vector<ShapedGrain>> rows_of(const std::vector<ShapedGrain>& grains, double length,
                                              double high) {
  std::vector<std::vector<ShapedGrain>> rows;
  std::size_t next = 0;
  for (double l = length; l > high && next < grains.size(); l -= 1.7 * high / kSlope) {
    rows.emplace_back();
    for (double room = l; next < grains.size() && 2 * grains[next].radius <= room; ++next) {
      room -= 2 * grains[next].radius;
      rows.back().push_back(grains[next]);
    }
  }
  return rows;
}

dem::Snapshot heap_of(const PileSetup& setup, int count, dem::Random& random) {
  std::vector<ShapedGrain> grains;
  for (int k = 0; k < count; ++k) grains.push_back(dem::draw_grain(setup.shape, random));
  const double high = 2 * dem::largest_radius(grains);
  double length = 10 * high;
  const auto held = [&] {
    std::size_t sum = 0;
    for (const auto& row : rows_of(grains, length, high)) sum += row.size();
    return sum;
  };
  while (held() < grains.size()) length += high;
  if (length > setup.floor.length) throw std::invalid_argument("floor.length is too small");

  const dem::EngineSettings s = settings_of(setup, grains);
  const auto engine = dem::make_engine(s);
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, setup.material.floor_friction});
  double l = length, bottom = 0;
  for (const auto& row : rows_of(grains, length, high)) {
    for (const auto& g :
         dem::side_by_side(row, -0.5 * l, 0.5 * l, bottom, setup.material.density, random)) {
      engine->add(g);
    }
    l -= 1.7 * high / kSlope;
    bottom += high;
  }
  engine->set_background_damping(kFallDamping);
  engine->step(std::lround(kFall / s.time_step));
  engine->set_background_damping(kRestDamping);
  engine->step(std::lround(kRest / s.time_step));
  return engine->snapshot();
}

enum class Mode { sleep, awake, newton };

struct Drops {
  double seconds = 0, awake = 0;  // CPU s per grain dropped; mean
  double grain_step = 0;          // CPU s for a step of a grain that is awake
  double snapshot = 0;            // CPU s for one
  double newton = 0;              // CPU s of the relaxations per grain dropped
  int failed = 0;                 // of them
  double level = 0;               // largest error of the force through a level, two intervals later
};

// The heap at rest, or as it was when there is no rest to be found.
dem::Snapshot relaxed(const dem::Snapshot& heap, const dem::EngineSettings& settings, Drops& out) {
  dem::QuasistaticSettings to_rest;
  to_rest.unbalanced_force_ratio = kNewtonRatio;
  const std::clock_t start = std::clock();
  dem::Snapshot state = heap;
  try {
    dem::QuasistaticResult r = dem::relax(heap, settings, heap.gravity, {}, to_rest);
    double moved = 0;
    for (std::size_t k = 0; k < heap.grains.size(); ++k) {
      moved = std::max(moved, (r.state.grains[k].position - heap.grains[k].position).norm() /
                                  heap.grains[k].radius);
    }
    fmt::print(
        "  newton: {} iterations, {} contacts gained, {} lost, a grain moves by {:.3f} radii",
        r.iterations, r.contacts_gained, r.contacts_lost, moved);
    state = std::move(r.state);
  } catch (const grainfield::ComputationFailed& failure) {
    fmt::print("  newton: {}", failure.what());
    ++out.failed;
  }
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  fmt::print(", {:.2f} CPU s\n", seconds);
  out.newton += seconds;
  return state;
}

Drops drop(const PileSetup& setup, const dem::Snapshot& heap, int drops, Mode mode) {
  std::vector<ShapedGrain> grains;
  for (const auto& g : heap.grains) grains.push_back({g.outline, g.radius, g.volume, g.angle});
  dem::EngineSettings s = settings_of(setup, grains);
  s.sleep = setup.sleep;
  s.sleep.on = mode == Mode::sleep;
  auto engine = dem::make_engine(s, heap);
  double top = 0, axis = 0;
  for (const auto& g : heap.grains) {
    if (g.position.y() + g.radius <= top) continue;
    top = g.position.y() + g.radius;
    axis = g.position.x();
  }
  const double d = 2 * setup.shape.radius, entry = kEntryDiameters * d;
  const double speed = setup.source.speed;
  const double fall = std::max(0.0, setup.source.height - top - entry);
  const long steps = std::lround(setup.source.interval / s.time_step / kSamples);
  engine->step(kSamples * steps);
  dem::Random random(7);
  Drops out;
  double grain_steps = 0;
  for (int n = 0; n < drops; ++n) {
    const ShapedGrain shaped = dem::draw_grain(setup.shape, random);
    dem::NewGrain g =
        shaped.at(axis + 0.5 * d * random.uniform(-1, 1), top + entry, setup.material.density);
    g.vy = -std::sqrt(speed * speed + 2 * setup.material.gravity * fall);
    std::clock_t start = std::clock();
    engine->snapshot();
    out.snapshot += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / drops;
    engine->add(g);
    fmt::print("{} {:3d}: awake", mode == Mode::sleep ? "asleep" : "awake ", n);
    double seconds = 0;
    for (int part = 0; part < kSamples; ++part) {
      start = std::clock();
      engine->step(steps);
      seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      const int awake = engine->motion().awake;
      out.awake += static_cast<double>(awake) / (kSamples * drops);
      grain_steps += static_cast<double>(awake) * static_cast<double>(steps);
      fmt::print(" {:4d}", awake);
    }
    fmt::print("  {:.2f} CPU s\n", seconds);
    std::fflush(stdout);
    out.seconds += seconds / drops;
    if (mode == Mode::newton) engine = dem::make_engine(s, relaxed(engine->snapshot(), s, out));
  }
  out.newton /= drops;
  out.grain_step = out.seconds * drops / grain_steps;
  engine->step(2 * kSamples * steps);
  const dem::Snapshot end = engine->snapshot();
  out.level = grainfield::coupling::measure_relaxation(end, end, d).levels_before;
  return out;
}

// Numbers of `setup.sleep` by their keys.
bool set_sleep(PileSetup& setup, const std::string& key, double value) {
  dem::SleepSettings& k = setup.sleep;
  const std::pair<const char*, double*> known[] = {
      {"quiet_time", &k.quiet_time},   {"quiet_move", &k.quiet_move},
      {"quiet_creep", &k.quiet_creep}, {"quiet_force", &k.quiet_force},
      {"wake_force", &k.wake_force},   {"wake_time", &k.wake_time},
      {"wake_shock", &k.wake_shock},   {"wake_speed", &k.wake_speed},
      {"wake_levels", &k.wake_levels}, {"wake_reach", &k.wake_reach}};
  for (const auto& [name, number] : known) {
    if (key == name) {
      *number = value;
      return true;
    }
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr,
               "usage: sleep_drop_benchmark GRAINS|FILE.h5:/GROUP [DROPS [KEY=VALUE ...]]\n");
    return 2;
  }
  try {
    PileSetup setup;
    setup.material.friction = setup.material.floor_friction = 0.54;
    setup.motion.time_step_fraction = 2;
    bool asleep_alone = false;
    for (int k = 3; k < argc; ++k) {
      const std::string word = argv[k];
      const std::size_t at = word.find('=');
      const std::string key = word.substr(0, at);
      if (key == "asleep") {
        asleep_alone = true;
      } else if (at == std::string::npos ||
                 !set_sleep(setup, key, std::stod(word.substr(at + 1)))) {
        throw std::invalid_argument(
            fmt::format("found \"{}\"; allowed: KEY=VALUE of [sleep]", word));
      }
    }
    const int drops = argc > 2 ? std::max(1, std::atoi(argv[2])) : 8;
    dem::Random random(3);
    const std::string heap_name = argv[1];
    const std::size_t colon = heap_name.find(':');
    const dem::Snapshot heap =
        colon == std::string::npos
            ? heap_of(setup, std::max(100, std::atoi(argv[1])), random)
            : dem::read_snapshot(heap_name.substr(0, colon), heap_name.substr(colon + 1));
    const Drops asleep = drop(setup, heap, drops, Mode::sleep);
    fmt::print(
        "{} grains: CPU s per grain dropped {:.3f} with sleeping ({:.0f} awake, {:.0f} ns for a "
        "step "
        "of one); levels carry their load to {:.2f} %\n",
        heap.grains.size(), asleep.seconds, asleep.awake, 1e9 * asleep.grain_step,
        100 * asleep.level);
    if (asleep_alone) return 0;
    const Drops awake = drop(setup, heap, std::max(1, drops / 4), Mode::awake),
                newton = drop(setup, heap, std::max(1, drops / 4), Mode::newton);
    fmt::print("{:.3f} with all awake ({:.0f} ns), ratio {:.2f}; a snapshot {:.4f}\n",
               awake.seconds, 1e9 * awake.grain_step, awake.seconds / asleep.seconds,
               asleep.snapshot);
    fmt::print(
        "with Newton's method to {:g} after each grain: {:.3f} and {:.3f} more for it; {} of "
        "{} found no rest\n",
        kNewtonRatio, newton.seconds, newton.newton, newton.failed, std::max(1, drops / 4));
  } catch (const std::exception& e) {
    fmt::print(stderr, "sleep_drop_benchmark: {}\n", e.what());
    return 2;
  }
}
