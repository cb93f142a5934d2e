// Words of three dimensions in a case of a plane study: one line that says so.
#include "tests/coupling/check_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::complaint;
using ::testing::HasSubstr;

TEST(CheckDimensions, KeysOfSpheresAreRefusedInThePlane) {
  const std::string layer = testing::small_case("point-load");
  ASSERT_EQ(complaint(layer), "");
  EXPECT_THAT(
      complaint(layer, {"material.law=hertz"}),
      HasSubstr("material.law: found \"hertz\", allowed: overlap_area | energy | linear | penalty; "
                "only in three dimensions: hertz, hertz_elliptic; the grains of study = "
                "\"point-load\" are "
                "in 2D"));
  EXPECT_THAT(
      complaint(layer, {"material.poisson=0.3"}),
      HasSubstr("material.poisson: found 0.3, allowed: only in three dimensions: -0.999 to 0.5; "
                "the grains of study = \"point-load\" are in 2D"));
  EXPECT_THAT(complaint(layer, {"material.damping_model=critical"}),
              HasSubstr("material.damping_model: found \"critical\", allowed: only in three "
                        "dimensions: critical | viscoelastic; the grains of"));
  EXPECT_THAT(
      complaint(layer, {"packing.shape=sphere"}),
      HasSubstr(
          "found \"sphere\", allowed: disk | regular (2D) | irregular (2D) | superellipsoid (3D)"));
  EXPECT_THAT(complaint(layer, {"packing.shape=superellipsoid"}),
              HasSubstr("packing.shape: found \"superellipsoid\", allowed: "));
  EXPECT_THAT(complaint(testing::small_case("pile"), {"shape.kind=sphere"}),
              HasSubstr("\"sphere\" is a shape of 3D; the grains of this study are in 2D"));
  // What is no word of any dimension is still told the nearest one.
  EXPECT_THAT(complaint(layer, {"material.law=hertzz"}), HasSubstr("did you mean "));
  EXPECT_THAT(complaint(layer, {"material.poison=0.3"}), HasSubstr("unknown key; did you mean "));
}

TEST(CheckDimensions, TheProgramEndsWithExitCodeTwo) {
  const testing::Folder folder;
  const std::string text = testing::small_case("point-load") + "\n";
  const testing::Output output =
      testing::program("check " + folder.write("c.toml", text) + " --set material.law=hertz");
  EXPECT_EQ(output.code, 2);
  EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
}

}  // namespace
}  // namespace grainfield::coupling
