// Stress on a layer's base in space, and branches that end on fixed spheres.
#include "coupling/averaging/base_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "coupling/averaging/average.h"
#include "coupling/averaging/base.h"
#include "coupling/averaging/kernel.h"
#include "dem/snapshot/contact_changes.h"
#include "tests/coupling/averaging_scene.h"

namespace grainfield::coupling {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using test::options;

constexpr double d = 0.01;
const Vector3d kForce(0.3, -0.7, 2);  // of the base on the sphere: no two components alike

dem::Grain sphere(std::int64_t id, const Vector3d& at) {
  dem::Grain g = test::disk(id, 0, 0, d / 2);
  g.position = at;
  g.volume = std::numbers::pi / 6 * d * d * d;
  return g;
}

// One sphere on a floor.
dem::Snapshot on_a_floor(const Vector3d& at) {
  dem::Snapshot s;
  s.dim = 3;
  s.gravity = {0, 0, -9.81};
  s.grains = {sphere(0, at)};
  test::add_wall(s, "floor", {0, 0, at.z() - d / 2}, {0, 0, 1});
  dem::Contact c;
  c.i = 0;
  c.j = -1;
  c.point = at - Vector3d(0, 0, d / 2);
  c.normal = {0, 0, -1};
  c.force = kForce;
  s.contacts = {c};
  return s;
}

// The same on a fixed sphere below it, the contact told from either side.
dem::Snapshot on_a_sphere(const Vector3d& at, bool fixed_first) {
  dem::Snapshot s = on_a_floor(at);
  s.walls.clear();
  s.grains.push_back(sphere(1, at - Vector3d(0, 0, d)));
  s.grains.back().fixed = true;
  dem::Contact& c = s.contacts.front();
  c.j = 1;
  if (!fixed_first) return s;
  std::swap(c.i, c.j);
  c.normal = -c.normal;
  c.force = -c.force;
  return s;
}

MatrixXd square_of_places(int n, double low, double step) {
  MatrixXd out(n * n, 2);
  for (int k = 0; k < n * n; ++k) out.row(k) << low + step * (k % n), low + step * (k / n);
  return out;
}

// (sigma_xz, sigma_yz, sigma_zz) integrated over the plane.
Vector3d total(const dem::Snapshot& s, const Kernel& kernel) {
  const double step = d / 8;
  const Field f = base_stress(s, square_of_places(64, -4 * d + step / 2, step), kernel);
  Vector3d sum;
  for (int a = 0; a < 3; ++a) {
    sum[a] = f.find(std::string("sigma_") + "xyz"[a] + "z")->value.sum() * step * step;
  }
  return sum;
}

TEST(BaseInSpace, CarriesEveryComponentOfTheForce) {
  for (const char* name : {"lucy", "gaussian", "heaviside"}) {
    const auto kernel = make_kernel(name, d, 3);
    const double rounding = name == std::string("heaviside") ? 2e-2 : 1e-3;  // of the sum
    for (const dem::Snapshot& s :
         {on_a_floor({0.1 * d, 0, d / 2}), on_a_sphere({0.1 * d, 0, d / 2}, false),
          on_a_sphere({0.1 * d, 0, d / 2}, true)}) {
      EXPECT_LT((total(s, *kernel) + kForce).norm(), rounding * kForce.norm()) << name;
    }
  }
}

// The smeared stress, its supports and the force of the base are of the same contacts, in all three
// components: those of free grains with the floor or with fixed grains.
TEST(BaseInSpace, ForceIsTheSumOverTheContactsWithTheBase) {
  const Vector3d at(0.1 * d, 0, d / 2);
  for (dem::Snapshot s : {on_a_floor(at), on_a_sphere(at, false), on_a_sphere(at, true)}) {
    test::add_wall(s, "left", {0, 0, 0}, {1, 0, 0});
    dem::Contact beside = s.contacts.front();
    beside.i = 0;
    beside.j = -static_cast<int>(s.walls.size());
    beside.force = {7, 8, 9};
    s.contacts.push_back(beside);
    if (s.walls.front().name == "floor") {  // a fixed sphere on the floor carries nothing
      s.grains.push_back(sphere(1, at + Vector3d(d, 0, 0)));
      s.grains.back().fixed = true;
      beside.i = 1;
      beside.j = -1;
      s.contacts.push_back(beside);
    }
    const std::vector<BaseSupport> supports = base_supports(s);
    ASSERT_EQ(supports.size(), 1u);
    EXPECT_EQ(supports.front().force, kForce);
    EXPECT_EQ(dem::base_force(s), kForce);
  }
}

// Upwards is z, whatever the load does along x and y.
TEST(BaseInSpace, ShareOfTheLoadIsThatOfTheVerticalForces) {
  const dem::Snapshot before = on_a_floor({0, 0, d / 2});
  dem::Snapshot after = before;
  after.loaded_grain = 0;
  after.applied_force = {1, 3, -5};
  after.contacts.front().force += Vector3d(-1, -3, 4.5);
  EXPECT_NEAR(total_over_load(before, after), 0.9, 1e-15);
  EXPECT_TRUE(std::isnan(total_over_load(before, before)));
}

TEST(BaseInSpace, IsNoLine) {
  const Eigen::VectorXd x = Eigen::VectorXd::Zero(1);
  EXPECT_THROW(base_profile(on_a_floor({0, 0, d / 2}), x, *make_kernel("lucy", d)),
               std::invalid_argument);
}

// Beside either side of a periodic cell the other side is seen.
TEST(BaseInSpace, SeesImagesAlongBothSides) {
  dem::Snapshot s = on_a_floor({0.1 * d, 0.2 * d, d / 2});
  s.cell.periodic = {true, true, false};
  s.cell.edges = Vector3d(6 * d, 7 * d, 0).asDiagonal();
  const auto kernel = make_kernel("lucy", d, 3);
  MatrixXd places(4, 2);
  places << 0.4 * d, 0.5 * d, 6.4 * d, 0.5 * d, 0.4 * d, 7.5 * d, -5.6 * d, -6.5 * d;
  const Field f = base_stress(s, places, *kernel);
  for (const Column& column : f.columns) {
    ASSERT_NE(column.value[0], 0) << column.name;
    for (int k = 1; k < 4; ++k) {
      EXPECT_NEAR(column.value[k], column.value[0], 1e-9 * std::fabs(column.value[0]))
          << column.name << " " << k;
    }
  }
}

// Coarse graining does not ask which of the two grains a contact names first.
TEST(BaseInSpace, BranchesToFixedSpheresKnowNoFirstGrain) {
  const Vector3d at(0, 0, d / 2);
  const MatrixXd points = (MatrixXd(2, 3) << 0, 0, d / 4, 0.1 * d, -0.1 * d, d / 3).finished();
  for (const bool extend : {true, false}) {
    AverageOptions o = options("coarse_graining", "lucy", d);
    o.extend_into_walls = extend;
    o.least_grains = 0;
    const Field one = average(on_a_sphere(at, false), points, o);
    const Field other = average(on_a_sphere(at, true), points, o);
    for (const Column& column : one.columns) {
      const Eigen::VectorXd& same = other.find(column.name)->value;
      if (column.name == "sigma_xz" || (!extend && column.name.starts_with("traction"))) {
        EXPECT_NE(column.value[1], 0) << column.name;
      }
      for (Eigen::Index p = 0; p < points.rows(); ++p) {
        if (std::isnan(column.value[p]) && std::isnan(same[p])) continue;
        EXPECT_NEAR(same[p], column.value[p], 1e-12 * std::fabs(column.value[p])) << column.name;
      }
    }
  }
}

}  // namespace
}  // namespace grainfield::coupling
