// Contact networks of spheres in space, between planes and in cells that repeat and do not flow.
// The force of a contact is sphere_contact.h's; of orientations only what a grain has turned since
// the committed state matters, as a rotation vector.
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "dem/quasistatic/contact_network.h"
#include "dem/quasistatic/sphere_contact.h"
#include "dem/space/space3.h"

namespace grainfield::dem {

class SphereNetwork final : public ContactNetwork {
 public:
  SphereNetwork(const Snapshot& start, const Materials& materials);

  using ContactNetwork::set_load;
  void set_load(const Vec3& gravity, const std::vector<Load>& loads) override;
  bool residual(const Vector& z, Vector& r) override;
  void tangent(const Vector& z, const Vector& r, const Vector& drag, Matrix& matrix) override;
  Vector drag_unit() const override;
  void commit(const Vector& z) override;
  void keep() override { kept_ = {pairs_, committed_, turned_, searched_, cell_}; }
  void take_back() override;
  std::vector<ForceChange> force_changes(const Vector& z) const override;
  Snapshot snapshot(const Snapshot& like) override;
  std::unique_ptr<ContactNetwork> part(const std::vector<int>& free) const override;
  void adopt(const ContactNetwork& part) override;

 private:
  struct Pair {
    int i = 0, j = 0;  // j < 0: plane -1 - j
    std::array<int, 3> image{0, 0, 0};
    double friction = 0;
    SphereMemory memory;
  };
  struct Sphere {
    double radius = 0, mass = 0;
    int unknown = -1;  // first of six, -1: fixed
  };
  // The 12 by 12 derivatives of a pair, in the places that its two grains have in the matrix.
  struct Block {
    int i = 0, j = 0;  // free grains by number, j < 0: none
    Eigen::Matrix<double, 12, 12> slopes;
  };

  bool any_free(const Pair& pair) const;
  void add_contact_forces(double& sum, int& contacts) const override;
  Vec3 displacement(int grain, const Vector& z) const;
  Vec3 turn(int grain, const Vector& z) const;
  SphereBodies bodies(const Pair& pair) const;
  SphereMotion<double> motion(const Pair& pair, const Vector& z) const;
  bool force(const Pair& pair, const Vector& z, SphereForce<double>& out) const;
  bool slopes(const Pair& pair, const Vector& z, Block& out) const;
  void ensure_candidates(const Vector& z);
  void search(const Vector& z);
  std::vector<Pair> near(const Vector& z) const;
  double mean_stiffness() const;

  SphereLaw law_;
  RollingLaw rolling_;
  double friction_;
  double stiffness_ = 0;  // of a contact, N/m
  Cell<3> cell_;
  std::vector<Sphere> spheres_;
  std::vector<Wall> walls_;
  std::vector<Vec3> origin_;           // of the start, m
  std::vector<RotationOf<3>> turned_;  // committed orientation
  std::vector<Vec3> committed_;        // displacement of the committed state since the start, m
  std::vector<Vec3> load_;             // N
  std::vector<Pair> pairs_;            // sorted by (i, j), planes of a grain first
  std::vector<Vec3> searched_;         // displacements at the last search
  struct Kept {
    std::vector<Pair> pairs;
    std::vector<Vec3> committed;
    std::vector<RotationOf<3>> turned;
    std::vector<Vec3> searched;
    Cell<3> cell;
  } kept_;
  double skin_ = 0;
  std::vector<Block> blocks_;
};

}  // namespace grainfield::dem
