// Contact networks of superellipsoids: the engine's laws without dashpots, with their increments
// over a step of time taken over the whole way since the committed state, as of spheres
// (sphere_contact.h).
//
//   slip       s = (u_i - u_j + theta_i x a_i - theta_j x a_j)_t,  a: mean arms, t: across the mean
//              of the committed and the present normal
//   friction   T = cap(share S0' - K s', mu N),  K: stiffnesses along the axes of the ellipse
//   on i       F = -N n + T,  M = a_i x F
//   on j      -F,             M = -a_j x F
//
// S0 turns with the material, by the mean turn of both. With the place and the turns of the two
// the normal, the contact point and the curvatures change, and N and K with these. Slopes are
// central differences of all of it, with the branches of the middle: sticks or slides, shrinks or
// grows.
#pragma once
#include <vector>

#include "dem/quasistatic/space_network.h"
#include "dem/quasistatic/superellipsoid_law.h"
#include "dem/shapes/common_normal.h"

namespace grainfield::dem {

/// What a contact remembers of the committed state.
struct SuperellipsoidMemory {
  bool touched = false;
  Vec3 normal{0, 0, 0};                 ///< from i to j
  double depth = 0, size = 0;           ///< m; size: SuperellipsoidLaw::Spring's
  Vec3 arm_i{0, 0, 0}, arm_j{0, 0, 0};  ///< from the centres to the contact point, m
  Vec3 spring{0, 0, 0};                 ///< of friction, on i, N
  PairNormal known;                     ///< where the common normal is looked for
};

struct SuperellipsoidForce {
  double normal = 0;                          ///< N, repulsion, N
  Vec3 friction{0, 0, 0};                     ///< T, N
  Vec3 force{0, 0, 0};                        ///< on i, N
  Vec3 moment_i{0, 0, 0}, moment_j{0, 0, 0};  ///< N m
  SuperellipsoidMemory reached;               ///< for the next committed state
  bool slides = false, shrinks = false;
};

class SuperellipsoidContacts {
 public:
  using Memory = SuperellipsoidMemory;
  using Force = SuperellipsoidForce;

  /// Throws std::invalid_argument as SuperellipsoidLaw, and for resistance against rolling.
  SuperellipsoidContacts(const Snapshot& start, const Materials& materials);

  static Memory memory_of(const Contact& contact);
  bool force(const PlacedPair& pair, const Memory& memory, const PairMotion& motion,
             Force& out) const {
    return force(pair, memory, motion, nullptr, out);
  }
  bool slopes(const PlacedPair& pair, const Memory& memory, const PairMotion& motion,
              PairSlopes& out) const;
  double stiffness(const PlacedPair& pair, const Memory& memory) const;
  double stiffness(double radius) const;
  static Vec3 arm_of(const Memory& memory) { return memory.arm_i; }
  static void tell(const Memory& /*memory*/, Contact& /*contact*/) {}

 private:
  struct Shape {
    Superellipsoid body;
    double farthest = 0, nearest = 0;  // points of the surface from the centre, m
    double equal_radius = 0;           // of the sphere of equal volume, m
  };

  bool overlap(const PlacedPair& pair, const PairMotion& motion, PairNormal& known,
               Overlap3& o) const;
  bool overlap_plane(const PlacedPair& pair, const PairMotion& motion, Overlap3& o) const;
  /// `branches`: taken from there instead of from the values.
  bool force(const PlacedPair& pair, const Memory& memory, const PairMotion& motion,
             const Force* branches, Force& out) const;

  SuperellipsoidLaw law_;
  std::vector<Shape> shapes_;
};

using SuperellipsoidNetwork = SpaceNetwork<SuperellipsoidContacts>;

}  // namespace grainfield::dem
