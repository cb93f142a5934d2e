#include "dem/collisions/hard_engine.h"

#include <fmt/format.h>

#include <algorithm>

#include "dem/collisions/sliding.h"
#include "dem/shared/computation_failed.h"

namespace grainfield::dem {
namespace {

constexpr long kEventsPerClock = 64;
// Collisions of one grain at one instant: more than a chain of grains needs that touch each other.
constexpr std::int32_t kMostAtOnce = 1000;
// Share of gravity along a wall that is round-off.
constexpr double kLevel = 1e-12;

// What a grain does alone, beside walls (from 0 on) and faces: -1 - 2 axis, and one less for the
// upper one.
constexpr std::int32_t kStopsSliding = -100, kSettles = -101;

std::int32_t face_code(int axis, int way) { return -1 - 2 * axis - (way > 0 ? 1 : 0); }

}  // namespace

template <int D>
HardEngine<D>::HardEngine(const HardScene<D>& scene, const std::vector<Body<D>>& grains)
    : scene_(scene), wall_impulses_(scene.walls.size(), Vector(Vector::Zero())) {
  check_scene(scene, grains);
  const double g = scene.gravity.norm();
  weighs_ = g > 0;
  for (const HardWall<D>& wall : scene.walls) {
    const Vector along = scene.gravity - scene.gravity.dot(wall.normal) * wall.normal;
    is_floor_.push_back(weighs_ && scene.gravity.dot(wall.normal) < 0 &&
                        along.norm() < kLevel * g && wall.velocity.isZero(0) &&
                        wall.law.restitution < 1);
  }
  cells_ = Cells<D>(scene.box, widest(grains), grains.size());
  hot_.resize(grains.size());
  cold_.resize(grains.size());
  plans_.resize(grains.size());
  for (std::size_t k = 0; k < grains.size(); ++k) {
    hot_[k].position = inside(scene.box, grains[k].position);
    hot_[k].velocity = grains[k].velocity;
    hot_[k].radius = grains[k].radius;
    hot_[k].cell = cells_.of(hot_[k].position);
    hot_[k].motion = grains[k].inverse_mass > 0 ? Motion::free : Motion::fixed;
    cold_[k].spin = grains[k].spin;
    cold_[k].inverse_mass = grains[k].inverse_mass;
    cold_[k].inverse_inertia = grains[k].inverse_inertia;
  }
  until_restart_ = kEventsPerClock * static_cast<long>(grains.size());
  fill();
  for (std::size_t k = 0; k < grains.size(); ++k) {
    const auto grain = static_cast<std::int32_t>(k);
    look_ahead(grain);
    look_around(grain);
    plan(grain);
  }
}

// Cells and queue from the grains and their plans.
template <int D>
void HardEngine<D>::fill() {
  const auto n = static_cast<std::int32_t>(hot_.size());
  for (std::int32_t g = 0; g < n; ++g) cells_.put(g, hot_[g].cell);
  queue_ = EventQueue(hot_.size());
  for (std::int32_t g = 0; g < n; ++g) plan(g);
}

template <int D>
bool HardEngine<D>::settle() {
  const std::size_t n = hot_.size();
  if (cold_.size() != n || plans_.size() != n || cells_.grains() != n ||
      wall_impulses_.size() != scene_.walls.size() || !(until_restart_ > 0)) {
    return false;
  }
  const auto most = static_cast<std::int32_t>(n);
  const auto walls = static_cast<std::int32_t>(scene_.walls.size());
  for (std::size_t k = 0; k < n; ++k) {
    const Plan& plan = plans_[k];
    const bool alone =
        plan.what >= face_code(D - 1, 1) || plan.what == kStopsSliding || plan.what == kSettles;
    if (hot_[k].cell < 0 || hot_[k].cell >= cells_.count() || plan.partner >= most ||
        (plan.meets < kNever && plan.partner < 0) || plan.what >= walls || !alone ||
        cold_[k].floor >= walls || hot_[k].motion < Motion::free ||
        hot_[k].motion > Motion::fixed) {
      return false;
    }
  }
  cells_.clear();
  fill();
  return true;
}

// -- flight

template <int D>
void HardEngine<D>::fly(std::int32_t g) {
  Hot& hot = hot_[g];
  const double dt = now_ - hot.time;
  hot.time = now_;
  if (hot.motion == Motion::free) {
    hot.position += dt * hot.velocity;
    if (!weighs_) return;
    hot.position += 0.5 * dt * dt * scene_.gravity;
    hot.velocity += dt * scene_.gravity;
    return;
  }
  Cold& cold = cold_[g];
  if (hot.motion == Motion::lies) lost_ += slid(g, dt);
  hot.position += dt * hot.velocity + 0.5 * dt * dt * cold.acceleration;
  hot.velocity += dt * cold.acceleration;
  cold.spin += dt * cold.turning;
}

template <int D>
double HardEngine<D>::slid(std::int32_t g, double time) const {
  const Cold& c = cold_[g];
  const Vector& v = hot_[g].velocity;
  const SpinOf<D> spin = c.spin + time * c.turning;
  return 0.5 / c.inverse_mass * (v.squaredNorm() - (v + time * c.acceleration).squaredNorm()) +
         0.5 / c.inverse_inertia * (square_of(c.spin) - square_of(spin));
}

/// What others have planned with it is void.
template <int D>
void HardEngine<D>::change(std::int32_t g) {
  ++hot_[g].number;
  if (hot_[g].motion != Motion::lies) return;
  hot_[g].motion = Motion::free;
  cold_[g].floor = -1;
  cold_[g].settles = kNever;
  cold_[g].slides_until = -kNever;
}

template <int D>
Body<D> HardEngine<D>::as_body(std::int32_t g) const {
  Body<D> out;
  out.position = hot_[g].position;
  out.velocity = hot_[g].velocity;
  out.spin = cold_[g].spin;
  out.radius = hot_[g].radius;
  out.inverse_mass = cold_[g].inverse_mass;
  out.inverse_inertia = cold_[g].inverse_inertia;
  return out;
}

template <int D>
void HardEngine<D>::take(std::int32_t g, const Body<D>& body) {
  hot_[g].velocity = body.velocity;
  cold_[g].spin = body.spin;
}

template <int D>
Body<D> HardEngine<D>::body(std::size_t grain) const {
  const auto g = static_cast<std::int32_t>(grain);
  Body<D> out = as_body(g);
  const double dt = now_ - hot_[g].time;
  const Vector a = acceleration(g);
  out.position = inside(scene_.box, Vector(out.position + dt * out.velocity + 0.5 * dt * dt * a));
  out.velocity += dt * a;
  if (hot_[g].motion == Motion::lies) out.spin += dt * cold_[g].turning;
  return out;
}

template <int D>
double HardEngine<D>::settled(std::size_t grain) const {
  return clock_ + cold_[grain].settles;
}

template <int D>
double HardEngine<D>::kinetic_energy() const {
  double sum = 0;
  for (std::size_t k = 0; k < hot_.size(); ++k) {
    const Body<D> b = body(k);
    if (b.inverse_mass == 0) continue;
    sum += 0.5 * b.velocity.squaredNorm() / b.inverse_mass;
    if (b.inverse_inertia > 0) sum += 0.5 * square_of(b.spin) / b.inverse_inertia;
  }
  return sum;
}

template <int D>
double HardEngine<D>::lost() const {
  double sum = lost_;
  for (std::size_t k = 0; k < hot_.size(); ++k) {
    const auto g = static_cast<std::int32_t>(k);
    if (hot_[k].motion == Motion::lies) sum += slid(g, now_ - hot_[k].time);
  }
  return sum;
}

// -- planning

template <int D>
void HardEngine<D>::look_at(std::int32_t g, std::int32_t other, const Vector& shift,
                            Plan& plan) const {
  if (other == g) return;
  const Hot &a = hot_[g], &b = hot_[other];
  const double dt = now_ - b.time, distance = a.radius + b.radius;
  double time = 0;
  if (a.motion == Motion::free && b.motion == Motion::free) {
    Vector r = b.position + shift - a.position + dt * b.velocity;
    if (!weighs_) {
      time = meet_time(r, a.velocity, b.velocity, distance);
    } else {
      r += 0.5 * dt * dt * scene_.gravity;
      time = meet_time(r, a.velocity, Vector(b.velocity + dt * scene_.gravity), distance);
    }
  } else {
    if (cold_[g].inverse_mass + cold_[other].inverse_mass == 0) return;
    const Vector accel = acceleration(other);
    const Vector r = b.position + shift - a.position + dt * b.velocity + 0.5 * dt * dt * accel;
    const Vector v = b.velocity + dt * accel;
    time = meet_time(r, a.velocity, v, Vector(accel - acceleration(g)), distance);
  }
  time += now_;
  if (time < plan.meets || (time == plan.meets && time < kNever && other < plan.partner)) {
    plan.meets = time;
    plan.partner = other;
    plan.number = b.number;
  }
}

template <int D>
void HardEngine<D>::look_around(std::int32_t g) {
  Plan& plan = plans_[g];
  plan.meets = kNever;
  plan.partner = -1;
  cells_.near(hot_[g].cell,
              [&](std::int32_t other, const Vector& shift) { look_at(g, other, shift, plan); });
}

/// Its earliest event alone, at its own time now.
template <int D>
void HardEngine<D>::look_ahead(std::int32_t g) {
  const Hot& hot = hot_[g];
  const Vector a = acceleration(g);
  Plan& plan = plans_[g];
  plan.alone = kNever;
  const auto add = [&](double time, std::int32_t what) {
    if (time >= plan.alone) return;
    plan.alone = time;
    plan.what = what;
  };
  for (std::size_t w = 0; w < scene_.walls.size(); ++w) {
    const HardWall<D>& wall = scene_.walls[w];
    if (hot.motion == Motion::fixed ||
        (hot.motion == Motion::lies && cold_[g].floor == static_cast<std::int32_t>(w))) {
      continue;
    }
    const double height = (hot.position - wall.place(time())).dot(wall.normal) - hot.radius;
    const double rise = (hot.velocity - wall.velocity).dot(wall.normal);
    add(now_ + fall_time(height, rise, a.dot(wall.normal)), static_cast<std::int32_t>(w));
  }
  for (int axis = 0; axis < D; ++axis) {
    const auto [low, high] = cells_.faces(hot.cell, axis);
    const double x = hot.position[axis], v = hot.velocity[axis];
    add(now_ + fall_time(x - low, v, a[axis]), face_code(axis, -1));
    add(now_ + fall_time(high - x, -v, -a[axis]), face_code(axis, 1));
  }
  if (hot.motion == Motion::lies) {
    if (cold_[g].slides_until >= now_) add(cold_[g].slides_until, kStopsSliding);
    if (cold_[g].settles > now_) add(cold_[g].settles, kSettles);
  }
}

template <int D>
void HardEngine<D>::plan(std::int32_t g) {
  queue_.plan(static_cast<std::uint32_t>(g), std::min(plans_[g].meets, plans_[g].alone));
}

// -- events

template <int D>
long HardEngine<D>::advance(long events, double until) {
  long done = 0;
  while (done < events) {
    const EventQueue::Event* next = queue_.earliest();
    if (next == nullptr || next->time > until - clock_) {
      if (std::isfinite(until)) now_ = std::max(now_, until - clock_);
      break;
    }
    now_ = std::max(now_, next->time);
    happen(static_cast<std::int32_t>(next->grain));
    ++done;
    ++tally_.events;
    if (--until_restart_ == 0) restart_clock();
  }
  return done;
}

template <int D>
void HardEngine<D>::happen(std::int32_t g) {
  const Plan& plan = plans_[g];
  if (plan.meets <= plan.alone) {
    collide_with_partner(g);
  } else if (plan.what >= 0) {
    hit(g, plan.what);
  } else if (plan.what == kStopsSliding) {
    stop_sliding(g);
  } else if (plan.what == kSettles) {
    fly(g);
    cold_[g].settles = now_;
    look_ahead(g);
    this->plan(g);
  } else {
    cross(g, plan.what);
  }
}

template <int D>
bool HardEngine<D>::is_recent(std::int32_t g) const {
  return now_ - cold_[g].last < scene_.contact_time;
}

template <int D>
void HardEngine<D>::note_collision(std::int32_t g, std::int32_t wall) {
  Cold& cold = cold_[g];
  cold.at_once = now_ > cold.last ? 0 : cold.at_once + 1;
  cold.last = now_;
  cold.last_wall = wall;
  if (cold.at_once < kMostAtOnce) return;
  throw ComputationFailed(fmt::format(
      "hard grains: grain {} collided {} times at t = {:.6g} s, an inelastic collapse with a "
      "contact time of {:g} s: raise the contact time, or the restitution",
      g, kMostAtOnce, time(), scene_.contact_time));
}

template <int D>
void HardEngine<D>::collide_with_partner(std::int32_t g) {
  const std::int32_t other = plans_[g].partner;
  fly(g);
  if (hot_[other].number != plans_[g].number) {
    ++tally_.repeated;
    look_around(g);
    plan(g);
    return;
  }
  fly(other);
  Body<D> a = as_body(g), b = as_body(other);
  const Vector way = nearest_way(scene_.box, a.position, b.position);
  const double distance = way.norm();
  const Vector n = way / distance;
  const bool elastic = is_recent(g) || is_recent(other);
  const Impact<D> impact = collide<D>(a, b, n, elastic ? ImpactLaw() : scene_.grains);
  const double press = (acceleration(g) - acceleration(other)).dot(n);
  const Push push = push_apart<D>(a, b, n, 0.5 * press * scene_.contact_time);
  change(g);
  change(other);
  take(g, a);
  take(other, b);
  note_collision(g, -1);
  note_collision(other, -1);
  ++tally_.pairs;
  tally_.elastic += elastic;
  tally_.virial += distance * (impact.normal + push.impulse);
  lost_ += impact.lost - push.gain;
  tally_.deepest = std::max(tally_.deepest, 1 - distance / (a.radius + b.radius));
  for (const std::int32_t k : {g, other}) {
    look_ahead(k);
    look_around(k);
    plan(k);
  }
}

template <int D>
void HardEngine<D>::hit(std::int32_t g, std::int32_t w) {
  const HardWall<D>& wall = scene_.walls[w];
  fly(g);
  const bool again = cold_[g].last_wall == w, elastic = is_recent(g) && !(again && is_floor_[w]);
  Body<D> a = as_body(g), b = wall.body();
  const Impact<D> impact = collide<D>(a, b, Vector(-wall.normal), elastic ? ImpactLaw() : wall.law);
  const double press = is_floor_[w] ? 0 : -acceleration(g).dot(wall.normal);
  const Push push = push_apart<D>(b, a, wall.normal, 0.5 * press * scene_.contact_time);
  wall_impulses_[w] += (hot_[g].velocity - a.velocity) / a.inverse_mass;
  change(g);
  take(g, a);
  note_collision(g, w);
  ++tally_.walls;
  tally_.elastic += elastic;
  lost_ += impact.lost - push.gain;
  if (is_floor_[w] && !elastic) {
    const double up = hot_[g].velocity.dot(wall.normal);
    if (2 * up < scene_.contact_time * scene_.gravity.norm()) lie_down(g, w, up);
  }
  look_ahead(g);
  look_around(g);
  plan(g);
}

template <int D>
void HardEngine<D>::lie_down(std::int32_t g, std::int32_t w, double up) {
  const HardWall<D>& wall = scene_.walls[w];
  const double gravity = scene_.gravity.norm();
  Hot& hot = hot_[g];
  Cold& cold = cold_[g];
  hot.motion = Motion::lies;
  hot.velocity -= up * wall.normal;
  lost_ += 0.5 * up * up / cold.inverse_mass;
  cold.floor = w;
  cold.settles = now_ + 2 * up / (gravity * (1 - wall.law.restitution));
  const Sliding<D> sliding =
      sliding_of(as_body(g), wall.normal, gravity, wall.law.friction, kLevel);
  cold.acceleration = sliding.acceleration;
  cold.turning = sliding.turning;
  cold.slides_until = sliding.time > 0 ? now_ + sliding.time : -kNever;
}

template <int D>
void HardEngine<D>::stop_sliding(std::int32_t g) {
  fly(g);
  ++hot_[g].number;
  cold_[g].acceleration = Vector::Zero();
  cold_[g].turning = zero<SpinOf<D>>();
  cold_[g].slides_until = -kNever;
  look_ahead(g);
  look_around(g);
  plan(g);
}

template <int D>
void HardEngine<D>::cross(std::int32_t g, std::int32_t face) {
  fly(g);
  const int axis = (-1 - face) / 2, way = (-1 - face) % 2 == 1 ? 1 : -1;
  const auto beside = cells_.beside(hot_[g].cell, axis, way);
  cells_.take(g, hot_[g].cell);
  hot_[g].cell = beside.cell;
  hot_[g].position[axis] += beside.shift;
  cells_.put(g, beside.cell);
  ++tally_.crossings;
  look_ahead(g);
  cells_.near_after(beside.cell, axis, way, [&](std::int32_t other, const Vector& shift) {
    look_at(g, other, shift, plans_[g]);
  });
  plan(g);
}

template <int D>
void HardEngine<D>::restart_clock() {
  until_restart_ = kEventsPerClock * static_cast<long>(hot_.size());
  const double passed = now_;
  clock_ += passed;
  now_ = 0;
  for (Hot& hot : hot_) hot.time -= passed;
  for (Cold& cold : cold_) {
    cold.last -= passed;
    cold.settles -= passed;
    cold.slides_until -= passed;
  }
  for (Plan& p : plans_) {
    p.meets -= passed;
    p.alone -= passed;
  }
  const auto n = static_cast<std::int32_t>(hot_.size());
  queue_ = EventQueue(hot_.size());
  for (std::int32_t g = 0; g < n; ++g) plan(g);
}

template class HardEngine<2>;
template class HardEngine<3>;

}  // namespace grainfield::dem
