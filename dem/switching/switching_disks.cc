#include "dem/switching/switching_disks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dem/checkpoint/checkpoint.h"

namespace grainfield::dem {
namespace {

// Rounds of impulses in a step; pairs that would still overlap then are soft.
constexpr int kRounds = 30;
// Pairs are looked for within this many times the way of free flight, and so much of the radius.
constexpr double kReach = 2, kLeastReach = 1e-3;

void check_law(const char* what, const ImpactLaw& law) {
  if (!(law.restitution >= 0 && law.restitution <= 1)) {
    throw std::invalid_argument(
        fmt::format("restitution {}: found {:g}, allowed: 0 to 1", what, law.restitution));
  }
  if (!(law.friction >= 0 && std::isfinite(law.friction))) {
    throw std::invalid_argument(
        fmt::format("friction {}: found {:g}, allowed: 0 or more", what, law.friction));
  }
}

}  // namespace

SwitchingDisks::SwitchingDisks(const SwitchScene& scene, const std::vector<Body<2>>& disks,
                               const ImplicitSettings& settings)
    : scene_(scene),
      time_step_(settings.time_step),
      disks_(scene.soft, disks, settings),
      soft_(disks.size(), 0) {
  check_law("of grains", scene.grains);
  for (const ImpactLaw& law : scene.walls) check_law("of walls", law);
  if (scene.walls.size() != scene.soft.walls.size()) {
    throw std::invalid_argument(
        fmt::format("impact laws of walls: found {}, allowed: {}, one a wall", scene.walls.size(),
                    scene.soft.walls.size()));
  }
  moving_ = disks;
  find_accelerations();
  find_pairs();
  for (const Pair& p : pairs_) {
    if (meeting_of(p).gap < 0) make_soft(p);
  }
  tally_ = {};
  disks_.set_acting(soft_);
}

void SwitchingDisks::step(long steps) {
  for (; steps > 0; --steps) {
    moving_ = disks_.bodies();
    find_accelerations();
    find_pairs();
    collide_all();
    disks_.set_velocities(moving_);
    disks_.set_acting(soft_);
    disks_.step(1);
    look_back();
    disks_.set_acting(soft_);
  }
}

void SwitchingDisks::add(const Body<2>& disk) {
  disks_.add(disk);
  soft_.push_back(0);
  disks_.set_acting(soft_);
}

void SwitchingDisks::make_soft(const Pair& p) {
  for (const int k : {p.i, p.j}) {
    if (k < 0 || soft_[k]) continue;
    soft_[k] = 1;
    ++tally_.to_soft;
  }
}

void SwitchingDisks::find_accelerations() {
  accelerations_.assign(moving_.size(), Vec(0, 0));
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    if (moving_[k].inverse_mass > 0) accelerations_[k] = scene_.soft.gravity;
  }
  for (const SoftTouch& t : disks_.touches()) {
    const Vec force = -t.repulsion * t.normal + t.tangential * Vec(-t.normal.y(), t.normal.x());
    accelerations_[t.i] += moving_[t.i].inverse_mass * force;
    if (t.j >= 0) accelerations_[t.j] -= moving_[t.j].inverse_mass * force;
  }
}

// Sorted by i, then j; walls first.
void SwitchingDisks::find_pairs() {
  std::vector<Reach<2>> reaches;
  std::vector<double> extra;
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    const Body<2>& b = moving_[k];
    // Impulses of this step may make it faster: as fast as the fastest of all, at most twice that.
    extra.push_back(b.velocity.norm() * time_step_ +
                    0.5 * accelerations_[k].norm() * time_step_ * time_step_);
  }
  const double widest = extra.empty() ? 0 : *std::max_element(extra.begin(), extra.end());
  for (const Body<2>& b : moving_) {
    reaches.push_back(
        {b.position, b.radius * (1 + kLeastReach) + kReach * widest, b.inverse_mass == 0});
  }
  std::vector<std::pair<int, int>> found;
  grid_.build(reaches);
  grid_.pairs(found);
  pairs_.clear();
  for (const auto& [i, j] : found) pairs_.push_back({std::min(i, j), std::max(i, j)});
  for (int k = 0; k < static_cast<int>(moving_.size()); ++k) {
    if (moving_[k].inverse_mass == 0) continue;
    for (int w = 0; w < static_cast<int>(scene_.soft.walls.size()); ++w) {
      const SoftWall& wall = scene_.soft.walls[static_cast<std::size_t>(w)];
      const double gap = (moving_[k].position - wall.point).dot(wall.normal) - moving_[k].radius;
      if (gap < kLeastReach * moving_[k].radius + kReach * widest) pairs_.push_back({k, -1 - w});
    }
  }
  std::sort(pairs_.begin(), pairs_.end(),
            [](const Pair& a, const Pair& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; });
}

SwitchingDisks::Meeting SwitchingDisks::meeting_of(const Pair& p) const {
  Meeting m;
  const Body<2>& a = moving_[p.i];
  const double half = 0.5 * time_step_ * time_step_;
  if (p.j < 0) {
    const SoftWall& wall = scene_.soft.walls[static_cast<std::size_t>(-1 - p.j)];
    m.normal = -wall.normal;
    m.gap = (a.position - wall.point).dot(wall.normal) - a.radius;
    m.parting = a.velocity.dot(wall.normal);
    m.closing = -accelerations_[p.i].dot(wall.normal);
    m.end = m.gap + time_step_ * m.parting - half * m.closing;
    return m;
  }
  const Body<2>& b = moving_[p.j];
  const Vec way = b.position - a.position, velocity = b.velocity - a.velocity;
  const Vec acceleration = accelerations_[p.j] - accelerations_[p.i];
  const double distance = way.norm(), reach = a.radius + b.radius;
  m.normal = way / distance;
  m.gap = distance - reach;
  m.parting = velocity.dot(m.normal);
  m.closing = -acceleration.dot(m.normal);
  m.end = (way + time_step_ * velocity + half * acceleration).norm() - reach;
  return m;
}

void SwitchingDisks::collide_pair(const Pair& p, const Vec& normal) {
  if (p.j < 0) {
    Body<2> plane;
    tally_.lost +=
        collide<2>(moving_[p.i], plane, normal, scene_.walls[static_cast<std::size_t>(-1 - p.j)])
            .lost;
  } else {
    // It acts between the two, a little before they touch: arms up to there keep their angular
    // momentum.
    Body<2>&a = moving_[p.i], &b = moving_[p.j];
    const double reach = a.radius + b.radius;
    const double longer = (b.position - a.position).norm() / reach;
    const double radius_a = a.radius, radius_b = b.radius;
    a.radius *= longer;
    b.radius *= longer;
    tally_.lost += collide<2>(a, b, normal, scene_.grains).lost;
    a.radius = radius_a;
    b.radius = radius_b;
  }
  ++tally_.collisions;
}

void SwitchingDisks::collide_all() {
  for (int round = 0;; ++round) {
    bool again = false;
    for (const Pair& p : pairs_) {
      if (is_soft(p)) continue;
      Meeting m = meeting_of(p);
      if (!(m.end < 0)) continue;
      if (m.parting < 0) {
        collide_pair(p, m.normal);
        again = true;
        m = meeting_of(p);
      }
      if (m.closing > 0 && time_step_ * m.closing > m.parting) {
        make_soft(p);  // (22)
      } else if (round >= kRounds) {
        make_soft(p);
        ++tally_.pressed;
      }
    }
    if (!again || round >= kRounds) return;
  }
}

void SwitchingDisks::look_back() {
  moving_ = disks_.bodies();
  find_accelerations();
  find_pairs();
  const std::vector<char> before = soft_;  // in the step: these contacts acted
  std::vector<char> touches(soft_.size(), 0);
  for (const Pair& p : pairs_) {
    const double overlap = -meeting_of(p).gap;
    if (!(overlap > 0)) continue;
    if (!before[p.i] || (p.j >= 0 && !before[p.j])) {
      const double stiffness =
          p.j < 0 ? scene_.soft.walls[static_cast<std::size_t>(-1 - p.j)].law.stiffness
                  : scene_.soft.grains.stiffness;
      tally_.switched += 0.5 * stiffness * overlap * overlap;
      ++tally_.pressed;
      make_soft(p);
    }
    touches[p.i] = 1;
    if (p.j >= 0) touches[p.j] = 1;
  }
  for (std::size_t k = 0; k < soft_.size(); ++k) {
    if (!soft_[k] || touches[k]) continue;
    soft_[k] = 0;
    ++tally_.to_hard;
  }
}

std::string SwitchingDisks::checkpoint() const {
  CheckpointWriter out;
  out.put(disks_.checkpoint());
  out.put(soft_);
  for (const long value : {tally_.collisions, tally_.to_soft, tally_.to_hard, tally_.pressed}) {
    out.put(static_cast<std::int64_t>(value));
  }
  out.put(tally_.lost);
  out.put(tally_.switched);
  return out.bytes();
}

void SwitchingDisks::restore(const std::string& checkpoint) {
  CheckpointReader in(checkpoint);
  std::string disks;
  in.get(disks);
  const std::size_t n = soft_.size();
  in.get(soft_);
  in.require(soft_.size() == n);
  for (long* value : {&tally_.collisions, &tally_.to_soft, &tally_.to_hard, &tally_.pressed}) {
    std::int64_t count = 0;
    in.get(count);
    *value = count;
  }
  in.get(tally_.lost);
  in.get(tally_.switched);
  in.finish();
  disks_.restore(disks);
  disks_.set_acting(soft_);
}

}  // namespace grainfield::dem
