#include "continuum/closed/models.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

class Hydrostatic : public Model {
 public:
  Hydrostatic(double weight, double level) : weight_(weight), level_(level) {}
  Stresses stress(const Points& points) override {
    Stresses out = Stresses::Constant(points.rows(), 3, std::numeric_limits<double>::quiet_NaN());
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      if (!(points(i, 1) <= level_)) continue;
      const double pressure = weight_ * (level_ - points(i, 1));
      out.row(i) << -pressure, -pressure, 0;
    }
    return out;
  }

 private:
  double weight_, level_;
};

}  // namespace

ModelInfo hydrostatic_info() {
  return {"hydrostatic",
          "pressure of the material above, the same in every direction",
          2,
          {number("rho_g", "N/m3", "weight of a unit volume (N/m2 with an areal density)",
                  "force balance", 1, -kUnbounded, kUnbounded),
           number("level", "m", "height of the free surface", "force balance", 0, -kUnbounded,
                  kUnbounded)},
          [](const Settings& s) -> std::unique_ptr<Model> {
            return std::make_unique<Hydrostatic>(number_of(s, "rho_g"), number_of(s, "level"));
          }};
}

}  // namespace grainfield::continuum
