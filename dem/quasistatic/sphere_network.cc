#include "dem/quasistatic/sphere_network.h"

namespace grainfield::dem {
namespace {

// Contacts that do not touch yet have the stiffness of this depth, as a share of the radius.
constexpr double kLightDepth = 1e-5;

}  // namespace

SphereContacts::SphereContacts(const Snapshot& start, const Materials& materials)
    : law_(materials.law), rolling_(materials.rolling) {
  for (const Grain& g : start.grains) radii_.push_back(g.radius);
}

/// Not touched: the springs are taken as they are at the present normal.
SphereMemory SphereContacts::memory_of(const Contact& c) {
  SphereMemory out;
  out.spring =
      c.spring_vector.allFinite() ? c.spring_vector : Vec3(c.force + c.normal_force * c.normal);
  out.roll = c.rolling_spring;
  out.twist = c.twisting_spring;
  return out;
}

SphereBodies SphereContacts::bodies(const PlacedPair& pair) const {
  return {radii_[pair.i], pair.is_plane() ? 0 : radii_[pair.j], pair.across, pair.plane,
          pair.friction};
}

bool SphereContacts::force(const PlacedPair& pair, const Memory& memory, const PairMotion& motion,
                           Force& out) const {
  return sphere_force<double>(law_, rolling_, bodies(pair), memory,
                              {motion.shift, motion.turn_i, motion.turn_j}, out);
}

bool SphereContacts::slopes(const PlacedPair& pair, const Memory& memory, const PairMotion& at,
                            PairSlopes& out) const {
  SphereMotion<Derived9> m;
  for (int a = 0; a < 3; ++a) {
    m.shift[a] = Derived9(at.shift[a], 9, a);
    m.turn_i[a] = Derived9(at.turn_i[a], 9, 3 + a);
    m.turn_j[a] = Derived9(at.turn_j[a], 9, 6 + a);
  }
  SphereForce<Derived9> f;
  if (!sphere_force(law_, rolling_, bodies(pair), memory, m, f)) return false;
  for (int a = 0; a < 3; ++a) {
    out.row(a) = f.force[a].derivatives();
    out.row(3 + a) = f.moment_i[a].derivatives();
    out.row(6 + a) = f.moment_j[a].derivatives();
  }
  return true;
}

double SphereContacts::stiffness(const PlacedPair& pair, const Memory& memory) const {
  const SphereBodies b = bodies(pair);
  const double radius =
      b.is_plane() ? b.radius_i : b.radius_i * b.radius_j / (b.radius_i + b.radius_j);
  return law_.repulsion(memory.depth, radius).slope;
}

double SphereContacts::stiffness(double radius) const {
  return law_.repulsion(kLightDepth * radius, 0.5 * radius).slope;
}

void SphereContacts::tell(const Memory& memory, Contact& contact) {
  contact.rolling_spring = memory.roll;
  contact.twisting_spring = memory.twist;
}

}  // namespace grainfield::dem
