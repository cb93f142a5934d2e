// The mean stress of packings that are worked out by hand, and what the commands print of it.
#include "coupling/structure/mean_stress.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/coupling/program.h"
#include "tests/coupling/structure_scene.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;

// A disk of radius 0.1 m in a box of its size: floor and lid press with `vertical`, the sides with
// `horizontal`.
dem::Snapshot boxed(double vertical, double horizontal) {
  dem::Snapshot s;
  s.gravity = {0, -9.81, 0};
  dem::Grain grain;
  grain.id = 1;
  grain.position = {0.1, 0.1, 0};
  grain.radius = 0.1;
  grain.volume = 0.0314;
  grain.mass = grain.inertia = 1;
  s.grains = {grain};
  const auto wall = [&](const char* name, const dem::Vec3& normal, double force) {
    dem::Wall w;
    w.name = name;
    w.normal = normal;
    w.point = grain.position - 0.1 * normal;
    dem::Contact c;
    c.i = 0;
    c.j = -1 - static_cast<std::int64_t>(s.walls.size());
    c.point = w.point;
    c.normal = -normal;
    c.force = force * normal;
    c.normal_force = force;
    s.walls.push_back(w);
    s.contacts.push_back(c);
  };
  wall("floor", {0, 1, 0}, vertical);
  wall("lid", {0, -1, 0}, vertical);
  wall("left", {1, 0, 0}, horizontal);
  wall("right", {-1, 0, 0}, horizontal);
  return s;
}

TEST(MeanStress, OfADiskInABox) {
  const dem::Snapshot s = boxed(6, 2);
  EXPECT_NEAR(packing_volume(s), 0.04, 1e-15);
  // Force times the width of the box over its area.
  const Eigen::Matrix3d stress = mean_stress(s);
  EXPECT_NEAR(stress(0, 0), -2 / 0.2, 1e-12);
  EXPECT_NEAR(stress(1, 1), -6 / 0.2, 1e-12);
  EXPECT_NEAR(stress(0, 1), 0, 1e-12);
}

// A row of disks across the boundary of a cell; fixed grains count for the others alone.
TEST(MeanStress, OfACellThatRepeats) {
  dem::Snapshot s;
  for (int k = 0; k < 2; ++k) {
    dem::Grain grain;
    grain.id = k;
    grain.position = {0.05 + 0.1 * k, 0.1, 0};
    grain.radius = 0.05;
    grain.volume = 0.008;
    grain.mass = grain.inertia = 1;
    s.grains.push_back(grain);
  }
  s.cell.periodic = {true, true, false};
  s.cell.edges.diagonal() << 0.2, 0.3, 0;
  test::press(s, 0, 1, 5);
  test::press(s, 0, 1, 5);
  s.contacts.back().normal = {-1, 0, 0};
  s.contacts.back().force = {5, 0, 0};
  s.contacts.back().point = {0, 0.1, 0};
  s.contacts.back().image = {-1, 0, 0};
  EXPECT_NEAR(packing_volume(s), 0.06, 1e-15);
  EXPECT_NEAR(mean_stress(s)(0, 0), -5 * 0.2 / 0.06, 1e-12);
  s.grains[1].fixed = true;
  EXPECT_NEAR(mean_stress(s)(0, 0), -5 * 0.1 / 0.06, 1e-12);
}

TEST(MeanStress, IsPrintedWithItsErrorAndUnit) {
  const Folder folder;
  const std::string file = folder / "s.h5";
  dem::write_snapshot(file, "/a", boxed(6, 2));
  const Output one = program("structure " + file);
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_THAT(one.out, HasSubstr("mean stress: sigma_xx -10, sigma_xy 0, sigma_yy -30 N/m (tension "
                                 "positive, 1 packing)"));
  dem::write_snapshot(file, "/b", boxed(7, 2));
  dem::write_snapshot(file, "/c", boxed(8, 2));
  const Output all = program(
      "average " + file + " --frame packing --grid 3x3 --least-grains 1 -o " + (folder / "f.csv"));
  ASSERT_EQ(all.code, 0) << all.err;
  // -30, -35 and -40: a standard error of 5/sqrt(3).
  EXPECT_THAT(all.out, HasSubstr("sigma_yy -35.0 ± 2.9 N/m (tension positive, 3 packings)"));
  EXPECT_THAT(testing::read_text(folder / "f.csv"),
              ::testing::StartsWith("# frame packing; coarse_graining, kernel lucy, width "));
}

}  // namespace
}  // namespace grainfield::coupling
