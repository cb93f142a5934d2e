// exp(-r^2 / 2 w^2) cut at 3 w and renormalised: the cut leaves out exp(-4.5) = 1.1 % of the
// weight.
#include <cmath>
#include <numbers>

#include "coupling/averaging/kernels.h"

namespace grainfield::coupling {
namespace {

class Gaussian : public Kernel {
 public:
  explicit Gaussian(double width)
      : width_(width), factor_(1 / (2 * std::numbers::pi * width * width * -std::expm1(-4.5))) {}
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
  double width_, factor_;
};

}  // namespace

std::unique_ptr<Kernel> make_gaussian(double width) { return std::make_unique<Gaussian>(width); }

}  // namespace grainfield::coupling
