// Every number of a case at both ends of its range and beyond, and what no machine could do: said
// within seconds, before anything is allocated.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <set>

#include "coupling/case/keys.h"
#include "coupling/case/study.h"
#include "tests/coupling/check_scene.h"

namespace grainfield::coupling {
namespace {

using testing::complaint;
using testing::complaint_of;
using testing::Folder;
using ::testing::HasSubstr;

// What reading says, and that it takes no longer than promised.
std::string soon(const std::string& file, const Overrides& set) {
  const auto start = std::chrono::steady_clock::now();
  const std::string what = complaint_of(file, set);
  const auto seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_LT(seconds, 10) << set.front() << ": " << what;
  return what;
}

bool is_number(const Key& key) { return type_name(key).find("number") != std::string::npos; }
bool is_integer(const Key& key) { return type_name(key) == "integer"; }

std::string written(const Key& key, double value) {
  std::string text = fmt::format("{}", value);
  if (is_integer(key)) text = fmt::format("{:.0f}", value);
  return key.path() + "=" + (type_name(key).starts_with("list") ? "[" + text + "]" : text);
}

TEST(CheckLimits, EveryNumberHasThem) {
  for (const Key& key : keys()) {
    if (!is_number(key) && !is_integer(key)) continue;
    EXPECT_TRUE(std::isfinite(key.least) && std::isfinite(key.most)) << key.path();
    EXPECT_LT(key.least, key.most) << key.path();
  }
}

TEST(CheckLimits, BeyondThemIsRefusedAndAtThemAnsweredSoon) {
  std::set<std::string> seen;
  for (const Study& study : studies()) {
    const Folder folder;
    const std::string file = folder.write("x.toml", testing::small_case(study.name));
    for (const Key& key : keys()) {
      if (!key_applies(key, study.name) || !(is_number(key) || is_integer(key))) continue;
      // The grains of a section that studies share are a pile's or a layer's.
      const bool poured = section_applies("source", study.name);
      if (!seen.insert(key.path() + (poured ? " of a pile" : "")).second) continue;
      const double over = is_integer(key) ? key.most + 1 : key.most + std::fabs(key.most) + 1;
      const double under = is_integer(key) ? key.least - 1 : key.least - std::fabs(key.least) - 1;
      for (const double value : {under, over}) {
        // 2^53 + 1 is no number of its own.
        if (value == key.most) continue;
        EXPECT_THAT(soon(file, {written(key, value)}),
                    HasSubstr("--set: " + key.path() + ": found "))
            << study.name << " " << value;
      }
      // At the ends other keys may not fit: then a key is named.
      for (const double value : {key.least, key.most}) {
        const std::string what = soon(file, {written(key, value)});
        EXPECT_TRUE(what.empty() || what.find(": ") != std::string::npos) << what;
        EXPECT_EQ(what.find("nan"), std::string::npos) << key.path() << ": " << what;
      }
      if (key.or_zero) {
        EXPECT_EQ(soon(file, {written(key, 0)}).find("--set: " + key.path() + ": found 0, allowed"),
                  std::string::npos);
      }
    }
  }
}

TEST(CheckLimits, FiguresThatNoDoubleHolds) {
  for (const char* figure : {"1e400", "-1e400", "inf", "nan", "1e-400", "1e-320", "-1e-320"}) {
    const std::string text = std::string("[packing]\nradius = ") + figure + "\n";
    EXPECT_THAT(complaint(text), HasSubstr("x.toml:2: ")) << figure;
    EXPECT_THAT(complaint("", {std::string("packing.radius=") + figure}),
                HasSubstr("--set: packing.radius: found "))
        << figure;
    EXPECT_THAT(complaint(std::string("[model.layer]\nnu = ") + figure + "\n"),
                HasSubstr(figure[0] == '1' && figure[2] == '-' ? "" : "x.toml:2: "))
        << figure;
  }
}

std::string pile(const std::string& more) { return "study = \"pile\"\n" + more; }

TEST(CheckCost, TooManyGrainsAreRefused) {
  EXPECT_THAT(complaint("[packing]\nwidth = 1e5\n"),
              HasSubstr("x.toml:2: packing.width: found 100000 m, allowed: up to "));
  EXPECT_THAT(complaint("[packing]\nwidth = 1e308\n"),
              HasSubstr("x.toml:2: packing.width: found 1e+308, allowed: 1e-06 to 1e+06"));
  EXPECT_THAT(complaint("[packing]\ndepth = 1e5\n"),
              HasSubstr("packing.depth: found 100000 m, allowed: up to "));
  EXPECT_THAT(complaint("[packing]\nshape = \"irregular\"\nside = 1e-6\n"),
              HasSubstr("packing.width: found 0.6 m, allowed: up to "));
  EXPECT_THAT(complaint("[packing]\nkind = \"triangular\"\nsizes = \"mono\"\ncolumns = 100000\n"
                        "rows = 1000\n"),
              HasSubstr("x.toml:4: packing.columns: found 100000, allowed: up to 10000 with "
                        "packing.rows = 1000: 10 million grains"));
  EXPECT_THAT(complaint(pile("[source]\ngrains = 10000000000\n")),
              HasSubstr("source.grains: found 1e+10, allowed: 3 to 10000000"));
  EXPECT_THAT(complaint(pile("[floor]\nkind = \"rough\"\nlength = 1e6\n")),
              HasSubstr("x.toml:4: floor.length: found 1e+06 m, allowed: up to "));
  EXPECT_THAT(
      complaint(pile("[floor]\nlength = 1e6\n")),
      HasSubstr("x.toml:3: floor.length: found 1e+06 m, allowed: up to 550 m with grains of "
                "this size: 100000 of them side by side"));
  EXPECT_EQ(complaint(pile("[floor]\nlength = 550\n")), "");
  EXPECT_EQ(complaint("[packing]\nkind = \"triangular\"\nsizes = \"mono\"\ncolumns = 10000\n"
                      "rows = 1000\n"),
            "");
}

// The limit that a refusal names is accepted.
TEST(CheckCost, LimitsNamedAreAccepted) {
  const std::string what = complaint("[packing]\nwidth = 1e5\n");
  const std::string mark = "allowed: up to ";
  const std::string most = what.substr(what.find(mark) + mark.size());
  EXPECT_EQ(complaint("[packing]\nwidth = " + most.substr(0, most.find(' ')) + "\n"), "") << what;
}

TEST(CheckCost, StepsWithoutEndAreRefused) {
  EXPECT_THAT(
      complaint(pile("[source]\ninterval = 1e5\n")),
      ::testing::AllOf(HasSubstr("x.toml:3: source.interval: found 100000.0: 6.5e+08 s take "),
                       HasSubstr(" (motion.time_step), "),
                       HasSubstr("allowed: up to 1e+12 "
                                 "steps")));
  EXPECT_THAT(complaint("[load]\nramp_time = 1e6\n[motion]\ntime_step = 1e-7\n"),
              HasSubstr("x.toml:2: load.ramp_time: found 1000000.0: "));
  EXPECT_THAT(complaint(pile("[change]\ngravity = [5]\nmethod = \"damped\"\nramp_time = 1e6\n"
                             "[motion]\ntime_step = 1e-7\n")),
              HasSubstr("x.toml:5: change.ramp_time: found 1000000.0: "));
  EXPECT_THAT(complaint("[load]\nramp_time = 1e300\n"),
              HasSubstr("load.ramp_time: found 1e+300, allowed: 1e-06 to 1e+06"));
  EXPECT_THAT(complaint("[rest]\nmax_time = 1e300\n"), HasSubstr("rest.max_time: found 1e+300"));
  EXPECT_THAT(complaint("[rest]\nbackground_damping = 1e8\n"),
              HasSubstr("x.toml:2: rest.background_damping: found 1e+08, allowed: at most "));
}

TEST(CheckCost, ValuesWithoutEndAreRefused) {
  EXPECT_THAT(
      complaint("[average]\nmap_columns = 2000\nmap_rows = 2000\n"),
      HasSubstr("average.map_rows: found 2000, with average.map_columns = 2000 and "
                "ensemble.realizations = 4: 3.2e+07 averaged values, allowed: up to 1e+07"));
  EXPECT_THAT(
      complaint("[average]\npoints = 10000\n[ensemble]\nrealizations = 1000\n"),
      HasSubstr("x.toml:4: ensemble.realizations: found 1000, with average.points = 10000: "));
  EXPECT_THAT(complaint("study = \"pile-fields\"\n[fields]\ncolumns = 2000\nrows = 1000\n"
                        "[ensemble]\nrealizations = 100\n"),
              HasSubstr("x.toml:4: fields.rows: found 1000, with fields.columns = 2000 and "
                        "ensemble.realizations = 100: "));
  EXPECT_THAT(complaint("[ensemble]\nrealizations = 100000\n"),
              HasSubstr("ensemble.realizations: found 100000, allowed: 1 to 10000"));
}

TEST(CheckCost, MeshesWithoutEndAreRefused) {
  EXPECT_THAT(
      complaint("[compare]\nmodels = [\"fe_elastic_layer\"]\n[model.fe_elastic_layer]\n"
                "cells = 1000\nhalf_width = 1000\n"),
      HasSubstr("model fe_elastic_layer: cells = 1000, half_width = 1000, degree = 0 ask for "
                "3.6e+10 unknowns; allowed: up to 2e+06; lower cells, half_width, degree"));
}

TEST(CheckCost, MeshesOfHyperbolicModelsToo) {
  EXPECT_THAT(complaint("study = \"osl-wedge\"\n[compare]\nmodels = [\"osl\", \"fe_osl_wedge\"]\n"
                        "[model.fe_osl_wedge]\ncolumns = 100000\nrows = 100000\n"),
              HasSubstr("ask for 3.6e+11 unknowns; allowed: up to 1e+07"));
}

// The least floor that is accepted, to a thousandth.
template <class Complaint>
double least_floor(double refused, double taken, const Complaint& complaint_of_length) {
  EXPECT_NE(complaint_of_length(refused), "");
  EXPECT_EQ(complaint_of_length(taken), "");
  while (taken - refused > 1e-3 * taken) {
    const double middle = 0.5 * (refused + taken);
    (complaint_of_length(middle).empty() ? taken : refused) = middle;
  }
  return taken;
}

// A later realization meets the floor's limit that the first one does not.
TEST(CheckRealizations, AllOfThemAreTried) {
  const auto floor = [](int realizations, double length) {
    return complaint(
        pile(fmt::format("[source]\ngrains = 30\n[ensemble]\nrealizations = {}\n"
                         "[floor]\nlength = {}\n",
                         realizations, length)));
  };
  const double least = least_floor(0.05, 0.5, [&](double length) { return floor(1, length); });
  EXPECT_THAT(floor(200, least), HasSubstr("x.toml:7: floor.length: found "));
}

TEST(CheckRealizations, ThoseThatCannotAllBeDrawnAreHeldTighter) {
  const auto pouring = [](int realizations, double length) {
    return complaint(
        pile(fmt::format("[average]\nmap_columns = 3\nmap_rows = 3\n[shape]\n"
                         "polydispersity = 0.1\n[ensemble]\nrealizations = {}\n"
                         "[floor]\nlength = {}\n",
                         realizations, length)));
  };
  // Some 46 of 400 piles of 6500 grains are drawn.
  const double least = least_floor(1, 2, [&](double length) { return pouring(1, length); });
  EXPECT_THAT(pouring(400, least), HasSubstr("floor.length: found "));
  EXPECT_EQ(pouring(400, 1.05 * least), "");
}

// RAND1 grains of 64 corners are drawn after hundreds of tries each.
TEST(CheckRealizations, CostlyGrainsAreFew) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(complaint(pile("[shape]\ncorners_min = 64\ncorners_max = 64\n")), "");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST(CheckStudies, WhatTheAnalysisWouldRefuse) {
  EXPECT_THAT(complaint("study = \"elastic-layer\"\n[compare]\nmodels = [\"layer\"]\n"),
              HasSubstr("x.toml:3: compare.models: found 1 model(s) of dimension"));
  EXPECT_THAT(complaint("study = \"osl-wedge\"\n[compare]\nmodels = [\"osl\"]\n"),
              HasSubstr("x.toml:3: compare.models: found 1 model(s), expected two or more"));
  EXPECT_THAT(complaint("study = \"wedge\"\n[wedge]\nbases = [\" 20\"]\n[compare]\nmodels = "
                        "[\"fe_mohr_coulomb_wedge\", \"cantelaube\"]\n"),
              HasSubstr("x.toml:3: wedge.bases: found \" 20\", expected rough, smooth"));
  EXPECT_THAT(complaint("[compare]\nmodels = [\"orthotropic_half_plane\"]\n"
                        "[model.orthotropic_half_plane]\nE_x = 1e7\n"),
              HasSubstr("model orthotropic_half_plane: "));
}

}  // namespace
}  // namespace grainfield::coupling
