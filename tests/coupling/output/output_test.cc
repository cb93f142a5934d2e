// Files: complete or not at all, read back as written, well-formed, and their error texts.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sstream>

#include "coupling/result/tables.h"
#include "coupling/store/atomic_file.h"
#include "coupling/store/field_io.h"
#include "coupling/store/vtu.h"
#include "dem/hdf5/file.h"
#include "tests/coupling/averaging_scene.h"
#include "tests/coupling/heap_scene.h"
#include "tests/refusal.h"

namespace grainfield::coupling {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Output : public testing::Test {
 protected:
  Output() {
    std::string name = (fs::temp_directory_path() / "grainfield-test-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~Output() override { fs::remove_all(folder_); }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  static std::string text(const std::string& file) {
    std::ifstream in(file);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  }

  fs::path folder_;
};

Field sample(bool grid) {
  Field f;
  f.points.resize(6, 2);
  f.points << 0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1;
  if (grid) {
    f.nx = 3;
    f.ny = 2;
  }
  f.realizations = 4;
  f.attributes = {{"kernel", "lucy"}, {"what", "a <test> & \"more\""},
                  {"h", 0.25},        {"left_deg", std::vector<double>{25.5, 26}},
                  {"nothing", "nan"}, {"padded", "0.10"}};
  Column& c = f.add("sigma_yy", "N/m");
  c.value << 1, 2, NAN, 4, 5, 1.0 / 3;
  c.error = Eigen::VectorXd::Constant(6, 0.1);
  f.add("grains", "1").value.setConstant(7);
  return f;
}

TEST_F(Output, AtomicFileAppearsOnCommitOnly) {
  {
    AtomicFile file(at("a.txt"));
    std::ofstream(file.temporary()) << "half";
    EXPECT_FALSE(fs::exists(at("a.txt")));
  }
  EXPECT_EQ(files(), 0u);
  write_text_file(at("a.txt"), "whole");
  EXPECT_EQ(text(at("a.txt")), "whole");
  EXPECT_EQ(files(), 1u);
}

TEST_F(Output, AtomicFileRefusesWhereItCannotWrite) {
  EXPECT_EQ(refusal_of([&] { write_text_file(at("no/a.txt"), ""); }),
            "cannot write " + at("no/a.txt") + ": " + at("no") + " is not a folder");
  EXPECT_EQ(refusal_of([&] { write_text_file(folder_.string(), ""); }),
            "cannot write " + folder_.string() + ": it is a folder");
  if (geteuid() != 0) {
    fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_THAT(refusal_of([&] { write_text_file(at("a.txt"), ""); }), HasSubstr("no permission"));
    fs::permissions(folder_, fs::perms::owner_all);
  }
}

TEST_F(Output, LinksAreFollowed) {
  write_text_file(at("real.txt"), "old");
  fs::create_symlink("real.txt", at("link"));
  fs::create_symlink(at("link"), at("link-to-link"));
  write_text_file(at("link-to-link"), "new");
  EXPECT_EQ(text(at("real.txt")), "new");
  EXPECT_TRUE(fs::is_symlink(at("link")));
  EXPECT_TRUE(fs::is_symlink(at("link-to-link")));
  fs::create_symlink("later.txt", at("dangling"));
  write_text_file(at("dangling"), "there");
  EXPECT_EQ(text(at("later.txt")), "there");
  fs::create_symlink("circle", at("circle"));
  EXPECT_THAT(refusal_of([&] { write_text_file(at("circle"), ""); }),
              HasSubstr("cannot write " + at("circle") + ": "));
}

TEST_F(Output, WhatIsNoFileIsNotReplaced) {
  EXPECT_EQ(refusal_of([&] { write_text_file("/dev/null", ""); }),
            "cannot write /dev/null: it is a device");
  fs::create_symlink("/dev/full", at("link"));
  EXPECT_THAT(refusal_of([&] { write_text_file(at("link"), ""); }), HasSubstr("it is a device"));
  ASSERT_EQ(mkfifo(at("pipe").c_str(), 0600), 0);
  EXPECT_THAT(refusal_of([&] { write_text_file(at("pipe"), ""); }), HasSubstr("it is a pipe"));
  EXPECT_TRUE(fs::is_fifo(at("pipe")));
}

TEST_F(Output, AReplacedFileHandsOnItsPermissions) {
  write_text_file(at("a.txt"), "old");
  const auto only_mine = fs::perms::owner_read | fs::perms::owner_write;
  fs::permissions(at("a.txt"), only_mine);
  write_text_file(at("a.txt"), "new");
  EXPECT_EQ(fs::status(at("a.txt")).permissions(), only_mine);
}

TEST_F(Output, LongNamesHaveRoomForATemporaryOne) {
  const std::string name(250, 'n');
  write_text_file(at(name), "x");
  EXPECT_EQ(text(at(name)), "x");
  EXPECT_THAT(refusal_of([&] { write_text_file(at(std::string(300, 'n')), "x"); }),
              HasSubstr("File name too long"));
}

TEST_F(Output, FilesThatBelongTogetherAppearTogether) {
  EXPECT_THROW(write_text_files({{at("a.txt"), "a"}, {at("no/b.txt"), "b"}}),
               std::invalid_argument);
  EXPECT_EQ(files(), 0u);
}

TEST_F(Output, FieldsComeBackBitForBit) {
  write_fields(at("fields.h5"), {{"map", sample(true)}, {"line-1", sample(false)}});
  EXPECT_EQ(files(), 2u);
  EXPECT_THAT(list_fields(at("fields.h5")), testing::UnorderedElementsAre("map", "line-1"));
  const Field f = read_field(at("fields.h5"), "map"), g = sample(true);
  EXPECT_EQ(f.points, g.points);
  EXPECT_EQ(f.nx, 3);
  EXPECT_EQ(f.ny, 2);
  EXPECT_EQ(f.realizations, 4);
  EXPECT_EQ(f.attributes, g.attributes);
  ASSERT_EQ(f.columns.size(), 2u);
  EXPECT_EQ(f.columns[0].name, "sigma_yy");
  EXPECT_EQ(f.columns[0].unit, "N/m");
  EXPECT_EQ(f.columns[0].value[5], 1.0 / 3);
  EXPECT_TRUE(std::isnan(f.columns[0].value[2]));
  EXPECT_EQ(f.columns[0].error, g.columns[0].error);
  EXPECT_EQ(f.columns[1].error.size(), 0);
}

// As h5py writes: texts of variable length.
TEST_F(Output, TextsOfVariableLengthAreRead) {
  write_fields(at("f.h5"), {{"map", sample(true)}});
  namespace h5 = dem::hdf5;
  {
    const h5::Handle file = h5::open_for_adding(at("f.h5"));
    const h5::Handle group = h5::open_group(file, "map");
    const h5::Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, H5T_VARIABLE);
    const h5::Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const auto replace = [&](const char* name, const char* text) {
      H5Adelete(group, name);
      const h5::Handle a(H5Acreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
      ASSERT_GE(H5Awrite(a, type, &text), 0);
    };
    const std::string columns = h5::read_text_attribute(group, "columns");
    replace("kind", "field");
    replace("columns", columns.c_str());
    replace("attribute.kernel", "from Python");
  }
  const Field f = read_field(at("f.h5"), "map");
  EXPECT_EQ(f.word("kernel"), "from Python");
  EXPECT_EQ(f.columns.size(), sample(true).columns.size());
}

TEST_F(Output, NumbersAmongAttributesAreNumbers) {
  write_fields(at("f.h5"), {{"map", sample(true)}});
  const dem::hdf5::Handle file = dem::hdf5::open_for_reading(at("f.h5"));
  EXPECT_EQ(dem::hdf5::number_attributes(dem::hdf5::open_group(file, "map")),
            (std::vector<std::string>{"attribute.h", "dim", "nx", "ny", "realizations"}));
}

// Files of format 1: a list of numbers is a text, a frame a sentence.
TEST_F(Output, OldAttributesHaveTheSameNumbers) {
  write_fields(at("f.h5"), {{"map", sample(true)}});
  {
    namespace h5 = dem::hdf5;
    const h5::Handle file = h5::open_for_adding(at("f.h5"));
    const h5::Handle group = h5::open_group(file, "map");
    h5::write_attribute(group, "attribute.heap.h", "0.1,0.30000000000000004");
    h5::write_attribute(group, "attribute.right_deg", "25.5, nan");
    h5::write_attribute(group, "attribute.rho_g_h", "12.5");
    h5::write_attribute(group, "attribute.frame",
                        "heap: apex at (0, 0), floor y = -h; every pile scaled by its own height");
  }
  const Field f = read_field(at("f.h5"), "map");
  EXPECT_EQ(f.attributes.at("heap.h"), Attribute(std::vector<double>{0.1, 0.1 + 0.2}));
  EXPECT_TRUE(std::isnan(f.number("right_deg")));
  EXPECT_EQ(f.attributes.at("rho_g_h"), Attribute(12.5));
  EXPECT_TRUE(f.is_of_heap());
  EXPECT_FALSE(f.is_over_height());
  EXPECT_FALSE(f.is_of_rings());
  Attributes of_rings{
      {"frame", "heap: apex at (0, 0, 0), lengths over its height h, rings: radius"}};
  type_attributes(of_rings);
  EXPECT_EQ(of_rings, (Attributes{{"frame", "heap"}, {"rings", 1.0}}));
  Attributes of_layer{{"frame", "models: load at (0, 0), surface y = 0"}, {"width", "0.01 m"}};
  type_attributes(of_layer);
  EXPECT_EQ(of_layer, (Attributes{{"frame", "layer"}, {"width", "0.01 m"}}));
}

TEST_F(Output, FieldReaderNamesWhatIsWrong) {
  const std::string file = at("fields.h5");
  EXPECT_EQ(refusal_of([&] { read_field(file, "map"); }), file + ": no such file");
  write_fields(file, {{"map", sample(true)}, {"base", sample(false)}});
  EXPECT_EQ(refusal_of([&] { read_field(file, "mop"); }),
            file + ": unknown field \"mop\"; known: base, map; did you mean \"map\"?");
  const std::string whole = text(file);
  std::ofstream(at("cut.h5"), std::ios::binary) << whole.substr(0, whole.size() / 2);
  EXPECT_EQ(refusal_of([&] { read_field(at("cut.h5"), "map"); }),
            at("cut.h5") + ": the HDF5 file is truncated or broken");
  std::ofstream(at("text.h5")) << "hello";
  EXPECT_THAT(refusal_of([&] { read_field(at("text.h5"), "map"); }), HasSubstr("not an HDF5 file"));
}

TEST_F(Output, FieldWriterRefusesAndLeavesNothing) {
  EXPECT_THAT(refusal_of([&] {
                write_fields(at("f.h5"), {{"a/b", sample(true)}});
              }),
              HasSubstr("\"a/b\" cannot name a field"));
  Field f = sample(true);
  f.nx = 5;
  EXPECT_EQ(refusal_of([&] {
              write_fields(at("f.h5"), {{"map", f}});
            }),
            "field \"map\": a grid of 5 x 2 with 6 points");
  f = sample(true);
  f.columns[0].value.resize(3);
  EXPECT_EQ(refusal_of([&] {
              write_fields(at("f.h5"), {{"map", f}});
            }),
            "field \"map\": column \"sigma_yy\" has 3 values and 6 errors for 6 points");
  EXPECT_EQ(files(), 0u);
}

TEST_F(Output, XdmfIsWellFormedAndPointsAtTheData) {
  write_fields(at("fields.h5"), {{"map", sample(true)}, {"line", sample(false)}});
  pugi::xml_document document;
  ASSERT_TRUE(document.load_file(at("fields.xdmf").c_str()));
  const auto grids = document.select_nodes("//Grid[@GridType='Uniform']");
  ASSERT_EQ(grids.size(), 2u);
  EXPECT_STREQ(document.select_node("//Grid[@Name='map']/Topology/@Dimensions").attribute().value(),
               "2 3");
  EXPECT_STREQ(
      document.select_node("//Grid[@Name='line']/Topology/@TopologyType").attribute().value(),
      "Polyvertex");
  EXPECT_STREQ(
      document.select_node("//Grid[@Name='map']/Attribute[@Name='sigma_yy_error']/DataItem")
          .node()
          .text()
          .get(),
      "fields.h5:/map/error/sigma_yy");
}

std::size_t count_numbers(const pugi::xml_node& node) {
  std::istringstream in(node.text().get());
  std::size_t n = 0;
  for (double v; in >> v;) ++n;
  return n;
}

std::vector<double> numbers(const pugi::xml_document& d, const std::string& name) {
  std::istringstream in(
      d.select_node(fmt::format("//DataArray[@Name='{}']", name).c_str()).node().text().get());
  std::vector<double> out;
  for (double v; in >> v;) out.push_back(v);
  return out;
}

TEST_F(Output, VtuFilesAreWellFormedAndConsistent) {
  const dem::Snapshot before = test::layer(1, 5, 3), after = test::layer(1, 5, 3, false, 2);
  write_grains_vtu(at("grains.vtu"), after, &before);
  write_contacts_vtu(at("contacts.vtu"), after);
  std::vector<int> chain_of(after.contacts.size(), -1);
  std::vector<std::size_t> pressed;
  for (std::size_t k = 0; k < after.contacts.size(); ++k)
    if (after.contacts[k].normal_force > 0) pressed.push_back(k);
  chain_of[pressed.at(0)] = 0;
  chain_of[pressed.at(2)] = chain_of[pressed.at(3)] = 1;
  write_chains_vtu(at("chains.vtu"), after, chain_of);
  EXPECT_EQ(files(), 3u);
  for (const char* name : {"grains.vtu", "contacts.vtu", "chains.vtu"}) {
    pugi::xml_document d;
    ASSERT_TRUE(d.load_file(at(name).c_str())) << name;
    const pugi::xml_node piece = d.select_node("//Piece").node();
    const auto points = piece.attribute("NumberOfPoints").as_uint();
    const auto cells = piece.attribute("NumberOfCells").as_uint();
    EXPECT_GT(cells, 0u);
    EXPECT_EQ(count_numbers(d.select_node("//Points/DataArray").node()), 3 * points);
    EXPECT_EQ(count_numbers(d.select_node("//DataArray[@Name='connectivity']").node()), points);
    EXPECT_EQ(count_numbers(d.select_node("//DataArray[@Name='types']").node()), cells);
    for (const auto& array : d.select_nodes("//CellData/DataArray"))
      EXPECT_EQ(count_numbers(array.node()),
                cells * array.node().attribute("NumberOfComponents").as_uint())
          << name << array.node().attribute("Name").value();
  }
  pugi::xml_document d;
  d.load_file(at("grains.vtu").c_str());
  EXPECT_EQ(d.select_node("//Piece").node().attribute("NumberOfCells").as_uint(), 15u);
  d.load_file(at("contacts.vtu").c_str());
  EXPECT_EQ(d.select_node("//Piece").node().attribute("NumberOfCells").as_uint(),
            after.contacts.size());
  d.load_file(at("chains.vtu").c_str());
  EXPECT_EQ(numbers(d, "chain"), (std::vector<double>{0, 1, 1}));
  EXPECT_THROW(write_chains_vtu(at("chains.vtu"), after, {0}), std::invalid_argument);
}

TEST_F(Output, VtuHoldsTheTrueOutlines) {
  const dem::Snapshot heap = test::lattice_heap(4);
  // The second grain, turned: corners about its centroid by its angle.
  const dem::Grain& g = heap.grains[1];
  const auto corners = outline(g);
  ASSERT_EQ(corners.size(), 7U);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const double a = g.angle + 2 * M_PI * static_cast<double>(k) / 7;
    EXPECT_NEAR(corners[k].x(), g.position.x() + g.radius * std::cos(a), 1e-12);
    EXPECT_NEAR(corners[k].y(), g.position.y() + g.radius * std::sin(a), 1e-12);
  }
  write_grains_vtu(at("heap.vtu"), heap);
  pugi::xml_document d;
  ASSERT_TRUE(d.load_file(at("heap.vtu").c_str()));
  const auto piece = d.child("VTKFile").child("UnstructuredGrid").child("Piece");
  EXPECT_EQ(piece.attribute("NumberOfCells").as_int(), 10);
  EXPECT_EQ(piece.attribute("NumberOfPoints").as_int(), 70);
  // A disk keeps its sides.
  dem::Grain disk = g;
  disk.outline.clear();
  EXPECT_EQ(outline(disk, 12).size(), 12U);
}

TEST_F(Output, VtuStressOfGrainsAddsUpToTheForcesAtTheWalls) {
  // sum of V sigma over the grains = sum over walls of F x (virial of a packing at rest plus
  // weight).
  const dem::Snapshot s = test::layer(2, 6, 4);
  write_grains_vtu(at("g.vtu"), s);
  pugi::xml_document d;
  d.load_file(at("g.vtu").c_str());
  std::istringstream in(d.select_node("//DataArray[@Name='stress']").node().text().get());
  double yy = 0, expected = 0;
  for (const dem::Grain& g : s.grains) {
    double row[9];
    for (double& v : row) in >> v;
    yy += row[4] * g.volume;
    expected += g.mass * s.gravity.y() * g.position.y();
  }
  for (const dem::Contact& c : s.contacts)
    if (c.j < 0) expected += c.force.y() * c.point.y();
  EXPECT_NEAR(yy, expected, 1e-6 * std::abs(expected));
}

Comparison small() {
  Profile p;
  p.name = "depth 0.1 m";
  p.key = "depth_0.1";
  p.depth = 0.1;
  p.x = Eigen::Vector3d(-1, 0, 1);
  p.mean = Eigen::Vector3d(1, 4, 1);
  p.error = Eigen::Vector3d(0.5, 0.5, 0.5);
  return compare({p}, {{"flamant", "half plane, 50 %", "half plane", {Eigen::Vector3d(1, 3, 2)}}},
                 scale_of_load(2, 0.5));
}

// Ten models side by side are wider than any page: those that rank first, every row with all its
// cells.
TEST_F(Output, LatexTablesOfManyModelsFitAPage) {
  Profile p = small().profiles.front();
  std::vector<ModelProfiles> models;
  for (int m = 0; m < 10; ++m) {
    models.push_back({"m" + std::to_string(m),
                      "model " + std::to_string(m) + " (a_b)",
                      "f",
                      {Eigen::Vector3d(1, 3 + m, 2)}});
  }
  const std::string tex = profiles_latex(compare({p}, models, scale_of_load(2, 0.5)));
  std::istringstream lines(tex);
  int rows = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.find(" \\\\") == std::string::npos) continue;
    EXPECT_EQ(std::count(line.begin(), line.end(), '&'), 4) << line;
    ++rows;
  }
  EXPECT_EQ(rows, 4);  // the heads, three points
  for (int m = 0; m < 3; ++m) {
    EXPECT_THAT(tex, HasSubstr("model " + std::to_string(m) + " (a\\_b)"));
  }
  EXPECT_THAT(
      tex, HasSubstr("Of 10 fields the 3 that rank first; in profiles.csv also: model 3 (a_b);"));
  EXPECT_THAT(tex, ::testing::Not(HasSubstr("& model 3")));
}

// In the order of the ranking, not of the list; and the best of the family that loses.
TEST_F(Output, MarkdownShowsTheNearestModelsAndTheBestOfAnotherFamily) {
  const Profile p = small().profiles.front();
  std::vector<ModelProfiles> models;
  for (const int far : {9, 2, 0, 5, 1}) {
    models.push_back({fmt::format("m{}", far),
                      fmt::format("by {}", far),
                      far == 9 ? "other" : "f",
                      {Eigen::Vector3d(1, 4 + far, 1)}});
  }
  const std::string text = profiles_markdown(compare({p}, models, scale_of_load(2, 0.5)));
  EXPECT_THAT(text, ::testing::ContainsRegex("by 0 +\\| by 1 +\\| by 2 +\\| by 9 +\\|\n"));
  EXPECT_THAT(text,
              HasSubstr("Of 5 fields the 3 that rank first and the best of another family; in "
                        "profiles.csv also: by 5."));
}

// A closed form and finite elements of the same field: one column, both names.
TEST_F(Output, ModelsOfOneFieldShareAColumn) {
  const Profile p = small().profiles.front();
  const Comparison c = compare({p},
                               {{"layer", "closed", "layer", {Eigen::Vector3d(1, 3, 2)}},
                                {"fe", "by elements", "layer", {Eigen::Vector3d(1, 3.002, 2)}},
                                {"half", "half plane", "half", {Eigen::Vector3d(1, 2.9, 2)}}},
                               scale_of_load(2, 0.5));
  const std::vector<Table> tables = profile_tables(c);
  ASSERT_EQ(tables.size(), 1U);
  EXPECT_THAT(tables.front().header,
              ::testing::ElementsAre("x/h", "simulation", "by elements; closed", "half plane"));
}

TEST_F(Output, LabelsAreNoCommandsOfLatex) {
  const Profile p = small().profiles.front();
  const std::string tex = profiles_latex(compare(
      {p}, {{"m", "\\input{x}^2~", "f", {Eigen::Vector3d(1, 3, 2)}}}, scale_of_load(2, 0.5)));
  EXPECT_THAT(tex, HasSubstr("\\textbackslash{}input\\{x\\}\\^{}2\\~{}"));
}

TEST_F(Output, ProfilesHaveUnitsDifferencesAndNormalisation) {
  const std::string csv = profiles_csv(small());
  EXPECT_THAT(csv, testing::StartsWith("# F = 2 N, h = 0.5 m, F/h = 4 N/m"));
  EXPECT_THAT(csv, HasSubstr("profile,depth_m,x_m,simulation_N/m,standard_error_N/m,flamant_N/m,"
                             "flamant_difference_N/m,flamant_difference_over_error\n"));
  EXPECT_THAT(csv, HasSubstr("depth 0.1 m,0.1,0,4,0.5,3,1,2\n"));
  EXPECT_THAT(profiles_markdown(small()), HasSubstr("| 0.000  | 1.00 ± 0.12 | 0.75 (+2.0)      |"));
  EXPECT_THAT(profiles_latex(small()), HasSubstr("half plane, 50 \\%"));
  write_profiles(folder_.string(), small());
  EXPECT_EQ(files(), 3u);
}

TEST_F(Output, SummaryComesBack) {
  const Summary s{{"a.b", 1.0 / 3}, {"n", std::int64_t{7}}, {"who", std::string("flamant")},
                  {"x", NAN},       {"more", HUGE_VAL},     {"less", -HUGE_VAL}};
  write_summary(at("summary.json"), s);
  // JSON has no word for them: a text would be taken for a name.
  const auto json = nlohmann::json::parse(text(at("summary.json")));
  for (const char* key : {"x", "more", "less"}) EXPECT_TRUE(json[key].is_null()) << key;
  const Summary back = read_summary(at("summary.json"));
  EXPECT_EQ(std::get<double>(back.at("a.b")), 1.0 / 3);
  EXPECT_EQ(std::get<std::int64_t>(back.at("n")), 7);
  EXPECT_EQ(std::get<std::string>(back.at("who")), "flamant");
  EXPECT_TRUE(std::isnan(std::get<double>(back.at("x"))));
  EXPECT_TRUE(std::isnan(std::get<double>(back.at("less"))));
}

TEST_F(Output, SummariesOfVersion09ComeBack) {
  write_text_file(at("summary.json"), R"({"a": "nan", "b": "inf", "c": "-inf"})");
  const Summary back = read_summary(at("summary.json"));
  EXPECT_TRUE(std::isnan(std::get<double>(back.at("a"))));
  EXPECT_EQ(std::get<double>(back.at("b")), HUGE_VAL);
  EXPECT_EQ(std::get<double>(back.at("c")), -HUGE_VAL);
}

TEST_F(Output, SummaryReaderNamesWhatIsWrong) {
  const std::string file = at("summary.json");
  EXPECT_EQ(refusal_of([&] { read_summary(file); }), file + ": no such file or not readable");
  write_text_file(file, "{\"a\": ");
  EXPECT_EQ(refusal_of([&] { read_summary(file); }),
            file + ": not a JSON object (broken or truncated)");
  write_text_file(file, "{\"a\": [1]}");
  EXPECT_EQ(refusal_of([&] { read_summary(file); }),
            file + ": \"a\" is array; allowed are numbers and strings");
}

}  // namespace
}  // namespace grainfield::coupling
