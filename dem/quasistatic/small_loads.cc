#include "dem/quasistatic/small_loads.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "dem/quasistatic/equilibrium.h"
#include "dem/quasistatic/quasistatic_checks.h"
#include "dem/snapshot/wall_forces.h"

namespace grainfield::dem {
namespace {

// Rest that is good enough to be the middle of a small change.
constexpr double kRest = 1e-4;
// Share of the load that may be left: it is sought to, and it must be reached.
constexpr double kSought = 1e-11, kReached = 1e-7;
constexpr int kMostSolves = 200;

std::pair<std::vector<Vec3>, std::vector<Vec3>> motion_of(const Snapshot& start,
                                                          const Eigen::VectorXd& z) {
  std::pair<std::vector<Vec3>, std::vector<Vec3>> out;
  const int per = start.dim == 2 ? 3 : 6;
  int at = 0;
  for (const Grain& g : start.grains) {
    Vec3 moved(0, 0, 0), turned(0, 0, 0);
    if (!g.fixed) {
      if (start.dim == 2) {
        moved = Vec3(g.radius * z[at], g.radius * z[at + 1], 0);
        turned.z() = z[at + 2];
      } else {
        moved = g.radius * z.segment<3>(at);
        turned = z.segment<3>(at + 3);
      }
      at += per;
    }
    out.first.push_back(moved);
    out.second.push_back(turned);
  }
  return out;
}

}  // namespace

SmallLoads::SmallLoads(const Snapshot& start, const Materials& materials) : start_(start) {
  check_start(start);
  network_ = make_contact_network(start, materials);
  network_->set_load(start.gravity);
  network_->set_scale(1);
  const ContactNetwork::Balance b = network_->balance();
  if (!(std::max(b.ratio, b.moment_ratio) <= kRest)) {
    throw ComputationFailed(fmt::format(
        "small loads: the packing is not at rest: unbalanced force ratio {:.2g}, moments {:.2g}, "
        "allowed: up to {:g}",
        b.ratio, b.moment_ratio, kRest));
  }
  network_->set_scale(b.mean_contact_force);
  const Vector none = Vector::Zero(network_->size());
  network_->tangent(none, none, none, factorized_);
  network_->tangent(none, none, -ContactNetwork::kFloor * network_->drag_unit(), tangent_);
  solver_ = solver_of(*network_);
  if (!solver_->prepare(factorized_)) {
    throw ComputationFailed("small loads: the tangent stiffness of the packing is singular");
  }
  // Contacts as the network sees them, those of two fixed grains left as they were.
  start_ = network_->snapshot(start);
}

SmallLoads::Vector SmallLoads::solve(const Vector& rhs, SmallResponse& out) {
  const double load = rhs.cwiseAbs().maxCoeff();
  Vector z = Vector::Zero(rhs.size()), left = rhs, step;
  out.left = 1;
  while (out.solves < kMostSolves && out.left > kSought) {
    solve_anywhere(*solver_, -left, step);
    ++out.solves;
    if (!step.allFinite()) break;
    const Vector next = rhs + tangent_ * (z + step);
    const double size = next.cwiseAbs().maxCoeff() / load;
    // Rounding is all that is left.
    if (out.left < kReached && size > 0.9 * out.left) break;
    z += step;
    left = next;
    out.left = size;
  }
  return z;
}

SmallResponse SmallLoads::response(const std::vector<std::int64_t>& ids, const Vec3& force) {
  if (ids.empty() || !force.allFinite() || force.isZero(0))
    throw std::invalid_argument(
        "small loads: found no load, allowed: a force on one grain or more");
  Vector rhs = Vector::Zero(network_->size());
  std::map<std::int64_t, int> unknown;  // first, by id
  int at = 0;
  for (const Grain& g : start_.grains) {
    if (g.fixed) continue;
    unknown[g.id] = at;
    at += network_->per_grain();
  }
  for (const std::int64_t id : ids) {
    const auto found = unknown.find(id);
    if (found == unknown.end()) {
      throw std::invalid_argument(fmt::format(
          "small loads: found a force on grain {}, allowed: the id of a free grain", id));
    }
    for (int a = 0; a < network_->per_force(); ++a)
      rhs[found->second + a] += force[a] / network_->scale();
  }
  SmallResponse out;
  const Vector z = solve(rhs, out);
  if (!(out.left <= kReached)) {
    throw ComputationFailed(fmt::format(
        "small loads: nothing carries a force on grain {}: after {} solutions {:.2g} of "
        "it is out of balance; choose a grain with contacts below",
        ids.front(), out.solves, out.left));
  }
  std::tie(out.moved, out.turned) = motion_of(start_, z);
  out.change = start_;
  out.change.gravity.setZero();
  out.change.loaded_grain = ids.front();
  out.change.also_loaded.assign(ids.begin() + 1, ids.end());
  std::sort(out.change.also_loaded.begin(), out.change.also_loaded.end());
  out.change.applied_force = force;
  const std::vector<ContactNetwork::ForceChange> changes = network_->force_changes(z);
  auto next = changes.begin();
  const auto order = [](const auto& c) { return std::tie(c.i, c.j, c.image); };
  for (Contact& c : out.change.contacts) {
    while (next != changes.end() && order(*next) < order(c)) ++next;
    const bool known = next != changes.end() && order(*next) == order(c);
    c.force = known ? next->force : Vec3(0, 0, 0);
    c.normal_force = -c.force.dot(c.normal);
    const Vec3 along = c.force + c.normal_force * c.normal;
    c.tangential_force =
        start_.dim == 2 ? along.dot(Vec3(-c.normal.y(), c.normal.x(), 0)) : along.norm();
    c.spring = c.tangential_force;
    c.spring_vector = start_.dim == 2 ? Vec3(0, 0, 0) : along;
    c.rolling_spring.setZero();
    c.twisting_spring = 0;
  }
  set_wall_forces(out.change);
  return out;
}

}  // namespace grainfield::dem
