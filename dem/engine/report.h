// What a world tells of its state: contacts, diagnostics, snapshots.
#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "dem/engine/engine.h"
#include "dem/engine/turning.h"
#include "dem/engine/world.h"
#include "dem/snapshot/added_forces_mark.h"
#include "dem/snapshot/cell_stress.h"

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
  /// the last step, with what forces of the caller's own do in it.
  template <class Visit>
  void visit_contacts(Visit visit) const {
    visit_listed([&](int i, int /*k*/, const Pair& pair, const Force& f, bool wall,
                     const Overlap& o) { visit(i, pair, f, wall, o); });
  }
  /// The same with its place in the list behind the first grain; -1: it is frozen.
  template <class Visit>
  void visit_listed(Visit visit) const {
    const auto& contacts = world_.contacts;
    Overlap o;
    for (int i = 0; i < contacts.pairs.rows(); ++i) {
      for (int k = contacts.pairs.first(i); k < contacts.pairs.last(i); ++k) {
        const Force f = with_added(contacts.pair_forces[k], i, contacts.pairs[k], false);
        if (pushes(f) && overlap(i, contacts.pairs[k].j, false, o, contacts.pairs[k].feature)) {
          visit(i, k, contacts.pairs[k], f, false, o);
        }
      }
      for (int k = contacts.walls.first(i); k < contacts.walls.last(i); ++k) {
        const int slot = contacts.walls[k].j;
        if (!world_.walls.is_plain(slot)) {
          visit_wall(world_, i, world_.grains.bodies[i], k,
                     [&](int, int at, const Overlap& overlap, const auto&, const auto&) {
                       const Force f =
                           with_added(contacts.wall_forces[at], i, contacts.walls[at], true);
                       if (pushes(f)) visit(i, at, contacts.walls[at], f, true, overlap);
                     });
          k += world_.walls.slots_of(world_.walls.wall_of(slot)) - 1;
          continue;
        }
        const Force f = with_added(contacts.wall_forces[k], i, contacts.walls[k], true);
        if (pushes(f) && overlap(i, slot, true, o)) visit(i, k, contacts.walls[k], f, true, o);
      }
    }
    if (world_.sleepers.frozen.empty()) return;
    const std::vector<int> index = world_.grains.index();
    for (const auto& frozen : world_.sleepers.frozen.sorted()) {
      const int i = index[first_of(frozen.key)], wall = wall_of(frozen.key, world_.walls.slots());
      Pair pair;
      pair.memory = frozen.memory;
      pair.j = wall >= 0 ? wall : index[second_of(frozen.key)];
      if (pushes(frozen.force) && overlap(i, pair.j, wall >= 0, o)) {
        visit(i, -1, pair, frozen.force, wall >= 0, o);
      }
    }
  }

  Diagnostics measure() const {
    Diagnostics d;
    const auto& bodies = world_.grains.bodies;
    std::vector<typename World::Vector> resultant(bodies.size(), World::Vector::Zero());
    std::vector<SpinOf<dim>> moment(bodies.size(), zero<SpinOf<dim>>());
    double force_sum = 0;
    visit_listed([&](int i, int k, const Pair& pair, const Force& f, bool wall, const Overlap& o) {
      ++d.contacts;
      force_sum += length_of(f.force);
      d.elastic_energy += rule(i, pair, wall).law.energy(o, pair.memory).total();
      if (world_.rolling.on)
        d.elastic_energy += rule(i, pair, wall).rolling.energy(rolling(i, k, pair, wall));
      const double radius =
          wall ? bodies[i].radius : std::min(bodies[i].radius, bodies[pair.j].radius);
      d.max_overlap_ratio = std::max(d.max_overlap_ratio, o.depth / radius);
      const Force own = of_law(f, i, pair, wall);
      if (is_sliding(own, o, rule(i, pair, wall).friction)) ++d.sliding;
      resultant[i] += own.force;
      moment[i] += own.torque_i;
      if (wall) return;
      resultant[pair.j] -= own.force;
      moment[pair.j] += own.torque_j;
    });
    for (int i = 0; world_.added.on() && i < world_.grains.size(); ++i) {
      const auto added = world_.added.of(world_.grains.ids[i]);
      resultant[i] += added.force;
      moment[i] += added.torque;
    }
    const auto& balance = world_.balance;
    if (balance.on) {  // bodies that part faster than their spring follows store energy, too
      const auto& list = world_.contacts;
      for (int k = 0; k < list.pairs.size(); ++k) {
        if (!pushes(list.pair_forces[k])) d.elastic_energy += balance.pairs[k].stored();
      }
      for (int k = 0; k < list.walls.size(); ++k) {
        if (!pushes(list.wall_forces[k])) d.elastic_energy += balance.walls[k].stored();
      }
    }
    d.energy_followed = balance.on;
    d.contact_losses = balance.gone_in_contacts();
    d.stopped_energy = balance.stopped;
    d.brought_energy = balance.brought_motion + d.contact_losses.stored;
    for (const auto& account : balance.outer) {
      d.damped_energy += account.damped;
      d.applied_work += account.work;
    }
    d.wall_work = world_.walls.work();
    d.height = -std::numeric_limits<double>::infinity();
    const typename World::Vector applied = world_.around.applied_at(world_.time());
    int free = 0, turning = 0;
    double moments = 0;
    for (int i = 0; i < world_.grains.size(); ++i) {
      if (world_.grains.is_fixed(i)) continue;
      ++free;
      d.potential_energy += potential_energy(i);
      typename World::Vector force = resultant[i] + world_.weight(i);
      if (world_.is_loaded(i)) force += applied;
      const double size = length_of(force);
      d.mean_unbalanced_force += size;
      d.max_unbalanced_force = std::max(d.max_unbalanced_force, size);
      if (bodies[i].inverse_inertia > 0) {
        ++turning;
        moments += size_of(moment[i]) / bodies[i].radius;
      }
      d.height = std::max(d.height, bodies[i].position[dim - 1] + bodies[i].radius);
    }
    if (free > 0) d.mean_unbalanced_force /= free;
    if (d.contacts > 0) d.mean_contact_force = force_sum / d.contacts;
    constexpr double inf = std::numeric_limits<double>::infinity();
    const bool pushes = d.mean_contact_force > 0;
    d.unbalanced_force_ratio = pushes ? d.mean_unbalanced_force / d.mean_contact_force : inf;
    d.unbalanced_moment_ratio =
        pushes ? moments / std::max(turning, 1) / d.mean_contact_force : inf;
    const Motion m = motion();
    d.kinetic_energy = m.kinetic_energy;
    d.awake = m.awake;
    if (balance.on) d.gravity_work = balance.brought_height - d.potential_energy;
    for (const double work : world_.grains.cell_work) d.cell_work += work;
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
      if (world_.grains.is_fixed(i)) continue;
      if (!world_.sleepers.is_asleep(i)) ++m.awake;
      m.kinetic_energy += kinetic_energy(i);
    }
    return m;
  }
  /// Kinetic energy of a free grain against the flow, J.
  double kinetic_energy(int i) const {
    const auto& grains = world_.grains;
    return 0.5 * grains.inertias[i].mass * world_.fluctuation(i).squaredNorm() +
           rotational_energy(grains.bodies[i], world_.rotation(i), grains.inertias[i]);
  }
  /// Potential energy of all free grains, J, as Diagnostics has it.
  double potential_energy() const {
    double sum = 0;
    for (int i = 0; i < world_.grains.size(); ++i) {
      if (!world_.grains.is_fixed(i)) sum += potential_energy(i);
    }
    return sum;
  }
  double potential_energy(int i) const {
    typename World::Vector place = world_.grains.bodies[i].position;
    if (world_.cell.is_periodic()) place += world_.cell.shift(world_.grains.images[i]);
    return -world_.weight(i).dot(place);
  }

  /// Force of all grains on a wall in the last step, and its torque about a place.
  std::pair<Vec3, Vec3> on_wall(int wall, const Vec3& about) const {
    Vec3 force(0, 0, 0), torque(0, 0, 0);
    visit_contacts([&](int i, const Pair& pair, const Force& f, bool at_wall, const Overlap& o) {
      if (!at_wall || world_.walls.wall_of(pair.j) != wall) return;
      const Vec3 on_it = -to_three(f.force);
      force += on_it;
      torque += torque_of(Vec3(contact_point(i, o) - about), on_it) + rolling_on_wall(f, o);
    });
    return {force, torque};
  }

  /// Where they are, how they move, and the forces on them.
  std::vector<Wall> walls() const {
    std::vector<Wall> walls;
    for (int w = 0; w < world_.walls.size(); ++w) walls.push_back(world_.walls.placed(w));
    visit_contacts([&](int i, const Pair& pair, const Force& f, bool at_wall, const Overlap& o) {
      if (!at_wall) return;
      Wall& wall = walls[world_.walls.wall_of(pair.j)];
      const Vec3 on_it = -to_three(f.force);
      wall.force += on_it;
      wall.torque +=
          torque_of(Vec3(contact_point(i, o) - wall.point), on_it) + rolling_on_wall(f, o);
    });
    return walls;
  }

  Snapshot snapshot() const {
    Snapshot s;
    s.dim = dim;
    s.time = world_.time();
    s.gravity = to_three(world_.around.gravity);
    s.walls = walls();
    s.cell = world_.cell.told();
    s.grains.resize(world_.grains.bodies.size());
    for (int i = 0; i < world_.grains.size(); ++i) {
      Grain& g = s.grains[world_.grains.ids[i]];  // ids are 0..n-1
      g.id = world_.grains.ids[i];
      fill(g, i);
    }
    if (world_.applied_index >= 0) {
      s.loaded_grain = world_.around.applied.id;
      s.also_loaded = world_.beside;
      s.applied_force = to_three(world_.around.applied_at(world_.time()));
    }
    visit_listed([&](int i, int k, const Pair& pair, const Force& f, bool wall, const Overlap& o) {
      const RollingMemory<dim> memory =
          world_.rolling.on ? rolling(i, k, pair, wall) : RollingMemory<dim>{};
      s.contacts.push_back(contact(i, pair, f, wall, o, memory));
    });
    // Stable: several contacts with one wall stay in their order, the nearest first.
    std::stable_sort(s.contacts.begin(), s.contacts.end(), [](const Contact& a, const Contact& b) {
      return a.i != b.i ? a.i < b.i : a.j < b.j;
    });
    s.attributes["integrator"] = world_.integrator;
    s.attributes["law"] = World::Law::name;
    s.attributes["time_step"] = fmt::format("{:.17g}", world_.time_step);
    if (world_.added.on()) s.attributes[kAddedForces] = world_.added.names();
    if (!world_.added.former.empty()) {
      s.attributes[kFormerAddedForces] = fmt::format("{}", fmt::join(world_.added.former, ", "));
    }
    return s;
  }

  CellStress cell_stress() const {
    const double volume = cell_volume(world_.cell.told(), dim);
    const auto& contacts = world_.contacts;
    const auto& bodies = world_.grains.bodies;
    using Matrix = Eigen::Matrix<double, dim, dim>;
    Matrix sum = Matrix::Zero(), motion = Matrix::Zero();
    for (int i = 0; i < contacts.pairs.rows(); ++i) {
      for (int k = contacts.pairs.first(i); k < contacts.pairs.last(i); ++k) {
        const Force f = with_added(contacts.pair_forces[k], i, contacts.pairs[k], false);
        if (!pushes(f)) continue;
        const int j = contacts.pairs[k].j;
        const typename World::Vector branch =
            bodies[j].position + world_.cell.shift(image_at(i, j)) - bodies[i].position;
        sum += f.force * branch.transpose();
      }
    }
    for (int i = 0; i < world_.grains.size(); ++i) {
      const typename World::Vector u = world_.fluctuation(i);
      motion -= world_.grains.inertias[i].mass * u * u.transpose();
    }
    CellStress out{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
    out.contacts.template topLeftCorner<dim, dim>() = sum / volume;
    out.motion.template topLeftCorner<dim, dim>() = motion / volume;
    return out;
  }

  /// What the law remembers of a contact beside its spring, from the overlap as it is.
  void take_up(int i, int j, bool wall, typename World::Memory& memory) const {
    if constexpr (requires(Overlap o) { World::Law::take_up(o, memory); }) {
      Overlap o;
      if (overlap(i, j, wall, o)) World::Law::take_up(o, memory);
    }
  }

 private:
  static bool pushes(const Force& f) { return !f.force.isZero(0); }

  Force added(int i, const Pair& pair, bool wall) const {
    const auto& ids = world_.grains.ids;
    if (wall) return world_.added.at(wall_key(ids[i], pair.j), false);
    return world_.added.at(pair_key(ids[i], ids[pair.j]), ids[i] > ids[pair.j]);
  }
  /// A contact's force by the law and by forces of the caller's own.
  Force with_added(const Force& f, int i, const Pair& pair, bool wall) const {
    Force all = f;
    if (world_.added.on()) AddedLoads<dim>::add(added(i, pair, wall), false, all);
    return all;
  }
  /// That of the law alone.
  Force of_law(const Force& all, int i, const Pair& pair, bool wall) const {
    if (!world_.added.on()) return all;
    const Force more = added(i, pair, wall);
    return {all.force - more.force, SpinOf<dim>(all.torque_i - more.torque_i),
            SpinOf<dim>(all.torque_j - more.torque_j)};
  }

  /// What contact k of a list, or (-1) a frozen one, remembers of rolling.
  RollingMemory<dim> rolling(int i, int k, const Pair& pair, bool wall) const {
    if (k >= 0) return wall ? world_.rolling.walls[k] : world_.rolling.pairs[k];
    const auto& ids = world_.grains.ids;
    return world_.rolling.told_of(wall ? wall_key(ids[i], pair.j) : pair_key(ids[i], ids[pair.j]));
  }
  /// The moment against rolling that a grain's contact puts on a wall, N m.
  Vec3 rolling_on_wall(const Force& f, const Overlap& o) const {
    if (!world_.rolling.on) return {0, 0, 0};
    const Force without =
        forces_at<World::Acting::central>(o, repulsion_of(f.force, o), tangential_of(f.force, o));
    return turning_to_three(SpinOf<dim>(without.torque_i - f.torque_i));
  }

  Vec3 contact_point(int i, const Overlap& o) const {
    return to_three(point_at<World::Acting::central>(world_.grains.bodies[i], o));
  }

  /// `j`: of a wall the slot, or, where it has several, the rank of the contact behind the first.
  /// `feature`: where a pair's contact is looked for first.
  bool overlap(int i, int j, bool wall, Overlap& o,
               typename World::Shape::Feature feature = {}) const {
    const auto& grains = world_.grains;
    if (wall && !world_.walls.is_plain(j)) {
      const int w = world_.walls.wall_of(j), rank = j - world_.walls.first_slot(w);
      Patch<dim> patches[kMostPatches];
      const auto& b = grains.bodies[i];
      if (world_.walls.touching(w, b.position, b.radius, patches) <= rank) return false;
      return world_.overlap_patch(i, b, patches[rank], o);
    }
    if (wall) {
      return world_.acting.overlap(grains.shapes, i, grains.bodies[i], world_.walls.plane(j), o);
    }
    const PairImage image = image_at(i, j);
    const typename World::Body other = world_.image_of(grains.bodies[j], image);
    return world_.overlap(i, grains.bodies[i], j, other, image, feature, o);
  }

  /// Which image of grain j touches grain i: the nearest, because no cell is so small that two do.
  PairImage image_at(int i, int j) const {
    const auto& bodies = world_.grains.bodies;
    return world_.cell.nearest(bodies[i].position, bodies[j].position);
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
    g.rotates = g.fixed || b.inverse_inertia != 0;
    g.material = world_.acting.material(world_.grains.kinds[i]);
    write_rotation(b, world_.rotation(i), inertia, g);
    g.outline = world_.grains.shapes.outline(i);
    if constexpr (requires { world_.grains.shapes.superellipsoid(i); }) {
      g.axes = world_.grains.shapes.superellipsoid(i).axes;
      g.exponents = world_.grains.shapes.superellipsoid(i).exponents;
    }
    if (!world_.cell.is_periodic()) return;
    // Since the last search it may have gone out of the cell.
    const auto home = world_.cell.home(b.position);
    g.position -= to_three(world_.cell.shift(home));
    g.velocity -= to_three(world_.cell.drift(home));
    for (int a = 0; a < dim; ++a) g.image[a] = world_.grains.images[i][a] + home[a];
  }

  /// The contact of body i with the image of body j, as of the copies within the cell, seen from
  /// the one that is named first.
  void fill_image(Contact& c, int i, int j, bool turned) const {
    const auto& cell = world_.cell;
    const auto& bodies = world_.grains.bodies;
    const PairImage n = image_at(i, j);
    const auto home_i = cell.home(bodies[i].position), home_j = cell.home(bodies[j].position);
    for (int a = 0; a < dim; ++a) {
      c.image[a] = turned ? -n[a] - home_j[a] + home_i[a] : n[a] + home_j[a] - home_i[a];
    }
    c.point -= to_three(turned ? typename World::Vector(cell.shift(n) + cell.shift(home_j))
                               : cell.shift(home_i));
  }

  Contact contact(int i, const Pair& pair, const Force& f, bool wall, const Overlap& o,
                  const RollingMemory<dim>& rolling) const {
    const auto& ids = world_.grains.ids;
    Contact c;
    c.i = ids[i];
    c.j = wall ? -1 - world_.walls.wall_of(pair.j) : ids[pair.j];
    c.point = contact_point(i, o);
    c.normal = to_three(normal_of(o));
    c.force = to_three(f.force);
    c.normal_force = repulsion_of(f.force, o);
    c.tangential_force = signed_size_of(tangential_of(f.force, o));
    c.friction = rule(i, pair, wall).friction;
    c.sliding = is_sliding(of_law(f, i, pair, wall), o, c.friction);
    write_rolling(rolling, c);
    const bool turned = !wall && c.j < c.i;
    write_spring(seen_from(pair.memory, turned).spring, c);
    if (turned) {
      std::swap(c.i, c.j);
      c.normal = -c.normal;
      c.force = -c.force;
    }
    if (wall) {
      c.point -= to_three(world_.cell.shift(world_.cell.home(world_.grains.bodies[i].position)));
    } else if (world_.cell.is_periodic()) {
      fill_image(c, i, pair.j, turned);
    }
    return c;
  }

  const World& world_;
};

}  // namespace grainfield::dem
