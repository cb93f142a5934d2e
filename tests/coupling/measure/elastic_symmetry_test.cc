// Isotropic against orthotropic: exact data, noise, correlated points, and spring lattices whose
// constants are known, from grains to verdict.
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/elastic_constants/symmetry.h"
#include "coupling/strain/strain.h"
#include "tests/coupling/elastic_scene.h"

namespace grainfield::coupling {
namespace {

using test::make_increments;
using test::Recipe;

ElasticOptions few_draws(int draws = 50) {
  ElasticOptions o;
  o.bootstrap.resamples = draws;
  return o;
}

TEST(ElasticSymmetry, ExactOrthotropicConstantsComeBack) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    dem::Random random(seed);
    const Eigen::Vector4d c(1e6 * random.uniform(2, 5), 1e6 * random.uniform(2, 5),
                            1e6 * random.uniform(0, 1.5), 1e6 * random.uniform(0.2, 3));
    Recipe recipe;
    recipe.realizations = 5;
    recipe.c = [&](const Eigen::Vector2d&) { return c; };
    const Increments data = make_increments(seed, recipe);
    const SymmetryFit f = fit_symmetry(data, everywhere(data.points), few_draws());
    const Constant* fitted[] = {&f.c11, &f.c22, &f.c12, &f.c66};
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(fitted[i]->value, c[i], 1e-11 * c[0]);
      EXPECT_NEAR(fitted[i]->low, c[i], 1e-9 * c[0]);
      EXPECT_NEAR(fitted[i]->high, c[i], 1e-9 * c[0]);
    }
    EXPECT_NEAR(f.normal_ratio.value, c[0] / c[1], 1e-10);
    EXPECT_NEAR(f.shear_ratio.value, 4 * c[3] / (c[0] + c[1] - 2 * c[2]), 1e-10);
    EXPECT_LT(f.residual_orthotropic, 1e-13);
    EXPECT_GT(f.residual_isotropic, 1e-3);
    EXPECT_LT(f.p_samples, 1e-10);
    EXPECT_TRUE(std::isnan(f.p_realizations));  // without a spread over realizations: no test
    EXPECT_LT(f.aicc_orthotropic, f.aicc_isotropic);
    EXPECT_FALSE(f.isotropy_holds());
    EXPECT_EQ(f.note, "");
    EXPECT_EQ(f.samples, 60);
  }
}

TEST(ElasticSymmetry, ExactIsotropicDataAreIsotropic) {
  Recipe recipe;
  recipe.realizations = 5;
  const Increments data = make_increments(1, recipe);
  const SymmetryFit f = fit_symmetry(data, everywhere(data.points), few_draws());
  EXPECT_NEAR(f.bulk.value, 2e6, 1e-5);
  EXPECT_NEAR(f.shear.value, 1e6, 1e-5);
  EXPECT_NEAR(f.c11.value, 3e6, 1e-5);
  EXPECT_NEAR(f.c12.value, 1e6, 1e-5);
  EXPECT_NEAR(f.normal_ratio.value, 1, 1e-12);
  EXPECT_NEAR(f.shear_ratio.value, 1, 1e-12);
  EXPECT_EQ(f.p_samples, 1);
  EXPECT_EQ(f.p_realizations, 1);
  EXPECT_LT(f.aicc_isotropic, f.aicc_orthotropic);
  EXPECT_TRUE(f.isotropy_holds());
  // The isotropic constants are those of isotropic_constants().
  Recipe noisy = recipe;
  noisy.stress_noise = 100;
  const Increments other = make_increments(2, noisy);
  const SymmetryFit g = fit_symmetry(other, everywhere(other.points), few_draws());
  const IsotropicConstants c = isotropic_constants(other, everywhere(other.points), few_draws());
  EXPECT_NEAR(g.bulk.value, c.bulk.value, 1e-9 * c.bulk.value);
  EXPECT_NEAR(g.shear.value, c.shear.value, 1e-9 * c.shear.value);
}

struct Rates {
  double samples = 0, realizations = 0, aicc = 0, ratio_held = 0, c66_held = 0;
};

// Shares of 200 trials: rejections at 5 %, preference for four constants, intervals that hold.
Rates rates(const Recipe& recipe) {
  const Eigen::Vector4d c = recipe.c({0, 0});
  Rates rate;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    const Increments data = make_increments(9000 + trial, recipe);
    ElasticOptions o = few_draws(300);
    o.bootstrap.seed = trial;
    const SymmetryFit f = fit_symmetry(data, everywhere(data.points), o);
    rate.samples += (f.p_samples < 0.05) / 200.0;
    rate.realizations += (f.p_realizations < 0.05) / 200.0;
    rate.aicc += (f.aicc_orthotropic < f.aicc_isotropic) / 200.0;
    const double ratio = c[0] / c[1];
    rate.ratio_held += (f.normal_ratio.low <= ratio && ratio <= f.normal_ratio.high) / 200.0;
    rate.c66_held += (f.c66.low <= c[3] && c[3] <= f.c66.high) / 200.0;
  }
  return rate;
}

TEST(ElasticSymmetry, TestsAndIntervalsOnIndependentNoise) {
  Recipe recipe;
  recipe.realizations = 20;
  recipe.stress_noise = 100;
  const Rates r = rates(recipe);
  EXPECT_NEAR(r.samples, 0.05, 0.045);      // three standard deviations of 200 trials
  EXPECT_NEAR(r.realizations, 0.07, 0.06);  // the bootstrap is somewhat narrow at 20
  EXPECT_NEAR(r.aicc, 0.135, 0.08);         // chance that chi-squared of 2 exceeds 4
  for (const double held : {r.ratio_held, r.c66_held}) {
    EXPECT_GE(held, 0.88);
    EXPECT_LE(held, 0.99);
  }
  recipe.c = [](const Eigen::Vector2d&) { return Eigen::Vector4d(4e6, 3e6, 1e6, 1e6); };
  const Rates o = rates(recipe);
  EXPECT_GT(o.samples, 0.95);
  EXPECT_GT(o.realizations, 0.95);
  EXPECT_GE(o.ratio_held, 0.88);
  EXPECT_LE(o.ratio_held, 0.99);
}

// Every point of a realization shows the same noise and nearly the same strain: the test that
// counts samples cries wolf, the one that counts realizations does not.
TEST(ElasticSymmetry, CorrelatedPointsFoolOnlyTheTestBySamples) {
  int samples = 0, realizations = 0;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    Recipe recipe;
    recipe.points = Eigen::MatrixXd::Zero(1, 2);
    recipe.realizations = 20;
    recipe.stress_noise = 100;
    Increments data = make_increments(100 + trial, recipe);
    data.points = grid_points(0, 1, 15, 0, 1, 1);
    for (Eigen::MatrixX3d& m : data.stress) m = m.replicate(15, 1).eval();
    for (Eigen::MatrixX3d& m : data.strain) m = m.replicate(15, 1).eval();
    const SymmetryFit f = fit_symmetry(data, everywhere(data.points), few_draws(200));
    samples += f.p_samples < 0.05;
    realizations += f.p_realizations < 0.05;
  }
  EXPECT_GT(samples, 100);
  EXPECT_LT(realizations, 40);
}

TEST(ElasticSymmetry, WhatCannotBeToldApartIsNan) {
  Recipe recipe;
  recipe.realizations = 5;
  Increments data = make_increments(3, recipe);
  for (Eigen::MatrixX3d& e : data.strain) e.col(2).setZero();
  SymmetryFit f = fit_symmetry(data, everywhere(data.points), few_draws());
  EXPECT_TRUE(std::isnan(f.c66.value) && std::isnan(f.c11.value) && std::isnan(f.p_samples));
  EXPECT_FALSE(std::isnan(f.bulk.value) || std::isnan(f.shear.value));
  EXPECT_FALSE(f.isotropy_holds());
  EXPECT_EQ(f.note,
            "the strains do not tell C11, C22, C12 and C66 apart (condition inf): isotropy is not "
            "tested");
  for (Eigen::MatrixX3d& e : data.strain) e.setConstant(NAN);
  f = fit_symmetry(data, everywhere(data.points), few_draws());
  EXPECT_EQ(f.note, "no point with both stress and strain: no constants");
  recipe.realizations = 3;
  data = make_increments(3, recipe);
  EXPECT_TRUE(std::isnan(fit_symmetry(data, everywhere(data.points), few_draws()).p_realizations));
}

// Lattice of points joined by springs of stiffness k, without forces, and the same after an affine
// displacement, with the springs' forces.
struct SpringLattice {
  dem::Snapshot before;
  explicit SpringLattice(bool triangular) {
    const double a = 0.01, height = triangular ? a * std::sqrt(3) / 2 : a;
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x) {
        dem::Grain g;
        g.id = x + 40 * y;
        g.position = {a * (x + (triangular ? 0.5 * (y % 2) : 0)), height * y, 0};
        g.radius = a / 2;
        g.mass = g.volume = 1;
        before.grains.push_back(g);
      }
    for (std::size_t i = 0; i < before.grains.size(); ++i)
      for (std::size_t j = i + 1; j < std::min(i + 45, before.grains.size()); ++j) {
        const dem::Vec3 branch = before.grains[j].position - before.grains[i].position;
        if (branch.norm() > 1.01 * a) continue;
        dem::Contact c;
        c.i = static_cast<std::int64_t>(i);
        c.j = static_cast<std::int64_t>(j);
        c.point = before.grains[i].position + branch / 2;
        c.normal = branch.normalized();
        before.contacts.push_back(c);
      }
  }
  dem::Snapshot after(const Eigen::Matrix2d& gradient, double k) const {
    dem::Snapshot s = before;
    for (dem::Grain& g : s.grains) g.position.head<2>() += gradient * g.position.head<2>();
    for (dem::Contact& c : s.contacts) {
      const dem::Vec3 branch = before.grains[static_cast<std::size_t>(c.j)].position -
                               before.grains[static_cast<std::size_t>(c.i)].position;
      const Eigen::Vector2d relative = gradient * branch.head<2>();
      c.force = k * relative.dot(c.normal.head<2>()) * c.normal;  // extension pulls i towards j
    }
    return s;
  }
};

Increments from_grains(const SpringLattice& lattice, double k) {
  dem::Random random(4);
  Increments data;
  AverageOptions average;
  average.width = 0.05;
  StrainOptions measure;
  measure.width = 0.05;
  const Eigen::MatrixXd points = grid_points(0.15, 0.25, 3, 0.15, 0.2, 2);
  for (int r = 0; r < 6; ++r) {
    Eigen::Matrix2d g;
    for (double& v : g.reshaped()) v = 1e-7 * random.uniform(-1, 1);
    const dem::Snapshot after = lattice.after(g, k);
    data.add(response(lattice.before, after, points, average),
             strain(lattice.before, after, points, measure).field);
  }
  return data;
}

// Triangular lattice of central springs: lambda = G = sqrt(3) k/4, K = 2 G, so nu = 1/4.
TEST(ElasticSymmetry, TriangularSpringLatticeIsIsotropic) {
  const Increments data = from_grains(SpringLattice(true), 1e6);
  const double g = std::sqrt(3) * 1e6 / 4;
  const IsotropicConstants c = isotropic_constants(data, everywhere(data.points), few_draws());
  // The kernel of ten spacings sums the lattice to some 1e-5.
  EXPECT_NEAR(c.shear.value / g, 1, 1e-3);
  EXPECT_NEAR(c.bulk.value / (2 * g), 1, 1e-3);
  EXPECT_NEAR(c.poisson.value, 0.25, 1e-3);
  EXPECT_NEAR(c.young.value / (2.5 * g), 1, 1e-3);
  const SymmetryFit f = fit_symmetry(data, everywhere(data.points), few_draws());
  EXPECT_NEAR(f.normal_ratio.value, 1, 1e-3);
  EXPECT_NEAR(f.shear_ratio.value, 1, 1e-3);
  EXPECT_LT(f.residual_isotropic, 1e-3);
}

// Square lattice: C11 = C22 = k, C12 = C66 = 0. As far from isotropic as can be.
TEST(ElasticSymmetry, SquareSpringLatticeIsNot) {
  const Increments data = from_grains(SpringLattice(false), 1e6);
  const SymmetryFit f = fit_symmetry(data, everywhere(data.points), few_draws());
  EXPECT_NEAR(f.c11.value / 1e6, 1, 1e-3);
  EXPECT_NEAR(f.c22.value / 1e6, 1, 1e-3);
  EXPECT_NEAR(f.c12.value / 1e6, 0, 1e-3);
  EXPECT_NEAR(f.c66.value / 1e6, 0, 1e-3);
  EXPECT_NEAR(f.shear_ratio.value, 0, 1e-3);
  EXPECT_GT(f.residual_isotropic, 0.1);
  EXPECT_FALSE(f.isotropy_holds());
}

}  // namespace
}  // namespace grainfield::coupling
