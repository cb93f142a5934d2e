// `grainfield average`, `strain` and `compare` of packings of spheres.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "continuum/model.h"
#include "coupling/averaging/kernel.h"
#include "coupling/averaging/layer.h"
#include "coupling/averaging/points.h"
#include "coupling/compare/smooth.h"
#include "coupling/store/field_io.h"
#include "tests/coupling/averaging_scene.h"
#include "tests/coupling/program.h"
#include "tests/coupling/settled_spheres_scene.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;
using ::testing::StartsWith;

std::string written(const Folder& folder, const dem::Snapshot& snapshot, const std::string& name) {
  dem::write_snapshot(folder / name, "state", snapshot);
  return folder / name;
}

void expect_refusal(const Output& output, const std::string& words) {
  EXPECT_EQ(output.code, 2) << output.err;
  EXPECT_THAT(output.err, HasSubstr(words));
  EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
}

TEST(AverageSpace, GridsCutsAndTables) {
  const Folder folder;
  const dem::Snapshot& s = test::settled_spheres();
  const std::string start =
      "average " + written(folder, s, "s.h5") + " --quantities sigma,density ";
  for (const char* frame : {"layer", "packing"}) {
    const Output out =
        program(start + "--frame " + frame + " --grid 5x4x6 -o " + (folder / "f.h5"));
    ASSERT_EQ(out.code, 0) << out.err;
    EXPECT_THAT(out.out, HasSubstr("average: 120 points"));
    const Field f = read_field(folder / "f.h5", "average");
    EXPECT_EQ(f.nx, 5);
    EXPECT_EQ(f.ny, 4);
    EXPECT_EQ(f.nz, 6);
    const double low = frame == std::string("layer") ? -test::kBoxSide / 2 : 0;
    EXPECT_NEAR(f.points(0, 0), low, 1e-12);
    EXPECT_NEAR(f.points(5, 1), low + test::kBoxSide / 3, 1e-12);
    EXPECT_NEAR(f.points(119, 2), frame == std::string("layer") ? 0 : layer_frame(s).surface,
                1e-12);
    EXPECT_THAT(testing::read_text(folder / "f.xdmf"),
                HasSubstr("TopologyType=\"3DSMesh\" Dimensions=\"6 4 5\""));
    // In the middle of the floor the weight above.
    EXPECT_LT(f.find("sigma_zz")->value[12], -300);
    EXPECT_THAT(program("info " + (folder / "f.h5")).out, HasSubstr("3D (grid 5 x 4 x 6)"));
  }
  // Walls: into them by default, or as a force density at the floor.
  const std::string floor = folder.write("p.csv", "x,y,z\n0.03,0.03,0\n");
  double into = 0;
  for (const std::string walls : {"", " --end-at-walls"}) {
    const Output out = program("average " + (folder / "s.h5") + " --frame packing --points " +
                               floor + " -o " + (folder / "w.h5") + walls);
    ASSERT_EQ(out.code, 0) << out.err;
    const Field f = read_field(folder / "w.h5", "average");
    if (walls.empty()) {
      EXPECT_EQ(f.find("traction_z")->value[0], 0);
      into = f.find("sigma_zz")->value[0];
      EXPECT_LT(into, -200);
    } else {
      EXPECT_GT(f.find("traction_z")->value[0], 1e4);
      EXPECT_GT(f.find("sigma_zz")->value[0], 0.9 * into);
    }
  }
  const Output usual = program(start + "-o " + (folder / "g.h5"));
  EXPECT_THAT(usual.out, HasSubstr("average: 20181 points"));
  const Output cuts = program(start + "--cuts 0,0.5 --grid 3x4 -o " + (folder / "c.csv"));
  ASSERT_EQ(cuts.code, 0) << cuts.err;
  const std::string table = testing::read_text(folder / "c.csv");
  EXPECT_THAT(
      table,
      HasSubstr(
          "tension positive\nx (m),y (m),z (m),sigma_xx (N/m2),sigma_yy (N/m2),sigma_zz (N/m2),"
          "sigma_yz (N/m2),sigma_zy (N/m2),sigma_xz (N/m2),sigma_zx (N/m2),"
          "sigma_xy (N/m2),sigma_yx (N/m2),density (kg/m3)\n-0.03,-0.03,-0."));
  EXPECT_THAT(table, StartsWith("# frame layer: load at (0, 0, 0), surface z = 0; "));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 26);
  const Output balance = program("average " + (folder / "s.h5") + " --balance");
  ASSERT_EQ(balance.code, 0) << balance.err;
  EXPECT_THAT(balance.out, ::testing::ContainsRegex("[|] coarse_graining [|] lucy +[|] 0[.]0"));
}

TEST(AverageSpace, RingsAboutTheAxisOfAFrame) {
  const Folder folder;
  const std::string start =
      "average " + written(folder, test::settled_spheres(), "s.h5") + " --rings ";
  const Output layer = program(start + "--grid 4x3 -o " + (folder / "f.h5"));
  ASSERT_EQ(layer.code, 0) << layer.err;
  const Field f = read_field(folder / "f.h5", "average");
  EXPECT_EQ(f.points.rows(), 12);
  EXPECT_EQ(f.points(0, 0), 0);
  EXPECT_NEAR(f.points(3, 0), test::kBoxSide / 2, 1e-12);
  EXPECT_EQ(f.word("frame"), "layer");
  EXPECT_TRUE(f.is_of_rings());
  EXPECT_LT(f.find("sigma_zz")->value[0], -300);
  EXPECT_LT(f.find("sigma_tt")->value[1], 0);
  EXPECT_NE(f.find("fabric_rz"), nullptr);
  const std::string points = folder.write("p.csv", "z,r\n0.02,0.01\n");
  const Output packing = program(start + "--frame packing --axis 0.02,0.03 --points " + points +
                                 " -o " + (folder / "p.out.csv"));
  ASSERT_EQ(packing.code, 0) << packing.err;
  EXPECT_THAT(
      testing::read_text(folder / "p.out.csv"),
      HasSubstr("tension positive\nr (m),z (m),sigma_rr (N/m2),sigma_tt (N/m2),sigma_zz (N/m2),"));
  expect_refusal(program(start + "--frame packing --axis 0.2,0.03 -o " + (folder / "x.h5")),
                 "--axis: (0.2, 0.03) is outside the packing");
}

TEST(AverageSpace, HeapsAreConesInUnitsOfTheirHeight) {
  const Folder folder;
  const double d = 0.01;
  dem::Snapshot s;
  s.dim = 3;
  s.gravity = {0, 0, -9.81};
  for (int k = -25; k <= 25; ++k)
    for (int j = -25; j <= 25; ++j)
      for (int i = 0; i < 12; ++i) {
        if (i + 0.5 > 12 - 0.6 * std::hypot(k, j)) continue;
        dem::Grain g = test::disk(static_cast<std::int64_t>(s.grains.size()), 0, 0, d / 2);
        g.position = d * dem::Vec3(k, j, i + 0.5);
        g.volume *= 4 * g.radius / 3;
        g.moments.setConstant(g.inertia);
        s.grains.push_back(g);
      }
  test::add_wall(s, "floor", {0, 0, 0}, {0, 0, 1});
  const Output out = program("average " + written(folder, s, "s.h5") +
                             " --frame heap --grid 9x9x5 --width 0.02 -o " + (folder / "f.h5"));
  ASSERT_EQ(out.code, 0) << out.err;
  const Field f = read_field(folder / "f.h5", "average");
  EXPECT_TRUE(f.is_over_height());
  EXPECT_NEAR(f.number("h"), 12 * d, d);
  EXPECT_NEAR(f.number("left_deg"), 31, 2);
  EXPECT_EQ(f.points(0, 2), -1);
  EXPECT_GT(f.find("volume_fraction")->value[40 + 81], 0.45);  // inside, above the floor
  EXPECT_TRUE(std::isnan(f.find("volume_fraction")->value[81 * 4]));
}

TEST(AverageSpace, RefusesWithOneLine) {
  const Folder folder;
  const std::string solid = "average " + written(folder, test::settled_spheres(), "s.h5"),
                    flat = "average " + written(folder, test::layer(4), "d.h5"),
                    end = " -o " + (folder / "f.h5");
  expect_refusal(program(solid + end + " --grid 9x9"),
                 "--grid: found 9 x 9, allowed: COLUMNSxROWSxLAYERS, the snapshot is 3D");
  expect_refusal(program(flat + end + " --grid 9x9x9"),
                 "--grid: found 9 x 9 x 9, allowed: COLUMNSxROWS, the snapshot is 2D");
  expect_refusal(program(solid + end + " --rings --grid 9x9x9"), "allowed: RADIIxHEIGHTS of rings");
  expect_refusal(program(flat + end + " --rings"), "averages over rings need a 3D one");
  expect_refusal(program(solid + end + " --axis 0,0 --frame packing"),
                 "--axis: it is that of --rings");
  expect_refusal(program(solid + end + " --axis 0,0 --rings"), "frame layer has its own axis");
  expect_refusal(program(solid + " " + (folder / "d.h5") + end),
                 "is 2D, the snapshot before it 3D");
  expect_refusal(program(solid + end + " --grid 2x2x"), "or COLUMNSxROWSxLAYERS");
  expect_refusal(program(solid + end + " --grid 200x200x200"), "8e+06 points");
}

TEST(StrainSpace, GivesAnAffineStrainBack) {
  const Folder folder;
  const dem::Snapshot& before = test::settled_spheres();
  dem::Snapshot after = before;
  Eigen::Matrix3d b;
  b << 1e-4, 3e-4, 0, -1e-4, -2e-4, 1e-4, 2e-4, 0, -3e-4;
  for (dem::Grain& g : after.grains) g.position += b * g.position;
  const std::string first = written(folder, before, "a.h5"),
                    second = written(folder, after, "b.h5");
  for (const std::string measure : {"cambou", "cundall", "derivative", "kernel"}) {
    const Output run =
        program("strain " + first + ":state " + second + ":state --grid 3x3x4 --measure " +
                measure + " -o " + (folder / "e.h5"));
    ASSERT_EQ(run.code, 0) << run.err;
    const Field f = read_field(folder / "e.h5", "strain");
    EXPECT_EQ(f.nz, 4);
    int values = 0;
    for (Eigen::Index k = 0; k < f.points.rows(); ++k) {
      if (!std::isfinite(f.find("strain_zz")->value[k])) continue;
      ++values;
      EXPECT_NEAR(f.find("strain_zz")->value[k], -3e-4, 1e-11) << measure;
      EXPECT_NEAR(f.find("strain_xz")->value[k], 1e-4, 1e-11);
      EXPECT_NEAR(f.find("rotation_z")->value[k], -2e-4, 1e-11);
    }
    EXPECT_GT(values, 10) << measure;
  }
  expect_refusal(
      program("strain " + first + ":state " + second + ":state --grid 3x3 -o " + (folder / "e.h5")),
      "--grid: found 3 x 3, allowed: COLUMNSxROWSxLAYERS, the snapshot is 3D");
}

// What Boussinesq's half space gives through the kernel, as a field of places or of rings.
Field half_space(bool rings, double factor) {
  const double h = 0.1, load = 3;
  Field f;
  f.points = rings ? grid_points(0, 0.15, 31, -0.075, -0.025, 3)
                   : box_points({-0.15, -0.01, -0.075}, {0.15, 0.01, -0.025}, 31, 3, 3);
  Eigen::MatrixXd at = f.points;
  if (rings) {
    at.resize(f.points.rows(), 3);
    at << f.points.col(0), Eigen::VectorXd::Zero(f.points.rows()), f.points.col(1);
  }
  f.nx = 31;
  f.ny = 3;
  f.nz = rings ? 0 : 3;
  const auto model = continuum::make_model("boussinesq", {{"F", "3"}});
  const auto kernel = make_kernel("lucy", 0.01, 3);
  const Eigen::MatrixXd stress =
      nodes_in_space(at, *kernel, 0).of([&](const Eigen::MatrixXd& p) -> Eigen::MatrixXd {
        return model->stress(p);
      });
  const std::vector<std::string> names =
      rings ? std::vector<std::string>{"sigma_rr", "sigma_tt", "sigma_zz", "", "sigma_rz", ""}
            : kSpaceStress;
  for (std::size_t c = 0; c < 6; ++c)
    if (!names[c].empty())
      f.add(names[c], "N/m2").value = factor * stress.col(static_cast<Eigen::Index>(c));
  f.attributes = {{"method", "coarse_graining"},
                  {"kernel", "lucy"},
                  {"width", 0.01},
                  {"h", h},
                  {"F", load},
                  {"frame", "layer"}};
  if (rings) f.attributes["rings"] = 1.0;
  return f;
}

TEST(CompareSpace, ModelsAreSeenAtTheSamePlaces) {
  for (const bool rings : {false, true}) {
    const Folder folder;
    write_fields(folder / "f.h5", {{"response", half_space(rings, 1.1)}});
    const std::string components =
        rings ? "sigma_zz,sigma_rr,sigma_tt,sigma_rz" : "sigma_zz,sigma_xz";
    const Output out =
        program("compare " + (folder / "f.h5") + " --model boussinesq --components " + components +
                " -o " + (folder / "c"));
    ASSERT_EQ(out.code, 0) << out.err << out.out;
    const auto summary =
        nlohmann::json::parse(testing::read_text((folder / "c") + "/summary.json"));
    // All values are the model's and a tenth.
    EXPECT_NEAR(summary.at("compare.boussinesq.rel_l2").get<double>(), 0.1 / 1.1, 1e-3);
    EXPECT_NEAR(summary.at("layer.F_over_h2").get<double>(), 300, 1e-9);
    EXPECT_THAT(testing::read_text((folder / "c") + "/profiles.csv"), HasSubstr("F/h^2"));
    // A layer takes the dimension from the field; a deep one is the half space.
    if (rings) {
      const Output deep = program("compare " + (folder / "f.h5") +
                                  " --model boussinesq --model layer:h=100 -o " + (folder / "b"));
      ASSERT_EQ(deep.code, 0) << deep.err << deep.out;
      const auto two = nlohmann::json::parse(testing::read_text((folder / "b") + "/summary.json"));
      EXPECT_NEAR(two.at("compare.layer.rel_l2").get<double>(),
                  two.at("compare.boussinesq.rel_l2").get<double>(), 1e-4);
    }
    expect_refusal(
        program("compare " + (folder / "f.h5") + " --model flamant -o " + (folder / "d")),
        "model flamant: is 2D, the field in");
  }
}

}  // namespace
}  // namespace grainfield::coupling
