// Contact laws of superellipsoids as equilibrium needs them: forces at rest by the overlap.
#pragma once
#include "dem/laws/registry.h"

namespace grainfield::dem {

class SuperellipsoidLaw {
 public:
  /// Friction: stiffnesses along the overlap's major and across it, N/m. A spring goes by `size`
  /// (m) where that shrinks, or always; size 0: by nothing.
  struct Spring {
    double major = 0, minor = 0;
    double size = 0;
  };

  /// Throws std::invalid_argument for a law that does not go with superellipsoids.
  explicit SuperellipsoidLaw(const AnyLaw& law);

  /// Whether it reads the curvatures of overlaps.
  bool curvatures() const { return curvatures_; }
  /// Whether springs go by their size always.
  bool follows_size() const { return follows_size_; }
  double repulsion(const Overlap3& o) const;  ///< N
  Spring spring(const Overlap3& o) const;

 private:
  AnyLaw law_;
  bool curvatures_ = false, follows_size_ = false;
};

}  // namespace grainfield::dem
