// Weights of coarse graining. A new kernel is one file that implements Kernel and one line in
// kernel.cc.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace grainfield::coupling {

/// A smooth or sharp isotropic weight of the plane or of space: integral 1, zero beyond range().
class Kernel {
 public:
  virtual ~Kernel() = default;
  virtual std::string name() const = 0;
  /// 2: of the plane; 3: of space.
  virtual int dim() const { return 2; }
  /// Radius beyond which the weight is zero, m.
  virtual double range() const = 0;
  /// The weight at distance r, 1/m2 (3D: 1/m3).
  virtual double value(double r) const = 0;
  /// Derivative of value() with respect to r, 1/m3; a jump at the edge is left out. The default is
  /// a central difference.
  virtual double slope(double r) const;
  /// Integral of the weight over s in [s0, s1] along a straight line that passes the point at
  /// distance d (s is the arc length from the foot of the perpendicular), 1/m (1/m2). The limits
  /// are already inside the kernel's support. The default is Gauss-Legendre quadrature with 30
  /// points on either side of the foot (exact for polynomials in s of degree 59).
  virtual double along_line(double d, double s0, double s1) const;

  /// Weight of the kernel seen from the side: its integral over y (and z) at abscissa x, 1/m. The
  /// kernel with which forces on the floor are smeared along x.
  double marginal(double x) const;
  /// Share of the kernel beyond abscissa x: integral of marginal() from x on.
  double beyond(double x) const;
  /// Distance over which values smeared with this kernel are worth one independent value:
  /// 1 / integral of marginal squared, m (3.54 standard deviations for a Gaussian).
  double independent_length() const;
};

/// Integral over t in [0, 1] of kernel(|point - (a + t (b - a))|), 1/m2: what the branch from a to
/// b gives to the field at `point` (Weinhart et al. 2012 eq. 13). Cut at the kernel's support.
double branch_weight(const Kernel& kernel, const Eigen::Vector2d& point, const Eigen::Vector2d& a,
                     const Eigen::Vector2d& b);
double branch_weight(const Kernel& kernel, const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                     const Eigen::Vector3d& b);

/// "lucy" (range 2 w), "gaussian" (standard deviation w, cut at 3 w and renormalised), "heaviside"
/// (a disk or ball of radius w). Throws std::invalid_argument for an unknown name (says the
/// nearest) or a width that is not positive.
std::unique_ptr<Kernel> make_kernel(const std::string& name, double width, int dim = 2);
const std::vector<std::string>& kernel_names();

std::unique_ptr<Kernel> make_lucy(double width, int dim);
std::unique_ptr<Kernel> make_gaussian(double width, int dim);
std::unique_ptr<Kernel> make_heaviside(double width, int dim);

}  // namespace grainfield::coupling
