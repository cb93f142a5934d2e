// A layer whose stresses obey sigma_xx = eta sigma_yy + mu sigma_xy under a line load (Bouchaud,
// Cates and Claudin 1995; Roul 4.4, 5): the load runs down along the two characteristics
// dx/dy = c1, c2 of the closure (osl.h) without spreading.
//
// Compression positive, y down, without weight: every function f gives an equilibrium
//   sigma_yy = f(x - c y),  sigma_xy = c f,  sigma_xx = c^2 f,  c = c1 or c2.
// A vertical load p(x) on the surface without shear splits into the shares
//   |c2| / (c1 - c2) along c1,  c1 / (c1 - c2) along c2.
// A line load is p = F delta(x). So that stresses are functions the load is spread over a stated
// width, p(x) = (F/w)(1 + cos(2 pi x / w)) for |x| < w/2.
//
// Base: the closure is marched down from the surface and needs nothing from the base: what arrives
// is taken up ("absorbing"). A base that bears no shear ("reflecting") must send a pulse f along c
// back as the pulse -(c/c') f along the other characteristic c', so that the shears cancel; the
// pressure on the base then adds up. A returned pulse that meets the surface leaves there; with
// more than one return it comes down again with the opposite sign, so that sigma_yy of the free
// surface is 0 (its shear cannot be made 0 as well: one condition per boundary is all a hyperbolic
// layer can meet).
#pragma once
#include <vector>

#include "continuum/closed/osl.h"

namespace grainfield::continuum {

/// One pulse, through the whole depth of the layer.
struct Pulse {
  double from = 0;   ///< abscissa of its middle on the surface, m
  double slope = 0;  ///< dx/dy, y down
  double share = 0;  ///< of F that it carries, as vertical force
};

class OslLayerField {
 public:
  /// `returns`: how often a pulse comes back from the base, 0 for an absorbing one. Needs eta > 0,
  /// depth and width above 0.
  OslLayerField(const Closure& closure, double load, double depth, double width, int returns);
  /// Stress xx, yy, xy (y up, tension positive) for -h <= y <= 0; nan outside.
  Eigen::Vector3d stress(double x, double y) const;
  /// Its derivatives, columns x, y.
  LinearStress gradient(double x, double y) const;
  const std::vector<Pulse>& pulses() const { return pulses_; }

 private:
  double load_, depth_, width_;
  std::vector<Pulse> pulses_;
};

}  // namespace grainfield::continuum
