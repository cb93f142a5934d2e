// Lucy's bell, a = r/c, c = 2 w (Weinhart et al. 2012 eq. 22):
//   f (1 + 3 a)(1 - a)^3 = f (1 - 6 a^2 + 8 a^3 - 3 a^4)
// with f = 5/(pi c^2) in the plane and 105/(16 pi c^3) in space.
// Twice continuously differentiable at its edge; its line integrals are closed.
#include <cmath>
#include <numbers>

#include "coupling/averaging/kernel.h"

namespace grainfield::coupling {
namespace {

class Lucy : public Kernel {
 public:
  Lucy(double width, int dim)
      : range_(2 * width),
        dim_(dim),
        factor_((dim == 2 ? 5 : 105 / (16 * range_)) / (std::numbers::pi * range_ * range_)) {}
  int dim() const override { return dim_; }
  std::string name() const override { return "lucy"; }
  double range() const override { return range_; }
  double value(double r) const override {
    const double a = r / range_;
    return a < 1 ? factor_ * (1 + 3 * a) * (1 - a) * (1 - a) * (1 - a) : 0;
  }
  double slope(double r) const override {
    const double a = r / range_;
    return a < 1 ? -12 * factor_ / range_ * a * (1 - a) * (1 - a) : 0;
  }
  double along_line(double d, double s0, double s1) const override {
    const double c = range_;
    return factor_ * c * (primitive(d / c, s1 / c) - primitive(d / c, s0 / c));
  }

 private:
  // The primitive of 1 - 6 r^2 + 8 r^3 - 3 r^4 with r^2 = d^2 + s^2, lengths in units of the range.
  static double primitive(double d, double s) {
    const double d2 = d * d, s2 = s * s, r2 = d2 + s2, r = std::sqrt(r2);
    // d^4 asinh(s/d) tends to 0 with d; below 1e-12 it is below rounding.
    const double logarithm = d > 1e-12 ? 0.375 * d2 * d2 * std::asinh(s / d) : 0;
    const double cube = s * r * (r2 / 4 + 0.375 * d2) + logarithm;
    return s * (1 - 6 * (d2 + s2 / 3) - 3 * (d2 * d2 + 2 * d2 * s2 / 3 + s2 * s2 / 5)) + 8 * cube;
  }

  double range_;
  int dim_;
  double factor_;
};

}  // namespace

std::unique_ptr<Kernel> make_lucy(double width, int dim) {
  return std::make_unique<Lucy>(width, dim);
}

}  // namespace grainfield::coupling
