// Asks the forces of the caller's own (added_forces.h): hands them grains and contacts, and keeps
// what they return. By one thread, while no grain moves.
#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "dem/engine/wall_contacts.h"
#include "dem/engine/world.h"

namespace grainfield::dem {

template <class World>
class AddForces {
 public:
  static constexpr int dim = World::dim;
  using Vector = typename World::Vector;
  using Loads = AddedLoads<dim>;
  using Force = ContactForce<dim>;

  explicit AddForces(World& world) : world_(world) {}

  /// Before the forces of step number `step` - 1 (from 0) end it: of the forces whose turn it is,
  /// or of all. The contacts have been searched for.
  void ask(long step, bool all) {
    auto& added = world_.added;
    const auto is_due = [&](const typename Loads::Source& source) {
      return all || step % source.force->every() == 0;
    };
    bool any = false, any_contacts = false;
    for (const auto& source : added.sources) {
      any |= is_due(source);
      any_contacts |= is_due(source) && source.force->in_contacts();
    }
    if (!any) return;
    const double time = static_cast<double>(step) * world_.time_step;
    fill_grains(time);
    if (any_contacts) fill_contacts();
    // All are asked before any of what they return counts: one may throw.
    std::vector<AddedForce::Loads> answers(added.sources.size());
    for (std::size_t s = 0; s < added.sources.size(); ++s) {
      if (!is_due(added.sources[s])) continue;
      AddedForce& force = *added.sources[s].force;
      const bool at_contacts = force.in_contacts();
      answers[s] = force.loads(grains_, at_contacts ? contacts_ : nullptr);
      check_loads(
          force, answers[s],
          at_contacts ? static_cast<Eigen::Index>(touching_.size()) : grains_->positions.rows(),
          dim, time, at_contacts ? &contacts_->i : nullptr);
    }
    for (std::size_t s = 0; s < added.sources.size(); ++s) {
      if (is_due(added.sources[s])) keep(answers[s], added.sources[s]);
    }
    sum_up();
  }

  /// What the forces have returned, of sources that have been asked.
  void sum_up() {
    auto& added = world_.added;
    added.sum.assign(world_.grains.ids.size(), {});
    for (const auto& source : added.sources) {
      for (std::size_t id = 0; id < source.loads.size(); ++id) {
        added.sum[id].force += source.loads[id].force;
        added.sum[id].torque += source.loads[id].torque;
      }
    }
  }

 private:
  /// A contact as the engine lists it.
  struct Touching {
    int i = 0, j = 0;  // bodies; j: of a wall -1
    int wall = -1;
    PairKey key = 0;
    bool turned = false;  // the function sees it from body j
    typename World::Overlap overlap;
  };

  /// A new one where the function has kept the last.
  template <class T>
  static T& fresh(std::shared_ptr<T>& held) {
    if (held.use_count() != 1) held = std::make_shared<T>();
    return *held;
  }
  template <class Values>
  static void put(const Values& from, Eigen::Index row, RowMatrix& to) {
    for (int d = 0; d < dim; ++d) to(row, d) = from[d];
  }

  void fill_grains(double time) {
    GrainsNow& now = fresh(grains_);
    const auto& grains = world_.grains;
    const Eigen::Index n = grains.size();
    now.time = time;
    now.positions.resize(n, dim);
    now.velocities.resize(n, dim);
    now.spins.resize(n, dim == 2 ? 1 : 3);
    now.radii.resize(n);
    now.masses.resize(n);
    for (int i = 0; i < grains.size(); ++i) {
      const auto& b = grains.bodies[i];
      const Eigen::Index id = grains.ids[i];
      put(b.position, id, now.positions);
      put(b.velocity, id, now.velocities);
      if constexpr (dim == 2)
        now.spins(id, 0) = b.spin;
      else
        put(b.spin, id, now.spins);
      now.radii[id] = b.radius;
      now.masses[id] = grains.inertias[i].mass;
    }
  }

  void fill_contacts() {
    find_touching();
    ContactsNow& now = fresh(contacts_);
    const auto count = static_cast<Eigen::Index>(touching_.size());
    now.i.resize(touching_.size());
    now.j.resize(touching_.size());
    now.points.resize(count, dim);
    now.normals.resize(count, dim);
    now.velocities.resize(count, dim);
    now.overlaps.resize(count);
    now.radii.resize(count);
    for (Eigen::Index c = 0; c < count; ++c) fill_contact(c, now);
  }
  void fill_contact(Eigen::Index c, ContactsNow& now) const {
    const Touching& t = touching_[static_cast<std::size_t>(c)];
    const auto& bodies = world_.grains.bodies;
    const auto& ids = world_.grains.ids;
    const double sign = t.turned ? -1 : 1;
    const std::int64_t other = t.wall >= 0 ? -1 - t.wall : ids[t.j];
    now.i[c] = t.turned ? other : ids[t.i];
    now.j[c] = t.turned ? ids[t.i] : other;
    put(point_at<World::Acting::central>(bodies[t.i], t.overlap), c, now.points);
    put(Vector(sign * normal_of(t.overlap)), c, now.normals);
    put(Vector(sign * velocities_[static_cast<std::size_t>(c)]), c, now.velocities);
    now.overlaps[c] = t.overlap.depth;
    const double r = bodies[t.i].radius;
    now.radii[c] = t.wall >= 0 ? r : r * bodies[t.j].radius / (r + bodies[t.j].radius);
  }

  /// Overlaps as they are: what contacts remember and where shapes look first stays as it is.
  void find_touching() {
    touching_.clear();
    velocities_.clear();
    const auto& contacts = world_.contacts;
    for (int i = 0; i < contacts.pairs.rows(); ++i) {
      for (int k = contacts.pairs.first(i); k < contacts.pairs.last(i); ++k) add_pair(i, k);
      for (int k = contacts.walls.first(i); k < contacts.walls.last(i); ++k) {
        k += add_wall(i, k);
      }
    }
  }
  void add_pair(int i, int k) {
    const auto& bodies = world_.grains.bodies;
    const auto& ids = world_.grains.ids;
    const auto& pair = world_.contacts.pairs[k];
    const auto image = world_.cell.is_periodic() ? world_.contacts.images[k] : PairImage{};
    const auto other = world_.image_of(bodies[pair.j], image);
    auto feature = pair.feature;
    Touching t;
    if (!world_.overlap(i, bodies[i], pair.j, other, image, feature, t.overlap)) return;
    t.i = i;
    t.j = pair.j;
    t.key = pair_key(ids[i], ids[pair.j]);
    t.turned = ids[i] > ids[pair.j];
    add(t, other);
  }
  /// Returns how many further slots the wall has.
  int add_wall(int i, int k) {
    const auto& b = world_.grains.bodies[i];
    const int slot = world_.contacts.walls[k].j;
    Touching t;
    t.i = i;
    t.j = -1;
    t.wall = world_.walls.wall_of(slot);
    if (world_.walls.is_plain(slot)) {
      if (!world_.acting.overlap(world_.grains.shapes, i, b, world_.walls.plane(slot), t.overlap))
        return 0;
      t.key = wall_key(world_.grains.ids[i], slot);
      add(t, world_.acting.wall_body());
      return 0;
    }
    visit_wall(world_, i, b, k,
               [&](int, int at, const auto& overlap, const auto& wall, const auto&) {
                 t.overlap = overlap;
                 t.key = wall_key(world_.grains.ids[i], world_.contacts.walls[at].j);
                 add(t, wall);
               });
    return world_.walls.slots_of(t.wall) - 1;
  }
  void add(const Touching& t, const typename World::Body& other) {
    const auto motion =
        motion_at<World::Acting::central>(world_.grains.bodies[t.i], other, t.overlap);
    const Vector n = normal_of(t.overlap);
    if constexpr (dim == 2)
      velocities_.push_back(motion.approach * n + motion.slip * Vector(-n.y(), n.x()));
    else
      velocities_.push_back(motion.approach * n + motion.slip);
    touching_.push_back(t);
  }

  void keep(const AddedForce::Loads& answer, typename Loads::Source& source) const {
    source.loads.assign(world_.grains.ids.size(), {});
    source.contacts = {};
    if (source.force->in_contacts()) {
      for (std::size_t c = 0; c < touching_.size(); ++c) {
        keep_contact(touching_[c], row_of(answer.forces, static_cast<Eigen::Index>(c)), source);
      }
      source.contacts.sort();
      return;
    }
    for (std::size_t id = 0; id < source.loads.size(); ++id) {
      auto& load = source.loads[id];
      const auto row = static_cast<Eigen::Index>(id);
      load.force = row_of(answer.forces, row);
      if (answer.torques.size() == 0) continue;
      if constexpr (dim == 2)
        load.torque = answer.torques(row, 0);
      else
        load.torque = row_of(answer.torques, row);
    }
  }
  /// `force`: on the grain that the function sees first.
  void keep_contact(const Touching& t, const Vector& force, typename Loads::Source& source) const {
    const auto& grains = world_.grains;
    const Vector on_i = t.turned ? Vector(-force) : force;
    Force f = forces_at<World::Acting::central>(t.overlap, repulsion_of(on_i, t.overlap),
                                                tangential_of(on_i, t.overlap));
    f.force = on_i;  // to the bit
    auto& first = source.loads[static_cast<std::size_t>(grains.ids[t.i])];
    first.force += f.force;
    first.torque += f.torque_i;
    if (t.wall >= 0) {
      world_.add_wall_torque(t.wall, grains.bodies[t.i], t.overlap, f);
    } else {
      auto& second = source.loads[static_cast<std::size_t>(grains.ids[t.j])];
      second.force -= f.force;
      second.torque += f.torque_j;
    }
    Force kept;
    Loads::add(f, t.turned, kept);
    source.contacts.add(t.key, kept);
  }
  static Vector row_of(const RowMatrix& values, Eigen::Index row) {
    Vector out = zero<Vector>();
    for (int d = 0; d < dim; ++d) out[d] = values(row, d);
    return out;
  }

  World& world_;
  std::shared_ptr<GrainsNow> grains_;
  std::shared_ptr<ContactsNow> contacts_;
  // Those of contacts_.
  std::vector<Touching> touching_;
  std::vector<Vector> velocities_;  // of body i against body j
};

}  // namespace grainfield::dem
