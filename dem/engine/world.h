// The state of a simulation: what moves, what it touches, what acts on it. The parts that work on
// it are in sweep.h (one step), search.h (near pairs), review.h (sleeping), report.h (what it
// tells) and world_checkpoint.h (its bits).
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "dem/contacts/contact_list.h"
#include "dem/contacts/margins.h"
#include "dem/engine/added_loads.h"
#include "dem/engine/energy_balance.h"
#include "dem/engine/grains.h"
#include "dem/engine/interaction.h"
#include "dem/engine/rolling_contacts.h"
#include "dem/engine/wall_contacts.h"
#include "dem/motion/applied_force.h"
#include "dem/motion/round_lanes.h"
#include "dem/sleep/sleepers.h"
#include "dem/space/moving_cell.h"
#include "dem/walls/walls.h"

namespace grainfield::dem {

/// What acts on bodies from outside.
template <int D>
struct Surroundings {
  VectorOf<D> gravity = zero<VectorOf<D>>();  ///< m/s2
  double drag = 0;                            ///< 1/s: background damping
  AppliedForce applied;

  VectorOf<D> applied_at(double t) const {
    const double part = applied.share_at(t);
    if constexpr (D == 2)
      return {applied.fx * part, applied.fy * part};
    else
      return {applied.fx * part, applied.fy * part, applied.fz * part};
  }
};

template <class ShapeStore, class ContactLaw, class Mover>
struct World {
  using Shape = ShapeStore;
  using Law = ContactLaw;
  using Integrator = Mover;
  using Acting = Interaction<Shape, Law>;
  static constexpr int dim = Shape::dim;
  using Body = dem::Body<dim>;
  using Vector = VectorOf<dim>;
  using Overlap = typename Shape::Overlap;
  using Memory = typename Acting::Memory;
  using Contacts = ContactList<dim, Memory, typename Acting::Feature>;
  using Pair = typename Contacts::Pair;
  using Frozen = FrozenContact<dim, Memory>;
  /// In a row of pairs sleepers come before the awake, so that they go side by side with them.
  static constexpr bool sleepers_first = Shape::outlines;

  Acting acting;
  SleepSettings sleep;
  double time_step = 0;      ///< s
  double local_damping = 0;  ///< Cundall's alpha
  long steps = 0;
  const char* integrator = "";  ///< its word

  Grains<Shape, Integrator> grains;
  Walls<dim> walls;
  MovingCell<dim> cell;
  Surroundings<dim> around;
  AddedLoads<dim> added;
  EnergyBalance<dim> balance;
  RollingContacts<dim> rolling;
  using Sleepers = dem::Sleepers<dim, Memory>;
  Sleepers sleepers;
  Contacts contacts;
  std::vector<Margin<dim>> margins;        ///< of the awake
  std::vector<RoundMargin> round_margins;  ///< the same, in three dimensions
  int awake = 0;  ///< bodies [0, awake) move; the others sleep or, with sleeping, are fixed
  int applied_index = -1;            ///< body that carries the applied force
  std::vector<std::int64_t> beside;  ///< ids, ascending, of others that carry the same
  std::vector<char> carries;         ///< by body: is one of these; empty without such
  bool all_round = false;  ///< all moments of each awake body are equal; since the last search
  bool search_needed = true;

  /// A contact with a wall (a pair of contacts.walls) has a memory, of the law or of rolling.
  bool remembers_wall(int k) const {
    return !contacts.walls[k].memory.empty() ||
           (rolling.on && static_cast<std::size_t>(k) < rolling.walls.size() &&
            !rolling.walls[k].empty());
  }
  double time() const { return static_cast<double>(steps) * time_step; }

  void locate_applied() {
    const auto at = std::find(grains.ids.begin(), grains.ids.end(), around.applied.id);
    applied_index = at == grains.ids.end() ? -1 : static_cast<int>(at - grains.ids.begin());
    carries.clear();
    if (beside.empty()) return;
    for (const std::int64_t id : grains.ids) {
      carries.push_back(std::binary_search(beside.begin(), beside.end(), id) ? 1 : 0);
    }
  }
  bool is_loaded(int i) const {
    return i == applied_index || (!carries.empty() && carries[static_cast<std::size_t>(i)] != 0);
  }
  const auto& pair_rule(int i, int j) const {
    return acting.kinds() == 1 ? acting.rule(0, 0) : acting.rule(grains.kinds[i], grains.kinds[j]);
  }
  /// `slot`: any of the wall's.
  const auto& wall_rule(int i, int slot) const { return acting.wall_rule(grains.kinds[i], slot); }
  /// Overlap of a grain with a half space that replaces a wall.
  bool overlap_patch(int i, const Body& b, const Patch<dim>& patch, Overlap& o) const {
    if (!acting.overlap(grains.shapes, i, b, patch.plane, o)) return false;
    if constexpr (Shape::offers(Measures::curvature))
      o.radius = effective_radius(o.radius, patch.curvature);
    return true;
  }
  /// What a wall is to the law at the contact of a body: without arm, and as heavy as none.
  Body wall_body(int wall, const Body& b, const Overlap& o) const {
    Body body = acting.wall_body();
    const Vector at = point_at<Acting::central>(b, o);
    body.velocity = walls.velocity(wall, at);
    body.spin = walls.state(wall).spin;
    return body;
  }
  /// A force on a grain by a wall, with the torque on the wall about its centre.
  void add_wall_torque(int wall, const Body& b, const Overlap& o, ContactForce<dim>& f) const {
    const Vector arm = point_at<Acting::central>(b, o) - walls.state(wall).centre;
    f.torque_j = torque_of(arm, Vector(-f.force));
  }
  const auto& rotation(int i) const { return grains.memory[i].rotation; }
  Vector weight(int i) const { return grains.inertias[i].mass * around.gravity; }

  /// Velocity of a body against the flow of the cell, m/s.
  Vector fluctuation(int i) const {
    const Body& b = grains.bodies[i];
    if (!cell.flows()) return b.velocity;
    return b.velocity - cell.flow_at(b.position);
  }
  /// Body b, its own or changed, as its image.
  Body image_of(const Body& b, const PairImage& n) const {
    Body image = b;
    image.position += cell.shift(n);
    image.velocity += cell.drift(n);
    return image;
  }
  /// Overlap of grain i as `a` and grain j as `b`, which has been made an image where it is one.
  template <class Feature>
  bool overlap(int i, const Body& a, int j, const Body& b, const PairImage& n, Feature& feature,
               Overlap& o) const {
    if (!is_image(n)) return acting.overlap(grains.shapes, i, a, j, b, feature, o);
    return acting.overlap_image(grains.shapes, i, a, j, b, cell.shift(n), feature, o);
  }

  /// Every grain wakes; fixed ones sleep while there is sleeping.
  void wake_all() {
    for (int i = 0; i < grains.size(); ++i) {
      const bool asleep = grains.is_fixed(i) && sleep.on;
      search_needed |=
          sleepers.set_asleep(i, asleep, grains.bodies[i].position, rotation(i), steps);
    }
    locate_applied();
  }
  /// Moves what the pairs have felt since the last search to their sleepers.
  void gather_touches() {
    if (awake == grains.size()) return;
    for (int k = 0; k < contacts.pairs.size(); ++k) {
      auto& felt = contacts.felt[k];
      if (felt.force_sum == 0) continue;
      sleepers.touch(contacts.pairs[k].j, felt);
      felt = {};
    }
  }
};

}  // namespace grainfield::dem
