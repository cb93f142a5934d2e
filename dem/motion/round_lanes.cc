// Compiled for every width (lanes.h): no function of it may be another file's, too.
#include "dem/motion/round_lanes.h"

#include <cstddef>

#include "dem/motion/lane_turn.h"
#include "dem/space/lane_rows.h"

namespace grainfield::dem {
namespace {

template <int size, int W, class Number>
[[gnu::always_inline]] inline void find_rows(Number* from, const int (&grains)[W],
                                             Number* (&rows)[W]) {
  for (int k = 0; k < W; ++k) rows[k] = from + std::ptrdiff_t{grains[k]} * size;
}

/// local_damping (local_damping.h).
template <int W>
[[gnu::always_inline]] inline Three<W> local_damping(const Three<W>& force, const Three<W>& motion,
                                                     double share) {
  using V = Lanes<W>;
  const auto against = [&](const V& f, const V& v) {
    const V size = share * (magnitude(f) + 0.0);  // of -0, too, +0
    return v > 0 ? -size : v < 0 ? size : V{};
  };
  return {against(force.x, motion.x), against(force.y, motion.y), against(force.z, motion.z)};
}

/// True when one has left its margin. `left`: so many of the lanes are grains of their own; others
/// do the first one's work again, for nobody. `in_a_row`: list[k] is list[0] + k, for all lanes.
template <int W, bool in_a_row>
[[gnu::always_inline]] inline bool step_on(const RoundStep& step, const RoundRows& from,
                                           const int* list, int count) {
  const int left = in_a_row ? W : count;
  using V = Lanes<W>;
  const V none{};
  double *bodies[W], *memories[W], *sums[W];
  const double* margins[W];
  int grains[W];
  for (int k = 0; k < W; ++k) grains[k] = in_a_row ? list[0] + k : list[k < left ? k : 0];
  find_rows<kRoundBody>(from.bodies, grains, bodies);
  find_rows<kRoundMemory>(from.memories, grains, memories);
  find_rows<kRoundSum>(from.sums, grains, sums);
  for (int k = 0; k < W; ++k) margins[k] = from.margins[grains[k]].position;
  const Four<W> body1 = four_of<W>(bodies, 0), body2 = four_of<W>(bodies, 4);
  const Four<W> body3 = four_of<W>(bodies, 8), turn = four_of<W>(memories, 0);
  const Four<W> sum1 = four_of<W>(sums, 0), sum2 = four_of<W>(sums, 4);
  const Three<W> before{body1.a, body1.b, body1.c};
  Three<W> velocity{body1.d, body2.a, body2.b}, spin{body2.c, body2.d, body3.a};
  const V inverse_mass = body3.c, inverse_inertia = body3.d;
  Three<W> force{sum1.a, sum1.b, sum1.c};
  Three<W> torque{sum1.d, sum2.a, sum2.b};

  const Three<W> gravity{none + step.gravity[0], none + step.gravity[1], none + step.gravity[2]};
  const auto inertia = [&](int number) {
    return lanes_of<W>(
        [&](int k) { return from.inertias[std::ptrdiff_t{grains[k]} * kRoundInertia + number]; });
  };
  if (step.local_damping != 0) {
    const Three<W> all = force + scaled<W>(inertia(0), gravity);
    force = force + local_damping<W>(all, velocity, step.local_damping);
    torque = torque + local_damping<W>(torque, spin, step.local_damping);
  }

  // VerletIntegrator<3>::end.
  const Three<W> acceleration =
      (scaled<W>(inverse_mass, force) + gravity) - scaled<W>(none + step.drag, velocity);
  if (step.drag != 0) {
    torque = torque - scaled<W>(none + step.drag, scaled<W>(inertia(1), spin));
  }
  const V half = none + 0.5 * step.dt, turning = half * inverse_inertia;
  velocity = velocity + scaled<W>(half, acceleration);
  spin = spin + scaled<W>(turning, torque);

  // begin.
  velocity = velocity + scaled<W>(half, acceleration);
  const Three<W> position = before + scaled<W>(none + step.dt, velocity);
  spin = spin + scaled<W>(turning, torque);
  const Turn<W> by = turn_by<W>(scaled<W>(none + step.dt, spin));
  Turn<W> rotation = product<W>(by, Turn<W>{turn.d, {turn.a, turn.b, turn.c}});
  const V share = 1.5 - 0.5 * squared<W>(rotation);
  rotation = {share * rotation.w, scaled<W>(share, rotation.v)};

  // Margin::is_left.
  const Four<W> centre = four_of<W>(margins, 0);
  const Three<W> moved = position - Three<W>{centre.a, centre.b, centre.c};
  const V way = centre.d;
  const auto stays = (way >= 0) & (dot<W>(moved, moved) <= way * way);

  const auto put = [&](const Four<W>& columns, double* const* rows, int at) {
    each_row<W>(columns, [&](int k, const Lanes<4>& row) {
      if (k < left) store<4>(row, rows[k] + at);
    });
  };
  put({position.x, position.y, position.z, velocity.x}, bodies, 0);
  put({velocity.y, velocity.z, spin.x, spin.y}, bodies, 4);
  for (int k = 0; k < W && k < left; ++k) bodies[k][8] = spin.z[k];
  put({rotation.v.x, rotation.v.y, rotation.v.z, rotation.w}, memories, 0);
  for (int k = 0; k < W && k < left; ++k) {
    store<4>(Lanes<4>{}, sums[k]);
    store<2>(Lanes<2>{}, sums[k] + 4);
  }
  return any_of(~stays);
}

}  // namespace

template <int W>
bool round_steps_of(const RoundStep& step, const RoundRows& rows, const int* list, int count) {
  bool moved = false;
  for (int at = 0; at < count; at += W) {
    const int *here = list + at, left = count - at;
    const bool in_a_row = left >= W && here[W - 1] - here[0] == W - 1;  // the list ascends
    moved |= in_a_row ? step_on<W, true>(step, rows, here, left)
                      : step_on<W, false>(step, rows, here, left);
  }
  return moved;
}
template bool round_steps_of<GRAINFIELD_LANES>(const RoundStep& step, const RoundRows& rows,
                                               const int* list, int count);

}  // namespace grainfield::dem
