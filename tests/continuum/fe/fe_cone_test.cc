// The body of revolution of the elasto-plastic solver: a column, a thick-walled cylinder that
// yields in part, cones in equilibrium.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>

#include "continuum/fe/plastic_verification.h"
#include "continuum/fe/wedge.h"
#include "continuum/model.h"

using namespace grainfield::continuum;
using testing::HasSubstr;

namespace {

WedgeProblem cone(int cells, double slope) {
  WedgeProblem p;
  p.cone = true;
  p.cells = cells;
  p.right_deg = slope;
  p.cohesion = 1e-2;
  return p;
}

// Points of a body between two depths: the section's integral of f over 2 pi r dr.
double base_integral(Model& model, double radius, double depth, int n = 400) {
  Points points(n, 3);
  for (int k = 0; k < n; ++k) points.row(k) << radius * (k + 0.5) / n, 0, -depth;
  const Stresses s = model.stress(points);
  double sum = 0;
  for (int k = 0; k < n; ++k) sum -= 2 * M_PI * points(k, 0) * radius / n * s(k, 2);
  return sum;
}

}  // namespace

TEST(FeCone, AColumnInATubeIsOfSecondOrder) {
  const double coarse = check_column(4), fine = check_column(8);
  std::printf("column: %.2e %.2e\n", coarse, fine);
  EXPECT_LT(fine, 1e-3);
  EXPECT_GT(std::log2(coarse / fine), 1.8);
}

TEST(FeCone, AnElasticCylinderIsLames) {
  Cylinder cylinder;
  cylinder.yields = 0;
  double error[2];
  for (int k = 0; k < 2; ++k) {
    cylinder.cells = 4 << k;
    const CylinderCheck found = check_cylinder(cylinder);
    error[k] = found.stress_error;
    EXPECT_EQ(found.yielded_error, 0);
  }
  std::printf("elastic cylinder: %.2e %.2e\n", error[0], error[1]);
  EXPECT_LT(error[1], 2e-3);
  EXPECT_GT(std::log2(error[0] / error[1]), 1.8);
}

// The stress has a kink where yielding ends: between first and second order.
TEST(FeCone, ACylinderYieldsAsFarAsTheClosedFormSays) {
  for (const double phi : {0., 30.}) {
    for (const double dilation : {0., phi}) {
      Cylinder cylinder;
      cylinder.phi_deg = phi;
      cylinder.dilation_deg = dilation;
      double error[2];
      for (int k = 0; k < 2; ++k) {
        cylinder.cells = 8 << k;
        const CylinderCheck found = check_cylinder(cylinder);
        error[k] = found.stress_error;
        EXPECT_NEAR(found.yielded_error, 0, 1.0 / cylinder.cells);
      }
      std::printf("phi %g psi %g: %.2e %.2e\n", phi, dilation, error[0], error[1]);
      EXPECT_LT(error[1], 1e-2) << phi;
      EXPECT_GT(std::log2(error[0] / error[1]), 0.9) << phi;
    }
  }
}

TEST(FeCone, RestsOnItsGround) {
  for (const auto base : {WedgeBase::rough, WedgeBase::frictional}) {
    for (const auto history : {WedgeHistory::at_once, WedgeHistory::rise, WedgeHistory::grow}) {
      WedgeProblem p = cone(8, 22);
      p.base = base;
      p.history = history;
      p.layers = 4;
      const WedgeResult r = solve_wedge(p);
      EXPECT_NEAR(r.base_force[1] / r.weight, 1, 1e-8);
      const plasticity::MohrCoulombLaw law({p.young, p.poisson, 28, 0, p.cohesion});
      for (const auto& point : r.points) EXPECT_LE(law.yield(point.stress), 1e-12);
      EXPECT_NEAR(r.weight, M_PI * std::pow(1 / std::tan(22 * M_PI / 180), 2) / 3, 1e-12);
    }
  }
}

// Components in the project's axes: the same round the axis, no direction on it, balance of what
// lies above a horizontal cut.
TEST(FeCone, AsAModelOfSpace) {
  const auto model = make_model(
      "fe_cone",
      {{"cells", "24"}, {"slope_deg", "24"}, {"cohesion", "0.01"}, {"rho_g", "3"}, {"h", "2"}});
  Points points(5, 3);
  points << 0.8, 0, -1.2, 0, 0.8, -1.2, 0.8 * std::sqrt(0.5), 0.8 * std::sqrt(0.5), -1.2, 0, 0, -1,
      9, 0, -1;
  const Stresses s = model->stress(points);
  EXPECT_NEAR(s(0, 0), s(1, 1), 1e-12);
  EXPECT_NEAR(s(0, 1), s(1, 0), 1e-12);
  EXPECT_NEAR(s(0, 4), s(1, 3), 1e-12);
  EXPECT_NEAR(s(2, 0), (s(0, 0) + s(0, 1)) / 2, 1e-12);
  EXPECT_NEAR(s(2, 5), (s(0, 0) - s(0, 1)) / 2, 1e-12);
  EXPECT_NEAR(s(3, 0), s(3, 1), 0.02 * std::abs(s(3, 2)));
  EXPECT_NEAR(s(3, 4), 0, 0.02 * std::abs(s(3, 2)));
  EXPECT_TRUE(s.row(4).array().isNaN().all());
  for (const double depth : {1.2, 2.0}) {
    const double radius = depth / std::tan(24 * M_PI / 180);
    const double weight = 3 * M_PI * radius * radius * depth / 3;
    EXPECT_NEAR(base_integral(*model, radius, depth) / weight, 1, 0.01) << depth;
  }
  const auto figures = model->figures();
  EXPECT_NEAR(figures.at("weight_ratio"), 1, 1e-8);
  EXPECT_LE(figures.at("dip_ratio"), 1);
  EXPECT_GT(figures.at("dip_ratio"), 0.3);
  for (const auto& [name, value] : figures) {
    const auto& declared = find_model("fe_cone").figures;
    EXPECT_TRUE(std::any_of(declared.begin(), declared.end(), [&name = name](const Figure& f) {
      return f.name == name;
    })) << name;
  }
}

TEST(FeCone, RefusesWhatCannotStand) {
  try {
    make_model("fe_cone", {{"slope_deg", "40"}, {"cohesion", "0"}});
    FAIL();
  } catch (const BadParameter& e) {
    EXPECT_THAT(e.what(), HasSubstr("fe_cone: slope_deg = 40"));
  }
}
