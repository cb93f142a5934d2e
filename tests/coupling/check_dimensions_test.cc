// Words of three dimensions in a case of a plane study: one line that says so.
#include "check_scene.h"
#include "program.h"

namespace grainfield::coupling {
namespace {

using testing::complaint;
using ::testing::HasSubstr;

TEST(CheckDimensions, KeysOfSpheresAreRefusedInThePlane) {
  const std::string layer = testing::small_case("point-load");
  ASSERT_EQ(complaint(layer), "");
  EXPECT_THAT(
      complaint(layer, {"material.law=hertz"}),
      HasSubstr("material.law: found \"hertz\", allowed: overlap_area | energy | linear; \"hertz\" "
                "is a law of spheres (3D); the studies' grains are in 2D"));
  EXPECT_THAT(complaint(layer, {"material.poisson=0.3"}),
              HasSubstr("material.poisson: unknown key: poisson is a key of the law \"hertz\" of "
                        "spheres (3D); the studies' grains are in 2D"));
  EXPECT_THAT(complaint(layer, {"packing.shape=sphere"}),
              HasSubstr("\"sphere\" is a shape of 3D; the studies' grains are in 2D"));
  // What is no word of any dimension is still told the nearest one.
  EXPECT_THAT(complaint(layer, {"material.law=hertzz"}), HasSubstr("nearest: "));
  EXPECT_THAT(complaint(layer, {"material.poison=0.3"}), HasSubstr("unknown key; nearest: "));
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
