// Compiled for every width (lanes.h): no function of it may be another file's, too.
#include "dem/motion/turn_lanes.h"

#include "dem/space/lanes3.h"

namespace grainfield::dem {
namespace {

/// A quaternion of each lane.
template <int W>
struct Turn {
  Lanes<W> w;
  Three<W> v;
};
template <int W>
[[gnu::always_inline]] inline Three<W> turned(const Turn<W>& q, const Three<W>& a) {
  const Three<W> once = cross<W>(q.v, a), twice = once + once;
  return a + scaled<W>(q.w, twice) + cross<W>(q.v, twice);
}
template <int W>
[[gnu::always_inline]] inline Turn<W> back(const Turn<W>& q) {
  return {q.w, -q.v};
}
template <int W>
[[gnu::always_inline]] inline Turn<W> product(const Turn<W>& a, const Turn<W>& b) {
  const Three<W>&p = a.v, &q = b.v;
  return {
      a.w * b.w - p.x * q.x - p.y * q.y - p.z * q.z,
      {a.w * q.x + p.x * b.w + p.y * q.z - p.z * q.y, a.w * q.y + p.y * b.w + p.z * q.x - p.x * q.z,
       a.w * q.z + p.z * b.w + p.x * q.y - p.y * q.x}};
}

/// As quaternion_of (space3.h), with rotation_of (rotation.h), of `size` along an axis.
template <int W>
[[gnu::always_inline]] inline Turn<W> turn_about(int axis, const Lanes<W>& size) {
  using V = Lanes<W>;
  using Bits = typename LanesOf<W>::Bits;
  constexpr double kTwoOverPi = 0.63661977236758134308;
  constexpr double kHalfPiHigh = 1.57079632673412561417e+00;
  constexpr double kHalfPiLow = 6.07710050650619224932e-11;
  constexpr double kRound = 6755399441055744.0;
  const V full = root_of<W>(size * size), angle = 0.5 * full;
  const V shifted = angle * kTwoOverPi + kRound, turns = shifted - kRound;
  const V r = (angle - turns * kHalfPiHigh) - turns * kHalfPiLow;
  const V q = r * r, q2 = q * q, q4 = q2 * q2;
  const V ps = (q * (-1.0 / 6) + q2 * (1.0 / 120 + q * (-1.0 / 5040))) +
               q4 * ((1.0 / 362880 + q * (-1.0 / 39916800)) +
                     q2 * (1.0 / 6227020800 + q * (-1.0 / 1307674368000)));
  const V pc = (q * -0.5 + q2 * (1.0 / 24 + q * (-1.0 / 720))) +
               q4 * (((1.0 / 40320 + q * (-1.0 / 3628800)) +
                      q2 * (1.0 / 479001600 + q * (-1.0 / 87178291200))) +
                     q4 * (1.0 / 20922789888000));
  const V s = r + r * ps, c = 1 + pc;
  // The quarter is in the last bits of the rounded sum.
  const Bits quarter =
      reinterpret_cast<Bits>(shifted) & (magnitude(turns) < 1e15 ? Bits{} + 3 : Bits{});
  const auto swapped = (quarter & 1) != 0, negative = (quarter & 2) != 0;
  const V cosine = swapped ? -s : c, sine = swapped ? c : s;
  const auto turns_at_all = full > 0;
  const V share = (negative ? -sine : sine) / full, none{};
  const V along = turns_at_all ? share * size : none;
  const V beside = turns_at_all ? share * (size * none) : none;
  Turn<W> out{turns_at_all ? (negative ? -cosine : cosine) : none + 1, {beside, beside, beside}};
  (axis == 0 ? out.v.x : axis == 1 ? out.v.y : out.v.z) = along;
  return out;
}

template <int W>
[[gnu::always_inline]] inline void turn(int axis, double dt, const Three<W>& moments,
                                        Three<W>& momentum, Turn<W>& rotation) {
  const auto along = [axis](const Three<W>& v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
  const Turn<W> by = turn_about<W>(axis, dt * along(momentum) / along(moments));
  momentum = turned<W>(back<W>(by), momentum);
  rotation = product<W>(rotation, by);
}

template <int W>
[[gnu::always_inline]] inline void drift(TurnBatch& b, double dt, int at) {
  using V = Lanes<W>;
  const Three<W> moments = three<W>(b.moments, at);
  Turn<W> rotation{loaded<W>(b.rotation[3] + at), three<W>(b.rotation, at)};
  const Three<W> spin = turned<W>(back<W>(rotation), three<W>(b.spin, at));
  const Three<W> before =
      turned<W>(rotation, Three<W>{moments.x * spin.x, moments.y * spin.y, moments.z * spin.z});
  const Three<W> world = before + scaled<W>(V{} + 0.5 * dt, three<W>(b.torque, at));
  Three<W> momentum = turned<W>(back<W>(rotation), world);
  turn<W>(0, 0.5 * dt, moments, momentum, rotation);
  turn<W>(1, 0.5 * dt, moments, momentum, rotation);
  turn<W>(2, dt, moments, momentum, rotation);
  turn<W>(1, 0.5 * dt, moments, momentum, rotation);
  turn<W>(0, 0.5 * dt, moments, momentum, rotation);
  const Three<W> rate{momentum.x / moments.x, momentum.y / moments.y, momentum.z / moments.z};
  put<W>(turned<W>(rotation, rate), b.spin, at);
  const Three<W>& v = rotation.v;
  const V square = (v.x * v.x + v.y * v.y) + (v.z * v.z + rotation.w * rotation.w);
  const V size = square > 0 ? root_of<W>(square) : V{} + 1;
  put<W>({v.x / size, v.y / size, v.z / size}, b.rotation, at);
  store<W>(rotation.w / size, b.rotation[3] + at);
}

}  // namespace

template <int W>
void drift_turning_of(TurnBatch& b, double dt, int count) {
  for (int at = 0; at < count; at += W) drift<W>(b, dt, at);
}
template void drift_turning_of<GRAINFIELD_LANES>(TurnBatch& b, double dt, int count);

}  // namespace grainfield::dem
