// The forces of a packing as functions of displacements, and their derivatives.
//
// Unknowns z: for each free grain (u_x/r, u_y/r, theta), displacements since the last committed
// state, r the grain's radius. Residual: for each free grain (F_x, F_y, M/r) / scale, the resultant
// of contact forces, weight and applied force.
//
// A contact's normal force N is the law's without its dashpot. Its tangential force is the return
// mapping of the committed spring S0:
//   T = clamp(S0 - k_t s, -mu N, mu N)
// with s the slip since the committed state, of i against j, at the contact's middle tangent t
// (normal halfway between the committed and the present one) and middle levers:
//   s = (u_i - u_j) . t + theta_i lever_i + theta_j lever_j
// A rigid rotation of both grains by a leaves s = O(a^3): the spring turns with the contact. A
// contact that was open at the committed state begins with S0 = 0 and only the share of s since it
// closed, depth / approach.
//
// Tangent: the force is a smooth function of N, s and the geometry (n, levers, shifts), with one
// branch for stick and one for slip. The derivatives of those eight by the relative position and
// the two angles are central differences of the narrow phase (of disks: by the position only), the
// branch is exact. Rows with slip make the matrix unsymmetric.
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "dem/laws/materials.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// Copyable: a copy is a saved state.
class ContactNetwork {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::SparseMatrix<double>;

  /// Committed state: the start's positions and springs. `start` must have been checked.
  ContactNetwork(const Snapshot& start, const Materials& materials);

  int size() const { return 3 * free_; }  ///< unknowns
  int free_grains() const { return free_; }

  /// External force on every grain, N, from now on.
  void set_load(const Vec3& gravity, std::int64_t loaded_a, const Vec3& force_a,
                std::int64_t loaded_b, const Vec3& force_b);
  /// Force that makes the residual one, N (> 0).
  void set_scale(double newtons) { scale_ = newtons; }
  double scale() const { return scale_; }

  /// Residual at z. False when z is not finite or moves a grain further than kMostMove: there the
  /// increments no longer mean anything.
  bool residual(const Vector& z, Vector& r);
  /// Its derivative at z, less `drag` on the diagonal. The diagonal also loses the size of the
  /// residual r of each grain: that keeps loose grains in place and vanishes with the residual, so
  /// that Newton's convergence stays quadratic.
  void tangent(const Vector& z, const Vector& r, const Vector& drag, Matrix& matrix);
  /// A stiffness of the law times radius over scale, per unknown: unit of a drag on z.
  Vector drag_unit() const;

  /// z becomes the committed state: springs and contact geometry are kept, z starts again at 0.
  void commit(const Vector& z);

  struct Balance {
    double mean_contact_force = 0, mean_unbalanced_force = 0;
    double mean_unbalanced_moment = 0;  ///< over the radii, N
    int contacts = 0;
    double ratio = 0;         ///< inf without contacts
    double moment_ratio = 0;  ///< likewise
  };
  /// Of the committed state, from the same forces as the residual.
  Balance balance();

  /// The committed state as a snapshot: `like` with new positions, velocities 0 and contacts.
  Snapshot snapshot(const Snapshot& like);

  /// Largest displacement of z in radii or radians that the model is made for.
  static constexpr double kMostMove = 0.5;

 private:
  struct Pair {
    int i = 0, j = 0;  // j < 0: wall -1 - j
    bool touched = false;
    double friction = 0;
    double spring = 0;                                // committed, N
    double nx = 0, ny = 0, lever_i = 0, lever_j = 0;  // committed, where touched
  };
  // Where the two grains are against each other, and how they moved since the committed state.
  struct Place {
    double dx = 0, dy = 0;            // from i to j; wall: from i to the wall's point, m
    double angle_i = 0, angle_j = 0;  // rad
    double ux = 0, uy = 0;            // displacement of i against j, m
    double turn_i = 0, turn_j = 0;    // rad
  };
  struct Geometry {
    double normal = 0, slip = 0;
    double nx = 0, ny = 0, lever_i = 0, lever_j = 0, shift_i = 0, shift_j = 0;
  };
  struct Force {
    double normal = 0, tangential = 0;
    bool sticks = true;
    double fx = 0, fy = 0, torque_i = 0, torque_j = 0;
  };
  using Slopes = Eigen::Matrix<double, 4, 4>;

  bool overlap(const Pair& pair, const Place& place, Overlap& o) const;
  bool geometry(const Pair& pair, const Place& place, Geometry& g) const;
  Force force(const Pair& pair, const Geometry& g) const;
  bool slopes(const Pair& pair, const Place& place, Slopes& out) const;
  Place place(const Pair& pair, const Vector& z) const;
  double displacement(int grain, int axis, const Vector& z) const;
  void ensure_candidates(const Vector& z);
  void search(const Vector& z);

  struct Shape {
    double radius = 0, mass = 0;
    int unknown = -1;  // first of three, -1: fixed
    double equal_radius = 0;
    Outline outline;
  };

  AnyLaw law_;
  Measures measures_ = Measures::depth;
  double friction_;
  double stiffness_, tangential_stiffness_;
  double scale_ = 1;
  int free_ = 0;
  std::vector<Shape> shapes_;
  std::vector<Wall> walls_;
  std::vector<std::array<double, 3>> origin_;     // x, y, angle of the start
  std::vector<std::array<double, 3>> committed_;  // displacement of the committed state since then
  std::vector<std::array<double, 2>> load_;       // N
  std::vector<Pair> pairs_;                       // sorted by (i, j), walls of a grain first
  std::vector<std::array<double, 2>> searched_;   // displacements at the last search
  double skin_ = 0;
  std::vector<Eigen::Triplet<double>> triplets_;
};

}  // namespace grainfield::dem
