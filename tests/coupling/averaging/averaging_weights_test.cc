// Order of the balance, cuts, normalisation, rattlers, points and error texts of averaging.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "coupling/averaging/average.h"
#include "coupling/averaging/grain_facts.h"
#include "coupling/averaging/kernel.h"
#include "coupling/averaging/region.h"
#include "coupling/averaging/weights.h"
#include "tests/coupling/averaging_scene.h"
#include "tests/refusal.h"

namespace grainfield::coupling {
namespace {

using test::layer;
using test::options;

// Second-order differences of a field whose third derivatives are bounded: order two, at the floor,
// inside and over the free surface, with both ends of the branches.
TEST(Balance, ResidualFallsWithTheSquareOfTheStep) {
  for (bool rough : {false, true})
    for (bool extend : {false, true}) {
      const dem::Snapshot s = layer(6, 10, 5, rough, 3.0);
      const LayerFrame frame = layer_frame(s);
      AverageOptions o = options("coarse_graining", "lucy", 0.02);
      o.extend_into_walls = extend;
      for (double height : {0.0, 0.5, 1.0, 1.3}) {
        const double y = frame.floor + height * frame.depth();
        double last = 0;
        for (double step : {8e-4, 4e-4, 2e-4, 1e-4}) {
          const double now =
              balance_residual(s, line_points(0, frame.right, 21, y), o, step, 2).rms;
          if (last > 0) {
            EXPECT_NEAR(std::log2(last / now), 2, 0.2) << rough << extend << " " << height;
          }
          last = now;
        }
      }
    }
}

TEST(Cuts, KernelsCarryTheSmearedWeightToTheQuadrature) {
  for (bool rough : {false, true})
    for (bool extend : {false, true}) {
      const dem::Snapshot s = layer(5, 12, 6, rough, 2.0);
      for (const std::string& kernel : kernel_names()) {
        AverageOptions o = options("coarse_graining", kernel, 0.012);
        o.extend_into_walls = extend;
        // Midpoint sums: Heaviside's chords have square-root ends and its field steps.
        const double tolerance = kernel == "lucy" ? 1e-6 : kernel == "gaussian" ? 2e-4 : 3e-3;
        for (double y : {-0.01, 0.0, 0.013, 0.031, 0.055, 0.065}) {
          const CutForce cut = cut_force(s, y, o);
          EXPECT_NEAR(cut.force, cut.weight, tolerance * test::weight(s)) << kernel << y << extend;
        }
      }
    }
}

TEST(Cuts, WeightAboveIsThatOfTheParts) {
  dem::Snapshot s;
  s.gravity = {0, -10, 0};
  test::add_wall(s, "floor", {0, 0, 0}, {0, 1, 0});
  s.grains.push_back(test::disk(0, 0, 1, 1));
  dem::Grain square = test::disk(1, 5, 1, std::sqrt(2.));
  square.outline = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  square.angle = std::numbers::pi / 4;
  square.mass = 7;
  s.grains.push_back(square);
  const double disk = s.grains[0].mass * 10;
  EXPECT_NEAR(weight_above(s, -1), disk + 70, 1e-9);
  EXPECT_NEAR(weight_above(s, 1), (disk + 70) / 2, 1e-9);
  // Above 1/2 of the disk's radius: a segment of 120 degrees; of the diamond a corner.
  const double corner = (std::sqrt(2.) - 0.5) * (std::sqrt(2.) - 0.5) / 4;
  EXPECT_NEAR(weight_above(s, 1.5),
              disk * (1. / 3 - std::sqrt(3.) / (4 * std::numbers::pi)) + 70 * corner, 1e-9);
  EXPECT_EQ(weight_above(s, 3), 0);
}

// Columns of disks that get lower to both sides: at the feet of the heap elements lie all but
// outside it, where their area inside is rounding.
TEST(Cuts, EndsOfAHeapSpoilNothing) {
  const double d = 0.01;
  dem::Snapshot s;
  s.gravity = {0, -10, 0};
  test::add_wall(s, "floor", {0, 0, 0}, {0, 1, 0});
  const int columns = 41;
  for (int c = 0; c < columns; ++c) {
    const int high = 1 + std::min(c, columns - 1 - c);
    const double x = c * d + 0.0007 * std::sin(c);
    const auto first = static_cast<std::int64_t>(s.grains.size());
    for (int r = 0; r < high; ++r) {
      s.grains.push_back(test::disk(first + r, x, (r + 0.5) * d, d / 2));
      dem::Contact touch;
      touch.i = r == 0 ? first : first + r - 1;
      touch.j = r == 0 ? -1 : first + r;
      touch.point = {x, r * d, 0};
      touch.normal = {0, r == 0 ? -1. : 1., 0};
      touch.force = -touch.normal * 10 * s.grains.back().mass * (high - r);
      s.contacts.push_back(touch);
    }
  }
  for (const char* method : {"particle_centre", "area_exact"})
    for (const std::string& kernel : support_names())
      for (double width : {2., 2.5, 3.})
        for (int k = 0; k < 10; ++k) {
          const CutForce cut = cut_force(s, 2 * k * d, options(method, kernel, width * d), 0.1 * d);
          EXPECT_GT(cut.weight, 0) << method << kernel << width << k;
          EXPECT_LT(cut.weight, 1.5 * test::weight(s)) << method << kernel << width << k;
        }
}

TEST(Averaging, EveryMethodGivesTheSameBitsOnAnyNumberOfThreads) {
  const dem::Snapshot s = layer(10);
  const Eigen::MatrixXd points = grid_points(-0.01, 0.13, 29, -0.01, 0.08, 17);
  for (const Method& method : methods())
    for (const std::string& kernel : method.kernels()) {
      AverageOptions o = options(method.name, kernel, 0.015);
      o.free_surface = "normalised";
      const Field one = average(s, points, o);
      for (int threads : {2, 3, 8}) {
        o.threads = threads;
        const Field many = average(s, points, o);
        for (std::size_t c = 0; c < one.columns.size(); ++c)
          for (Eigen::Index p = 0; p < points.rows(); ++p) {
            const double a = one.columns[c].value[p], b = many.columns[c].value[p];
            ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << one.columns[c].name;
          }
      }
    }
}

TEST(Averaging, NormalisedFieldsKeepTheirValuesUpToTheSurface) {
  // A dense lattice under one stress in every bond, open above.
  const double d = 0.002;
  const int n = 40;
  dem::Snapshot s;
  test::add_wall(s, "floor", {0, -d / 2, 0}, {0, 1, 0});
  test::add_wall(s, "left", {-d / 2, 0, 0}, {1, 0, 0});
  test::add_wall(s, "right", {(n - 0.5) * d, 0, 0}, {-1, 0, 0});
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      s.grains.push_back(test::disk(x + n * y, x * d, y * d, d / 2));
      const auto touch = [&](std::int64_t j, dem::Vec3 normal) {
        dem::Contact c;
        c.i = x + n * y;
        c.j = j;
        c.normal = normal;
        c.point = s.grains.back().position + normal * d / 2;
        c.force = -100 * d * normal;
        s.contacts.push_back(c);
      };
      if (y == 0) touch(-1, {0, -1, 0});
      if (x == 0) touch(-2, {-1, 0, 0});
      touch(x + 1 < n ? x + 1 + n * y : -3, {1, 0, 0});
      if (y + 1 < n) touch(x + n * (y + 1), {0, 1, 0});
    }
  const double top = (n - 0.5) * d;
  const Eigen::MatrixXd points = line_points(0, (n - 1) * d, 7, top - d / 4);
  AverageOptions o = options("coarse_graining", "lucy", 4 * d);
  const Field open = average(s, points, o);
  o.free_surface = "normalised";
  const Field kept = average(s, points, o);
  for (Eigen::Index p = 0; p < 7; ++p) {
    EXPECT_NEAR(open.find("volume_fraction")->value[p] / (std::numbers::pi / 4),
                p == 0 || p == 6 ? 0.27 : 0.5, 0.06);
    EXPECT_NEAR(kept.find("volume_fraction")->value[p], std::numbers::pi / 4, 0.02);
    EXPECT_NEAR(open.find("sigma_xx")->value[p], -50, 6);
    EXPECT_NEAR(kept.find("sigma_xx")->value[p], -100, 4);
  }
}

TEST(Rattlers, AreTakenAwayOneAfterTheOther) {
  // 0 and 1 lean on the floor and on each other; 2 hangs on 1, 3 on 2; 4 touches with no force.
  dem::Snapshot s;
  test::add_wall(s, "floor", {0, 0, 0}, {0, 1, 0});
  for (int k = 0; k < 5; ++k) s.grains.push_back(test::disk(k, k, 0.5, 0.5));
  const auto touch = [&](std::int64_t i, std::int64_t j, double force) {
    dem::Contact c;
    c.i = i;
    c.j = j;
    c.point = {static_cast<double>(i) + 0.5, 0.5, 0};
    if (j < 0) c.point = {static_cast<double>(i), 0, 0};
    c.normal = {1, 0, 0};
    c.force = {-force, 0, 0};
    s.contacts.push_back(c);
  };
  touch(0, -1, 1);
  touch(0, 1, 1);
  touch(1, -1, 1);
  touch(1, 2, 1);
  touch(2, 3, 1);
  touch(3, 4, 0);
  EXPECT_EQ(rattlers(s), (std::vector<bool>{false, false, true, true, true}));
  const auto facts = grain_facts(s);
  EXPECT_EQ(facts[1].contacts, 3);
  EXPECT_EQ(facts[1].bearing_contacts, 2);
  EXPECT_EQ(facts[3].contacts, 2);
  EXPECT_EQ(facts[3].bearing_contacts, 0);
  const Field f = average(s, line_points(2, 2, 1, 0.5), options("particle_centre", "circle", 3));
  EXPECT_NEAR(f.find("coordination")->value[0], 10. / 5, 1e-12);
  EXPECT_NEAR(f.find("coordination_bearing")->value[0], 4. / 2, 1e-12);
  EXPECT_NEAR(f.find("rattlers")->value[0], 0.6, 1e-12);
  s.grains[2].fixed = true;  // part of the apparatus: it supports
  EXPECT_EQ(rattlers(s), (std::vector<bool>{false, false, false, true, true}));
  s.grains[2].fixed = false;
  s.loaded_grain = 2;  // an applied force supports as well
  s.applied_force = {0, -1, 0};
  EXPECT_EQ(rattlers(s), (std::vector<bool>{false, false, false, true, true}));
}

TEST(Averaging, NamesPointsWithTooFewGrains) {
  const dem::Snapshot s = layer(11);
  AverageOptions o = options("particle_centre", "circle", 0.008);
  o.least_grains = 3;
  Gaps gaps;
  const Eigen::MatrixXd points = grid_points(0.02, 0.1, 5, 0.03, 0.5, 2);
  const Field f = average(s, points, o, &gaps);
  EXPECT_EQ(gaps.points, 10);
  EXPECT_EQ(gaps.outside.size(), 5u);  // the upper row is far above the packing
  for (const auto& [p, grains] : gaps.few_grains) {
    EXPECT_LT(grains, 3);
    EXPECT_TRUE(std::isnan(f.find("sigma_xx")->value[p]));
    EXPECT_EQ(f.find("grains")->value[p], grains);
  }
  Gaps known;
  known.points = 10;
  known.least_grains = 3;
  for (Eigen::Index p : {1, 2, 4, 5}) known.few_grains[p] = static_cast<double>(p) / 2;
  known.outside[9] = 1;
  EXPECT_EQ(known.text(points),
            "4 of 10 points have fewer than 3 grains in the averaging volume and are nan: (0.04 "
            "0.03) with 0.5, (0.06 0.03) with 1, (0.1 0.03) with 2, ...; a larger width takes in "
            "more\n1 of 10 points have less than a tenth of the averaging volume inside the "
            "packing and are nan: (0.1 0.5)");
  // In the air beside a heap no width helps: such points are counted, not named.
  known.few_grains[6] = known.few_grains[7] = 0;
  EXPECT_THAT(
      known.text(points),
      ::testing::AllOf(
          ::testing::HasSubstr("4 of 8 points within the packing have fewer than 3 grains"),
          ::testing::HasSubstr("\n2 of 10 points lie outside the packing, without a grain in "
                               "the averaging volume, and are nan\n")));
  known.few_grains.erase(6);
  known.few_grains.erase(7);
  Gaps both = gaps;
  both.add(known);
  EXPECT_EQ(both.few_grains.at(1),
            std::min(0.5, gaps.few_grains.count(1) ? gaps.few_grains.at(1) : 9));
  EXPECT_EQ(Gaps{}.text(points), "");
}

TEST(Averaging, OnlyTheChosenQuantities) {
  const dem::Snapshot s = layer(2);
  AverageOptions o = options("coarse_graining", "lucy", 0.01);
  o.quantities = {"fabric", "density"};
  const Eigen::MatrixXd points = grid_points(0, 0.12, 5, 0, 0.06, 4);
  const Field few = average(s, points, o);
  ASSERT_EQ(few.columns.size(), 4u);
  EXPECT_EQ(few.columns[0].name, "density");
  o.quantities.clear();
  const Field all = average(s, points, o);
  for (const Column& column : few.columns) EXPECT_EQ(column.value, all.find(column.name)->value);
  EXPECT_EQ(all.columns.back().name, "grains");
}

TEST(Averaging, RefusesWithOneLineWhatItCannotDo) {
  dem::Snapshot s = layer(2);
  const Eigen::MatrixXd p = line_points(0, 1, 2, 0);
  AverageOptions o = options("area_exact", "lucy", 1);
  EXPECT_EQ(refusal_of([&] { average(s, p, o); }),
            "unknown kernel of area_exact \"lucy\"; known: circle, square; did you mean "
            "\"circle\"?");
  o.kernel = "circle";
  o.free_surface = "closed";
  EXPECT_EQ(refusal_of([&] { average(s, p, o); }),
            "unknown free surface \"closed\"; known: open, normalised; did you mean \"open\"?");
  o.free_surface = "open";
  o.quantities = {"fabrik"};
  const std::string text = refusal_of([&] { average(s, p, o); });
  EXPECT_EQ(text.substr(0, 44), "unknown quantity \"fabrik\"; known: sigma, sig");
  EXPECT_NE(text.find("did you mean \"fabric\"?"), std::string::npos);
  o.quantities.clear();
  EXPECT_EQ(refusal_of([&] { balance_residual(s, p, o, 0.1, 3); }),
            "differences of order 3 for the balance; known: 2, 4");
  EXPECT_EQ(refusal_of([&] { cut_points(0, 1, 3, {}); }), "horizontal cuts without heights");
  dem::Snapshot flat = layer(2, 12, 2);
  AverageOptions one;
  one.width = 1;
  EXPECT_EQ(refusal_of([&] { balance_table(flat, one); }),
            "the packing is nowhere four mean diameters high; too low to compare averagings on "
            "(without --balance it is averaged all the same)");
}

TEST(Points, HorizontalCuts) {
  const Eigen::MatrixXd cuts = cut_points(0, 1, 3, {0.5, 2});
  ASSERT_EQ(cuts.rows(), 6);
  EXPECT_EQ(cuts(1, 0), 0.5);
  EXPECT_EQ(cuts(4, 1), 2);
}

}  // namespace
}  // namespace grainfield::coupling
