// Files as LIGGGHTS, YADE and MercuryDPM write them beside their dumps: lines of VTK whose ids are
// of something else, arrays of parts of forces, columns behind those that are known.
#include <gmock/gmock.h>

#include "coupling/import/packing_warnings.h"
#include "coupling/import/step_names.h"
#include "tests/coupling/import_outcome.h"

namespace grainfield::coupling {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::Outcome;

class ImportPrograms : public testing::ImportOfFiles {
 protected:
  static std::string poly(int points, const std::string& places, const std::string& rest) {
    return fmt::format(
        "# vtk DataFile Version 3.0\nmade\nASCII\nDATASET POLYDATA\nPOINTS {} double\n{}\n{}",
        points, places, rest);
  }
  static std::string numbers(const std::string& name, const std::string& values) {
    return fmt::format("SCALARS {} int 1\nLOOKUP_TABLE default\n{}\n", name, values);
  }
  // Three spheres on each other, the lowest on the floor at z = 0; each of 1 kg.
  static constexpr const char* kPlaces = "0 0 0.0099 0 0 0.0297 0 0 0.0495";
  std::string spheres(bool ids = true) {
    return write("g.vtk",
                 poly(3, kPlaces,
                      "POINT_DATA 3\nSCALARS radius double 1\nLOOKUP_TABLE default\n"
                      "0.01 0.01 0.01\nSCALARS mass double 1\nLOOKUP_TABLE default\n1 1 1\n" +
                          (ids ? numbers("id", "1 2 3") : std::string())));
  }
  // Their two contacts as lines between the centres, with cell data.
  std::string pairs(const std::string& data) {
    return write("p.vtk", poly(4, "0 0 0.0099 0 0 0.0297 0 0 0.0297 0 0 0.0495",
                               "LINES 2 6\n2 0 1\n2 2 3\nCELL_DATA 2\n" + data));
  }
  static constexpr const char* kForce = "VECTORS force double\n0 0 -19.62\n0 0 -9.81\n";
  // The floor's contact as LIGGGHTS has it: the point and the centre, and the numbers of mesh and
  // triangle.
  std::string floor(const char* triangle) {
    return write("w.vtk", poly(2, "0 0 0 0 0 0.0099",
                               "LINES 1 3\n2 0 1\nCELL_DATA 1\n" + numbers("id1", "0") +
                                   numbers("id2", triangle) + "VECTORS force double\n0 0 29.43\n"));
  }
  Outcome vtk(const std::vector<std::string>& files) {
    return import("vtk", files, [](ImportOptions& o) {
      o.dim = 3;
      o.walls.push_back(parse_wall("floor:z=0:ids=0"));
    });
  }
  static void expect_at_rest(const Outcome& out, std::size_t contacts, const std::string& what) {
    const dem::Snapshot s = only(out).snapshot;
    ASSERT_EQ(s.contacts.size(), contacts) << what;
    const PackingCheck check = check_packing(s);
    EXPECT_LT(check.unbalanced_force_ratio, 1e-12) << what;
    EXPECT_NEAR(check.support_ratio, 1, 1e-12) << what;
  }
};

TEST_F(ImportPrograms, LinesBetweenCentresNeedNoIds) {
  const std::string g = spheres();
  const std::string both =
      write("b.vtk", poly(6, "0 0 0.0099 0 0 0.0297 0 0 0.0297 0 0 0.0495 0 0 0.0099 0 0 0",
                          "LINES 3 9\n2 0 1\n2 2 3\n2 4 5\nCELL_DATA 3\nVECTORS force double\n0 0 "
                          "-19.62\n0 0 -9.81\n0 0 29.43\n"));
  expect_at_rest(vtk({g, both}), 3, "ids of grains");
  expect_at_rest(vtk({spheres(false), both}), 3, "no ids at all");
  expect_at_rest(import("csv",
                        {write("g.csv",
                               "id,x,y,z,radius,mass\n1,0,0,0.0099,0.01,1\n2,0,0,0.0297,0.01,"
                               "1\n3,0,0,0.0495,0.01,1\n"),
                         write("c.csv",
                               "x1,y1,z1,x2,y2,z2,fx,fy,fz\n0,0,0.0099,0,0,0.0297,0,0,-19.62\n"
                               "0,0,0.0297,0,0,0.0495,0,0,-9.81\n0,0,0.0099,0,0,0,0,0,29.43\n")},
                        [](ImportOptions& o) { o.walls.push_back(parse_wall("floor:z=0")); }),
                 3, "a table of places");
  const std::string lost =
      write("l.vtk", poly(2, "0 0 0.0099 0 0.5 0.5",
                          "LINES 1 3\n2 0 1\nCELL_DATA 1\nVECTORS force double\n"
                          "0 0 1\n"));
  EXPECT_THAT(vtk({g, lost}).refused,
              HasSubstr("joins grain 1 and (0, 0.5, 0.5) m, where no grain and no wall is"));
  const std::string away =
      write("a.vtk", poly(2, "0 0.5 0 0 0.5 0.5",
                          "LINES 1 3\n2 0 1\nCELL_DATA 1\nVECTORS force double\n"
                          "0 0 1\n"));
  EXPECT_THAT(vtk({g, away}).refused, HasSubstr("no grain has its centre there"));
}

// The numbers of a mesh and its triangles are ids of grains, too.
TEST_F(ImportPrograms, LinesWhoseIdsAreOfMeshes) {
  const std::string g = spheres();
  const std::string p = pairs(numbers("id1", "1 2") + numbers("id2", "2 3") + kForce);
  for (const char* triangle : {"0", "2", "7"}) {
    const Outcome out = vtk({g, p, floor(triangle)});
    expect_at_rest(out, 3, triangle);
    EXPECT_THAT(only(out).warnings,
                Contains(HasSubstr("w.vtk: 1 of 1 rows join other grains than i and j name (the "
                                   "first: 0 " +
                                   std::string(triangle) + " from no grain to grain 1)")));
  }
  const Outcome right = vtk({g, p});
  EXPECT_THAT(only(right).warnings, Not(Contains(HasSubstr("join other grains"))));
  // Contacts that count from 0.
  const Outcome shifted = vtk({g, pairs(numbers("id1", "0 1") + numbers("id2", "1 2") + kForce)});
  EXPECT_THAT(only(shifted).warnings, Contains(HasSubstr("2 of 2 rows join other grains")));
  EXPECT_EQ(only(shifted).snapshot.contacts.at(1).j, 2);
}

// One wrong id or place among right ones is a mistake of its row, and turns no other force.
TEST_F(ImportPrograms, AFewRowsThatContradictTheirEndsAreRefused) {
  const auto rows = [&](const char* last) {
    return import(
        "csv",
        {write("g.csv",
               "id,x,y,z,radius,mass\n1,0,0,0.01,0.01,1\n2,0,0,0.03,0.01,1\n"
               "3,0,0,0.05,0.01,1\n4,0,0,0.07,0.01,1\n"),
         write("c.csv", std::string("i,j,x1,y1,z1,x2,y2,z2,fx,fy,fz\n1,2,0,0,0.03,0,0,0.01,0,0,-3\n"
                                    "2,3,0,0,0.05,0,0,0.03,0,0,-2\n") +
                            last + ",0,0,-1\n")},
        [](ImportOptions& o) { o.dim = 3; });
  };
  EXPECT_EQ(only(rows("3,4,0,0,0.07,0,0,0.05")).snapshot.contacts.at(2).force.z(), -1);
  // The ids alone tell a row without ends.
  EXPECT_EQ(only(rows("3,4,0,0,0.07,,,")).snapshot.contacts.size(), 3U);
  EXPECT_THAT(
      rows("2,4,0,0,0.07,0,0,0.05").refused,
      HasSubstr("c.csv:4: i and j name other grains than the ends of the row join: 2 4 from "
                "grain 4 to grain 3 (1 of 3 rows do so)"));
}

// LIGGGHTS' wall/gran/local as a dump: the wall's end of the line is first, the force is the
// grain's.
TEST_F(ImportPrograms, AGrainAndAWallBesideALineThatBeginsAtTheWall) {
  const auto walls = [&](const char* grain) {
    return import(
        "csv",
        {write("g.csv", "id,x,y,z,radius,mass\n1,0,0,0.0099,0.01,1\n2,0,0,0.0297,0.01,1\n"),
         write("c.csv", "x1,y1,z1,x2,y2,z2,i,j,fx,fy,fz\n0,0,0.0099,0,0,0.0297,1,2,0,0,-9.81\n"),
         write("w.csv", std::string("x1,y1,z1,x2,y2,z2,wall,i,fx,fy,fz\n0,0,0,0,0,0.0099,0,") +
                            grain + ",0,0,19.62\n")},
        [](ImportOptions& o) { o.walls.push_back(parse_wall("floor:z=0:ids=0")); });
  };
  expect_at_rest(walls("1"), 2, "its own id");
  // That of a triangle: the line tells the grain.
  const Outcome other = walls("2");
  expect_at_rest(other, 2, "another id");
  EXPECT_THAT(only(other).warnings,
              Contains(HasSubstr("1 of 1 rows join other grains than i and wall name")));
}

TEST_F(ImportPrograms, ArraysOfPartsOfForces) {
  const std::string g = spheres(), ids = numbers("id1", "1 2") + numbers("id2", "2 3");
  for (const auto& [normal, tangential] : {std::pair{"normalForce", "shearForce"},
                                           {"fn", "fs"},
                                           {"F_n", "F_t"},
                                           {"forceN", "forceT"}}) {
    const dem::Snapshot s =
        only(vtk({g, pairs(ids +
                           fmt::format("VECTORS {} double\n0 0 -2\n0 0 -1\nVECTORS {} double\n1 0 "
                                       "0\n0 1 0\n",
                                       normal, tangential))}))
            .snapshot;
    ASSERT_EQ(s.contacts.size(), 2u) << normal;
    EXPECT_EQ(s.contacts[0].force, dem::Vec3(1, 0, -2)) << normal;
    EXPECT_EQ(s.contacts[1].force, dem::Vec3(0, 1, -1)) << normal;
  }
}

TEST_F(ImportPrograms, NormalPartsBesideVectorsUnderAnyName) {
  const auto warnings = [&](const std::string& names, const std::string& values) {
    return only(csv({write("g.csv", grains_),
                     write("c.csv", "i,j,fx,fy," + names + "\n1,2,-1,0," + values + "\n")}))
        .warnings;
  };
  for (const char* names : {"T_x,T_y", "tfx,tfy", "Qx,Qy", "c_p[4],c_p[5]", "t1,t2"})
    EXPECT_THAT(warnings(names, "0,0.5"),
                Contains(HasSubstr("lie along the normals, and " + std::string(names) +
                                   " across them: are fx ... the normal part alone")))
        << names;
  EXPECT_THAT(warnings("T_x,T_y", "0.5,0"), Not(Contains(HasSubstr("across them"))));
  EXPECT_THAT(warnings("tx,ty", "0,1"), Not(Contains(HasSubstr("across them"))));
  EXPECT_THAT(warnings("torque_x,torque_y", "0,0.5"), Not(Contains(HasSubstr("across them"))));
}

TEST_F(ImportPrograms, AxesThatAreExchanged) {
  const std::string g =
      "id,x,y,radius,mass\n1,0,0,0.01,1\n2,0.0199,0.001,0.01,1\n3,-0.0199,0.002,0.01,1\n"
      "4,0.001,0.0199,0.01,1\n5,0.016,-0.0118,0.01,1\n6,-0.016,-0.0118,0.01,1\n";
  const auto text = [&](const char* rows) {
    ImportedSnapshot s = only(csv({write("g.csv", g), write("c.csv", rows)}));
    const PackingCheck check = check_packing(s.snapshot);
    std::string all = tension_in(check);
    for (const std::string& one : warnings_of(check)) all += one;
    return all;
  };
  EXPECT_THAT(text("i,j,fy,fx\n1,2,-10,-0.5\n1,3,10,-1\n1,4,-0.5,-10\n1,5,-8,6\n1,6,8,6\n"),
              HasSubstr("exchange fx and fy (or x and y of the grains), which leaves 0 that pull"));
  EXPECT_THAT(text("i,j,fx,fy\n1,2,-10,-0.5\n1,3,10,-1\n1,4,-0.5,-10\n1,5,-8,6\n1,6,8,6\n"),
              Not(HasSubstr("exchange")));
  EXPECT_THAT(text("i,j,fx,fy\n1,2,10,-0.5\n1,3,-10,-1\n1,4,0.5,-10\n1,5,8,6\n1,6,-8,6\n"),
              HasSubstr("turn the sign of fx alone"));
}

// --column y=z takes z away from z.
TEST_F(ImportPrograms, AColumnIsTakenOnce) {
  const Outcome out = import("csv",
                             {write("g.csv",
                                    "id,x,z,radius,mass\n1,0,0.01,0.01,1\n2,0.0199,0.01,0.01,1\n"
                                    "3,0.01,0.027,0.01,1\n"),
                              write("c.csv", "i,j,fx,fz\n1,2,-1,0\n")},
                             [](ImportOptions& o) {
                               o.columns = {"y=z", "fy=fz"};
                             });
  const dem::Snapshot s = only(out).snapshot;
  EXPECT_EQ(s.dim, 2);
  ASSERT_EQ(s.grains.size(), 3u);
  EXPECT_EQ(s.grains[2].position, dem::Vec3(0.01, 0.027, 0));
  EXPECT_THAT(csv({write("h.csv", "id,x,z,radius,mass\n1,0,0.01,0.01,1\n"),
                   write("d.csv", "i,j,fx,fz\n1,2,-1,0\n")})
                  .refused,
              HasSubstr("a plane of x and z: --dim 2 --column y=z --column fy=fz"));
  // EDEM's contacts with geometries: the same name is the id of a grain in one table.
  const std::string particles =
      "Particle ID,x,y,radius,mass\n1,0,0.0099,0.01,1\n2,0.0199,0.0099,0.01,1\n";
  const Outcome geometry = import(
      "csv",
      {write("p.csv", particles), write("e.csv", "Particle ID,Geometry ID,fx,fy\n1,7,0,1\n")},
      [](ImportOptions& o) {
        o.columns = {"i=Particle ID", "wall=Geometry ID"};
        o.walls.push_back(parse_wall("floor:y=0:ids=7"));
      });
  EXPECT_EQ(only(geometry).snapshot.contacts.size(), 1u);
}

TEST_F(ImportPrograms, StepsOfAnEmptiedBox) {
  const std::string none =
      "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n0\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
      "ITEM: ATOMS id x y radius mass\n";
  const std::vector<std::string> files{write("g.dump", atoms(0, "") + none),
                                       write("c.dump", entries(0) + entries(100, ""))};
  const Outcome out = import("liggghts", files);
  EXPECT_EQ(only(out).group, "/step_0");
  EXPECT_THAT(only(out).warnings, Contains(HasSubstr("left out: 100")));
  EXPECT_THAT(
      import("liggghts", files,
             [](ImportOptions& o) {
               o.steps = {{100, ""}};
             })
          .refused,
      HasSubstr("g.dump: the tables of grains of step 100 hold no row, expected one of each "
                "grain; steps that have all tables: 0"));
}

TEST(StepsWithoutIds, GrainsThatLieApartMayBePieces) {
  const auto keys = [](const RowKeys& all) {
    return std::function<RowKeys()>([all] { return all; });
  };
  const auto steps = [&](const RowKeys& first, const RowKeys& second) {
    return steps_of_names(
        {{"g_0.vtp", true, {}, keys(first)}, {"g_1.vtp", true, {}, keys(second)}});
  };
  EXPECT_THAT(steps({"0 0 0", "0 0 1"}, {"1 0 0", "1 0 1"}).warnings,
              ElementsAre(HasSubstr("pieces of one step belong into one file")));
  EXPECT_THAT(steps({"0 0 0", "0 0 1"}, {"0 0 0", "1 0 1"}).warnings, IsEmpty());
}

TEST_F(ImportPrograms, MercuryWithColumnsBehindItsOwn) {
  const std::string row = " 0 0 0 0.01 0 0 0 0 0 0 0";
  const dem::Snapshot s = only(import("mercury",
                                      {write("a.data", "2 0.5 0 0 0 1 1 1\n0 0 0.01" + row +
                                                           " 7\n0 0 0.03" + row + " 3\n")},
                                      [](ImportOptions& o) {
                                        o.without_contacts = true;
                                        o.density = 2500;
                                      }))
                              .snapshot;
  ASSERT_EQ(s.grains.size(), 2u);
  EXPECT_EQ(s.grains[1].id, 1);
}

}  // namespace
}  // namespace grainfield::coupling
