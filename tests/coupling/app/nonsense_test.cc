// Nonsense that was once taken in silence: every key with what is no value of it, settings with a
// second line, packings named twice, forces beyond all bounds, normals across, models of another
// body.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <set>

#include "coupling/models/subject.h"
#include "coupling/tasks/average_task.h"
#include "tests/coupling/check_scene.h"

namespace grainfield::coupling {
namespace {

using testing::complaint;
using testing::complaint_of;
using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Output;
using testing::program;

// What is no value of a key of this type, as TOML.
std::vector<std::string> no_values_of(const Key& key) {
  const std::string type = type_name(key);
  std::vector<std::string> out = {"1979-05-27", "{}", "[[1]]"};
  if (type.find("number") != std::string::npos) {
    for (const char* text : {"nan", "inf", "-inf", "true", "\"much\""}) out.emplace_back(text);
    if (key.most < 1e300) out.emplace_back("1e300");
    if (key.least > -1e300) out.emplace_back("-1e300");
  }
  if (type == "integer") {
    for (const char* text :
         {"nan", "0.5", "true", "\"many\"", "9007199254740993", "-9223372036854775808"})
      out.emplace_back(text);
  }
  if (type == "boolean") {
    for (const char* text : {"1", "\"yes\"", "nan"}) out.emplace_back(text);
  }
  if (type == "word") out.emplace_back("\"no such word\"");
  if (type.starts_with("list of numbers")) {
    for (std::string& text : out) text = "[" + text + "]";
  }
  return out;
}

TEST(Nonsense, WhatIsNoValueOfAKeyIsRefusedByItsName) {
  std::set<std::string> seen;
  int refused = 0;
  for (const Study& study : studies()) {
    const Folder folder;
    for (const Key& key : keys()) {
      if (!key_applies(key, study.name) || !seen.insert(key.path()).second) continue;
      for (const std::string& value : no_values_of(key)) {
        const std::string text = key.section.empty()
                                     ? fmt::format("{} = {}\n", key.name, value)
                                     : fmt::format("study = \"{}\"\n[{}]\n{} = {}\n", study.name,
                                                   key.section, key.name, value);
        const std::string what = complaint_of(folder.write("x.toml", text));
        EXPECT_THAT(what, HasSubstr(key.path())) << text;
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 2000);
}

TEST(Nonsense, ASettingHasOneLine) {
  EXPECT_THAT(complaint("study = \"point-load\"\n", {"load.force=1\nfoo.bar=3"}),
              HasSubstr("--set: load.force: found another line behind its value"));
  EXPECT_THAT(complaint("study = \"point-load\"\n", {"load.force=1\n[foo]"}),
              HasSubstr("--set: load.force: found another line behind its value"));
}

TEST(Nonsense, ASeedThatADoubleCannotHoldIsRefused) {
  EXPECT_THAT(complaint("study = \"point-load\"\n", {"ensemble.seed=9007199254740993"}),
              HasSubstr("found 9007199254740993, allowed: 0 to 9007199254740992"));
  EXPECT_EQ(complaint("study = \"point-load\"\n", {"ensemble.seed=9007199254740992"}), "");
}

TEST(Nonsense, ASweepOverVariantsWithoutValuesNamesThem) {
  EXPECT_THAT(complaint("study = \"point-load\"\n[sweep]\nkey = \"variant\"\n[variant.soft.load]\n"
                        "force = 1\n[variant.hard.load]\nforce = 2\n"),
              HasSubstr("sweep.key: needs sweep.values as well, of: soft, hard"));
}

TEST(Nonsense, ModelsOfAnotherBodyAreRefused) {
  EXPECT_THAT(
      complaint("study = \"point-load\"\n[compare]\nmodels = [\"flamant\", \"hydrostatic\"]\n"),
      HasSubstr("compare.models: found \"hydrostatic\", which is no model of a body under a "
                "load, allowed: flamant"));
  EXPECT_THAT(complaint("study = \"pile\"\n[compare]\nmodels = [\"layer\"]\n"),
              HasSubstr("compare.models: found \"layer\", which is no model of a heap under its "
                        "weight, allowed: "));
  for (const char* study :
       {"elastic-layer", "elastic-half-space", "osl-layer", "orthotropic-layer"})
    EXPECT_THAT(complaint(fmt::format("study = \"{}\"\n[compare]\nmodels = [\"flamant\", "
                                      "\"hydrostatic\"]\n",
                                      study)),
                HasSubstr("compare.models: found \"hydrostatic\", which is no model of a body"));
  for (const char* study : {"osl-wedge", "wedge-core", "wedge", "lattice-pile"})
    EXPECT_THAT(complaint(fmt::format("study = \"{}\"\n[compare]\nmodels = [\"cantelaube\", "
                                      "\"layer\"]\n",
                                      study)),
                HasSubstr("compare.models: found \"layer\", which is no model of a heap"));
  int loads = 0, heaps = 0;
  for (const continuum::ModelInfo& info : continuum::registry()) {
    EXPECT_NE(is_of(info, Subject::load), is_of(info, Subject::heap)) << info.name;
    loads += is_of(info, Subject::load);
    heaps += is_of(info, Subject::heap);
  }
  EXPECT_GT(loads, 5);
  EXPECT_GT(heaps, 5);
}

TEST(Nonsense, ALoadThatPullsIsRefused) {
  const Folder folder;
  const std::string points = folder.write("p.csv", "x,y\n0,-0.1\n");
  for (const char* model : {"flamant", "layer --set h=1", "osl_layer --set h=1"}) {
    const Output output = program(fmt::format("model {} --set F=-3 --points {}", model, points));
    EXPECT_EQ(output.code, 2) << output.err;
    EXPECT_THAT(output.err, HasSubstr("F = -3 is out of range; allowed: at least 0 N")) << model;
  }
}

// Two disks on a floor and a third on them.
constexpr const char* kGrains =
    "id,x,y,radius,density\n0,0,0.005,0.005,5000\n1,0.01,0.005,0.005,5000\n"
    "2,0.005,0.0135,0.005,5000\n";
constexpr const char* kFloor = "name,x,y,nx,ny\nfloor,0,0,0,1\n";

Output imported(const Folder& folder, const std::string& contact) {
  const std::string grains = folder.write("g.csv", kGrains);
  const std::string walls = folder.write("w.csv", kFloor);
  const std::string contacts =
      folder.write("c.csv", "i,j,px,py,nx,ny,fx,fy\n0,floor,0,0,0,-1,0,5\n" + contact + "\n");
  return program("import --from csv " + grains + " " + contacts + " " + walls + " -o " +
                 (folder / "o.h5"));
}

TEST(Nonsense, ForcesBeyondAllBoundsAreRefused) {
  const Folder folder;
  const Output output = imported(folder, "0,2,0.0025,0.009,0.5,0.86,0,-1e300");
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr("c.csv:3: found a force of 1e+300 N, allowed: up to 1e+100 N"));
}

TEST(Nonsense, NormalsAcrossTheLineOfCentresAreWarnedOf) {
  const Folder folder;
  const Output across = imported(folder, "0,2,0.0025,0.009,0.86,-0.5,0,-1");
  EXPECT_EQ(across.code, 0) << across.err;
  EXPECT_THAT(across.err,
              HasSubstr("1 of 1 contacts between round grains have a normal more than 60 "
                        "degrees off the line of centres (the first: 0 and 2)"));
  const Folder other;
  EXPECT_THAT(imported(other, "0,2,0.0025,0.009,0.5,0.866,0,-1").err, Not(HasSubstr("normal")));
}

TEST(Nonsense, CopiesAndStatesOfAPackingAreNoEnsemble) {
  const Folder folder;
  ASSERT_EQ(program("samples -o " + (folder / "s")).code, 0);
  const std::string heaps = folder / "s/heaps.h5", copy = folder / "copy.h5";
  testing::fs::copy_file(heaps, copy);
  const auto averaged = [&](const std::string& what) {
    return program("average " + what + " --grid 3x3 -o " + (folder / "a.h5"));
  };
  const Output twice = averaged(heaps + ":realization_000/pile " + copy + ":realization_000/pile");
  EXPECT_EQ(twice.code, 2);
  EXPECT_THAT(twice.err, HasSubstr("copy.h5:realization_000/pile is a copy of "));
  // The same packing under two names of one file.
  ASSERT_EQ(imported(folder, "0,2,0.0025,0.009,0.5,0.86,0,-1").code, 0);
  const std::string one = folder / "o.h5";
  ASSERT_EQ(program("import --from csv " + (folder / "g.csv") + " " + (folder / "c.csv") + " " +
                    (folder / "w.csv") + " --group again --add -o " + one)
                .code,
            0);
  EXPECT_THAT(averaged(one + " --frame packing").err, HasSubstr("is a copy of "));

  const std::string layer = folder / "s/layer.h5";
  const Output states = averaged(layer);
  EXPECT_EQ(states.code, 2);
  EXPECT_THAT(states.err, HasSubstr("are states of one packing, allowed: one state of each"));
  const Output loaded = averaged(layer + ":loaded");
  EXPECT_EQ(loaded.code, 0) << loaded.err;
  EXPECT_THAT(loaded.out, HasSubstr("4 realizations"));

  const std::string pile =
      folder.write("pile.toml", "study = \"pile-fit\"\n[grains]\nfiles = [\"" + heaps + "\", \"" +
                                    copy + "\"]\n[ensemble]\nrealizations = 8\n");
  const Output checked = program("check " + pile);
  EXPECT_EQ(checked.code, 2);
  EXPECT_THAT(checked.err, HasSubstr("copy.h5:/realization_000/pile is a copy of "));
}

TEST(Nonsense, AGrainGoneAstrayIsNamed) {
  const Folder folder;
  folder.write("g.csv",
               "id,x,y,radius,density\n1,0,0.01,0.01,5000\n2,0,0.0299,0.01,5000\n"
               "4,1e6,0.01,0.01,5000\n");
  folder.write("c.csv", "i,j,fx,fy\n1,2,0,-15.4\n");
  ASSERT_EQ(program("import --from csv " + (folder / "g.csv") + " " + (folder / "c.csv") +
                    " --wall floor:y=0 -o " + (folder / "o.h5"))
                .code,
            0);
  for (const char* frame : {"packing", "layer", "heap"}) {
    const Output out = program("average " + (folder / "o.h5") + " --frame " + frame +
                               " --grid 2x2 -o " + (folder / "a.h5"));
    EXPECT_EQ(out.code, 2) << frame;
    EXPECT_THAT(out.err, HasSubstr("grain 4 at x = 1e+06 m has gone astray")) << frame;
  }
}

TEST(Nonsense, APackingCountsOnce) {
  const Folder folder;
  ASSERT_EQ(imported(folder, "0,2,0.0025,0.009,0.5,0.86,0,-1").code, 0);
  const std::string file = folder / "o.h5";
  for (const std::string& again : {file, file + ":packing", file + ":/packing"}) {
    EXPECT_THROW(parse_snapshot_names({file, again}), std::invalid_argument) << again;
    const Output fit = program("fit " + file + " " + again + " -o " + (folder / "fit"));
    EXPECT_EQ(fit.code, 2);
    EXPECT_THAT(fit.err, HasSubstr("named twice, allowed: every packing once"));
  }
}

}  // namespace
}  // namespace grainfield::coupling
