// Oriented stress linearity: closure, the two ways to write it, its named members, layers.
#include "continuum/closed/osl.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "continuum/closed/osl_layer.h"
#include "continuum/model.h"
#include "tests/continuum/heap_scene.h"
#include "tests/continuum/refused_model.h"

using namespace grainfield::continuum;
using namespace grainfield::continuum::testing;
using grainfield::dem::Random;
using ::testing::HasSubstr;

namespace {

constexpr double kRounding = 1e-12;

const SectorField& field_of(const std::unique_ptr<Model>& model) {
  return dynamic_cast<const SectorField&>(dynamic_cast<const HeapModel&>(*model).field());
}

// Largest difference of coefficients.
double distance(const SectorField& a, const SectorField& b) {
  double out = 0;
  for (std::size_t r = 0; r < a.regions().size(); ++r) {
    out = std::max(out, (a.linear(r) - b.linear(r)).cwiseAbs().maxCoeff());
    out = std::max(out, std::fabs(a.regions()[r].from - b.regions()[r].from));
  }
  return out;
}

}  // namespace

TEST(Osl, ObeysItsClosureEverywhere) {
  Random random(1);
  for (int k = 0; k < 5000; ++k) {
    const double phi = random_phi(random), mu = random.uniform(-3, 0.95 / std::tan(phi));
    // With or without a yielding slope.
    const double eta = k % 2 == 0
                           ? eta_at_yield(phi, mu)
                           : (1 / std::tan(phi) - mu) / std::tan(phi) * random.uniform(0.01, 0.99);
    const Closure closure{eta, mu};
    const SectorField field = osl_field(phi, closure, 1);
    double size = 1;
    for (std::size_t r = 0; r < 4; ++r)
      size = std::max(size, (1 + eta) * field.linear(r).cwiseAbs().maxCoeff());
    for (std::size_t r = 0; r < 4; ++r) {
      const auto p = random_point(random, field, r);
      EXPECT_NEAR(closure_residual(closure, field.stress(p.x(), p.y()), p.x()) / p.norm(), 0,
                  kRounding * size)
          << k;
    }
    EXPECT_NEAR(std::tan(field.regions()[3].from), closure.c1(), 1e-12 * closure.c1());
    EXPECT_NEAR(closure.c1() * closure.c2(), -eta, 1e-12 * eta);
    EXPECT_NEAR(closure.c1() + closure.c2(), mu, 1e-12 * (closure.c1() - closure.c2()));
  }
}

// Roul 4.24: then, and only then, the outer region is at the limit of friction.
TEST(Osl, SlopeYieldsForConsistentConstants) {
  Random random(2);
  for (int k = 0; k < 3000; ++k) {
    const double phi = random_phi(random), mu = random.uniform(-2.5, 0.9 / std::tan(phi));
    const double eta = eta_at_yield(phi, mu);
    EXPECT_NEAR(mu_at_yield(phi, eta), mu, 1e-11);
    const SectorField field = osl_field(phi, {eta, mu}, 1);
    const auto p = random_point(random, field, 3);
    EXPECT_NEAR(yield_residual(field.stress(p.x(), p.y()), phi), 0, kRounding * p.squaredNorm());
    const SectorField other = osl_field(phi, {0.97 * eta, mu}, 1);
    EXPECT_GT(std::fabs(yield_residual(other.linear(3).col(1), phi)), 1e-6);
    // At the slope the ratio of shear to vertical stress is eta0 tan(phi) (Roul 4.21).
    const double t = std::tan(phi);
    EXPECT_NEAR(-field.linear(3)(2, 1) / field.linear(3)(1, 1), t / (1 + 2 * t * t), 1e-12);
  }
}

TEST(Osl, RatioAndClosureRoundTrip) {
  Random random(3);
  for (int k = 0; k < 5000; ++k) {
    const Closure closure{std::exp(random.uniform(-4, 2)), random.uniform(-4, 4)};
    const StressRatio ratio = ratio_of(closure);
    EXPECT_GT(ratio.tau, std::numbers::pi / 4);
    EXPECT_LT(ratio.tau, 3 * std::numbers::pi / 4);
    if (closure.eta < 1) {
      EXPECT_GE(ratio.K, 1 - 1e-12);
    }
    // Both descriptions give the closure back.
    for (const StressRatio& same :
         {ratio, StressRatio{1 / ratio.K, ratio.tau - std::numbers::pi / 2}}) {
      const Closure back = closure_of(same);
      EXPECT_NEAR(back.eta, closure.eta, 1e-10 * (1 + closure.eta)) << k;
      EXPECT_NEAR(back.mu, closure.mu, 1e-10 * (1 + std::fabs(closure.mu))) << k;
    }
    // Wittmer's formula for K.
    const double q =
        1 + 2 * std::pow(1 - closure.eta, 2) / (closure.mu * closure.mu + 4 * closure.eta);
    EXPECT_NEAR(ratio.K + 1 / ratio.K, 2 * q, 1e-9 * q);
  }
}

// What K and tau mean: the normal stresses on the two directions, in a field of the closure.
TEST(Osl, RatioIsThatOfTheNormalStresses) {
  Random random(4);
  for (int k = 0; k < 2000; ++k) {
    const double phi = random_phi(random), mu = random.uniform(-2, 0.9 / std::tan(phi));
    const Closure closure{eta_at_yield(phi, mu), mu};
    const SectorField field = osl_field(phi, closure, 1);
    const Eigen::Vector3d s = field.linear(2) * Eigen::Vector2d(0.3, -1);
    const StressRatio ratio = ratio_of(closure);
    // y up: n turns by tau from the x axis.
    const auto normal = [&](double angle) {
      const double c = std::cos(angle), d = std::sin(angle);
      return c * c * s[0] + d * d * s[1] + 2 * c * d * s[2];
    };
    const double nn = normal(ratio.tau), mm = normal(ratio.tau + std::numbers::pi / 2);
    EXPECT_NEAR(nn, ratio.K * mm, 1e-10 * (1 + ratio.K)) << k;
  }
}

TEST(Osl, RoulsFit) {
  const StressRatio ratio = ratio_of({0.74, -0.31});
  EXPECT_NEAR(ratio.K, 1.345, 2e-2);
  EXPECT_NEAR(ratio.tau / kDegree, 85, 0.5);
  const Closure closure = closure_of({1.345, 85 * kDegree});
  EXPECT_NEAR(closure.eta, 0.74, 5e-3);
  EXPECT_NEAR(closure.mu, -0.31, 5e-3);
  // He checked it against 4.24 at 28 degrees.
  EXPECT_NEAR(eta_at_yield(28 * kDegree, -0.31), 0.74, 5e-3);
}

TEST(Osl, MembersAreLimits) {
  for (const char* degrees : {"15", "28", "40"}) {
    const double phi = std::stod(degrees) * kDegree;
    const auto bcc = make_model("bcc", {{"phi_deg", degrees}}),
               fpa = make_model("fpa", {{"phi_deg", degrees}});
    EXPECT_LT(
        distance(field_of(bcc), field_of(make_model("osl", {{"phi_deg", degrees}, {"mu", "0"}}))),
        1e-14);
    EXPECT_LT(
        distance(field_of(fpa), field_of(make_model("osl", {{"phi_deg", degrees}, {"eta", "1"}}))),
        1e-13);
    // mu -> 0, with distances in proportion.
    const double far = distance(field_of(bcc), osl_field(phi, {eta_at_yield(phi, 1e-3), 1e-3}, 1)),
                 near = distance(field_of(bcc), osl_field(phi, {eta_at_yield(phi, 1e-4), 1e-4}, 1));
    EXPECT_NEAR(far / near, 10, 0.1);
    // BCC's plateau is that of the elastic core without a kink.
    const SectorField core = cantelaube_field(phi, core_angle(phi, CoreBranch::zero), 1);
    EXPECT_LT(distance(field_of(bcc), core), 1e-12);
  }
}

// FPA: the major axis leans by (pi/2 - phi)/2 from the vertical on all of the right half, away from
// the axis at depth; the mirror image on the left.
TEST(Osl, FpaHasFixedAxes) {
  Random random(5);
  for (int k = 0; k < 3000; ++k) {
    const double phi = random_phi(random);
    const SectorField field = osl_field(phi, {1, -2 * std::tan(phi)}, 1);
    const std::size_t region = k % 4;
    const auto p = random_point(random, field, region);
    const Eigen::Vector3d s = -field.stress(p.x(), p.y());  // compression positive
    // Angle of the major axis from the vertical; with y up it leans to the outside going up.
    const double lean = std::atan2(2 * s[2], s[1] - s[0]) / 2;
    const double expected = (std::numbers::pi / 2 - phi) / 2;
    EXPECT_NEAR(lean, region < 2 ? expected : -expected, 1e-7) << k;
  }
}

// Roul 4.4 names FPA by K = 1 and tau = (pi - phi)/2.
TEST(Osl, FpaHasRatioOne) {
  for (double degrees = 15; degrees <= 40; ++degrees) {
    const StressRatio ratio = ratio_of({1, -2 * std::tan(degrees * kDegree)});
    EXPECT_NEAR(ratio.K, 1, 1e-14);
    EXPECT_NEAR(ratio.tau / kDegree, 90 - degrees / 2, 1e-12);
  }
}

TEST(Osl, DipDeepensFromBccToFpa) {
  double before = 2;
  for (const char* mu : {"0", "-0.2", "-0.5", "-0.8", "-1.06"}) {
    const auto model = make_model("osl", {{"phi_deg", "28"}, {"mu", mu}});
    const SectorField& field = field_of(model);
    const double x = std::tan(field.regions()[3].from);
    const double ratio = field.stress(0, -1)[1] / field.stress(x, -1)[1];
    EXPECT_LE(ratio, 1 + 1e-12);
    EXPECT_LT(ratio, before);
    before = ratio;
  }
}

TEST(Osl, SettingsInEveryWay) {
  const auto both = make_model("osl", {{"eta", "0.74"}, {"mu", "-0.31"}});
  const auto figures = both->figures();
  EXPECT_EQ(figures.at("eta"), 0.74);
  EXPECT_EQ(figures.at("mu"), -0.31);
  char K[40], tau[40];
  std::snprintf(K, sizeof K, "%.17g", figures.at("K"));
  std::snprintf(tau, sizeof tau, "%.17g", figures.at("tau_deg"));
  const auto ratio = make_model("osl", {{"K", K}, {"tau_deg", tau}});
  EXPECT_LT(distance(field_of(both), field_of(ratio)), 1e-13);
  const auto half_way = make_model("osl", {{"phi_deg", "28"}});
  EXPECT_NEAR(half_way->figures().at("mu"), -std::tan(28 * kDegree), 1e-15);
}

TEST(Osl, RefusesWhatCannotBe) {
  EXPECT_THAT(refusal("osl", {{"eta", "-0.1"}}),
              HasSubstr("eta = -0.1 is out of range; allowed: above 0"));
  EXPECT_THAT(refusal("osl", {{"eta", "4"}, {"mu", "0"}}),
              HasSubstr("eta = 4, mu = 0 is outside the hyperbolic range of a heap; allowed: eta "
                        "above 0 and below cot(phi) (cot(phi) - mu) = 3.53713 at phi_deg = 28"));
  EXPECT_THAT(refusal("osl", {{"mu", "2"}}),
              HasSubstr("has no characteristic inside the heap; allowed: mu below cot(phi) = "
                        "1.88073 at phi_deg = 28"));
  EXPECT_THAT(refusal("osl", {{"K", "1.3"}}),
              HasSubstr("found K; allowed: eta, mu, eta with mu, or"));
  EXPECT_THAT(refusal("osl", {{"K", "1.3"}, {"tau_deg", "80"}, {"mu", "0"}}),
              HasSubstr("allowed: eta, mu, eta with mu, or K with tau_deg"));
  EXPECT_THAT(refusal("osl", {{"K", "2"}, {"tau_deg", "45"}}), HasSubstr("model osl: eta = "));
  EXPECT_THAT(refusal("fpa", {{"mu", "0"}}), HasSubstr("fpa: no parameter 'mu'"));
  EXPECT_THAT(refusal("bcc", {{"phi_deg", "100"}}), HasSubstr("allowed: 1 to 80 deg"));
  EXPECT_THAT(refusal("ife", {{"phi_deg", "0"}}), HasSubstr("phi_deg = 0 is out of range"));
  EXPECT_THAT(refusal("ife", {{"phi_deg", "61"}}), HasSubstr("allowed: 15 to 60 deg"));
  for (const char* end : {"15", "60"}) EXPECT_EQ(refusal("ife", {{"phi_deg", end}}), "accepted");
  EXPECT_THAT(refusal("osl_layer", {{"eta", "0"}}), HasSubstr("eta = 0 is out of range"));
  EXPECT_THAT(refusal("osl_layer", {{"base", "rough"}}),
              HasSubstr("base = 'rough' is not one of absorbing, reflecting"));
  EXPECT_THAT(refusal("osl_layer", {{"returns", "1.5"}}), HasSubstr("whole numbers 1 to 1000"));
}

TEST(OslLayer, BalancesAndObeysItsClosure) {
  Random random(6);
  int differences = 0;
  for (int k = 0; k < 5000; ++k) {
    const Closure closure{std::exp(random.uniform(-3, 1)), random.uniform(-1, 1)};
    const double h = std::exp(random.uniform(-2, 2)), width = h * std::exp(random.uniform(-3, 1));
    const OslLayerField field(closure, 3, h, width, static_cast<int>(random.bits() % 4));
    // A point inside one of the pulses.
    const auto& pulse = field.pulses()[random.bits() % field.pulses().size()];
    const double y = -h * random.uniform(),
                 x = pulse.from - pulse.slope * y + width * random.uniform(-0.5, 0.5);
    const LinearStress g = field.gradient(x, y);
    const double size = 1e-12 * g.cwiseAbs().maxCoeff();
    EXPECT_NEAR(g(0, 0) + g(2, 1), 0, size);
    EXPECT_NEAR(g(2, 0) + g(1, 1), 0, size);
    const Eigen::Vector3d s = field.stress(x, y);
    EXPECT_NEAR(closure_residual(closure, s, 1), 0, 1e-12 * s.norm());
    // Gradients against Richardson's differences, away from where the second derivative jumps.
    const double steepest = std::max(closure.c1(), -closure.c2());
    const double d = 1e-3 * width / (1 + steepest);
    bool smooth = y + d < 0 && y - d > -h;
    for (const Pulse& other : field.pulses()) {
      const double edge = std::fabs(x - other.from + other.slope * y) - width / 2;
      smooth = smooth && std::fabs(edge) > 2e-3 * width;
    }
    if (!smooth) continue;
    ++differences;
    double largest = 0;
    for (const Pulse& other : field.pulses()) largest = std::max(largest, std::fabs(other.share));
    const double scale = 3 * largest * 40 / (width * width) * std::pow(1 + steepest, 3);
    for (int axis = 0; axis < 2; ++axis) {
      const auto difference = [&](double e) -> Eigen::Vector3d {
        const double dx = axis == 0 ? e : 0, dy = axis == 1 ? e : 0;
        return (field.stress(x + dx, y + dy) - field.stress(x - dx, y - dy)) / (2 * e);
      };
      const Eigen::Vector3d found = (4 * difference(d / 2) - difference(d)) / 3;
      EXPECT_LT((found - g.col(axis)).norm(), 1e-8 * scale) << k;
    }
  }
  EXPECT_GT(differences, 3000);
}

// The load arrives at the feet of the characteristics, all of it, at every depth; no shear above.
TEST(OslLayer, CarriesTheLoadToTwoFeet) {
  const auto model = make_model(
      "osl_layer", {{"F", "2"}, {"h", "0.5"}, {"eta", "0.64"}, {"mu", "0.3"}, {"width", "0.02"}});
  const double c1 = model->figures().at("c1"), c2 = model->figures().at("c2");
  for (const double y : {0., -0.1, -0.5}) {
    const int n = 40000;
    Points p(n, 2);
    for (int i = 0; i < n; ++i) p.row(i) << -1 + (i + 0.5) * 2. / n, y;
    const Stresses s = model->stress(p);
    EXPECT_NEAR(-s.col(1).sum() * 2 / n, 2, 1e-9);
    EXPECT_NEAR(s.col(2).sum() * 2 / n, 0, 1e-9);  // no resultant shear
    if (y == 0) {
      EXPECT_LT(s.col(2).cwiseAbs().maxCoeff(), 1e-12 * s.col(1).cwiseAbs().maxCoeff());
    }
    if (y < -0.4) {
      Eigen::Index at = 0;
      double left = 0, right = 0, left_at = 0, right_at = 0;
      for (; at < n; ++at) {
        const double f = -s(at, 1) * 2 / n;
        (p(at, 0) < 0 ? left : right) += f;
        (p(at, 0) < 0 ? left_at : right_at) += f * p(at, 0);
      }
      EXPECT_NEAR(right, 2 * -c2 / (c1 - c2), 1e-9);
      EXPECT_NEAR(left, 2 * c1 / (c1 - c2), 1e-9);
      EXPECT_NEAR(right_at / right, 0.5 * c1, 1e-9);
      EXPECT_NEAR(left_at / left, 0.5 * c2, 1e-9);
    }
  }
  Points outside(2, 2);
  outside << 0, 0.01, 0, -0.51;
  EXPECT_TRUE(model->stress(outside).array().isNaN().all());
}

// A base that bears no shear, a surface without pressure where pulses come back to it.
TEST(OslLayer, ReflectingBaseBearsNoShear) {
  Random random(7);
  for (int k = 0; k < 500; ++k) {
    const Closure closure{std::exp(random.uniform(-2, 1)), random.uniform(-0.5, 0.5)};
    const int returns = 1 + static_cast<int>(random.bits() % 4);
    const OslLayerField field(closure, 1, 1, 0.1, returns);
    double pressure = 0;
    for (const Pulse& pulse : field.pulses()) {
      const double x = pulse.from + pulse.slope + random.uniform(-0.05, 0.05);
      const Eigen::Vector3d s = field.stress(x, -1);
      EXPECT_NEAR(s[2], 0, 1e-10 * (1 + s.norm())) << k;
      pressure = std::max(pressure, -s[1]);
    }
    const OslLayerField absorbing(closure, 1, 1, 0.1, 0);
    EXPECT_EQ(absorbing.pulses().size(), 2U);
    if (returns == 1) {
      // Share |c2|/(c1 - c2) times 1 + c1/|c2|: the whole load at either foot.
      EXPECT_NEAR(-field.stress(closure.c1(), -1)[1], 20, 1e-9);
      EXPECT_NEAR(-field.stress(closure.c2(), -1)[1], 20, 1e-9);
    } else {
      const Pulse& back = field.pulses()[field.pulses()[1].slope == closure.c2() ? 2 : 1];
      EXPECT_NEAR(field.stress(back.from, 0)[1], 0, 1e-10);
    }
  }
}
