// Settlements that a model predicts by its stresses: closed-form displacements of the half plane
// and space, stiffness by depth, and where the grains' are compared with them.
#include "coupling/studies/boussinesq_limit/settlement.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "continuum/closed/half_space.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling::testing {
namespace {

constexpr double kForce = 3, kDepth = 2, kYoung = 50, kPoisson = 0.3;
const double kNothing = std::numeric_limits<double>::quiet_NaN();

SettlementPlaces places() {
  SettlementPlaces out;
  out.surface = Eigen::VectorXd::LinSpaced(21, -4, 4);
  out.axis = Eigen::VectorXd::LinSpaced(10, 0.1, 1.9);
  out.aside = 1e-3;
  return out;
}

RunFacts facts(int dim) { return {kForce, kDepth, dim, 0.1, "", {}}; }

// Strains of the half plane's stresses over a depth are differences of its displacement.
TEST(Settlement, OfTheHalfPlaneIsFlamants) {
  const Folder folder;
  const auto moduli =
      continuum::read_moduli_by_depth(folder.write("one.csv", "depth,E,nu\n0,50,0.3\n"));
  const SettlementPlaces at = places();
  const Settlements s = predicted_settlements({"x", "flamant", {}}, facts(2), moduli, at);
  const auto down = [](double x, double y) {
    return continuum::flamant_displacement(kForce, kYoung, kPoisson, x, -kDepth)[1] -
           continuum::flamant_displacement(kForce, kYoung, kPoisson, x, y)[1];
  };
  for (Eigen::Index k = 0; k < at.surface.size(); ++k) {
    if (std::fabs(at.surface[k]) < 0.2) {
      EXPECT_TRUE(std::isnan(s.surface[k]));
      continue;
    }
    EXPECT_NEAR(s.surface[k], down(at.surface[k], 0), 1e-5 * kForce / kYoung) << at.surface[k];
  }
  EXPECT_TRUE(std::isnan(s.axis[0]));
  for (Eigen::Index k = 1; k < at.axis.size(); ++k)
    EXPECT_NEAR(s.axis[k], down(0, -at.axis[k]), 1e-5 * kForce / kYoung) << at.axis[k];
  EXPECT_GT(s.axis[1], s.axis[2]);
}

TEST(Settlement, OfTheHalfSpaceIsBoussinesqs) {
  const Folder folder;
  const auto moduli =
      continuum::read_moduli_by_depth(folder.write("one.csv", "depth,E,nu\n0,50,0.3\n"));
  SettlementPlaces at = places();
  at.aside = 0.4;
  const Settlements s =
      predicted_settlements({"x", "boussinesq", {{"nu", "0.3"}}}, facts(3), moduli, at);
  const auto down = [](double x, double z) {
    return continuum::boussinesq_displacement(kForce, kYoung, kPoisson, x, 0, -kDepth)[2] -
           continuum::boussinesq_displacement(kForce, kYoung, kPoisson, x, 0, z)[2];
  };
  const double unit = kForce / kYoung / kDepth;
  EXPECT_NEAR(s.surface[3], down(at.surface[3], 0), 1e-5 * unit);
  // Mean over a disk.
  double mean = 0;
  for (int k = 0; k < 1000; ++k) mean += down(0.4 * std::sqrt((k + 0.5) / 1000), -1.1) / 1000;
  EXPECT_NEAR(s.axis[5], mean, 2e-3 * mean);
  EXPECT_LT(mean, 0.99 * down(0, -1.1));
}

// Under the same stresses half as stiff a half settles twice as much of its part.
TEST(Settlement, FollowsTheModuliOfEachDepth) {
  const Folder folder;
  const auto one =
      continuum::read_moduli_by_depth(folder.write("one.csv", "depth,E,nu\n0,50,0.3\n"));
  const auto soft = continuum::read_moduli_by_depth(
      folder.write("two.csv", "depth,E,nu\n0,25,0.3\n1,25,0.3\n1.000001,50,0.3\n"));
  const SettlementPlaces at = places();
  for (const int dim : {2, 3}) {
    const ModelChoice model{"x", dim == 2 ? "flamant" : "boussinesq", {}};
    const Settlements a = predicted_settlements(model, facts(dim), one, at),
                      b = predicted_settlements(model, facts(dim), soft, at);
    EXPECT_NEAR(b.axis[7], a.axis[7], 1e-9);  // 1.5 m deep
    SettlementPlaces middle = at;
    middle.axis = Eigen::VectorXd::Constant(1, 1.0);
    const double below = predicted_settlements(model, facts(dim), one, middle).axis[0];
    // To a part of the quadrature that has the jump.
    EXPECT_NEAR(b.axis[2], below + 2 * (a.axis[2] - below), 0.01 * b.axis[2]) << dim;
  }
}

TEST(Settlement, MeansAreOfPlacesFarFromTheLoad) {
  SettlementPlaces at;
  at.surface = Eigen::VectorXd{{-2.2, -2, -1, -0.2, 0, 0.4, 1}};
  at.axis = Eigen::VectorXd{{0.2, 0.6, 1.4, 1.8}};
  const Settlements grains{Eigen::VectorXd{{9, 1, 2, 9, 9, kNothing, 3}},
                           Eigen::VectorXd{{9, 4, kNothing, 9}}},
      model{Eigen::VectorXd{{7, 2, 4, 7, kNothing, 7, 3}}, Eigen::VectorXd{{7, 5, 7, 7}}};
  const MeanSettlement surface = mean_on_surface(grains, model, at, 2),
                       axis = mean_on_axis(grains, model, at, 2);
  EXPECT_DOUBLE_EQ(surface.of, 2);
  EXPECT_DOUBLE_EQ(surface.other, 3);
  EXPECT_DOUBLE_EQ(axis.of, 4);
  EXPECT_DOUBLE_EQ(axis.other, 5);
  EXPECT_TRUE(std::isnan(mean_on_axis(grains, model, at, 100).of));
}

}  // namespace
}  // namespace grainfield::coupling::testing
