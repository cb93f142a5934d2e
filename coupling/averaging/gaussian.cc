// exp(-r^2 / 2 w^2) cut at 3 w and renormalised: in the plane the cut leaves out exp(-4.5) = 1.1 %
// of the weight, in space erfc(3/sqrt 2) + sqrt(2/pi) 3 exp(-4.5) = 2.9 %.
#include <cmath>
#include <numbers>

#include "coupling/averaging/kernel.h"

namespace grainfield::coupling {
namespace {

class Gaussian : public Kernel {
 public:
  Gaussian(double width, int dim)
      : width_(width),
        dim_(dim),
        factor_(std::pow(2 * std::numbers::pi * width * width, -dim / 2.0)) {
    const double kept = dim == 2 ? -std::expm1(-4.5)
                                 : std::erf(3 / std::numbers::sqrt2) -
                                       std::sqrt(2 / std::numbers::pi) * 3 * std::exp(-4.5);
    factor_ /= kept;
  }
  int dim() const override { return dim_; }
  std::string name() const override { return "gaussian"; }
  double range() const override { return 3 * width_; }
  double value(double r) const override {
    const double a = r / width_;
    return a < 3 ? factor_ * std::exp(-a * a / 2) : 0;
  }
  double slope(double r) const override { return -r / (width_ * width_) * value(r); }
  double along_line(double d, double s0, double s1) const override {
    const double a = d / width_, scale = width_ * std::numbers::sqrt2;
    return factor_ * std::exp(-a * a / 2) * width_ * std::sqrt(std::numbers::pi / 2) *
           (std::erf(s1 / scale) - std::erf(s0 / scale));
  }

 private:
  double width_;
  int dim_;
  double factor_;
};

}  // namespace

std::unique_ptr<Kernel> make_gaussian(double width, int dim) {
  return std::make_unique<Gaussian>(width, dim);
}

}  // namespace grainfield::coupling
