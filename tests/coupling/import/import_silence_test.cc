// What a reader could lose or take for something else without a word: rows behind a sign, vectors
// counted from 1, times, units in names and of options.
#include <gmock/gmock.h>

#include <cmath>

#include "coupling/import/packing_warnings.h"
#include "tests/coupling/import_outcome.h"

namespace grainfield::coupling {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;

class ImportSilence : public testing::ImportOfFiles {
 protected:
  Outcome grains(const std::string& text, const std::function<void(ImportOptions&)>& choose = {}) {
    return import("csv", {write("g", text)}, [&](ImportOptions& o) {
      o.without_contacts = true;
      o.density = 2500;
      if (choose) choose(o);
    });
  }
  const std::string vtk_points_ =
      "# vtk DataFile Version 3.0\ng\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 0 0\n0.0199 0 0\n"
      "POINT_DATA 2\nSCALARS id int 1\nLOOKUP_TABLE default\n1 2\nSCALARS radius float 1\n"
      "LOOKUP_TABLE default\n0.01 0.01\n";
  const std::string vtk_pairs_ =
      "# vtk DataFile Version 3.0\nc\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0.01 0 0\n"
      "POINT_DATA 1\nSCALARS i int 1\nLOOKUP_TABLE default\n1\nSCALARS j int 1\n"
      "LOOKUP_TABLE default\n2\nVECTORS force float\n-1 0 0\n";
};

TEST_F(ImportSilence, RowsThatBeginWithASign) {
  const std::string g = write("g.csv", grains_ + "3,0.04,0.01,0.01,1\n");
  const auto contacts = [&](const std::string& rows) {
    return import("csv", {g, write("c.csv", "wall,i,j,fx,fy\n" + rows)},
                  [](ImportOptions& o) { o.walls.push_back(parse_wall("floor:y=0")); });
  };
  for (const char* none : {"#N/A", "#NV", "#VALEUR!", "-", "NA"}) {
    const Outcome out = contacts(std::string(none) + ",1,2,-1,0\nfloor,1,,0,1\n# end of it\n");
    EXPECT_EQ(only(out).snapshot.contacts.size(), 2u) << none;
  }
  EXPECT_EQ(only(contacts("floor,1,,0,1\n# 3,1,2,-1,0\n")).snapshot.contacts.size(), 1u);
  EXPECT_THAT(grains("id,x,y,radius\n#1,0,0,0.01\n#2,1,0,0.01\n").refused,
              HasSubstr("g:2: found \"#1,0,0,0.01\", expected a row, or a comment with a blank"));
  EXPECT_EQ(only(grains("id,x,y,radius,mass,vx\n1,0,0,0.01,1, #N/A\n")).snapshot.grains[0].mass, 1);
  EXPECT_EQ(only(grains("id,x,y,radius,material\n1,0,0,1,sand #0\n")).snapshot.grains[0].material,
            "sand #0");
}

TEST_F(ImportSilence, VectorsCountedFromOne) {
  const auto velocity = [&](const std::string& names, const std::string& values) {
    return only(grains("id,x,y,z,radius," + names + "\n1,0,0,0,1," + values + "\n2,3,0,1,1," +
                       values + "\n"))
        .snapshot.grains.at(0)
        .velocity;
  };
  const dem::Vec3 all(1, 2, 3);
  EXPECT_EQ(velocity("velocity_1,velocity_2,velocity_3", "1,2,3"), all);
  EXPECT_EQ(velocity("velocity_0,velocity_1,velocity_2", "1,2,3"), all);
  EXPECT_EQ(velocity("velocity_2,velocity_3", "2,3"), dem::Vec3(0, 0, 0));
  EXPECT_THAT(only(grains("id,x,y,z,radius,vy,vz\n1,0,0,0,1,1,2\n2,3,0,1,1,1,2\n")).warnings,
              Contains(HasSubstr("velocities along some axes and no vx")));
  EXPECT_EQ(only(grains("id,pos_1,pos_2,radius\n1,0.5,0.25,1\n")).snapshot.grains[0].position,
            dem::Vec3(0.5, 0.25, 0));
}

TEST_F(ImportSilence, RowsOfSeveralTimes) {
  const std::string g = write("g.csv", grains_ + "3,0.0398,0.01,0.01,1\n");
  EXPECT_THAT(csv({g, write("c.csv",
                            "step,i,j,fx,fy\n100,1,2,-1,0\n100,2,3,-1,0\n200,1,2,-1,0\n"
                            "200,2,3,-1,0\n")})
                  .refused,
              HasSubstr("c.csv:1: column step: found rows of several states, 100, 200, allowed: "
                        "those of one; write a file for each"));
  const std::string timed = write(
      "t.csv", "time (ms),id,x,y,radius,mass\n500,1,0,0.01,0.01,1\n500,2,0.0199,0.01,0.01,1\n");
  const auto at = [&](const char* time) {
    return only(
        csv({timed, write("c.csv", fmt::format("time (ms),i,j,fx,fy\n{},1,2,-1,0\n", time))}));
  };
  EXPECT_EQ(at("500").snapshot.time, 0.5);
  EXPECT_THAT(at("500").notes, Not(Contains(HasSubstr("not taken"))));
  EXPECT_THAT(at("500").warnings, Not(Contains(HasSubstr("of one state"))));
  EXPECT_THAT(at("700").warnings, Contains(HasSubstr("time is 700, in " + timed +
                                                     " it is 500: are they of one state")));
}

TEST_F(ImportSilence, OptionsBesideColumnsThatHaveUnits) {
  const std::string text = "id,x (mm),y (mm),radius (mm)\n1,0,0,5\n2,10,0,5\n";
  const auto periodic = [&](const char* axis) {
    return grains(text, [&](ImportOptions& o) { o.periodic.push_back(parse_periodic(axis)); });
  };
  EXPECT_THAT(
      periodic("x=0:20").refused,
      HasSubstr("--periodic x: found a length without a unit beside the column \"x (mm)\""));
  EXPECT_THAT(
      grains(text, [](ImportOptions& o) { o.walls.push_back(parse_wall("floor:y=-5")); }).refused,
      HasSubstr("--wall floor: found a length without a unit"));
  EXPECT_EQ(periodic("x=0:20 mm").refused, "");
}

TEST_F(ImportSilence, UnitsBehindNames) {
  const auto radius = [&](const std::string& text, const std::vector<std::string>& columns = {}) {
    const Outcome out = grains(text, [&](ImportOptions& o) { o.columns = columns; });
    return out.refused.empty() ? out.packings.at(0).snapshot.grains[0].radius : std::nan("");
  };
  EXPECT_EQ(radius("id,x_mm,y_mm,radius_mm\n1,0,0,5\n"), 0.005);
  EXPECT_EQ(radius("id,x/mm,y/mm,radius/mm\n1,0,0,5\n"), 0.005);
  EXPECT_EQ(radius("id;x, mm;y, mm;radius, mm\n1;0;0;5\n"), 0.005);
  EXPECT_EQ(radius("id,x_mm,y_mm,radius_mm\n1,0,0,5\n", {"x,y,radius=x_mm,y_mm,radius_mm"}), 0.005);
  // A unit of another system is not taken for a part of the name.
  const std::string inches = "id,x (in),y (in),radius (in)\n1,0,0,5\n";
  const Outcome out = grains(inches, [](ImportOptions& o) {
    o.columns = {"x=x (in)", "y=y (in)", "radius=radius (in)"};
  });
  EXPECT_THAT(out.refused, HasSubstr("found the unit \"in\""));
  EXPECT_THAT(out.refused, Not(HasSubstr("where it is no unit")));
  EXPECT_EQ(radius("id,x (m),y (m),radius (true)\n1,0,0,5\n", {"radius=radius (true)"}), 5);
}

TEST_F(ImportSilence, DensitiesOfSpheresInThePlane) {
  const auto mass = [&](const std::string& format, const std::string& name,
                        const std::string& text) {
    return only(import(format, {write(name, text)},
                       [](ImportOptions& o) {
                         o.without_contacts = true;
                         o.density = 2500;
                       }))
        .snapshot.grains.at(0)
        .mass;
  };
  const double sphere = 2500 * 4.0 / 3 * M_PI * 1e-6, disk = 2500 * M_PI * 1e-4;
  EXPECT_NEAR(mass("yade", "b.txt", "# id x y z r\n0 0 0 0 0.01\n1 0.02 0 0 0.01\n"), sphere,
              1e-12);
  EXPECT_NEAR(mass("lammps", "d", atoms(0, "", "1 0 0 0.01\n2 0.02 0 0.01\n", "id x y radius")),
              sphere, 1e-12);
  EXPECT_NEAR(mass("csv", "g.csv", "id,x,y,radius\n1,0,0,0.01\n2,0.02,0,0.01\n"), disk, 1e-12);
  const std::string rest = " 0 0 0 0.01 0 0 0 0 0 0 0\n";
  EXPECT_NEAR(mass("mercury", "s.data", "2 0 0 0 0 1 1 1\n0 0 0" + rest + "0.02 0 0" + rest),
              sphere, 1e-12);
  EXPECT_NEAR(mass("mercury", "p.data", "2 0 0 0 1 1\n0 0 0 0 0.01 0 0 0\n0.02 0 0 0 0.01 0 0 0\n"),
              disk, 1e-12);
}

TEST_F(ImportSilence, ACellMuchWiderThanThePacking) {
  const auto warnings = [&](const char* axis) {
    return only(grains("id,x,y,radius\n1,0,0,0.005\n2,0.01,0,0.005\n",
                       [&](ImportOptions& o) { o.periodic.push_back(parse_periodic(axis)); }))
        .warnings;
  };
  EXPECT_THAT(warnings("x=0:20"), Contains(HasSubstr("1e+03 times as wide as the packing in it")));
  EXPECT_THAT(warnings("x=0:0.02"), Not(Contains(HasSubstr("as wide as"))));
}

TEST_F(ImportSilence, VolumesOfOutlines) {
  EXPECT_THAT(grains("id,x,y,outline,volume\n1,0,0,-1 -1;1 -1;1 1;-1 1,12\n").refused,
              HasSubstr("grain 1: found volume 12 and a shape that reaches 1.41421 m from its "
                        "centre, which makes 4"));
}

TEST_F(ImportSilence, PointsOffOutlinesAndSolids) {
  const std::string squares = write("g.csv",
                                    "id,x,y,outline,mass\n1,0,0,-1 -1;1 -1;1 1;-1 1,1\n"
                                    "2,0,1.99,-1 -1;1 -1;1 1;-1 1,1\n");
  const auto warnings = [&](const std::string& g, const std::string& rows) {
    return only(csv({g, write("c.csv", rows)})).warnings;
  };
  const std::string plane = "i,j,fx,fy,nx,ny,px,py\n1,2,0,-1,0,1,";
  EXPECT_THAT(warnings(squares, plane + "0.5,1\n"), Not(Contains(HasSubstr("off the outlines"))));
  for (const char* point : {"0.5,0.4", "1.6,1"})
    EXPECT_THAT(warnings(squares, plane + point + "\n"),
                Contains(HasSubstr("1 of 1 contact points lie farther than a fifth of the radius "
                                   "off the outlines")))
        << point;
  const std::string solids = write(
      "s.csv", "id,x,y,z,axis_x,axis_y,axis_z,mass\n1,0,0,0,1,1,1.5,1\n2,0,0,2.99,1,1,1.5,1\n");
  const std::string space = "i,j,fx,fy,fz,nx,ny,nz,px,py,pz\n1,2,0,0,-1,0,0,1,0,0,";
  EXPECT_THAT(warnings(solids, space + "1.495\n"), Not(Contains(HasSubstr("off the outlines"))));
  EXPECT_THAT(warnings(solids, space + "0.8\n"), Contains(HasSubstr("off the outlines")));
}

TEST_F(ImportSilence, OptionsThatTheFileOverrules) {
  EXPECT_THAT(only(grains("id,x,y,radius,mass\n1,0,0,1,1\n")).notes,
              Contains(HasSubstr("--density is not used: the table has masses")));
}

TEST_F(ImportSilence, AnglesOfOutlinesInDegrees) {
  const auto warnings = [&](const char* name, const char* angle) {
    return only(grains(
                    fmt::format("id,x,y,outline,{}\n1,0,0,-1 -1;1 -1;1 1;-1 1,{}\n", name, angle)))
        .warnings;
  };
  EXPECT_THAT(warnings("angle", "90"), Contains(HasSubstr("are they degrees, \"angle (deg)\"?")));
  EXPECT_THAT(warnings("angle (deg)", "90"), Not(Contains(HasSubstr("degrees"))));
  EXPECT_THAT(warnings("angle", "1.5"), Not(Contains(HasSubstr("degrees"))));
}

TEST_F(ImportSilence, OldDumpsAndOtherNames) {
  const std::string g =
      write("g", atoms(0, "", "1 0 0 0 0.01 1\n2 0.5 0 0 0.01 1\n", "id x y z radius mass",
                       "xy xz yz\n0 1.1 0.1\n0 1 0\n0 1 0"));
  EXPECT_EQ(import("lammps", {g}, [](ImportOptions& o) { o.without_contacts = true; }).refused, "");
  const std::string c = write("c", entries(0, "1 2 -1 0 0 0\n", "natom1 natom2 fx fy p1 p2"));
  EXPECT_EQ(only(import("lammps", {write("a", atoms(0, "")), c})).snapshot.contacts.size(), 1u);
}

TEST_F(ImportSilence, IndicesOfALatticeAreNoContacts) {
  EXPECT_EQ(only(grains("id,i,j,x,y,radius\n1,0,0,0,0,1\n2,1,0,2,0,1\n")).snapshot.grains.size(),
            2u);
}

TEST_F(ImportSilence, GrainsAndContactsOfTwoSteps) {
  const auto warnings = [&](const char* step) {
    return only(import("vtk",
                       {write("g_100.vtk", vtk_points_),
                        write(fmt::format("c_{}.vtk", step), vtk_pairs_)},
                       [](ImportOptions& o) { o.density = 2500; }))
        .warnings;
  };
  EXPECT_THAT(warnings("200"), Contains(HasSubstr("grains and contacts of one step?")));
  EXPECT_THAT(warnings("100"), Not(Contains(HasSubstr("of one step?"))));
}

TEST_F(ImportSilence, GrainsOfOneBodyUnderOtherNames) {
  for (const char* name : {"id_body", "i_body", "idms", "f_ms_id"})
    EXPECT_THAT(
        only(grains(fmt::format("id,x,y,radius,{}\n1,0,0,1,1\n2,3,0,1,1\n3,6,0,1,2\n", name)))
            .warnings,
        Contains(HasSubstr("grains of one rigid body")))
        << name;
}

}  // namespace
}  // namespace grainfield::coupling
