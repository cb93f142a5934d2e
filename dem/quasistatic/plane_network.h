// Contact networks in the plane: disks and polygons.
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
#include <array>
#include <vector>

#include "dem/quasistatic/contact_network.h"

namespace grainfield::dem {

class PlaneNetwork final : public ContactNetwork {
 public:
  PlaneNetwork(const Snapshot& start, const Materials& materials);

  using ContactNetwork::set_load;
  void set_load(const Vec3& gravity, const std::vector<Load>& loads) override;
  bool residual(const Vector& z, Vector& r) override;
  void tangent(const Vector& z, const Vector& r, const Vector& drag, Matrix& matrix) override;
  Vector drag_unit() const override;
  void commit(const Vector& z) override;
  void keep() override { kept_ = {pairs_, committed_, searched_}; }
  void take_back() override;
  std::vector<ForceChange> force_changes(const Vector& z) const override;
  Snapshot snapshot(const Snapshot& like) override;

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

  void add_contact_forces(double& sum, int& contacts) const override;
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
  std::vector<Shape> shapes_;
  std::vector<Wall> walls_;
  std::vector<std::array<double, 3>> origin_;     // x, y, angle of the start
  std::vector<std::array<double, 3>> committed_;  // displacement of the committed state since then
  std::vector<std::array<double, 2>> load_;       // N
  std::vector<Pair> pairs_;                       // sorted by (i, j), walls of a grain first
  std::vector<std::array<double, 2>> searched_;   // displacements at the last search
  struct Kept {
    std::vector<Pair> pairs;
    std::vector<std::array<double, 3>> committed;
    std::vector<std::array<double, 2>> searched;
  } kept_;
  double skin_ = 0;
  std::vector<Eigen::Triplet<double>> triplets_;
};

}  // namespace grainfield::dem
