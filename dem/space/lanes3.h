// Vectors of three dimensions side by side (lanes.h).
#pragma once
#include "dem/space/lanes.h"
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

/// A vector of each lane. The order of every sum is that of Eigen's vectors of three.
template <int W>
struct Three {
  Lanes<W> x, y, z;
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
template <int W>
[[gnu::always_inline]] inline Three<W> scaled(const Lanes<W>& s, const Three<W>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <int W>
[[gnu::always_inline]] inline Lanes<W> dot(const Three<W>& a, const Three<W>& b) {
  return a.x * b.x + (a.y * b.y + a.z * b.z);
}
template <int W>
[[gnu::always_inline]] inline Three<W> cross(const Three<W>& a, const Three<W>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <int W, class M>
[[gnu::always_inline]] inline Three<W> chosen(const M& mask, const Three<W>& a, const Three<W>& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

}  // namespace grainfield::dem
