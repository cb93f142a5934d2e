// Pairs through the real program: closed forms, every path, what is refused, the same bits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "coupling/result/tables.h"
#include "coupling/run/summary_keys.h"
#include "coupling/studies/pair/closed_forms.h"
#include "dem/laws/restitution.h"
#include "tests/coupling/check_scene.h"
#include "tests/coupling/run_scene.h"

namespace grainfield::coupling {
namespace {

using testing::complaint;
using testing::Folder;
using ::testing::HasSubstr;
using testing::number;
using testing::Output;
using testing::program;
using testing::run_of;

std::string pair_case(const std::string& pair, const std::string& material,
                      const std::string& more = "") {
  return "title = \"two bodies\"\nstudy = \"pair\"\n[pair]\n" + pair +
         "[material]\ndensity = 2500\n" + material +
         "[motion]\ntime_step_fraction = 0.004\n[ensemble]\nrealizations = 1\n" + more;
}

const std::string kLinear =
    "law = \"linear\"\nnormal_stiffness = 1e7\nnormal_damping = 2000\ntangential_damping = 0\n";

std::vector<std::vector<std::string>> rows_of(const std::string& file) {
  std::vector<std::vector<std::string>> out;
  std::istringstream lines(testing::read_text(file));
  for (std::string line; std::getline(lines, line);) {
    out.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) out.back().push_back(cell);
  }
  return out;
}

void expect_closed_forms(const Summary& s, const std::string& impact) {
  for (const char* name : {"restitution_normal", "duration", "max_depth"}) {
    if (s.count(impact + "closed_form." + name) == 0) continue;
    const double known = number(s, impact + "closed_form." + name);
    EXPECT_NEAR(number(s, impact + name), known, 1e-3 * known) << impact << name;
  }
}

TEST(PairRun, LinearImpactIsTheClosedForm) {
  const Folder folder;
  const Summary s = run_of(folder, pair_case("speeds = [0.01]\n", kLinear));
  EXPECT_NO_THROW(require_documented(s));
  // As in pair_slow_test.cc, written out.
  const double mass = 0.5 * 2500 * std::numbers::pi * 1e-4, beta = 1000;
  const double omega = std::sqrt(1e7 / mass - beta * beta);
  const double time =
      (std::numbers::pi - std::atan2(2 * beta * omega, omega * omega - beta * beta)) / omega;
  EXPECT_NEAR(number(s, "pair.closed_form.restitution_normal"), std::exp(-beta * time), 1e-12);
  EXPECT_NEAR(number(s, "pair.closed_form.duration"), time, 1e-12);
  expect_closed_forms(s, "pair.");
  expect_closed_forms(s, "pair.speed_0.01.");
  EXPECT_GT(number(s, "pair.stable_time_step"), number(s, "dem.time_step"));
  EXPECT_THAT(std::get<std::string>(s.at("verdict.sentence")), HasSubstr("e_n = 0."));

  const auto profile = rows_of(folder / "out/profiles.csv");
  EXPECT_EQ(profile.front().front(), "realization");
  EXPECT_EQ(profile.front()[4], "normal_force_N");
  ASSERT_GT(profile.size(), 200U);
  double most = 0;
  for (std::size_t k = 1; k < profile.size(); ++k) {
    ASSERT_EQ(profile[k].size(), profile.front().size());
    most = std::max(most, std::stod(profile[k][4]));
  }
  EXPECT_NEAR(most, number(s, "pair.max_force"), 1e-2 * most);
  const auto impacts = rows_of(folder / "out/impacts.csv");
  ASSERT_EQ(impacts.size(), 3U);
  EXPECT_EQ(impacts[2][0], "0.01");
  const std::string report = testing::read_text(folder / "out/report.html");
  for (const char* title : {"Force against depth", "Forces against time", "Energies against time",
                            "Normal restitution against speed", "closed form"}) {
    EXPECT_THAT(report, HasSubstr(title));
  }
  for (const char* name : {"snapshots.h5", "case.toml", "states/grains_state_00.vtu"}) {
    EXPECT_TRUE(testing::fs::exists(folder / ("out/" + std::string(name)))) << name;
  }
}

// Without dashpots and sliding the slip turns round with the tangential spring.
TEST(PairRun, TangentialRestitutionIsTheClosedForm) {
  for (const auto& [shape, ratio] : {std::pair{"disk", 3.0}, {"sphere", 3.5}}) {
    const Folder folder;
    const Summary s = run_of(
        folder, pair_case(std::string("speed = 0.001\nangle = 3\nshape = \"") + shape + "\"\n",
                          "law = \"linear\"\nnormal_stiffness = 1e7\nnormal_damping = 0\n"
                          "tangential_stiffness = 2e6\ntangential_damping = 0\nfriction = 10\n",
                          "[output]\nreport = false\nvtu = false\n"));
    const double known = -std::cos(std::numbers::pi * std::sqrt(ratio * 0.2));
    EXPECT_NEAR(number(s, "pair.restitution_tangential"), known, 1e-3) << shape;
    // Out of step it holds in the limit of small angles only.
    EXPECT_EQ(s.count("pair.closed_form.restitution_tangential"), 0U) << shape;
    // At little friction and a flat angle it slips throughout, and no spring counts.
    const Summary flat =
        run_of(folder,
               pair_case(std::string("speed = 0.001\nangle = 80\nshape = \"") + shape + "\"\n",
                         kLinear + "friction = 0.1\n"),
               "", "flat");
    const double slip = -1 + 0.1 * (1 + number(flat, "pair.restitution_normal")) * ratio /
                                 std::tan(80 * std::numbers::pi / 180);
    EXPECT_NEAR(number(flat, "pair.restitution_tangential"), slip, 1e-3) << shape;
    EXPECT_EQ(flat.count("pair.closed_form.restitution_tangential"), 0U);
    // Stiffer than the normal spring, it is at its limit from the first instant to the last.
    dem::PairSetup stiff;
    stiff.shape = shape;
    stiff.material.law = "linear";
    stiff.material.tangential_stiffness = 1.2 * stiff.material.normal_stiffness;
    stiff.material.normal_damping = stiff.material.tangential_damping = 0;
    stiff.material.friction = 0.1;
    EXPECT_NEAR(pair_closed_form(stiff, 0.001, 80).restitution_tangential,
                restitution_of_slip(stiff, 1, 80), 1e-12);
    EXPECT_TRUE(std::isnan(pair_closed_form(stiff, 0.001, 20).restitution_tangential));
    // In step: at every angle.
    dem::PairSetup& in_step = stiff;
    in_step.material.tangential_stiffness = in_step.material.normal_stiffness / ratio;
    EXPECT_EQ(pair_closed_form(in_step, 0.001, 3).restitution_tangential, 1);
    EXPECT_NEAR(pair_closed_form(in_step, 0.001, 80).restitution_tangential,
                restitution_of_slip(in_step, 1, 80), 1e-12);
  }
}

// The moment against rolling turns the body as well, which no closed form of e_t knows. (Two equal
// ones turn alike, and do not roll on each other.)
TEST(PairRun, RollingResistanceLeavesNoClosedFormOfSlip) {
  const Folder folder;
  const std::string pair = "speed = 0.001\nangle = 80\npartner = \"wall\"\n";
  const std::string material =
      "law = \"linear\"\nnormal_stiffness = 1e7\nnormal_damping = 0\n"
      "tangential_damping = 0\nfriction = 0.1\n";
  const std::string bare = "[output]\nreport = false\nvtu = false\n";
  const std::string e_t = "pair.restitution_tangential",
                    known = "pair.closed_form.restitution_tangential";
  const Summary free = run_of(folder, pair_case(pair, material, bare));
  EXPECT_NEAR(number(free, e_t), number(free, known), 1e-3);
  const Summary rolling = run_of(
      folder, pair_case(pair, material + "rolling_friction = 0.5\nrolling_stiffness = 1e6\n", bare),
      "", "rolling");
  EXPECT_GT(std::fabs(number(rolling, e_t) - number(free, known)), 0.01);
  EXPECT_EQ(rolling.count(known), 0U);
  EXPECT_EQ(number(rolling, "pair.closed_form.restitution_normal"), 1);

  dem::PairSetup setup;
  EXPECT_FALSE(std::isnan(restitution_of_slip(setup, 1, 80)));
  setup.material.rolling_friction = 0.5;
  EXPECT_TRUE(std::isnan(restitution_of_slip(setup, 1, 80)));
}

TEST(PairRun, HertzImpactIsTheClosedForm) {
  const Folder folder;
  const std::string sphere = "shape = \"sphere\"\nspeeds = [0.01]\n";
  const Summary elastic = run_of(
      folder, pair_case(sphere, "law = \"hertz\"\nyoung = 1e7\npoisson = 0.3\ndamping = 0\n"));
  const double young = 1e7 / (2 * 0.91), mass = 0.5 * 2500 * 4.0 / 3 * std::numbers::pi * 1e-6;
  const double depth = std::pow(15 * mass * 0.01 / (16 * young * std::sqrt(0.005)), 0.4);
  EXPECT_NEAR(number(elastic, "pair.closed_form.max_depth"), depth, 1e-9 * depth);
  EXPECT_NEAR(number(elastic, "pair.closed_form.duration"), 2.94328 * depth / 0.1,
              1e-5 * depth / 0.1);
  EXPECT_NEAR(number(elastic, "pair.max_force"), number(elastic, "pair.closed_form.max_force"),
              1e-3 * number(elastic, "pair.max_force"));
  EXPECT_NEAR(number(elastic, "pair.restitution_normal"), 1, 1e-3);
  expect_closed_forms(elastic, "pair.");
  expect_closed_forms(elastic, "pair.speed_0.01.");
  const Summary damped =
      run_of(folder, pair_case(sphere, "law = \"hertz\"\nyoung = 1e7\ndamping = 0.2\n"), "", "d");
  EXPECT_LT(number(damped, "pair.restitution_normal"), 0.8);
  expect_closed_forms(damped, "pair.");
  expect_closed_forms(damped, "pair.speed_0.01.");
}

// Disks, for small depths.
TEST(PairRun, EnergyLawHasOneRestitutionForAllSpeeds) {
  const Folder folder;
  const Summary s =
      run_of(folder,
             pair_case("speed = 1e-3\nspeeds = [1e-4]\n",
                       "law = \"energy\"\nenergy = \"square\"\ndamping = 0.75\nfriction = 0\n"),
             "--set motion.time_step_fraction=0.05");  // soft, so an impact takes long
  EXPECT_NEAR(number(s, "pair.closed_form.restitution_normal"), dem::restitution_of_dashpot(0.375),
              1e-12);
  expect_closed_forms(s, "pair.");
  expect_closed_forms(s, "pair.speed_0.0001.");
}

TEST(PairClosedForms, DashpotsWithoutPull) {
  EXPECT_EQ(dem::restitution_of_dashpot(0), 1);
  // Critical: x'' = 0 at s = 2 (Schwager and Poeschel 2007).
  EXPECT_NEAR(dem::restitution_of_dashpot(1), std::exp(-2.0), 1e-12);
  EXPECT_NEAR(dem::restitution_of_dashpot(1 - 1e-7), dem::restitution_of_dashpot(1 + 1e-7), 1e-6);
  EXPECT_LT(dem::restitution_of_dashpot(3), dem::restitution_of_dashpot(2));
}

// Every path runs, in the plane and in space, and its table says so.
TEST(PairRun, EveryPath) {
  for (const char* path : {"approach", "slide", "roll", "loop", "random", "waypoints"}) {
    for (const char* shape : {"disk", "regular", "sphere"}) {
      const Folder folder;
      std::string pair = std::string("kind = \"path\"\npath = \"") + path + "\"\nshape = \"" +
                         shape + "\"\nsteps = 200\n";
      if (path == std::string("random")) pair += "loops = 3\n";
      if (path == std::string("waypoints")) {
        pair += "waypoints = [0, 0, 0, 0.02, 0.01, 0.1, 0.02, -0.01, 0, 0, 0, 0]\n";
      }
      const Summary s =
          run_of(folder, pair_case(pair, kLinear + "friction = 0.3\n"),
                 "--set output.vtu=false --set output.snapshots=false --set output.report=false");
      EXPECT_GT(number(s, "pair.stored_most"), 0) << path << shape;
      EXPECT_GT(number(s, "pair.work"), 0) << path << shape;  // friction and dashpots take it
      EXPECT_GT(rows_of(folder / "out/profiles.csv").size(), 100U) << path << shape;
      if (path == std::string("random")) {
        EXPECT_EQ(rows_of(folder / "out/loops.csv").size(), 4U) << shape;
      }
    }
  }
}

TEST(PairRun, SweepOfLawsIsOnePicture) {
  const Folder folder;
  const std::string text =
      pair_case("speeds = [0.01]\n", kLinear,
                "[sweep]\nkey = \"variant\"\nvalues = [\"disks\", \"spheres\"]\n"
                "[variant.disks.material]\nlaw = \"energy\"\n"
                "[variant.spheres.pair]\nshape = \"sphere\"\n"
                "[variant.spheres.material]\nlaw = \"hertz\"\ndamping = 0.1\n");
  const Summary s = run_of(folder, text, "--threads 2");
  EXPECT_NEAR(number(s, "pair.restitution_normal.spheres"),
              number(s, "pair.closed_form.restitution_normal.spheres"), 1e-3);
  EXPECT_LT(number(s, "pair.restitution_normal.disks"), 0.9);
  const std::string report = testing::read_text(folder / "out/report.html");
  EXPECT_THAT(report, HasSubstr("Normal restitution against speed"));
  EXPECT_THAT(report, HasSubstr("Side by side"));
  EXPECT_TRUE(testing::fs::exists(folder / "out/spheres/profiles.csv"));
}

TEST(PairRun, SameBitsOnAnyThreadsAndAfterStops) {
  const Folder folder;
  const std::string text =
      pair_case("kind = \"path\"\npath = \"random\"\nshape = \"rand1\"\nloops = 3\nsteps = 50\n",
                "law = \"energy\"\n", "[output]\nreport = false\n");
  const std::string realizations = "--set ensemble.realizations=2 ";
  run_of(folder, text, realizations + "--threads 1", "one");
  const auto one = testing::contents(folder / "one");
  EXPECT_GT(one.size(), 5U);
  for (const char* threads : {"2", "3"}) {
    run_of(folder, text, realizations + "--threads " + threads, threads);
    EXPECT_EQ(testing::contents(folder / threads), one) << threads;
  }
  // Stopped again and again, each time from the last checkpoint.
  const std::string run =
      "run " + (folder / "x.toml") + " -o " + (folder / "k") + " " + realizations;
  int stops = 0, code = 0;
  for (long at = 3000; at < 200000; at += 3000, ++stops) {
    code =
        program(run + (stops > 0 ? "--resume" : "") + " --stop-after-steps " + std::to_string(at))
            .code;
    if (code != 130) break;
  }
  EXPECT_EQ(code, 0);
  EXPECT_GT(stops, 1);
  EXPECT_EQ(testing::contents(folder / "k"), one);

  const std::string impact = pair_case("angle = 20\nspeeds = [0.3]\n", kLinear);
  run_of(folder, impact, "--threads 1", "impact");
  const Output stopped = program("run " + (folder / "x.toml") + " -o " + (folder / "impact2") +
                                 " --stop-after-steps 700");
  EXPECT_EQ(stopped.code, 130) << stopped.err;
  run_of(folder, impact, "--threads 3 --resume", "impact2");
  EXPECT_EQ(testing::contents(folder / "impact2"), testing::contents(folder / "impact"));
}

TEST(PairCheck, RefusesWhatRunWould) {
  const auto refusal = [](const std::string& pair, const std::string& more = "") {
    return complaint("study = \"pair\"\n[pair]\n" + pair + more);
  };
  EXPECT_EQ(refusal(""), "");
  EXPECT_THAT(refusal("shape = \"sphere\"\n"),
              HasSubstr("material.law: found \"overlap_area\", allowed: linear | hertz"));
  EXPECT_THAT(refusal("", "[material]\nlaw = \"hertz\"\n"),
              HasSubstr("material.law: found \"hertz\""));
  EXPECT_THAT(
      refusal("speed = 0\n"),
      HasSubstr("x.toml:3: pair.speed: found 0 with pair.kind \"collision\", allowed: above 0"));
  EXPECT_THAT(refusal("offset = 3\n"), HasSubstr("pair.offset: found"));
  EXPECT_THAT(refusal("spin_first = [1, 2, 3]\n"),
              HasSubstr("pair.spin_first: found 3 numbers, allowed: 1"));
  EXPECT_THAT(refusal("partner = \"wall\"\nspin_second = [1]\n"),
              HasSubstr("pair.spin_second: found a spin, allowed: none for a wall"));
  EXPECT_THAT(refusal("kind = \"path\"\npath = \"waypoints\"\nwaypoints = [0, 0]\n"),
              HasSubstr("pair.waypoints: found 2 numbers"));
  EXPECT_THAT(refusal("shape = \"outline\"\n"), HasSubstr("pair.outline: found no corner"));
  EXPECT_THAT(refusal("kind = \"path\"\n", "[motion]\nlocal_damping = 0.3\n"),
              HasSubstr("motion.local_damping: found 0.3"));
  EXPECT_THAT(refusal("shape = \"regular\"\n",
                      "[material]\nrolling_friction = 0.1\nrolling_stiffness = 1e6\n"),
              HasSubstr("material.rolling_friction: found above 0, allowed for polygons: 0"));
  EXPECT_THAT(refusal("", "[motion]\ntime_step = 1.0\n"),
              HasSubstr("motion.time_step: found 1 s, allowed: at most"));
  EXPECT_THAT(refusal("", "[material]\ngravity = 1.0\n"), HasSubstr("has no meaning"));
  EXPECT_THAT(refusal("", "[compare]\nmodels = [\"flamant\"]\n"), HasSubstr("has no meaning"));
  EXPECT_THAT(refusal("kind = \"path\"\npath = \"random\"\nradius = 1e-6\nradius_second = 1e3\n"),
              HasSubstr("pair.radius_second: found 1000 m beside"));
  EXPECT_EQ(refusal("kind = \"path\"\npath = \"random\"\nradius_second = 0.1\n"), "");
  EXPECT_EQ(refusal("kind = \"path\"\n", "[motion]\ntime_step = 1.0\n"), "");
  EXPECT_THAT(refusal("speeds = [0.1, 1e4]\n"),
              HasSubstr("x.toml:3: pair.speeds: found 10000, allowed: at most "));
  EXPECT_THAT(refusal("offset = 1.9\nangles = [-80, 80]\n"),
              HasSubstr("x.toml:4: pair.angles: found 80: the bodies move apart"));
  EXPECT_THAT(refusal("spedes = [1]\n"), HasSubstr("did you mean pair.speed"));

  const Folder folder;
  const Output output =
      program("check " + folder.write("x.toml", "study = \"pair\"\n[pair]\nspeed = 0\n"));
  EXPECT_EQ(output.code, 2);
  const Output fast =
      program("check " + folder.write("f.toml", "study = \"pair\"\n[pair]\nspeed = 1e4\n"));
  EXPECT_EQ(fast.code, 2);
  EXPECT_THAT(fast.err, HasSubstr("f.toml:3: pair.speed: found 10000, allowed: at most"));
  EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
}

}  // namespace
}  // namespace grainfield::coupling
