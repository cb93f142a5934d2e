// Contact networks in space, between planes and in cells that repeat and do not flow: whatever the
// grains are. What acts between two of them, and what they remember, is Contacts' matter:
// sphere_network.h, superellipsoid_network.h.
#pragma once
#include <Eigen/Core>
#include <array>
#include <concepts>
#include <memory>
#include <utility>
#include <vector>

#include "dem/quasistatic/contact_network.h"
#include "dem/space/space3.h"

namespace grainfield::dem {

/// Two grains, or one and a plane, in the committed state.
struct PlacedPair {
  int i = 0, j = 0;      ///< j < 0: a plane
  Vec3 across{0, 0, 0};  ///< from i to j or the plane's point, m
  Vec3 plane{0, 0, 0};   ///< its normal, towards the grains
  double friction = 0;
  RotationOf<3> turned_i = RotationOf<3>::Identity(), turned_j = turned_i;

  bool is_plane() const { return j < 0; }
};

/// Motion of the pair since then.
struct PairMotion {
  Vec3 shift{0, 0, 0};                    ///< u_i - u_j, m
  Vec3 turn_i{0, 0, 0}, turn_j{0, 0, 0};  ///< rotation vectors, rad
};

/// Derivatives of force on i, moment on i and moment on j by shift, turn_i and turn_j.
using PairSlopes = Eigen::Matrix<double, 9, 9>;
/// The derivatives of both grains' residuals by their unknowns, in their places in the matrix.
struct PairBlock {
  int i = 0, j = 0;  ///< free grains by number, j < 0: none
  Eigen::Matrix<double, 12, 12> slopes;
};

/// Made of the start and the materials. Of a pair: its Memory, begun by a contact of the start; its
/// Force with the Memory that the next committed state begins with, also where they do not touch
/// (false); the derivatives of that; a stiffness.
template <class C>
concept SpaceContacts = std::constructible_from<C, const Snapshot&, const Materials&> &&
    requires(const C& contacts, const PlacedPair& pair, const PairMotion& motion,
             const typename C::Memory& memory, typename C::Force& force, PairSlopes& slopes,
             const Contact& old, Contact& told, double radius) {
  { memory.touched } -> std::convertible_to<bool>;
  { memory.normal } -> std::convertible_to<Vec3>;   // from i to j
  { force.normal } -> std::convertible_to<double>;  // repulsion, N
  { force.friction } -> std::convertible_to<Vec3>;  // on i, N
  { force.force } -> std::convertible_to<Vec3>;     // on i, N
  { force.moment_i } -> std::convertible_to<Vec3>;  // N m
  { force.moment_j } -> std::convertible_to<Vec3>;
  { force.reached } -> std::convertible_to<typename C::Memory>;
  { contacts.memory_of(old) } -> std::same_as<typename C::Memory>;
  { contacts.force(pair, memory, motion, force) } -> std::same_as<bool>;
  { contacts.slopes(pair, memory, motion, slopes) } -> std::same_as<bool>;
  { contacts.stiffness(pair, memory) } -> std::same_as<double>;  // of one that touches, N/m
  { contacts.stiffness(radius) } -> std::same_as<double>;        // of spheres that hardly do
  { contacts.arm_of(memory) } -> std::convertible_to<Vec3>;      // from i to the contact point, m
  contacts.tell(memory, told);                                   // what else a snapshot has of it
};

template <SpaceContacts Contacts>
class SpaceNetwork final : public ContactNetwork {
 public:
  SpaceNetwork(const Snapshot& start, const Materials& materials);

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
    typename Contacts::Memory memory;
  };
  using Force = typename Contacts::Force;
  struct Body {
    double radius = 0, mass = 0;  // radius: to the farthest point of its surface
    int unknown = -1;             // first of six, -1: fixed
  };
  bool any_free(const Pair& pair) const;
  void add_contact_forces(double& sum, int& contacts) const override;
  Vec3 displacement(int grain, const Vector& z) const;
  Vec3 turn(int grain, const Vector& z) const;
  Vec3 across(const Pair& pair) const;
  PlacedPair placed(const Pair& pair) const;
  PairMotion motion(const Pair& pair, const Vector& z) const;
  bool force(const Pair& pair, const Vector& z, Force& out) const;
  bool slopes(const Pair& pair, const Vector& z, PairBlock& out) const;
  void ensure_candidates(const Vector& z);
  void search(const Vector& z);
  std::vector<Pair> near(const Vector& z) const;
  double mean_stiffness() const;

  Contacts contacts_;
  double friction_;
  double stiffness_ = 0;  // of a contact, N/m
  Cell<3> cell_;
  std::vector<Body> bodies_;
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
  std::vector<PairBlock> blocks_;
};

}  // namespace grainfield::dem
