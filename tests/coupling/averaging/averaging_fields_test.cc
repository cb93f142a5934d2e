// Fields of known packings: homogeneous stress, conservation, balance, response.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "coupling/averaging/average.h"
#include "coupling/averaging/base.h"
#include "coupling/averaging/kernel.h"
#include "dem/snapshot/contact_changes.h"
#include "tests/coupling/averaging_scene.h"
#include "tests/refusal.h"

namespace grainfield::coupling {
namespace {

using test::layer;

AverageOptions coarse(const std::string& kernel, double width, bool extend = true) {
  AverageOptions o;
  o.kernel = kernel;
  o.width = width;
  o.extend_into_walls = extend;
  o.least_grains = 0;
  return o;
}

AverageOptions centre(const std::string& support, double width) {
  AverageOptions o;
  o.method = "particle_centre";
  o.kernel = support;
  o.width = width;
  o.least_grains = 0;
  return o;
}

// A square lattice under a uniform force p d on every horizontal and q d on every vertical bond:
// the stress is (-q, -p) wherever the average covers whole cells.
dem::Snapshot lattice(int n, double d, double p, double q) {
  dem::Snapshot s;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) s.grains.push_back(test::disk(x + n * y, x * d, y * d, d / 2));
  const auto bond = [&](std::int64_t i, std::int64_t j, dem::Vec3 normal, double force) {
    dem::Contact c;
    c.i = i;
    c.j = j;
    c.normal = normal;
    c.point = s.grains[static_cast<std::size_t>(i)].position + normal * d / 2;
    c.force = -force * normal;
    c.normal_force = force;
    s.contacts.push_back(c);
  };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      if (x + 1 < n) bond(x + n * y, x + 1 + n * y, {1, 0, 0}, q * d);
      if (y + 1 < n) bond(x + n * y, x + n * (y + 1), {0, 1, 0}, p * d);
    }
  return s;
}

TEST(Averaging, ParticleCentreIsExactOnALattice) {
  const double d = 0.01, p = 300, q = 120;
  const dem::Snapshot s = lattice(21, d, p, q);
  // A square of 5 x 5 whole cells around the middle grain.
  const Field f = average(s, line_points(10 * d, 10 * d, 1, 10 * d), centre("square", 2.5 * d));
  EXPECT_NEAR(f.find("sigma_xx")->value[0], -q, 1e-9 * q);
  EXPECT_NEAR(f.find("sigma_yy")->value[0], -p, 1e-9 * p);
  EXPECT_NEAR(f.find("sigma_xy")->value[0], 0, 1e-9 * p);
  EXPECT_NEAR(f.find("volume_fraction")->value[0], std::numbers::pi / 4, 1e-12);
  EXPECT_EQ(f.find("grains")->value[0], 25);
}

TEST(Averaging, CoarseGrainingIsExactOnALatticeInTheMeanOverACell) {
  // Averaged over one cell the kernel sees every bond equally: exact but for the sampling of the
  // cell, which for smooth periodic fields converges faster than any power.
  const double d = 0.01, p = 300, q = 120;
  const dem::Snapshot s = lattice(25, d, p, q);
  const int n = 8;
  const Eigen::MatrixXd cell =
      grid_points(12 * d, (13 - 1.0 / n) * d, n, 12 * d, (13 - 1.0 / n) * d, n);
  for (const char* kernel : {"lucy", "gaussian"}) {
    const Field f = average(s, cell, coarse(kernel, 1.5 * d));
    const double tolerance = kernel == std::string("lucy") ? 1e-4 : 2e-3;  // the Gaussian's cut
    EXPECT_NEAR(f.find("sigma_xx")->value.mean(), -q, tolerance * q) << kernel;
    EXPECT_NEAR(f.find("sigma_yy")->value.mean(), -p, tolerance * p) << kernel;
    EXPECT_NEAR(f.find("volume_fraction")->value.mean(), std::numbers::pi / 4, 5 * tolerance);
  }
}

// The flux of vertical force through a horizontal cut is the weight above it, smeared with the
// kernel: sum m g * (share of the kernel around the grain above the cut).
TEST(Averaging, VerticalStressCarriesTheWeightAboveEveryCut) {
  for (unsigned seed : {1u, 2u, 3u}) {
    const dem::Snapshot s = layer(seed);
    const double width = 0.012;
    const auto kernel = make_kernel("lucy", width);
    // The side walls of the scene carry vertical force too: they take it at x = 0 and the other
    // end.
    for (double cut : {0.0, 0.007, 0.02, 0.041}) {
      const double reach = 5 * kernel->range(), x0 = -reach, x1 = 0.12 + reach;
      const int n = 4000;
      AverageOptions o = coarse("lucy", width, true);
      const Field f = average(s, line_points(x0, x1, n, cut), o);
      const double flux = -f.find("sigma_yy")->value.sum() * (x1 - x0) / (n - 1);
      const auto share_above = [&](double y) {  // of a kernel centred at y
        double share = 0;
        const int m = 2000;
        for (int k = 0; k < m; ++k) {
          const double at = kernel->range() * ((k + 0.5) / m * 2 - 1);
          if (y + at > cut) share += kernel->marginal(at) * 2 * kernel->range() / m;
        }
        return share;
      };
      double expected = 0;
      for (const dem::Grain& g : s.grains) expected += 9.81 * g.mass * share_above(g.position.y());
      for (const dem::Contact& c : s.contacts)
        if (c.j == -2 || c.j == -3) expected -= c.force.y() * share_above(c.point.y());
      // Trapezoidal sum of a twice differentiable integrand with 4000 points.
      EXPECT_NEAR(flux, expected, 1e-3 * test::weight(s)) << "seed " << seed << " cut " << cut;
    }
  }
}

// Force of every wall but the floor on the grains, N.
Eigen::Vector2d side_wall_force(const dem::Snapshot& s) {
  Eigen::Vector2d sum(0, 0);
  for (const dem::Contact& c : s.contacts)
    if (c.j < 0 && s.walls[static_cast<std::size_t>(-1 - c.j)].name != "floor")
      sum += c.force.head<2>();
  return sum;
}

TEST(Averaging, FloorAndWallsCarryTheWeight) {
  for (bool rough : {false, true}) {
    const dem::Snapshot s = layer(4, 12, 6, rough);
    const double w = test::weight(s);
    EXPECT_NEAR(dem::base_force(s).y() + side_wall_force(s).y(), w, 1e-9 * w);
    EXPECT_NEAR(dem::base_force(s).x() + side_wall_force(s).x(), 0, 1e-9 * w);
    const auto kernel = make_kernel("lucy", 0.01);
    const int n = 4001;
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, -0.05, 0.17);
    const Field base = base_profile(s, x, *kernel);
    const double step = 0.22 / (n - 1);
    EXPECT_NEAR(-base.find("sigma_yy")->value.sum() * step, dem::base_force(s).y(), 1e-6 * w);
    EXPECT_NEAR(-base.find("sigma_xy")->value.sum() * step, dem::base_force(s).x(), 1e-6 * w);
  }
}

// One grain on a floor: the traction's integral over the plane is the floor's force.
TEST(Averaging, TractionIntegratesToTheFloorForce) {
  dem::Snapshot s = layer(5, 6, 3);
  const Eigen::MatrixXd grid = grid_points(-0.04, 0.1, 281, -0.04, 0.07, 221);
  const Field f = average(s, grid, coarse("lucy", 0.01, false));
  const double cell = (0.14 / 280) * (0.11 / 220);
  const double w = test::weight(s);
  EXPECT_NEAR(f.find("traction_y")->value.sum() * cell, w, 1e-4 * w);
  EXPECT_NEAR(f.find("density")->value.sum() * cell * 9.81, w, 1e-4 * w);
}

// div sigma + density g + traction + load = 0 to the order of the differences, near walls as well,
// with both treatments of the boundary, on flat and rough floors, with the applied force.
TEST(Averaging, BalanceHoldsToTheOrderOfTheDifferences) {
  for (bool rough : {false, true})
    for (bool extend : {false, true}) {
      const dem::Snapshot s = layer(6, 10, 5, rough, 3.0);
      const LayerFrame frame = layer_frame(s);
      const Eigen::MatrixXd points = grid_points(0, frame.right, 9, frame.floor, frame.surface, 7);
      const AverageOptions o = coarse("gaussian", 0.02, extend);
      const AverageOptions lucy = coarse("lucy", 0.02, extend);
      double last = 0;
      std::vector<double> orders;
      for (double step : {8e-4, 4e-4, 2e-4, 1e-4}) {
        const double now = balance_residual(s, points, lucy, step).rms;
        if (last > 0) orders.push_back(std::log2(last / now));
        last = now;
      }
      // Lucy's third derivatives jump at its edge and centre, which limits the fourth-order
      // differences to between two and three in the mean over points.
      for (double order : orders) EXPECT_GT(order, 1.8) << rough << extend;
      EXPECT_LT(last, 2e-4) << rough << extend;
      EXPECT_EQ(balance_residual(s, points, o).points, 63);
    }
}

TEST(Averaging, BalanceNeedsEveryTerm) {
  dem::Snapshot s = layer(6, 10, 5, false, 3.0);
  const Eigen::MatrixXd points = grid_points(0, 0.1, 9, 0, 0.05, 7);
  const AverageOptions o = coarse("lucy", 0.02, false);
  const double whole = balance_residual(s, points, o).rms;
  dem::Snapshot without_load = s;
  without_load.applied_force.setZero();
  EXPECT_GT(balance_residual(without_load, points, o).rms, 100 * whole);
  dem::Snapshot pushed = s;
  pushed.contacts[3].force.y() *= 1.1;
  EXPECT_GT(balance_residual(pushed, points, o).rms, 10 * whole);
}

TEST(Averaging, ParticleCentreLeavesALargerResidual) {
  const dem::Snapshot s = layer(8, 14, 9);
  const Eigen::MatrixXd points = grid_points(0.04, 0.1, 9, 0.03, 0.06, 7);
  const double cg = balance_residual(s, points, coarse("lucy", 0.02)).rms;
  const double pc = balance_residual(s, points, centre("circle", 0.02)).rms;
  EXPECT_LT(cg, 1e-3);
  EXPECT_GT(pc, 100 * cg);
}

TEST(Averaging, ExtendedStressReachesTheFloorsValue) {
  // Directly below a lone grain on the floor the extended stress is the smeared floor force.
  dem::Snapshot s;
  s.gravity = {0, -9.81, 0};
  test::add_wall(s, "floor", {0, 0, 0}, {0, 1, 0});
  s.grains.push_back(test::disk(0, 0, 0.05, 0.05));
  dem::Contact c;
  c.i = 0;
  c.j = -1;
  c.point = {0, 0, 0};
  c.normal = {0, -1, 0};
  c.force = {0, s.grains[0].mass * 9.81, 0};
  s.contacts.push_back(c);
  const auto kernel = make_kernel("lucy", 0.01);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(9, -0.02, 0.02);
  const Field base = base_profile(s, x, *kernel);
  const Field extended = average(s, base.points, coarse("lucy", 0.01, true));
  const Field ended = average(s, base.points, coarse("lucy", 0.01, false));
  const double scale = base.find("sigma_yy")->value.cwiseAbs().maxCoeff();
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    EXPECT_NEAR(extended.find("sigma_yy")->value[k], base.find("sigma_yy")->value[k], 1e-9 * scale);
    EXPECT_NEAR(ended.find("sigma_yy")->value[k], base.find("sigma_yy")->value[k] / 2,
                1e-9 * scale);
    EXPECT_EQ(extended.find("traction_y")->value[k], 0);
  }
}

TEST(Averaging, ResponseIntegratesToTheLoad) {
  for (bool rough : {false, true}) {
    const dem::Snapshot before = layer(9, 12, 5, rough), after = layer(9, 12, 5, rough, 5.0);
    EXPECT_NEAR(total_over_load(before, after) +
                    (side_wall_force(after).y() - side_wall_force(before).y()) / 5.0,
                1, 1e-9);
    const auto kernel = make_kernel("gaussian", 0.008);
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(3001, -0.06, 0.18);
    const Field base = base_response(before, after, x, *kernel);
    EXPECT_NEAR(-base.find("sigma_yy")->value.sum() * 0.24 / 3000,
                5.0 * total_over_load(before, after), 2e-4 * 5.0);
    const Field change =
        response(before, after, line_points(0.05, 0.1, 5, 0.03), coarse("lucy", 0.01));
    const Field a = average(before, line_points(0.05, 0.1, 5, 0.03), coarse("lucy", 0.01));
    const Field b = average(after, line_points(0.05, 0.1, 5, 0.03), coarse("lucy", 0.01));
    for (int k = 0; k < 5; ++k)
      EXPECT_DOUBLE_EQ(change.find("sigma_yy")->value[k],
                       b.find("sigma_yy")->value[k] - a.find("sigma_yy")->value[k]);
  }
}

TEST(Averaging, BitsDoNotDependOnThreads) {
  const dem::Snapshot s = layer(10);
  const Eigen::MatrixXd points = grid_points(0, 0.12, 29, 0, 0.06, 17);
  for (AverageOptions o : {coarse("lucy", 0.015), centre("circle", 0.02)}) {
    const Field one = average(s, points, o);
    for (int threads : {2, 3, 8, 40}) {
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

TEST(Averaging, CutSupportsHaveTheAreaInsideTheLayer) {
  // A dense lattice: sigma and volume fraction stay right where walls, floor and surface cut the
  // support, because V is the part inside.
  const double d = 0.002;
  dem::Snapshot s = lattice(60, d, 100, 100);
  for (const char* support : {"circle", "square"}) {
    const Eigen::MatrixXd points = grid_points(0, 59 * d, 5, 0, 59 * d, 5);
    const Field f = average(s, points, centre(support, 0.03));
    for (Eigen::Index p = 0; p < points.rows(); ++p)
      // Half a row of centres more or less along the circle's edge: d/2 over 30 mm on every side.
      EXPECT_NEAR(f.find("volume_fraction")->value[p], std::numbers::pi / 4, 0.08)
          << support << points.row(p);
  }
}

TEST(Averaging, KineticStressIsThatOfTheVelocitiesAboutTheirMean) {
  dem::Snapshot s = lattice(21, 0.01, 1, 1);
  for (dem::Grain& g : s.grains) g.velocity = {3, -2, 0};
  const Eigen::MatrixXd middle = line_points(0.1, 0.1, 1, 0.1);
  const Field uniform = average(s, middle, coarse("lucy", 0.02));
  EXPECT_NEAR(uniform.find("kinetic_xx")->value[0], 0, 1e-9);
  for (std::size_t g = 0; g < s.grains.size(); g += 2) s.grains[g].velocity.x() = -3;
  const Field mixed = average(s, middle, centre("square", 0.05));
  // 21 grains to a row: signs alternate over the lattice; about half of each, variance 9.
  EXPECT_NEAR(mixed.find("kinetic_xx")->value[0], -9 * mixed.find("density")->value[0],
              0.01 * 9 * mixed.find("density")->value[0]);
}

TEST(Averaging, FewGrainsGiveNanAndTheCount) {
  const dem::Snapshot s = layer(11);
  AverageOptions o = coarse("lucy", 0.001);
  o.least_grains = 2;
  const Field f = average(s, line_points(0.06, 0.06, 1, 0.03), o);
  EXPECT_TRUE(std::isnan(f.find("sigma_yy")->value[0]));
  EXPECT_LE(f.find("grains")->value[0], 1);
}

TEST(LayerFrame, MeasuresTheLayerAndItsLoad) {
  const dem::Snapshot s = layer(12, 12, 6, false, 1.0);
  const LayerFrame frame = layer_frame(s);
  EXPECT_EQ(frame.left, 0);
  EXPECT_EQ(frame.right, 0.12);
  EXPECT_EQ(frame.floor, 0);
  EXPECT_NEAR(frame.surface, 0.0605, 0.002);
  EXPECT_EQ(frame.load_x, s.grains[12 * 5 + 6].position.x());
  const Eigen::MatrixXd points = grid_points(0, 1, 3, 2, 3, 2);
  EXPECT_TRUE(frame.to_packing(points).isApprox(points.rowwise() +
                                                Eigen::RowVector2d(frame.load_x, frame.surface)));
  EXPECT_EQ(layer_frame(layer(12, 12, 6, true)).load_x, 0.06);
  EXPECT_NEAR(layer_frame(layer(12, 12, 6, true)).floor, 0.01, 0.002);
}

TEST(Averaging, RefusesWithOneLine) {
  const dem::Snapshot s = layer(13);
  const Eigen::MatrixXd p = line_points(0, 1, 2, 0);
  const auto with = [&](auto change) {
    AverageOptions o = coarse("lucy", 0.01);
    change(o);
    return refusal_of([&] { average(s, p, o); });
  };
  EXPECT_EQ(with([](auto& o) { o.method = "coarse_grain"; }),
            "unknown averaging method \"coarse_grain\"; known: coarse_graining, particle_centre, "
            "area_exact; did you mean \"coarse_graining\"?");
  EXPECT_EQ(
      with([](auto& o) { o.kernel = "circle"; }),
      "unknown kernel of coarse_graining \"circle\"; known: lucy, gaussian, heaviside; did you "
      "mean \"lucy\"?");
  EXPECT_EQ(with([](auto& o) { o.width = 0; }),
            "averaging width is 0 m; it must be positive (a grain diameter or more)");
  EXPECT_EQ(with([](auto& o) { o.threads = 0; }), "averaging on 0 threads; at least 1 is needed");
  EXPECT_EQ(refusal_of([&] { average(s, Eigen::MatrixXd::Zero(2, 3), coarse("lucy", 1)); }),
            "points have 3 coordinates; averaging needs 2");
  EXPECT_EQ(refusal_of([&] {
              average(s, Eigen::MatrixXd::Constant(1, 2, std::numeric_limits<double>::quiet_NaN()),
                      coarse("lucy", 1));
            }),
            "points hold a value that is not finite");
  dem::Snapshot solid = s;
  solid.dim = 3;
  EXPECT_EQ(refusal_of([&] { average(solid, p, coarse("lucy", 1)); }),
            "points have 2 coordinates; averaging needs 3");
  dem::Snapshot empty;
  EXPECT_EQ(refusal_of([&] { average(empty, p, coarse("lucy", 1)); }),
            "the snapshot has no free grain");
}

TEST(Averaging, RefusesSnapshotsOfDifferentPackings) {
  const dem::Snapshot a = layer(13);
  dem::Snapshot fewer = layer(13, 12, 5), other = a, fixed = a, bigger = a;
  other.grains[3].id = 77;
  fixed.grains[2].fixed = true;
  bigger.grains[1].radius = 0.25;
  const auto text = [&](const dem::Snapshot& b) {
    return refusal_of([&] { response(a, b, line_points(0, 1, 2, 0), coarse("lucy", 0.01)); });
  };
  EXPECT_EQ(text(fewer), "snapshots do not belong together: 72 grains unloaded, 60 loaded");
  EXPECT_EQ(text(other),
            "snapshots do not belong together: grain 3 is id 3 unloaded, id 77 loaded");
  EXPECT_EQ(text(fixed),
            "snapshots do not belong together: grain id 2 is fixed in one of them only");
  EXPECT_THAT(text(bigger),
              testing::StartsWith("snapshots do not belong together: grain id 1 has"));
}

}  // namespace
}  // namespace grainfield::coupling
