// Quaternions side by side (lanes.h), operation by operation as space3.h and Eigen have them.
#pragma once
#include "dem/space/lane_angle.h"
#include "dem/space/lanes3.h"

namespace grainfield::dem {

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

/// As quaternion_of (space3.h) of `size` along an axis.
template <int W>
[[gnu::always_inline]] inline Turn<W> turn_about(int axis, const Lanes<W>& size) {
  using V = Lanes<W>;
  const V full = root_of<W>(size * size);
  const Angle<W> half = angle_of<W>(0.5 * full);
  const auto turns_at_all = full > 0;
  const V share = half.sine / full, none{};
  const V along = turns_at_all ? share * size : none;
  const V beside = turns_at_all ? share * (size * none) : none;
  Turn<W> out{turns_at_all ? half.cosine : none + 1, {beside, beside, beside}};
  (axis == 0 ? out.v.x : axis == 1 ? out.v.y : out.v.z) = along;
  return out;
}
/// As quaternion_of.
template <int W>
[[gnu::always_inline]] inline Turn<W> turn_by(const Three<W>& turn) {
  using V = Lanes<W>;
  const V full = root_of<W>(dot<W>(turn, turn)), none{};
  const Angle<W> half = angle_of<W>(0.5 * full);
  const auto turns_at_all = full > 0;
  return {turns_at_all ? half.cosine : none + 1,
          chosen<W>(turns_at_all, scaled<W>(half.sine / full, turn), Three<W>{none, none, none})};
}

template <int W>
[[gnu::always_inline]] inline Lanes<W> squared(const Turn<W>& q) {
  const Three<W>& v = q.v;
  return (v.x * v.x + v.y * v.y) + (v.z * v.z + q.w * q.w);
}
template <int W>
[[gnu::always_inline]] inline Turn<W> normalized(const Turn<W>& q) {
  const Lanes<W> square = squared<W>(q);
  const Lanes<W> size = square > 0 ? root_of<W>(square) : Lanes<W>{} + 1;
  return {q.w / size, {q.v.x / size, q.v.y / size, q.v.z / size}};
}

}  // namespace grainfield::dem
