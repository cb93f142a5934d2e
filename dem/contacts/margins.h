// How far grains may go until the next search, and when one is due.
#pragma once
#include <algorithm>

#include "dem/space/space.h"

namespace grainfield::dem {

// Skin of the neighbour list as a share of the mean radius, when none is given. A large one means
// few searches and many idle pairs: it grows when motion asks for a search within kOften steps of
// the last time, and shrinks when it has not for kSeldom steps. At rest 0.03 was the fastest of
// 0.01, 0.03 and 0.1 on the settled packings of tests/benchmarks. Step counts alone decide, so the
// bits stay.
inline constexpr double kFirstSkin = 0.1, kLeastSkin = 0.03, kMostSkin = 0.4;
inline constexpr long kOften = 60, kSeldom = 1000;
// A grain may move half the skin, and at its present speed for this many steps, before the next
// search; so a few falling grains do not make all others search.
inline constexpr double kStepsAhead = 100;
// ... but not further than this many radii.
inline constexpr double kMostAhead = 3;

class Skin {
 public:
  /// A search at this step; by_motion: because grains have left their margins, or have not for
  /// long.
  void adapt(bool by_motion, long step) {
    if (!by_motion) return;
    const long since = step - last_by_motion_;
    last_by_motion_ = step;
    if (since < kOften) {
      share_ = std::min(1.5 * share_, kMostSkin);
    } else if (since >= kSeldom) {
      share_ = std::max(0.5 * share_, kLeastSkin);
    }
  }
  /// `given`: m, or 0 for the share of the mean radius.
  void set(double given, double mean_radius) { skin_ = given > 0 ? given : share_ * mean_radius; }
  /// No search has been asked for so long that a smaller skin would do.
  bool is_too_large(long step) const {
    return step - last_by_motion_ >= kSeldom && share_ > kLeastSkin;
  }
  /// How far any point of a grain may go until the next search, m. `speed`: of its fastest point.
  double way(double speed, double radius, double time_step) const {
    return 0.5 * skin_ + std::min(kStepsAhead * time_step * speed, kMostAhead * radius);
  }

  template <class Self, class Each>
  static void visit(Self& self, Each each) {
    each(self.skin_);
    each(self.share_);
    each(self.last_by_motion_);
  }

 private:
  double skin_ = 0, share_ = kFirstSkin;
  long last_by_motion_ = 0;  // the last search that motion asked for
};

/// Where a grain was at the last search, and how far any of its points may go.
template <int D>
struct Margin {
  VectorOf<D> position = zero<VectorOf<D>>();
  RotationOf<D> rotation = no_rotation<RotationOf<D>>();
  double turning = 0;  ///< m/rad: how far turning carries a point; 0 where only the circle counts
  double way = 0;      ///< m

  /// True when the grain may be where the list does not know of it; also for nan. `turns`: turning
  /// counts at all.
  template <bool turns>
  bool is_left(const VectorOf<D>& now, const RotationOf<D>& rotation_now) const {
    return is_beyond<turns>(now - position, rotation_now, way);
  }
  /// The same in a space that flows: it would have carried the grain to `carried`, and has changed
  /// distances by up to `strain` times themselves. Two grains at a distance of more than the sum of
  /// their reaches (radius + way) are still apart while each is off that place by less than
  /// way - strain reach.
  template <bool turns>
  bool is_left_in_flow(const VectorOf<D>& now, const RotationOf<D>& rotation_now,
                       const VectorOf<D>& carried, double strain, double radius) const {
    return is_beyond<turns>(now - carried, rotation_now, way - strain * (radius + way));
  }

 private:
  template <bool turns>
  bool is_beyond(const VectorOf<D>& moved, const RotationOf<D>& rotation_now, double left) const {
    if constexpr (turns) left -= turning * Space<D>::angle_between(rotation_now, rotation);
    return !(left >= 0 && moved.squaredNorm() <= left * left);
  }
};

}  // namespace grainfield::dem
