// Compiled for every width (lanes.h): no function of it may be another file's, too.
#include "dem/laws/disk_lanes.h"

#include <cstddef>

#include "dem/space/lane_rows.h"

namespace grainfield::dem {
namespace {

/// What is known of pairs by slot, before it goes to the memories and sums.
struct alignas(64) PairLanes {
  double fx[kBatch], fy[kBatch], torque_i[kBatch], torque_j[kBatch], spring[kBatch];
  double *sum_i[kBatch], *sum_j[kBatch], *kept[kBatch];
  unsigned char* pair[kBatch];
};

/// capped of a number (contact.h).
template <int W>
[[gnu::always_inline]] inline Lanes<W> within(const Lanes<W>& value, const Lanes<W>& limit) {
  const Lanes<W> above = value < -limit ? -limit : value;
  return limit < above ? limit : above;
}

/// Lanes beyond the batch do later pairs' work, for nobody.
template <int W>
[[gnu::always_inline]] inline void add_forces(const RoundNumbers& law, const DiskRows& rows,
                                              const RowBatch& batch, int at, PairLanes& to) {
  using V = Lanes<W>;
  const V none{};
  const double *body_i[W], *body_j[W];
  V spring{};
  for (int k = 0; k < W; ++k) {
    const std::ptrdiff_t at_pair = batch.pair[at + k];
    unsigned char* const pair = rows.pairs + at_pair * kDiskPair;
    const int j = batch.second[at + k], later = batch.second[at + k + kPairsAhead];
    double force = 0;
    __builtin_memcpy(&force, pair, sizeof force);
    const std::ptrdiff_t i = batch.first[at + k];
    spring[k] = force;
    to.pair[at + k] = pair;
    body_i[k] = rows.bodies + i * kDiskBody;
    to.sum_i[at + k] = rows.sums + i * kDiskSum;
    to.kept[at + k] = rows.kept != nullptr ? rows.kept + at_pair * kDiskForce : nullptr;
    body_j[k] = rows.bodies + std::ptrdiff_t{j} * kDiskBody;
    to.sum_j[at + k] = rows.sums + std::ptrdiff_t{j} * kDiskSum;
    __builtin_prefetch(rows.bodies + std::ptrdiff_t{later} * kDiskBody);
    __builtin_prefetch(rows.sums + std::ptrdiff_t{later} * kDiskSum, 1);
  }
  // Position and velocity; spin, radius, inverse mass and inertia.
  const Four<W> a = four_of<W>(body_i, 0), b = four_of<W>(body_j, 0);
  const Four<W> inert_a = four_of<W>(body_i, 4), inert_b = four_of<W>(body_j, 4);

  // overlap_of_disks.
  const V dx = b.a - a.a, dy = b.b - a.b, ri = inert_a.b, rj = inert_b.b;
  const V squared = dx * dx + dy * dy, reach = ri + rj;
  const auto apart = squared >= reach * reach;
  const V distance = root_of<W>(squared), inverse = 1 / distance, depth = reach - distance;
  const V sag_i = depth * (2 * rj - depth) * (0.5 * inverse), sag_j = depth - sag_i;
  V nx = dx * inverse, ny = dy * inverse, arm_i = ri - sag_i, arm_j = rj - sag_j;
  const auto beside = distance > magnitude(ri - rj) + 1e-12 * reach;
  const auto swallowed = ~(beside | apart);
  if (any_of(swallowed)) [[unlikely]] {
    const V inner = ri < rj ? none : distance;
    nx = swallowed & (distance == 0) ? none + 1 : nx;
    ny = swallowed & (distance == 0) ? none : ny;
    arm_i = swallowed ? inner : arm_i;
    arm_j = swallowed ? distance - inner : arm_j;
  }

  // motion_at.
  const V vx = a.c - b.c, vy = a.d - b.d;
  const V approach = vx * nx + vy * ny;
  const V slip = vy * nx - vx * ny + inert_a.a * arm_i + inert_b.a * arm_j;

  // LinearLaw and friction_force.
  const V mass = 1 / (inert_a.c + inert_b.c);
  const V pushed = law.normal * depth + mass * law.across * approach;
  const V normal = pushed < 0 ? none : pushed;
  const V limit = law.friction * normal, along = -(mass * law.along) * slip;
  const V trial = spring - law.tangential * slip * law.dt, sum = trial + along;
  const V tangential = within<W>(sum, limit);
  const V rest = within<W>(tangential == sum ? trial : tangential - along, limit);

  // forces_at; 0 of those that do not touch.
  const V fx = -normal * nx - tangential * ny, fy = -normal * ny + tangential * nx;
  store<W>(apart ? none : fx, to.fx + at);
  store<W>(apart ? none : fy, to.fy + at);
  store<W>(apart ? none : arm_i * tangential, to.torque_i + at);
  store<W>(apart ? none : arm_j * tangential, to.torque_j + at);
  store<W>(apart ? none : rest, to.spring + at);
}

/// To the memories, and to the sums or what is kept of pairs.
template <int W>
[[gnu::always_inline]] inline void scatter(const RowBatch& batch, int at, bool keeps,
                                           const PairLanes& c) {
  const int left = batch.count - at;
  const Lanes<W> fx = loaded<W>(c.fx + at), fy = loaded<W>(c.fy + at), none{};
  // A grain is the second of its pairs in earlier rows, then the first of those in its own: so all
  // second ones before the first ones keep the order of every sum.
  const auto add = [&](const Four<W>& columns, double* const* sums) {
    each_row<W>(columns, [&](int k, const Lanes<4>& row) {
      if (k < left) store<4>(loaded<4>(sums[k]) + row, sums[k]);
    });
  };
  const Lanes<W> torque_i = loaded<W>(c.torque_i + at), torque_j = loaded<W>(c.torque_j + at);
  if (keeps) {
    add({fx, fy, torque_i, torque_j}, c.kept + at);
  } else {
    add({-fx, -fy, torque_j, none}, c.sum_j + at);
    add({fx, fy, torque_i, none}, c.sum_i + at);
  }
  for (int k = 0; k < W && k < left; ++k) {
    __builtin_memcpy(c.pair[at + k], &c.spring[at + k], sizeof(double));
  }
}

}  // namespace

template <int W>
void disk_forces_of(const RoundNumbers& law, const DiskRows& rows, const RowBatch& batch) {
  static_assert(kPairsBehind >= kPairsAhead + W);
  PairLanes lanes;
  for (int at = 0; at < batch.count; at += W) add_forces<W>(law, rows, batch, at, lanes);
  for (int at = 0; at < batch.count; at += W) scatter<W>(batch, at, rows.kept != nullptr, lanes);
}
template void disk_forces_of<GRAINFIELD_LANES>(const RoundNumbers& law, const DiskRows& rows,
                                               const RowBatch& batch);

}  // namespace grainfield::dem
