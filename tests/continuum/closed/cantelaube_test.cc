// Elastic cores between plastic flanks: the three branches, the limit of friction, two slopes.
#include "continuum/closed/cantelaube.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "continuum/model.h"
#include "tests/continuum/heap_scene.h"
#include "tests/continuum/refused_model.h"

using namespace grainfield::continuum;
using namespace grainfield::continuum::testing;
using grainfield::dem::Random;
using ::testing::HasSubstr;

namespace {

constexpr double kRounding = 1e-12;

Eigen::Vector3d on_ray(const HeapField& field, std::size_t region, double theta) {
  const Eigen::Vector2d e(std::sin(theta), -std::cos(theta));
  return field.gradient(region, e.x(), e.y()) * e;
}

}  // namespace

TEST(Cantelaube, BranchesAt28Degrees) {
  const double phi = 28 * kDegree;
  EXPECT_NEAR(core_angle(phi, CoreBranch::minus) / kDegree, 22.496, 5e-4);
  EXPECT_NEAR(core_angle(phi, CoreBranch::zero) / kDegree, 38.634, 5e-4);
  EXPECT_NEAR(core_angle(phi, CoreBranch::plus) / kDegree, 48.635, 5e-4);
}

TEST(Cantelaube, BranchesAsPrinted) {
  Random random(1);
  for (int k = 0; k < 2000; ++k) {
    const double phi = random_phi(random), beta = std::numbers::pi / 2 - phi;
    const double s = std::sin(beta), c = std::cos(beta);
    const double minus = s / std::pow(1 - c, 2) * (std::sqrt(1 + std::pow(1 - c, 2)) - 1);
    EXPECT_NEAR(std::tan(core_angle(phi, CoreBranch::minus)), minus, 1e-12);
    // Dip, plateau, peak, in this order of angles, all inside the heap.
    EXPECT_LT(core_angle(phi, CoreBranch::minus), core_angle(phi, CoreBranch::zero));
    EXPECT_LT(core_angle(phi, CoreBranch::zero), core_angle(phi, CoreBranch::plus));
    EXPECT_LT(core_angle(phi, CoreBranch::plus), beta);
    EXPECT_LT(core_constants(phi, core_angle(phi, CoreBranch::minus)).b1, 0);
    EXPECT_NEAR(core_constants(phi, core_angle(phi, CoreBranch::zero)).b1, 0, 1e-12);
    EXPECT_GT(core_constants(phi, core_angle(phi, CoreBranch::plus)).b1, 0);
  }
}

// Flanks yield everywhere, the axis on the branches minus and plus; the core stays inside the
// limit.
TEST(Cantelaube, YieldsWhereItShould) {
  Random random(2);
  for (int k = 0; k < 3000; ++k) {
    const double phi = random_phi(random);
    const auto branch = static_cast<CoreBranch>(k % 3);
    const SectorField field = cantelaube_field(phi, core_angle(phi, branch), 1);
    for (const std::size_t flank : {0, 3}) {
      const auto p = random_point(random, field, flank);
      const Eigen::Vector3d s = field.stress(p.x(), p.y());
      EXPECT_NEAR(yield_residual(s, phi), 0, kRounding * p.squaredNorm());
    }
    const double axis = yield_residual(field.stress(0, -1), phi);
    if (branch == CoreBranch::zero) {
      EXPECT_LT(axis, -1e-3);
    } else {
      EXPECT_NEAR(axis, 0, kRounding);
    }
    EXPECT_LE(field.largest_mobilised(), 1 + 1e-9);
  }
}

TEST(Cantelaube, FreeAngleIsTheBranchAtItsAngle) {
  const auto branch = make_model("cantelaube", {{"branch", "plus"}});
  const auto free = make_model("cantelaube", {{"beta_hat_deg", "48.63523"}});
  Points p(3, 2);
  p << 0.1, -1, 0.9, -1, 1.4, -1;
  EXPECT_LT((branch->stress(p) - free->stress(p)).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_NEAR(branch->figures().at("beta_hat_deg"), 48.635, 5e-4);
  EXPECT_NEAR(make_model("cantelaube", {})->figures().at("beta_hat_deg"), 22.496, 5e-4);
}

// Down to the least core allowed the coefficients are finite, and a core in tension says so.
TEST(Cantelaube, NarrowCoresAreFiniteAndSayThatTheyAreInTension) {
  for (const char* phi : {"1", "28", "80"}) {
    for (const char* beta_hat : {"1e-6", "1e-3", "0.1", "5"}) {
      const auto model = make_model("cantelaube", {{"phi_deg", phi}, {"beta_hat_deg", beta_hat}});
      const auto figures = model->figures();
      for (const char* name : {"a1", "a2", "b1"})
        EXPECT_TRUE(std::isfinite(figures.at(name))) << phi << " " << beta_hat << " " << name;
      const Stresses s = model->stress((Points(2, 2) << 0, -1, 1e-9, -1).finished());
      EXPECT_TRUE(s.allFinite()) << phi << " " << beta_hat;
      if (s.col(0).maxCoeff() > 0 || s.col(1).maxCoeff() > 0) {
        EXPECT_GT(figures.at("mobilised_sine_ratio"), 1) << phi << " " << beta_hat;
      }
    }
  }
  EXPECT_GT(make_model("cantelaube", {{"beta_hat_deg", "5"}})
                ->stress((Points(1, 2) << 0, -1).finished())(0, 1),
            0);
}

TEST(Cantelaube, RefusesWhatCannotBe) {
  EXPECT_THAT(refusal("cantelaube", {{"phi_deg", "0"}}),
              HasSubstr("phi_deg = 0 is out of range; allowed: 1 to 80 deg"));
  EXPECT_THAT(refusal("cantelaube", {{"phi_deg", "91"}}), HasSubstr("phi_deg = 91"));
  EXPECT_THAT(
      refusal("cantelaube", {{"phi_deg", "28"}, {"beta_hat_deg", "62"}}),
      HasSubstr("beta_hat_deg = 62 is not inside the heap; allowed: at least 1e-06 and below "
                "90 - phi_deg = 62 deg"));
  for (const char* narrow : {"0", "1e-300", "9e-7", "-3"})
    EXPECT_THAT(refusal("cantelaube", {{"beta_hat_deg", narrow}}),
                HasSubstr("is out of range; allowed: 1e-06 to 90 deg"));
  EXPECT_THAT(refusal("cantelaube", {{"branch", "mius"}}),
              HasSubstr("branch = 'mius' is not one of minus, zero, plus; did you mean 'minus'?"));
  EXPECT_THAT(refusal("cantelaube", {{"rho_g", "-1"}}), HasSubstr("rho_g = -1"));
}

// With equal slopes at phi the two models are one.
TEST(CantelaubeAsymmetric, GoesOverIntoTheSymmetricHeap) {
  Random random(3);
  for (int k = 0; k < 2000; ++k) {
    const double phi = random_phi(random);
    const auto branch = static_cast<CoreBranch>(k % 3);
    const SectorField symmetric = cantelaube_field(phi, core_angle(phi, branch), 1);
    const SectorField field = asymmetric_field({phi, phi, phi, true, true}, branch, 0, 1);
    for (std::size_t r = 0; r < symmetric.regions().size(); ++r) {
      const auto p = random_point(random, symmetric, r);
      EXPECT_LT((field.stress(p.x(), p.y()) - symmetric.stress(p.x(), p.y())).norm(),
                1e-11 * p.norm())
          << phi / kDegree << " " << k % 3;
    }
  }
}

// ... and does so continuously: slopes that differ by epsilon change the field by order epsilon
// (the flank's root makes it the square root of epsilon at phi itself, so stay below).
TEST(CantelaubeAsymmetric, IsContinuousInItsSlopes) {
  const double phi = 35 * kDegree, slope = 28 * kDegree;
  for (const auto branch : {CoreBranch::minus, CoreBranch::zero, CoreBranch::plus}) {
    const SectorField symmetric = asymmetric_field({phi, slope, slope, true, true}, branch, 0, 1);
    double before = 0;
    for (const double epsilon : {1e-2, 1e-3, 1e-4}) {
      const SectorField field =
          asymmetric_field({phi, slope, slope + epsilon, true, true}, branch, 0, 1);
      const double away = (field.stress(0.3, -1) - symmetric.stress(0.3, -1)).norm();
      if (before > 0) {
        EXPECT_NEAR(before / away, 10, 2);
      }
      before = away;
    }
  }
}

TEST(CantelaubeAsymmetric, MirroredSlopesGiveTheMirroredField) {
  Random random(4);
  for (int k = 0; k < 2000; ++k) {
    const AsymmetricHeap heap = random_asymmetric(random);
    const AsymmetricHeap other{heap.phi, heap.right, heap.left, true, true};
    const auto branch = static_cast<CoreBranch>(k % 3);
    const double ray = branch == CoreBranch::zero ? 0 : random_yield_ray(random, heap, branch);
    const SectorField field = asymmetric_field(heap, branch, ray, 1),
                      mirror = asymmetric_field(other, branch, -ray, 1);
    const auto p = random_point(random, field, k % 3);
    const Eigen::Vector3d a = field.stress(p.x(), p.y()), b = mirror.stress(-p.x(), p.y());
    EXPECT_LT((a - Eigen::Vector3d(b[0], b[1], -b[2])).norm(), 1e-10 * p.norm()) << k;
  }
}

TEST(CantelaubeAsymmetric, FlanksYieldAndSoDoesTheInnerRay) {
  Random random(5);
  for (int k = 0; k < 3000; ++k) {
    const AsymmetricHeap heap = random_asymmetric(random);
    const auto branch = static_cast<CoreBranch>(k % 3);
    const double ray = branch == CoreBranch::zero ? 0 : random_yield_ray(random, heap, branch);
    const SectorField field = asymmetric_field(heap, branch, ray, 1);
    const std::size_t last = field.regions().size() - 1;
    for (const std::size_t flank : {std::size_t{0}, last}) {
      const auto p = random_point(random, field, flank);
      const Eigen::Vector3d s = field.stress(p.x(), p.y());
      EXPECT_NEAR(yield_residual(s, heap.phi), 0, kRounding * p.squaredNorm());
      EXPECT_LE(std::fabs(s[0]), std::fabs(s[1]) * (1 + 1e-12));
    }
    if (branch == CoreBranch::zero) continue;
    EXPECT_EQ(field.regions()[2].from, ray);
    EXPECT_NEAR(yield_residual(on_ray(field, 1, ray), heap.phi), 0, 1e-11);
    // The pressure along the ray has its kink the right way round: a dip for minus.
    const Eigen::Vector2d e(std::sin(ray), -std::cos(ray)), n(std::cos(ray), std::sin(ray));
    const Eigen::Vector3d kink = (field.linear(2) - field.linear(1)) * n;
    const double along =
        kink[0] * e.x() * e.x() + kink[1] * e.y() * e.y() + 2 * kink[2] * e.x() * e.y();
    EXPECT_EQ(along < 0, branch == CoreBranch::minus) << k;
  }
}

// The two roots of the flank's condition: both at the limit, one and the same at slope phi.
TEST(CantelaubeAsymmetric, BothRootsOfTheFlank) {
  Random random(6);
  for (int k = 0; k < 5000; ++k) {
    const double phi = random_phi(random), alpha = phi * random.uniform(0.05, 1);
    for (const bool active : {true, false}) {
      const LinearStress field = flank_stress(phi, alpha, active);
      const Eigen::Vector3d s = field * Eigen::Vector2d(0, -1);
      EXPECT_NEAR(yield_residual(s, phi) / s.squaredNorm(), 0, 1e-12);
      EXPECT_NEAR(field(0, 0) + field(2, 1), 0, 1e-12 * s.norm());
      EXPECT_NEAR(field(2, 0) + field(1, 1), 1, 1e-12 * s.norm());
    }
    EXPECT_LE(flank_coefficient(phi, alpha, true), flank_coefficient(phi, alpha, false));
    EXPECT_NEAR(flank_coefficient(phi, phi, true), std::pow(std::cos(phi), 2), 1e-12);
    EXPECT_NEAR(flank_coefficient(phi, phi, false), std::pow(std::cos(phi), 2), 1e-12);
  }
  // A horizontal surface: Rankine's two states.
  EXPECT_NEAR(flank_coefficient(0.5, 1e-9, true), (1 - std::sin(0.5)) / (1 + std::sin(0.5)), 1e-12);
}

TEST(CantelaubeAsymmetric, UnsetSlopesAreTheFrictionAngle) {
  const auto model = make_model("cantelaube_asymmetric", {{"phi_deg", "30"}});
  const auto& field = dynamic_cast<const HeapModel&>(*model).field();
  EXPECT_NEAR(field.rays().front() / kDegree, -60, 1e-12);
  EXPECT_NEAR(field.rays().back() / kDegree, 60, 1e-12);
  EXPECT_EQ(field.regions().size(), 3U);
}

TEST(CantelaubeAsymmetric, RefusesWhatCannotBe) {
  const char* name = "cantelaube_asymmetric";
  EXPECT_THAT(refusal(name, {{"phi_deg", "28"}, {"left_deg", "31"}}),
              HasSubstr("left_deg = 31 is steeper than the friction angle; allowed: above 0 and at "
                        "most phi_deg = 28 deg"));
  EXPECT_THAT(refusal(name, {{"right_deg", "0"}}), HasSubstr("right_deg = 0 is out of range"));
  EXPECT_THAT(refusal(name, {{"branch", "minus"}, {"yield_ray_deg", "70"}}),
              HasSubstr("no core of branch minus yields on the ray yield_ray_deg = 70"));
  // Both ends of the range that the message names hold.
  const Settings two{{"branch", "minus"}, {"left_deg", "11"}, {"right_deg", "28"}};
  const AsymmetricHeap heap{28 * kDegree, 11 * kDegree, 28 * kDegree, true, true};
  const auto rays = yield_rays(heap, CoreBranch::minus);
  ASSERT_TRUE(rays);
  EXPECT_GT(rays->first, 0);
  EXPECT_TRUE(yielding_field(heap, CoreBranch::minus, rays->first, 1));
  EXPECT_TRUE(yielding_field(heap, CoreBranch::minus, rays->second, 1));
  EXPECT_FALSE(yielding_field(heap, CoreBranch::minus, rays->first - 0.001, 1));
  EXPECT_FALSE(yielding_field(heap, CoreBranch::minus, rays->second + 0.001, 1));
  char text[60];
  std::snprintf(text, sizeof text, "yield_ray_deg = 0; allowed: %.2f to %.2f deg",
                rays->first / kDegree, rays->second / kDegree);
  EXPECT_THAT(refusal(name, two), HasSubstr(text));
}
