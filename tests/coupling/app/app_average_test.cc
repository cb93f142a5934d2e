// `grainfield average` on written snapshots: frames, cuts, methods, balance, points without values.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "coupling/averaging/base.h"
#include "coupling/averaging/kernel.h"
#include "coupling/store/field_io.h"
#include "dem/hdf5/file.h"
#include "tests/coupling/averaging_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Output;
using testing::program;

std::string written(const Folder& folder, const dem::Snapshot& snapshot, const std::string& name) {
  dem::write_snapshot(folder / name, "state", snapshot);
  return folder / name;
}

Field field_of(const std::string& file) { return read_field(file, "average"); }

std::string unit_of_points(const std::string& file) {
  const dem::hdf5::Handle in = dem::hdf5::open_for_reading(file);
  const dem::hdf5::Handle points(H5Dopen2(in, "average/points", H5P_DEFAULT), H5Dclose);
  return dem::hdf5::read_text_attribute(points, "unit");
}

void expect_refusal(const Output& output, const std::string& words) {
  EXPECT_EQ(output.code, 2) << output.err;
  EXPECT_THAT(output.err, HasSubstr(words));
  EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
}

TEST(Average, MethodsCutsAndQuantities) {
  const Folder folder;
  const std::string file = written(folder, test::layer(4), "s.h5");
  for (const char* method : {"coarse_graining", "particle_centre", "area_exact"}) {
    const Output out =
        program("average " + file + " --method " + method +
                " --cuts 0,0.5 --grid 7x2 --quantities sigma,fabric -o " + (folder / "f.h5"));
    ASSERT_EQ(out.code, 0) << out.err;
    EXPECT_THAT(out.out, HasSubstr("average: 14 points, 1 realization"));
    const Field field = field_of(folder / "f.h5");
    EXPECT_EQ(field.points.rows(), 14);
    EXPECT_EQ(field.word("method"), method);
    EXPECT_NE(field.find("fabric_xy"), nullptr);
    EXPECT_EQ(field.find("density"), nullptr);
    EXPECT_NEAR(field.points(13, 1), -field.number("h") / 2, 1e-12);
  }
}

TEST(Average, DoubtsAreNamed) {
  const Folder folder;
  dem::Snapshot pulled = test::layer(4), bare = test::layer(4);
  for (dem::Contact& c : pulled.contacts) {
    c.force = -c.force;
    c.normal_force = -c.normal_force;
  }
  bare.contacts.clear();
  int files = 0;
  const auto said = [&](const dem::Snapshot& s) {
    const std::string name = "s" + std::to_string(files++) + ".h5";
    const Output out =
        program("average " + written(folder, s, name) + " --cuts 0.5 -o " + (folder / "f.h5"));
    EXPECT_EQ(out.code, 0) << out.err;
    return out.err;
  };
  EXPECT_THAT(said(bare), HasSubstr("has no contacts: stress and fabric are 0"));
  EXPECT_THAT(said(pulled), HasSubstr("the contacts pull"));
  EXPECT_THAT(said(test::layer(4)), Not(HasSubstr("warning")));
  // Models that need a weight are not given one.
  const Output weightless =
      program("compare " + (folder / "f.h5") + " --model hydrostatic -o " + (folder / "c"));
  EXPECT_EQ(weightless.code, 2);
  EXPECT_THAT(weightless.err, HasSubstr("model hydrostatic: needs rho_g, the weight per volume"));
  EXPECT_EQ(program("compare " + (folder / "f.h5") + " --model hydrostatic:rho_g=1e4 -o " +
                    (folder / "c"))
                .code,
            0);
}

TEST(Average, HeapsAverageInScaledCoordinates) {
  const Folder folder;
  std::string files;
  for (int k = 0; k < 2; ++k) {  // the same heap, one 10 % larger
    dem::Snapshot s;
    const double d = 0.01 * (1 + 0.1 * k);
    s.gravity = {0, -9.81, 0};
    test::add_wall(s, "floor", {0, 0, 0}, {0, 1, 0});
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 2 * (12 - y) - 1; ++x)
        s.grains.push_back(test::disk(static_cast<std::int64_t>(s.grains.size()), (x + y) * d,
                                      (y + 0.5) * d, d / 2));
    files += " " + written(folder, s, "heap" + std::to_string(k) + ".h5");
  }
  const Output out = program("average" + files + " --frame heap --grid 21x11 --width 0.02 -o " +
                             (folder / "f.h5"));
  ASSERT_EQ(out.code, 0) << out.err;
  EXPECT_THAT(out.err, HasSubstr("14 of 189 points within the packing have fewer than 3 grains"));
  const Field field = field_of(folder / "f.h5");
  EXPECT_EQ(field.nx, 21);
  EXPECT_EQ(field.points(0, 1), -1);
  EXPECT_TRUE(field.is_of_heap());
  EXPECT_EQ(unit_of_points(folder / "f.h5"), "h");
  ASSERT_EQ(program("average" + files + " --grid 21x11 --width 0.02 -o " + (folder / "p.h5")).code,
            0);
  EXPECT_EQ(unit_of_points(folder / "p.h5"), "m");
  // Full below, empty beside the slopes.
  EXPECT_GT(field.find("volume_fraction")->value[10 + 21 * 3], 0.7);
  EXPECT_TRUE(std::isnan(field.find("volume_fraction")->value[21 * 10]));
}

TEST(Average, PrintsTheBalanceOfEveryAveraging) {
  const Folder folder;
  const std::string file = written(folder, test::layer(4, 14, 9), "s.h5");
  const Output out = program("average " + file + " --balance");
  ASSERT_EQ(out.code, 0) << out.err;
  EXPECT_THAT(out.out, HasSubstr("126 grains"));
  for (const char* row : {"[|] method +[|] weight +[|]", "[|] coarse_graining +[|] lucy +[|] 0[.]0",
                          "[|] area_exact +[|] square +[|]"}) {
    EXPECT_THAT(out.out, ::testing::ContainsRegex(row));
  }
}

TEST(Average, ThreeDimensions) {
  const Folder folder;
  dem::Snapshot s;
  s.dim = 3;
  for (int k = 0; k < 27; ++k) {
    dem::Grain g = test::disk(k, 0, 0, 0.5);
    g.position = {static_cast<double>(k % 3), static_cast<double>(k / 3 % 3),
                  static_cast<double>(k / 9)};
    g.volume = 0.5;
    g.moments.setConstant(0.05);
    s.grains.push_back(g);
  }
  const std::string start = "average " + written(folder, s, "s.h5") + " -o " + (folder / "f.h5");
  const std::string points = folder.write("p.csv", "x,y,z\n1,1,1\n");
  const Output out = program(start +
                             " --frame packing --method particle_centre --kernel square "
                             "--width 1.5 --points " +
                             points);
  ASSERT_EQ(out.code, 0) << out.err;
  EXPECT_NEAR(field_of(folder / "f.h5").find("volume_fraction")->value[0], 0.5, 1e-12);
}

// A floor under another name is no base: no profile of zeros.
TEST(Average, ResponseWithoutABaseHasNoBaseResponse) {
  for (const bool named : {true, false}) {
    const Folder folder;
    const std::string file = folder / "s.h5";
    for (const double load : {0., 3.}) {
      dem::Snapshot s = test::layer(4, 12, 6, false, load);
      if (!named) s.walls[0].name = "bottom";
      dem::write_snapshot(file, load > 0 ? "a/loaded" : "a/unloaded", s);
      const auto kernel = make_kernel("lucy", 0.01);
      const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(5, 0, 0.1);
      if (named) {
        EXPECT_LT(base_profile(s, x, *kernel).find("sigma_yy")->value.minCoeff(), 0);
        continue;
      }
      try {
        base_profile(s, x, *kernel);
        ADD_FAILURE();
      } catch (const std::invalid_argument& e) {
        EXPECT_THAT(e.what(), HasSubstr("nor a wall named \"floor\"; its walls: bottom, left"));
      }
    }
    const Output out = program("average " + file + " --response -o " + (folder / "f.h5"));
    EXPECT_EQ(out.code, 0) << out.err;
    EXPECT_EQ(out.out.find("base_response") != std::string::npos, named) << out.out;
    // A weight that is 0 by default is not asked for.
    const Output compare = program("compare " + (folder / "f.h5") +
                                   " --model fe_osl_layer:cells=8 -o " + (folder / "c"));
    EXPECT_EQ(compare.err.find("needs rho_g"), std::string::npos) << compare.err;
  }
}

TEST(Average, RefusesWithOneLine) {
  const Folder folder;
  const std::string start = "average " + written(folder, test::layer(4), "s.h5");
  const std::string end = " -o " + (folder / "f.h5");
  expect_refusal(program(start), "give -o FIELD.h5, or --balance, or both");
  expect_refusal(program(start + end + " --cuts 0.5,1.5"), "--cuts: found 1.5");
  expect_refusal(program(start + end + " --frame heaps"), "did you mean \"heap\"?");
  expect_refusal(program(start + end + " --quantities stress"), "unknown quantity \"stress\"");
  expect_refusal(program(start + end + " --free-surface opn"), "did you mean \"open\"?");
  expect_refusal(program(start + end + " --method area_exact --kernel lucy"),
                 "unknown kernel of area_exact");
  expect_refusal(program(start + end + " --width 0"), "--width: found 0, allowed: above 0");
  expect_refusal(program(start + end + " --least-grains -1"),
                 "averages from at least -1 grains; it must be 0 or more");
  const std::string own = folder / "s.h5";
  expect_refusal(program(start + " -o " + folder.path() + "/../" +
                         testing::fs::path(folder.path()).filename().string() + "/s.h5"),
                 "s.h5 is an input and would be replaced; name another file");
  EXPECT_EQ(dem::read_snapshot(own, "state").grains.size(), test::layer(4).grains.size());
  dem::Snapshot weightless = test::layer(4);
  weightless.gravity.setZero();
  expect_refusal(program("average " + written(folder, weightless, "w.h5") + " --balance"),
                 "the packing's gravity is 0 0 m/s2; what the averagings carry");
  dem::Snapshot swapped = test::layer(4);
  std::swap(swapped.walls[1].point, swapped.walls[2].point);
  expect_refusal(program("average " + written(folder, swapped, "x.h5") + end),
                 "no free grain lies between the packing's sides at x = 0.12 and 0 m");
  dem::Snapshot lost = test::layer(4);
  lost.grains[3].position.x() = std::nan("");
  expect_refusal(program("average " + written(folder, lost, "lost.h5") + end),
                 "position of grain 3 is nan; it must be a finite number");
  EXPECT_FALSE(testing::fs::exists(folder / "f.h5"));
}

}  // namespace
}  // namespace grainfield::coupling
