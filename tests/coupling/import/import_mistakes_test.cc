// Mistakes in foreign files: each one clear line.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/coupling/import_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;
using ::testing::StartsWith;

// Files of two grains and a wall, one line of them changed, and what is said about it.
struct Mistake {
  std::string grains, contacts, options, words;
};

void expect_refused(const std::string& format, const Mistake& m) {
  const Folder folder;
  std::string files;
  if (!m.grains.empty()) files += " " + folder.write("g.txt", m.grains);
  if (!m.contacts.empty()) files += " " + folder.write("c.txt", m.contacts);
  const Output output =
      program("import --from " + format + " " + m.options + files + " -o " + (folder / "o.h5"));
  EXPECT_EQ(output.code, 2) << output.err;
  EXPECT_EQ(output.out, "");
  EXPECT_THAT(output.err, StartsWith("grainfield: "));
  EXPECT_THAT(output.err, HasSubstr(m.words));
  EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
  EXPECT_FALSE(testing::fs::exists(folder / "o.h5"));
  EXPECT_EQ(std::distance(testing::fs::directory_iterator(folder.path()),
                          testing::fs::directory_iterator()),
            static_cast<long>(!m.grains.empty()) + static_cast<long>(!m.contacts.empty()));
}

TEST(ImportMistakes, MistakesInCsv) {
  const std::string g = "id,x,y,radius,mass\n1,0,0,1,1\n2,0,1.9,1,1\n", c = "i,j,fx,fy\n1,2,0,-3\n";
  const std::vector<Mistake> mistakes{
      {"", c, "", "no table of grains in "},
      {g, "", "", "no table of contacts in "},
      {"# nothing\n", c, "",
       "g.txt: is empty, expected a line of names such as id,x,y,radius,mass"},
      {"id,x,y,radius,mass\n", c, "", "the tables of grains hold no row"},
      {"id,x,y,radus,mass\n1,0,0,1,1\n", c, "",
       "g.txt:1: no column \"radius\"; found: id x y radus mass; nearest: radus; other names by "
       "--column radius=THEIRS"},
      {"id,x,y,Rp [m],mass\n1,0,0,1,1\n", c, "", "nearest: Rp [m]; other names by --column"},
      {"id,x,y,d,mass\n1,0,0,1,1\n", c, "", "nearest: d (--column diameter=d); other"},
      {"number,x,y,radius,mass\n1,0,0,1,1\n", c, "",
       "no column \"id\"; found: number x y radius mass; nearest: number"},
      {"id,xc,yc,radius,mass\n1,0,0,1,1\n", c, "", "nearest: x (xc), y (yc)"},
      {g, "i,j,f1,f2\n1,2,0,1\n", "", "nearest: f1; other names"},
      {"id,x,y,radius\n1,0,0,1\n", c, "", "or --density"},
      {g, "# c\ni,j,fx\n1,2,0\n", "",
       "c.txt:2: no column \"fy\"; found: i j fx; other names by --column fy=THEIRS"},
      {g, "i,j,fnx,fny\n1,2,0,1\n", "", "without friction: --column ftx,fty,ftz=0,0,0"},
      {g + "3,0,abc,1,1\n", c, "", "g.txt:4: column y: found \"abc\", expected a finite number"},
      {g + "3,0,nan,1,1\n", c, "", "g.txt:4: column y: found \"nan\", expected a finite number"},
      {g + "3,0,1e999,1,1\n", c, "", "found \"1e999\", expected a finite number"},
      {g + "3,,0,1,1\n", c, "", "g.txt:4: column x: found \"\", expected a finite number"},
      {g + "3.5,0,0,1,1\n", c, "", "column id: found \"3.5\", expected a whole number"},
      {g + "3,0,0,1\n", c, "", "g.txt:4: 4 values where the header at line 1 names 5 columns"},
      {g + "1,5,5,1,1\n", c, "", "g.txt:4: grain 1 is there already, at "},
      {g + "3,0,0,0,1\n", c, "", "g.txt:4: grain 3: found radius 0 m, allowed: above 0"},
      {g + "3,0,0,1,-1\n", c, "", "g.txt:4: grain 3: found mass -1, allowed: above 0"},
      {g, c + "1,7,0,0\n", "",
       "c.txt:3: contact of the unknown grain 7; known: 2 grains with ids from 1 to 2, no walls "
       "(--wall)"},
      {g, c + "1,flor,0,0\n", "--wall floor:y=-1",
       "c.txt:3: contact with the unknown wall \"flor\"; known: 2 grains with ids from 1 to 2, "
       "walls floor; --wall flor:AXIS=POSITION describes it"},
      {g, c + "2,2,0,0\n", "", "c.txt:3: grain 2 in contact with itself"},
      {g, c + "2,1,0,0\n", "", "c.txt:3: the contact of grains 1 and 2 is there already, at "},
      {g, c + "2,1,0,inf\n", "", "c.txt:3: column fy: found \"inf\""},
      {g, c + "1,floor,0,3\n", "--wall floor:y=-5",
       "c.txt:3: grain 1 of radius 1 m in contact with wall floor at a distance of 5 m: is the "
       "wall "
       "where it says?"},
      {g, c + "1,floor,0,3\n1,floor,0,3\n", "--wall floor:y=-1",
       "c.txt:4: the contact of grain 1 and wall floor is there already, at "},
      {"id,xs,ys,radius,mass\n1,0,0,1,1\n", c, "",
       "g.txt:1: places over the box (id xs ys radius mass), and no box"},
      {g + "3,50,0,1,1\n", c + "1,3,0,1\n", "",
       "across a periodic boundary? --periodic AXIS=LOW:HIGH"},
      {g, "i,j,nx,ny,px,py,fx,fy\n1,2,0,0,0,1,1,1\n", "",
       "c.txt:2: the contact's normal has length 0"},
      {g, "i,j,nx,ny,px,py,fx,fy\n1,2,1e300,1,0,1,1,1\n", "",
       "c.txt:2: the contact's normal has length inf"},
      {g + "3,0,0,1e200,1\n", c, "",
       "g.txt:4: grain 3: its radius becomes 1e+200, allowed: a finite number, up to 1e+100"},
      {g + "3,1e300,0,1,1\n", c, "--periodic x=0:10",
       "g.txt:4: grain 3: a place 1e+299 edges of the periodic cell away, allowed: up to 1000000"},
      {g + "3,0,0,1,1\n", c + "1,3,0,0\n", "", "grains 1 and 3 have the same centre"},
      {"id,x,y,z,radius,mass\n1,0,0,0,1,1\n2,0,1.9,0.1,1,1\n", c, "--dim 2",
       "g.txt:3: grain 2 has z = 0.1, grain 1 has z = 0; 2D needs one z"},
      {"id,x,y,z,radius,mass\n1,0,0,0,1,1\n2,0,1.9,0.1,1,1\n", c, "", "c.txt:1: no column \"fz\""},
      {g, c, "--dim 3", "g.txt:1: no column \"z\""},
      {g, c, "--dim 4", "--dim: found 4, allowed: 2, 3"},
      {g, "i,j,fx,fy,fz\n1,2,0,-3,0.5\n", "", "c.txt:2: found a force of 0.5 N along z in 2D"},
      {"id,x,y,z,outline,mass\n1,0,0,0,0 0;1 0;0 1,1\n2,0,0,1,0 0;1 0;0 1,1\n", c, "",
       "g.txt:2: grain 1 is a polygon; 3D takes spheres"},
      {"id,x,y,outline,mass\n1,0,0,0 0;1 0;0,1\n", c, "",
       "g.txt:2: grain 1: corner 3 of the outline: found \"0\", expected two finite numbers"},
      {"id,x,y,outline,mass\n1,0,0,0 0;2 0;1 0.2;0 2,1\n", c, "", "g.txt:2: grain 1: "},
      {"id,x,y,outline,mass\n1,0,0,,1\n", c, "", "grain 1 has neither a radius nor an outline"},
      {"id,x,y,outline,mass\n1,0,0,-1 -1;1 -1;0 1,1\n2,0,1,-1 -1;1 -1;0 1,1\n", c, "",
       "c.txt:2: contact of grains 1 and 2: those of polygons need px, py, nx and ny"},
      {g, c, "--column radius", "--column: found \"radius\", expected OURS=THEIRS"},
      {g, c, "--column radios=r", "unknown name \"radios\"; nearest: radius"},
      {g, c, "--column i,j=a", "--column i,j=a: 2 names on the left, 1 on the right"},
      {g, c, "--column radius=r_p",
       "--column radius=r_p: no table that needs radius has a column \"r_p\""},
      {g, c, "--wall floor:w=0", "--wall: found \"floor:w=0\", expected NAME:AXIS=POSITION"},
      {g, c, "--wall floor:z=0", "--wall floor: a wall across z in a packing in 2D"},
      {g, c, "--gravity 1", "--gravity: found \"1\", expected X,Y or X,Y,Z"},
      {g, c, "--fixed type", "--fixed: found \"type\", expected COLUMN=VALUE"},
      {g, c, "--fixed type=2", "g.txt:1: no column \"type\"; found: id x y radius mass"},
      {g, c, "--step 5", "--step: the files of csv hold no time steps"},
      {g, c, "--load 9=0,1", "--load: unknown grain 9; known: 2 grains"},
      {g, c, "--density -1", "--density: found -1, allowed: above 0"},
      {g, c, "--friction -0.5", "--friction: found -0.5, allowed: 0 to 1e+06"},
      {g, c, "--friction nan", "--friction: found nan, allowed: 0 to 1e+06"},
      {g, c, "--friction 1e7", "--friction: found 1e+07, allowed: 0 to 1e+06"},
      {g, c, "--column friction=-1", "c.txt:2: column friction: found -1, allowed: 0 to 1e+06"},
      {g, c, "--column friction=inf",
       "--column friction=inf: expected a column or a finite number"},
      {g, "i,j,fx,fy,friction\n1,2,0,-3,1e9\n", "",
       "c.txt:2: column friction: found 1000000000, allowed: 0 to 1e+06"},
      {g, "i,j,fx,fy,sliding\n1,2,0,-3,2\n", "", "c.txt:2: column sliding: found 2, allowed: 0, 1"},
      {g, c, "--column sliding=2", "c.txt:2: column sliding: found 2, allowed: 0, 1"},
      {"id,x,y,radius,mass,fixed\n1,0,0,1,1,0\n2,0,1.9,1,1,-1\n", c, "",
       "g.txt:3: column fixed: found -1, allowed: 0, 1"},
      {"id,x,y,x,radius,mass\n1,0,0,0,1,1\n2,0,1.9,0,1,1\n", c, "",
       "g.txt:1: column \"x\" is there twice, allowed: once"},
      {g, c, "--time-step nan",
       "--time-step: found nan, allowed: a finite number of seconds from 0"},
      {g, c, "--time-step -1", "--time-step: found -1, allowed: "},
      {g, c, "--time-step inf", "--time-step: found inf, allowed: "},
      {"id,x,y,radius,diameter,mass\n1,0,0,1,2.00001,1\n2,0,1.9,1,1,1\n", c, "",
       "g.txt:3: grain 2: found radius 1 m and diameter 1 m, allowed: twice the radius, or one of "
       "the columns"},
      {"id,x,y,radius,mass,density\n1,0,0,1,3.1416,1\n2,0,1.9,1,4.1888,1\n3,5,0,1,1,1\n", c, "",
       "g.txt:4: grain 3: found mass 1 kg and density 1, which makes 3.14159 kg, allowed: "},
      {g + "3,0,1.9,1,1\n", c, "",
       "g.txt:4: grains 2 and 3 have the same centre, (0, 1.9, 0) m, allowed: a place for each"},
      {g + "3,10,1.9,1,1\n", c, "--periodic x=0:10",
       "g.txt:4: grains 2 and 3 have the same centre, (0, 1.9, 0) m in the periodic cell"},
      {"id,x,y,radius,mass,vx\n1,0,0,1,1,0\n2,0,1.9,1,1,-1e101\n", c, "",
       "g.txt:3: grain 2: its vx becomes -1e+101, allowed: a finite number, up to 1e+100"},
      {g, c, "--fixed id=99,98", "--fixed id=99,98: no grain has that; column id holds 1, 2"},
      {g, c, "--gravity 0,-9.81,5", "--gravity: found 5 m/s2 along z in 2D, allowed: X,Y"},
      {g, c, "--load 1=0,-1,5", "--load: found 5 N along z in 2D, allowed: ID=FX,FY"},
      {g, c, "--gravity 0,-1e101", "--gravity: found 1e+101, allowed: up to 1e+100"},
      {g + "3,0,1e12,1,1\n", c, "",
       "g.txt:4: grain 3 is 1e+12 median radii from the middle of the packing, allowed: up to "
       "1e+09"},
      {g, c, "--periodic x=0:10 --periodic x=0:20",
       "--periodic: axis x is given twice, allowed: once"},
      {g, c, "--wall floor:y=-1 --wall floor:y=-2",
       "--wall floor: a wall is called floor already, allowed: every name and id once"},
      {g, c, "--wall floor:y=-1:ids=7 --wall left:x=-1:ids=7",
       "--wall left: a wall is called 7 already"},
      {g, "i,j,px,py,nx,ny,fx,fy\n1,2,0,9,0,1,0,-3\n", "",
       "c.txt:2: the point (0, 9, 0) m of the contact is 9 m from grain 1 of radius 1 m and 7.1 m "
       "from grain 2 of radius 1 m, allowed: up to 2 radii from each"},
      {g, c + "1,floor,0,3\n", "--wall floor:y=-1 --column px=0 --column py=6",
       "c.txt:2: the point (0, 6, 0) m of the contact is 6 m from grain 1 "},
      {g, "i,j,px,py,fx,fy\n1,floor,0,8,0,3\n", "--wall floor:y=-1",
       "c.txt:2: the point (0, 8, 0) m of the contact with wall floor is 8 m from grain 1 of "
       "radius "
       "1 m, allowed: up to 2 radii"},
      {g, "i,j,px,py,fx,fy\n1,floor,0,-1,0,3\n", "--wall floor:y=2",
       "--wall floor: 1 of 1 grains in contact with wall floor are not on the side to which its "
       "normal (0, -1) points, allowed: a normal into the grains; they lie towards (0, 1); --wall "
       "points to the middle of all grains, a table of walls says it"},
  };
  for (const char* name : {".", "/", "//x//", "a/../b", "a:b", "a/", "'a\nb'", "'a\tb'"}) {
    expect_refused("csv", {g, c, fmt::format("--group {}", name), "--group: found the name \""});
  }
  expect_refused("csv", {g, c, "--group a:b",
                         "allowed: names such as packing or heap_1/loaded, without \":\", control "
                         "characters and parts that are empty, \".\" or \"..\""});
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.grains + mistake.contacts + mistake.options);
    expect_refused("csv", mistake);
  }
  expect_refused(
      "cvs",
      {g, c, "",
       "--from: unknown format \"cvs\"; nearest: csv; allowed: lammps, liggghts, yade, csv"});
}

TEST(ImportMistakes, MistakesInDumps) {
  const dem::Snapshot ours = test::overlapping_layer(8, 3, 2);
  const std::string g = test::dump_grains(ours, 7, false), c = test::lammps_contacts(ours, 7);
  const std::string columns = test::lammps_columns;
  const auto cut = [](std::string text, std::size_t bytes) {
    text.resize(text.size() - bytes);
    return text;
  };
  const auto changed = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::vector<Mistake> mistakes{
      {g, c, "", "c.txt:9: no columns \"i\", \"j\", \"fx\"; found: index c_ids[1] c_ids[2] c_p[1]"},
      {changed(g, " radius", " c_r"), c, columns,
       "g.txt:9: no column \"radius\"; found: id type x y z c_r mass; nearest: c_r; "},
      {cut(g, 1), c, columns,
       "truncated: step 7 has 6 rows announced, 5 there (the last one ends without a line end)"},
      {cut(g, 60), c, columns, "g.txt:15: truncated: step 7 has 6 rows announced, 5 there"},
      {g, cut(c, 200), columns, "truncated: step 7 has "},
      {g.substr(0, 30), c, columns, "g.txt:3: truncated: the file ends in the middle of a line"},
      {g + g.substr(0, 100), c, columns, "truncated"},
      {"", c, columns, "no table of grains of step 7 in "},
      {g, test::lammps_contacts(ours, 8), columns + " --step 7",
       "no table of contacts of step 7 in "},
      {"some text\n", c, columns,
       "g.txt:1: found \"some text\", expected \"ITEM: ...\"; is this a dump file?"},
      {"ITEM: UNITS\nlj\n" + g, c, columns, "g.txt:2: units \"lj\", allowed: si, cgs, micro, nano"},
      {changed(g, "NUMBER OF ATOMS\n6", "NUMBER OF ATOMS\nsix"), c, columns,
       "g.txt:4: found \"six\", expected the number of rows"},
      {changed(g, "NUMBER OF ATOMS\n6", "NUMBER OF ATOMS\n5"), c, columns,
       "expected \"ITEM: ...\""},
      {"ITEM: ATOMS id\n1\n", c, columns, "before ITEM: TIMESTEP and ITEM: NUMBER OF ..."},
      {"ITEM: TIMES", "ITEM: TIMES", "",
       "g.txt:1: truncated: the file ends in the middle of a line"},
      {"ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n0\nITEM:  \n", c, columns,
       "g.txt:5: found \"ITEM:\" without a name, expected ATOMS or ENTRIES behind it"},
      {g, c, columns + " --wall floor:y=0:fix=f_floor",
       "g.txt:9: no column \"f_floor[1]\"; found: id type"},
      {changed(g, "BOX BOUNDS ff ff pp", "BOX BOUNDS pp qq ff"), c, columns,
       "g.txt:5: found the boundaries \"BOX BOUNDS pp qq ff\", expected three of pp or two of f, "
       "s, "
       "m each"},
      {changed(g, "BOX BOUNDS ff ff pp", "BOX BOUNDS pf ff ff"), c, columns,
       "g.txt:5: found the boundaries"},
      {changed(g, "BOX BOUNDS ff ff pp", "BOX BOUNDS ff ff"), c, columns,
       "g.txt:5: found the boundaries"},
      {"ITEM: TIME\nnan\n" + g, c, columns,
       "g.txt:2: found \"nan\", expected the time, a finite number from 0"},
      {"ITEM: TIME\n-1\n" + g, c, columns, "g.txt:2: found \"-1\", expected the time"},
      {g, c, columns + " --step 7=a//b", "--step: found the name \"a//b\" of a snapshot"},
      {"\x1f\x8b\x08 compressed", c, columns, "is damaged or cut off"},
      {std::string(std::size_t{1} << 20, 'x'), c, columns,
       "g.txt:1: the line is longer than 1048575 bytes"},
  };
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.words);
    expect_refused("lammps", mistake);
  }
  // An earlier step of a truncated dump can be had.
  const Folder folder;
  const std::string files = folder.write("g", g + cut(test::dump_grains(ours, 8, false), 5)) + " " +
                            folder.write("c", c + test::lammps_contacts(ours, 8)) + columns +
                            " -o " + (folder / "o.h5");
  EXPECT_EQ(program("import --from lammps --step 7 " + files).code, 0);
  // By default it is taken, and the other one told.
  const Output whole = program("import --from lammps " + files);
  EXPECT_EQ(whole.code, 0);
  EXPECT_THAT(whole.err, HasSubstr("truncated: step 8 has 6 rows announced"));
  EXPECT_EQ(program("import --from lammps --step 8 " + files).code, 2);
  EXPECT_THAT(program("import --from lammps " + (folder / "none") + " -o x").err,
              HasSubstr("none: No such file"));
  EXPECT_THAT(program("import --from lammps " + folder.path() + " -o x").err,
              HasSubstr("is a folder"));
}

// The normal of a wall decides on the sign of what it bears.
TEST(ImportMistakes, WallsThatTurnTheirBacks) {
  const Folder folder;
  const std::string grains =
      folder.write("g.csv",
                   "id,x,y,radius,density\n1,0,0.01,0.01,5000\n2,0,0.0299,0.01,5000\n"
                   "3,0.02,0.01,0.01,5000\n");
  const std::string contacts =
      folder.write("k.csv",
                   "i,j,px,py,nx,ny,fx,fy\n1,floor,0,0,0,-1,0,30.8\n1,2,0,0.02,0,1,0,-15.4\n"
                   "3,floor,0.02,0,0,-1,0,15.4\n");
  const auto import = [&](const std::string& walls, const std::string& more = "") {
    return program("import --from csv " + grains + " " + contacts + " " +
                   folder.write("w.csv", "name,x,y,nx,ny\n" + walls) + " " + more + " -o " +
                   (folder / "o.h5"));
  };
  const Output good = import("floor,0,0,0,1\n");
  EXPECT_EQ(good.code, 0) << good.err;
  EXPECT_EQ(good.err, "");
  for (const char* normal : {"0,-1", "1,0", "-1,0", "1,-1"}) {
    const Output bad = import(fmt::format("floor,0,0,{}\n", normal));
    EXPECT_EQ(bad.code, 2) << normal;
    EXPECT_THAT(bad.err, HasSubstr("w.csv:2: 2 of 2 grains in contact with wall floor are not on "
                                   "the side to which its normal ("));
    EXPECT_THAT(bad.err, HasSubstr("allowed: a normal into the grains; they lie towards (0, 1)\n"));
  }
  // Grains beyond a wall that they do not touch are none of its.
  EXPECT_EQ(import("floor,0,0,0,1\nshelf,0,0.02,0,-1\n").code, 0);
  EXPECT_THAT(import("floor,0,0,0,1\nfloor,0,0,0,1\n").err,
              HasSubstr("w.csv:3: wall floor is there already, at "));
  EXPECT_THAT(import("floor,0,0,0,1\n", "--wall floor:y=0").err,
              HasSubstr("w.csv:2: wall floor is there already, by --wall"));
  // Without points the heights tell.
  const std::string plain =
      folder.write("p.csv", "i,j,fx,fy\n1,floor,0,30.8\n1,2,0,-15.4\n3,floor,0,15.4\n");
  for (const char* normal : {"0,-1", "1,0"}) {
    const Output bad =
        program("import --from csv " + grains + " " + plain + " " +
                folder.write("w.csv", fmt::format("name,x,y,nx,ny\nfloor,0,0,{}\n", normal)) +
                " -o " + (folder / "o.h5"));
    EXPECT_EQ(bad.code, 2) << normal;
    EXPECT_THAT(bad.err, HasSubstr("are not on the side to which its normal"));
  }
}

TEST(ImportMistakes, WhatTheSystemCannotRead) {
  const Folder folder;
  const Output output =
      program("import --from csv --without-contacts /proc/self/mem -o " + (folder / "o.h5"));
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr("/proc/self/mem: cannot be read: "));
}

TEST(ImportMistakes, ColumnsThatAreNearlyOurs) {
  const Folder folder;
  const std::string csv =
      folder.write("g.csv", "id,x,y,radius,density,fixd,temperature\n1,0,1,1,5000,1,300\n");
  const auto import = [&](const std::string& more) {
    return program("import --from csv --without-contacts " + csv + more + " -o " +
                   (folder / "o.h5"));
  };
  const Output output = import("");
  EXPECT_EQ(output.code, 0);
  EXPECT_THAT(output.err, HasSubstr("g.csv:1: the column \"fixd\" is not used; nearest: fixed"));
  EXPECT_THAT(output.err, ::testing::Not(HasSubstr("temperature")));
  EXPECT_THAT(import(" --column fixed=fixd").err, ::testing::Not(HasSubstr("is not used")));
}

TEST(ImportMistakes, NoPackingWithinAnother) {
  const Folder folder;
  const std::string rest =
      folder.write("g.csv", "id,x,y,radius,density\n1,0,1,1,5000\n") + " -o " + (folder / "o.h5");
  const auto import = [&](const std::string& more) {
    return program("import --from csv --without-contacts " + more + " " + rest);
  };
  ASSERT_EQ(import("--group a/b").code, 0);
  EXPECT_THAT(import("--add --group a/b/c").err,
              HasSubstr("holds a snapshot /a/b, and /a/b/c would be one within the other"));
  EXPECT_EQ(import("--add --group a").code, 2);
  EXPECT_EQ(import("--add --group a/c").code, 0);
}

TEST(ImportMistakes, MistakesInYade) {
  expect_refused(
      "yade",
      {"1 0 0 0 1\n", "# id1 id2 fx fy fz\n", "--density 1",
       "g.txt:1: no comment line above names the 5 columns; expected \"#format id_x_y_z_r\""});
  expect_refused(
      "yade", {"#format x_y_z_r\n0 0 0 1\n", "# id1 id2 fx fy fz\n", "--density 1",
               "g.txt:1: no column \"id\"; found: x y z r; the contacts name their grains by it"});
}

}  // namespace
}  // namespace grainfield::coupling
