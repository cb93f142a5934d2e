// Compiled for every width (lanes.h): no function of it may be another file's, too.
#include "dem/laws/sphere_lanes.h"

#include <cstddef>

#include "dem/space/lane_rows.h"
#include "dem/space/lanes3.h"

namespace grainfield::dem {
namespace {

/// The columns of bodies (body.h).
template <int W>
struct Bodies {
  Three<W> position, velocity, spin;
  Lanes<W> radius, inverse_mass;
};
template <int W>
[[gnu::always_inline]] inline Bodies<W> bodies_of(const double* const* rows) {
  const Four<W> first = four_of<W>(rows, 0), second = four_of<W>(rows, 4);
  const Four<W> third = four_of<W>(rows, 8);
  return {{first.a, first.b, first.c},
          {first.d, second.a, second.b},
          {second.c, second.d, third.a},
          third.b,
          third.c};
}

// The work on a batch goes in three passes, each over all of its lanes: one alone, from bodies to
// sums, is a chain of operations that wait for each other, longer than a processor looks ahead.

/// What a pass leaves for the next, by slot.
struct alignas(64) PairLanes {
  double normal[3][kBatch], slip[3][kBatch];
  double approach[kBatch], depth[kBatch], inverse_mass[kBatch];
  double twist[kBatch];                     ///< rad, about the normal
  double wide[kBatch];                      ///< of Hertz' law: the contact's radius, m
  double lever_i[kBatch], lever_j[kBatch];  ///< of the contact point along the normal, m
  double apart[kBatch];                     ///< not 0: the two do not touch
  double spring[3][kBatch], remembered[kBatch];
  double force[3][kBatch], tangential[3][kBatch];  ///< N
  // With resistance against rolling:
  double turning[3][kBatch], radius[kBatch];  ///< w_i - w_j, rad/s; R_eff, m
  double moment[3][kBatch];                   ///< on i, N m
  double roll[3][kBatch], roll_twist[kBatch];
};

/// As capped (contact.h). Seldom does any of W contacts slide.
template <int W, class M>
[[gnu::always_inline]] inline Three<W> capped(const Three<W>& v, const Lanes<W>& limit,
                                              const M& apart) {
  const Lanes<W> square = dot<W>(v, v);
  const auto slides = (square > limit * limit) & ~apart;
  if (!any_of(slides)) return v;
  return chosen<W>(slides, scaled<W>(limit / root_of<W>(square), v), v);
}

/// turn_with_contact.
template <int W>
[[gnu::always_inline]] inline Three<W> turned(const Three<W>& old, const Three<W>& normal,
                                              const Lanes<W>& twist) {
  const Lanes<W> before = dot<W>(old, old);
  Three<W> spring = old - scaled<W>(dot<W>(old, normal), normal);
  spring = spring + scaled<W>(twist, cross<W>(normal, spring));
  const Lanes<W> now = dot<W>(spring, spring);
  spring = chosen<W>(now > 0, scaled<W>(root_of<W>(before / now), spring), spring);
  return chosen<W>(before > 0, spring, old);
}

/// friction_force of vectors: the force, and the spring as it is then.
template <int W, class M>
[[gnu::always_inline]] inline Three<W> slid(const Lanes<W>& limit, const Lanes<W>& stiffness,
                                            const Lanes<W>& viscosity, const Three<W>& slip,
                                            double dt, const M& apart, Three<W>& spring) {
  const Three<W> viscous = scaled<W>(-viscosity, slip);
  const Three<W> advance = scaled<W>(stiffness, slip);
  const Three<W> trial{spring.x - advance.x * dt, spring.y - advance.y * dt,
                       spring.z - advance.z * dt};
  const Three<W> sum = trial + viscous;
  const Three<W> force = capped<W>(sum, limit, apart);
  const auto all = (force.x == sum.x) & (force.y == sum.y) & (force.z == sum.z);
  spring = capped<W>(chosen<W>(all, trial, force - viscous), limit, apart);
  return force;
}
template <int W>
[[gnu::always_inline]] inline Lanes<W> within(const Lanes<W>& value, const Lanes<W>& limit) {
  const Lanes<W> above = value < -limit ? -limit : value;
  return limit < above ? limit : above;
}

/// The memory of pair k, and what it remembers of rolling.
template <SphereLawKind kind>
[[gnu::always_inline]] inline double* memory_of(const SphereRows& rows, int k) {
  return reinterpret_cast<double*>(rows.pairs + std::ptrdiff_t{k} * pair_size(kind));
}
[[gnu::always_inline]] inline double* rolling_of(const SphereRows& rows, int k) {
  return rows.rolling + std::ptrdiff_t{k} * 4;
}

/// RollingLaw::moment.
template <int W>
[[gnu::always_inline]] inline void roll(const RollingNumbers& law, double dt,
                                        const SphereRows& rows, const RowBatch& batch, int at,
                                        const Three<W>& normal, const Three<W>& force,
                                        PairLanes& c) {
  using V = Lanes<W>;
  const V none{}, repulsion = -dot<W>(force, normal);
  const auto apart = loaded<W>(c.apart + at) != 0;
  const Three<W> turning = three<W>(c.turning, at), zero{none, none, none};
  const V radius = loaded<W>(c.radius + at);
  double* remembered[W];
  for (int k = 0; k < W; ++k) remembered[k] = rolling_of(rows, batch.pair[at + k]);
  const Four<W> memory = four_of<W>(remembered, 0);
  Three<W> spring = turned<W>({memory.a, memory.b, memory.c}, normal, loaded<W>(c.twist + at));
  const Three<W> rolling = scaled<W>(radius, cross<W>(turning, normal));
  const Three<W> held = slid<W>(law.friction * repulsion, none + law.stiffness, none + law.damping,
                                rolling, dt, apart, spring);
  if (!(law.stiffness > 0)) spring = zero;

  const V rate = dot<W>(turning, normal), limit = law.twisting_friction * repulsion;
  const V viscous = -law.twisting_damping * rate;
  const V trial = memory.d - law.twisting_stiffness * rate * dt, sum = trial + viscous;
  const V twisted = within<W>(sum, limit);
  V twist = within<W>(twisted == sum ? trial : twisted - viscous, limit);
  if (!(law.twisting_stiffness > 0)) twist = none;

  const Three<W> moment = scaled<W>(radius, cross<W>(normal, held)) + scaled<W>(twisted, normal);
  put<W>(chosen<W>(apart, zero, moment), c.moment, at);
  put<W>(chosen<W>(apart, zero, spring), c.roll, at);
  store<W>(apart ? none : twist, c.roll_twist + at);
}

/// SphereStore::overlap and motion_at. Lanes beyond the batch do later pairs' work, for nobody.
template <int W, SphereLawKind kind>
[[gnu::always_inline]] inline void measure_overlap(const RoundNumbers& law, const SphereRows& rows,
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
  const Bodies<W> a = bodies_of<W>(body_i), b = bodies_of<W>(body_j);
  const Three<W> between = b.position - a.position;
  const V squared = dot<W>(between, between), reach = a.radius + b.radius;
  const auto apart = squared >= reach * reach;
  const V distance = root_of<W>(squared), inverse = 1 / distance, depth = reach - distance;
  const auto off_centre = distance > 0;
  const Three<W> normal{off_centre ? inverse * between.x : none + 1,
                        off_centre ? inverse * between.y : none,
                        off_centre ? inverse * between.z : none};
  const V lens = a.radius - depth * (2 * b.radius - depth) * (0.5 * inverse);
  const V inside = a.radius > b.radius ? distance : none;
  const V lever_i = distance > magnitude(a.radius - b.radius) ? lens : inside;
  const V lever_j = lever_i - distance;
  const Three<W> arm_i = scaled<W>(lever_i, normal), arm_j = scaled<W>(lever_j, normal);
  const Three<W> v = a.velocity - b.velocity + cross<W>(a.spin, arm_i) - cross<W>(b.spin, arm_j);
  const V approach = dot<W>(v, normal);
  put<W>(normal, to.normal, at);
  put<W>(v - scaled<W>(approach, normal), to.slip, at);
  store<W>(approach, to.approach + at);
  store<W>(depth, to.depth + at);
  store<W>(a.inverse_mass + b.inverse_mass, to.inverse_mass + at);
  store<W>(0.5 * law.dt * dot<W>(a.spin + b.spin, normal), to.twist + at);
  if constexpr (kind == SphereLawKind::hertz) {
    store<W>(root_of<W>(a.radius * b.radius / reach * depth), to.wide + at);
  }
  if (rows.rolling != nullptr) {
    put<W>(a.spin - b.spin, to.turning, at);
    store<W>(a.radius * b.radius / reach, to.radius + at);
  }
  store<W>(lever_i, to.lever_i + at);
  store<W>(lever_j, to.lever_j + at);
  store<W>(apart ? none + 1 : none, to.apart + at);
}

/// turn_with_contact, the law, friction_force and forces_at, of central contacts; 0 of pairs that
/// do not touch.
template <int W, SphereLawKind kind, bool rolls>
[[gnu::always_inline]] inline void add_forces(const RoundNumbers& law,
                                              const RollingNumbers& rolling, const SphereRows& rows,
                                              const RowBatch& batch, int at, PairLanes& c) {
  using V = Lanes<W>;
  const V none{};
  const double* before[W];
  for (int k = 0; k < W; ++k) before[k] = memory_of<kind>(rows, batch.pair[at + k]);
  const Four<W> memory = four_of<W>(before, 0);
  const Three<W> normal = three<W>(c.normal, at), slip = three<W>(c.slip, at);
  const V approach = loaded<W>(c.approach + at), depth = loaded<W>(c.depth + at);
  const auto apart = loaded<W>(c.apart + at) != 0;

  Three<W> spring = turned<W>({memory.a, memory.b, memory.c}, normal, loaded<W>(c.twist + at));
  const V mass = 1 / loaded<W>(c.inverse_mass + at);
  V stiffness = none + law.tangential, along, pushed, remembered = memory.d;
  if constexpr (kind == SphereLawKind::hertz) {
    const V wide = loaded<W>(c.wide + at), kn = law.normal * wide;
    stiffness = law.tangential * wide;
    const V across =
        law.viscoelastic ? law.across * wide * mass : law.across * root_of<W>(kn * mass);
    along = law.viscoelastic ? law.along * wide * mass : law.along * root_of<W>(stiffness * mass);
    pushed = kn * (2.0 / 3) * depth + across * approach;
    const auto shrinks = law.displacement ? (wide < memory.d) | (memory.d > 0) : wide < memory.d;
    spring = chosen<W>(shrinks, scaled<W>(wide / memory.d, spring), spring);
    remembered = apart ? none : wide;
  } else if constexpr (kind == SphereLawKind::linear) {
    along = mass * law.along;
    pushed = law.normal * depth + mass * law.across * approach;
  } else {
    along = none + law.along;
    pushed = law.normal * depth + law.across * root_of<W>(law.normal * mass) * approach;
  }
  const V repulsion = pushed < 0 ? none : pushed;

  const Three<W> tangential =
      slid<W>(law.friction * repulsion, stiffness, along, slip, law.dt, apart, spring);

  const Three<W> zero{none, none, none};
  const Three<W> force = tangential - scaled<W>(repulsion, normal);
  put<W>(chosen<W>(apart, zero, force), c.force, at);
  put<W>(chosen<W>(apart, zero, tangential), c.tangential, at);
  put<W>(chosen<W>(apart, zero, spring), c.spring, at);
  store<W>(remembered, c.remembered + at);
  if constexpr (rolls) roll<W>(rolling, law.dt, rows, batch, at, normal, force, c);
}

/// To the memories, and to the sums or what is kept of pairs. `full`: no lane is beyond the batch.
template <int W, SphereLawKind kind, bool rolls, bool full>
[[gnu::always_inline]] inline void scatter(const SphereRows& rows, const RowBatch& batch, int at,
                                           const PairLanes& c) {
  const int left = full ? W : batch.count - at;
  const int* const pairs = batch.pair + at;
  const Three<W> normal = three<W>(c.normal, at), force = three<W>(c.force, at);
  const Three<W> tangential = three<W>(c.tangential, at), spring = three<W>(c.spring, at);
  Three<W> torque_i = cross<W>(scaled<W>(loaded<W>(c.lever_i + at), normal), tangential);
  Three<W> torque_j = -cross<W>(scaled<W>(loaded<W>(c.lever_j + at), normal), tangential);
  if constexpr (rolls) {
    const Three<W> moment = three<W>(c.moment, at), spring_roll = three<W>(c.roll, at);
    torque_i = torque_i + moment;
    torque_j = torque_j - moment;
    each_row<W>({spring_roll.x, spring_roll.y, spring_roll.z, loaded<W>(c.roll_twist + at)},
                [&](int k, const Lanes<4>& row) {
                  if (k < left) store<4>(row, rolling_of(rows, pairs[k]));
                });
  }
  each_row<W>({spring.x, spring.y, spring.z, loaded<W>(c.remembered + at)},
              [&](int k, const Lanes<4>& row) {
                if (k >= left) return;
                double* const memory = memory_of<kind>(rows, pairs[k]);
                if constexpr (kind == SphereLawKind::hertz) return store<4>(row, memory);
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

template <int W, SphereLawKind kind, bool rolls>
[[gnu::always_inline]] inline void forces(const RoundNumbers& law, const RollingNumbers& rolling,
                                          const SphereRows& rows, const RowBatch& batch) {
  static_assert(kPairsBehind >= kPairsAhead + W);
  PairLanes lanes;
  for (int at = 0; at < batch.count; at += W) measure_overlap<W, kind>(law, rows, batch, at, lanes);
  for (int at = 0; at < batch.count; at += W)
    add_forces<W, kind, rolls>(law, rolling, rows, batch, at, lanes);
  int at = 0;
  for (; at + W <= batch.count; at += W) scatter<W, kind, rolls, true>(rows, batch, at, lanes);
  if (at < batch.count) scatter<W, kind, rolls, false>(rows, batch, at, lanes);
}
template <int W, SphereLawKind kind>
void forces(const RoundNumbers& law, const RollingNumbers& rolling, const SphereRows& rows,
            const RowBatch& batch) {
  if (rows.rolling != nullptr) return forces<W, kind, true>(law, rolling, rows, batch);
  forces<W, kind, false>(law, rolling, rows, batch);
}

}  // namespace

template <int W>
void sphere_forces_of(const RoundNumbers& law, const RollingNumbers& rolling,
                      const SphereRows& rows, const RowBatch& batch) {
  switch (law.kind) {
    case SphereLawKind::hertz:
      return forces<W, SphereLawKind::hertz>(law, rolling, rows, batch);
    case SphereLawKind::linear:
      return forces<W, SphereLawKind::linear>(law, rolling, rows, batch);
    case SphereLawKind::penalty:
      return forces<W, SphereLawKind::penalty>(law, rolling, rows, batch);
  }
}
template void sphere_forces_of<GRAINFIELD_LANES>(const RoundNumbers& law,
                                                 const RollingNumbers& rolling,
                                                 const SphereRows& rows, const RowBatch& batch);

}  // namespace grainfield::dem
