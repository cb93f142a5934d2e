// Where the packing is: between the side walls, above the floor, below the free surface.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "coupling/averaging/kernel.h"
#include "coupling/averaging/roof.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Shape of a representative volume element about the origin.
struct Support {
  const char* name;
  /// Distance from the centre as the support sees it: inside is less than its width.
  double (*distance)(const Eigen::Vector3d& from_centre);
  /// Area in the plane, volume in space.
  double (*measure)(double width, int dim);
  /// The same inside the box; in 2D z is ignored.
  double (*in_box)(double width, const Eigen::Vector3d& low, const Eigen::Vector3d& high, int dim);
  /// Area inside the polygon (2D).
  double (*in_polygon)(double width, const std::vector<Eigen::Vector2d>& corners);
  /// Area of a disk of radius r at `centre` inside it (2D).
  double (*of_disk)(double width, const Eigen::Vector2d& centre, double r);
  /// Volume of a sphere of radius r at `centre` inside it (3D).
  double (*of_ball)(double width, const Eigen::Vector3d& centre, double r);
  /// Half of its chord along y at x, and along z at (x, y) (3D); |x| < width, |y| within that.
  double (*half_y)(double width, double x);
  double (*half_z)(double width, double x, double y);
};
/// "circle" and "square"; in 3D they are the sphere and the cube. Null for another name.
const Support* find_support(const std::string& name);

/// 2D: the free surface is the polyline through the highest points of the free grains in columns
/// two mean diameters wide; it meets a side wall (or a side steeper than any heap) level, and
/// otherwise the floor at the outermost grain's edge. A wall that faces down (lid, piston) is the
/// surface if a grain touches it. 3D: the box of the walls across the axes, closed by the grains'
/// extent where there is none, below the highest points of the grains in columns two mean diameters
/// wide (roof.h) or a lid that a grain touches.
class Region {
 public:
  /// Throws std::invalid_argument "the snapshot has no free grain".
  explicit Region(const dem::Snapshot& snapshot);

  int dim() const { return dim_; }
  double floor() const { return low_[dim_ - 1]; }  ///< height of the floor, m
  double left() const { return low_.x(); }
  double right() const { return high_.x(); }
  double front() const { return low_.y(); }  ///< 3D: along y
  double back() const { return high_.y(); }
  double highest() const { return high_[dim_ - 1]; }  ///< of the free surface, m
  /// Corners of the free surface from left to right (2D), m.
  const std::vector<Eigen::Vector2d>& corners() const { return surface_; }
  /// Height of the free surface at abscissa x (2D), m; level beyond the ends.
  double surface(double x) const;
  /// The same over the plane (3D).
  double surface(double x, double y) const { return roof_.height(x, y); }
  const Roof& roof() const { return roof_; }
  /// Area (volume) of the support, centred at `at`, inside the region.
  double measure(const Support& support, double width, const Eigen::VectorXd& at) const;
  /// Share of the kernel, centred at `at`, inside the region (2D); `above_only`: only what lies
  /// above the free surface counts as outside. Chords in y exact, 16 Gauss points along x between
  /// the surface's corners.
  double share(const Kernel& kernel, const Eigen::Vector2d& at, bool above_only) const;
  /// The same in 3D: chords in z exact, 20 x 20 Gauss points over the plane.
  double share(const Kernel& kernel, const Eigen::Vector3d& at, bool above_only) const;

 private:
  void find_surface(const dem::Snapshot& snapshot);
  void find_roof(const dem::Snapshot& snapshot);
  double below_roof(const Support& support, double width, const Eigen::Vector3d& at) const;

  int dim_;
  Eigen::Vector3d low_, high_;
  std::vector<Eigen::Vector2d> surface_;  // 2D: left to right, of strictly rising abscissas
  Roof roof_{0};                          // 3D
};

}  // namespace grainfield::coupling
