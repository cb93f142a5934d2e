#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/studies/pair/pair_run.h"
#include "dem/run/fingerprint.h"

namespace grainfield::dem {
namespace {

// Finding where two bodies touch costs as much as drawing so many.
constexpr std::int64_t kTouchDraws = 100;

}  // namespace

PairRun::PairRun(const PairSetup& setup, std::uint64_t seed, int threads)
    : setup_(setup), seed_(seed), threads_(threads) {
  check_pair(setup_);
}

PairBodies PairRun::draw() const {
  Random random(seed_);
  return make_pair(setup_, random, threads_);
}

std::string PairRun::fingerprint() const {
  return fmt::format("pair {} {}", fingerprint_of(setup_), seed_);
}

RunResult PairRun::result_of(const PairBodies& bodies, long steps) const {
  RunResult out;
  out.snapshots = snapshots_of(records_, bodies);
  out.snapshots.front().second.attributes["seed"] = fmt::format("{}", seed_);
  out.figures = figures_;
  out.figures["dem.grains"] = bodies.has_wall ? 1 : 2;
  out.figures["dem.steps"] = static_cast<double>(steps);
  out.figures["pair.stable_time_step"] = bodies.stable_step;
  return out;
}

void PairRun::add_figure(const std::string& key, double value) {
  if (std::isfinite(value)) figures_[key] = value;
}

std::vector<PairLaunch> pair_launches(const PairSetup& s) {
  std::vector<PairLaunch> out{{s.speed, s.angle, "pair.", "pair.speed", "pair.angle"}};
  for (const double v : s.speeds) {
    out.push_back({v, s.angle, fmt::format("pair.speed_{:g}.", v), "pair.speeds", "pair.angle"});
  }
  for (const double a : s.angles) {
    out.push_back({s.speed, a, fmt::format("pair.angle_{:g}.", a), "pair.speed", "pair.angles"});
  }
  return out;
}

std::unique_ptr<Run> make_pair_run(const PairSetup& setup, std::uint64_t seed, int threads) {
  if (setup.kind == "path") return make_path_run(setup, seed, threads);
  return make_collision_run(setup, seed, threads);
}

Outlook foresee_pair(const PairSetup& setup, const std::vector<std::uint64_t>& seeds,
                     std::int64_t most) {
  Outlook out;
  check_pair(setup);
  // Only what is drawn differs from seed to seed.
  const bool drawn = setup.shape == "rand1" || (setup.kind == "path" && setup.path == "random");
  const std::int64_t work = kTouchDraws + static_cast<std::int64_t>(pair_launches(setup).size());
  for (const std::uint64_t seed : seeds) {
    if (most <= 0) break;
    most -= work;
    make_pair_run(setup, seed, 1);
    Random random(seed);
    const double step = make_pair(setup, random, 1).settings.time_step;
    if (out.time_step == 0 && setup.kind == "collision") out.time_step = step;
    if (!drawn) break;
  }
  out.grains = setup.partner == "wall" ? 1 : 2;
  return out;
}

}  // namespace grainfield::dem
