// Surfaces of walls: where they are nearest to a ball, what of a mesh is felt, STL files, and the
// stiffness of Hertz' contact on a curved wall.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "dem/random/random.h"
#include "dem/space/space3.h"
#include "dem/walls/stl.h"
#include "dem/walls/surface.h"
#include "dem/walls/wall_motion.h"
#include "tests/dem/mesh_scene.h"
#include "tests/refusal.h"

namespace grainfield::dem {
namespace {

using testing::HasSubstr;

Wall round_wall(const char* shape, double radius, double end_radius, double length, bool inside) {
  Wall w{"wall", {0, 0, 0}, Vec3(1, 2, 2) / 3, 0, shape};
  w.radius = radius;
  w.end_radius = end_radius;
  w.length = length;
  w.inside = inside;
  return w;
}

/// Least distance to points of a round shell, from many of them.
double sampled_distance(const Wall& w, const Vec3& at) {
  const Vec3 across = w.normal.unitOrthogonal(), third = w.normal.cross(across);
  double least = 1e300;
  for (int k = 0; k <= 2000; ++k) {
    const double t = k / 2000.0, r = w.radius + t * (w.end_radius - w.radius);
    // The nearest point of one circle is in the half plane of the place.
    const double z = at.dot(w.normal), rho = std::hypot(at.dot(across), at.dot(third));
    least = std::min(least, std::hypot(rho - r, z - t * w.length));
  }
  return least;
}

TEST(WallSurface, RoundShellsAreNearestWhereTheyAre) {
  Random random(3);
  int near = 0, rims = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const bool cylinder = trial % 3 == 0;
    const double end = cylinder ? 0.3 : random.uniform(0, 0.5);
    const Wall w = round_wall(cylinder ? "cylinder" : "cone", 0.3, end, 0.8, true);
    const auto surface = surface_of<3>(w);
    const Vec3 at(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    Wall sampled = w;
    sampled.end_radius = cylinder ? 0.3 : end;
    const double exact = sampled_distance(sampled, at);
    Patch<3> found[kMostPatches];
    const int count = surface->patches(at, 0.2, found);
    ASSERT_EQ(count, exact < 0.2 ? 1 : exact > 0.2 + 1e-6 ? 0 : count) << trial;
    if (count == 0) continue;
    ++near;
    const Plane<3>& plane = found[0].plane;
    const double spacing = 2.5e-4;  // half of that between samples
    const double amiss = std::min(spacing, spacing * spacing / exact);
    EXPECT_NEAR(plane.height(at), exact, amiss);
    EXPECT_NEAR((at - plane.point).norm(), plane.height(at), 1e-12);
    EXPECT_NEAR(plane.normal.norm(), 1, 1e-12);
    rims += found[0].curvature == 0;
    const double z = plane.point.dot(w.normal);
    const double rho = (plane.point - z * w.normal).norm();
    EXPECT_NEAR(rho, 0.3 + z / 0.8 * (sampled.end_radius - 0.3), 1e-9);
  }
  EXPECT_GT(near, 300);
  EXPECT_GT(rims, 50);
  EXPECT_LT(rims, near - 100);
}

TEST(WallSurface, EndlessCylindersHaveOneSide) {
  Patch<3> found[kMostPatches];
  const auto tube = surface_of<3>(round_wall("cylinder", 0.5, 0, 0, true));
  const Vec3 axis = Vec3(1, 2, 2) / 3, out = axis.unitOrthogonal();
  ASSERT_EQ(tube->patches(7 * axis + 0.45 * out, 0.1, found), 1);
  EXPECT_NEAR((found[0].plane.normal + out).norm(), 0, 1e-14);
  EXPECT_NEAR((found[0].plane.point - (7 * axis + 0.5 * out)).norm(), 0, 1e-14);
  EXPECT_EQ(found[0].curvature, -2);
  EXPECT_EQ(tube->patches(7 * axis + 0.35 * out, 0.1, found), 0);
  ASSERT_EQ(tube->patches(0.6 * out, 0.1, found), 1);  // behind it
  EXPECT_NEAR(found[0].plane.height(0.6 * out), -0.1, 1e-14);
  const auto rod = surface_of<3>(round_wall("cylinder", 0.5, 0, 0, false));
  ASSERT_EQ(rod->patches(0.55 * out, 0.1, found), 1);
  EXPECT_NEAR((found[0].plane.normal - out).norm(), 0, 1e-14);
  EXPECT_EQ(found[0].curvature, 2);
  EXPECT_EQ(rod->sweeping_arm(3 * axis, -4 * axis), 0);
  EXPECT_NEAR(rod->sweeping_arm(3 * axis + 0.2 * out, axis), 0.2, 1e-15);
  EXPECT_TRUE(std::isinf(rod->sweeping_arm(3 * axis, out)));
  const auto cone = surface_of<3>(round_wall("cone", 0.5, 0.2, 2, true));
  EXPECT_EQ(cone->sweeping_arm(3 * axis, axis), 0);
  EXPECT_NEAR(cone->sweeping_arm(0.1 * out, -axis), 0.6, 1e-15);
  EXPECT_NEAR(cone->sweeping_arm({0, 0, 0}, 7 * out), 2.2, 1e-12);  // its end turns over
  Wall circle{"ring", {0, 0, 0}, {0, 1, 0}, 0, "cylinder"};
  circle.radius = 0.5;
  Patch<2> flat[kMostPatches];
  ASSERT_EQ(surface_of<2>(circle)->patches({0, -0.45}, 0.1, flat), 1);
  EXPECT_NEAR(flat[0].plane.normal.y(), 1, 1e-15);
}

// Against brute force: a convex body has one nearest point.
TEST(WallSurface, AMeshFromOutsideIsItsNearestPoint) {
  const auto surface = mesh_surface(box_mesh({-0.5, -0.3, -0.2}, {0.5, 0.3, 0.2}, false), "box");
  Random random(5);
  Patch<3> found[kMostPatches];
  int faces = 0, others = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    const Vec3 at(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const Vec3 nearest = at.cwiseMax(Vec3(-0.5, -0.3, -0.2)).cwiseMin(Vec3(0.5, 0.3, 0.2));
    const double distance = (at - nearest).norm();
    const int count = surface->patches(at, 0.25, found);
    ASSERT_EQ(count, distance > 0 && distance < 0.25 ? 1 : 0) << at.transpose();
    if (count == 0) continue;
    EXPECT_NEAR((found[0].plane.point - nearest).norm(), 0, 1e-12);
    EXPECT_NEAR((found[0].plane.normal - (at - nearest) / distance).norm(), 0, 1e-12);
    const Vec3 n = found[0].plane.normal;
    (n.cwiseAbs().maxCoeff() > 1 - 1e-9 ? faces : others) += 1;
  }
  EXPECT_GT(faces, 300);
  EXPECT_GT(others, 200);
}

TEST(WallSurface, ACornerOfAMeshHasThreeContacts) {
  const auto surface = mesh_surface(box_mesh({0, 0, 0}, {1, 1, 1}, true), "box");
  Patch<3> found[kMostPatches];
  const Vec3 at(0.09, 0.08, 0.07);
  ASSERT_EQ(surface->patches(at, 0.1, found), 3);
  EXPECT_NEAR((found[0].plane.normal - Vec3::UnitZ()).norm(), 0, 1e-15);  // the nearest first
  EXPECT_NEAR((found[1].plane.normal - Vec3::UnitY()).norm(), 0, 1e-15);
  EXPECT_NEAR((found[2].plane.normal - Vec3::UnitX()).norm(), 0, 1e-15);
  EXPECT_EQ(surface->patches({0.5, 0.5, 0.05}, 0.1, found), 1);
  EXPECT_EQ(surface->patches({0.5, 0.05, 0.05}, 0.1, found), 2);
  // On the diagonal, where the triangles of a face meet, and at a corner of four of them.
  EXPECT_EQ(surface->patches({0.3, 0.3, 0.05}, 0.1, found), 1);
  EXPECT_EQ(surface->patches({-0.05, 0.5, 0.5}, 0.1, found), 0);  // behind
}

TEST(WallSurface, FacetsOfARoundMeshAreOneContact) {
  const auto drum = mesh_surface(drum_mesh(0.5, 1, 36), "drum");
  Patch<3> found[kMostPatches];
  for (int k = 0; k < 360; ++k) {
    const double angle = k * 0.017453;
    const Vec3 at(0.42 * std::cos(angle), 0.42 * std::sin(angle), 0.5);
    ASSERT_EQ(drum->patches(at, 0.1, found), 1) << k;
    EXPECT_NEAR((found[0].plane.normal + at.cwiseProduct(Vec3(1, 1, 0)) / 0.42).norm(), 0, 0.09);
  }
  EXPECT_EQ(drum->patches({0.42, 0.01, 0.05}, 0.1, found), 2);  // with the end
}

TEST(WallSurface, ShapesThatDoNotFitAreRefused) {
  Wall w = round_wall("cylindre", 1, 1, 1, true);
  EXPECT_EQ(refusal_of([&] { surface_of<3>(w); }),
            "wall wall: shape: found \"cylindre\", allowed: plane, cylinder, cone, mesh; did you "
            "mean \"cylinder\"?");
  w.shape = "cone";
  EXPECT_THAT(refusal_of([&] { surface_of<2>(w); }),
              HasSubstr("wall wall: shape: found \"cone\", allowed: plane, cylinder"));
  w.length = 0;
  EXPECT_EQ(refusal_of([&] { surface_of<3>(w); }),
            "wall wall: length: found 0, allowed: above 0 m");
  w.shape = "cylinder";
  w.radius = -1;
  EXPECT_EQ(refusal_of([&] { surface_of<3>(w); }),
            "wall wall: radius: found -1, allowed: above 0 m");
  w.shape = "mesh";
  EXPECT_EQ(refusal_of([&] { surface_of<3>(w); }), "wall wall: found no facet");
}

// Hertz' elliptic contact of a sphere with a cylinder, by elliptic integrals (physics, section 5).
double exact_radius(double radius, double curvature) {
  using boost::math::ellint_1;
  using boost::math::ellint_2;
  const double one = 0.5 / radius, two = 0.5 * (1 / radius + curvature);
  const double low = std::min(one, two), high = std::max(one, two);
  const double ratio = high / low;
  const auto miss = [&](double kappa) {
    const double e = std::sqrt(1 - 1 / (kappa * kappa));
    const double k = ellint_1(e), l = ellint_2(e);
    return (kappa * kappa * l - k) / (k - l) - ratio;
  };
  double kappa = 1;
  if (ratio > 1 + 1e-9) {
    const auto range = boost::math::tools::bisect(
        miss, 1 + 1e-6, 1e4, [](double x, double y) { return std::fabs(x - y) < 1e-12 * y; });
    kappa = range.first;
  }
  const double e = std::sqrt(1 - 1 / (kappa * kappa));
  const double k = ellint_1(e), l = ellint_2(e);
  const double gamma =
      2.0 / 3 * 3.14159265358979 * kappa * std::sqrt(l / (k * k * k * (low + high)));
  return 0.5625 * gamma * gamma;
}

TEST(WallSurface, HertzOnACurvedWallIsTheEllipticContact) {
  EXPECT_EQ(effective_radius(0.3, 0), 0.3);
  for (const double r : {0.01, 0.3}) {
    for (const double ratio : {0.01, 0.1, 0.3, 0.5, 0.7, 0.9}) {  // r / R
      const double around = effective_radius(r, -ratio / r),
                   column = effective_radius(r, ratio / r);
      EXPECT_NEAR(around / exact_radius(r, -ratio / r), 1, 1e-3) << ratio;
      EXPECT_NEAR(column / exact_radius(r, ratio / r), 1, 1e-3) << ratio;
      EXPECT_GT(around, r);
      EXPECT_LT(column, r);
    }
  }
  EXPECT_NEAR(effective_radius(0.01, 1000), exact_radius(0.01, 1000), 1e-2 * 0.01);
  EXPECT_TRUE(std::isfinite(effective_radius(0.01, -200)));
}

class Stl : public testing::Test {
 protected:
  ~Stl() override { std::filesystem::remove(file_); }

  std::string refused(const StlOptions& options = {}) const {
    return refusal_of([&] { read_stl(file_, options); });
  }
  void write(const std::string& bytes) const { std::ofstream(file_, std::ios::binary) << bytes; }
  /// Facets from outside, in millimetres.
  static std::string ascii(const Triangles& mesh) {
    std::string out = "solid a box of facets\n";
    for (const auto& [a, b, c] : mesh) {
      const Vec3 n = (b - a).cross(c - a).normalized();
      out += fmt::format("  facet normal {} {} {}\n    outer loop\n", n.x(), n.y(), n.z());
      for (const Vec3& v : {a, b, c}) {
        out += fmt::format("      vertex {} {} {}\n", 1e3 * v.x(), 1e3 * v.y(), 1e3 * v.z());
      }
      out += "    endloop\n  endfacet\n";
    }
    return out + "endsolid a box of facets\n";
  }
  static std::string binary(const Triangles& mesh) {
    std::string out(80, ' ');
    out.replace(0, 5, "solid");  // as some programs do
    const auto count = static_cast<std::uint32_t>(mesh.size());
    out.append(reinterpret_cast<const char*>(&count), 4);
    for (const auto& [a, b, c] : mesh) {
      for (const Vec3& v : {Vec3(0, 0, 0), a, b, c}) {
        for (int k = 0; k < 3; ++k) {
          const auto x = static_cast<float>(1e3 * v[k]);
          out.append(reinterpret_cast<const char*>(&x), 4);
        }
      }
      out.append(2, '\0');
    }
    return out;
  }

  const Triangles box_ = box_mesh({0, 0, 0}, {1, 0.5, 0.25}, false);
  const StlOptions mm_{1e-3, false, false};
  const std::string file_ =
      testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name() + ".stl";
};

TEST_F(Stl, IsReadInBothForms) {
  for (const std::string& bytes : {ascii(box_), binary(box_)}) {
    write(bytes);
    const Triangles mesh = read_stl(file_, mm_);
    ASSERT_EQ(mesh.size(), 12U);
    for (std::size_t t = 0; t < 12; ++t) {
      for (int k = 0; k < 3; ++k) EXPECT_NEAR((mesh[t][k] - box_[t][k]).norm(), 0, 1e-15);
    }
    EXPECT_NEAR(topology_of(mesh, "").volume, 0.125, 1e-14);
    // Grains inside see the facets from behind.
    const Triangles turned = read_stl(file_, {1e-3, true, false});
    EXPECT_NEAR(topology_of(turned, "").volume, -0.125, 1e-14);
  }
}

TEST_F(Stl, SolidsAfterTheFirstAreReadToo) {
  const Triangles other = box_mesh({2, 0, 0}, {3, 1, 1}, false);
  write(ascii(box_) + "\n" + ascii(other));
  const Triangles mesh = read_stl(file_, mm_);
  ASSERT_EQ(mesh.size(), 24U);
  for (std::size_t t = 0; t < 12; ++t) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR((mesh[12 + t][k] - other[t][k]).norm(), 0, 1e-15);
  }
  EXPECT_NEAR(topology_of(mesh, "").volume, 1.125, 1e-13);
  write(ascii(box_) + "rubbish\n" + ascii(other));  // on line 2 + 12 facets of 7 + 1
  EXPECT_EQ(refused(mm_), file_ +
                              ": line 87: found \"rubbish\", expected solid or the end of the "
                              "file of an ASCII STL file");
  const std::string both = ascii(box_) + ascii(other);
  write(both.substr(0, both.rfind("endsolid")));
  EXPECT_THAT(refused(mm_), HasSubstr("found \"\", expected facet or endsolid"));
}

TEST_F(Stl, OpenOnesMustBeMeant) {
  Triangles open = box_;
  open.erase(open.begin() + 7);
  write(ascii(open));
  EXPECT_THAT(refused(mm_), AllOf(HasSubstr(file_ + ": facet "),
                                  HasSubstr("an edge without a neighbour: the surface is open; "
                                            "close it, or say that a thin open sheet is meant")));
  EXPECT_EQ(read_stl(file_, {1e-3, false, true}).size(), 11U);
}

TEST_F(Stl, InsideOutOnesAreRefused) {
  Triangles turned = box_;
  for (auto& t : turned) std::swap(t[0], t[1]);
  write(binary(turned));
  EXPECT_THAT(refused(mm_), HasSubstr("is inside out (its facets enclose -0.125 m3); turn"));
  Triangles mixed = box_;
  std::swap(mixed[4][0], mixed[4][1]);
  write(binary(mixed));
  EXPECT_THAT(refused(mm_), AllOf(HasSubstr("facet "), HasSubstr("turned against facet ")));
}

TEST_F(Stl, BrokenOnesAreRefused) {
  EXPECT_THAT(refused(), HasSubstr("cannot be read"));
  write("");
  EXPECT_THAT(refused(), HasSubstr("found 0 bytes, expected 84 of a binary STL file"));
  const std::string bytes = binary(box_);
  std::string cut = bytes.substr(0, bytes.size() - 7);
  cut[0] = 'x';
  write(cut);
  EXPECT_THAT(refused(), HasSubstr("found 677 bytes, expected 684 of a binary STL file with 12"));
  std::string huge = bytes;
  const std::uint32_t count = 0x7fffffff;
  std::memcpy(huge.data() + 80, &count, 4);
  huge[0] = 'x';
  write(huge);
  EXPECT_THAT(refused(), HasSubstr("2147483647 facets"));
  const std::string text = ascii(box_);
  write(text.substr(0, text.size() / 2));
  EXPECT_THAT(refused(), HasSubstr("expected "));
  std::string word = text;
  word.replace(word.find("vertex") + 7, 1, "x");
  write(word);
  EXPECT_THAT(refused(), HasSubstr("line 4: found \"x"));
  Triangles thin = box_;
  thin[3][1] = thin[3][0];
  write(ascii(thin));
  EXPECT_THAT(refused(), HasSubstr("facet 4: has no area; leave it out"));
  Triangles nowhere = box_;
  nowhere[5][2].x() = std::nan("");
  write(binary(nowhere));
  EXPECT_THAT(refused(), HasSubstr("facet 6: a corner's coordinate is not a finite number"));
  write(ascii(box_));
  EXPECT_THAT(refused({0, false, false}), HasSubstr("unit: found 0, allowed: above 0 m"));
  std::string against = text;
  const std::size_t at = against.find("normal ") + 7;
  against.replace(at, against.find('\n', at) - at, "1 0 0");
  write(against);
  EXPECT_THAT(refused(), HasSubstr("facet 1: its corners run against its normal"));
}

}  // namespace
}  // namespace grainfield::dem
