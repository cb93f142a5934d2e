// A disk (3D: ball) of constant weight: sharp; the line integral is a chord.
#include <numbers>

#include "coupling/averaging/kernel.h"

namespace grainfield::coupling {
namespace {

class Heaviside : public Kernel {
 public:
  Heaviside(double width, int dim)
      : width_(width),
        dim_(dim),
        factor_((dim == 2 ? 1 : 3 / (4 * width)) / (std::numbers::pi * width * width)) {}
  int dim() const override { return dim_; }
  std::string name() const override { return "heaviside"; }
  double range() const override { return width_; }
  double value(double r) const override { return r < width_ ? factor_ : 0; }
  double slope(double /*r*/) const override { return 0; }
  double along_line(double /*d*/, double s0, double s1) const override {
    return factor_ * (s1 - s0);
  }

 private:
  double width_;
  int dim_;
  double factor_;
};

}  // namespace

std::unique_ptr<Kernel> make_heaviside(double width, int dim) {
  return std::make_unique<Heaviside>(width, dim);
}

}  // namespace grainfield::coupling
