// Compiled for every width (lanes.h): no function of it may be another file's, too.
#include "dem/laws/disk_lanes.h"

#include <cstddef>

#include "dem/laws/linear.h"
#include "dem/laws/penalty.h"
#include "dem/space/kinematics.h"
#include "dem/space/lane_rows.h"
#include "dem/space/round_overlap.h"

namespace grainfield::dem {
namespace {

/// What is known of pairs by slot, before it goes to the memories and sums.
struct alignas(64) PairLanes {
  double fx[kBatch], fy[kBatch], torque_i[kBatch], torque_j[kBatch], spring[kBatch];
  double *sum_i[kBatch], *sum_j[kBatch], *kept[kBatch];
  unsigned char* pair[kBatch];
};

template <int W>
[[gnu::always_inline]] inline Body<2, Lanes<W>> disks_of(const Four<W>& first,
                                                         const Four<W>& second) {
  return {{first.a, first.b}, {first.c, first.d}, second.a, second.b, second.c, second.d};
}

/// Lanes beyond the batch do later pairs' work, for nobody.
template <int W, class Law>
[[gnu::always_inline]] inline void add_forces(const Law& law, double friction, double dt,
                                              const DiskRows& rows, const RowBatch& batch, int at,
                                              PairLanes& to) {
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
  // What is waited for first is read first.
  const Four<W> first_a = four_of<W>(body_i, 0), first_b = four_of<W>(body_j, 0);
  const Four<W> second_a = four_of<W>(body_i, 4), second_b = four_of<W>(body_j, 4);
  const Body<2, V> a = disks_of<W>(first_a, second_a), b = disks_of<W>(first_b, second_b);
  Overlap2Of<V> o;
  const auto apart = disks_meet(V(b.position.x() - a.position.x()),
                                V(b.position.y() - a.position.y()), a.radius, b.radius, o)
                         .apart;
  SpringMemory<2, V> memory{spring};
  const LawForce<2, V> f = law(o, motion_at<true>(a, b, o), none + friction, dt, memory);
  const ContactForce<2, V> on = forces_at<true>(o, f.normal, f.tangential);
  store<W>(apart ? none : on.force.x(), to.fx + at);
  store<W>(apart ? none : on.force.y(), to.fy + at);
  store<W>(apart ? none : on.torque_i, to.torque_i + at);
  store<W>(apart ? none : on.torque_j, to.torque_j + at);
  store<W>(apart ? none : memory.spring, to.spring + at);
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

template <int W, class Law>
void disk_forces_of(const Law& law, double friction, double dt, const DiskRows& rows,
                    const RowBatch& batch) {
  static_assert(kPairsBehind >= kPairsAhead + W);
  PairLanes lanes;
  for (int at = 0; at < batch.count; at += W) {
    add_forces<W>(law, friction, dt, rows, batch, at, lanes);
  }
  for (int at = 0; at < batch.count; at += W) scatter<W>(batch, at, rows.kept != nullptr, lanes);
}
template void disk_forces_of<GRAINFIELD_LANES>(const LinearLaw&, double, double, const DiskRows&,
                                               const RowBatch&);
template void disk_forces_of<GRAINFIELD_LANES>(const PenaltyLaw&, double, double, const DiskRows&,
                                               const RowBatch&);

}  // namespace grainfield::dem
