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
struct alignas(64) Passed {
  double normal[3][kBatch], slip[3][kBatch];
  double approach[kBatch], depth[kBatch], inverse_mass[kBatch];
  double twist[kBatch];                       ///< rad, about the normal
  double wide[kBatch];                        ///< of Hertz' law: the contact's radius, m
  double lever_i[kBatch], lever_j[kBatch];    ///< of the contact point along the normal, m
  double apart[kBatch];                       ///< not 0: the two do not touch
  double spring[3][kBatch], remembered[kBatch];
  double force[3][kBatch], tangential[3][kBatch];  ///< N
  double *sum_i[kBatch], *sum_j[kBatch], *memory[kBatch];
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

/// SphereStore::overlap and motion_at. Lanes beyond the batch do the first one's work again.
template <int W, SphereLawKind kind>
[[gnu::always_inline]] inline void meet(const SphereNumbers& law, const SphereRows& rows,
                                        const SphereBatch& batch, int at, Passed& to) {
  using V = Lanes<W>;
  const V none{};
  const double *body_i[W], *body_j[W];
  for (int k = 0; k < W; ++k) {
    const int slot = at + k < batch.count ? at + k : at;
    unsigned char* const pair = rows.pairs + std::ptrdiff_t{batch.first + slot} * pair_size(kind);
    int j = 0, later = 0;
    __builtin_memcpy(&j, pair + second_in_pair(kind), sizeof j);
    __builtin_memcpy(&later, pair + kPairsAhead * pair_size(kind) + second_in_pair(kind),
                     sizeof later);
    const std::ptrdiff_t i = batch.i[slot];
    to.memory[at + k] = reinterpret_cast<double*>(pair);
    body_i[k] = rows.bodies + i * kSphereBody;
    to.sum_i[at + k] = rows.sums + i * kSphereSum;
    body_j[k] = rows.bodies + std::ptrdiff_t{j} * kSphereBody;
    to.sum_j[at + k] = rows.sums + std::ptrdiff_t{j} * kSphereSum;
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
  store<W>(lever_i, to.lever_i + at);
  store<W>(lever_j, to.lever_j + at);
  store<W>(apart ? none + 1 : none, to.apart + at);
}

/// turn_with_contact, the law, friction_force and forces_at, of central contacts; 0 of pairs that do
/// not touch.
template <int W, SphereLawKind kind>
[[gnu::always_inline]] inline void press(const SphereNumbers& law, int at, Passed& at_contact) {
  using V = Lanes<W>;
  const V none{};
  Passed& c = at_contact;
  const Four<W> memory = four_of<W>(c.memory + at, 0);
  const Three<W> normal = three<W>(c.normal, at), slip = three<W>(c.slip, at);
  const V approach = loaded<W>(c.approach + at), depth = loaded<W>(c.depth + at);
  const auto apart = loaded<W>(c.apart + at) != 0;

  const Three<W> old{memory.a, memory.b, memory.c};
  const V before = dot<W>(old, old);
  Three<W> spring = old - scaled<W>(dot<W>(old, normal), normal);
  spring = spring + scaled<W>(loaded<W>(c.twist + at), cross<W>(normal, spring));
  const V now = dot<W>(spring, spring);
  spring = chosen<W>(now > 0, scaled<W>(root_of<W>(before / now), spring), spring);
  spring = chosen<W>(before > 0, spring, old);

  const V mass = 1 / loaded<W>(c.inverse_mass + at);
  V stiffness = none + law.tangential, along, pushed, remembered = memory.d;
  if constexpr (kind == SphereLawKind::hertz) {
    const V wide = loaded<W>(c.wide + at), kn = law.normal * wide;
    stiffness = law.tangential * wide;
    const V across = law.viscoelastic ? law.across * wide * mass
                                      : law.across * root_of<W>(kn * mass);
    along = law.viscoelastic ? law.along * wide * mass : law.along * root_of<W>(stiffness * mass);
    pushed = kn * (2.0 / 3) * depth + across * approach;
    const auto shrinks =
        law.displacement ? (wide < memory.d) | (memory.d > 0) : wide < memory.d;
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

  const V limit = law.friction * repulsion;
  const Three<W> viscous = scaled<W>(-along, slip);
  const Three<W> advance = scaled<W>(stiffness, slip);
  const Three<W> trial{spring.x - advance.x * law.dt, spring.y - advance.y * law.dt,
                       spring.z - advance.z * law.dt};
  const Three<W> sum = trial + viscous;
  const Three<W> tangential = capped<W>(sum, limit, apart);
  const auto all = (tangential.x == sum.x) & (tangential.y == sum.y) & (tangential.z == sum.z);
  spring = capped<W>(chosen<W>(all, trial, tangential - viscous), limit, apart);

  const Three<W> zero{none, none, none};
  put<W>(chosen<W>(apart, zero, tangential - scaled<W>(repulsion, normal)), c.force, at);
  put<W>(chosen<W>(apart, zero, tangential), c.tangential, at);
  put<W>(chosen<W>(apart, zero, spring), c.spring, at);
  store<W>(remembered, c.remembered + at);
}

/// To the memories and sums.
template <int W>
[[gnu::always_inline]] inline void give(const SphereBatch& batch, int at, const Passed& c) {
  const int left = batch.count - at;
  const Three<W> normal = three<W>(c.normal, at), force = three<W>(c.force, at);
  const Three<W> tangential = three<W>(c.tangential, at), spring = three<W>(c.spring, at);
  const Three<W> torque_i =
      cross<W>(scaled<W>(loaded<W>(c.lever_i + at), normal), tangential);
  const Three<W> torque_j =
      -cross<W>(scaled<W>(loaded<W>(c.lever_j + at), normal), tangential);
  each_row<W>({spring.x, spring.y, spring.z, loaded<W>(c.remembered + at)},
              [&](int k, const Lanes<4>& row) {
                if (k < left) store<4>(row, c.memory[at + k]);
              });
  // A grain is the second of its pairs in earlier rows, then the first of those in its own: so all
  // second ones before the first ones keep the order of every sum.
  const auto add = [&](const Three<W>& f, const Three<W>& torque, double* const* sums) {
    each_row<W>({f.x, f.y, f.z, torque.x}, [&](int k, const Lanes<4>& row) {
      if (k < left) store<4>(loaded<4>(sums[k]) + row, sums[k]);
    });
    each_pair<W>(torque.y, torque.z, [&](int k, const Lanes<2>& row) {
      if (k < left) store<2>(loaded<2>(sums[k] + 4) + row, sums[k] + 4);
    });
  };
  add(-force, torque_j, c.sum_j + at);
  add(force, torque_i, c.sum_i + at);
}

template <int W, SphereLawKind kind>
[[gnu::always_inline]] inline void forces(const SphereNumbers& law, const SphereRows& rows,
                                          const SphereBatch& batch) {
  Passed passed;
  for (int at = 0; at < batch.count; at += W) meet<W, kind>(law, rows, batch, at, passed);
  for (int at = 0; at < batch.count; at += W) press<W, kind>(law, at, passed);
  for (int at = 0; at < batch.count; at += W) give<W>(batch, at, passed);
}

}  // namespace

template <int W>
void sphere_forces_of(const SphereNumbers& law, const SphereRows& rows, const SphereBatch& batch) {
  switch (law.kind) {
    case SphereLawKind::hertz:
      return forces<W, SphereLawKind::hertz>(law, rows, batch);
    case SphereLawKind::linear:
      return forces<W, SphereLawKind::linear>(law, rows, batch);
    case SphereLawKind::penalty:
      return forces<W, SphereLawKind::penalty>(law, rows, batch);
  }
}
template void sphere_forces_of<GRAINFIELD_LANES>(const SphereNumbers& law, const SphereRows& rows,
                                                 const SphereBatch& batch);

}  // namespace grainfield::dem
