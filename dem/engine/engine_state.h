// What the step loop tells of its state: contacts, diagnostics, snapshots, checkpoints.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "dem/engine/engine_loop.h"

namespace grainfield::dem {

/// visit(first grain, pair, force, is a wall, overlap) for every contact that carried force in the
/// last step.
template <class Shape, class Law, class Integrator>
template <class Visit>
void EngineLoop<Shape, Law, Integrator>::visit_contacts(Visit visit) const {
  if (pair_start_.empty()) return;
  Overlap o;
  PairFeature feature;
  for (int i = 0; i + 1 < static_cast<int>(pair_start_.size()); ++i) {
    const Body& a = bodies_[i];
    for (int k = pair_start_[i]; k < pair_start_[i + 1]; ++k) {
      const ContactForce& f = pair_forces_[k];
      const Body& b = bodies_[pairs_[k].j];
      if ((f.fx != 0 || f.fy != 0) &&
          shapes_.template overlap<Law::needs_area>(i, a, pairs_[k].j, b, feature, o)) {
        visit(i, pairs_[k], f, false, o);
      }
    }
    for (int k = wall_start_[i]; k < wall_start_[i + 1]; ++k) {
      const ContactForce& f = wall_forces_[k];
      if ((f.fx != 0 || f.fy != 0) && overlap_with_wall(i, walls_[wall_pairs_[k].j], o)) {
        visit(i, wall_pairs_[k], f, true, o);
      }
    }
  }
  if (frozen_.empty()) return;
  std::vector<int> index(ids_.size());
  for (int i = 0; i < static_cast<int>(ids_.size()); ++i) index[ids_[i]] = i;
  for (const Frozen& frozen : sorted_frozen()) {
    const int i = index[frozen.key >> 32];
    const auto high = static_cast<std::uint32_t>(frozen.key);
    const std::uint32_t wall = 0xFFFFFFFFu - high;
    const bool is_wall = wall < walls_.size();
    Pair pair;
    pair.spring = frozen.spring;
    pair.j = is_wall ? static_cast<int>(wall) : index[high];
    const ContactForce f{frozen.fx, frozen.fy, frozen.torque_low, frozen.torque_high};
    const bool touches = is_wall ? overlap_with_wall(i, walls_[wall], o)
                                 : shapes_.template overlap<Law::needs_area>(
                                       i, bodies_[i], pair.j, bodies_[pair.j], feature, o);
    if (touches && (f.fx != 0 || f.fy != 0)) visit(i, pair, f, is_wall, o);
  }
}

/// The frozen contacts in an order that no hash decides.
template <class Shape, class Law, class Integrator>
auto EngineLoop<Shape, Law, Integrator>::sorted_frozen() const -> std::vector<Frozen> {
  std::vector<Frozen> list;
  list.reserve(frozen_.size());
  for (const auto& [key, frozen] : frozen_) list.push_back(frozen);
  std::sort(list.begin(), list.end(),
            [](const Frozen& a, const Frozen& b) { return a.key < b.key; });
  return list;
}

template <class Shape, class Law, class Integrator>
Diagnostics EngineLoop<Shape, Law, Integrator>::measure() const {
  Diagnostics d;
  const int n = static_cast<int>(bodies_.size());
  std::vector<std::array<double, 2>> resultant(n, {0, 0});
  double force_sum = 0;
  visit_contacts([&](int i, const Pair& pair, const ContactForce& f, bool wall, const Overlap& o) {
    ++d.contacts;
    force_sum += std::hypot(f.fx, f.fy);
    d.elastic_energy += law_.energy(o, pair.spring);
    const double radius =
        wall ? bodies_[i].radius : std::min(bodies_[i].radius, bodies_[pair.j].radius);
    d.max_overlap_ratio = std::max(d.max_overlap_ratio, o.depth / radius);
    const double normal = -(f.fx * o.nx + f.fy * o.ny);
    const double tangential = f.fy * o.nx - f.fx * o.ny;
    const double mu = wall ? walls_[pair.j].friction : settings_.friction;
    if (mu > 0 && std::fabs(tangential) >= mu * normal * (1 - kSlidingMargin)) ++d.sliding;
    resultant[i][0] += f.fx;
    resultant[i][1] += f.fy;
    if (!wall) {
      resultant[pair.j][0] -= f.fx;
      resultant[pair.j][1] -= f.fy;
    }
  });
  d.height = -std::numeric_limits<double>::infinity();
  const auto [load_x, load_y] = applied_at(time());
  for (int i = 0; i < n; ++i) {
    const Body& b = bodies_[i];
    if (b.inverse_mass == 0) continue;
    const double mass = inertias_[i].mass;
    double fx = resultant[i][0] + mass * settings_.gravity_x;
    double fy = resultant[i][1] + mass * settings_.gravity_y;
    if (i == applied_index_) {
      fx += load_x;
      fy += load_y;
    }
    const double size = std::hypot(fx, fy);
    d.mean_unbalanced_force += size;
    d.max_unbalanced_force = std::max(d.max_unbalanced_force, size);
    d.height = std::max(d.height, b.y + b.radius);
  }
  if (free_ > 0) d.mean_unbalanced_force /= free_;
  if (d.contacts > 0) d.mean_contact_force = force_sum / d.contacts;
  d.unbalanced_force_ratio = d.mean_contact_force > 0
                                 ? d.mean_unbalanced_force / d.mean_contact_force
                                 : std::numeric_limits<double>::infinity();
  const Motion m = motion();
  d.kinetic_energy = m.kinetic_energy;
  d.awake = m.awake;
  if (!std::isfinite(d.kinetic_energy) || !std::isfinite(d.elastic_energy)) {
    throw ComputationFailed(fmt::format(
        "the energy is not a finite number at t = {:.6g} s (step {}): kinetic {:g} J, elastic {:g} "
        "J; lower motion.time_step (now {:.3g} s), damping or stiffness, or give grains of a usual "
        "size",
        time(), steps_, d.kinetic_energy, d.elastic_energy, settings_.time_step));
  }
  return d;
}

template <class Shape, class Law, class Integrator>
Motion EngineLoop<Shape, Law, Integrator>::motion() const {
  Motion m;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& b = bodies_[i];
    if (b.inverse_mass == 0) continue;
    if (!asleep_[i]) ++m.awake;
    m.kinetic_energy += 0.5 * inertias_[i].mass * (b.vx * b.vx + b.vy * b.vy) +
                        (b.inverse_inertia > 0 ? 0.5 * b.spin * b.spin / b.inverse_inertia : 0.0);
  }
  return m;
}

template <class Shape, class Law, class Integrator>
Snapshot EngineLoop<Shape, Law, Integrator>::snapshot() const {
  Snapshot s;
  s.time = time();
  s.gravity = Vec3(settings_.gravity_x, settings_.gravity_y, 0);
  s.walls = walls_;
  const int n = static_cast<int>(bodies_.size());
  s.grains.resize(n);
  for (int i = 0; i < n; ++i) {
    const Body& b = bodies_[i];
    Grain& g = s.grains[ids_[i]];  // ids are 0..n-1
    g.id = ids_[i];
    g.position = Vec3(b.x, b.y, 0);
    g.velocity = Vec3(b.vx, b.vy, 0);
    g.angle = memory_[i].angle;
    g.spin = b.spin;
    g.radius = b.radius;
    g.mass = inertias_[i].mass;
    g.inertia = inertias_[i].polar;
    g.volume = inertias_[i].area;
    g.fixed = b.inverse_mass == 0;
    g.outline = shapes_.outline(i);
  }
  if (applied_index_ >= 0) {
    const auto [fx, fy] = applied_at(time());
    s.loaded_grain = applied_.id;
    s.applied_force = Vec3(fx, fy, 0);
  }
  visit_contacts([&](int i, const Pair& pair, const ContactForce& f, bool wall, const Overlap& o) {
    const Body& a = bodies_[i];
    Contact c;
    c.i = ids_[i];
    const auto [px, py] = point_of(a, o);
    c.point = Vec3(px, py, 0);
    c.normal = Vec3(o.nx, o.ny, 0);
    c.force = Vec3(f.fx, f.fy, 0);
    c.j = wall ? -1 - pair.j : ids_[pair.j];
    if (!wall && c.j < c.i) {
      std::swap(c.i, c.j);
      c.normal = -c.normal;
      c.force = -c.force;
    }
    c.normal_force = -(f.fx * o.nx + f.fy * o.ny);
    c.tangential_force = f.fy * o.nx - f.fx * o.ny;
    c.spring = pair.spring;
    c.friction = wall ? walls_[pair.j].friction : settings_.friction;
    c.sliding = c.friction > 0 &&
                std::fabs(c.tangential_force) >= c.friction * c.normal_force * (1 - kSlidingMargin);
    s.contacts.push_back(c);
  });
  std::sort(s.contacts.begin(), s.contacts.end(),
            [](const Contact& a, const Contact& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; });
  s.attributes["integrator"] = Integrator::name;
  s.attributes["law"] = Law::name;
  s.attributes["time_step"] = fmt::format("{:.17g}", settings_.time_step);
  return s;
}

/// As frozen contacts without force: the next search hands their springs on.
template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::remember(const std::vector<Contact>& contacts) {
  for (const Contact& c : contacts) {
    const Key key = c.j < 0 ? wall_key(c.i, static_cast<int>(-1 - c.j)) : pair_key(c.i, c.j);
    Frozen frozen;
    frozen.key = key;
    frozen.spring = c.spring;
    frozen_[key] = frozen;
  }
  search_needed_ = true;
}

/// each(value) for all that an image holds but the frozen contacts and the shapes, in its order.
template <class Shape, class Law, class Integrator>
template <class Loop, class Each>
void EngineLoop<Shape, Law, Integrator>::visit_state(Loop& loop, Each each) {
  each(loop.background_);
  each(loop.applied_);
  each(loop.steps_);
  each(loop.free_);
  each(loop.first_new_);
  each(loop.skin_);
  each(loop.skin_share_);
  each(loop.last_by_motion_);
  each(loop.search_needed_);
  each(loop.settings_.gravity_x);
  each(loop.settings_.gravity_y);
  each(loop.settings_.sleep.on);
  each(loop.awake_);
  each(loop.sleepers_changed_);
  each(loop.bodies_);
  each(loop.memory_);
  each(loop.inertias_);
  each(loop.ids_);
  each(loop.reference_);
  each(loop.asleep_);
  each(loop.quiet_);
  each(loop.rests_);
  each(loop.touches_);
  each(loop.pair_start_);
  each(loop.wall_start_);
  each(loop.pairs_);
  each(loop.wall_pairs_);
  each(loop.pair_forces_);
  each(loop.wall_forces_);
  each(loop.felt_);
}

template <class Shape, class Law, class Integrator>
std::string EngineLoop<Shape, Law, Integrator>::image() const {
  ImageWriter w;
  visit_state(*this, [&w](const auto& value) { w.put(value); });
  w.put(sorted_frozen());
  shapes_.write(w);
  return w.bytes();
}

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::restore(const std::string& image) {
  ImageReader r(image);
  visit_state(*this, [&r](auto& value) { r.get(value); });
  std::vector<Frozen> frozen;
  r.get(frozen);
  frozen_.clear();
  for (const Frozen& f : frozen) frozen_[f.key] = f;
  shapes_.read(r, bodies_.size());
  r.finish();
  const int n = static_cast<int>(bodies_.size());
  for (const Pair& p : pairs_) r.require(p.j >= 0 && p.j < n);
  for (const Pair& p : wall_pairs_) r.require(p.j >= 0 && p.j < static_cast<int>(walls_.size()));
  r.require(awake_ >= 0 && awake_ <= n);
  const auto rows_fit = [&](const std::vector<int>& start, std::size_t pairs) {
    return static_cast<int>(start.size()) == awake_ + 1 && start.front() == 0 &&
           start.back() == static_cast<int>(pairs) && std::is_sorted(start.begin(), start.end());
  };
  if (!search_needed_) {
    r.require(pairs_.size() >= kAhead && rows_fit(pair_start_, pairs_.size() - kAhead) &&
              rows_fit(wall_start_, wall_pairs_.size()) &&
              reference_.size() == static_cast<std::size_t>(awake_));
  }
  const std::size_t all = bodies_.size();
  r.require(memory_.size() == all && ids_.size() == all && inertias_.size() == all &&
            asleep_.size() == all && quiet_.size() == all && rests_.size() == all &&
            touches_.size() == all && pair_forces_.size() == pairs_.size() &&
            felt_.size() == pairs_.size() && wall_forces_.size() == wall_pairs_.size());
  if (search_needed_) {
    sleepers_changed_ = true;
  } else {
    index_contacts();
    build_sleepers_grid();  // a review may ask it before the next search
  }
  locate_applied();
}

}  // namespace grainfield::dem
