// Columns whose names say one thing and whose values may be another: numbers of rows, flags, sizes
// of components, signs of sizes, units in other capitals.
#include <gmock/gmock.h>

#include "tests/coupling/import_outcome.h"

namespace grainfield::coupling {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;

class ImportMeanings : public testing::ImportOfFiles {
 protected:
  // Three spheres in a row along (1, 2, 2), which touch.
  static constexpr const char* kSpheres =
      "id,x,y,z,radius,mass\n1,0,0,0,0.015,1\n2,0.01,0.02,0.02,0.015,1\n3,0.02,0.04,0.04,0.015,1\n";
  Outcome spheres(const std::string& contacts, const std::vector<std::string>& columns = {}) {
    return import("csv", {write("g.csv", kSpheres), write("c.csv", contacts)},
                  [&](ImportOptions& o) { o.columns = columns; });
  }
  Outcome disks(const std::string& contacts) {
    return csv({write("g.csv", grains_), write("c.csv", contacts)});
  }
};

// A spring is a part of the force: the column stays the tangential one.
TEST_F(ImportMeanings, AColumnIsSpringAndTangentialForce) {
  const Outcome out = import(
      "lammps",
      {write("g.dump",
             atoms(0, "", "1 0 0 0 0.015 1\n2 0.01 0.02 0.02 0.015 1\n", "id x y z radius mass")),
       write("c.dump", entries(0, "1 2 -1 -2 -2 2 -1 0\n", "id1 id2 fx fy fz p1 p2 p3"))},
      [](ImportOptions& o) { o.columns = {"sx,sy,sz=p1,p2,p3"}; });
  const dem::Snapshot s = only(out).snapshot;
  ASSERT_EQ(s.contacts.size(), 1u);
  EXPECT_EQ(s.contacts[0].force, dem::Vec3(1, -3, -2));
}

TEST_F(ImportMeanings, TheNumberOfARowIsNoBody) {
  const Outcome out = spheres("i,id1,id2,fx,fy,fz\n1,2,3,-1,-2,-2\n2,1,2,-1,-2,-2\n");
  const dem::Snapshot s = only(out).snapshot;
  ASSERT_EQ(s.contacts.size(), 2u);
  EXPECT_EQ(s.contacts[0].i + s.contacts[0].j + s.contacts[1].i + s.contacts[1].j, 0 + 1 + 1 + 2);
  EXPECT_THAT(only(out).notes, Contains(HasSubstr("columns that are not taken: i")));
  // Beside j it is one.
  EXPECT_EQ(only(spheres("i,j,id1,id2,fx,fy,fz\n1,2,8,9,-1,-2,-2\n")).snapshot.contacts[0].j, 1);
}

// "id:0" and "id:1" of ParaView, "id[0]" of arrays: the bodies count from 1, components from 0.
TEST_F(ImportMeanings, BodiesAsComponents) {
  for (const char* names :
       {"id:0,id:1,id:2", "id[0],id[1],id[2]", "id_0,id_1,id_2", "particle0,particle1,flag"}) {
    const dem::Snapshot s =
        only(spheres(fmt::format("{},fx,fy,fz\n2,3,1,-1,-2,-2\n", names))).snapshot;
    ASSERT_EQ(s.contacts.size(), 1u) << names;
    EXPECT_EQ(s.contacts[0].i, 1) << names;
    EXPECT_EQ(s.contacts[0].j, 2) << names;
  }
}

TEST_F(ImportMeanings, AFlagIsNoWall) {
  const auto refused = [&](const std::string& flag, const std::string& ids) {
    return import(
               "csv",
               {write("g.csv", grains_), write("c.csv", "i,j,wall,fx,fy\n1,2," + flag + ",-1,0\n")},
               [&](ImportOptions& o) { o.walls.push_back(parse_wall("floor:y=0:ids=" + ids)); })
        .refused;
  };
  for (const char* ids : {"0", "1", "7"})
    for (const char* flag : {"0", "1", "False"})
      EXPECT_THAT(refused(flag, ids),
                  HasSubstr(fmt::format(
                      "column wall: found \"{}\" beside 2 in the column of j: a flag", flag)))
          << ids;
  // An id of a wall beside its own name, and beside nothing.
  const Outcome out =
      import("csv",
             {write("g.csv", grains_),
              write("d.csv", "i,j,wall,fx,fy\n1,2,,-1,0\n1,1,1,0,9.81\n2,,1,0,9.81\n")},
             [&](ImportOptions& o) { o.walls.push_back(parse_wall("floor:y=0:ids=1")); });
  EXPECT_EQ(only(out).snapshot.contacts.size(), 3u);
}

// absForceT of YADE's VTKRecorder.
TEST_F(ImportMeanings, SizesOfComponentsAreNoForce) {
  const std::string table = "id1,id2,forceN,absForceT:0,absForceT:1,absForceT:2\n1,2,3,0.2,0.1,0\n";
  EXPECT_THAT(spheres(table).refused,
              HasSubstr("absForceT:0 ... are sizes of components, without their signs"));
  EXPECT_THAT(spheres(table, {"fn=forceN"}).refused,
              HasSubstr("--column ft=0 leaves the tangential part out"));
  const Outcome normal = spheres(table, {"fn=forceN", "ft=0"});
  EXPECT_LT((only(normal).snapshot.contacts[0].force - dem::Vec3(-1, -2, -2)).norm(), 1e-12);
  EXPECT_THAT(only(normal).warnings, Contains(HasSubstr("absForceT")));
}

TEST_F(ImportMeanings, PartsThatAreNotAcrossEachOther) {
  const auto warnings = [&](const std::string& tangential) {
    return only(spheres("i,j,fnx,fny,fnz,ftx,fty,ftz\n1,2,-1,-2,-2," + tangential +
                        "\n2,3,-1,-2,-2," + tangential + "\n"))
        .warnings;
  };
  EXPECT_THAT(warnings("0.2,0.1,0"),
              Contains(HasSubstr("2 of 2 tangential parts are not across the normal part")));
  EXPECT_THAT(warnings("0.2,-0.1,0"), Not(Contains(HasSubstr("not across"))));
}

// fn above 0 pushes, whichever way the file's normal points; the vector beside it acts on i.
TEST_F(ImportMeanings, ASizeBesideAVector) {
  const dem::Vec3 right(-0.8, -2.1, -2);
  const std::string head = "i,j,fn,ftx,fty,ftz,nx,ny,nz\n";
  for (const char* normal : {"0.3333333,0.6666667,0.6666667", "-0.3333333,-0.6666667,-0.6666667"})
    EXPECT_LT(
        (only(spheres(head + "1,2,3,0.2,-0.1,0," + normal + "\n")).snapshot.contacts[0].force -
         right)
            .norm(),
        1e-6)
        << normal;
  const std::string rows =
      "1,2,-3,0.2,-0.1,0,0.3333333,0.6666667,0.6666667\n2,3,-3,0.2,-0.1,0,0.3333333,0.6666667,"
      "0.6666667\n";
  EXPECT_THAT(only(spheres(head + rows)).warnings,
              Contains(HasSubstr("fn is below 0 in 2 of 2 contacts, which pulls: where compression "
                                 "is negative, change the sign of this column")));
}

// Two contacts of one pair, through both sides of a cell that is narrower than four radii.
TEST_F(ImportMeanings, NormalsThroughBothSidesOfANarrowCell) {
  const Outcome out =
      import("csv",
             {write("g.csv", "id,x,y,z,radius,mass\n1,0.01,0,0,0.0101,1\n2,0.03,0,0,0.0101,1\n"),
              write("c.csv",
                    "i,j,fn,ftx,fty,ftz,nx,ny,nz,px,py,pz\n1,2,3,0,1,0,1,0,0,0.02,0,0\n"
                    "1,2,2,0,0,1,-1,0,0,0,0,0\n")},
             [](ImportOptions& o) {
               o.dim = 3;
               o.periodic.push_back(parse_periodic("x=0:0.04"));
             });
  const dem::Snapshot s = only(out).snapshot;
  ASSERT_EQ(s.contacts.size(), 2u);
  EXPECT_EQ(s.contacts[0].force + s.contacts[1].force, dem::Vec3(-1, 1, 1));
}

// Following "where it is no unit" would read kN as N.
TEST_F(ImportMeanings, UnitsInOtherCapitals) {
  EXPECT_THAT(disks("i,j,fx (KN),fy (KN)\n1,2,-1,0\n").refused,
              HasSubstr("found the unit \"KN\", allowed: N"));
  for (const auto& [unit, meant] : {std::pair{"KN", "kN"}, {"kn", "kN"}, {"n", "N"}}) {
    const std::string refused =
        disks(fmt::format("i,j,fx ({0}),fy ({0})\n1,2,-1,0\n", unit)).refused;
    EXPECT_THAT(refused, HasSubstr(fmt::format("did you mean \"{}\"? (capitals count)", meant)));
    EXPECT_THAT(refused, Not(HasSubstr("where it is no unit")));
  }
}

TEST_F(ImportMeanings, HintsOfDumpsLookBehindWhatMadeAColumn) {
  const auto refused = [&](const std::string& columns, const std::string& row) {
    return import("lammps",
                  {write("g.dump", atoms(0, "", row, columns)), write("c.dump", entries(0))})
        .refused;
  };
  EXPECT_THAT(refused("id x y c_d c_rho", "1 0 0 0.01 2500\n"),
              HasSubstr("nearest: radius (c_d (--column diameter=c_d)), mass (c_rho (--column "
                        "density=c_rho))"));
  // p1 is taken already: it is no id.
  const std::string types =
      import("lammps", {write("h.dump", atoms(0, "")),
                        write("c.dump", entries(0, "1 1 -1 0 0 0\n", "ptype1 ptype2 fx fy p1 p2"))})
          .refused;
  EXPECT_THAT(types, HasSubstr("no columns \"i\", \"j\""));
  EXPECT_THAT(types, Not(HasSubstr("nearest")));
  // Columns of our own script: the ids, and not the first part of the force, are nearest to i.
  const std::string numbered =
      import(
          "lammps",
          {write("i.dump", atoms(0, "")),
           write("n.dump", entries(0, "1 2 -1 0 0 0 0 0\n",
                                   "c_ids[1] c_ids[2] c_p[1] c_p[2] c_p[3] c_p[4] c_p[5] c_p[6]"))})
          .refused;
  EXPECT_THAT(numbered, HasSubstr("nearest: i (c_ids[1]), j (c_ids[2]); other names by --column "
                                  "OURS=THEIRS, such as --column 'i,j=c_ids[1..2]'"));
}

TEST_F(ImportMeanings, PartsWhoseLetterStandsBehind) {
  EXPECT_THAT(disks("i,j,fx_n,fy_n,fx_t,fy_t\n1,2,-1,0,0,0\n").refused,
              HasSubstr("no column \"fnx\"; found: i j fx_n fy_n fx_t fy_t; nearest: fx_n"));
}

// EDEM's and Rocky's names.
TEST_F(ImportMeanings, NamesThatBeginWithTheWordOfTheGrain) {
  const dem::Snapshot s =
      only(csv({write("g.csv",
                      "Particle ID,Particle Position X (mm),Particle Position Y (mm),Particle "
                      "Radius (mm),Particle Mass (g)\n1,0,10,10,1000\n2,19.9,10,10,1000\n"),
                write("c.csv",
                      "Particle 1 ID,Particle 2 ID,Contact Position X (mm),Contact Position "
                      "Y (mm),Force X (N),Force Y (N)\n1,2,9.93,10,-1,0\n")}))
          .snapshot;
  ASSERT_EQ(s.contacts.size(), 1u);
  EXPECT_EQ(s.grains[1].position.x(), 0.0199);
  EXPECT_NEAR(s.contacts[0].point.x(), 9.93e-3, 1e-15);
}

}  // namespace
}  // namespace grainfield::coupling
