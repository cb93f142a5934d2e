// Study pile-fields through the real program: piles of an earlier run are used again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupling/result/tables.h"
#include "dem/snapshot/snapshot.h"
#include "tests/coupling/heap_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;

std::string tiny(const std::string& study, const std::string& more = "") {
  return "study = \"" + study + R"("
[shape]
radius = 0.0275
polydispersity = 0.1
[source]
grains = 60
height = 1.0
interval = 0.12
[floor]
length = 6.0
[material]
young = 1e6
[rest]
background_damping = 300
unbalanced_force_ratio = 1e-3
kinetic_to_elastic_energy = 1e-5
[ensemble]
realizations = 2
[output]
report = false
vtu = false
)" + more;
}

const char* const kFields = R"([change]
gravity = [8.829]
[fields]
rve_diameters = 1.4
sizes = [1, 1.4]
columns = 61
rows = 31
resamples = 10
heights = [0.35, 0.4]
)";

TEST(FieldsRun, FinishedPilesGiveWhatPouredOnesGive) {
  const Folder folder;
  const Output pour =
      program("run " + folder.write("pile.toml", tiny("pile")) + " -o " + (folder / "pile"));
  ASSERT_EQ(pour.code, 0) << pour.err;
  const std::string file = folder.write("fields.toml", tiny("pile-fields", kFields));
  const Output poured = program("run " + file + " -o " + (folder / "poured"));
  ASSERT_EQ(poured.code, 0) << poured.err;
  const std::string reuse = " --set 'grains.files=[\"" + (folder / "pile/snapshots.h5") + "\"]'";
  const Output reused = program("run " + file + reuse + " -o " + (folder / "reused"));
  ASSERT_EQ(reused.code, 0) << reused.err;
  const Summary a = read_summary(folder / "poured/summary.json"),
                b = read_summary(folder / "reused/summary.json");
  int same = 0;
  for (const auto& [key, value] : a) {
    const bool of_fields = key.rfind("fabric.", 0) == 0 || key.rfind("strain.", 0) == 0 ||
                           key.rfind("elastic.", 0) == 0 || key.rfind("heap.", 0) == 0 ||
                           key.rfind("change.", 0) == 0;
    if (!of_fields || b.count(key) == 0) continue;
    const auto* number = std::get_if<double>(&value);
    if (number != nullptr && std::isnan(*number)) continue;
    EXPECT_EQ(value, b.at(key)) << key;
    ++same;
  }
  EXPECT_GT(same, 60);
  // What is left can be used again, and then nothing has to be solved.
  const std::string again = " --set 'grains.files=[\"" + (folder / "reused/snapshots.h5") + "\"]'";
  const Output third = program("run " + file + again + " -o " + (folder / "third"));
  ASSERT_EQ(third.code, 0) << third.err;
  EXPECT_EQ(read_summary(folder / "third/summary.json").at("elastic.young"), b.at("elastic.young"));
  EXPECT_TRUE(testing::fs::exists(folder / "reused/elastic_map.csv"));

  const auto refusal = [&](const std::string& set) {
    const Output out = program("run " + file + reuse + " --set " + set + " -o " + (folder / "x"));
    EXPECT_EQ(out.code, 2) << out.err;
    return out.err;
  };
  EXPECT_THAT(refusal("material.friction=0.3"),
              HasSubstr("material.friction: found 0.3, the pile "));
  EXPECT_THAT(refusal("material.young=2e6"), HasSubstr("does not rest with this stiffness"));
  EXPECT_THAT(refusal("material.gravity=5"), HasSubstr("material.gravity: found 5, the pile "));
  EXPECT_THAT(refusal("material.density=100"), HasSubstr("material.density: found 100, the pile"));
  EXPECT_THAT(refusal("ensemble.realizations=3"),
              HasSubstr("ensemble.realizations: found 3, allowed: up to 2, the realizations in "));
  const Output fewer = program("check " + file + reuse + " --set ensemble.realizations=1");
  EXPECT_EQ(fewer.code, 0) << fewer.err;
  EXPECT_THAT(fewer.err, HasSubstr("warning: grains.files: 2 realizations, of which "
                                   "ensemble.realizations = 1 takes the first"));
  EXPECT_THAT(refusal("'fields.topics=[\"fabrik\"]'"), HasSubstr("did you mean fabric"));
  EXPECT_THAT(refusal("'compare.models=[\"osl\"]'"), HasSubstr("compare.models: has no meaning"));
}

TEST(FieldsRun, FilesWithoutPilesAreRefused) {
  const Folder folder;
  const std::string file = folder.write("fields.toml", tiny("pile-fields", kFields));
  const auto refusal = [&](const std::string& name) {
    const Output out = program("check " + file + " --set 'grains.files=[\"" + name + "\"]'");
    EXPECT_EQ(out.code, 2);
    return out.err;
  };
  EXPECT_THAT(refusal(folder / "none.h5"), HasSubstr("grains.files: "));
  dem::write_snapshot(folder / "layer.h5", "/unloaded", test::lattice_heap(3));
  EXPECT_THAT(refusal(folder / "layer.h5"), HasSubstr("holds no snapshot named pile"));
}

}  // namespace
}  // namespace grainfield::coupling
