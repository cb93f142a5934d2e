// What equilibrium needs of a contact law of spheres: forces at rest, and how they grow with depth.
#pragma once
#include "dem/laws/registry.h"

namespace grainfield::dem {

class SphereLaw {
 public:
  /// A value and its derivative by the depth.
  struct Slope {
    double value = 0, slope = 0;
    Slope scaled(double by) const { return {value, by * slope}; }
  };

  /// Throws std::invalid_argument for a law without a spring whose stiffness it tells.
  explicit SphereLaw(const AnyLaw& law);

  /// N, at a depth and a relative radius of curvature, m.
  Slope repulsion(double depth, double radius) const;
  /// Stiffness of the spring of friction, N/m.
  Slope spring(double depth, double radius) const;
  /// Share of its spring that a contact keeps when its depth changes alone.
  Slope kept(double before, double depth, double radius) const;
  /// The depth whose stiffness a slip from one depth to another meets.
  double depth_of_stiffness(double before, double depth) const;

 private:
  enum class Memory { constant, force, displacement };

  AnyLaw law_;
  Memory memory_ = Memory::constant;
};

}  // namespace grainfield::dem
