// An affine displacement imposed on random packings comes back to round-off from every measure.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "coupling/strain/strain.h"
#include "tests/coupling/strain_scene.h"

namespace grainfield::coupling {
namespace {

using Eigen::Matrix3d;
using test::moved;
using test::random_packing;

constexpr double d = 0.01;

StrainOptions options_for(const std::string& measure, bool other_support = false) {
  StrainOptions o;
  o.measure = measure;
  o.width = measure == "kernel" ? 1.5 * d : 2.6 * d;
  o.support = measure == "kernel" ? (other_support ? "gaussian" : "lucy")
                                  : (other_support ? "square" : "circle");
  o.step = 1.1 * d;
  return o;
}

Matrix3d random_gradient(dem::Random& random, int dim) {
  Matrix3d g = Matrix3d::Zero();
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) g(i, j) = 1e-3 * random.uniform(-1, 1);
  return g;
}

Matrix3d gradient_of(const Field& f, Eigen::Index p, int dim) {
  const std::string axes = "xyz";
  Matrix3d g = Matrix3d::Zero();
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) {
      std::string name = "du_x_dx";
      name[3] = axes[static_cast<std::size_t>(i)];
      name[6] = axes[static_cast<std::size_t>(j)];
      g(i, j) = f.find(name)->value[p];
    }
  return g;
}

// Positions are near 0.1 m and displacements near 1e-4 m: their difference is known to 1e-17 m, a
// share of 1e-13 of the displacement over a grain; conditioning takes one more digit.
constexpr double round_off = 1e-3 * 1e-10;

TEST(StrainAffine, EveryMeasureReturnsItExactly) {
  int checked = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    dem::Random random(seed);
    const dem::Snapshot before = random_packing(seed, 9, 8);
    const Matrix3d g = random_gradient(random, 2);
    const dem::Vec3 shift(1e-5, -2e-5, 0);
    const dem::Snapshot after =
        moved(before, [&](const dem::Vec3& x) { return dem::Vec3(shift + g * x); });
    Eigen::MatrixXd points(3, 2);
    for (Eigen::Index k = 0; k < points.size(); ++k) points(k) = d * random.uniform(2.5, 5.5);
    for (const std::string& measure : strain_measures()) {
      const StrainResult r = strain(before, after, points, options_for(measure, seed % 2 == 0));
      for (Eigen::Index p = 0; p < points.rows(); ++p) {
        ASSERT_LT((gradient_of(r.field, p, 2) - g).norm(), round_off)
            << measure << ", seed " << seed << "\n"
            << r.report();
        const auto at = [&](const char* name) { return r.field.find(name)->value[p]; };
        EXPECT_NEAR(at("strain_xx"), g(0, 0), round_off);
        EXPECT_NEAR(at("strain_yy"), g(1, 1), round_off);
        EXPECT_NEAR(at("strain_xy"), (g(0, 1) + g(1, 0)) / 2, round_off);
        EXPECT_NEAR(at("rotation"), (g(1, 0) - g(0, 1)) / 2, round_off);
        EXPECT_TRUE(measure == "derivative" ? std::isnan(at("misfit")) : at("misfit") < 1e-9);
        EXPECT_GE(at("condition"), 1 - 1e-12);
        EXPECT_GE(at("grains"), 6);
        EXPECT_EQ(at("contacts") > 0, measure == "cambou" || measure == "liao");
        ++checked;
      }
    }
  }
  EXPECT_EQ(checked, 300 * 5 * 3);
}

TEST(StrainAffine, InThreeDimensions) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    dem::Random random(seed);
    const dem::Snapshot before = random_packing(seed, 6, 6, 3);
    const Matrix3d g = random_gradient(random, 3);
    const dem::Snapshot after = moved(before, [&](const dem::Vec3& x) { return dem::Vec3(g * x); });
    const Eigen::MatrixXd points = Eigen::MatrixXd::Constant(1, 3, 3 * d);
    for (const std::string& measure : strain_measures()) {
      if (measure == "liao") continue;
      const StrainResult r = strain(before, after, points, options_for(measure));
      EXPECT_LT((gradient_of(r.field, 0, 3) - g).norm(), round_off) << measure << r.report();
      EXPECT_NEAR(r.field.find("strain_yz")->value[0], (g(1, 2) + g(2, 1)) / 2, round_off);
      EXPECT_NEAR(r.field.find("strain_xz")->value[0], (g(0, 2) + g(2, 0)) / 2, round_off);
      EXPECT_NEAR(r.field.find("strain_xy")->value[0], (g(0, 1) + g(1, 0)) / 2, round_off);
      EXPECT_NEAR(r.field.find("rotation_x")->value[0], (g(2, 1) - g(1, 2)) / 2, round_off);
      EXPECT_NEAR(r.field.find("rotation_y")->value[0], (g(0, 2) - g(2, 0)) / 2, round_off);
      EXPECT_NEAR(r.field.find("rotation_z")->value[0], (g(1, 0) - g(0, 1)) / 2, round_off);
    }
  }
}

// Spheres that turn by the rotation of an affine motion: Liao sees the strain alone; that turn by
// more, minus the rest. Full turns do not count.
TEST(StrainAffine, LiaoInThreeDimensions) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    dem::Random random(seed);
    dem::Snapshot before = random_packing(seed, 6, 6, 3);
    const auto orient = [](dem::Grain& g, const Eigen::Quaterniond& q) {
      g.orientation = {q.w(), q.x(), q.y(), q.z()};
    };
    for (dem::Grain& g : before.grains)
      orient(g, Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1),
                                   random.uniform(-1, 1), random.uniform(0.1, 1))
                    .normalized());
    const Matrix3d g = random_gradient(random, 3), spin = (g - g.transpose()) / 2;
    for (const double more : {0.0, 1.0}) {
      dem::Snapshot after = moved(before, [&](const dem::Vec3& x) { return dem::Vec3(g * x); });
      const dem::Vec3 turn = (1 + more) * dem::Vec3(spin(2, 1), spin(0, 2), spin(1, 0));
      for (dem::Grain& grain : after.grains) {
        const auto& o = grain.orientation;
        orient(grain, Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized())) *
                          Eigen::Quaterniond(-o[0], -o[1], -o[2], -o[3]));
      }
      const Eigen::MatrixXd points = Eigen::MatrixXd::Constant(1, 3, 3 * d);
      const Matrix3d seen =
          gradient_of(strain(before, after, points, options_for("liao")).field, 0, 3);
      EXPECT_LT((seen - ((g + g.transpose()) / 2 - more * spin)).norm(), 1e-12) << seed;
    }
  }
}

// A small rigid rotation, with and without the grains turning along: the measures of centres see
// the rotation and no spin; Liao sees the rotation of centres less the spin.
TEST(StrainAffine, RigidRotationAndSpins) {
  const double angle = 1e-3;
  const auto turn_about = [&](const dem::Vec3& x) {
    return dem::Vec3(-angle * (x.y() - 0.02), angle * (x.x() - 0.03), 0);
  };
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const dem::Snapshot before = random_packing(seed, 9, 8);
    const Eigen::MatrixXd points = Eigen::MatrixXd::Constant(1, 2, 4 * d);
    for (const std::string& measure : strain_measures())
      for (const double spin : {0.0, angle, angle + 2 * std::numbers::pi}) {
        const Field f =
            strain(before, moved(before, turn_about, spin), points, options_for(measure)).field;
        const double seen = measure == "liao" && spin != 0 ? 0 : angle;
        // A full turn of 6.28 rad is subtracted: the spin is known to 1e-15.
        EXPECT_NEAR(f.find("rotation")->value[0], seen, 1e-13) << measure << " " << spin;
        for (const char* name : {"strain_xx", "strain_yy", "strain_xy"})
          EXPECT_NEAR(f.find(name)->value[0], 0, 1e-13) << measure << " " << spin;
      }
  }
}

// Grains that turn on the spot, all alike: only Liao reports it, as minus the spin.
TEST(StrainAffine, SpinsAlone) {
  const dem::Snapshot before = random_packing(3, 9, 8);
  const dem::Snapshot after = moved(
      before, [](const dem::Vec3&) { return dem::Vec3(0, 0, 0); }, 2e-3);
  const Eigen::MatrixXd points = Eigen::MatrixXd::Constant(1, 2, 4 * d);
  for (const std::string& measure : strain_measures()) {
    const Field f = strain(before, after, points, options_for(measure)).field;
    EXPECT_NEAR(f.find("rotation")->value[0], measure == "liao" ? -2e-3 : 0, 1e-14) << measure;
  }
}

// Symmetric strain plus rotation plus spins equal to it: Liao returns the strain alone.
TEST(StrainAffine, LiaoWithMatchingSpinsIsObjective) {
  dem::Random random(7);
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const dem::Snapshot before = random_packing(seed, 9, 8);
    const Matrix3d g = random_gradient(random, 2);
    const double rotation = (g(1, 0) - g(0, 1)) / 2;
    const dem::Snapshot after = moved(
        before, [&](const dem::Vec3& x) { return dem::Vec3(g * x); }, rotation);
    const Eigen::MatrixXd points = Eigen::MatrixXd::Constant(1, 2, 4 * d);
    const Matrix3d liao =
        gradient_of(strain(before, after, points, options_for("liao")).field, 0, 2);
    EXPECT_LT((liao - (g + g.transpose()) / 2).norm(), round_off);
  }
}

// What the corrections buy: without them disorder spoils an affine displacement by some per cent.
TEST(StrainAffine, PlainDifferencesErrByTheDisorder) {
  const dem::Snapshot before = random_packing(5, 12, 12);
  const dem::Snapshot after =
      moved(before, [](const dem::Vec3& x) { return dem::Vec3(1e-3 * x.x(), 0, 0); });
  const Eigen::MatrixXd points = Eigen::MatrixXd::Constant(1, 2, 6 * d);
  for (const char* measure : {"derivative", "kernel"}) {
    StrainOptions o = options_for(measure);
    o.affine_exact = false;
    const double xx = strain(before, after, points, o).field.find("strain_xx")->value[0];
    EXPECT_GT(std::abs(xx - 1e-3), 1e-6) << measure;
    EXPECT_LT(std::abs(xx - 1e-3), 4e-4) << measure;
  }
}

TEST(StrainAffine, ThreadsDoNotChangeBits) {
  const dem::Snapshot before = random_packing(11, 14, 12);
  const dem::Snapshot after = moved(
      before,
      [](const dem::Vec3& x) {
        return dem::Vec3(1e-3 * std::sin(30 * x.x()), 1e-3 * x.x() * x.y(), 0);
      },
      1e-4);
  dem::Random random(1);
  Eigen::MatrixXd points(101, 2);
  for (Eigen::Index k = 0; k < points.size(); ++k) points(k) = d * random.uniform(-2, 14);
  for (const std::string& measure : strain_measures()) {
    StrainOptions o = options_for(measure);
    const StrainResult one = strain(before, after, points, o);
    for (const int threads : {2, 3, 8, 200}) {
      o.threads = threads;
      const StrainResult many = strain(before, after, points, o);
      EXPECT_EQ(one.too_few, many.too_few);
      for (std::size_t c = 0; c < one.field.columns.size(); ++c)
        for (Eigen::Index p = 0; p < points.rows(); ++p) {
          const double a = one.field.columns[c].value[p], b = many.field.columns[c].value[p];
          EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << measure;
        }
    }
  }
}

}  // namespace
}  // namespace grainfield::coupling
