// Compiled for every width (lanes.h): no function of it may be another file's, too.
#include "dem/laws/sphere_lanes.h"

#include <cstddef>
#include <limits>

#include "dem/laws/hertz.h"
#include "dem/laws/linear.h"
#include "dem/laws/penalty.h"
#include "dem/space/kinematics3.h"
#include "dem/space/lane_rows.h"
#include "dem/space/round_overlap.h"

namespace grainfield::dem {
namespace {

template <int W>
[[gnu::always_inline]] inline Body<3, Lanes<W>> spheres_of(const double* const* rows) {
  const Four<W> first = four_of<W>(rows, 0), second = four_of<W>(rows, 4);
  const Four<W> third = four_of<W>(rows, 8);
  return {{first.a, first.b, first.c},
          {first.d, second.a, second.b},
          {second.c, second.d, third.a},
          third.b,
          third.c,
          third.d};
}

// The work on a batch goes in three passes, each over all of its lanes: one alone, from bodies to
// sums, is a chain of operations that wait for each other, longer than a processor looks ahead.

/// What a pass leaves for the next, by slot.
struct alignas(64) PairLanes {
  double normal[3][kBatch], slip[3][kBatch];
  double approach[kBatch], depth[kBatch], inverse_mass[kBatch];
  double twist[kBatch];                     ///< rad, about the normal
  double radius[kBatch];                    ///< relative, of curvature, m
  double lever_i[kBatch], lever_j[kBatch];  ///< of the contact point along the normal, m
  double apart[kBatch];                     ///< not 0: the two do not touch
  double spring[3][kBatch], remembered[kBatch];
  double force[3][kBatch], tangential[3][kBatch];  ///< N
  // With resistance against rolling:
  double turning[3][kBatch], rolls_on[kBatch];  ///< Turning: between, radius
  double moment[3][kBatch];                     ///< on i, N m
  double roll[3][kBatch], roll_twist[kBatch];
};

/// Numbers of a law's memory: a spring, and where there is a fourth, the contact's radius.
template <class Law>
inline constexpr int kMemory = sizeof(typename Law::template Memory<3>) / sizeof(double);

/// The memory of pair k, and what it remembers of rolling.
template <class Law>
[[gnu::always_inline]] inline double* memory_of(const SphereRows& rows, int k) {
  return reinterpret_cast<double*>(rows.pairs + std::ptrdiff_t{k} * kSpherePair<Law>);
}
[[gnu::always_inline]] inline double* rolling_of(const SphereRows& rows, int k) {
  return rows.rolling + std::ptrdiff_t{k} * 4;
}

/// Overlap and motion. Lanes beyond the batch do later pairs' work, for nobody.
template <int W, class Law, bool rolls>
[[gnu::always_inline]] inline void measure_overlap(double dt, const SphereRows& rows,
                                                   const RowBatch& batch, int at, PairLanes& to) {
  using V = Lanes<W>;
  const V none{};
  const double *body_i[W], *body_j[W];
  for (int k = 0; k < W; ++k) {
    const int later = batch.second[at + k + kPairsAhead];
    body_i[k] = rows.bodies + std::ptrdiff_t{batch.first[at + k]} * kSphereBody;
    body_j[k] = rows.bodies + std::ptrdiff_t{batch.second[at + k]} * kSphereBody;
    const double* const ahead = rows.bodies + std::ptrdiff_t{later} * kSphereBody;
    __builtin_prefetch(ahead);
    __builtin_prefetch(ahead + 8);
    __builtin_prefetch(rows.sums + std::ptrdiff_t{later} * kSphereSum, 1);
  }
  const Body<3, V> a = spheres_of<W>(body_i), b = spheres_of<W>(body_j);
  Overlap3Of<V> o;
  const SpheresMeet<V> lie = spheres_meet(b.position - a.position, a.radius, b.radius, o);
  set_arms(lie.lever_i, lie.lever_j, o);
  const ContactMotion<3, V> m = motion_at<true>(a, b, o);
  put<W>(o.normal, to.normal, at);
  put<W>(m.slip, to.slip, at);
  store<W>(m.approach, to.approach + at);
  store<W>(o.depth, to.depth + at);
  store<W>(m.inverse_mass, to.inverse_mass + at);
  store<W>(twist_of(a, b, o, dt), to.twist + at);
  if constexpr (Law::measures == Measures::curvature) store<W>(o.radius, to.radius + at);
  if constexpr (rolls) {
    const Turning<3, V> turning = turning_of(a, b, o, dt);
    put<W>(turning.between, to.turning, at);
    store<W>(turning.radius, to.rolls_on + at);
  }
  store<W>(lie.lever_i, to.lever_i + at);
  store<W>(lie.lever_j, to.lever_j + at);
  store<W>(lie.apart ? none + 1 : none, to.apart + at);
}

/// Memory, law and friction, resistance against rolling; 0 of pairs that do not touch.
template <int W, class Law, bool rolls>
[[gnu::always_inline]] inline void add_forces(const Law& law, double friction, double dt,
                                              const RollingLaw& rolling, const SphereRows& rows,
                                              const RowBatch& batch, int at, PairLanes& c) {
  using V = Lanes<W>;
  const V none{};
  const auto columns = [&](auto row_of) {
    const double* before[W];
    for (int k = 0; k < W; ++k) before[k] = row_of(rows, batch.pair[at + k]);
    return four_of<W>(before, 0);
  };
  const Four<W> before = columns(memory_of<Law>);
  typename Law::template Memory<3, V> memory;
  memory.spring = {before.a, before.b, before.c};
  if constexpr (kMemory<Law> == 4) memory.contact_radius = before.d;
  Overlap3Of<V> o;
  o.normal = three<W>(c.normal, at);
  o.depth = loaded<W>(c.depth + at);
  if constexpr (Law::measures == Measures::curvature) o.radius = loaded<W>(c.radius + at);
  ContactMotion<3, V> m;
  m.approach = loaded<W>(c.approach + at);
  m.slip = three<W>(c.slip, at);
  m.inverse_mass = loaded<W>(c.inverse_mass + at);
  const auto apart = loaded<W>(c.apart + at) != 0;
  // What does not touch has no limit, so that nothing slides there.
  const V endless = none + std::numeric_limits<double>::infinity();

  const V twist = loaded<W>(c.twist + at);
  turn_with_contact(memory.spring, o.normal, twist, o);
  const LawForce<3, V> f = law(o, m, apart ? endless : none + friction, dt, memory);
  const ContactForce<3, V> on = forces_at<true>(o, f.normal, f.tangential);

  const Three<W> zero = Three<W>::Zero();
  put<W>(chosen<W>(apart, zero, on.force), c.force, at);
  put<W>(chosen<W>(apart, zero, f.tangential), c.tangential, at);
  put<W>(chosen<W>(apart, zero, memory.spring), c.spring, at);
  if constexpr (kMemory<Law> == 4) {
    store<W>(apart ? none : memory.contact_radius, c.remembered + at);
  }
  if constexpr (rolls) {
    const Four<W> rolled = columns(rolling_of);
    RollingMemory<3, V> springs{{rolled.a, rolled.b, rolled.c}, rolled.d};
    const Turning<3, V> turning{three<W>(c.turning, at), loaded<W>(c.rolls_on + at), twist};
    const V repulsion = apart ? endless : repulsion_of(on.force, o);
    const Three<W> moment = rolling.moment(turning, o, repulsion, dt, springs);
    put<W>(chosen<W>(apart, zero, moment), c.moment, at);
    put<W>(chosen<W>(apart, zero, springs.roll), c.roll, at);
    store<W>(apart ? none : springs.twist, c.roll_twist + at);
  }
}

/// To the memories, and to the sums or what is kept of pairs. `full`: no lane is beyond the batch.
template <int W, class Law, bool rolls, bool full>
[[gnu::always_inline]] inline void scatter(const SphereRows& rows, const RowBatch& batch, int at,
                                           const PairLanes& c) {
  const int left = full ? W : batch.count - at;
  const int* const pairs = batch.pair + at;
  using V = Lanes<W>;
  const Three<W> force = three<W>(c.force, at), spring = three<W>(c.spring, at);
  Overlap3Of<V> o;
  o.normal = three<W>(c.normal, at);
  set_arms(loaded<W>(c.lever_i + at), loaded<W>(c.lever_j + at), o);
  ContactForce<3, V> on;
  set_torques<V>(o, three<W>(c.tangential, at), on);
  Three<W> torque_i = on.torque_i, torque_j = on.torque_j;
  if constexpr (rolls) {
    const Three<W> moment = three<W>(c.moment, at), spring_roll = three<W>(c.roll, at);
    torque_i = torque_i + moment;
    torque_j = torque_j - moment;
    each_row<W>({spring_roll.x, spring_roll.y, spring_roll.z, loaded<W>(c.roll_twist + at)},
                [&](int k, const Lanes<4>& row) {
                  if (k < left) store<4>(row, rolling_of(rows, pairs[k]));
                });
  }
  V remembered{};
  if constexpr (kMemory<Law> == 4) remembered = loaded<W>(c.remembered + at);
  each_row<W>({spring.x, spring.y, spring.z, remembered}, [&](int k, const Lanes<4>& row) {
    if (k >= left) return;
    double* const memory = memory_of<Law>(rows, pairs[k]);
    if constexpr (kMemory<Law> == 4) return store<4>(row, memory);
    store<2>(__builtin_shufflevector(row, row, 0, 1), memory);
    memory[2] = row[2];
  });
  // A grain is the second of its pairs in earlier rows, then the first of those in its own: so all
  // second ones before the first ones keep the order of every sum.
  const auto add = [&](const Three<W>& f, const Three<W>& torque, double* to, int size,
                       const int* place) {
    double* sums[W];
    for (int k = 0; k < W; ++k) sums[k] = to + std::ptrdiff_t{place[k]} * size;
    if constexpr (W == 8) {
      Lanes<8> rows_in_order[8];
      each_row_of_six({f.x, f.y, f.z, torque.x}, torque.y, torque.z,
                      [&](int k, const Lanes<8>& row) { rows_in_order[k] = row; });
      for (int k = 0; k < 8; ++k) {
        if (k < left) store<8>(loaded<8>(sums[k]) + rows_in_order[k], sums[k]);
      }
      return;
    }
    each_row<W>({f.x, f.y, f.z, torque.x}, [&](int k, const Lanes<4>& row) {
      if (k < left) store<4>(loaded<4>(sums[k]) + row, sums[k]);
    });
    each_pair<W>(torque.y, torque.z, [&](int k, const Lanes<2>& row) {
      if (k < left) store<2>(loaded<2>(sums[k] + 4) + row, sums[k] + 4);
    });
  };
  if (rows.kept == nullptr) {
    add(-force, torque_j, rows.sums, kSphereSum, batch.second + at);
    add(force, torque_i, rows.sums, kSphereSum, batch.first + at);
    return;
  }
  add(force, torque_i, rows.kept, kSphereForce, pairs);
  const Lanes<W> none{};
  each_row<W>({torque_j.x, torque_j.y, torque_j.z, none}, [&](int k, const Lanes<4>& row) {
    if (k >= left) return;
    double* const to = rows.kept + std::ptrdiff_t{pairs[k]} * kSphereForce + 6;
    store<2>(__builtin_shufflevector(row, row, 0, 1), to);
    to[2] = row[2];
  });
}

template <bool rolls, int W, class Law>
[[gnu::always_inline]] inline void forces(const Law& law, double friction, double dt,
                                          const RollingLaw& rolling, const SphereRows& rows,
                                          const RowBatch& batch) {
  static_assert(kPairsBehind >= kPairsAhead + W);
  PairLanes lanes;
  for (int at = 0; at < batch.count; at += W) {
    measure_overlap<W, Law, rolls>(dt, rows, batch, at, lanes);
  }
  for (int at = 0; at < batch.count; at += W) {
    add_forces<W, Law, rolls>(law, friction, dt, rolling, rows, batch, at, lanes);
  }
  int at = 0;
  for (; at + W <= batch.count; at += W) scatter<W, Law, rolls, true>(rows, batch, at, lanes);
  if (at < batch.count) scatter<W, Law, rolls, false>(rows, batch, at, lanes);
}

}  // namespace

template <int W, class Law>
void sphere_forces_of(const Law& law, double friction, double dt, const RollingLaw& rolling,
                      const SphereRows& rows, const RowBatch& batch) {
  if (!(dt > 0)) __builtin_unreachable();
  if (rows.rolling != nullptr) {
    return forces<true, W>(law, friction, dt, rolling, rows, batch);
  }
  forces<false, W>(law, friction, dt, rolling, rows, batch);
}
template void sphere_forces_of<GRAINFIELD_LANES>(const HertzLaw&, double, double, const RollingLaw&,
                                                 const SphereRows&, const RowBatch&);
template void sphere_forces_of<GRAINFIELD_LANES>(const LinearLaw&, double, double,
                                                 const RollingLaw&, const SphereRows&,
                                                 const RowBatch&);
template void sphere_forces_of<GRAINFIELD_LANES>(const PenaltyLaw&, double, double,
                                                 const RollingLaw&, const SphereRows&,
                                                 const RowBatch&);

}  // namespace grainfield::dem
