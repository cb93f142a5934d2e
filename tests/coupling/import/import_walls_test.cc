// Walls that are not where the forces say, signs of pairs and of walls, ids that mean two things.
#include <gmock/gmock.h>

#include "coupling/import/packing_warnings.h"
#include "tests/coupling/import_outcome.h"

namespace grainfield::coupling {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::Outcome;

// Two columns of three disks of radius 1 cm that stand on y = 0.
class ImportWalls : public testing::ImportOfFiles {
 protected:
  std::string grains(double radius = 0.01) {
    std::string rows = "id,x,y,radius,mass\n";
    for (int k = 0; k < 6; ++k)
      rows += fmt::format("{},{:.7f},{:.7f},{},1\n", k + 1, 0.03 * (k / 3), 0.01 + 0.02 * (k % 3),
                          radius);
    return write("g.csv", rows);
  }
  // Forces on i; the weight of what stands above, times these signs.
  std::string contacts(double pairs = 1, double walls = 1) {
    std::string rows = "i,j,wall,fx,fy\n";
    for (int k = 0; k < 6; ++k) {
      if (k % 3 < 2)
        rows += fmt::format("{},{},,0,{}\n", k + 1, k + 2, -9.81 * pairs * (2 - k % 3));
      if (k % 3 == 0) rows += fmt::format("{},,floor,0,{}\n", k + 1, 3 * 9.81 * walls);
    }
    return write("c.csv", rows);
  }
  ImportedSnapshot with_wall(const std::string& wall, double pairs = 1, double walls = 1,
                             const std::function<void(ImportOptions&)>& choose = {}) {
    return only(import("csv", {grains(), contacts(pairs, walls)}, [&](ImportOptions& o) {
      o.walls.push_back(parse_wall(wall));
      if (choose) choose(o);
    }));
  }
};

TEST_F(ImportWalls, ForcesAcrossGapsToAWallAreSaid) {
  EXPECT_THAT(with_wall("floor:y=0").warnings, IsEmpty());
  EXPECT_THAT(with_wall("floor:y=-0.00005").warnings, IsEmpty());
  EXPECT_THAT(
      with_wall("floor:y=-0.005").warnings,
      Contains(HasSubstr("2 of 2 contacts with wall floor bear a force across a gap of up to "
                         "0.005 m to it: is its plane where it says? The grains on it end "
                         "at y = 0 m")));
  EXPECT_THAT(with_wall("floor:y=0.004").warnings,
              Contains(HasSubstr("lie up to 0.004 m deep in it")));
}

TEST_F(ImportWalls, SignsOfPairsAndOfWallsAreJudgedApart) {
  const auto tension = [&](double pairs, double walls,
                           const std::function<void(ImportOptions&)>& choose = {}) {
    return tension_in(check_packing(with_wall("floor:y=0", pairs, walls, choose).snapshot));
  };
  EXPECT_EQ(tension(1, 1), "");
  EXPECT_THAT(tension(-1, 1), HasSubstr("4 of 4 contacts between grains pull, 2 of 2 with walls "
                                        "push: forces count on grain i, by j or the wall; turn the "
                                        "sign of those between grains alone (import "
                                        "--flip-forces=pairs)"));
  EXPECT_THAT(tension(1, -1), HasSubstr("turn the sign of those with walls alone (import "
                                        "--flip-forces=walls)"));
  EXPECT_THAT(tension(-1, -1), HasSubstr("(import --flip-forces)"));
  EXPECT_EQ(tension(-1, 1, [](ImportOptions& o) { o.flip_pairs = true; }), "");
  EXPECT_EQ(tension(1, -1, [](ImportOptions& o) { o.flip_walls = true; }), "");
  EXPECT_NE(tension(1, 1, [](ImportOptions& o) { o.flip_walls = true; }), "");
}

TEST_F(ImportWalls, TheProgramTurnsOneKind) {
  const std::string files = grains() + " " + contacts(-1, 1) + " --wall floor:y=0 -o " +
                            (folder_ / "o.h5") + " --flip-forces";
  const testing::Output turned = testing::program("import --from csv " + files + "=pairs");
  EXPECT_EQ(turned.code, 0) << turned.err;
  EXPECT_THAT(turned.err, Not(HasSubstr("pull")));
  EXPECT_THAT(testing::program("import --from csv " + files).err, HasSubstr("--flip-forces=walls"));
  EXPECT_THAT(testing::program("import --from csv " + files + "=floor").err,
              HasSubstr("allowed: --flip-forces, --flip-forces=pairs, --flip-forces=walls"));
}

TEST_F(ImportWalls, AWallOfATableCalledAsAGrain) {
  const std::string walls = write("w.csv", "name,x,y,nx,ny\n2,0,0,0,1\n"),
                    rows = write("p.csv", "i,j,fx,fy\n1,2,0,9.81\n");
  EXPECT_THAT(csv({grains(), walls, rows}).refused,
              HasSubstr("2 is a grain and the name of wall 2, allowed: one meaning"));
}

TEST_F(ImportWalls, ForcesThatDoNotFitThePlaces) {
  const auto doubts = [&](const char* rows) {
    const std::string file = write("p.csv", std::string("i,j,fx,fy\n") + rows);
    return warnings_of(check_packing(only(csv({grains(), file})).snapshot));
  };
  EXPECT_THAT(doubts("1,2,-1,-2\n2,3,0,-1\n4,5,0,-2\n5,6,0.1,-1\n"),
              Not(Contains(HasSubstr("more tangential"))));
  EXPECT_THAT(doubts("1,2,-2,0\n2,3,-1,0\n4,5,0,-2\n5,6,0.1,-1\n"),
              Contains(HasSubstr("2 of 4 contacts between grains bear more tangential than normal "
                                 "force (friction above 1): do ids, axes and signs")));
}

// A grain that touches another through both sides of a narrow cell.
TEST_F(ImportWalls, TheForceTellsTheSideOfANarrowCell) {
  const std::string g = write("n.csv", "id,x,y,radius,mass\n1,0.0,0,0.01,1\n2,0.0199,0,0.01,1\n");
  const auto force = [&](const char* fx) {
    const std::string c = write("nc.csv", fmt::format("i,j,fx,fy\n1,2,{},0\n", fx));
    const auto s = only(import("csv", {g, c}, [](ImportOptions& o) {
                     o.periodic.push_back(parse_periodic("x=0:0.0398"));
                   })).snapshot;
    EXPECT_GT(s.contacts.at(0).normal_force, 0);
    return s.contacts.at(0).image[0];
  };
  EXPECT_EQ(force("-1"), 0);
  EXPECT_EQ(force("1"), -1);
}

TEST_F(ImportWalls, NormalsFromTheSecondToTheFirst) {
  const std::string c = write("t.csv", "i,j,fx,fy,nx,ny\n1,2,0,-1,0,-1\n");
  const ImportedSnapshot turned = only(csv({grains(), c}));
  EXPECT_NEAR(turned.snapshot.contacts.at(0).point.y(), 0.02, 1e-12);
  EXPECT_THAT(warnings_of(check_packing(turned.snapshot)),
              Contains(HasSubstr("1 of 1 contacts between round grains have a normal")));
}

TEST_F(ImportWalls, SizesOfTangentialForcesWithoutASign) {
  const auto doubts = [&](const char* last) {
    std::string rows = "i,j,wall,fn,ft,nx,ny\n";
    for (const char* pair : {"1,2,", "2,3,", "4,5,", "5,6,"})
      rows += std::string(pair) + ",1,0.1,0,1\n";
    rows += std::string("1,,floor,1,") + last + ",0,-1\n";
    const std::string file = write("ft.csv", rows);
    return only(import("csv", {grains(), file},
                       [](ImportOptions& o) { o.walls.push_back(parse_wall("floor:y=0")); }))
        .warnings;
  };
  EXPECT_THAT(doubts("0.1"), Contains(HasSubstr("none of 5 values of ft is below 0")));
  EXPECT_THAT(doubts("-0.1"), Not(Contains(HasSubstr("values of ft"))));
}

}  // namespace
}  // namespace grainfield::coupling
