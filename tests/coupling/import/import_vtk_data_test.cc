// What points, lines and cells of VTK mean: three spheres in a column, with two contacts.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>

#include "coupling/import/import.h"
#include "coupling/import/step_names.h"
#include "tests/coupling/program.h"
#include "tests/refusal.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;

std::string array(const std::string& type, const std::string& name, const std::string& values,
                  int components = 1) {
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">{}"
      "</DataArray>",
      type, name, components, values);
}

const char* const kPlaces = "0 0 0 0 0 0.0099 0 0 0.0198";
const std::string kRadius = array("Float64", "radius", "0.005 0.005 0.005");
const std::string kForce = array("Float64", "force", "0 0 -1 0 0 -2", 3);
const std::string kLines = "<Lines>" + array("Int64", "connectivity", "0 1 1 2") +
                           array("Int64", "offsets", "2 4") + "</Lines>";
const std::string kVertices = "<Verts>" + array("Int64", "connectivity", "0 1 2") +
                              array("Int64", "offsets", "1 2 3") + "</Verts>";

std::string poly(const std::string& points, const std::string& cells, const std::string& of_cells,
                 const std::string& places = array("Float64", "Points", kPlaces, 3)) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
         "byte_order=\"LittleEndian\"><PolyData><Piece NumberOfPoints=\"3\"><Points>" +
         places + "</Points><PointData>" + points + "</PointData>" + cells + "<CellData>" +
         of_cells + "</CellData></Piece></PolyData></VTKFile>\n";
}

ImportOptions options_of(std::vector<std::string> files) {
  ImportOptions options;
  options.format = "vtk";
  options.density = 2500;
  options.dim = 3;
  options.files = std::move(files);
  return options;
}

dem::Snapshot read(const ImportOptions& options) {
  dem::Snapshot s;
  import_snapshots(options, [&](ImportedSnapshot&& one) { s = std::move(one.snapshot); });
  return s;
}

std::string refusal(const ImportOptions& options) {
  return refusal_of([&] { read(options); });
}

// The lowest grain is pressed down by 1 N, the highest is held up by 2 N.
void expect_column(const dem::Snapshot& s, const std::string& form) {
  ASSERT_EQ(s.grains.size(), 3u) << form;
  ASSERT_EQ(s.contacts.size(), 2u) << form;
  double low = 0, high = 0;
  for (const dem::Contact& c : s.contacts)
    for (const auto& [k, sign] : {std::pair{c.i, 1}, {c.j, -1}}) {
      const double z = s.grains[static_cast<std::size_t>(k)].position.z();
      if (z == 0) low += sign * c.force.z();
      if (z > 0.015) high += sign * c.force.z();
    }
  EXPECT_EQ(low, -1) << form;
  EXPECT_EQ(high, 2) << form;
}

// Lines name their grains by any array of ids, of any type, also one that the user chooses;
// without one by the points' numbers. Vertices have rows of data of their own, before the lines.
TEST(ImportVtkData, LinesBetweenTheGrains) {
  const Folder folder;
  const auto column = [&](const std::string& form, const std::string& text,
                          const std::string& chosen = "") {
    ImportOptions options = options_of({folder.write("b.vtp", text)});
    if (!chosen.empty()) options.columns.push_back(chosen);
    expect_column(read(options), form);
  };
  const auto ids = [](const char* type, const char* name) {
    return kRadius + array(type, name, "3 1 2");
  };
  column("id", poly(ids("Int64", "id"), kLines, kForce));
  column("floating-point id", poly(ids("Float64", "id"), kLines, kForce));
  column("another name", poly(ids("Int32", "Particle_ID"), kLines, kForce));
  column("a chosen name", poly(ids("Int32", "mark"), kLines, kForce), "id=mark");
  column("numbers", poly(kRadius, kLines, kForce));
  const std::string of_both = array("Float64", "force", "9 9 9 9 9 9 9 9 9 0 0 -1 0 0 -2", 3);
  column("vertices", poly(ids("Int64", "id"), kVertices + kLines, of_both));
  const std::string of_all =
      array("Float64", "id1", "0 0 0 3 1") + array("Float64", "id2", "0 0 0 1 2") + of_both;
  column("vertices, lines with ids", poly(ids("Int64", "id"), kVertices + kLines, of_all));
  const std::string legacy =
      "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 double\n" +
      std::string(kPlaces) +
      "\nLINES 2 6\n2 0 1\n2 1 2\nVERTICES 3 6\n1 0\n1 1\n1 2\nCELL_DATA 5\nVECTORS force double\n"
      "9 9 9\n9 9 9\n9 9 9\n0 0 -1\n0 0 -2\nPOINT_DATA 3\nFIELD FieldData 2\n"
      "Particle%20ID 1 3 int\n7 5 6\nradius 1 3 double\n0.005 0.005 0.005\n";
  column("legacy, lines first", legacy);
  EXPECT_THAT(refusal(options_of({folder.write(
                  "two.vtp", poly(ids("Int64", "Ball_ID") + array("Int64", "Grain_ID", "1 2 3"),
                                  kLines, kForce))})),
              HasSubstr("no column \"id\"; found: x y z radius Ball_ID Grain_ID"));
}

// An id of four bytes from 2^24 on may be its neighbour's.
TEST(ImportVtkData, RoundedIdsAreRefused) {
  const Folder folder;
  const auto with = [&](const char* type) {
    const std::string ids = array(type, "id", "16777216 16777218 16777220");
    return options_of({folder.write("b.vtp", poly(kRadius + ids, kLines, kForce))});
  };
  EXPECT_THAT(refusal(with("Float32")), HasSubstr("of four bytes one from 2^24 on"));
  expect_column(read(with("Float64")), "Float64");
}

TEST(ImportVtkData, PointsWithTwoIdsAreContacts) {
  const Folder folder;
  const std::string grains =
      folder.write("g.vtp", poly(kRadius + array("Int64", "id", "1 2 3"), "", ""));
  const std::string pairs = array("Int64", "id1", "1 2") + array("Int64", "id2", "2 3");
  const std::string places = array("Float64", "Points", "0 0 0.005 0 0 0.0149", 3);
  const dem::Snapshot s =
      read(options_of({grains, folder.write("c.vtp", poly(pairs + kForce, "", "", places))}));
  expect_column(s, "points");
  EXPECT_EQ(s.contacts[0].point.z(), 0.005);
  // Both ends of a line may have its data.
  const std::string four = array("Int64", "id1", "1 1 2 2") + array("Int64", "id2", "2 2 3 3") +
                           array("Float64", "force", "0 0 -1 0 0 -1 0 0 -2 0 0 -2", 3);
  const std::string lines = "<Lines>" + array("Int64", "connectivity", "0 1 2 3") +
                            array("Int64", "offsets", "2 4") + "</Lines>";
  const std::string ends = array("Float64", "Points", "0 0 0 0 0 0.0099 0 0 0.0099 0 0 0.0198", 3);
  expect_column(read(options_of({grains, folder.write("l.vtp", poly(four, lines, "", ends))})),
                "lines");
}

// The data of vertices are those of their points.
TEST(ImportVtkData, RadiiOfVertices) {
  const Folder folder;
  const std::string vertices = "<Verts>" + array("Int64", "connectivity", "2 1 0") +
                               array("Int64", "offsets", "1 2 3") + "</Verts>";
  const std::string radii = array("Float64", "radius", "0.004 0.005 0.006");
  ImportOptions options =
      options_of({folder.write("g.vtp", poly(array("Int64", "id", "1 2 3"), vertices, radii))});
  options.without_contacts = true;
  const dem::Snapshot s = read(options);
  ASSERT_EQ(s.grains.size(), 3u);
  EXPECT_EQ(s.grains[0].radius, 0.006);
  EXPECT_EQ(s.grains[2].radius, 0.004);
  EXPECT_EQ(s.grains[2].position.z(), 0.0198);
}

// A table of contacts whose force has another name is no reason to leave it out.
TEST(ImportVtkData, AForceOfAnotherNameIsAskedFor) {
  const Folder folder;
  const std::string grains =
      folder.write("g.vtp", poly(kRadius + array("Int64", "id", "1 2 3"), "", ""));
  const std::string cells = array("Int64", "id1", "1 2") + array("Int64", "id2", "2 3") +
                            array("Float64", "forceN", "1 2");
  for (const std::string& lines : {kLines, std::string()}) {
    const std::string text =
        refusal(options_of({grains, folder.write("c.vtp", poly("", lines, cells))}));
    EXPECT_THAT(text, HasSubstr("found: id1 id2 forceN"));
    EXPECT_THAT(text, ::testing::Not(HasSubstr("--without-contacts")));
  }
}

TEST(ImportVtkData, UnitsInNamesCount) {
  const Folder folder;
  const std::string points = array("Float64", "Diameter [mm]", "10 10 10") +
                             array("Float64", "Density [g/cm3]", "2.5 2.5 2.5") +
                             array("Int64", "id", "3 1 2");
  const std::string force = array("Float64", "force (mN)", "0 0 -1000 0 0 -2000", 3);
  const dem::Snapshot s = read(options_of({folder.write("b.vtp", poly(points, kLines, force))}));
  expect_column(s, "units");
  EXPECT_EQ(s.grains[0].radius, 0.005);
  EXPECT_NEAR(s.grains[0].mass, 2500 * s.grains[0].volume, 1e-15);
}

TEST(ImportVtkData, WholeNumbersHaveUnitsToo) {
  const Folder folder;
  const std::string text =
      "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 int\n"
      "0 0 0 0 0 9900 0 0 19800\nLINES 2 6\n2 0 1\n2 1 2\nCELL_DATA 2\nVECTORS force double\n"
      "0 0 -1\n0 0 -2\nPOINT_DATA 3\nFIELD FieldData 1\nradius 1 3 int\n5000 5000 5000\n";
  ImportOptions options = options_of({folder.write("b.vtk", text)});
  options.units = "um";
  const dem::Snapshot s = read(options);
  expect_column(s, "um");
  EXPECT_EQ(s.grains[0].radius, 0.005);
}

TEST(ImportVtkData, PackedFilesAreUnpacked) {
  const Folder folder;
  const std::string file =
      folder.write("b.vtp", poly(kRadius + array("Int64", "id", "1 2 3"), kLines, kForce));
  ASSERT_EQ(std::system(("gzip -k " + file).c_str()), 0);
  expect_column(read(options_of({file + ".gz"})), "gzip");
  EXPECT_THAT(refusal(options_of({folder.write("r.vtp", "\x01\x02\n")})),
              HasSubstr("r.vtp:1: found \"(no text)\", expected \"# vtk DataFile\""));
}

TEST(ImportVtkData, ListsOfFilesNameTheirFiles) {
  const Folder folder;
  const std::string pvd =
      "<?xml version=\"1.0\"?><VTKFile type=\"Collection\" version=\"0.1\"><Collection><DataSet "
      "timestep=\"0\" file=\"g_0.vtp\"/><DataSet timestep=\"1\" file=\"g_1.vtp\"/></Collection>"
      "</VTKFile>";
  EXPECT_THAT(refusal(options_of({folder.write("a.pvd", pvd)})),
              HasSubstr("only lists the files that hold the points; give these: g_0.vtp g_1.vtp"));
}

std::vector<std::optional<long long>> steps_of(const std::vector<std::string>& names) {
  std::vector<NamedFile> files;
  for (const std::string& name : names) files.push_back({name, true, {}});
  return steps_of_names(files).steps;
}

TEST(ImportVtkData, StepsAreTheNumberThatDiffers) {
  using Steps = std::vector<std::optional<long long>>;
  EXPECT_EQ(steps_of({"a1/dump100.vtk"}), Steps{100});
  EXPECT_EQ(steps_of({"g.vtp"}), Steps{std::nullopt});
  EXPECT_EQ(steps_of({"g_100_s1.vtp", "c_100_s1.vtp", "g_200_s1.vtp", "c_200_s1.vtp"}),
            (Steps{100, 100, 200, 200}));
  EXPECT_EQ(steps_of({"g_100_s1.vtp", "g_200_s1.vtp", "c_200_s1.vtp"}), (Steps{100, 200, 200}));
  EXPECT_EQ(steps_of({"g10.vtp", "c10.vtp", "g20.vtp", "c20.vtp"}), (Steps{10, 10, 20, 20}));
  EXPECT_THROW(steps_of({"g_1_p0.vtp", "g_1_p1.vtp", "g_2_p0.vtp"}), std::invalid_argument);
}

TEST(ImportVtkData, FilesWithoutAGrainInCommonArePiecesOfOneStep) {
  using Steps = std::vector<std::optional<long long>>;
  const std::function<RowKeys()> low =
                                     [] {
                                       return RowKeys{"1", "2"};
                                     },
                                 high = [] {
                                   return RowKeys{"3", "4"};
                                 };
  const NamedSteps pieces = steps_of_names({{"g_0.vtp", true, low},
                                            {"g_1.vtp", true, high},
                                            {"c_0.vtp", false, {}},
                                            {"c_1.vtp", false, {}}});
  EXPECT_EQ(pieces.steps, Steps(4));
  EXPECT_THAT(pieces.notes, ::testing::ElementsAre(HasSubstr("are pieces of one step")));
  // The step is that of two numbers within which no grain is there twice.
  const std::vector<NamedFile> both{{"g_0_100.vtp", true, low},
                                    {"g_1_100.vtp", true, high},
                                    {"g_0_200.vtp", true, low},
                                    {"g_1_200.vtp", true, high}};
  EXPECT_EQ(steps_of_names(both).steps, (Steps{100, 100, 200, 200}));
  const NamedSteps steps = steps_of_names({{"g_0.vtp", true, low}, {"g_1.vtp", true, low}});
  EXPECT_EQ(steps.steps, (Steps{0, 1}));
  EXPECT_TRUE(steps.notes.empty());
  EXPECT_THAT(steps_of_names({{"g_0.vtp", true, {}}, {"g_1.vtp", true, {}}}).notes,
              ::testing::ElementsAre(HasSubstr("taken as steps")));
}

}  // namespace
}  // namespace grainfield::coupling
