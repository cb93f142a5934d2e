// Compiled for every width (lanes.h): no function of it may be another file's, too.
#include "dem/laws/elliptic_lanes.h"

#include "dem/space/lanes3.h"

namespace grainfield::dem {
namespace {

constexpr double kPi = 3.141592653589793238462643383279502884;
// Beyond it turned_by (kinematics3.h) takes sine and cosine.
constexpr double kMostTurnSquared = 1e-2;

/// As capped (contact.h).
template <int W>
[[gnu::always_inline]] inline Three<W> capped(const Three<W>& v, const Lanes<W>& limit) {
  const Lanes<W> square = dot<W>(v, v);
  const auto slides = square > limit * limit;
  if (!any_of(slides)) return v;
  return chosen<W>(slides, scaled<W>(limit / root_of<W>(square), v), v);
}

/// As turned_by and turn_with_material.
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

/// As EllipticContact.
template <int W>
struct LaneEllipse {
  Lanes<W> gamma, axis, k, b, d;
};
/// As EllipseTable::contact, of ratios that the table has.
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
  V columns_of_rows[kEllipseRow];
  columns<W>(rows, columns_of_rows);
  const auto sum = [&](int first) {
    const V* c = columns_of_rows + first;
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

template <int W>
[[gnu::always_inline]] inline void forces(const EllipticNumbers& law, const OverlapBatch& o,
                                          ContactBatch& c, int at) {
  using V = Lanes<W>;
  const V none{};
  const Three<W> normal = three<W>(o.normal, at), major = three<W>(o.major, at);
  const Three<W> arm_i = three<W>(o.arm_i, at), arm_j = three<W>(o.arm_j, at);
  const Three<W> spin_i = three<W>(c.spin_i, at), spin_j = three<W>(c.spin_j, at);
  const V depth = loaded<W>(o.depth + at);

  // motion_at.
  const Three<W> v = three<W>(c.velocity, at) + cross<W>(spin_i, arm_i) - cross<W>(spin_j, arm_j);
  const V approach = dot<W>(v, normal);
  const Three<W> slip = v - scaled<W>(approach, normal);

  const Three<W> turn = scaled<W>(V{} + 0.5 * law.dt, spin_i + spin_j);
  const V square = dot<W>(turn, turn);
  const auto too_far = ~(square < kMostTurnSquared);
  store<W>(too_far ? V{} + 1.0 : none, c.left + at);
  Three<W> spring = turned<W>(three<W>(c.spring, at), normal, turn, square);

  const V radius = loaded<W>(o.radius + at);
  const V least = 0.5 / (law.most_radius * radius), most = 0.5 / (law.least_radius * radius);
  const auto within = [&](const V& x) {
    const V above = x < least ? least : x;
    return most < above ? most : above;
  };
  const LaneEllipse<W> ellipse =
      ellipse_of<W>(law.table, within(loaded<W>(o.lesser_curvature + at)),
                    within(loaded<W>(o.greater_curvature + at)));
  const V mass = 1 / loaded<W>(c.inverse_mass + at), root = root_of<W>(depth);
  const V stiffness = 1.5 * ellipse.gamma * law.effective_young * root;
  const V dashpot = 2 * law.damping * root_of<W>(stiffness * mass);
  const V pushed = stiffness * (2.0 / 3) * depth + dashpot * approach;
  const V repulsion = pushed < 0 ? none : pushed;

  const V a = ellipse.axis * root, before = loaded<W>(c.contact_radius + at);
  const auto shrinks = law.displacement ? (a < before) | (before > 0) : a < before;
  spring = chosen<W>(shrinks, scaled<W>(a / before, spring), spring);
  store<W>(too_far ? before : a, c.contact_radius + at);
  const V scale = 2 * (1 + law.poisson) / (law.young * kPi * a);
  const V along = scale * (ellipse.k - law.poisson * ellipse.b);
  const V beside = scale * (ellipse.k - law.poisson * ellipse.d);
  const Three<W> minor = cross<W>(normal, major);
  spring = spring - scaled<W>(law.dt * dot<W>(slip, major) / along, major);
  spring = spring - scaled<W>(law.dt * dot<W>(slip, minor) / beside, minor);

  // friction_force, without a stiffness and a viscosity of its own.
  const V limit = law.friction * repulsion;
  const Three<W> viscous = scaled<W>(-none, slip);
  const Three<W> still = scaled<W>(none, scaled<W>(none, slip));
  const Three<W> trial = spring - still, sum = trial + viscous;
  const Three<W> tangential = capped<W>(sum, limit);
  const auto all = (tangential.x == sum.x) & (tangential.y == sum.y) & (tangential.z == sum.z);
  spring = capped<W>(chosen<W>(all, trial, tangential - viscous), limit);
  const Three<W> old = three<W>(c.spring, at);
  put<W>(chosen<W>(too_far, old, spring), c.spring, at);

  // forces_at.
  const Three<W> force = tangential - scaled<W>(repulsion, normal);
  put<W>(force, c.force, at);
  put<W>(cross<W>(arm_i, force), c.torque_i, at);
  put<W>(-cross<W>(arm_j, force), c.torque_j, at);
}

}  // namespace

template <int W>
void elliptic_forces_of(const EllipticNumbers& law, const OverlapBatch& o, ContactBatch& c,
                        int count) {
  for (int at = 0; at < count; at += W) forces<W>(law, o, c, at);
}
template void elliptic_forces_of<GRAINFIELD_LANES>(const EllipticNumbers& law,
                                                   const OverlapBatch& o, ContactBatch& c,
                                                   int count);

}  // namespace grainfield::dem
