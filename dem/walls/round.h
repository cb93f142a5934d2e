// Round walls: an endless cylinder (in the plane a circle), and the shell of a cylinder or cone
// between two ends.
#pragma once
#include "dem/space/space3.h"
#include "dem/walls/surface.h"

namespace grainfield::dem {

// Round-off of an axis' place and direction, relative.
inline constexpr double kOnAxis = 1e-9;
inline bool lies_along(const Eigen::Vector3d& spin, const Eigen::Vector3d& axis) {
  return spin.cross(axis).norm() <= kOnAxis * spin.norm();
}

/// One side is the wall's: grains are inside (a round container) or outside (a column).
template <int D>
class EndlessCylinder final : public WallSurface<D> {
 public:
  using Vector = VectorOf<D>;
  /// `axis`: unit; not used in the plane.
  EndlessCylinder(double radius, bool inside, const Eigen::Vector3d& axis)
      : radius_(radius), inside_(inside), axis_(axis) {}

  int patches(const Vector& centre, double reach, Patch<D>* found) const override {
    Vector out = centre;
    if constexpr (D == 3) out -= centre.dot(axis_) * axis_;
    const double distance = out.norm();
    const double height = inside_ ? radius_ - distance : distance - radius_;
    if (!(height < reach)) return 0;
    if (distance > 0) {
      out /= distance;
    } else {
      out = across();
    }
    found->plane.normal = inside_ ? Vector(-out) : out;
    found->plane.point = centre - height * found->plane.normal;
    found->curvature = (inside_ ? -1 : 1) / radius_;
    return 1;
  }
  /// About a line along its axis it is carried as a whole.
  double sweeping_arm(const Vector& centre, const Eigen::Vector3d& spin) const override {
    if constexpr (D == 2) {
      return centre.norm();
    } else {
      if (!lies_along(spin, axis_)) return WallSurface<D>::sweeping_arm(centre, spin);
      const double away = centre.cross(axis_).norm();
      return away <= kOnAxis * (radius_ + centre.norm()) ? 0 : away;
    }
  }

 private:
  Vector across() const {
    if constexpr (D == 2)
      return Vector(1, 0);
    else
      return axis_.unitOrthogonal();
  }

  double radius_;
  bool inside_;
  Eigen::Vector3d axis_;
};

/// Thin, and pushes grains on either side; its rims are felt, too.
class RoundShell final : public WallSurface<3> {
 public:
  using Vector = Eigen::Vector3d;
  /// From the origin along `axis` (unit), m.
  RoundShell(double radius, double end_radius, double length, const Vector& axis)
      : radius_(radius), end_radius_(end_radius), length_(length), axis_(axis) {
    const double slant = std::hypot(length, end_radius - radius);
    along_ = {(end_radius - radius) / slant, length / slant};
    slant_ = slant;
  }

  int patches(const Vector& centre, double reach, Patch<3>* found) const override {
    const double z = centre.dot(axis_);
    if (!(z > -reach && z < length_ + reach)) return 0;
    Vector out = centre - z * axis_;
    const double rho = out.norm();
    out = rho > 0 ? Vector(out / rho) : Vector(axis_.unitOrthogonal());
    // In the half plane through the axis: the place on the line from (radius, 0).
    const double from = (rho - radius_) * along_[0] + z * along_[1];
    const double t = std::clamp(from, 0.0, slant_);
    const double at_rho = radius_ + t * along_[0], at_z = t * along_[1];
    double d_rho = rho - at_rho, d_z = z - at_z;
    const double distance = std::hypot(d_rho, d_z);
    if (!(distance < reach)) return 0;
    const bool rim = from != t;
    const bool within = d_rho * along_[1] - d_z * along_[0] <= 0;
    if (!rim) {  // perpendicular to the line, also at no distance
      d_rho = within ? -along_[1] : along_[1];
      d_z = within ? along_[0] : -along_[0];
    } else {
      d_rho /= distance;
      d_z /= distance;
    }
    found->plane.normal = d_rho * out + d_z * axis_;
    found->plane.point = at_rho * out + at_z * axis_;
    // Meusnier: across the generating line the curvature is cos / rho. A rim counts as flat.
    found->curvature = rim || at_rho <= 0 ? 0 : (within ? -1 : 1) * along_[1] / at_rho;
    return 1;
  }
  double sweeping_arm(const Vector& centre, const Eigen::Vector3d& spin) const override {
    const double far = kOnAxis * (radius_ + end_radius_ + centre.norm());
    if (lies_along(spin, axis_) && centre.cross(axis_).norm() <= far) return 0;
    const Vector along = spin.normalized(), end = length_ * axis_ - centre;
    return std::max(centre.cross(along).norm() + radius_, end.cross(along).norm() + end_radius_);
  }

 private:
  double radius_, end_radius_, length_, slant_;
  Vector axis_;
  std::array<double, 2> along_;  // unit, along the generating line: (rho, z)
};

}  // namespace grainfield::dem
