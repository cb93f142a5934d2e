#include "continuum/closed/osl_layer.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "continuum/closed/models.h"
#include "continuum/constants.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

// Points this share of the depth outside are on the surface or the base.
constexpr double kOnBoundary = 1e-9;
// Width of the load where none is chosen, as a share of the depth.
constexpr double kWidth = 0.1;

// p(x) / F and its derivative.
struct Load {
  double value = 0, slope = 0;
  Load(double x, double width) {
    if (!(std::fabs(x) < width / 2)) return;
    const double k = 2 * std::numbers::pi / width;
    value = (1 + std::cos(k * x)) / width;
    slope = -k * std::sin(k * x) / width;
  }
};

class OslLayer : public Model {
 public:
  explicit OslLayer(OslLayerField field) : field_(std::move(field)) {}
  Stresses stress(const Points& points) override {
    Stresses out(points.rows(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      out.row(i) = field_.stress(points(i, 0), points(i, 1)).transpose();
    return out;
  }
  std::map<std::string, double> figures() const override {
    return {{"c1", field_.pulses()[0].slope}, {"c2", field_.pulses()[1].slope}};
  }

 private:
  OslLayerField field_;
};

std::unique_ptr<Model> make(const Settings& s) {
  const Closure closure{number_of(s, "eta"), number_of(s, "mu")};
  const double depth = number_of(s, "h"), width = number_of(s, "width");
  const int returns = s.at("base") == "reflecting" ? static_cast<int>(number_of(s, "returns")) : 0;
  return std::make_unique<OslLayer>(OslLayerField(
      closure, number_of(s, "F"), depth, std::isnan(width) ? kWidth * depth : width, returns));
}

}  // namespace

OslLayerField::OslLayerField(const Closure& closure, double load, double depth, double width,
                             int returns)
    : load_(load), depth_(depth), width_(width) {
  const double c1 = closure.c1(), c2 = closure.c2();
  for (const bool first : {true, false}) {
    Pulse pulse{0, first ? c1 : c2, (first ? -c2 : c1) / (c1 - c2)};
    pulses_.push_back(pulse);
    for (int k = 0; k < returns; ++k) {
      const double other = pulse.slope == c1 ? c2 : c1;
      const Pulse back{pulse.from + (pulse.slope - other) * depth, other,
                       -pulse.share * pulse.slope / other};
      pulses_.push_back(back);
      if (k + 1 == returns) break;
      pulse = {back.from, pulse.slope, -back.share};
      pulses_.push_back(pulse);
    }
  }
  // The two that the load sends down come first.
  for (std::size_t k = 1; k < pulses_.size(); ++k) {
    if (pulses_[k].from == 0 && pulses_[k].slope == c2) std::swap(pulses_[1], pulses_[k]);
  }
}

Eigen::Vector3d OslLayerField::stress(double x, double y) const {
  const double slack = kOnBoundary * depth_;
  if (!(y <= slack && y >= -depth_ - slack && std::isfinite(x)))
    return Eigen::Vector3d::Constant(kNan);
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (const Pulse& p : pulses_) {
    const double f = load_ * p.share * Load(x - p.from + p.slope * y, width_).value;
    out += f * Eigen::Vector3d(-p.slope * p.slope, -1, p.slope);
  }
  return out;
}

LinearStress OslLayerField::gradient(double x, double y) const {
  LinearStress out = LinearStress::Zero();
  for (const Pulse& p : pulses_) {
    const double f = load_ * p.share * Load(x - p.from + p.slope * y, width_).slope;
    out += f * Eigen::Vector3d(-p.slope * p.slope, -1, p.slope) * Eigen::RowVector2d(1, p.slope);
  }
  return out;
}

ModelInfo osl_layer_info() {
  return {
      "osl_layer",
      "layer with oriented stress linearity: the load runs down two characteristics",
      2,
      {number("F", "N", "load at the origin, down", "Roul 5.6", 1, 0, kUnbounded),
       number("h", "m", "depth of the layer", "Roul 5.6", 1, kAboveZero, kUnbounded),
       may_be_free(number("eta", "-",
                          "sigma_xx / sigma_yy without shear; characteristics dx/dy = +-sqrt(eta) "
                          "for mu = 0",
                          "Roul 4.22", 0.5, kAboveZero, kUnbounded),
                   0.02, 6),
       may_be_free(number("mu", "-", "tilts both characteristics to one side", "Roul 4.22", 0,
                          -kUnbounded, kUnbounded),
                   -2, 2),
       may_be_free(optional_number("width", "m",
                                   "the load is spread as 1 + cos over this width; unset: h/10",
                                   "stated load", kAboveZero, kUnbounded),
                   0.1, 4),
       choice("base",
              "absorbing: takes up what arrives; reflecting: bears no shear and sends pulses back",
              "hyperbolic layer", {"absorbing", "reflecting"}),
       only_with(whole_number("returns", "reflecting base: how often pulses come back from it",
                              "hyperbolic layer", 1, 1, 1000),
                 "base", {"reflecting"})},
      make,
      {{"c1", "-", "dx/d(depth) of the characteristic to the right"},
       {"c2", "-", "dx/d(depth) of the characteristic to the left"}}};
}

}  // namespace grainfield::continuum
