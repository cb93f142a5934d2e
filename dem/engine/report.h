// What a world tells of its state: contacts, diagnostics, snapshots.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "dem/engine/engine.h"
#include "dem/engine/turning.h"
#include "dem/engine/world.h"

namespace grainfield::dem {

template <class World>
class Report {
 public:
  static constexpr int dim = World::dim;
  using Pair = typename World::Pair;
  using Force = ContactForce<dim>;
  using Overlap = typename World::Overlap;

  explicit Report(const World& world) : world_(world) {}

  /// visit(first grain, pair, force, is a wall, overlap) for every contact that carried force in
  /// the last step.
  template <class Visit>
  void visit_contacts(Visit visit) const {
    const auto& contacts = world_.contacts;
    Overlap o;
    for (int i = 0; i < contacts.pairs.rows(); ++i) {
      for (int k = contacts.pairs.first(i); k < contacts.pairs.last(i); ++k) {
        const Force& f = contacts.pair_forces[k];
        if (pushes(f) && overlap(i, contacts.pairs[k].j, false, o)) {
          visit(i, contacts.pairs[k], f, false, o);
        }
      }
      for (int k = contacts.walls.first(i); k < contacts.walls.last(i); ++k) {
        const Force& f = contacts.wall_forces[k];
        if (pushes(f) && overlap(i, contacts.walls[k].j, true, o)) {
          visit(i, contacts.walls[k], f, true, o);
        }
      }
    }
    if (world_.sleepers.frozen.empty()) return;
    const std::vector<int> index = world_.grains.index();
    for (const auto& frozen : world_.sleepers.frozen.sorted()) {
      const int i = index[first_of(frozen.key)], wall = wall_of(frozen.key, world_.walls.size());
      Pair pair;
      pair.memory = frozen.memory;
      pair.j = wall >= 0 ? wall : index[second_of(frozen.key)];
      if (pushes(frozen.force) && overlap(i, pair.j, wall >= 0, o)) {
        visit(i, pair, frozen.force, wall >= 0, o);
      }
    }
  }

  Diagnostics measure() const {
    Diagnostics d;
    const auto& bodies = world_.grains.bodies;
    std::vector<typename World::Vector> resultant(bodies.size(), World::Vector::Zero());
    double force_sum = 0;
    visit_contacts([&](int i, const Pair& pair, const Force& f, bool wall, const Overlap& o) {
      ++d.contacts;
      force_sum += length_of(f.force);
      d.elastic_energy += rule(i, pair, wall).law.energy(o, pair.memory);
      const double radius =
          wall ? bodies[i].radius : std::min(bodies[i].radius, bodies[pair.j].radius);
      d.max_overlap_ratio = std::max(d.max_overlap_ratio, o.depth / radius);
      if (is_sliding(f, o, rule(i, pair, wall).friction)) ++d.sliding;
      resultant[i] += f.force;
      if (!wall) resultant[pair.j] -= f.force;
    });
    d.height = -std::numeric_limits<double>::infinity();
    const typename World::Vector applied = world_.around.applied_at(world_.time());
    int free = 0;
    for (int i = 0; i < world_.grains.size(); ++i) {
      if (world_.grains.is_fixed(i)) continue;
      ++free;
      typename World::Vector force = resultant[i] + world_.weight(i);
      if (i == world_.applied_index) force += applied;
      const double size = length_of(force);
      d.mean_unbalanced_force += size;
      d.max_unbalanced_force = std::max(d.max_unbalanced_force, size);
      d.height = std::max(d.height, bodies[i].position[dim - 1] + bodies[i].radius);
    }
    if (free > 0) d.mean_unbalanced_force /= free;
    if (d.contacts > 0) d.mean_contact_force = force_sum / d.contacts;
    d.unbalanced_force_ratio = d.mean_contact_force > 0
                                   ? d.mean_unbalanced_force / d.mean_contact_force
                                   : std::numeric_limits<double>::infinity();
    const Motion m = motion();
    d.kinetic_energy = m.kinetic_energy;
    d.awake = m.awake;
    if (!std::isfinite(d.kinetic_energy) || !std::isfinite(d.elastic_energy)) {
      throw ComputationFailed(fmt::format(
          "the energy is not a finite number at t = {:.6g} s (step {}): kinetic {:g} J, elastic "
          "{:g} J; lower motion.time_step (now {:.3g} s), damping or stiffness, or give grains of "
          "a "
          "usual size",
          world_.time(), world_.steps, d.kinetic_energy, d.elastic_energy, world_.time_step));
    }
    return d;
  }

  Motion motion() const {
    Motion m;
    for (int i = 0; i < world_.grains.size(); ++i) {
      const auto& b = world_.grains.bodies[i];
      if (world_.grains.is_fixed(i)) continue;
      if (!world_.sleepers.is_asleep(i)) ++m.awake;
      m.kinetic_energy += 0.5 * world_.grains.inertias[i].mass * b.velocity.squaredNorm() +
                          turning_energy(b, world_.rotation(i), world_.grains.inertias[i]);
    }
    return m;
  }

  Snapshot snapshot() const {
    Snapshot s;
    s.dim = dim;
    s.time = world_.time();
    s.gravity = to_three(world_.around.gravity);
    s.walls = world_.walls.all();
    s.grains.resize(world_.grains.bodies.size());
    for (int i = 0; i < world_.grains.size(); ++i) {
      Grain& g = s.grains[world_.grains.ids[i]];  // ids are 0..n-1
      g.id = world_.grains.ids[i];
      fill(g, i);
    }
    if (world_.applied_index >= 0) {
      s.loaded_grain = world_.around.applied.id;
      s.applied_force = to_three(world_.around.applied_at(world_.time()));
    }
    visit_contacts([&](int i, const Pair& pair, const Force& f, bool wall, const Overlap& o) {
      s.contacts.push_back(contact(i, pair, f, wall, o));
    });
    std::sort(s.contacts.begin(), s.contacts.end(), [](const Contact& a, const Contact& b) {
      return a.i != b.i ? a.i < b.i : a.j < b.j;
    });
    s.attributes["integrator"] = world_.integrator;
    s.attributes["law"] = World::Law::name;
    s.attributes["time_step"] = fmt::format("{:.17g}", world_.time_step);
    return s;
  }

 private:
  static bool pushes(const Force& f) { return !f.force.isZero(0); }

  bool overlap(int i, int j, bool wall, Overlap& o) const {
    const auto& grains = world_.grains;
    if (wall) {
      return world_.acting.overlap(grains.shapes, i, grains.bodies[i], world_.walls.plane(j), o);
    }
    typename World::Shape::Feature feature;
    return world_.acting.overlap(grains.shapes, i, grains.bodies[i], j, grains.bodies[j], feature,
                                 o);
  }

  const auto& rule(int i, const Pair& pair, bool wall) const {
    return wall ? world_.wall_rule(i, pair.j) : world_.pair_rule(i, pair.j);
  }

  static bool is_sliding(const Force& f, const Overlap& o, double mu) {
    return mu > 0 && size_of(tangential_of(f.force, o)) >=
                         mu * repulsion_of(f.force, o) * (1 - kSlidingMargin);
  }

  void fill(Grain& g, int i) const {
    const auto& b = world_.grains.bodies[i];
    const auto& inertia = world_.grains.inertias[i];
    g.position = to_three(b.position);
    g.velocity = to_three(b.velocity);
    g.radius = b.radius;
    g.mass = inertia.mass;
    g.volume = inertia.volume;
    g.fixed = world_.grains.is_fixed(i);
    tell_turning(b, world_.rotation(i), inertia, g);
    g.outline = world_.grains.shapes.outline(i);
  }

  Contact contact(int i, const Pair& pair, const Force& f, bool wall, const Overlap& o) const {
    const auto& ids = world_.grains.ids;
    Contact c;
    c.i = ids[i];
    c.j = wall ? -1 - pair.j : ids[pair.j];
    c.point = to_three(point_at<World::Acting::central>(world_.grains.bodies[i], o));
    c.normal = to_three(normal_of(o));
    c.force = to_three(f.force);
    c.normal_force = repulsion_of(f.force, o);
    c.tangential_force = signed_size_of(tangential_of(f.force, o));
    c.friction = rule(i, pair, wall).friction;
    c.sliding = is_sliding(f, o, c.friction);
    const bool turned = !wall && c.j < c.i;
    tell_spring(seen_from(pair.memory, turned).spring, c);
    if (turned) {
      std::swap(c.i, c.j);
      c.normal = -c.normal;
      c.force = -c.force;
    }
    return c;
  }

  const World& world_;
};

}  // namespace grainfield::dem
