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

/// As capped (contact.h). Seldom does any of W contacts slide.
template <int W>
[[gnu::always_inline]] inline Three<W> capped(const Three<W>& v, const Lanes<W>& limit) {
  const Lanes<W> size = root_of<W>(dot<W>(v, v));
  const auto slides = size > limit;
  if (!any_of(slides)) return v;
  return chosen<W>(slides, scaled<W>(limit / size, v), v);
}

template <int W, SphereLawKind kind>
[[gnu::always_inline]] inline void forces(const SphereNumbers& law, const SphereRows& rows,
                                          const SphereBatch& batch, int at) {
  using V = Lanes<W>;
  const V none{};
  const double *body_i[W], *body_j[W];
  double *memories[W], *sum_i[W], *sum_j[W];
  const int left = batch.count - at;  // lanes beyond do the first one's work again, for nobody
  for (int k = 0; k < W; ++k) {
    const int slot = k < left ? at + k : at;
    unsigned char* const pair = rows.pairs + std::ptrdiff_t{batch.first + slot} * rows.pair_size;
    int j = 0, later = 0;
    __builtin_memcpy(&j, pair + rows.second, sizeof j);
    __builtin_memcpy(&later, pair + std::ptrdiff_t{rows.ahead} * rows.pair_size + rows.second,
                     sizeof later);
    const std::ptrdiff_t i = batch.i[slot];
    memories[k] = reinterpret_cast<double*>(pair);
    body_i[k] = rows.bodies + i * rows.body_size;
    sum_i[k] = rows.sums + i * rows.sum_size;
    body_j[k] = rows.bodies + std::ptrdiff_t{j} * rows.body_size;
    sum_j[k] = rows.sums + std::ptrdiff_t{j} * rows.sum_size;
    __builtin_prefetch(rows.bodies + std::ptrdiff_t{later} * rows.body_size);
    __builtin_prefetch(rows.bodies + std::ptrdiff_t{later} * rows.body_size + 8);
    __builtin_prefetch(rows.sums + std::ptrdiff_t{later} * rows.sum_size, 1);
  }
  const Bodies<W> a = bodies_of<W>(body_i), b = bodies_of<W>(body_j);
  const Four<W> memory = four_of<W>(memories, 0);

  // SphereStore::overlap.
  const Three<W> between = b.position - a.position;
  const V squared = dot<W>(between, between), reach = a.radius + b.radius;
  const auto apart = squared >= reach * reach;
  const V distance = root_of<W>(squared), depth = reach - distance;
  const auto off_centre = distance > 0;
  const Three<W> normal{off_centre ? between.x / distance : none + 1,
                        off_centre ? between.y / distance : none,
                        off_centre ? between.z / distance : none};
  const V lens = a.radius - depth * (2 * b.radius - depth) / (2 * distance);
  const V inside = a.radius > b.radius ? distance : none;
  const V lever = distance > magnitude(a.radius - b.radius) ? lens : inside;
  const Three<W> arm_i = scaled<W>(lever, normal), arm_j = scaled<W>(lever - distance, normal);

  // motion_at.
  const Three<W> v = a.velocity - b.velocity + cross<W>(a.spin, arm_i) - cross<W>(b.spin, arm_j);
  const V approach = dot<W>(v, normal);
  const Three<W> slip = v - scaled<W>(approach, normal);

  // turn_with_contact.
  const Three<W> old{memory.a, memory.b, memory.c};
  const V twist = 0.5 * law.dt * dot<W>(a.spin + b.spin, normal);
  const V size = root_of<W>(dot<W>(old, old));
  Three<W> spring = old - scaled<W>(dot<W>(old, normal), normal);
  spring = spring + scaled<W>(twist, cross<W>(normal, spring));
  const V now = root_of<W>(dot<W>(spring, spring));
  spring = chosen<W>(now > 0, scaled<W>(size / now, spring), spring);
  spring = chosen<W>(size > 0, spring, old);

  // The law.
  const V mass = 1 / (a.inverse_mass + b.inverse_mass);
  V stiffness = none + law.tangential, along, pushed, remembered = memory.d;
  if constexpr (kind == SphereLawKind::hertz) {
    const V radius = a.radius * b.radius / reach, wide = root_of<W>(radius * depth);
    const V kn = law.normal * wide;
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

  // friction_force.
  const V limit = law.friction * repulsion;
  const Three<W> viscous = scaled<W>(-along, slip);
  const Three<W> advance = scaled<W>(stiffness, slip);
  const Three<W> trial{spring.x - advance.x * law.dt, spring.y - advance.y * law.dt,
                       spring.z - advance.z * law.dt};
  const Three<W> sum = trial + viscous;
  const Three<W> tangential = capped<W>(sum, limit);
  const auto all = (tangential.x == sum.x) & (tangential.y == sum.y) & (tangential.z == sum.z);
  spring = capped<W>(chosen<W>(all, trial, tangential - viscous), limit);

  // forces_at, of central contacts; 0 of pairs that do not touch.
  const Three<W> zero{none, none, none};
  const Three<W> force = chosen<W>(apart, zero, tangential - scaled<W>(repulsion, normal));
  const Three<W> torque_i = chosen<W>(apart, zero, cross<W>(arm_i, tangential));
  const Three<W> torque_j = chosen<W>(apart, zero, -cross<W>(arm_j, tangential));
  spring = chosen<W>(apart, zero, spring);

  each_row<W>({spring.x, spring.y, spring.z, remembered}, [&](int k, const Lanes<4>& row) {
    if (k < left) store<4>(row, memories[k]);
  });
  // A grain is the second of its pairs in earlier rows, then the first of those in its own: so all
  // second ones before the first ones keep the order of every sum.
  each_row<W>({-force.x, -force.y, -force.z, torque_j.x}, [&](int k, const Lanes<4>& row) {
    if (k < left) store<4>(loaded<4>(sum_j[k]) + row, sum_j[k]);
  });
  each_pair<W>(torque_j.y, torque_j.z, [&](int k, const Lanes<2>& row) {
    if (k < left) store<2>(loaded<2>(sum_j[k] + 4) + row, sum_j[k] + 4);
  });
  each_row<W>({force.x, force.y, force.z, torque_i.x}, [&](int k, const Lanes<4>& row) {
    if (k < left) store<4>(loaded<4>(sum_i[k]) + row, sum_i[k]);
  });
  each_pair<W>(torque_i.y, torque_i.z, [&](int k, const Lanes<2>& row) {
    if (k < left) store<2>(loaded<2>(sum_i[k] + 4) + row, sum_i[k] + 4);
  });
}

}  // namespace

template <int W>
void sphere_forces_of(const SphereNumbers& law, const SphereRows& rows, const SphereBatch& batch) {
  switch (law.kind) {
    case SphereLawKind::hertz:
      for (int at = 0; at < batch.count; at += W) {
        forces<W, SphereLawKind::hertz>(law, rows, batch, at);
      }
      return;
    case SphereLawKind::linear:
      for (int at = 0; at < batch.count; at += W) {
        forces<W, SphereLawKind::linear>(law, rows, batch, at);
      }
      return;
    case SphereLawKind::penalty:
      for (int at = 0; at < batch.count; at += W) {
        forces<W, SphereLawKind::penalty>(law, rows, batch, at);
      }
      return;
  }
}
template void sphere_forces_of<GRAINFIELD_LANES>(const SphereNumbers& law, const SphereRows& rows,
                                                 const SphereBatch& batch);

}  // namespace grainfield::dem
