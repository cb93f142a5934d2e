// A disk of constant weight: sharp; the line integral is a chord.
#include <numbers>

#include "coupling/averaging/kernels.h"

namespace grainfield::coupling {
namespace {

class Heaviside : public Kernel {
 public:
  explicit Heaviside(double width)
      : width_(width), factor_(1 / (std::numbers::pi * width * width)) {}
  std::string name() const override { return "heaviside"; }
  double range() const override { return width_; }
  double value(double r) const override { return r < width_ ? factor_ : 0; }
  double slope(double /*r*/) const override { return 0; }
  double along_line(double /*d*/, double s0, double s1) const override {
    return factor_ * (s1 - s0);
  }

 private:
  double width_, factor_;
};

}  // namespace

std::unique_ptr<Kernel> make_heaviside(double width) { return std::make_unique<Heaviside>(width); }

}  // namespace grainfield::coupling
