// Compiled for every width (lanes.h): no function of it may be another file's, too.
#include "dem/motion/turn_lanes.h"

#include "dem/motion/lane_turn.h"

namespace grainfield::dem {
namespace {

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
  const Turn<W> unit = normalized<W>(rotation);
  put<W>(unit.v, b.rotation, at);
  store<W>(unit.w, b.rotation[3] + at);
}

}  // namespace

template <int W>
void drift_turning_of(TurnBatch& b, double dt, int count) {
  for (int at = 0; at < count; at += W) drift<W>(b, dt, at);
}
template void drift_turning_of<GRAINFIELD_LANES>(TurnBatch& b, double dt, int count);

}  // namespace grainfield::dem
