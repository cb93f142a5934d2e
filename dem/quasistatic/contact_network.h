// The forces of a packing as functions of displacements, and their derivatives: what equilibrium is
// sought with. plane_network.h has disks and polygons, space_network.h what there is in space.
//
// Unknowns z: for each free grain displacement over its radius r, and rotation, since the last
// committed state: (u_x/r, u_y/r, theta) in the plane, (u/r, theta) with three each in space.
// Residual: for each free grain (F, M/r) / scale, the resultant of contact forces, weight and
// applied force.
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "dem/laws/materials.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

class ContactNetwork {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::SparseMatrix<double>;

  virtual ~ContactNetwork() = default;

  int size() const { return per_grain() * free_; }  ///< unknowns
  int free_grains() const { return free_; }
  /// Components of a grain's force and, after them, of its moment.
  int per_force() const { return dim_; }
  int per_grain() const { return dim_ == 2 ? 3 : 6; }

  /// A force, N, on each of some grains (by index).
  struct Load {
    std::vector<std::int64_t> grains;
    Vec3 force{0, 0, 0};
  };
  /// External force on every grain from now on.
  virtual void set_load(const Vec3& gravity, const std::vector<Load>& loads) = 0;
  void set_load(const Vec3& gravity) { set_load(gravity, {}); }
  /// Force that makes the residual one, N (> 0).
  void set_scale(double newtons) { scale_ = newtons; }
  double scale() const { return scale_; }

  /// Residual at z. False when z is not finite or moves a grain further than kMostMove: there the
  /// increments no longer mean anything.
  virtual bool residual(const Vector& z, Vector& r) = 0;
  /// Its derivative at z, less `drag` on the diagonal. The diagonal also loses the size of the
  /// residual r of each grain: that keeps loose grains in place and vanishes with the residual, so
  /// that Newton's convergence stays quadratic.
  virtual void tangent(const Vector& z, const Vector& r, const Vector& drag, Matrix& matrix) = 0;
  /// Share of that stiffness, which holds grains that roll or slide freely: on the diagonal of the
  /// derivative, not in the residual. Well below the softest mode of a packing of 1e4 grains, 1e-4.
  static constexpr double kFloor = 1e-6;
  /// A stiffness of the law times radius over scale, per unknown: unit of a drag on z.
  virtual Vector drag_unit() const = 0;

  /// z becomes the committed state: springs and contact geometry are kept, z starts again at 0.
  virtual void commit(const Vector& z) = 0;
  /// Keeps the committed state, and goes back to the one that was kept last.
  virtual void keep() = 0;
  virtual void take_back() = 0;

  /// From the committed state to the next one everything moves by gradient * x before z is added:
  /// free and fixed grains and the edges of the cell, which contacts between grains feel. Planes
  /// stay.
  void strain(const Eigen::Matrix3d& gradient) { gradient_ = gradient; }
  /// Whether a strain waits for its commit.
  bool strains() const { return !gradient_.isZero(0); }

  /// A copy, with load, scale, committed state and the strain that waits, in which only the free
  /// grains with these numbers, ascending, are free. Throws std::logic_error in the plane.
  virtual std::unique_ptr<ContactNetwork> part(const std::vector<int>& free) const;
  /// The committed state of such a part becomes the one of this network, which must not have
  /// changed since.
  virtual void adopt(const ContactNetwork& part);

  struct Balance {
    double mean_contact_force = 0, mean_unbalanced_force = 0;
    double mean_unbalanced_moment = 0;  ///< over the radii, N
    int contacts = 0;
    double ratio = 0;         ///< inf without contacts
    double moment_ratio = 0;  ///< likewise
  };
  /// Balance of the committed state, from the same forces as the residual.
  Balance balance();
  /// Mean size of the resultants in a residual, and of the moments over the radii.
  double mean_resultant(const Vector& r) const;
  double mean_moment(const Vector& r) const;

  /// A contact of the committed state, and what a small motion changes its force by.
  struct ForceChange {
    std::int64_t i = 0, j = 0;  ///< as Contact
    std::array<int, 3> image{0, 0, 0};
    Vec3 force{0, 0, 0};  ///< on i, N
  };
  /// The derivative of the contacts' forces at the committed state times z, ascending (i, j,
  /// image).
  virtual std::vector<ForceChange> force_changes(const Vector& z) const = 0;

  /// The committed state as a snapshot: `like` with new positions, velocities 0 and contacts.
  virtual Snapshot snapshot(const Snapshot& like) = 0;

  /// Largest displacement of z in radii or radians that the model is made for.
  static constexpr double kMostMove = 0.5;

 protected:
  explicit ContactNetwork(int dim) : dim_(dim) {}
  ContactNetwork(const ContactNetwork&) = default;
  ContactNetwork& operator=(const ContactNetwork&) = default;

  /// Sum of the contacts' forces, N, and their number, in the committed state.
  virtual void add_contact_forces(double& sum, int& contacts) const = 0;

  static bool within_reach(const Vector& z) {
    return z.size() == 0 || z.cwiseAbs().maxCoeff() <= kMostMove;  // false for nan
  }

  int dim_ = 2;
  int free_ = 0;
  double scale_ = 1;
  /// The strain of the next commit, for grains, those that are fixed too, and the cell.
  Eigen::Matrix3d gradient_ = Eigen::Matrix3d::Zero();
};

/// Committed state: the start's positions and springs. `start` must have been checked. Throws
/// std::invalid_argument for a law that equilibrium is not sought with.
std::unique_ptr<ContactNetwork> make_contact_network(const Snapshot& start,
                                                     const Materials& materials);

}  // namespace grainfield::dem
