// The strain of a packing of one's own, by the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupling/store/field_io.h"
#include "tests/coupling/averaging_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using ::testing::HasSubstr;

// u = B x, an extension, a shear and a turn.
dem::Snapshot displaced(dem::Snapshot s) {
  Eigen::Matrix3d b = Eigen::Matrix3d::Zero();
  b.topLeftCorner<2, 2>() << 1e-4, 3e-4, -1e-4, -2e-4;
  for (dem::Grain& g : s.grains) {
    if (!g.fixed) g.position += b * g.position;
  }
  return s;
}

TEST(StrainCommand, GivesAnAffineStrainBack) {
  const testing::Folder folder;
  const std::string file = folder / "s.h5";
  const dem::Snapshot before = test::layer(2);
  dem::write_snapshot(file, "/before", before);
  dem::write_snapshot(file, "/after", displaced(before));
  for (const std::string measure : {"cambou", "cundall", "derivative", "kernel"}) {
    const std::string out = folder / (measure + ".h5");
    const testing::Output run =
        testing::program("strain " + file + ":/before " + file + ":/after -o " + out +
                         " --grid 9x5 --measure " + measure);
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("strain: 45 points, measure " + measure));
    const Field field = read_field(out, "strain");
    EXPECT_EQ(field.nx, 9);
    EXPECT_EQ(field.word("measure"), measure);
    int values = 0;
    for (Eigen::Index k = 0; k < field.points.rows(); ++k) {
      if (!std::isfinite(field.find("strain_xx")->value[k])) continue;
      ++values;
      EXPECT_NEAR(field.find("strain_xx")->value[k], 1e-4, 1e-12);
      EXPECT_NEAR(field.find("strain_yy")->value[k], -2e-4, 1e-12);
      EXPECT_NEAR(field.find("strain_xy")->value[k], 1e-4, 1e-12);
      EXPECT_NEAR(field.find("rotation")->value[k], -2e-4, 1e-12);
    }
    EXPECT_GT(values, 20) << measure;
  }
}

// x = 0 lies at the load, whichever of the states knows it.
TEST(StrainCommand, TheLoadOfEitherStateIsTheOrigin) {
  const testing::Folder folder;
  dem::Snapshot before = test::layer(2), after = displaced(before);
  constexpr std::int64_t kLoaded = 12 * 5 + 2;  // in the top row, left of the middle
  std::vector<double> mean;
  for (const bool both : {true, false}) {
    before.loaded_grain = both ? kLoaded : -1;
    dem::Snapshot loaded = after;
    loaded.loaded_grain = kLoaded;
    const std::string file = folder / (both ? "both.h5" : "one.h5");
    dem::write_snapshot(file, "/before", before);
    dem::write_snapshot(file, "/after", loaded);
    const std::string out = folder / (both ? "both_strain.h5" : "one_strain.h5");
    ASSERT_EQ(testing::program("strain " + file + ":/before " + file + ":/after -o " + out +
                               " --grid 9x5")
                  .code,
              0);
    const Eigen::VectorXd u = read_field(out, "strain").find("u_y")->value;
    double sum = 0;
    for (const double value : u) sum += std::isfinite(value) ? value : 0;
    mean.push_back(sum);
  }
  EXPECT_NE(mean[0], 0);
  EXPECT_EQ(mean[0], mean[1]);
}

TEST(StrainCommand, RefusesWhatDoesNotBelongTogether) {
  const testing::Folder folder;
  const std::string file = folder / "s.h5";
  dem::write_snapshot(file, "/a", test::layer(2));
  dem::write_snapshot(file, "/b", test::layer(3, 10, 6));
  const auto refusal = [&](const std::string& arguments) {
    const testing::Output run = testing::program("strain " + arguments);
    EXPECT_EQ(run.code, 2) << arguments;
    return run.err;
  };
  const std::string good = file + ":/a " + file + ":/a -o " + (folder / "o.h5");
  EXPECT_THAT(refusal(file + ":/a " + file + ":/b -o " + (folder / "o.h5")),
              HasSubstr("snapshots do not belong together"));
  EXPECT_THAT(refusal(file + " " + file + ":/b -o " + (folder / "o.h5")),
              HasSubstr("holds 2 snapshots, strain takes one"));
  EXPECT_THAT(refusal(good + " --measure cambu"), HasSubstr("cambou"));
  EXPECT_THAT(refusal(good + " --frame heaps"), HasSubstr("heap"));
  EXPECT_THAT(refusal(good + " --grid 5"), HasSubstr("--grid: found \"5\""));
  EXPECT_THAT(refusal(good + " --width 0"), HasSubstr("--width: found 0, allowed: above 0"));
  EXPECT_THAT(refusal(file + ":/a " + file + ":/a -o " + file), HasSubstr("is an input"));
}

}  // namespace
}  // namespace grainfield::coupling
