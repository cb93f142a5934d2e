// Contact networks of spheres: the force of a contact is sphere_contact.h's.
#pragma once
#include <vector>

#include "dem/laws/rolling.h"
#include "dem/quasistatic/space_network.h"
#include "dem/quasistatic/sphere_contact.h"
#include "dem/quasistatic/sphere_law.h"

namespace grainfield::dem {

class SphereContacts {
 public:
  using Memory = SphereMemory;
  using Force = SphereForce<double>;

  /// Throws std::invalid_argument as SphereLaw.
  SphereContacts(const Snapshot& start, const Materials& materials);

  static Memory memory_of(const Contact& contact);
  bool force(const PlacedPair& pair, const Memory& memory, const PairMotion& motion,
             Force& out) const;
  bool slopes(const PlacedPair& pair, const Memory& memory, const PairMotion& motion,
              PairSlopes& out) const;
  double stiffness(const PlacedPair& pair, const Memory& memory) const;
  double stiffness(double radius) const;
  static Vec3 arm_of(const Memory& memory) { return memory.lever_i * memory.normal; }
  static void tell(const Memory& memory, Contact& contact);

 private:
  SphereBodies bodies(const PlacedPair& pair) const;

  SphereLaw law_;
  RollingLaw rolling_;
  std::vector<double> radii_;
};

using SphereNetwork = SpaceNetwork<SphereContacts>;

}  // namespace grainfield::dem
