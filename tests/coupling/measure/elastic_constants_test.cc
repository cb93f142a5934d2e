// Isotropic constants: Roul's formulas, exact and noisy data, what is undefined.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "continuum/elastic_field.h"
#include "coupling/elastic_constants/constants.h"
#include "coupling/elastic_constants/elastic_map.h"
#include "tests/coupling/elastic_scene.h"

namespace grainfield::coupling {
namespace {

using test::make_increments;
using test::Recipe;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

ElasticOptions few_draws() {
  ElasticOptions o;
  o.bootstrap.resamples = 50;
  return o;
}

// One sample: the printed formulas (Roul 3.16 to 3.19), whatever the numbers are.
TEST(ElasticConstants, OneSampleGivesRoulsFormulas) {
  dem::Random random(1);
  for (int trial = 0; trial < 1000; ++trial) {
    const Eigen::Vector3d s = test::random_tensor(random, 100),
                          e = test::random_tensor(random, 1e-4);
    Increments one;
    one.points = Eigen::MatrixXd::Zero(1, 2);
    one.stress.push_back(s.transpose());
    one.strain.push_back(e.transpose());
    const IsotropicConstants c = isotropic_constants(one, everywhere(one.points), few_draws());
    const double k = 0.5 * (s[0] + s[1]) / (e[0] + e[1]);
    const double g = 0.5 * ((s[0] - s[1]) * (e[0] - e[1]) + 4 * s[2] * e[2]) /
                     (std::pow(e[0] - e[1], 2) + 4 * e[2] * e[2]);
    EXPECT_NEAR(c.bulk.value, k, 1e-12 * std::abs(k));
    EXPECT_NEAR(c.shear.value, g, 1e-9 * std::abs(g) + 1e-6);
    EXPECT_NEAR(c.young.value, 3 * g - g * g / k, 1e-8 * std::abs(3 * g - g * g / k) + 1e-5);
    EXPECT_NEAR(c.poisson.value, 0.5 * (1 - g / k), 1e-9 * (1 + std::abs(g / k)));
    EXPECT_TRUE(std::isnan(c.bulk.low) && std::isnan(c.bulk.error));
    EXPECT_EQ(c.note.empty(), k > 0 && g > 0 && g < 3 * k);
  }
}

TEST(ElasticConstants, ExactDataComeBackToRoundOff) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    dem::Random random(seed);
    const double k = std::pow(10, random.uniform(4, 8)), g = k * random.uniform(0.05, 2.9);
    Recipe recipe;
    recipe.c = [&](const Eigen::Vector2d&) { return test::isotropic(k, g); };
    recipe.realizations = 3;
    const Increments data = make_increments(seed, recipe);
    const IsotropicConstants c = isotropic_constants(data, everywhere(data.points), few_draws());
    EXPECT_NEAR(c.bulk.value / k, 1, 1e-12);
    EXPECT_NEAR(c.shear.value / g, 1, 1e-12);
    EXPECT_NEAR(c.young.value / (3 * g - g * g / k), 1, 1e-10);
    EXPECT_NEAR(c.poisson.value, (1 - g / k) / 2, 1e-11);
    EXPECT_NEAR(c.bulk_share, 1, 1e-12);
    EXPECT_NEAR(c.shear_share, 1, 1e-12);
    EXPECT_LT(c.bulk.error / k, 1e-12);
    EXPECT_NEAR(c.bulk.low / k, 1, 1e-12);
    EXPECT_EQ(c.samples, 36);
    EXPECT_EQ(c.realizations, 3);
    EXPECT_EQ(c.note, "");
  }
}

TEST(ElasticConstants, IntervalsOfNoisyDataHoldTheTruth) {
  Recipe recipe;
  recipe.realizations = 25;
  recipe.stress_noise = 100;  // a third of the stress
  recipe.shared = true;       // points of a realization are not independent
  const double k = 2e6, g = 1e6, truth[] = {k, g, 3 * g - g * g / k, (1 - g / k) / 2};
  for (const char* interval : {"bca", "percentile"}) {
    int held[4] = {};
    for (std::uint64_t trial = 0; trial < 200; ++trial) {
      const Increments data = make_increments(500 + trial, recipe);
      ElasticOptions o;
      o.bootstrap.interval = interval;
      o.bootstrap.resamples = 500;
      o.bootstrap.seed = trial;
      const IsotropicConstants c = isotropic_constants(data, everywhere(data.points), o);
      const Constant* fitted[] = {&c.bulk, &c.shear, &c.young, &c.poisson};
      for (int i = 0; i < 4; ++i) {
        held[i] += fitted[i]->low <= truth[i] && truth[i] <= fitted[i]->high;
        EXPECT_LT(fitted[i]->low, fitted[i]->high);
      }
      EXPECT_NEAR(c.bulk.value, k, 6 * c.bulk.error);
    }
    for (const int count : held) {
      EXPECT_GE(count, 0.88 * 200) << interval;
      EXPECT_LE(count, 0.99 * 200) << interval;
    }
  }
}

// Noise of the strain with variance 1/4 of the strain's own: constants fall to 1/(1 + 1/4); K over
// its share, the fit of strain to stress, is right for noise of the strain alone.
TEST(ElasticConstants, NoiseOfTheStrainLowersConstants) {
  Recipe recipe;
  recipe.points = grid_points(0, 1, 40, 0, 1, 40);
  Increments exact = make_increments(3, recipe), noisy = exact;
  noisy.stress.clear();
  noisy.strain.clear();
  dem::Random random(9);
  for (int r = 0; r < 16; ++r) {
    noisy.stress.push_back(exact.stress[0]);
    noisy.strain.push_back(exact.strain[0]);
    for (Eigen::Index p = 0; p < exact.points.rows(); ++p)
      noisy.strain.back().row(p) += test::random_tensor(random, 0.5e-4).transpose();
  }
  const IsotropicConstants pooled =
      isotropic_constants(noisy, everywhere(noisy.points), few_draws());
  // 1600 strains: their own spread makes the ratio of variances vary by 1/sqrt(800) = 3.5 %.
  EXPECT_NEAR(pooled.bulk.value / 2e6, 1 / 1.25, 0.02);
  EXPECT_NEAR(pooled.shear.value / 1e6, 1 / 1.25, 0.02);
  EXPECT_NEAR(pooled.bulk_share, 1 / 1.25, 0.02);
  EXPECT_NEAR(pooled.bulk.value / pooled.bulk_share / 2e6, 1, 0.02);
}

TEST(ElasticConstants, WhatIsUndefinedIsNanWithANote) {
  Recipe recipe;
  recipe.realizations = 2;
  const Increments data = make_increments(5, recipe);
  const auto with = [&](const std::function<void(Eigen::MatrixX3d&)>& change) {
    Increments changed = data;
    for (Eigen::MatrixX3d& e : changed.strain) change(e);
    return isotropic_constants(changed, everywhere(changed.points), few_draws());
  };
  const IsotropicConstants pressure = with([](Eigen::MatrixX3d& e) {
    e.col(1) = e.col(0);
    e.col(2).setZero();
  });
  EXPECT_EQ(pressure.note, "no shear: G, E and nu are undefined");
  EXPECT_FALSE(std::isnan(pressure.bulk.value));
  EXPECT_TRUE(std::isnan(pressure.shear.value) && std::isnan(pressure.young.value) &&
              std::isnan(pressure.poisson.value) && std::isnan(pressure.shear_share));
  const IsotropicConstants shear = with([](Eigen::MatrixX3d& e) { e.col(1) = -e.col(0); });
  EXPECT_EQ(shear.note, "no change of volume: K, E and nu are undefined");
  EXPECT_FALSE(std::isnan(shear.shear.value));
  EXPECT_TRUE(std::isnan(shear.bulk.value) && std::isnan(shear.young.value));
  EXPECT_EQ(with([](Eigen::MatrixX3d& e) { e.setZero(); }).note, "no strain: no constants");
  EXPECT_EQ(with([](Eigen::MatrixX3d& e) { e.setConstant(nan); }).note,
            "no point with both stress and strain: no constants");
  EXPECT_EQ(with([](Eigen::MatrixX3d& e) { e = -e; }).note.substr(0, 3), "K -");
  EXPECT_NE(with([](Eigen::MatrixX3d& e) { e = -e; }).note.find("not a stable elastic material"),
            std::string::npos);
  // A nan at one point of one realization takes that sample away, nothing else.
  Increments hole = data;
  hole.strain[0](3, 2) = nan;
  const IsotropicConstants c = isotropic_constants(hole, everywhere(hole.points), few_draws());
  EXPECT_EQ(c.samples, 23);
  EXPECT_NEAR(c.bulk.value, 2e6, 1e-5);
}

TEST(ElasticConstants, Localities) {
  const Increments data = make_increments(6, Recipe());
  const Locality one = locality(data.points, {0.3, 0.01}, "lucy", 0);
  EXPECT_EQ(one.weights.sum(), 1);
  EXPECT_EQ(one.weights[1], 1);
  EXPECT_EQ(locality(data.points, {0, 0}, "gaussian", 0.5).weights[0], 1);
}

// What a solve is given: the numbers of the field, node by node; unstable nodes have none.
TEST(ElasticConstants, MapsReachTheSolver) {
  Field f;
  f.points = grid_points(-0.3, 0.1, 5, -0.2, 0, 3);
  f.nx = 5;
  f.ny = 3;
  for (const char* name : {"young", "poisson"}) {
    Column& column = f.add(name, "1");
    for (Eigen::Index k = 0; k < 15; ++k) {
      column.value[k] = (name[0] == 'y' ? 1e6 : 0.02) * (1 + static_cast<double>(k) / 3);
    }
    if (name[0] == 'p') column.value[7] = 0.5;
    column.error = 0.1 * column.value;
  }
  const auto file = std::filesystem::temp_directory_path() /
                    ("grainfield_elastic_map_" + std::to_string(::getpid()) + ".csv");
  std::ofstream(file) << elastic_map_text(f);
  const continuum::ElasticField map = continuum::read_elastic_field(file);
  std::filesystem::remove(file);
  for (const Eigen::Index k : {0, 4, 11, 14}) {
    const double young = f.find("young")->value[k], poisson = f.find("poisson")->value[k];
    const Eigen::Matrix3d c = map.at(f.points(k, 0), f.points(k, 1));
    // Plane strain: C66 = E/(2 (1 + nu)).
    EXPECT_NEAR(c(2, 2) / (young / (2 * (1 + poisson))), 1, 1e-12) << k;
  }
  EXPECT_THAT(elastic_map_text(f), testing::HasSubstr(",nan,nan,nan,nan\n"));
}

TEST(ElasticConstants, FieldsBecomeIncrements) {
  Field stress, strain;
  stress.points = strain.points = grid_points(0, 1, 2, 0, 1, 1);
  const auto put = [](Field& f, const char* name, double value) {
    f.add(name, "1").value.setConstant(value);
  };
  put(stress, "sigma_xx", 1);
  put(stress, "sigma_yy", 2);
  put(stress, "sigma_xy", 3);
  put(stress, "sigma_yx", 5);
  put(strain, "strain_xx", 6);
  put(strain, "strain_yy", 7);
  Increments data;
  EXPECT_EQ(refusal_of([&] { data.add(stress, strain); }),
            "the field of strain has no column \"strain_xy\"");
  EXPECT_EQ(data.realizations(), 0);
  put(strain, "strain_xy", 8);
  data.add(stress, strain);
  EXPECT_EQ(data.stress[0].row(1), Eigen::RowVector3d(1, 2, 4));
  EXPECT_EQ(data.strain[0].row(0), Eigen::RowVector3d(6, 7, 8));
  stress.points(0, 0) = 9;
  EXPECT_EQ(refusal_of([&] { data.add(stress, strain); }),
            "stress and strain are on different points (2 and 2)");
  strain.points = stress.points;
  EXPECT_EQ(refusal_of([&] { data.add(stress, strain); }),
            "realization 1 is on other points than the first one");
}

TEST(ElasticConstants, Refusals) {
  Recipe recipe;
  const Increments data = make_increments(7, recipe);
  const auto refusal =
      [&](const std::function<void(Increments&, Locality&, ElasticOptions&)>& change) {
        Increments d = data;
        Locality where = everywhere(data.points);
        ElasticOptions o = few_draws();
        change(d, where, o);
        return refusal_of([&] { isotropic_constants(d, where, o); });
      };
  EXPECT_EQ(refusal([](auto& d, auto&, auto&) { d = {}; }),
            "elastic constants need at least one realization");
  EXPECT_EQ(refusal([](auto& d, auto&, auto&) { d.strain.clear(); }),
            "1 realizations of stress, 0 of strain");
  EXPECT_EQ(refusal([](auto& d, auto&, auto&) { d.strain[0] = d.strain[0].topRows(2).eval(); }),
            "realization 0 has 12 stresses and 2 strains at 12 points");
  EXPECT_EQ(refusal([](auto&, auto& w, auto&) { w.weights = Eigen::VectorXd::Ones(3); }),
            "3 weights for 12 points");
  EXPECT_EQ(refusal([](auto&, auto& w, auto&) { w.weights[2] = -1; }),
            "a weight of the elastic fit is negative or nan");
  EXPECT_EQ(refusal([](auto&, auto&, auto& o) { o.bootstrap.level = 0; }),
            "bootstrap level is 0; it must be above 0 and below 1");
  EXPECT_EQ(refusal_of([&] {
              locality(data.points, {0, 0}, "lucky", 1);
            }),
            "unknown kernel \"lucky\"; known: lucy, gaussian, heaviside; did you mean \"lucy\"?");
  EXPECT_EQ(refusal_of([&] {
              locality(data.points, {0, 0}, "lucy", -1);
            }),
            "kernel width is -1 m; it must be positive and finite");
}

TEST(ElasticConstants, ThreadsDoNotChangeBits) {
  Recipe recipe;
  recipe.realizations = 7;
  recipe.stress_noise = 50;
  const Increments data = make_increments(8, recipe);
  ElasticOptions o;
  o.bootstrap.resamples = 333;
  const IsotropicConstants one = isotropic_constants(data, everywhere(data.points), o);
  for (const int threads : {2, 3, 8}) {
    o.bootstrap.threads = threads;
    const IsotropicConstants many = isotropic_constants(data, everywhere(data.points), o);
    EXPECT_EQ(one.young.low, many.young.low);
    EXPECT_EQ(one.poisson.error, many.poisson.error);
  }
}

}  // namespace
}  // namespace grainfield::coupling
