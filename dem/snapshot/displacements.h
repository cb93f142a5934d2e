// How far the grains of a packing have come between two of its states.
#pragma once
#include <array>
#include <string>

#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// Displacements across the boundaries of a periodic cell. Along an axis of which both states have
/// counted the images, a displacement is that of the grain. Along the others it is the shortest
/// way. The attribute `images` of an imported state says what its file had: "counted" (image flags,
/// or places that were not carried back), "counted along x", "not carried back" (no flags, and
/// grains far out of the cell), "untold". States of our engines have no such attribute: all images
/// are counted.
class Displacements {
 public:
  /// The states have the same grains in the same order, and outlive this. Throws
  /// std::invalid_argument where a grain is more than kMostImages (images.h) edges away.
  Displacements(const Snapshot& before, const Snapshot& after);

  /// Displacement of the copy that was in the cell before, m.
  Vec3 of(std::size_t grain) const;
  /// `image`, counted in the edges of the cell before, in those after.
  std::array<int, 3> image_after(const std::array<int, 3>& image) const;
  /// How much farther than a place its image has come, m.
  Vec3 of_image(const std::array<int, 3>& image) const;

  /// Where images were not counted in both states: what was done about it, a sentence. Else empty.
  const std::string& images() const { return images_; }
  /// What makes the displacements doubtful, and what to do; a sentence. Empty: nothing. That some
  /// shortest ways are longer than a third of an edge, where another image may be meant; or that
  /// nobody can tell how many edges the sides of the cell have slid past each other.
  std::string doubt() const;

 private:
  void settle_axes();
  void settle_exchange();
  /// Whether contacts keep together if images are counted from the places.
  bool places_fit() const;
  Vec3 by_images(std::size_t grain) const;
  /// The part of a way that images along the counted axes do not change.
  Vec3 across_counted(const Vec3& way) const { return counts_some_ ? Vec3(across_ * way) : way; }

  const Snapshot *before_, *after_;
  std::array<bool, 3> counted_{};  // axes
  Cell<3> nearest_;                // that after, across the counted axes, of the others
  Eigen::Matrix3d across_;         // projects across the edges along the counted axes
  bool counts_some_ = false;
  Eigen::Matrix3i exchange_;  // columns: the old edges in new ones
  bool slid_ = false;         // the sides are between two images
  std::string images_;
};

}  // namespace grainfield::dem
