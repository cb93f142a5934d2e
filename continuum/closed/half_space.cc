#include "continuum/closed/half_space.h"

#include "continuum/closed/models.h"
#include "continuum/constants.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

class Flamant : public Model {
 public:
  explicit Flamant(double load) : load_(load) {}
  Stresses stress(const Points& points) override {
    Stresses out = Stresses::Constant(points.rows(), 3, kNan);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      if (!(points(i, 1) < 0)) continue;
      const auto s = flamant_stress(load_, points(i, 0), points(i, 1));
      for (int c = 0; c < 3; ++c) out(i, c) = s[c];
    }
    return out;
  }

 private:
  double load_;
};

class Boussinesq : public Model {
 public:
  Boussinesq(double load, double poisson) : load_(load), poisson_(poisson) {}
  Stresses stress(const Points& points) override {
    Stresses out = Stresses::Constant(points.rows(), 6, kNan);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      if (!(points(i, 2) < 0)) continue;
      const auto s = boussinesq_stress(load_, poisson_, points(i, 0), points(i, 1), points(i, 2));
      for (int c = 0; c < 6; ++c) out(i, c) = s[c];
    }
    return out;
  }

 private:
  double load_, poisson_;
};

}  // namespace

ModelInfo flamant_info() {
  return {"flamant",
          "elastic half plane under a line load",
          2,
          {number("F", "N", "load at the origin, down", "Roul 5.2", 1, 0, kUnbounded)},
          [](const Settings& s) -> std::unique_ptr<Model> {
            return std::make_unique<Flamant>(number_of(s, "F"));
          }};
}

ModelInfo boussinesq_info() {
  return {"boussinesq",
          "elastic half space under a point load",
          3,
          {number("F", "N", "load at the origin, down", "Boussinesq 1885", 1, 0, kUnbounded),
           number("nu", "-", "Poisson's ratio; the vertical stresses do not depend on it",
                  "Boussinesq 1885", 0.3, 0, 0.5)},
          [](const Settings& s) -> std::unique_ptr<Model> {
            return std::make_unique<Boussinesq>(number_of(s, "F"), number_of(s, "nu"));
          }};
}

}  // namespace grainfield::continuum
