// Tables of numbers in a state's file: as they were written, and as older files held them.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "dem/hdf5/file.h"
#include "dem/snapshot/snapshot.h"
#include "tests/paths.h"

namespace grainfield::dem {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string fresh(const char* name) {
  const std::string file = (std::filesystem::temp_directory_path() / name).string();
  std::filesystem::remove(file);
  return file;
}

Snapshot state() {
  Snapshot out;
  out.attributes["state"] = "pile";
  return out;
}

TEST(NumberTables, ComeBackWithOrderUnitsAndAllDigits) {
  Snapshot s = state();
  s.tables["pair"] = {{"time", "s", {0, 0.1, 1.0 / 3}}, {"depth", "m", {1e-9, NAN, 2}}};
  s.tables["soft"] = {{"grains", "1", {1, 0, 1, 1}}};
  const std::string file = fresh("tables.h5");
  write_snapshot(file, "/pile", s);
  const Snapshot back = read_snapshot(file, "/pile");
  ASSERT_EQ(back.tables.size(), 2U);
  const NumberTable& pair = back.tables.at("pair");
  ASSERT_EQ(pair.size(), 2U);
  EXPECT_EQ(pair[0].name, "time");
  EXPECT_EQ(pair[0].unit, "s");
  EXPECT_THAT(pair[0].values, ElementsAre(0, 0.1, 1.0 / 3));
  EXPECT_EQ(pair[1].name, "depth");
  EXPECT_TRUE(std::isnan(pair[1].values[1]));
  EXPECT_THAT(back.tables.at("soft").front().values, ElementsAre(1, 0, 1, 1));
  EXPECT_THAT(list_snapshots(file), ElementsAre("/pile"));
}

TEST(NumberTables, AreReadFromAttributesOfOlderFiles) {
  Snapshot s = state();
  s.attributes["settling:time"] = "0 0.5 1";
  s.attributes["settling:kinetic"] = "3 nan 1e-12";
  s.attributes["pair:depth"] = "0.25";
  s.attributes["pair:loop_crossings"] = "2 4";
  s.attributes["switch:soft"] = "0 0.5";
  s.attributes["switch:soft_grains"] = "1 0 1";
  s.attributes["gas:note"] = "no numbers";
  const std::string file = fresh("older.h5");
  write_snapshot(file, "/pile", s);
  const Snapshot back = read_snapshot(file, "/pile");
  const NumberTable& settling = back.tables.at("settling");
  ASSERT_EQ(settling.size(), 2U);
  EXPECT_EQ(settling[0].name, "kinetic");
  EXPECT_THAT(settling[1].values, ElementsAre(0, 0.5, 1));
  EXPECT_EQ(settling[0].values[2], 1e-12);
  EXPECT_THAT(back.tables.at("pair").front().values, ElementsAre(0.25));
  EXPECT_EQ(back.tables.at("loops").front().name, "crossings");
  EXPECT_THAT(back.tables.at("switch").front().values, ElementsAre(0, 0.5));
  EXPECT_THAT(back.tables.at("soft").front().values, ElementsAre(1, 0, 1));
  EXPECT_EQ(back.attributes.at("gas:note"), "no numbers");
  EXPECT_EQ(back.attributes.count("settling:time"), 0U);
}

// A file that version 0.9.0 wrote: six disks of base settle (case implicit-settling).
TEST(NumberTables, OfAFileOfVersion090HaveItsNumbers) {
  const std::string file =
      std::string(GRAINFIELD_SOURCES) + "/tests/dem/snapshot/settling_0_9_0.h5";
  const Snapshot s = read_snapshot(file, list_snapshots(file).front());
  const NumberTable& table = s.tables.at("settling");
  ASSERT_EQ(table.size(), 10U);
  for (const NumberColumn& column : table) {
    ASSERT_EQ(column.values.size(), 25U) << column.name;
    if (column.name == "time") {
      EXPECT_NEAR(column.values.back(), 7.53982237, 1e-8);
    }
    if (column.name == "spread") {
      EXPECT_NEAR(column.values[1], 0.000993551246, 1e-12);
    }
  }
}

TEST(NumberTables, AreRefusedWithColumnsOfAnotherLength) {
  const std::string file = fresh("lengths.h5");
  write_snapshot(file, "/pile", state());
  {
    hdf5::Handle opened = hdf5::open_for_adding(file);
    {
      const hdf5::Handle group = hdf5::create_group(opened, "/pile/tables/gas");
      hdf5::write(group, "time", std::vector<double>{1, 2}, 1, "1");
      hdf5::write(group, "temperature", std::vector<double>{1}, 1, "1");
      hdf5::write_attribute(group, "columns", std::string("time,temperature"));
    }
    hdf5::finish(std::move(opened), file);
  }
  try {
    read_snapshot(file, "/pile");
    FAIL() << "not refused";
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr("/pile/tables/gas: temperature has 1 rows where 2 are"));
  }
}

TEST(NumberTables, AreNoneWithoutAny) {
  const std::string file = fresh("none.h5");
  write_snapshot(file, "/pile", state());
  EXPECT_THAT(read_snapshot(file, "/pile").tables, IsEmpty());
}

}  // namespace
}  // namespace grainfield::dem
