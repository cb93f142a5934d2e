#include "coupling/averaging/cluster.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "dem/snapshot/displacements.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

// Two copies of a grain are the same one when they are nearer than this share of its radius: images
// are apart by a whole edge.
constexpr double kSame = 1e-3;

}  // namespace

Cluster::Cluster(const dem::Snapshot& first, const Eigen::Vector3d& centre, double radius)
    : first_(&first) {
  if (first.dim != 3) {
    throw std::invalid_argument("a cluster: found grains in the plane, allowed: in space");
  }
  std::array<int, 3> most{0, 0, 0};
  for (std::size_t a = 0; a < 3; ++a) most[a] = first.cell.periodic[a] ? 2 : 0;
  for (std::size_t g = 0; g < first.grains.size(); ++g) {
    if (first.grains[g].fixed) continue;
    for (int i = -most[0]; i <= most[0]; ++i) {
      for (int j = -most[1]; j <= most[1]; ++j) {
        for (int k = -most[2]; k <= most[2]; ++k) {
          const std::array<int, 3> image{i, j, k};
          const dem::Vec3 at = first.grains[g].position + dem::shift_to(first.cell, image);
          if ((at - centre).norm() < radius) members_.push_back({g, image});
        }
      }
    }
  }
}

Eigen::MatrixXd Cluster::places(const dem::Snapshot& state) const {
  const dem::Snapshot& first = *first_;
  const dem::Displacements displacements(first, state);
  Eigen::MatrixXd out(size(), 3);
  for (Eigen::Index m = 0; m < size(); ++m) {
    const Member& member = members_[static_cast<std::size_t>(m)];
    dem::Vec3 at = first.grains[member.grain].position + displacements.of(member.grain);
    if (first.cell.is_periodic()) {
      at += dem::shift_to(state.cell, displacements.image_after(member.image));
    }
    out.row(m) = at.transpose();
  }
  return out;
}

ContactsOfGrains::ContactsOfGrains(const dem::Snapshot& state)
    : state_(&state), touches_(state.grains.size()) {
  for (std::size_t c = 0; c < state.contacts.size(); ++c) {
    const dem::Contact& contact = state.contacts[c];
    touches_[static_cast<std::size_t>(contact.i)].push_back({c, 1});
    if (contact.j >= 0) touches_[static_cast<std::size_t>(contact.j)].push_back({c, -1});
  }
}

ClusterForces ContactsOfGrains::of(const Cluster& cluster, const Eigen::MatrixXd& places) const {
  std::multimap<std::size_t, Eigen::Index> copies;
  for (Eigen::Index m = 0; m < cluster.size(); ++m) copies.emplace(cluster.grain(m), m);
  const auto is_member = [&](std::size_t grain, const dem::Vec3& at) {
    const auto [begin, end] = copies.equal_range(grain);
    return std::any_of(begin, end, [&](const auto& copy) {
      return (places.row(copy.second).transpose() - at).norm() <
             kSame * state_->grains[grain].radius;
    });
  };
  // Forces that do not cancel count from the middle.
  const Eigen::RowVector3d middle = places.colwise().mean();
  ClusterForces out;
  for (Eigen::Index m = 0; m < cluster.size(); ++m) {
    const std::size_t g = cluster.grain(m);
    const dem::Vec3 centre = places.row(m).transpose();
    dem::Vec3 outer = dem::Vec3::Zero(), all = dem::Vec3::Zero();
    bool at_boundary = false;
    for (const Touch& touch : touches_[g]) {
      const dem::Contact& c = state_->contacts[touch.contact];
      const dem::Vec3 force = touch.sign * c.force;
      const dem::Vec3 first = state_->grains[static_cast<std::size_t>(c.i)].position;
      // From the member's centre to the contact and to the other centre, as the contact has them.
      dem::Vec3 arm = c.point - first, branch = dem::Vec3::Zero();
      bool inner = false;
      if (c.j >= 0) {
        branch = dem::second_place(*state_, c) - first;
        if (touch.sign < 0) {
          arm -= branch;
          branch = -branch;
        }
        inner = is_member(static_cast<std::size_t>(touch.sign > 0 ? c.j : c.i), centre + branch);
      }
      all += force;
      out.grains += force * arm.transpose();
      if (inner) {
        if (touch.sign > 0) out.inside += force * branch.transpose();
      } else {
        outer += force;
        at_boundary = true;
      }
    }
    const Eigen::RowVector3d place = places.row(m) - middle;
    out.boundary += outer * place;
    out.unbalanced += all * place;
    if (at_boundary) ++out.boundary_grains;
  }
  return out;
}

}  // namespace grainfield::coupling
