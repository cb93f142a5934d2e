// The state of a simulation: what moves, what it touches, what acts on it. The parts that work on
// it are in sweep.h (one step), search.h (near pairs), review.h (sleeping), report.h (what it
// tells) and world_image.h (its bits).
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "dem/contacts/contact_list.h"
#include "dem/contacts/margins.h"
#include "dem/engine/grains.h"
#include "dem/engine/interaction.h"
#include "dem/engine/walls.h"
#include "dem/motion/applied_force.h"
#include "dem/sleep/sleepers.h"

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

  Acting acting;
  SleepSettings sleep;
  double time_step = 0;  ///< s
  long steps = 0;
  const char* integrator = "";  ///< its word

  Grains<Shape, Integrator> grains;
  Walls<dim> walls;
  Surroundings<dim> around;
  Sleepers<dim, Memory> sleepers;
  Contacts contacts;
  std::vector<Margin<dim>> margins;  ///< of the awake
  int awake = 0;  ///< bodies [0, awake) move; the others sleep or, with sleeping, are fixed
  int applied_index = -1;  ///< body that carries the applied force
  bool search_needed = true;

  double time() const { return static_cast<double>(steps) * time_step; }

  void locate_applied() {
    const auto at = std::find(grains.ids.begin(), grains.ids.end(), around.applied.id);
    applied_index = at == grains.ids.end() ? -1 : static_cast<int>(at - grains.ids.begin());
  }
  const auto& pair_rule(int i, int j) const {
    return acting.kinds() == 1 ? acting.rule(0, 0) : acting.rule(grains.kinds[i], grains.kinds[j]);
  }
  const auto& wall_rule(int i, int wall) const { return acting.wall_rule(grains.kinds[i], wall); }
  const auto& rotation(int i) const { return grains.memory[i].rotation; }
  Vector weight(int i) const { return grains.inertias[i].mass * around.gravity; }

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
      if (felt.press == 0) continue;
      sleepers.touch(contacts.pairs[k].j, felt);
      felt = {};
    }
  }
};

}  // namespace grainfield::dem
