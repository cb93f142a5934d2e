// Ids of grains on the way to LAMMPS and back, and imported packings, which have no case, in it.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>

#include "coupling/export/lammps_deck.h"
#include "coupling/import/ids_table.h"
#include "dem/snapshot/snapshot.h"
#include "tests/coupling/lammps_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using ::testing::Contains;
using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::program;

constexpr std::int64_t kMost = 2147483647;

dem::Snapshot spheres(const std::vector<std::int64_t>& ids) {
  dem::Snapshot s;
  s.dim = 3;
  for (const std::int64_t id : ids) {
    dem::Grain g;
    g.id = id;
    g.radius = 0.005;
    g.mass = 1e-3;
    g.volume = 5e-7;
    g.position = {0.02 * static_cast<double>(s.grains.size()), 0, 0.005};
    s.grains.push_back(g);
  }
  return s;
}

LammpsDeck deck_of(const dem::Snapshot& packing, int copies = 1) {
  LammpsSetup setup;
  setup.known = false;
  setup.copies = {copies, 1};
  return lammps_deck(packing, setup);
}

TEST(ExportIds, IdsThatLammpsCanHaveAreKept) {
  const LammpsDeck deck = deck_of(spheres({7, 300, kMost}));
  EXPECT_TRUE(deck.ids.empty());
  EXPECT_THAT(deck.notes, Not(Contains(HasSubstr("ids are"))));
  EXPECT_THAT(deck.input, Not(HasSubstr("--ids")));
  for (const char* row : {"\n7 1 ", "\n300 1 ", "\n2147483647 1 "})
    EXPECT_THAT(deck.data, HasSubstr(row));
}

TEST(ExportIds, OthersAreNumberedAndComeBack) {
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  for (const auto& ids :
       {std::vector<std::int64_t>{0, 1, 2}, {-5, 3, 4}, {1, 2, kMost + 1}, {0, 5, most}}) {
    const dem::Snapshot packing = spheres(ids);
    const LammpsDeck deck = deck_of(packing);
    EXPECT_THAT(deck.notes, Contains(HasSubstr("ids.csv has both")));
    EXPECT_THAT(deck.input, HasSubstr("--ids ids.csv"));
    dem::Snapshot back = packing;
    for (std::size_t k = 0; k < 3; ++k) {
      back.grains[k].id = static_cast<std::int64_t>(k) + 1;
      EXPECT_THAT(deck.data, HasSubstr(fmt::format("\n{} 1 ", k + 1)));
    }
    back.loaded_grain = 2;
    const Folder folder;
    restore_ids(folder.write("ids.csv", deck.ids), back);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(back.grains[k].id, ids[k]);
    EXPECT_EQ(back.loaded_grain, ids[1]);
  }
}

TEST(ExportIds, ATableOfIdsMustFit) {
  const Folder folder;
  const auto refusal = [&](const char* text) {
    dem::Snapshot packing = spheres({1, 2});
    try {
      restore_ids(folder.write("ids.csv", text), packing);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal("id,original\n1,10\n2,20\n"), "");
  EXPECT_THAT(refusal("id,original\n1,10\n"), HasSubstr("found no row of grain 2"));
  EXPECT_THAT(refusal("id,original\n1,10\n1,20\n"),
              HasSubstr("ids.csv:3: column id: found 1 again"));
  EXPECT_THAT(refusal("id,original\n1,10\n2,10\n"), HasSubstr("column original: found 10 again"));
  EXPECT_THAT(refusal("id,ours\n1,10\n2,20\n"), HasSubstr("no column \"original\""));
}

// LAMMPS runs the deck with a law from the command line, and the commands of its first lines bring
// the packing back under its ids.
TEST(ExportIds, APackingWithoutACaseRunsAndComesBack) {
  if (!lammps::is_there()) GTEST_SKIP() << "lmp not found: the Debian package lammps has it";
  const Folder folder;
  for (const bool plane : {true, false}) {
    // LAMMPS can have those of the plane.
    const std::int64_t first = plane ? 11 : kMost + 7;
    std::string rows = plane ? "id,x,y,radius,density\n" : "id,x,y,z,radius,density\n";
    for (int k = 0; k < 12; ++k) {
      const double x = 0.006 + 0.011 * (k % 4), up = 0.006 + 0.011 * (k / 4);
      rows += fmt::format("{},{},{},{}0.005,2500\n", first + k, x, plane ? up : 0.006,
                          plane ? "" : fmt::format("{},", up));
    }
    const std::string name = folder / (plane ? "plane" : "space");
    folder.write(plane ? "plane.csv" : "space.csv", rows);
    const testing::Output imported = program(fmt::format(
        "import --from csv --without-contacts --friction 0.5 --dim {} {}.csv {} -o {}.h5",
        plane ? 2 : 3, name,
        plane ? "--wall floor:y=0 --wall left:x=0 --wall right:x=0.045"
              : "--wall floor:z=0 --wall front:y=0 --wall behind:y=0.012 --periodic x=0:0.044",
        name));
    ASSERT_EQ(imported.code, 0) << imported.err;
    const testing::Output exported = program(fmt::format("export {0}.h5 --to lammps -o {0}", name));
    ASSERT_EQ(exported.code, 0) << exported.err;
    EXPECT_EQ(std::filesystem::exists(name + "/ids.csv"), !plane);
    lammps::run_lammps(name, "in.lammps",
                       "-var law \"hooke 1e4 20 damping mass_velocity tangential linear_history "
                       "2857 1 0.5\" -var step 1e-5");
    const std::string text = testing::read_text(name + "/in.lammps"), command = "# grainfield ";
    const std::size_t begin = text.find(command) + command.size();
    ASSERT_GE(begin, command.size());
    const testing::Output back =
        program(text.substr(begin, text.find('\n', begin) - begin), "cd " + name + " &&");
    ASSERT_EQ(back.code, 0) << back.err;
    const dem::Snapshot s = dem::read_snapshot(name + "/lammps.h5", "/unloaded");
    EXPECT_EQ(s.dim, plane ? 2 : 3);
    ASSERT_EQ(s.grains.size(), 12u);
    for (int k = 0; k < 12; ++k) EXPECT_EQ(s.grains[static_cast<std::size_t>(k)].id, first + k);
    double floor = 0, weight = 0;
    for (const dem::Contact& c : s.contacts)
      if (c.j == -1) floor += c.force[s.dim - 1];
    for (const dem::Grain& g : s.grains) weight += 9.81 * g.mass;
    EXPECT_NEAR(floor / weight, 1, 1e-2);  // at rest to the deck's ratio of energies
    // States before and after belong together.
    const testing::Output strain = program(
        fmt::format("strain {0}.h5:packing {0}/lammps.h5:unloaded -o {0}-strain.csv", name));
    EXPECT_EQ(strain.code, 0) << strain.err;
  }
}

}  // namespace
}  // namespace grainfield::coupling
