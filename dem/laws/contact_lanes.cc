// Compiled for every width (lanes.h): no function of it may be another file's, too.
#include "dem/laws/contact_lanes.h"

#include "dem/space/lane_rows.h"
#include "dem/space/lanes3.h"

namespace grainfield::dem {
namespace {

constexpr double kPi = 3.141592653589793238462643383279502884;
// Beyond it turned_by (kinematics3.h) takes sine and cosine.
constexpr double kMostTurnSquared = 1e-2;

/// Springs capped as by capped (contact.h).
template <int W>
[[gnu::always_inline]] inline Three<W> capped(const Three<W>& v, const Lanes<W>& limit) {
  const Lanes<W> square = dot<W>(v, v);
  const auto slides = square > limit * limit;
  if (!any_of(slides)) return v;
  return chosen<W>(slides, scaled<W>(limit / root_of<W>(square), v), v);
}

/// Springs turned as by turned_by and turn_with_material.
template <int W>
[[gnu::always_inline]] inline Three<W> turned(const Three<W>& spring, const Three<W>& normal,
                                              const Three<W>& turn, const Lanes<W>& square) {
  const Lanes<W> size = root_of<W>(dot<W>(spring, spring));
  const Lanes<W> share =
      0.5 * (1 + square * (1.0 / 12 + square * (1.0 / 120 + square * (17.0 / 20160 +
                                                                      square * (31.0 / 362880)))));
  const Three<W> t = scaled<W>(share, turn), once = cross<W>(t, spring);
  Three<W> out = spring + scaled<W>(2 / (1 + dot<W>(t, t)), once + cross<W>(t, once));
  out = out - scaled<W>(dot<W>(out, normal), normal);
  const Lanes<W> now = root_of<W>(dot<W>(out, out));
  out = chosen<W>(now > 0, scaled<W>(size / now, out), out);
  return chosen<W>(size > 0, out, spring);
}

/// Numbers of EllipticContact.
template <int W>
struct LaneEllipse {
  Lanes<W> gamma, axis, k, b, d;
};
/// Contacts as of EllipseTable::contact, for ratios that the table has.
template <int W>
[[gnu::always_inline]] inline LaneEllipse<W> ellipse_of(const double* table, const Lanes<W>& lesser,
                                                        const Lanes<W>& greater) {
  using V = Lanes<W>;
  using Bits = typename LanesOf<W>::Bits;
  const V ratio = greater_of(greater / lesser, V{} + 1.0);
  const Bits bits = reinterpret_cast<Bits>(ratio);
  const Bits part = (bits >> 49) - (std::uint64_t{1023} << 3);
  const Bits rest = (bits & ((std::uint64_t{1} << 49) - 1)) << 3 | (std::uint64_t{1023} << 52);
  const V t = 2 * reinterpret_cast<V>(rest) - 3, t2 = t * t, t4 = t2 * t2;
  const double* rows[W];
  for (int k = 0; k < W; ++k) rows[k] = table + kEllipseRow * part[k];
  V columns[kEllipseRow];
  for (int n = 0; n < kEllipseRow; n += 4) {
    const int at = n < kEllipseRow - 4 ? n : kEllipseRow - 4;
    const Four<W> four = four_of<W>(rows, at);
    columns[at] = four.a;
    columns[at + 1] = four.b;
    columns[at + 2] = four.c;
    columns[at + 3] = four.d;
  }
  const auto sum = [&](int first) {
    const V* c = columns + first;
    return (c[0] + c[1] * t + (c[2] + c[3] * t) * t2) +
           t4 * ((c[4] + c[5] * t + (c[6] + c[7] * t) * t2) + t4 * c[8]);
  };
  LaneEllipse<W> out;
  out.k = sum(0);
  out.d = sum(kEllipseRow / 2);
  out.b = out.k - out.d;
  const V kappa = root_of<W>(ratio * out.d / out.b);
  const V e = out.k - (1 - 1 / (kappa * kappa)) * out.d;
  out.gamma = 2.0 / 3 * kPi * kappa * root_of<W>(e / (out.k * out.k * out.k * (lesser + greater)));
  out.axis = root_of<W>(out.d / (lesser * out.k));
  return out;
}

/// Both bodies of each contact (body.h) at the contact.
template <int W>
struct LaneMotion {
  Lanes<W> depth, approach, mass;
  Three<W> normal, slip;
};

/// What a law does to the memory, but for friction, and the repulsion with its dashpot, N.
template <int W>
[[gnu::always_inline]] inline Lanes<W> repulsion(const EllipticNumbers& law, const OverlapBatch& o,
                                                 int at, const LaneMotion<W>& m, Three<W>& spring,
                                                 Lanes<W>& contact_radius) {
  using V = Lanes<W>;
  const V radius = loaded<W>(o.radius + at);
  const V least = 0.5 / (law.most_radius * radius), most = 0.5 / (law.least_radius * radius);
  const auto within = [&](const V& x) {
    const V above = x < least ? least : x;
    return most < above ? most : above;
  };
  const LaneEllipse<W> ellipse =
      ellipse_of<W>(law.table, within(loaded<W>(o.lesser_curvature + at)),
                    within(loaded<W>(o.greater_curvature + at)));
  const V root = root_of<W>(m.depth);
  const V stiffness = 1.5 * ellipse.gamma * law.effective_young * root;
  const V dashpot = 2 * law.damping * root_of<W>(stiffness * m.mass);

  const V a = ellipse.axis * root, before = contact_radius;
  const auto shrinks = law.displacement ? (a < before) | (before > 0) : a < before;
  spring = chosen<W>(shrinks, scaled<W>(a / before, spring), spring);
  contact_radius = a;
  const V scale = 2 * (1 + law.poisson) / (law.young * kPi * a);
  const V along = scale * (ellipse.k - law.poisson * ellipse.b);
  const V beside = scale * (ellipse.k - law.poisson * ellipse.d);
  const Three<W> major = three<W>(o.major, at), minor = cross<W>(m.normal, major);
  spring = spring - scaled<W>(law.dt * dot<W>(m.slip, major) / along, major);
  spring = spring - scaled<W>(law.dt * dot<W>(m.slip, minor) / beside, minor);
  return stiffness * (2.0 / 3) * m.depth + dashpot * m.approach;
}
template <int W>
[[gnu::always_inline]] inline Lanes<W> repulsion(const PenaltyNumbers& law, const OverlapBatch&,
                                                 int, const LaneMotion<W>& m, Three<W>&,
                                                 Lanes<W>&) {
  const Lanes<W> dashpot = 2 * law.damping * root_of<W>(law.normal * m.mass);
  return law.normal * m.depth + dashpot * m.approach;
}
/// The spring's advance, N, as friction_force makes it.
template <int W>
[[gnu::always_inline]] inline Three<W> advance(const EllipticNumbers&, const Three<W>& slip) {
  const Lanes<W> none{};
  return scaled<W>(none, scaled<W>(none, slip));
}
template <int W>
[[gnu::always_inline]] inline Three<W> advance(const PenaltyNumbers& law, const Three<W>& slip) {
  const Lanes<W> none{};
  return scaled<W>(none + law.dt, scaled<W>(none + law.tangential, slip));
}

template <int W, class Law>
[[gnu::always_inline]] inline void forces(const Law& law, const OverlapBatch& o, ContactBatch& c,
                                          int at) {
  using V = Lanes<W>;
  const V none{};
  const Three<W> arm_i = three<W>(o.arm_i, at), arm_j = three<W>(o.arm_j, at);
  // Velocity and the first number of the spin; its others, the radius and the inverse mass.
  const Four<W> fast_i = four_of<W>(c.body_i + at, 3), slow_i = four_of<W>(c.body_i + at, 7);
  const Four<W> fast_j = four_of<W>(c.body_j + at, 3), slow_j = four_of<W>(c.body_j + at, 7);
  const Three<W> spin_i{fast_i.d, slow_i.a, slow_i.b}, spin_j{fast_j.d, slow_j.a, slow_j.b};
  Three<W> velocity_j{fast_j.a, fast_j.b, fast_j.c};
  const auto across = loaded<W>(c.across + at) > 0;
  if (any_of(across)) {
    velocity_j = chosen<W>(across, velocity_j + three<W>(c.drift, at), velocity_j);
  }

  // motion_at.
  LaneMotion<W> m;
  m.normal = three<W>(o.normal, at);
  m.depth = loaded<W>(o.depth + at);
  const Three<W> v = Three<W>{fast_i.a, fast_i.b, fast_i.c} - velocity_j + cross<W>(spin_i, arm_i) -
                     cross<W>(spin_j, arm_j);
  m.approach = dot<W>(v, m.normal);
  m.slip = v - scaled<W>(m.approach, m.normal);
  m.mass = 1 / (slow_i.d + slow_j.d);

  const Three<W> turn = scaled<W>(V{} + 0.5 * law.dt, spin_i + spin_j);
  const V square = dot<W>(turn, turn);
  const auto too_far = ~(square < kMostTurnSquared);
  store<W>(too_far ? V{} + 1.0 : none, c.left + at);
  const Four<W> before = four_of<W>(c.memory + at, 0);
  const Three<W> old{before.a, before.b, before.c};
  Three<W> spring = turned<W>(old, m.normal, turn, square);

  V fourth = before.d;
  const V pushed = repulsion<W>(law, o, at, m, spring, fourth);
  const V repulsion = pushed < 0 ? none : pushed;

  // friction_force, without a viscosity.
  const V limit = law.friction * repulsion;
  const Three<W> viscous = scaled<W>(-none, m.slip);
  const Three<W> trial = spring - advance<W>(law, m.slip), sum = trial + viscous;
  const Three<W> tangential = capped<W>(sum, limit);
  const auto all = (tangential.x == sum.x) & (tangential.y == sum.y) & (tangential.z == sum.z);
  spring = capped<W>(chosen<W>(all, trial, tangential - viscous), limit);
  spring = chosen<W>(too_far, old, spring);
  fourth = too_far ? before.d : fourth;
  each_row<W>(Four<W>{spring.x, spring.y, spring.z, fourth},
              [&](int k, const Lanes<4>& row) { store<4>(row, c.memory[at + k]); });

  // forces_at.
  const Three<W> force = tangential - scaled<W>(repulsion, m.normal);
  const Three<W> torque_i = cross<W>(arm_i, force), torque_j = -cross<W>(arm_j, force);
  each_row<W>(Four<W>{force.x, force.y, force.z, torque_i.x},
              [&](int k, const Lanes<4>& row) { store<4>(row, c.force[at + k]); });
  each_row<W>(Four<W>{torque_i.y, torque_i.z, torque_j.x, torque_j.y},
              [&](int k, const Lanes<4>& row) { store<4>(row, c.force[at + k] + 4); });
  for (int k = 0; k < W; ++k) c.force[at + k][8] = torque_j.z[k];
}

}  // namespace

template <int W, class Law>
void contact_forces_of(const Law& law, const OverlapBatch& o, ContactBatch& c, int count) {
  for (int at = 0; at < count; at += W) forces<W>(law, o, c, at);
}
template void contact_forces_of<GRAINFIELD_LANES>(const EllipticNumbers& law, const OverlapBatch& o,
                                                  ContactBatch& c, int count);
template void contact_forces_of<GRAINFIELD_LANES>(const PenaltyNumbers& law, const OverlapBatch& o,
                                                  ContactBatch& c, int count);

}  // namespace grainfield::dem
