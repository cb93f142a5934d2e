#include "coupling/studies/pair/pair_records.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "dem/laws/contact.h"

namespace grainfield::dem {
namespace {

constexpr std::size_t kSnapshots = 10;  // of a run, beside the deepest

void fill(Grain& g, const PairState& state, int dim) {
  g.position = state.position;
  g.velocity = state.velocity;
  g.angle = state.angle;
  g.spin = state.spin.z();
  if (dim == 2) return;
  g.angular_velocity = state.spin;
  g.orientation = state.orientation;
}

Snapshot snapshot_of(const PairRecord& r, Snapshot out, double friction) {
  out.time = r.time;
  out.contacts.clear();
  fill(out.grains[0], r.first, out.dim);
  const bool wall = out.grains.size() == 1;
  if (!wall) fill(out.grains[1], r.second, out.dim);
  if (wall) out.walls.front().force = -r.forces.force;
  const PairForces& f = r.forces;
  if (f.force.isZero(0)) return out;
  Contact c;
  c.i = 0;
  c.j = wall ? -1 : 1;
  c.point = f.point;
  c.normal = f.normal;
  c.force = f.force;
  c.normal_force = f.normal_force;
  c.tangential_force = f.tangential_force;
  c.friction = friction;
  c.sliding = friction > 0 &&
              std::fabs(f.tangential_force) >= friction * f.normal_force * (1 - kSlidingMargin);
  c.spring = std::numeric_limits<double>::quiet_NaN();  // not told
  c.spring_vector.setConstant(c.spring);
  out.contacts.push_back(c);
  return out;
}

// The angle of a body that turns about z alone.
double turning_about_z(const std::array<double, 4>& q) { return 2 * std::atan2(q[3], q[0]); }

double column(const PairRecord& r, std::size_t k, bool in_space) {
  const auto turning = [&](const Vec3& torque) { return in_space ? torque.norm() : torque.z(); };
  const PairForces& f = r.forces;
  const double values[] = {r.time,
                           f.depth,
                           f.area,
                           f.normal_force,
                           f.tangential_force,
                           turning(f.torque_first),
                           turning(f.torque_second),
                           r.kinetic,
                           r.stored,
                           r.dissipated,
                           r.first.position.x(),
                           r.first.position.y(),
                           in_space ? turning_about_z(r.first.orientation) : r.first.angle};
  static_assert(std::size(values) == std::size(kPairColumns));
  return values[k];
}

}  // namespace

void PairRecords::add(const PairRecord& record, int wanted) {
  // The last record stands beside the n-th ones until the next comes.
  if (seen > 0 && (seen - 1) % every != 0) kept.pop_back();
  kept.push_back(record);
  ++seen;
  if (kept.size() <= 2 * static_cast<std::size_t>(wanted)) return;
  for (std::size_t k = 0; 2 * k < kept.size(); ++k) kept[k] = kept[2 * k];
  kept.resize((kept.size() + 1) / 2);
  every *= 2;
}

std::vector<std::pair<std::string, Snapshot>> snapshots_of(const PairRecords& records,
                                                           const PairBodies& bodies) {
  const std::vector<PairRecord>& all = records.kept;
  const Snapshot like = bodies.engine(all.front().first)->snapshot();
  std::set<std::size_t> chosen;
  for (std::size_t k = 0; k < kSnapshots; ++k)
    chosen.insert(k * (all.size() - 1) / (kSnapshots - 1));
  const auto deepest = std::max_element(
      all.begin(), all.end(),
      [](const PairRecord& a, const PairRecord& b) { return a.forces.depth < b.forces.depth; });
  chosen.insert(static_cast<std::size_t>(deepest - all.begin()));
  std::vector<std::pair<std::string, Snapshot>> out;
  for (const std::size_t k : chosen) {
    out.emplace_back(fmt::format("state_{:02}", out.size()),
                     snapshot_of(all[k], like, bodies.settings.friction));
  }
  NumberTable& table = out.front().second.tables["pair"];
  for (std::size_t c = 0; c < std::size(kPairColumns); ++c) {
    table.push_back({kPairColumns[c].name, kPairColumns[c].unit, {}});
    for (const PairRecord& r : all) table.back().values.push_back(column(r, c, like.dim == 3));
  }
  return out;
}

}  // namespace grainfield::dem
