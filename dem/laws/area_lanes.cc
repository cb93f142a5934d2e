// Compiled for every width (lanes.h): no function of it may be another file's, too.
#include "dem/laws/area_lanes.h"

#include "dem/space/lane_rows.h"

namespace grainfield::dem {
namespace {

/// capped of a number (contact.h).
template <int W>
[[gnu::always_inline]] inline Lanes<W> within(const Lanes<W>& value, const Lanes<W>& limit) {
  const Lanes<W> above = value < -limit ? -limit : value;
  return limit < above ? limit : above;
}

template <int W>
[[gnu::always_inline]] inline void add_forces(const AreaNumbers& law, const PlaneOverlapBatch& o,
                                              int at, PlaneForceBatch& f) {
  using V = Lanes<W>;
  const double *body_i[W], *body_j[W];
  const int left = o.count - at;
  for (int k = 0; k < W; ++k) {
    body_i[k] = f.body_i[k < left ? at + k : at];
    body_j[k] = f.body_j[k < left ? at + k : at];
  }
  // Velocity, spin, radius; spin, radius, inverse mass and inertia.
  const Four<W> a = four_of<W>(body_i, 2), b = four_of<W>(body_j, 2);
  const Four<W> inert_a = four_of<W>(body_i, 4), inert_b = four_of<W>(body_j, 4);
  const auto of = [at](const double* values) { return loaded<W>(values + at); };
  const V nx = of(o.nx), ny = of(o.ny), length = of(o.length);
  const V arm_i = of(o.arm_i), arm_j = of(o.arm_j), lever_i = of(o.lever_i);
  const V lever_j = of(o.lever_j), shift_i = of(o.shift_i), shift_j = of(o.shift_j);
  const V none{};

  // motion_at.
  const V vx = a.a - b.a, vy = a.b - b.b;
  V approach = vx * nx + vy * ny;
  approach += b.c * shift_j - a.c * shift_i;
  const V slip = vy * nx - vx * ny + a.c * lever_i + b.c * lever_j;

  // AreaDashpots::forces.
  const V inverse_sum = inert_a.c + inert_b.c;
  const V viscous =
      law.damping * of(o.chord) * approach / length * root_of<W>(law.young / inverse_sum);
  const V pushed = law.young / length * of(o.area) + viscous;
  const V normal = pushed < 0 ? none : pushed;
  const V inverse_tangential = inverse_sum + arm_i * arm_i * inert_a.d + arm_j * arm_j * inert_b.d;
  const V viscosity = root_of<W>(law.tangential / inverse_tangential);

  // friction_force.
  const V limit = law.friction * normal, along = -viscosity * slip;
  const V trial = of(f.spring) - law.tangential * slip * law.dt, sum = trial + along;
  const V tangential = within<W>(sum, limit);
  store<W>(within<W>(tangential == sum ? trial : tangential - along, limit), f.spring + at);

  // forces_at.
  each_row<W>({-normal * nx - tangential * ny, -normal * ny + tangential * nx,
               lever_i * tangential + shift_i * normal, lever_j * tangential - shift_j * normal},
              [&](int k, const Lanes<4>& row) { store<4>(row, f.force[at + k]); });
}

}  // namespace

template <int W>
void area_forces_of(const AreaNumbers& law, const PlaneOverlapBatch& overlaps,
                    PlaneForceBatch& forces) {
  for (int at = 0; at < overlaps.count; at += W) add_forces<W>(law, overlaps, at, forces);
}
template void area_forces_of<GRAINFIELD_LANES>(const AreaNumbers& law,
                                               const PlaneOverlapBatch& overlaps,
                                               PlaneForceBatch& forces);

}  // namespace grainfield::dem
