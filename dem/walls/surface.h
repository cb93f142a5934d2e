// What a wall's surface must answer, in the frame of the wall: origin at Wall::point, axes as they
// were when it was given. A new kind is a file beside this one and an entry in surface.cc.
#pragma once
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "dem/snapshot/snapshot.h"
#include "dem/walls/patch.h"

namespace grainfield::dem {

template <int D>
class WallSurface {
 public:
  using Vector = VectorOf<D>;
  WallSurface() = default;
  WallSurface(const WallSurface&) = delete;
  WallSurface& operator=(const WallSurface&) = delete;
  virtual ~WallSurface() = default;

  /// Where the surface is nearer than `reach` to the centre of a ball: at most slots() places,
  /// those that are local minima of the distance, the nearest first. Returns their number.
  virtual int patches(const Vector& centre, double reach, Patch<D>* found) const = 0;
  virtual int slots() const { return 1; }
  /// Turning about this line (rad/s about an axis through `centre`) moves no point of the surface
  /// across it faster than by an arm of this length, m; 0: it stays in its place, infinite: the
  /// surface has no end.
  virtual double sweeping_arm(const Vector& /*centre*/, const Eigen::Vector3d& /*spin*/) const {
    return std::numeric_limits<double>::infinity();
  }
};

/// The surface of a wall (its shape, radii, length, triangles; direction as given). Throws
/// std::invalid_argument naming the wall: an unknown shape, one that D dimensions do not have,
/// radii or triangles that do not fit.
template <int D>
std::unique_ptr<WallSurface<D>> surface_of(const Wall& wall);

/// Words of the surfaces of D dimensions.
template <int D>
std::vector<std::string> surfaces_in();

}  // namespace grainfield::dem
