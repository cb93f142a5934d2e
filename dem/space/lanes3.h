// Vectors of two and of three dimensions side by side (lanes.h).
#pragma once
#include "dem/space/number.h"
#include "dem/space/overlap_batch.h"

namespace grainfield::dem::inline GRAINFIELD_INSTRUCTIONS {

/// A vector in the plane of each lane, as far as Eigen's are needed of one.
template <int W>
struct Two {
  Lanes<W> first, second;

  [[gnu::always_inline]] static Two Zero() { return {Lanes<W>{}, Lanes<W>{}}; }
  [[gnu::always_inline]] Lanes<W>& x() { return first; }
  [[gnu::always_inline]] Lanes<W>& y() { return second; }
  [[gnu::always_inline]] const Lanes<W>& x() const { return first; }
  [[gnu::always_inline]] const Lanes<W>& y() const { return second; }
};

/// A vector of each lane, as far as Eigen's are needed of one. The order of every sum is that of
/// Eigen's vectors of three.
template <int W>
struct Three {
  Lanes<W> x, y, z;

  [[gnu::always_inline]] static Three Zero() { return {Lanes<W>{}, Lanes<W>{}, Lanes<W>{}}; }
  [[gnu::always_inline]] static Three UnitX() { return {Lanes<W>{} + 1, Lanes<W>{}, Lanes<W>{}}; }
  [[gnu::always_inline]] Lanes<W> dot(const Three& b) const {
    return x * b.x + (y * b.y + z * b.z);
  }
  [[gnu::always_inline]] Lanes<W> squaredNorm() const { return dot(*this); }
  [[gnu::always_inline]] Three cross(const Three& b) const {
    return {y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x};
  }
};
template <int W>
[[gnu::always_inline]] inline Three<W> three(const double (*from)[kBatch], int at) {
  return {loaded<W>(from[0] + at), loaded<W>(from[1] + at), loaded<W>(from[2] + at)};
}
template <int W>
[[gnu::always_inline]] inline void put(const Three<W>& v, double (*to)[kBatch], int at) {
  store<W>(v.x, to[0] + at);
  store<W>(v.y, to[1] + at);
  store<W>(v.z, to[2] + at);
}
template <int W>
[[gnu::always_inline]] inline Three<W> operator+(const Three<W>& a, const Three<W>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <int W>
[[gnu::always_inline]] inline Three<W> operator-(const Three<W>& a, const Three<W>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <int W>
[[gnu::always_inline]] inline Three<W> operator-(const Three<W>& a) {
  return {-a.x, -a.y, -a.z};
}
/// `s`: a double, or a number of each lane.
template <class N, int W>
[[gnu::always_inline]] inline Three<W> operator*(const N& s, const Three<W>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <int W>
[[gnu::always_inline]] inline Three<W> operator*(const Three<W>& a, double s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <int W>
[[gnu::always_inline]] inline Three<W> scaled(const Lanes<W>& s, const Three<W>& a) {
  return s * a;
}
template <int W>
[[gnu::always_inline]] inline Lanes<W> dot(const Three<W>& a, const Three<W>& b) {
  return a.dot(b);
}
template <int W>
[[gnu::always_inline]] inline Three<W> cross(const Three<W>& a, const Three<W>& b) {
  return a.cross(b);
}
template <int W, class M>
[[gnu::always_inline]] inline Three<W> chosen(const M& mask, const Three<W>& a, const Three<W>& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}
template <int W>
[[gnu::always_inline]] inline auto same(const Three<W>& a, const Three<W>& b) {
  return (a.x == b.x) & (a.y == b.y) & (a.z == b.z);
}

}  // namespace grainfield::dem::inline GRAINFIELD_INSTRUCTIONS
