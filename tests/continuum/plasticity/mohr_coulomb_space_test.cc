// The Mohr-Coulomb law in space against the plane-strain one, in turned axes, and its tangent
// against differences.
#include "continuum/plasticity/mohr_coulomb_space.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <map>
#include <random>

using namespace grainfield::continuum::plasticity;

namespace {

class Draw {
 public:
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53;
  }

 private:
  std::mt19937_64 bits_{11};
};

MohrCoulomb random_material(Draw& draw) {
  MohrCoulomb m;
  m.E = draw(1, 20);
  m.nu = draw(0, 0.45);
  m.friction_deg = draw(5, 45);
  m.dilation_deg = draw(0, m.friction_deg);
  m.cohesion = draw(0, 0.3);
  return m;
}

// About a mean compression, so that plane, edges and apex all come.
Vector6 random_strain(Draw& draw) {
  Vector6 e;
  for (int k = 0; k < 6; ++k) e[k] = draw(-0.2, 0.2);
  e.head<3>().array() -= draw(-0.1, 0.3);
  return e;
}

TEST(MohrCoulombSpace, IsThePlaneLawWithoutShearsOutOfThePlane) {
  Draw draw;
  for (int k = 0; k < 3000; ++k) {
    const MohrCoulombLaw law(random_material(draw));
    Vector6 e = random_strain(draw);
    e[3] = e[4] = 0;
    const Returned plane = law(Vector4(e[0], e[1], e[2], e[5]));
    const ReturnedSpace space = return_in_space(law, e);
    EXPECT_EQ(space.regime, plane.regime);
    const double E = law.constants().E;
    const Vector4 s(space.stress[0], space.stress[1], space.stress[2], space.stress[5]);
    EXPECT_LT((s - plane.stress).norm(), 1e-12 * E);
    EXPECT_LT(std::abs(space.stress[3]) + std::abs(space.stress[4]), 1e-12 * E);
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const auto at = [](int a) { return a == 3 ? 5 : a; };
        EXPECT_NEAR(space.tangent(at(i), at(j)), plane.tangent(i, j), 1e-8 * E);
      }
    }
  }
}

TEST(MohrCoulombSpace, TangentIsTheDerivative) {
  Draw draw;
  std::map<Regime, int> seen;
  for (int k = 0; k < 2000; ++k) {
    const MohrCoulombLaw law(random_material(draw));
    const Vector6 e = random_strain(draw);
    const ReturnedSpace there = return_in_space(law, e);
    constexpr double kStep = 1e-6;
    Matrix6 differences;
    bool same = true;
    for (int c = 0; c < 6; ++c) {
      const ReturnedSpace up = return_in_space(law, e + kStep * Vector6::Unit(c)),
                          down = return_in_space(law, e - kStep * Vector6::Unit(c));
      same = same && up.regime == there.regime && down.regime == there.regime;
      differences.col(c) = (up.stress - down.stress) / (2 * kStep);
    }
    if (!same) continue;
    ++seen[there.regime];
    // Central differences of curved directions: second order in the step over the strains' spread.
    EXPECT_LT((differences - there.tangent).norm(), 1e-3 * law.constants().E) << k;
  }
  EXPECT_EQ(seen.size(), 5U);
  for (const auto& [regime, count] : seen) EXPECT_GT(count, 20);
}

TEST(MohrCoulombSpace, ElasticStrainInvertsHooke) {
  Draw draw;
  for (int k = 0; k < 100; ++k) {
    const double E = draw(1, 20), nu = draw(-0.5, 0.45);
    const Vector6 e = random_strain(draw);
    EXPECT_LT((elastic_strain_in_space(hooke_in_space(E, nu) * e, E, nu) - e).norm(), 1e-12);
  }
}

}  // namespace
