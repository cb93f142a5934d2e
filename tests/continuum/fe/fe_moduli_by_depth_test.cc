// Elastic constants by depth: rows that do not differ give the closed layers, a half space whose
// modulus grows as a power of the depth has a closed stress, and in the plane a map says the same.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "continuum/model.h"
#include "tests/continuum/refused_model.h"

using namespace grainfield::continuum;
using ::testing::HasSubstr;

namespace {

// A file that is there for one test.
class File {
 public:
  explicit File(const std::string& text, const std::string& name = "moduli.csv")
      : path_(std::filesystem::temp_directory_path() /
              (::testing::UnitTest::GetInstance()->current_test_info()->name() + ("_" + name))) {
    std::ofstream(path_) << text;
  }
  ~File() { std::filesystem::remove(path_); }
  std::string name() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

Points plane_points() {
  Points out(12, 2);
  for (int i = 0; i < 12; ++i) out.row(i) << 0.12 * i - 0.3, -0.25 - 0.25 * (i % 4);
  return out;
}

Points space_points() {
  Points out(8, 3);
  for (int i = 0; i < 8; ++i) out.row(i) << 0.1 * i - 0.2, 0.07 * i, -0.25 - 0.25 * (i % 4);
  return out;
}

double misfit(const Stresses& found, const Stresses& expected) {
  return (found - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

// E = (depth/depth of interest)^power, nu = 1/(2 + power): rows an eighth of an octave apart.
std::string power_law(double power) {
  std::string out = "depth,E,nu\n";
  const double nu = 1 / (2 + power);
  const auto row = [&](double depth, double E) {
    out += std::to_string(depth) + "," + std::to_string(E) + "," + std::to_string(nu) + "\n";
  };
  constexpr double kShallowest = 1e-3;
  row(0, std::pow(kShallowest, power));
  for (int k = 1; k <= 160; ++k) {
    const double depth = kShallowest * std::exp2(k / 8.0);
    row(depth, std::pow(depth, power));
  }
  return out;
}

}  // namespace

TEST(FeModuliByDepth, EqualRowsAreTheClosedLayers) {
  const File even("depth,E,nu\n0,2e7,0.2\n0.4,2e7,0.2\n1,2e7,0.2\n", "even.csv");
  for (const char* base : {"smooth", "rough"}) {
    const auto plane = make_model("fe_elastic_layer", {{"base", base}, {"moduli", even.name()}});
    EXPECT_LT(misfit(plane->stress(plane_points()),
                     make_model("layer", {{"base", base}, {"nu", "0.2"}})->stress(plane_points())),
              1e-3);
  }
  const File across(
      "# measured\ndepth,E_v,E_h,nu_h,nu_v,G_v\n0,2,1,0.2,0.3,0.6\n2,2,1,0.2,0.3,0.6\n",
      "across.csv");
  const auto space = make_model("fe_elastic_layer", {{"dim", "3"},
                                                     {"base", "rough"},
                                                     {"half_width", "4"},
                                                     {"tolerance", "0.02"},
                                                     {"moduli", across.name()}});
  const auto closed = make_model("transverse_layer", {{"base", "rough"},
                                                      {"E_v", "2"},
                                                      {"E_h", "1"},
                                                      {"nu_h", "0.2"},
                                                      {"nu_v", "0.3"},
                                                      {"G_v", "0.6"}});
  EXPECT_LT(misfit(space->stress(space_points()), closed->stress(space_points())), 0.02);
}

// Froehlich 1934, Holl 1940: with nu = 1/(2 + n) the stress is a compression along the rays from
// the load, (3 + n) F/(2 pi R^2) cos^(n + 1) in space; in the plane F/(B R) cos^(n + 1), B the
// integral of cos^(n + 2) over the half circle.
TEST(FeModuliByDepth, HalfSpaceWithModulusLikeAPowerOfDepth) {
  for (const double n : {1.0 / 3, 1.0}) {
    const File table(power_law(n));
    const double B =
        std::sqrt(std::numbers::pi) * std::tgamma((n + 3) / 2) / std::tgamma((n + 4) / 2);
    Points plane(3, 2);
    plane << 0, -0.5, 0, -1, 0.5, -1;
    const auto model =
        make_model("fe_elastic_half_space", {{"depth", "1"}, {"moduli", table.name()}});
    const Stresses found = model->stress(plane);
    for (Eigen::Index i = 0; i < plane.rows(); ++i) {
      const double R = plane.row(i).norm(), cosine = -plane(i, 1) / R;
      const double ray = -std::pow(cosine, n + 1) / (B * R);
      EXPECT_NEAR(found(i, 1), ray * cosine * cosine, 0.01 * std::fabs(ray)) << n << " " << i;
      EXPECT_NEAR(found(i, 0), ray * (1 - cosine * cosine), 0.02 * std::fabs(ray)) << n << " " << i;
    }
  }
}

TEST(FeModuliByDepth, AxisOfTheGradedHalfSpaceInSpace) {
  const double n = 1.0 / 3;
  const File table(power_law(n));
  Points axis(2, 3);
  axis << 0, 0, -0.5, 0, 0, -1;
  const Stresses found =
      make_model("fe_elastic_half_space",
                 {{"dim", "3"}, {"depth", "1"}, {"radius", "20"}, {"moduli", table.name()}})
          ->stress(axis);
  for (Eigen::Index i = 0; i < 2; ++i) {
    const double z = axis(i, 2);
    EXPECT_NEAR(-found(i, 2) * 2 * std::numbers::pi * z * z, 3 + n, 0.02) << i;
  }
}

// Another split of the displacement, another reader.
TEST(FeModuliByDepth, PlaneLayerIsThatOfAMap) {
  std::string rows = "depth,E,nu\n", map = "x,y,young,poisson\n";
  for (const double depth : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    rows += std::to_string(depth) + "," + std::to_string(1 + 3 * depth * depth) + ",0.25\n";
  }
  for (const double y : {-1.0, -0.75, -0.5, -0.25, 0.0}) {
    for (const double x : {-8.0, 0.0, 8.0}) {
      map += std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(1 + 3 * y * y) +
             ",0.25\n";
    }
  }
  const File table(rows), grid(map, "map.csv");
  const auto by_depth =
      make_model("fe_elastic_layer", {{"base", "rough"}, {"moduli", table.name()}});
  const auto by_map = make_model("fe_orthotropic_layer", {{"base", "rough"}, {"map", grid.name()}});
  const Stresses found = by_depth->stress(plane_points());
  EXPECT_LT(misfit(found, by_map->stress(plane_points())), 2e-3);
  // The base of the graded layer feels another pressure than that of the even one.
  EXPECT_GT(
      misfit(found,
             make_model("layer", {{"base", "rough"}, {"nu", "0.25"}})->stress(plane_points())),
      0.02);
}

TEST(FeModuliByDepth, RefusesByRow) {
  const auto refused = [](const std::string& text, const Settings& more = {}) {
    const File table(text);
    Settings s = more;
    s["moduli"] = table.name();
    return refusal("fe_elastic_layer", s);
  };
  EXPECT_THAT(refused("depth,nu,E\n0,0.3,1\n"),
              HasSubstr(":1: the header is \"depth,nu,E\"; allowed: depth,E,nu or "
                        "depth,E_v,E_h,nu_h,nu_v,G_v"));
  EXPECT_THAT(refused("depth,E,nu\n0.1,1,0.3\n"), HasSubstr(":2: the first depth is 0.1 m"));
  EXPECT_THAT(refused("depth,E,nu\n0,1,0.3\n0,1,0.3\n"),
              HasSubstr(":3: depth = 0 m follows 0 m; allowed: depths that ascend"));
  EXPECT_THAT(refused("depth,E,nu\n0,1,0.3\n0.9,1,0.3\n"),
              HasSubstr(":3: depth = 0.9 m is the last row; allowed: 1 m or more"));
  EXPECT_THAT(refused("depth,E,nu\n0,1,0.3\n1,-1,0.3\n"), HasSubstr(":3: these constants"));
  EXPECT_THAT(refused("depth,E,nu\n0,1,0.3\n1,1,0.5\n"), HasSubstr(":3: these constants"));
  EXPECT_THAT(refused("depth,E_v,E_h,nu_h,nu_v,G_v\n0,1,1,0.3,0.7,1\n1,1,1,0.3,0.3,1\n"),
              HasSubstr(":2: these constants"));
  // Stable at both ends, not between them.
  EXPECT_THAT(
      refused("depth,E_v,E_h,nu_h,nu_v,G_v\n0,1,0.3,0,1.2,1\n1,1,20,0,0.1,1\n", {{"dim", "3"}}),
      HasSubstr(":3: between this row and the one above"));
  EXPECT_THAT(refused("depth,E,nu\n"), HasSubstr(":1: no row"));
  EXPECT_THAT(refused("depth,E,nu\n0,1,0.3\n1,1,x\n"), HasSubstr(":3: \"x\" is not a finite"));
  EXPECT_EQ(refusal("fe_elastic_layer", {{"moduli", "/nowhere.csv"}}),
            "/nowhere.csv: cannot be opened");
  EXPECT_THAT(refusal("fe_elastic_layer", {{"moduli", "m.csv"}, {"nu", "0.2"}}),
              HasSubstr("beside moduli = m.csv, which replaces it"));
}
