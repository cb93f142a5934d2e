// Clusters of grains as averaging volumes (Wellmann section 5): who belongs to one, where its
// grains are in later states, and its stress from the forces on its boundary and from those inside.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// The grains whose centres are nearer to a point than a radius, in a first state; in a periodic
/// cell images too. 3D.
class Cluster {
 public:
  /// `first` must outlive it.
  Cluster(const dem::Snapshot& first, const Eigen::Vector3d& centre, double radius);

  Eigen::Index size() const { return static_cast<Eigen::Index>(members_.size()); }
  /// Index of a member's grain.
  std::size_t grain(Eigen::Index member) const {
    return members_[static_cast<std::size_t>(member)].grain;
  }
  /// Centres in a later state of the same grains (or in the first), m: a row for each member. In a
  /// cell that flows the copies that were within the radius move with their images.
  Eigen::MatrixXd places(const dem::Snapshot& state) const;

 private:
  struct Member {
    std::size_t grain = 0;
    std::array<int, 3> image{0, 0, 0};
  };
  const dem::Snapshot* first_;
  std::vector<Member> members_;
};

/// Sums over the contacts of a cluster, N m, force (outer) place; over a volume they are stresses,
/// tension positive. Between two members: an inner contact; with another grain or a wall: an outer
/// one.
struct ClusterForces {
  /// Sum over members: resultant of the outer contacts (outer) centre (Wellmann eq. 29).
  Eigen::Matrix3d boundary = Eigen::Matrix3d::Zero();
  /// Sum over inner contacts: force (outer) branch.
  Eigen::Matrix3d inside = Eigen::Matrix3d::Zero();
  /// What the members' forces leave: resultant of all contacts (outer) centre. Always
  /// boundary = inside + unbalanced; at rest without gravity it is 0.
  Eigen::Matrix3d unbalanced = Eigen::Matrix3d::Zero();
  /// Sum over contacts of members: force (outer) way from the centre to the contact, which
  /// belongs to the members' own volumes.
  Eigen::Matrix3d grains = Eigen::Matrix3d::Zero();
  int boundary_grains = 0;  ///< members with an outer contact
};

/// The contacts of a state, by grain.
class ContactsOfGrains {
 public:
  /// `state` must outlive it.
  explicit ContactsOfGrains(const dem::Snapshot& state);
  /// `places`: of the cluster in this state.
  ClusterForces of(const Cluster& cluster, const Eigen::MatrixXd& places) const;

 private:
  struct Touch {
    std::size_t contact = 0;
    double sign = 1;  ///< of the contact's force on this grain
  };
  const dem::Snapshot* state_;
  std::vector<std::vector<Touch>> touches_;
};

}  // namespace grainfield::coupling
