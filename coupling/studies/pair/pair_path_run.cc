// Paths of a pair, one after the other, each passed again in finer steps until its work has
// settled.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "coupling/studies/pair/pair_path.h"
#include "coupling/studies/pair/pair_run.h"

namespace grainfield::dem {
namespace {

// The work of a path has settled when finer steps change it by less than this share of the largest
// stored energy; steps are made finer by these factors.
constexpr double kSettled = 2e-6;
constexpr int kFiner = 4, kFinest = 256;
// Random loops during which the bodies overlap by less than this share of r^2 (of r: spheres), r of
// the smaller one, while their outlines cross, are drawn again.
constexpr double kHardlyMet = 0.01;
constexpr int kMostTries = 1000;  // loops drawn until the bodies meet
constexpr int kLookAt = 200;
constexpr double kBar = 4.8;  // axis ratio of those that lie across each other

class PathRun final : public PairRun {
 public:
  PathRun(const PairSetup& setup, std::uint64_t seed, int threads)
      : PairRun(setup, seed, threads), loops_(setup_.path == "random" ? setup_.loops : 1) {
    prepare();
    begin_pass();
  }

  void advance(long steps) override {
    for (; steps > 0 && !done(); --steps) step();
  }
  bool done() const override { return now_.loop == loops_; }
  Progress progress() const override {
    Progress p;
    p.phase = fmt::format("path {}/{}", std::min(now_.loop + 1, loops_), loops_);
    p.fraction = static_cast<double>(now_.loop) / loops_;
    p.steps = now_.steps;
    p.grains = p.awake = bodies_->has_wall ? 1 : 2;
    return p;
  }
  RunResult result() const override {
    RunResult out = result_of(*first_bodies_, now_.steps);
    if (setup_.path != "random") return out;
    NumberTable& table = out.snapshots.front().second.tables["loops"];
    for (std::size_t c = 0; c < std::size(kLoopColumns); ++c) {
      table.push_back({kLoopColumns[c].name, kLoopColumns[c].unit, {}});
      for (std::size_t k = c; k < done_loops_.size(); k += std::size(kLoopColumns)) {
        table.back().values.push_back(done_loops_[k]);
      }
    }
    return out;
  }

 private:
  struct Now {
    int loop = 0, factor = 1, step = 0, most_crossings = 0;
    double work = 0, stored = 0, deepest = 0, before = 0, start_stored = 0;
    double worst = 0, sum = 0, crossing = 0, unsettled = 0;
    long steps = 0;
  };

  // Bodies and path of the present loop.
  void prepare() {
    if (setup_.path != "random") {
      bodies_ = draw();
      path_.emplace(setup_, *bodies_);
    } else {
      Random random(seed_ + 0x9E3779B97F4A7C15ULL * static_cast<std::uint64_t>(now_.loop + 1));
      int draws = 0;
      do {
        if (++draws > kMostTries) refuse_apart();
        PairSetup s = setup_;
        const bool bars = s.shape == "rand1" && now_.loop % 4 == 3;
        if (bars) {
          s.corners = 4;
          s.axis_ratio = kBar;
        }
        bodies_ = make_pair(s, random, threads_);
        path_.emplace(s, random, bars);
      } while (!meets());
    }
    probe_ = bodies_->probe();
    if (now_.loop == 0) first_bodies_ = bodies_;
    length_ = path_->length(kLookAt);
  }
  [[noreturn]] void refuse_apart() const {
    throw std::invalid_argument(fmt::format(
        "pair.radius_second: found {:g} m beside pair.radius = {:g} m: {} random loops did not "
        "bring the bodies to overlap; allowed: sizes of which they do",
        setup_.radius_second, setup_.radius, kMostTries));
  }
  bool meets() const {
    const std::unique_ptr<PairProbe> probe = bodies_->probe();
    const bool two = !bodies_->has_wall && setup_.radius_second > 0;
    const double r = two ? std::min(setup_.radius, setup_.radius_second) : setup_.radius;
    const PairState second = bodies_->state_of_second();
    for (int k = 0; k < kLookAt; ++k) {
      probe->forget();
      const PairState first = bodies_->state_of_first(path_->at((k + 0.5) / kLookAt));
      const PairForces f = probe->at(first, second, 0);
      const bool met = setup_.in_space() ? f.depth > kHardlyMet * r : f.area > kHardlyMet * r * r;
      if (met && outlines_cross(*bodies_, first, second)) return true;
    }
    return false;
  }
  int count() const { return setup_.steps * now_.factor; }
  void begin_pass() {
    now_.step = 0;
    now_.work = now_.stored = now_.start_stored = now_.deepest = 0;
    probe_->forget();
    if (now_.loop == 0) records_ = {};
    const PairForces f =
        probe_->at(bodies_->state_of_first(path_->at(0)), bodies_->state_of_second(), 0);
    now_.start_stored = f.stored;
  }
  // By the midpoint rule: the forces in the middle of the step, on the way of the whole.
  void step() {
    const int n = count();
    const double dt = setup_.speed > 0 ? length_ / (setup_.speed * n) : 0;
    const PairPose begin = path_->at(static_cast<double>(now_.step) / n),
                   end = path_->at(static_cast<double>(now_.step + 1) / n),
                   middle = path_->at((now_.step + 0.5) / n);
    PairRecord r;
    r.first = bodies_->state_of_first(middle);
    r.second = bodies_->state_of_second();
    r.first.spin = r.second.spin = Vec3::Zero();
    const Vec3 way(end.x - begin.x, end.y - begin.y, 0);
    const double turn = end.angle - begin.angle;
    if (dt > 0) {
      r.first.velocity = way / dt;
      r.first.spin = {0, 0, turn / dt};
    }
    // Half of the slip reaches the springs before the forces are taken, the rest after.
    r.forces = probe_->at(r.first, r.second, 0.5 * dt);
    if (dt > 0) probe_->at(r.first, r.second, 0.5 * dt);
    now_.work -= r.forces.force.dot(way) + r.forces.torque_first.z() * turn;
    now_.stored = std::max(now_.stored, r.forces.stored);
    now_.deepest = std::max(now_.deepest, r.forces.depth);
    if (now_.step % 50 == 0) {
      now_.most_crossings = std::max(now_.most_crossings, crossings(*bodies_, r.first, r.second));
    }
    ++now_.steps;
    if (now_.loop == 0) {
      r.time = (now_.step + 0.5) * dt;
      r.stored = r.forces.stored;
      r.dissipated = now_.work - (r.stored - now_.start_stored);
      records_.add(r, setup_.records);
    }
    if (++now_.step == n) end_pass();
  }
  void end_pass() {
    const bool settled =
        now_.factor > 1 && std::fabs(now_.work - now_.before) <= kSettled * now_.stored;
    if (!settled && now_.factor < kFinest) {
      now_.before = now_.work;
      now_.factor *= kFiner;
      return begin_pass();
    }
    if (!settled) ++now_.unsettled;
    end_loop();
  }
  void end_loop() {
    const double share = now_.stored > 0 ? now_.work / now_.stored : 0;
    if (now_.loop == 0) {
      add_figure("pair.work", now_.work);
      add_figure("pair.max_depth", now_.deepest);
      add_figure("pair.stored_most", now_.stored);
    }
    now_.worst = std::max(now_.worst, std::fabs(share));
    now_.sum += std::fabs(share);
    now_.crossing += now_.most_crossings > 2;
    for (const double value : {share, now_.stored, static_cast<double>(now_.most_crossings)}) {
      done_loops_.push_back(value);
    }
    if (++now_.loop < loops_) {
      now_.factor = 1;
      now_.before = now_.most_crossings = 0;
      prepare();
      return begin_pass();
    }
    add_figure("pair.loops", loops_);
    if (path_->closed()) {
      add_figure("pair.loop_work_over_energy", now_.worst);
      add_figure("pair.loop_work_over_energy_mean", now_.sum / loops_);
    }
    add_figure("pair.loops_crossing", now_.crossing);
    add_figure("pair.loops_unsettled", now_.unsettled);
  }
  void visit(Archive& archive) override {
    archive(now_);
    std::string memory = archive.is_reading() ? "" : probe_->image();
    archive(memory);
    archive(done_loops_);
    records_.visit(archive);
    archive(figures_);
    archive.require(now_.loop >= 0 && now_.loop <= loops_);
    if (!archive.is_reading()) return;
    if (!done()) prepare();  // the first bodies stay those of the constructor
    probe_->restore(memory);
  }

  int loops_;
  std::optional<PairBodies> bodies_, first_bodies_;
  std::optional<PairPath> path_;
  std::unique_ptr<PairProbe> probe_;
  double length_ = 0;
  Now now_;
  std::vector<double> done_loops_;  // kLoopColumns of one loop after the other
};

}  // namespace

std::unique_ptr<Run> make_path_run(const PairSetup& setup, std::uint64_t seed, int threads) {
  return std::make_unique<PathRun>(setup, seed, threads);
}

}  // namespace grainfield::dem
