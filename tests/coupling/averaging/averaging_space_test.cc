// Averages of spheres: the balance of a settled box, exact stresses, images, rings, cones.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "coupling/averaging/average.h"
#include "coupling/averaging/cone.h"
#include "coupling/averaging/region.h"
#include "coupling/averaging/rings.h"
#include "coupling/averaging/roof.h"
#include "coupling/averaging/weights.h"
#include "tests/coupling/averaging_scene.h"
#include "tests/coupling/periodic_scene.h"
#include "tests/coupling/settled_spheres_scene.h"

namespace grainfield::coupling {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using test::options;
using test::settled_spheres;

Matrix3d stress_at(const Field& f, Eigen::Index p) {
  Matrix3d s;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      s(a, b) = f.find(std::string("sigma_") + "xyz"[a] + "xyz"[b])->value[p];
  return s;
}

constexpr double d = 0.01;

// From wall to wall, from half a diameter above the floor to three above the free surface.
MatrixXd box_of_points(int n) {
  const Region region(settled_spheres());
  return box_points({0, 0, region.floor()},
                    {test::kBoxSide, test::kBoxSide, region.highest() + 3 * d}, n, n, 2 * n);
}

TEST(SettledSpheres, ObeyTheBalanceOfForcesEverywhere) {
  const dem::Snapshot& s = settled_spheres();
  const MatrixXd points = box_of_points(7);
  for (const bool extend : {true, false}) {
    AverageOptions o = options("coarse_graining", "lucy", d);
    o.extend_into_walls = extend;
    const BalanceResidual r = balance_residual(s, points, o);
    EXPECT_EQ(r.points, points.rows());
    EXPECT_LT(r.rms, 2e-4) << extend;
    EXPECT_LT(r.largest, 1e-2) << extend;  // of rho g, at the worst of 686 places
    if (extend) continue;
    // Without the walls' force density the balance does not hold.
    const Field f = average(s, points, o);
    EXPECT_GT(f.find("traction_z")->value.maxCoeff(), 5 * 9.81 * 1500);
  }
}

// Differences on a grid of spacing h: second order, and below 1 % at an eighth of the width.
TEST(SettledSpheres, DifferencesOnAGridConverge) {
  const AverageOptions o = options("coarse_graining", "lucy", 1.5 * d);
  const MatrixXd points = box_of_points(6);
  double last = 0;
  for (const double step : {1.5 * d / 8, 1.5 * d / 16, 1.5 * d / 32}) {
    const double now = balance_residual(settled_spheres(), points, o, step, 2).rms;
    if (last > 0) {
      EXPECT_NEAR(std::log2(last / now), 2, 0.2) << step;
    } else {
      EXPECT_LT(now, 1e-2);
    }
    last = now;
  }
}

TEST(SettledSpheres, CutsCarryTheWeightAbove) {
  const dem::Snapshot& s = settled_spheres();
  const Region region(s);
  double weight = 0;
  for (const dem::Grain& g : s.grains) weight += 9.81 * g.mass;
  EXPECT_NEAR(weight_above(s, -1), 0, 1e-4 * weight);
  for (const double height : {0.0, 0.02, 0.05}) {
    const CutForce cut = cut_force(s, height, options("coarse_graining", "lucy", d));
    EXPECT_NEAR(cut.error(), 0, 1e-3) << height;
    EXPECT_GT(cut.weight, 0.05 * weight);
    // Elements: their edges' levers are left, and what the sides cut off.
    const CutForce ball = cut_force(s, height, options("area_exact", "circle", 1.5 * d));
    EXPECT_NEAR(ball.error(), 0, 0.15) << height;
  }
  const std::vector<BalanceRow> table = balance_table(s, options("coarse_graining", "lucy", 1));
  ASSERT_EQ(table.size(), 7u);
  EXPECT_LT(table[0].inside.rms, 1e-3);
  EXPECT_LT(std::abs(table[0].worst_cut), 1e-3);
  EXPECT_GT(table[0].inside.points, 500);
}

// The integral of the field over space is the sum over all contacts of force (outer) branch.
TEST(SettledSpheres, TheTotalStressIsTheSumOverContacts) {
  const dem::Snapshot& s = settled_spheres();
  Matrix3d expected = Matrix3d::Zero();
  double mass = 0;
  for (const dem::Grain& g : s.grains) mass += g.mass;
  for (const dem::Contact& c : s.contacts) {
    const Vector3d from = s.grains[static_cast<std::size_t>(c.i)].position;
    const Vector3d to = c.j >= 0 ? s.grains[static_cast<std::size_t>(c.j)].position : c.point;
    expected += c.force * (to - from).transpose();
  }
  AverageOptions o = options("coarse_graining", "lucy", 1.5 * d);
  o.extend_into_walls = false;
  o.quantities = {"sigma", "density"};
  const double h = d / 2, low = -0.03;
  const int n = 24, m = 37;
  const Field f =
      average(s,
              box_points({low, low, low}, {low + (n - 1) * h, low + (n - 1) * h, low + (m - 1) * h},
                         n, n, m),
              o);
  Matrix3d sum = Matrix3d::Zero();
  for (Eigen::Index p = 0; p < f.points.rows(); ++p) sum += h * h * h * stress_at(f, p);
  EXPECT_LT((sum - expected).norm(), 1e-4 * expected.norm());
  EXPECT_NEAR(f.find("density")->value.sum() * h * h * h, mass, 1e-5 * mass);
}

// Spheres of one size on a face-centred lattice in a periodic cell, pressed by f at every contact:
// p = 4 * 12/2 * f r 2 / (3 V), V = (2 sqrt2 r)^3; the field has the lattice's symmetry.
TEST(Space, PressureOfAFaceCentredLattice) {
  const double r = d / 2, edge = 2 * std::numbers::sqrt2 * r, push = 0.3;
  dem::Snapshot s;
  s.dim = 3;
  s.cell.periodic = {true, true, true};
  s.cell.edges = 2 * edge * Matrix3d::Identity();
  for (int k = 0; k < 32; ++k) {
    static const Vector3d basis[4]{{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}};
    dem::Grain g;
    g.id = k;
    g.position = edge * (basis[k % 4] + Vector3d(k / 4 % 2, k / 8 % 2, k / 16));
    g.radius = r;
    g.volume = 4 * std::numbers::pi / 3 * r * r * r;
    g.mass = 2500 * g.volume;
    s.grains.push_back(g);
  }
  for (int i = 0; i < 32; ++i)
    for (int j = i + 1; j < 32; ++j) {
      dem::Contact c;
      c.i = i;
      c.j = j;
      const Vector3d from = s.grains[static_cast<std::size_t>(i)].position;
      c.image = dem::nearest_image(s.cell, s.grains[static_cast<std::size_t>(j)].position - from);
      const Vector3d branch = dem::second_place(s, c) - from;
      if (branch.norm() > 1.001 * d) continue;
      c.normal = branch.normalized();
      c.point = from + r * c.normal;
      c.force = -push * c.normal;
      s.contacts.push_back(c);
    }
  ASSERT_EQ(s.contacts.size(), 32u * 6);
  const double pressure = 32 * 6 * push * d / (3 * std::pow(2 * edge, 3));
  // Wide kernels see no lattice.
  const Field f = average(s, box_points({0, 0, 0}, {edge / 2, edge / 3, edge / 4}, 3, 3, 3),
                          options("coarse_graining", "gaussian", 2 * d));
  for (Eigen::Index p = 0; p < f.points.rows(); ++p)
    EXPECT_LT((stress_at(f, p) + pressure * Matrix3d::Identity()).norm(), 4e-3 * pressure);
  EXPECT_NEAR(f.find("volume_fraction")->value[5], std::numbers::pi / std::sqrt(18), 3e-3);
  // Cubes of a whole cell hold every sphere once, wherever they are.
  const Field cells = average(s, MatrixXd(Eigen::RowVector3d(0.3 * edge, 0.1 * edge, 0.7 * edge)),
                              options("area_exact", "square", edge / 2));
  EXPECT_LT((stress_at(cells, 0) + pressure * Matrix3d::Identity()).norm(), 1e-9 * pressure);
  EXPECT_NEAR(cells.find("volume_fraction")->value[0], std::numbers::pi / std::sqrt(18), 1e-9);
}

// Many copies of a slanting cell side by side are the same as one cell with its images.
TEST(Space, ImagesAreThoseOfATiledPacking) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    dem::Snapshot s = test::periodic_packing(3, seed);
    s.cell.velocity_gradient << 0.3, 0.1, -0.2, 0, -0.4, 0.5, 0.7, 0, 0.2;
    dem::Snapshot tiled = s;
    tiled.cell = {};
    tiled.grains.clear();
    tiled.contacts.clear();
    const auto n = static_cast<std::int64_t>(s.grains.size());
    const int copies = 5;
    const auto index = [&](int i, int j, int k) { return ((k * copies + j) * copies + i) * n; };
    for (int k = 0; k < copies; ++k)
      for (int j = 0; j < copies; ++j)
        for (int i = 0; i < copies; ++i) {
          const Vector3d shift = s.cell.edges * Vector3d(i - 2, j - 2, k - 2);
          for (dem::Grain g : s.grains) {
            g.position += shift;
            g.velocity += s.cell.velocity_gradient * shift;
            g.id = static_cast<std::int64_t>(tiled.grains.size());
            tiled.grains.push_back(g);
          }
          for (dem::Contact c : s.contacts) {
            const int a = i + c.image[0], b = j + c.image[1], e = k + c.image[2];
            if (std::min({a, b, e}) < 0 || std::max({a, b, e}) >= copies) continue;
            c.i += index(i, j, k);
            c.j += index(a, b, e);
            c.point += shift;
            c.image = {0, 0, 0};
            tiled.contacts.push_back(c);
          }
        }
    const Vector3d middle = s.cell.low + s.cell.edges * Vector3d::Constant(0.5);
    const MatrixXd points =
        box_points(middle - Vector3d::Constant(d), middle + Vector3d::Constant(d), 3, 3, 3);
    AverageOptions o = options("coarse_graining", "lucy", d);
    o.quantities = {"sigma", "density", "traction", "momentum"};
    const Field a = average(s, points, o), b = average(tiled, points, o);
    for (const Column& column : a.columns)
      EXPECT_LT((column.value - b.find(column.name)->value).cwiseAbs().maxCoeff(),
                1e-11 * std::max(1e-30, column.value.cwiseAbs().maxCoeff()))
          << column.name;
  }
}

// A packing that is moved and turned has the moved and turned field.
TEST(Space, FieldsMoveAndTurnWithThePacking) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  dem::Snapshot s = settled_spheres();
  std::erase_if(s.contacts, [](const dem::Contact& c) { return c.j < 0; });
  s.walls.clear();
  for (int trial = 0; trial < 5; ++trial) {
    const Eigen::Quaterniond q =
        Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
            .normalized();
    const Vector3d by(normal(random), normal(random), normal(random));
    dem::Snapshot turned = s;
    for (dem::Grain& g : turned.grains) g.position = q * g.position + by;
    for (dem::Contact& c : turned.contacts) {
      c.point = q * c.point + by;
      c.normal = q * c.normal;
      c.force = q * c.force;
    }
    for (const std::string kernel : {"lucy", "gaussian", "heaviside"}) {
      const AverageOptions o = options("coarse_graining", kernel, d);
      const Eigen::RowVector3d at(0.031, 0.027, 0.033);
      const Eigen::RowVector3d there = (q * Vector3d(at.transpose()) + by).transpose();
      const Matrix3d stress = stress_at(average(s, MatrixXd(at), o), 0),
                     seen = stress_at(average(turned, MatrixXd(there), o), 0),
                     expected = q.toRotationMatrix() * stress * q.toRotationMatrix().transpose();
      EXPECT_LT((seen - expected).norm(), 1e-10 * stress.norm()) << kernel;
    }
  }
}

TEST(Space, BlocksAndThreadsDoNotChangeBits) {
  const dem::Snapshot& s = settled_spheres();
  AverageOptions o = options("coarse_graining", "lucy", d / 2);
  const MatrixXd many = box_of_points(33);  // 71,874: more than one block
  o.threads = 3;
  const Field all = average(s, many, o);
  o.threads = 1;
  const Field last = average(s, many.bottomRows(7000), o);
  const Field first = average(s, many.topRows(3000), o);
  for (const Column& column : all.columns) {
    const auto same = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
      for (Eigen::Index p = 0; p < a.size(); ++p)
        if (a[p] != b[p] && !(std::isnan(a[p]) && std::isnan(b[p]))) return false;
      return true;
    };
    EXPECT_TRUE(same(column.value.tail(7000), last.find(column.name)->value)) << column.name;
    EXPECT_TRUE(same(column.value.head(3000), first.find(column.name)->value)) << column.name;
  }
}

TEST(Space, NormalisedFieldsKeepTheirValuesUpToSurfaceAndWalls) {
  // A lattice in a box: the density is the same everywhere.
  dem::Snapshot s;
  s.dim = 3;
  s.gravity = {0, 0, -9.81};
  const int n = 8;
  for (int k = 0; k < n * n * n; ++k) {
    dem::Grain g = test::disk(k, 0, 0, d / 2);
    g.position = d * Vector3d(k % n + 0.5, k / n % n + 0.5, k / (n * n) + 0.5);
    g.volume = 4 * std::numbers::pi / 3 * std::pow(d / 2, 3);
    s.grains.push_back(g);
  }
  test::add_wall(s, "floor", {0, 0, 0}, {0, 0, 1});
  AverageOptions o = options("coarse_graining", "lucy", 1.5 * d);
  o.quantities = {"volume_fraction"};
  const MatrixXd points = box_points({0, 0, 0}, {n * d, n * d, n * d}, 3, 3, 5);
  const Field open = average(s, points, o);
  o.free_surface = "normalised";
  const Field whole = average(s, points, o);
  const double full = std::numbers::pi / 6;
  for (Eigen::Index p = 0; p < points.rows(); ++p)
    EXPECT_NEAR(whole.find("volume_fraction")->value[p], full, 0.02) << points.row(p);
  EXPECT_NEAR(open.find("volume_fraction")->value[0], full / 8, 0.02);
  // The same of elements.
  const Field balls = average(s, points, options("area_exact", "circle", 2.5 * d));
  for (Eigen::Index p = 0; p < points.rows(); ++p)
    EXPECT_NEAR(balls.find("volume_fraction")->value[p], full, 0.03) << points.row(p);
}

// Far from the walls grains and stress are divided by one share of the kernel.
TEST(Space, NormalisedStressIsThatOfTheShareBelowTheSurface) {
  const Region region(settled_spheres());
  const double middle = test::kBoxSide / 2;
  const MatrixXd points = box_points({middle, middle, region.highest() - 3 * d},
                                     {middle, middle, region.highest() - d}, 1, 1, 5);
  AverageOptions o = options("coarse_graining", "lucy", d);
  const Field open = average(settled_spheres(), points, o);
  o.free_surface = "normalised";
  const Field whole = average(settled_spheres(), points, o);
  for (Eigen::Index p = 0; p < points.rows(); ++p) {
    const double share =
        open.find("volume_fraction")->value[p] / whole.find("volume_fraction")->value[p];
    EXPECT_LT(share, p == 4 ? 0.95 : 1 + 1e-12);
    EXPECT_LT((share * stress_at(whole, p) - stress_at(open, p)).norm(),
              1e-9 * stress_at(open, p).norm());
  }
}

TEST(Roof, HasTheColumnsHeightsAboveTheirMiddles) {
  const Roof roof(settled_spheres(), {0, 0, 0}, {test::kBoxSide, test::kBoxSide, 0}, 2 * d);
  ASSERT_GT(roof.heights().rows(), 1);
  for (Eigen::Index i = 0; i < roof.heights().rows(); ++i) {
    for (Eigen::Index j = 0; j < roof.heights().cols(); ++j) {
      const Eigen::Vector2d at = roof.middle(i, j);
      EXPECT_NEAR(roof.height(at.x(), at.y()), roof.heights()(i, j), 1e-12);
    }
  }
}

// Spheres cut by spheres and cubes, against counting random places.
TEST(Space, SharesOfSpheresAreThoseOfCounting) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const char* name : {"circle", "square"}) {
    const Support& support = *find_support(name);
    for (int trial = 0; trial < 60; ++trial) {
      const Vector3d centre = 1.5 * Vector3d(uniform(random), uniform(random), uniform(random));
      const double r = 0.3 + 0.25 * (1 + uniform(random));
      int inside = 0, all = 0;
      while (all < 20000) {
        const Vector3d at(uniform(random), uniform(random), uniform(random));
        if (at.norm() >= 1) continue;
        ++all;
        inside += support.distance(centre + r * at) < 1;
      }
      const double ball = 4 * std::numbers::pi / 3 * r * r * r;
      EXPECT_NEAR(support.of_ball(1, centre, r) / ball, static_cast<double>(inside) / all, 0.02)
          << name << " " << centre.transpose() << " " << r;
    }
    EXPECT_NEAR(support.of_ball(1, Vector3d::Zero(), 0.5), std::numbers::pi / 6, 1e-12);
    EXPECT_EQ(support.of_ball(1, Vector3d(2, 0, 0), 0.5), 0);
  }
}

TEST(Rings, AreTheMeanOverTheAngle) {
  const dem::Snapshot& s = settled_spheres();
  const Eigen::Vector2d axis(0.028, 0.031);
  const AverageOptions o = options("coarse_graining", "lucy", d);
  MatrixXd rings(4, 2);
  rings << 0, 0.03, 0.004, 0.01, 0.015, 0.03, 0.02, 0.055;
  const Field f =
      average_on_rings([&](const MatrixXd& points,
                           const AverageOptions& options) { return average(s, points, options); },
                       axis, rings, o);
  EXPECT_EQ(f.points, rings);
  const int n = 400;
  for (Eigen::Index ring = 0; ring < rings.rows(); ++ring) {
    MatrixXd points(n, 3);
    for (int k = 0; k < n; ++k) {
      const double theta = 2 * std::numbers::pi * (k + 0.37) / n;
      points.row(k) << axis.x() + rings(ring, 0) * std::cos(theta),
          axis.y() + rings(ring, 0) * std::sin(theta), rings(ring, 1);
    }
    const Field there = average(s, points, o);
    Matrix3d mean = Matrix3d::Zero();
    double density = 0;
    for (int k = 0; k < n; ++k) {
      const Matrix3d turn =
          Eigen::AngleAxisd(-2 * std::numbers::pi * (k + 0.37) / n, Vector3d::UnitZ())
              .toRotationMatrix();
      mean += turn * stress_at(there, k) * turn.transpose() / n;
      density += there.find("density")->value[k] / n;
    }
    const char* axes = "rtz";
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        EXPECT_NEAR(f.find(std::string("sigma_") + axes[a] + axes[b])->value[ring], mean(a, b),
                    1e-4 * mean.norm())
            << ring << a << b;
    EXPECT_NEAR(f.find("density")->value[ring], density, 1e-4 * density);
    EXPECT_NEAR(f.find("sigma_antisymmetric_rz")->value[ring], (mean(0, 2) - mean(2, 0)) / 2,
                1e-4 * mean.norm());
  }
  Gaps gaps;
  const Field empty =
      average_on_rings([&](const MatrixXd& points,
                           const AverageOptions& options) { return average(s, points, options); },
                       axis, MatrixXd(Eigen::RowVector2d(0.01, 0.3)),
                       [&] {
                         AverageOptions strict = o;
                         strict.least_grains = 3;
                         return strict;
                       }(),
                       &gaps);
  EXPECT_TRUE(std::isnan(empty.find("sigma_rr")->value[0]));
  EXPECT_EQ(empty.find("grains")->value[0], 0);
  EXPECT_EQ(gaps.few_grains.size(), 1u);
}

// A cone of spheres on a lattice: apex, height, slope, weight.
TEST(Cone, IsMeasured) {
  for (const double slope : {0.5, 0.8}) {
    dem::Snapshot s;
    s.dim = 3;
    s.gravity = {0, 0, -9.81};
    const double height = 20 * d;
    for (int k = -60; k <= 60; ++k)
      for (int j = -60; j <= 60; ++j)
        for (int i = 0; i < 20; ++i) {
          const Vector3d at = d * Vector3d(k, j, i + 0.5);
          if (at.z() > height - slope * at.head<2>().norm()) continue;
          dem::Grain g = test::disk(static_cast<std::int64_t>(s.grains.size()), 0, 0, d / 2);
          g.position = at + Vector3d(0.3, -0.2, 0);
          g.volume = 4 * std::numbers::pi / 3 * std::pow(d / 2, 3);
          g.mass = 2500 * g.volume;
          s.grains.push_back(g);
        }
    test::add_wall(s, "floor", {0, 0, 0}, {0, 0, 1});
    const ConeFrame cone = cone_frame(s);
    EXPECT_NEAR(cone.apex_x, 0.3, 1e-3);
    EXPECT_NEAR(cone.apex_y, -0.2, 1e-3);
    EXPECT_NEAR(cone.floor, 0, 1e-12);
    EXPECT_NEAR(cone.height, height, d);
    EXPECT_NEAR(std::tan(cone.repose_deg * std::numbers::pi / 180), slope, 0.05 * slope);
    EXPECT_NEAR(cone.foot, height / slope, 2 * d);
    EXPECT_NEAR(cone.volume_fraction, std::numbers::pi / 6, 0.02);
    EXPECT_NEAR(cone.pressure(), 2500 * std::numbers::pi / 6 * 9.81 * height, 300);
    EXPECT_LT((cone.to_packing(MatrixXd(Eigen::RowVector3d(0, 0, -1))) -
               Eigen::RowVector3d(cone.apex_x, cone.apex_y, 0))
                  .norm(),
              1e-12);
    // The region of the averages ends at the slope.
    const Region region(s);
    const Support& ball = *find_support("circle");
    const double all = region.measure(ball, 5, Vector3d(0.3, -0.2, 0));
    EXPECT_NEAR(all, std::numbers::pi / 3 * height * std::pow(height / slope, 2), 0.1 * all);
    // One grain in flight is no height.
    dem::Grain stray = s.grains.front();
    stray.id = 1000000;
    stray.position = {0.3, -0.2, 1};
    s.grains.push_back(stray);
    dem::Contact c;
    for (std::int64_t i = 0; i + 2 < static_cast<std::int64_t>(s.grains.size()); i += 2) {
      c.i = i;
      c.j = i + 1;
      s.contacts.push_back(c);
    }
    EXPECT_NEAR(cone_frame(s).height, height, d);
  }
}

TEST(LayerFrame, IsABoxInSpace) {
  const dem::Snapshot& s = settled_spheres();
  const LayerFrame frame = layer_frame(s, 7);
  EXPECT_EQ(frame.left, 0);
  EXPECT_EQ(frame.back, test::kBoxSide);
  EXPECT_EQ(frame.load_y, s.grains[7].position.y());
  EXPECT_GT(frame.surface, 0.07);
  EXPECT_LT(frame.surface, 0.12);
  const MatrixXd origin = frame.to_packing(MatrixXd(Eigen::RowVector3d(0, 0, 0)));
  EXPECT_EQ(origin(0, 2), frame.surface);
  EXPECT_EQ(origin(0, 1), frame.load_y);
}

}  // namespace
}  // namespace grainfield::coupling
