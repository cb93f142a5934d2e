// The commands on good input, through the real program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "coupling/result/tables.h"
#include "coupling/run/summary_keys.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;
using testing::tiny_case;

TEST(Commands, QuickOnesNeedLittleTime) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "a sanitized program is slower";
#endif
  const Folder folder;
  const std::string file = folder.write("x.toml", tiny_case());
  for (const std::string command : {"keys", "cases", "model", "check "}) {
    // The best of several starts counts: the machine may be busy with something else.
    double best = 1e9;
    for (int n = 0; n < 3; ++n) {
      const auto start = std::chrono::steady_clock::now();
      ASSERT_EQ(program(command == "check " ? command + file : command).code, 0);
      best = std::min(
          best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    EXPECT_LT(best, 0.2) << command;
  }
}

TEST(Commands, ModelsOfSpaceInCylindricalAxes) {
  const Folder folder;
  const std::string points = folder.write("p.csv", "x,y,z\n0.3,0,-1\n0,-0.3,-1\n");
  const Output plain = program("model boussinesq --points " + points);
  const Output turned = program("model boussinesq --cylindrical --points " + points);
  EXPECT_THAT(turned.out, ::testing::StartsWith(
                              "x,y,z,sigma_rr,sigma_tt,sigma_zz,sigma_tz,sigma_rz,sigma_rt\n"));
  const auto row = [](const std::string& text, int line) {
    std::vector<double> out;
    std::size_t at = 0;
    for (int k = 0; k < line; ++k) at = text.find('\n', at) + 1;
    const std::size_t end = text.find('\n', at);
    for (; at < end; at = std::min(text.find(',', at), end) + 1)
      out.push_back(std::stod(text.substr(at)));
    return out;
  };
  const auto first = row(turned.out, 1), second = row(turned.out, 2), cartesian = row(plain.out, 1);
  ASSERT_EQ(first.size(), 9u);
  for (std::size_t c = 3; c < 9; ++c) {
    EXPECT_NEAR(first[c], cartesian[c], 1e-14);
    EXPECT_NEAR(second[c], first[c], 1e-14);
  }
  const std::string plane = folder.write("q.csv", "x,y\n0,-1\n");
  const Output refused = program("model layer --cylindrical --points " + plane);
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err,
              HasSubstr("--cylindrical is for models of space; layer without --set dim=3"
                        " is of the plane"));
}

TEST(Commands, KeysAndCases) {
  EXPECT_THAT(program("keys material").out, HasSubstr("friction = 0.5"));
  EXPECT_THAT(program("keys fit.heights material.young").out,
              ::testing::AllOf(HasSubstr("  heights = "), HasSubstr("  young = ")));
  EXPECT_EQ(program("keys pile-point-source").out, program("keys pile").out);
  EXPECT_THAT(program("keys --summary").out, HasSubstr("response.total_over_load"));
  const Output cases = program("cases");
  EXPECT_THAT(cases.out, HasSubstr("point-load-mono.toml"));
  EXPECT_THAT(cases.out, HasSubstr("elastic-half-space.toml"));
}

TEST(Commands, CasesAreFoundByTheirNames) {
  const Folder folder;
  const std::string there = "cd " + folder.path() + " &&";
  for (const std::string name : {"fit-osl-point", "fit-osl-point.toml"}) {
    const Output shipped = program("check " + name, there);
    EXPECT_EQ(shipped.code, 0) << shipped.err;
    EXPECT_THAT(shipped.out, HasSubstr("fit-osl-point.toml: ok (pile)\n"));
  }
  const Output unknown = program("run fit-ols-point", there);
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err,
              HasSubstr("fit-ols-point: no such file, and no shipped case; did you mean "
                        "fit-osl-point? (grainfield cases)"));
  EXPECT_THAT(program("run nofile.toml", there).err,
              HasSubstr("nofile.toml: no such file, and no shipped case (grainfield cases)"));
  // A path is meant as it stands.
  EXPECT_EQ(program("check nowhere/fit-osl-point.toml", there).code, 2);
  // A folder of results does not hide the case, a file does.
  testing::fs::create_directory(folder / "fit-osl-point");
  EXPECT_EQ(program("check fit-osl-point", there).code, 0);
  folder.write("fit-osl-point.toml", tiny_case());
  for (const std::string name : {"fit-osl-point", "fit-osl-point.toml"}) {
    EXPECT_THAT(program("check " + name, there).out, HasSubstr("ok (point-load, compared with "));
  }
}

TEST(Commands, AnInstalledProgramKnowsItsCases) {
  const Folder folder;
  testing::fs::create_directories(folder / "bin");
  testing::fs::create_directories(folder / "share/grainfield/cases");
  testing::fs::copy(GRAINFIELD_PROGRAM, folder / "bin/grainfield");
  folder.write("share/grainfield/cases/small-layer.toml", tiny_case());
  const auto run = [&](const std::string& arguments) {
    return std::system(
        (folder / "bin/grainfield " + arguments + " > " + (folder / "out") + " 2>&1").c_str());
  };
  EXPECT_EQ(run("check small-layer"), 0) << testing::read_text(folder / "out");
  EXPECT_THAT(testing::read_text(folder / "out"), HasSubstr("small-layer.toml: ok (point-load"));
  EXPECT_EQ(run("cases"), 0);
  EXPECT_THAT(testing::read_text(folder / "out"), HasSubstr("tiny"));
  EXPECT_NE(run("check fit-osl-point"), 0);
}

TEST(Commands, ModelWritesAllDigits) {
  const Folder folder;
  const std::string points = folder.write("p.csv", "# remark\ny,x,more\n-1,0,7\n-2,0.5,7\n1,0,7\n");
  const Output output = program("model flamant --set F=3.141592653589793 --points " + points);
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.out, HasSubstr("x,y,sigma_xx,sigma_yy,sigma_xy\n0,-1,"));
  EXPECT_THAT(output.out, HasSubstr("\n0,1,nan,nan,nan\n"));  // above the surface
  // 2 F / (pi y) right below the load.
  const std::size_t at = output.out.find("0,-1,") + 5;
  const double yy = std::stod(output.out.substr(output.out.find(',', at) + 1));
  EXPECT_NEAR(yy, -2, 1e-14);
  EXPECT_EQ(program("model flamant --points " + points + " -o " + (folder / "o.csv")).code, 0);
  EXPECT_THAT(testing::read_text(folder / "o.csv"), HasSubstr("sigma_yy"));
}

TEST(Commands, ModelTellsWhatElseItKnows) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitized program is built without finite elements";
#endif
  const Folder folder;
  const std::string points = folder.write("p.csv", "x,y\n0,-0.5\n9,-0.5\n");
  const std::string heap = "model fe_mohr_coulomb_wedge --set cells=4 --set left_deg=20 ";
  const Output output = program(heap + "--all --figures --points " + points);
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(output.out.rfind("# ", 0), 0U);
  EXPECT_THAT(output.out, HasSubstr("# unknowns = 90\n"));
  EXPECT_THAT(output.out, HasSubstr("\nx,y,sigma_xx,sigma_yy,sigma_xy,sigma_zz,displacement_x,"
                                    "displacement_y,mobilized,plastic,plastic_shear,"
                                    "plastic_volume\n0,-0.5,"));
  EXPECT_THAT(output.out, HasSubstr("\n9,-0.5,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan\n"));
  // Without cohesion nothing holds a heap on a smooth base: a computation that fails.
  const Output slides = program(heap + "--set base=smooth --points " + points);
  EXPECT_EQ(slides.code, 3);
  EXPECT_THAT(slides.err, HasSubstr("a heap on a smooth base slides apart"));
}

TEST(Commands, ModelListsItsParameters) {
  const Output output = program("model layer --list");
  EXPECT_THAT(output.out, HasSubstr("nu = 0.3"));
  EXPECT_THAT(output.out, HasSubstr("smooth | rough"));
}

TEST(Commands, RunAverageCompareInfo) {
  const Folder folder;
  const std::string file = folder.write("x.toml", tiny_case());
  const Output run = program("run " + file + " -o " + (folder / "out"));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("report: " + (folder / "out/report.html")));
  for (const char* name :
       {"summary.json", "profiles.csv", "profiles.md", "profiles.tex", "fields.h5", "fields.xdmf",
        "snapshots.h5", "states/grains_loaded.vtu", "report.html", "case.toml"}) {
    EXPECT_TRUE(testing::fs::exists(folder / ("out/" + std::string(name)))) << name;
  }
  EXPECT_FALSE(testing::fs::exists(folder / "out/checkpoint"));
  EXPECT_FALSE(testing::fs::exists(folder / "out/.partial"));

  const Summary summary = read_summary(folder / "out/summary.json");
  EXPECT_NO_THROW(require_documented(summary));
  for (const char* key :
       {"dem.grains", "dem.contacts", "dem.steps", "dem.unbalanced_force_ratio",
        "dem.kinetic_to_elastic_energy", "dem.volume_fraction", "base.weight_ratio",
        "response.total_over_load", "response.peak", "response.width", "response.peaks",
        "compare.flamant.rel_l2", "compare.rough.max", "compare.rough.chi2_per_dof",
        "verdict.best_model", "time.dem_s", "memory.peak_MB", "time.continuum_s",
        "load.contacts_lost.most"}) {
    EXPECT_EQ(summary.count(key), 1U) << key;
  }
  EXPECT_NEAR(std::get<double>(summary.at("base.weight_ratio")), 1, 1e-3);
  EXPECT_NEAR(std::get<double>(summary.at("response.total_over_load")), 1, 1e-2);

  const Output info = program("info " + (folder / "out/snapshots.h5"));
  EXPECT_THAT(info.out, HasSubstr("realization_002/unloaded: 2D, "));
  EXPECT_THAT(info.out, HasSubstr("seed"));
  EXPECT_THAT(program("info " + (folder / "out/fields.h5")).out, HasSubstr("sigma_yy (N/m)"));

  // The steps of the run on their own give the run's field.
  const Output average = program("average " + (folder / "out/snapshots.h5") +
                                 " --response --grid 5x4 -o " + (folder / "f.h5"));
  ASSERT_EQ(average.code, 0) << average.err;
  EXPECT_THAT(average.out, HasSubstr("response: 20 points, 3 realizations"));
  const Output compare =
      program("compare " + (folder / "f.h5") +
              " --model flamant --model layer:base=rough --model layer -o " + (folder / "c"));
  ASSERT_EQ(compare.code, 0) << compare.err;
  const Summary again = read_summary(folder / "c/summary.json");
  EXPECT_EQ(again.count("compare.layer.rel_l2"), 1U);
  EXPECT_EQ(again.count("compare.layer_2.rel_l2"), 1U);
  // By the run's own fields the verdict is the run's.
  const Output same =
      program("compare " + (folder / "out/fields.h5") + " --model flamant -o " + (folder / "d"));
  ASSERT_EQ(same.code, 0) << same.err;
  const Summary judged = read_summary(folder / "d/summary.json");
  for (const char* figure : {"chi2_per_dof", "chance", "rel_l2"}) {
    const std::string key = std::string("compare.flamant.") + figure;
    EXPECT_NEAR(std::get<double>(judged.at(key)), std::get<double>(summary.at(key)),
                1e-9 * std::get<double>(summary.at(key)))
        << key;
  }
}

TEST(Commands, TheWrittenCaseRunsToTheSameResult) {
  const Folder folder;
  const std::string quiet = "[output]\nvtu = false\nreport = false\n";
  ASSERT_EQ(
      program("run " + folder.write("x.toml", tiny_case(quiet)) + " -o " + (folder / "a")).code, 0);
  testing::fs::create_directory(folder / "again");
  testing::fs::copy(folder / "a/case.toml", folder / "again/x.toml");
  ASSERT_EQ(program("run " + (folder / "again/x.toml") + " -o " + (folder / "b")).code, 0);
  EXPECT_EQ(testing::contents(folder / "a"), testing::contents(folder / "b"));
}

TEST(Commands, SweepLeavesOneFolderPerValueAndASummary) {
  const Folder folder;
  const std::string text = tiny_case(
      "[output]\nvtu = false\n[sweep]\nkey = \"material.friction\"\nvalues = [0.3, 0.6]\n");
  const std::string file = folder.write("x.toml", text);
  const Output run = program("run " + file + " --set ensemble.realizations=1 --set " +
                             "'average.depths=[0.4, 0.6]' --threads 1 -o " + (folder / "out"));
  ASSERT_EQ(run.code, 0) << run.err;
  const Summary all = read_summary(folder / "out/summary.json");
  const Summary one = read_summary(folder / "out/friction_0.6/summary.json");
  // What decides the numbers, ready for a shell.
  const std::string command =
      "grainfield run " + file + " --set ensemble.realizations=1 --set 'average.depths=[0.4, 0.6]'";
  EXPECT_EQ(std::get<std::string>(all.at("case.command")), command);
  EXPECT_EQ(std::get<std::string>(one.at("case.command")), command);
  EXPECT_THAT(testing::read_text(folder / "out/friction_0.6/report.html"),
              HasSubstr("ensemble.realizations=1"));
  EXPECT_EQ(all.at("response.peak.friction_0.6"), one.at("response.peak"));
  EXPECT_NE(all.at("response.peak.friction_0.6"), all.at("response.peak.friction_0.3"));
  EXPECT_TRUE(testing::fs::exists(folder / "out/report.html"));
  EXPECT_TRUE(testing::fs::exists(folder / "out/friction_0.3/report.html"));
}

TEST(Commands, ElasticStudyWithoutGrains) {
  const Folder folder;
  const std::string text = R"(study = "elastic-layer"
[problem]
points = 21
depths = [0.075, 0.15]
[compare]
models = ["layer", "rough", "flamant"]
[model.rough]
name = "layer"
base = "rough"
)";
  const Output run = program("run " + folder.write("x.toml", text) + " -o " + (folder / "out"));
  ASSERT_EQ(run.code, 0) << run.err;
  const Summary s = read_summary(folder / "out/summary.json");
  // physics.md section 4: 0.9195 F/h on a smooth base, 0.807 on a rough one at nu = 0.3, 2/pi.
  EXPECT_NEAR(std::get<double>(s.at("response.peak_over_F_per_h")), 0.9195, 1e-4);
  EXPECT_NEAR(std::get<double>(s.at("compare.rough.peak_over_F_per_h")), 0.8078, 1e-3);
  EXPECT_NEAR(std::get<double>(s.at("compare.flamant.peak_over_F_per_h")), 2 / M_PI, 1e-12);
}

}  // namespace
}  // namespace grainfield::coupling
