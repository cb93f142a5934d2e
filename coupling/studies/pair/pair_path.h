// Where the first body of a pair is led.
#pragma once
#include <vector>

#include "coupling/studies/pair/pair_bodies.h"

namespace grainfield::dem {

class PairPath {
 public:
  /// The path of the setup, from where the bodies touch.
  PairPath(const PairSetup& setup, const PairBodies& bodies);
  /// A closed loop drawn of `random`, lengths in units of the mean of both radii (at a wall: of the
  /// radius), near the second body; `crossing`: centre over centre.
  PairPath(const PairSetup& setup, Random& random, bool crossing);

  /// At the share t of the path, in [0, 1].
  PairPose at(double t) const;
  /// Length, with angles times the radius, m.
  double length(int steps) const;
  /// It ends where it begins.
  bool closed() const;

 private:
  enum class Kind { approach, slide, roll, ellipse, waypoints };
  Kind kind_ = Kind::ellipse;
  PairPose start_;
  double radius_ = 0, depth_ = 0, along_ = 0, across_ = 0, swing_ = 0, phase_ = 0;
  double arm_ = 0;  // of the first body at the contact: roll
  int turns_ = 1, rounds_ = 0;
  bool at_wall_ = false;
  bool on_arc_ = false;  // slide: of round bodies, so that the depth stays
  std::vector<PairPose> waypoints_;
};

}  // namespace grainfield::dem
