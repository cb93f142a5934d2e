// Marching in depth against exact solutions of oriented stress linearity.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "continuum/model.h"
#include "continuum/osl/march.h"
#include "tests/continuum/osl_exact.h"

using namespace grainfield::continuum;
using osl::State;

namespace {

/// Of the observed order: leading-order convergence is reached, but not exactly.
constexpr double kOrder = 0.3;

osl::Problem constant(const osl::exact::Constants& k, std::function<double(double)> weight) {
  osl::Problem p;
  p.name = "march";
  p.weight = [weight](double, double y) { return weight(y); };
  p.eta = [k](double, double) { return k.eta; };
  p.mu = [k](double, double) { return k.mu; };
  return p;
}

Eigen::MatrixXd line(double half_width, double depth, int n) {
  Eigen::MatrixXd points(n, 2);
  for (int i = 0; i < n; ++i) points.row(i) << half_width * (-1 + (2 * i + 1.) / n), depth;
  return points;
}

double rms_error(const osl::MarchResult& result, const Eigen::MatrixXd& points,
                 const osl::StateField& exact) {
  double sum = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    sum += (result.states[i] - exact(points(i, 0), points(i, 1))).squaredNorm();
  return std::sqrt(sum / static_cast<double>(points.rows()));
}

}  // namespace

TEST(OslMarch, ClosedFormOfTheHeapIsMetOnAnAlignedMesh) {
  for (const double phi_deg : {15., 28., 40.}) {
    const double tangent = std::tan(phi_deg * std::numbers::pi / 180), c = 1 / tangent;
    for (const double mu : {0., -0.31, -2 * tangent}) {
      const osl::exact::Constants k{(1 - mu * tangent) / (1 + 2 * tangent * tangent), mu};
      const Eigen::MatrixXd points = line(c, 1, 40);
      const auto result = osl::march(constant(k, [](double) { return 1; }),
                                     osl::heap_mesh(c, 1, 8, 1, k.c1()), points);
      // What the march starts with at the tip is left as a trace on the characteristic.
      EXPECT_LT(rms_error(result, points,
                          [&](double x, double y) { return osl::exact::closed_form(k, c, x, y); }),
                1e-6)
          << "phi " << phi_deg << " mu " << mu;
      EXPECT_NEAR(result.figures.at("base_force"), c, 1e-10 * c);
      EXPECT_LT(result.figures.at("force_balance"), 1e-12);
    }
  }
}

TEST(OslMarch, ThirdOrderInAHeapOfVaryingWeight) {
  const osl::exact::Constants k;
  const double c = 1.88;
  const auto p = constant(k, [](double y) { return 1 + std::cos(3 * y); });
  const osl::StateField exact = [&](double x, double y) {
    return osl::exact::heap(
        k, c, [](double d) { return d + std::sin(3 * d) / 3; }, x, y);
  };
  const Eigen::MatrixXd points = line(c, 1, 300);
  double coarse = 0;
  for (int n = 16; n <= 64; n *= 2) {
    const double fine =
        rms_error(osl::march(p, osl::heap_mesh(c, 1, n, 1, k.c1()), points), points, exact);
    std::printf("march heap n %d error %.3g order %.3f\n", n, fine, std::log2(coarse / fine));
    if (coarse > 0) {
      EXPECT_NEAR(std::log2(coarse / fine), 3, kOrder) << n;
    }
    coarse = fine;
  }
}

TEST(OslMarch, ALoadRunsDownTheCharacteristics) {
  // cos^4 has three continuous derivatives at its feet.
  const osl::exact::Constants k;
  const double width = 0.4;
  const auto pressure = [=](double x) {
    return std::abs(x) < width / 2 ? std::pow(std::cos(std::numbers::pi * x / width), 4) : 0;
  };
  auto p = constant(k, [](double) { return 0; });
  p.surface = [=](double x, double) { return State(pressure(x), 0); };
  const osl::StateField exact = [&](double x, double y) {
    return osl::exact::pulse(k, pressure, x, y);
  };
  const Eigen::MatrixXd points = line(1.2, 1, 300);
  double coarse = 0;
  for (int n = 48; n <= 192; n *= 2) {
    const auto result = osl::march(p, osl::box_mesh(1.2, 1, n, 1), points);
    const double fine = rms_error(result, points, exact);
    std::printf("march layer n %d error %.3g order %.3f\n", n, fine, std::log2(coarse / fine));
    if (coarse > 0) {
      EXPECT_GT(std::log2(coarse / fine), 2) << n;
    }
    EXPECT_LT(result.figures.at("force_balance"), 1e-12);
    EXPECT_NEAR(result.figures.at("load"), width * 3 / 8, 1e-12);
    EXPECT_LT(result.figures.at("side_force"), 1e-5);
    coarse = fine;
  }
}

TEST(OslMarch, SmoothWallsReturnTheForceAndRoughOnesCarryIt) {
  auto p = constant({0.5, 0}, [](double) { return 1; });
  p.mirrored = false;
  p.sides = osl::Sides::walls;
  const auto mesh = osl::box_mesh(0.5, 3, 50, 1);
  const auto smooth = osl::march(p, mesh, line(0.5, 3, 5));
  // Weight alone on smooth walls: hydrostatic.
  for (const State& u : smooth.states) {
    EXPECT_NEAR(u[0], 3, 1e-9);
    EXPECT_NEAR(u[1], 0, 1e-9);
  }
  EXPECT_NEAR(smooth.figures.at("side_force"), 0, 1e-12);
  p.wall_friction = 0.3;
  const auto rough = osl::march(p, mesh, line(0.5, 3, 5));
  EXPECT_GT(rough.figures.at("side_force"), 0.3);
  EXPECT_NEAR(rough.figures.at("side_force") + rough.figures.at("base_force"), 3, 1e-10);
}

TEST(OslMarch, FailuresSayWhatToChange) {
  using testing::HasSubstr;
  const osl::exact::Constants k;
  const auto p = constant(k, [](double) { return 1; });
  try {
    osl::march(p, osl::heap_mesh(2, 1, 8, 1, 0), line(1, 1, 3), {1e-9, 3});
    FAIL();
  } catch (const grainfield::ComputationFailed& e) {
    EXPECT_THAT(e.what(), HasSubstr("after 3 steps (too many); raise steps (now 3) or lower"));
  }
  const auto refusal = [&](const osl::Problem& q, const osl::StripMesh& mesh) -> std::string {
    try {
      osl::march(q, mesh, line(1, 1, 3));
    } catch (const BadParameter& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
      return e.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal(p, osl::heap_mesh(0.5, 1, 8, 1, 0)), HasSubstr("outside the heap"));
  auto elliptic = p;
  elliptic.eta = [](double, double y) { return y < 0.5 ? 0.5 : -0.5; };
  EXPECT_THAT(refusal(elliptic, osl::heap_mesh(2, 1, 8, 1, 0)),
              HasSubstr("outside the hyperbolic range; allowed: mu^2 + 4 eta above 0"));
  auto leaning = p;
  leaning.eta = [](double, double) { return -0.01; };
  EXPECT_THAT(refusal(leaning, osl::heap_mesh(2, 1, 8, 1, 0)),
              HasSubstr("both characteristics on one side of the vertical; allowed: eta above 0"));
  EXPECT_THAT(refusal(p, osl::StripMesh{{-1, 0, 0.9}, {0, 1}, 2, {}}),
              HasSubstr("the mesh does not fit the heap"));
  EXPECT_THAT(refusal(p, osl::StripMesh{{-1, 0.1, 1}, {0, 1}, 2, {}}),
              HasSubstr("no border of columns at x = 0"));
  EXPECT_THAT(refusal(p, osl::StripMesh{{-1, 0, 1}, {0.1, 1}, 2, {}}),
              HasSubstr("begins at depth 0.1; allowed: 0"));
  EXPECT_THAT(refusal(p, osl::StripMesh{{-1, 0, 0, 1}, {0, 1}, 2, {}}),
              HasSubstr("allowed: ascending"));
  EXPECT_THAT(refusal(p, osl::StripMesh{{-1, 0, 1}, {0}, 2, {}}), HasSubstr("allowed: 2 or more"));
}
