// The report: pictures drawn or their absence explained, nothing executed that data say.
#include "coupling/report/report.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "coupling/averaging/average.h"
#include "coupling/report/drawing.h"
#include "coupling/studies/pile/page.h"
#include "coupling/studies/point_load/page.h"
#include "tests/coupling/averaging_scene.h"
#include "tests/coupling/heap_scene.h"

namespace grainfield::coupling {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class ReportTest : public testing::Test {
 protected:
  ReportTest() {
    std::string name = (fs::temp_directory_path() / "grainfield-test-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    if (const char* path = std::getenv("PATH")) path_ = path;
  }
  ~ReportTest() override {
    setenv("PATH", path_.c_str(), 1);
    fs::remove_all(folder_);
  }
  std::string file() const { return (folder_ / "report.html").string(); }
  std::string page() const {
    std::ifstream in(file());
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  }
  void need_gnuplot() {
    if (!find_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  }
  fs::path folder_;
  std::string path_;
};

PointLoadReport input(const dem::Snapshot& before, const dem::Snapshot& after) {
  Profile p;
  p.name = "depth 0.03 m";
  p.key = "depth_0.03";
  p.depth = 0.03;
  p.x = Eigen::VectorXd::LinSpaced(9, -0.05, 0.05);
  p.mean = (-(p.x / 0.02).array().square()).exp();
  p.error = Eigen::VectorXd::Constant(9, 0.1);
  Profile base = p;
  base.name = base.key = "base";
  base.depth = 0.06;
  PointLoadReport in;
  in.title = "A <case> & its `report`";
  in.unloaded = &before;
  in.loaded = &after;
  const Eigen::VectorXd model = 0.9 * p.mean;
  in.comparison = compare({p, base}, {{"flamant", "half plane", "half plane", {model, model}}},
                          scale_of_load(2, 0.06));
  AverageOptions o;
  o.width = 0.02;
  in.map = response(before, after, grid_points(0.01, 0.11, 11, 0, 0.05, 6), o);
  in.map.nx = 11;
  in.map.ny = 6;
  in.models = {{"half plane", Eigen::VectorXd::Constant(66, -1)}};
  in.figures = {{"response.peaks", "1"}};
  in.made = {{"seed", "7"}};
  return in;
}

TEST_F(ReportTest, HasEveryPictureAndTable) {
  need_gnuplot();
  const dem::Snapshot before = test::layer(1), after = test::layer(1, 12, 6, false, 2);
  const ReportResult r = write_report(file(), point_load_report(input(before, after)));
  EXPECT_EQ(r.why_missing, "");
  EXPECT_EQ(r.pictures, 6);  // two packings, depths, base, maps, angles
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("A &lt;case&gt; &amp; its `report`"));
  EXPECT_THAT(html, HasSubstr("data:image/png;base64,"));
  EXPECT_THAT(html, HasSubstr("data:image/svg+xml;base64,"));
  EXPECT_THAT(html, HasSubstr("class=\"verdict\""));
  EXPECT_THAT(html, HasSubstr("<td>seed</td><td>7</td>"));
  EXPECT_THAT(html, Not(HasSubstr("src=\"http")));
}

// The map of what is left is of the model that the verdict names, not of the first on the list.
TEST_F(ReportTest, TheResidualMapIsOfTheNearestModel) {
  const dem::Snapshot before = test::layer(1), after = test::layer(1, 12, 6, false, 2);
  PointLoadReport in = input(before, after);
  const auto values = [&](double share) {
    std::vector<Eigen::VectorXd> out;
    for (const Profile& p : in.comparison.profiles) out.push_back(share * p.mean);
    return out;
  };
  in.comparison = compare(in.comparison.profiles,
                          {{"far", "far=flamant", "half plane", values(0.3)},
                           {"near", "near=layer", "finite layer", values(0.99)}},
                          scale_of_load(2, 0.06));
  in.models = {{"far=flamant", Eigen::VectorXd::Constant(66, -1)},
               {"near=layer", Eigen::VectorXd::Constant(66, -2)}};
  ASSERT_EQ(in.comparison.judgement.best, "near");
  const Report report = point_load_report(in);
  int maps = 0;
  for (const Section& section : report.sections) {
    const auto* picture = std::get_if<Picture>(&section);
    if (picture == nullptr || picture->title != "Maps of the response") continue;
    ++maps;
    EXPECT_THAT(picture->program, HasSubstr("grains - near=layer"));
    EXPECT_THAT(picture->program, Not(HasSubstr("flamant")));
  }
  EXPECT_EQ(maps, 1);
}

TEST_F(ReportTest, PilesAreDrawnWithOutlinesAgeForcesAndDisplacements) {
  need_gnuplot();
  const dem::Snapshot heap = test::lattice_heap(12);
  dem::Snapshot moved = heap;
  for (dem::Grain& g : moved.grains) g.position.y() *= 0.999;
  PileReport in;
  in.title = "heap";
  in.comparison.judgement.findings = {"A pressure dip"};
  in.pile = &heap;
  in.changed = {{"g = 5 m/s2", &moved}};
  Profile p;
  p.name = p.key = "base";
  p.depth = 0.05;
  p.x = Eigen::VectorXd::LinSpaced(9, -0.05, 0.05);
  p.mean = Eigen::VectorXd::Constant(9, 100);
  p.error = Eigen::VectorXd::Constant(9, 5);
  Profile cut = p;
  cut.name = cut.key = "height_0.5";
  in.comparison = without_models({p, cut}, scale_of_heaps(0.05, 200, ""), 3);
  in.averaged = "coarse graining, lucy kernel, w = 0.0055 m";
  AverageOptions o;
  o.width = 0.01;
  in.map = average(heap, grid_points(-0.03, 0.03, 11, 0, 0.05, 6), o);
  in.map.nx = 11;
  in.map.ny = 6;
  const ReportResult r = write_report(file(), pile_report(in));
  EXPECT_EQ(r.why_missing, "");
  // Age, forces, base, cuts, volume fraction, stress, displacements, angles of both states.
  EXPECT_EQ(r.pictures, 9);
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("coarse graining, lucy kernel, w = 0.0055 m"));
  EXPECT_THAT(html, HasSubstr("rho g h = 200 N/m"));
  EXPECT_THAT(html, HasSubstr("Displacements from the pile to g = 5 m/s2"));
  // Eight points of a closed heptagon and its colour: first dropped dark, last bright.
  const std::string age = grains_by_age("t", heap).program;
  EXPECT_THAT(age, HasSubstr("0x440154"));
  EXPECT_THAT(age, HasSubstr("0xfde725"));
  EXPECT_THAT(age, HasSubstr("filledcurves closed"));
  EXPECT_THAT(age, HasSubstr("set colorbox horizontal"));
  EXPECT_THAT(age, HasSubstr("grains dropped before"));
  // A magnification of the largest displacement to three diameters.
  EXPECT_THAT(displacements("t", heap, moved).caption, HasSubstr("times as long"));
  EXPECT_THROW(displacements("t", heap, test::lattice_heap(5)), std::invalid_argument);
  // Grains that rolled off do not shrink the heap in the picture.
  dem::Snapshot strayed = heap;
  strayed.grains[5].position.x() -= 0.5;
  strayed.grains[3].position.x() += 1;
  EXPECT_EQ(packing("t", strayed).height, packing("t", heap).height);
  EXPECT_THAT(packing("t", strayed).caption,
              HasSubstr("2 grains that rolled off lie outside the picture."));
  EXPECT_EQ(packing("t", heap).caption.find("rolled"), std::string::npos);
}

// A rough floor that reaches far beyond the heap, and a funnel's plates above it, do not shrink it.
TEST_F(ReportTest, FixedGrainsBesideAndAboveTheHeapAreLeftOut) {
  const dem::Snapshot heap = test::lattice_heap(12);
  const Picture plain = packing("t", heap);
  dem::Snapshot with = heap;
  double left = 1e9, right = -1e9, top = -1e9;
  for (const dem::Grain& g : heap.grains) {
    left = std::min(left, g.position.x() - g.radius);
    right = std::max(right, g.position.x() + g.radius);
    top = std::max(top, g.position.y() + g.radius);
  }
  for (const double x : {left - 1, left - 0.02, right + 0.02, right + 1}) {
    dem::Grain fixed = heap.grains[0];
    fixed.id = static_cast<std::int64_t>(with.grains.size());
    fixed.fixed = true;
    fixed.position.x() = x;
    with.grains.push_back(fixed);
  }
  with.grains.back().position = {0, 10 * top, 0};
  const Picture cropped = packing("t", with);
  EXPECT_EQ(cropped.height, plain.height);
  EXPECT_EQ(cropped.caption.find("rolled"), std::string::npos);
  // The same frame, to the letter.
  const auto frame = [](const Picture& picture) {
    const auto at = picture.program.find("set xrange");
    return picture.program.substr(at, picture.program.find("set border") - at);
  };
  EXPECT_EQ(frame(cropped), frame(plain));
}

TEST_F(ReportTest, WithoutGnuplotKeepsItsTablesAndSaysWhatToInstall) {
  setenv("PATH", folder_.c_str(), 1);
  const dem::Snapshot before = test::layer(1), after = test::layer(1, 12, 6, false, 2);
  const ReportResult r = write_report(file(), point_load_report(input(before, after)));
  EXPECT_EQ(r.pictures, 0);
  EXPECT_EQ(r.why_missing, "gnuplot not found: install gnuplot-nox");
  EXPECT_GT(r.missing, 1);
  EXPECT_EQ(r.complaint(), fmt::format("report.html: {0} of {0} pictures are missing: gnuplot not "
                                       "found: install gnuplot-nox",
                                       r.missing));
  EXPECT_THAT(page(), HasSubstr("No picture: gnuplot not found: install gnuplot-nox."));
  EXPECT_THAT(page(), HasSubstr("Distance of the models from the grains"));
}

TEST_F(ReportTest, TextInDataCannotRunCommands) {
  need_gnuplot();
  const std::string trap = (folder_ / "trap").string();
  const std::string evil =
      "a' \"; system('touch " + trap + "') `touch " + trap + "` \\\" $x\n!touch " + trap;
  Series s{evil, Eigen::Vector3d(0, 1, 2), Eigen::Vector3d(0, 1, 0), {}, true};
  Report report{"t", "", {curves(evil, evil, evil, {{evil, {s}}})}};
  const ReportResult r = write_report(file(), report);
  EXPECT_EQ(r.why_missing, "");
  EXPECT_FALSE(fs::exists(trap));
}

// Frames of different curves name their own; one that is empty in a frame keeps its colour.
TEST_F(ReportTest, FramesMayHaveLegendsOfTheirOwn) {
  need_gnuplot();
  const auto series = [](const char* label) {
    return Series{label, Eigen::Vector3d(0, 1, 2), Eigen::Vector3d(0, 1, 0), {}};
  };
  const Series none{"none", {}, {}, {}};
  const auto drawn = [&](bool own) {
    const Picture picture = curves(
        "c", "x", "y", {{"f", {none, series("first")}, own}, {"g", {none, series("second")}, own}});
    return draw(*find_gnuplot(), "svg", picture.program);
  };
  const auto own = drawn(true), common = drawn(false);
  ASSERT_EQ(own.error + common.error, "");
  // Curves have their titles in the file, too; what is written has an end of its own.
  EXPECT_THAT(own.bytes, HasSubstr(">second</text>"));
  EXPECT_THAT(own.bytes, HasSubstr(">first</text>"));
  EXPECT_THAT(common.bytes, HasSubstr(">first</text>"));
  EXPECT_THAT(common.bytes, Not(HasSubstr(">second</text>")));
}

TEST_F(ReportTest, NanAndFlatDataStillDraw) {
  need_gnuplot();
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(4, 0, 3);
  Series gaps{"gaps", x, Eigen::Vector4d(1, NAN, 1, 1), Eigen::Vector4d(NAN, NAN, NAN, NAN), true};
  Map map{"m", 2, 2, grid_points(0, 1, 2, 0, 1, 2), Eigen::Vector4d(NAN, NAN, NAN, 0)};
  Report report{"t", "", {curves("c", "x", "y", {{"f", {gaps}}}), maps("m", "x", "y", "v", {map})}};
  EXPECT_EQ(write_report(file(), report).why_missing, "");
}

// Points stand in the middle of their cells: the frame goes round the cells.
TEST_F(ReportTest, CellsOfMapsEndAtTheFrame) {
  const Map map{"m", 3, 2, grid_points(0, 1, 3, 0, 1, 2), Eigen::VectorXd::Constant(6, 1.0)};
  EXPECT_THAT(maps("m", "x", "y", "v", {map}).program,
              HasSubstr("set xrange [-0.25:1.25]\nset yrange [-0.5:1.5]\n"));
}

// However many maps stand above each other, the scale is as high as one of them.
TEST_F(ReportTest, TheColourBoxIsAsHighAsAMap) {
  Map map;
  map.nx = map.ny = 2;
  map.points.resize(4, 2);
  map.points << 0, 0, 2, 0, 0, 1, 2, 1;
  map.value = Eigen::VectorXd::Ones(4);
  for (const std::size_t count : {1, 3}) {
    const Picture p = maps("maps", "x", "y", "v", std::vector<Map>(count, map));
    const auto number = [&](const std::string& before, std::size_t from = 0) {
      const std::size_t at = p.program.find(before, from);
      EXPECT_NE(at, std::string::npos) << before;
      return std::stod(p.program.substr(at + before.size()));
    };
    const double top = number("set tmargin at screen "), bottom = number("set bmargin at screen ");
    const std::size_t box = p.program.find("set colorbox user origin screen ");
    EXPECT_NEAR(number("size screen 0.018, screen ", box), top - bottom, 2e-4) << count;
    EXPECT_NEAR(number(", screen ", box), bottom, 2e-4) << count;
  }
}

// Maps beside each other have room for a short title and for the numbers of their axes.
TEST_F(ReportTest, TitlesOfNarrowMapsAreBroken) {
  Map map{"", 2, 2, grid_points(0, 1, 2, 0, 1, 2), Eigen::VectorXd::Ones(4)};
  std::vector<Map> all;
  for (const char* title : {"grains", "predicted_smooth=transverse_layer", "grains - layer"}) {
    map.title = title;
    all.push_back(map);
  }
  const std::string program = maps("m", "x", "height", "v", all).program;
  EXPECT_THAT(program, HasSubstr("set title \"predicted_smooth=\\ntransverse_layer\" "));
  EXPECT_THAT(program, HasSubstr("set title \"grains - layer\" "));
  EXPECT_EQ(program.find("set ylabel \"height\""), program.rfind("set ylabel \"height\""));
  // One map has the whole width.
  EXPECT_THAT(maps("m", "x", "height", "v", {all[1]}).program,
              HasSubstr("set title \"predicted_smooth=transverse_layer\" "));
}

TEST_F(ReportTest, BrokenAndEndlessProgramsAreReported) {
  need_gnuplot();
  const std::string gnuplot = *find_gnuplot();
  EXPECT_THAT(draw(gnuplot, "svg", "plot nonsense(x)").error, HasSubstr("undefined function"));
  EXPECT_EQ(draw(gnuplot, "svg", "while (1) { a = 1 }", 0.3).error,
            "gnuplot took longer than 0.3 s");
}

TEST_F(ReportTest, PicturesNeedNoTemporaryFolder) {
  need_gnuplot();
  const char* before = getenv("TMPDIR");
  const std::string kept = before != nullptr ? before : "";
  for (const char* folder : {"/no/such/folder", "/tmp/it's", "/tmp/'`touch x`'"}) {
    setenv("TMPDIR", folder, 1);
    EXPECT_FALSE(draw(*find_gnuplot(), "svg", "plot x").bytes.empty()) << folder;
  }
  before != nullptr ? setenv("TMPDIR", kept.c_str(), 1) : unsetenv("TMPDIR");
}

// Neither a disk nor a limit on files matters for a picture that is passed on in memory.
TEST_F(ReportTest, PicturesNeedNoRoomForFiles) {
  need_gnuplot();
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit none{0, 0};
    setrlimit(RLIMIT_FSIZE, &none);
    std::string data = "$d << EOD\n";
    for (int k = 0; k < 30000; ++k) data += fmt::format("{} {}\n", k, k * k % 1009);
    const Drawing drawing = draw(*find_gnuplot(), "svg", data + "EOD\nplot $d with lines");
    _exit(drawing.bytes.size() > 100'000 ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

// A gnuplot of our own that counts its starts and ends as it is told.
TEST_F(ReportTest, OnlyWhatASignalStoppedIsDrawnAgain) {
  const std::string count = (folder_ / "count").string(), fake = (folder_ / "gnuplot").string();
  const auto starts = [&](const std::string& ending) {
    fs::remove(count);
    std::ofstream(fake) << "#!/bin/sh\ncat > " + count + ".in\necho x >> " + count + "\n" + ending;
    fs::permissions(fake, fs::perms::owner_all);
    const Drawing drawing = draw(fake, "svg", "plot x");
    std::ifstream lines(count);
    int n = 0;
    for (std::string line; std::getline(lines, line);) ++n;
    return fmt::format("{} {}{}", n, drawing.bytes, drawing.error);
  };
  EXPECT_EQ(starts("kill -SEGV $$"), "1 SIGSEGV ended gnuplot");
  EXPECT_EQ(starts("kill -KILL $$"), "1 SIGKILL ended gnuplot");
  EXPECT_EQ(starts("exit 3"), "1 gnuplot ended with status 3");
  EXPECT_EQ(starts("printf picture"), "1 picture");
  EXPECT_EQ(starts("test $(wc -l < " + count + ") -gt 2 || kill -TERM $$\nprintf late"), "3 late");
  EXPECT_EQ(starts("kill -INT $$"), "5 SIGINT ended gnuplot");
}

TEST_F(ReportTest, AReaderThatHasGoneIsNoSignalToUs) {
  const std::string fake = (folder_ / "gnuplot").string();
  std::ofstream(fake) << "#!/bin/sh\nexec <&-\nsleep 0.2\nprintf picture\n";
  fs::permissions(fake, fs::perms::owner_all);
  const std::string longer_than_a_pipe(200'000, '#');
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGPIPE, SIG_DFL);  // which ends a process
    _exit(draw(fake, "svg", longer_than_a_pipe).bytes == "picture" ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST_F(ReportTest, ASignalToTheGroupDoesNotReachThePicture) {
  need_gnuplot();
  // The child leads a group, survives the signal itself and draws while the group is sent it.
  const pid_t child = fork();
  if (child == 0) {
    if (setpgid(0, 0) != 0) _exit(2);
    signal(SIGTERM, [](int) {});  // what is ignored would be ignored by gnuplot as well
    std::thread shooter([] {
      for (int k = 0; k < 20; ++k) {
        kill(0, SIGTERM);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    });
    const bool drawn =
        !draw(*find_gnuplot(), "svg", "do for [k=1:200000] { a = sin(k) }\nplot x").bytes.empty();
    shooter.join();
    _exit(drawn ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST_F(ReportTest, ContactAnglesAreRelativeToIsotropic) {
  // All contacts upright: the two bins at 90 and 270 degrees hold everything.
  dem::Snapshot s;
  for (int k = 0; k < 4; ++k) s.grains.push_back(test::disk(k, 0, k, 0.5));
  for (int k = 0; k < 3; ++k) {
    dem::Contact c;
    c.i = k;
    c.j = k + 1;
    c.normal = {0, 1, 0};
    c.normal_force = 1;
    s.contacts.push_back(c);
  }
  // 36 bins, two of them full: 18 times the isotropic density.
  EXPECT_THAT(contact_angles("t", s).program, HasSubstr("\n1.1022e-15 18\n"));
}

}  // namespace
}  // namespace grainfield::coupling
