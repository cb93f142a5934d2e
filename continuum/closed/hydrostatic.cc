#include "continuum/closed/hydrostatic.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "continuum/closed/models.h"
#include "continuum/constants.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

constexpr double kSteepest = 89;  // degrees

class Hydrostatic : public Model {
 public:
  explicit Hydrostatic(const HydrostaticSetup& setup) : setup_(setup) {}
  Stresses stress(const Points& points) override { return hydrostatic_stress(setup_, points); }
  // d sigma_xx / dx is not 0 under a slope, and no shear balances it: over rho g its tangent.
  std::map<std::string, double> figures() const override {
    return {{"equilibrium_residual", std::tan(std::max(setup_.left, setup_.right))}};
  }

 private:
  HydrostaticSetup setup_;
};

}  // namespace

Stresses hydrostatic_stress(const HydrostaticSetup& setup, const Points& points) {
  Stresses out = Stresses::Constant(points.rows(), 3, std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const double x = points(i, 0), slope = x < 0 ? setup.left : setup.right;
    const double depth = setup.level - std::fabs(x) * std::tan(slope) - points(i, 1);
    if (!(depth >= 0)) continue;
    const double pressure = setup.rho_g * depth;
    out.row(i) << -pressure, -pressure, 0;
  }
  return out;
}

ModelInfo hydrostatic_info() {
  return {
      "hydrostatic",
      "pressure of the material above, the same in every direction",
      2,
      {number("rho_g", "N/m3", "weight of a unit volume (N/m2 with an areal density)",
              "force balance", 1, kAboveZero, kUnbounded),
       number("level", "m", "height of the free surface (of a heap: its apex)", "force balance", 0,
              -kUnbounded, kUnbounded),
       number("left_deg", "deg", "slope of a heap's left flank; 0: a level surface",
              "force balance", 0, 0, kSteepest),
       number("right_deg", "deg", "slope of its right flank", "force balance", 0, 0, kSteepest)},
      [](const Settings& s) -> std::unique_ptr<Model> {
        return std::make_unique<Hydrostatic>(HydrostaticSetup{
            number_of(s, "rho_g"), number_of(s, "level"), number_of(s, "left_deg") * kDegree,
            number_of(s, "right_deg") * kDegree});
      },
      {{"equilibrium_residual", "-",
        "largest |div sigma - (0, rho g)| over rho g: the tangent of the steeper slope"}}};
}

}  // namespace grainfield::continuum
