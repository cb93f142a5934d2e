// Elementary functions of our own against the C library's in long double.
#include "dem/space/elementary.h"

#include <gtest/gtest.h>

#include <limits>

#include "dem/random/random.h"

namespace grainfield::dem {
namespace {

TEST(Elementary, ArcSineIsThatOfTheLibrary) {
  Random random(1);
  double worst = 0;
  const auto look = [&](double x) {
    const double exact = static_cast<double>(std::asin(static_cast<long double>(x)));
    worst = std::max(worst, std::fabs(arc_sine(x) - exact));
  };
  for (const double x :
       {0.0, 1e-300, 1e-9, 0.5, std::nextafter(0.5, 1), std::nextafter(1.0, 0), 1.0}) {
    look(x);
  }
  for (int k = 0; k < 200000; ++k) {
    look(random.uniform());
    look(1 - 1e-6 * random.uniform());
  }
  EXPECT_LT(worst, 5e-16);
  EXPECT_TRUE(std::isnan(arc_sine(std::numeric_limits<double>::quiet_NaN())));
}

TEST(Elementary, ArcIsThatOfTheLibrary) {
  Random random(2);
  double worst = 0;
  const auto look = [&](double y, double x) {
    const double exact =
        static_cast<double>(std::atan2(static_cast<long double>(y), static_cast<long double>(x)));
    worst = std::max(worst, std::fabs(arc_of(y, x) - exact));
  };
  for (const double x : {-1.0, 0.0, 1.0}) look(0, x);
  look(1, 0);
  for (int k = 0; k < 200000; ++k) look(random.uniform(), random.uniform(-1, 1));
  EXPECT_LT(worst, 9e-16);
}

TEST(Elementary, CubeRootIsThatOfTheLibrary) {
  Random random(4);
  double worst = 0;
  const auto look = [&](double x) {
    const double exact = static_cast<double>(std::cbrt(static_cast<long double>(x)));
    worst = std::max(worst, std::fabs(cube_root(x) / exact - 1));
  };
  for (int k = -300; k <= 300; ++k) look(std::pow(10.0, k));
  for (int k = 0; k < 200000; ++k) look(std::ldexp(random.uniform(0.5, 1), k % 201 - 100));
  EXPECT_LT(worst, 5e-16);
  EXPECT_EQ(cube_root(0), 0);
  EXPECT_EQ(cube_root(27), 3);
}

TEST(Elementary, LogarithmIsThatOfTheLibrary) {
  Random random(3);
  double worst = 0;
  for (int k = 0; k < 200000; ++k) {
    const double x =
        k % 2 == 0 ? random.uniform() + 1e-16 : std::ldexp(random.uniform(0.5, 1), k % 90);
    const double exact = static_cast<double>(std::log(static_cast<long double>(x)));
    worst = std::max(worst, std::fabs(natural_log(x) - exact) / std::max(1.0, std::fabs(exact)));
  }
  EXPECT_LT(worst, 3e-16);
  EXPECT_EQ(natural_log(1), 0);
}

TEST(Elementary, ExponentialIsThatOfTheLibrary) {
  Random random(6);
  double worst = 0;
  const auto look = [&](double x) {
    const double exact = static_cast<double>(std::exp(static_cast<long double>(x)));
    worst = std::max(worst, std::fabs(exponential(x) / exact - 1));
  };
  for (const double x : {0.0, 1e-300, -1e-17, 0.5 * std::numbers::ln2, 709.0, -707.9}) look(x);
  for (int k = 0; k < 200000; ++k) {
    look(random.uniform(-700, 700));
    look(random.uniform(-2, 2));
  }
  EXPECT_LT(worst, 5e-16);
  EXPECT_EQ(exponential(0), 1);
  EXPECT_EQ(exponential(-1e9), 0);
  EXPECT_EQ(exponential(1e9), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(exponential(std::numeric_limits<double>::quiet_NaN())));
}

TEST(Elementary, LogGammaIsThatOfTheLibrary) {
  Random random(7);
  double worst = 0;
  const auto look = [&](double x) {
    const double exact = static_cast<double>(std::lgamma(static_cast<long double>(x)));
    worst = std::max(worst, std::fabs(log_gamma(x) - exact) / std::max(1.0, std::fabs(exact)));
  };
  for (const double x : {1e-9, 0.05, 0.5, 1.0, 1.5, 2.0, 12.0, 1e6}) look(x);
  for (int k = 0; k < 100000; ++k) look(random.uniform(0, 40));
  EXPECT_LT(worst, 1.2e-14);  // terms of up to 20 cancel
  EXPECT_NEAR(beta(2, 3), 1.0 / 12, 1e-15);
}

}  // namespace
}  // namespace grainfield::dem
