// The page of the sources' figures.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "coupling/reproduce/figures.h"
#include "coupling/reproduce/page.h"
#include "coupling/run/summary_keys.h"
#include "tests/coupling/program.h"
#include "tests/paths.h"

namespace grainfield::coupling {
namespace {

using ::testing::AllOf;
using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::program;

const std::string kDocs = std::string(GRAINFIELD_CASES) + "/../docs/";

TEST(Reproduce, ThePageInDocsIsWhatTheCommandPrints) {
  const auto output = program("reproduce " + kDocs + "reproduction/results");
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(testing::read_text(kDocs + "reproduction.md"), output.out)
      << "regenerate: grainfield reproduce docs/reproduction/results -o docs/reproduction.md";
}

TEST(Reproduce, EveryFigureNamesAShippedCase) {
  std::set<std::string> seen;
  for (const SourceFigure& f : source_figures()) {
    EXPECT_TRUE(testing::fs::exists(std::string(GRAINFIELD_CASES) + "/" + f.study + ".toml"))
        << f.study;
    EXPECT_TRUE(seen.insert(f.what).second) << f.what;
    EXPECT_NE(f.number == nullptr, f.word == nullptr) << f.what;
    EXPECT_LE(f.low, f.high) << f.what;
  }
}

TEST(Reproduce, FitsGiveTheLargerErrorAndQualityInWords) {
  const Folder folder;
  folder.write("fit-osl-point.json",
               R"({"fit.osl.eta": 0.72, "fit.osl.eta.error": 0.004,
 "fit.osl.eta.bootstrap_error": 0.02, "fit.osl.mu": -0.5, "fit.osl.mu.error": 0.03,
 "fit.osl.mu.bootstrap_error": "nan", "fit.osl.chi2_per_dof": 1.3, "fit.osl.chi2_chance": 1.21,
 "fit.osl.rel_l2": 0.08})");
  folder.write("fit-asymmetric.json",
               R"({"fit.cantelaube_asymmetric.kink": -0.3,
 "fit.cantelaube_asymmetric.kink.error": 0.1, "fit.cantelaube_asymmetric.ray_deg": 4})");
  const std::string page = reproduction_page(Results(folder.path()));
  EXPECT_THAT(page, HasSubstr("| OSL, point source: η | 0.74 | 0.720 ± 0.020 | agrees |"));
  EXPECT_THAT(page, HasSubstr("| -0.500 ± 0.030 | differs by 0.18 (6.0 standard errors) |"));
  EXPECT_THAT(page, HasSubstr("| beyond the errors: χ²/dof 1.30 (chance: up to 1.21), relative L2 "
                              "8.0 % | differs |"));
  EXPECT_THAT(page, HasSubstr("| dip: kink -0.30 ± 0.10 ρg on the ray at 4° from the vertical | "
                              "agrees |"));
  // The misprints follow.
  EXPECT_THAT(page, HasSubstr("| Wellmann 6 | \"c_end = 0.4\" | 0.04 |"));
  for (const char* place :
       {"Liffman 7, 19", "Liffman 14", "Liffman 29", "Liffman 30", "Liffman 36", "Roul 2.39"}) {
    EXPECT_THAT(page, HasSubstr(std::string("| ") + place + " | "));
  }
}

TEST(Reproduce, SummariesGiveNumbersWithErrorsAndWords) {
  const Folder folder;
  folder.write("pile-point-source.json",
               R"({"repose.mean_deg": 28.4, "repose.mean_deg.standard_error": 0.3,
 "dip.verdict": "dip", "dip.difference": 0.1, "dip.standard_error": 0.02, "dip.p_value": 0.001,
 "dip.ratio": 0.8, "ensemble.realizations": 8, "density.ratio": 1.02,
 "density.ratio.standard_error": 0.004, "dem.grains": 6500, "source.interval": 0.03})");
  folder.write("pile-line-source.json",
               R"({"repose.mean_deg": 24, "repose.mean_deg.standard_error": 0.5,
 "heap.volume_fraction": 0.79, "dip.verdict": "dip", "dip.difference": 0.1,
 "dip.standard_error": 0.02, "dip.p_value": 0.001, "dip.ratio": 0.8})");
  folder.write("pile-elliptic.json",
               R"({"dip.verdict": "undecided", "dip.difference": 0.22, "dip.standard_error": 0.2,
 "dip.p_value": "nan", "dip.ratio": 0.7})");
  const std::string page = reproduction_page(Results(folder.path()));
  EXPECT_THAT(page,
              HasSubstr("| Roul 3.1 | angle of repose, point source | 28 deg | 28.4 ± 0.3 deg "
                        "| agrees | 8 | `pile-point-source` |"));
  EXPECT_THAT(page, HasSubstr("| 24.0 ± 0.5 deg | differs by 2 deg (4.0 standard errors) |"));
  EXPECT_THAT(page, HasSubstr("| dip: shoulder - centre = 0.100 ± 0.020 ρgh, p = 0.002 if "
                              "there were none (0.004 over all pours); centre over largest 0.80 | "
                              "agrees |"));
  // A line source with a dip is a difference.
  EXPECT_THAT(page, HasSubstr("none (0.004 over all pours); centre over largest 0.80 | differs |"));
  EXPECT_THAT(page, HasSubstr("| `pile-point-source` | 8 | 0.100 ± 0.020 | 0.002 | 0.004 | dip |"));
  EXPECT_THAT(page, HasSubstr("| `pile-elliptic` |  | 0.220 ± 0.200 | nan | nan | undecided |"));
  EXPECT_THAT(page, HasSubstr("| too few realizations to tell |"));
  // The ratio of 0.22 +- 0.2 and 0.1 +- 0.02.
  EXPECT_THAT(page, HasSubstr("| about 2 | 2.200 ± 2.048 | spread too wide to tell |"));
  // A number without an error says nothing.
  EXPECT_THAT(page, HasSubstr("| 0.79 | 0.790 | no error, no statement |"));
  EXPECT_THAT(page,
              HasSubstr("| 1.08-1.10 | 1.020 ± 0.004 | differs by 0.06 (15.0 standard errors) |"));
  EXPECT_THAT(page, HasSubstr("| `pile-point-source` | 6500 | 8 | 0.03 |"));
  EXPECT_THAT(page, HasSubstr("| asymmetric line source, steeper flank | 31 deg | not run |"));
  // No command is made up where none was stored.
  EXPECT_THAT(page, ::testing::Not(HasSubstr("grainfield run cases/pile-point-source.toml")));
  EXPECT_THAT(page, HasSubstr("run before commands were stored"));
}

// One of three pours at p = 0.04 is what chance alone makes of three; a study that the sources do
// not have counts too.
TEST(Reproduce, DipsAreJudgedOverAllPours) {
  const auto pour = [](double difference, double p) {
    return fmt::format(
        R"({{"dip.difference": {}, "dip.standard_error": 0.02, "dip.p_value": {}, "dip.ratio": 0.8}})",
        difference, p);
  };
  const Folder folder;
  folder.write("pile-point-source.json", pour(0.05, 0.02));
  folder.write("pile-line-source.json", pour(-0.01, 0.7));
  folder.write("another.json", pour(-0.3, 0.999));
  const std::string page = reproduction_page(Results(folder.path()));
  EXPECT_THAT(page,
              HasSubstr("| `pile-point-source` |  | 0.050 ± 0.020 | 0.04 | 0.08 | neither |"));
  EXPECT_THAT(page, HasSubstr("| `another` |  | -0.300 ± 0.020 | 0.002 | 0.006 | peak |"));
  EXPECT_THAT(page,
              HasSubstr("| Roul 3.3 | base pressure, point source | dip | neither: shoulder"));
}

// -0.04 +- 0.03 over 0.05 +- 0.02 against 1.5: -0.115 off with an error of 0.03 sqrt 2.
TEST(Reproduce, ARatioIsJudgedByItsNumeratorWhereTheDenominatorIsUncertain) {
  const Folder folder;
  folder.write("pile-point-source.json", R"({"dip.difference": 0.05, "dip.standard_error": 0.02})");
  folder.write("pile-elliptic.json", R"({"dip.difference": -0.04, "dip.standard_error": 0.03})");
  EXPECT_THAT(reproduction_page(Results(folder.path())),
              HasSubstr("| about 2 | -0.800 ± 0.849 | differs by 2.3 (2.7 standard errors) |"));
}

// Fig. 11's other claims as differences, and what a reader must know of a row.
TEST(Reproduce, SuperellipsoidsChangeInWordsWithNotesOnTheRun) {
  const Folder folder;
  const char* key = "\"sample.end_axial_stress_ratio.";
  std::string laws = R"({"case.command": "grainfield run cases/contact-laws.toml --quick",
 "dem.grains.least.ratio_1": 200, "dem.grains.least.ratio_025": 200)";
  const auto put = [&](const char* member, double value) {
    laws += fmt::format(", {0}{1}\": {2}, {0}standard_error.{1}\": 0.02", key, member, value);
  };
  put("ratio_025", 1.2);
  put("ratio_1", 1.4);
  put("ratio_1_friction_025", 1);
  put("ratio_025_friction_025", 0.88);
  put("poisson_0", 1.4);
  put("poisson_045", 1.45);
  put("poisson_0_friction_025", 1.39);
  folder.write("contact-laws.json", laws + "}");
  folder.write("box-compression.json", R"({"sample.end_axial_stress_ratio.penalty_0": 0.1,
 "sample.end_axial_stress_ratio.standard_error.penalty_0": 0.01,
 "sample.kinetic_share.penalty_0": 15})");
  folder.write("box-shear.json", R"({"rve.contraction.hertz_05": 0.0002,
 "rve.contraction.standard_error.hertz_05": 0.0002, "rve.dilation.hertz_05": 0.001,
 "rve.dilation.standard_error.hertz_05": 0.0001,
 "sample.axial_dip_strain.penalty_025": 0.07, "sample.axial_dip_strain.standard_error.penalty_025": 0.003,
 "sample.pressure_ratio.penalty_025": 1.3, "sample.pressure_ratio.standard_error.penalty_025": 0.02,
 "sample.pressure_ratio.hertz_025": 1.2, "sample.pressure_ratio.standard_error.hertz_025": 0.02})");
  const std::string page = reproduction_page(Results(folder.path()));
  EXPECT_THAT(page, HasSubstr("penalty law | rises | rises: +0.400 ± 0.028 | agrees |  | "
                              "`contact-laws` (quick, 200 grains) |"));
  EXPECT_THAT(page, HasSubstr("Hertz law | rises | undecided: +0.010 ± 0.028 | too few"));
  EXPECT_THAT(page, HasSubstr("0.25 to 1, mu = 0.5 | hardly changes | changes: +0.200 ± 0.028, "
                              "+17 ± 2 % | differs |"));
  // Above a tenth, but not by two errors: neither.
  EXPECT_THAT(page, HasSubstr("0.25 to 1, mu = 0.25 | hardly changes | between: +0.120 ± 0.028, "
                              "+14 ± 3 % | spread too wide to tell |"));
  EXPECT_THAT(page, HasSubstr("0 to 0.45, mu = 0.5 | hardly changes | hardly changes: +0.050 ± "
                              "0.028, +4 ± 2 % | agrees |"));
  EXPECT_THAT(page, HasSubstr("| 0.100 ± 0.010 | agrees; slow flow, not at rest: kinetic over "
                              "elastic energy up to 15 |  | `box-compression` |"));
  EXPECT_THAT(page, HasSubstr("| dilation: trace/3 falls by 0.00020 ± 0.00020, then rises by "
                              "0.00100 ± 0.00010 | differs |"));
  EXPECT_THAT(page, HasSubstr("penalty law, mu = 0.25 | about 0.05 | 0.070 ± 0.003 | differs by "
                              "0.0075 (2.5 standard errors) |"));
  EXPECT_THAT(page,
              HasSubstr("volumetric stress over its start, from penalty to Hertz law | rises | "
                        "falls: -0.100 ± 0.028 | differs |"));
  EXPECT_THAT(page, HasSubstr("mu = 0 | about 1 | not in this run: without friction no sample came "
                              "to rest before it |  |  |"));
}

// One sample has no error, and of a study that was not run nothing is known.
TEST(Reproduce, OneSampleDecidesNothingAndNoRunIsSaidSo) {
  const Folder folder;
  const std::string key = "\"sample.end_axial_stress_ratio.";
  folder.write("contact-laws.json", "{" + key + "ratio_025\": 1.2, " + key + "ratio_1\": 1.201}");
  const std::string page = reproduction_page(Results(folder.path()));
  EXPECT_THAT(page, HasSubstr("0.25 to 1, mu = 0.5 | hardly changes | undecided: +0.001, +0 % | "
                              "too few realizations to tell |"));
  EXPECT_THAT(page,
              HasSubstr("volumetric stress over its start, mu = 0 | about 1 | not run |  |  |"));
}

TEST(Reproduce, EveryKeyIsOneThatSummariesHave) {
  // A results file with every number gives every row: no key of the table is misspelt.
  const Folder folder;
  const std::set<std::string> keys{"repose.mean_deg",
                                   "dem.repose_angle_left_deg",
                                   "dem.repose_angle_right_deg",
                                   "heap.volume_fraction",
                                   "density.ratio",
                                   "change.gravity_0.98.coordination_ratio",
                                   "change.gravity_18.6.coordination_ratio",
                                   "dip.ratio",
                                   "dip.difference",
                                   "dip.p_value",
                                   "rve_size.stress_grains",
                                   "rve_size.strain_grains",
                                   "rve_size.fabric_grains",
                                   "forces.tail_p_value",
                                   "orientation.order",
                                   "orientation.director_deg",
                                   "strain.dip_ratio",
                                   "strain.cundall.difference_yy_low",
                                   "strain.liao.difference_yy_low",
                                   "strain.derivative.difference_yy_low",
                                   "fabric.anisotropy",
                                   "fabric.axis_left_deg",
                                   "fabric.axis_right_deg",
                                   "fabric.g2",
                                   "fabric.nu_c_correlation",
                                   "fabric.nu_correlation",
                                   "invariants.trace_slope_ratio",
                                   "change.gravity_0.981.coordination_ratio",
                                   "change.gravity_18.639.coordination_ratio",
                                   "elastic.young_over_grain",
                                   "elastic.bulk_fabric_correlation",
                                   "elastic.young_fabric_correlation",
                                   "elastic.shear_fabric_correlation",
                                   "response.peaks",
                                   "liffman.normal_max_error.slope_deg_60",
                                   "liffman.horizontal_max_error.slope_deg_60",
                                   "fit.cantelaube.a1",
                                   "fit.cantelaube.a2",
                                   "fit.cantelaube.b1",
                                   "fit.cantelaube.a_xx",
                                   "fit.cantelaube.a_yy",
                                   "fit.cantelaube.a_xy",
                                   "fit.cantelaube.beta_hat_deg",
                                   "fit.osl.eta",
                                   "fit.osl.mu",
                                   "fit.osl.K",
                                   "fit.osl.tau_deg",
                                   "fit.cantelaube_asymmetric.kink",
                                   "fit.cantelaube_asymmetric.kink.error",
                                   "fit.cantelaube_asymmetric.ray_deg",
                                   "rve.r2.grains",
                                   "rve.r3.grains",
                                   "rve.r5.grains",
                                   "rve.r7.grains",
                                   "rve.r2.error_bar",
                                   "rve.r3.error_bar",
                                   "rve.r5.error_bar",
                                   "rve.r7.error_bar",
                                   "rve.r5.strain_ratio",
                                   "rve.r5.strain_ratio.hertz_05",
                                   "rve.contraction_strain.hertz_05",
                                   "sample.kinetic_share.hertz_05",
                                   "sample.stiffening_late.hertz_05",
                                   "sample.stiffening_late.penalty_05",
                                   "sample.end_axial_stress_ratio.hertz_0",
                                   "sample.end_axial_stress_ratio.penalty_0",
                                   "rve.contraction.hertz_05",
                                   "rve.dilation.hertz_05",
                                   "sample.plastic_strain.hertz_0",
                                   "sample.plastic_strain.hertz_05",
                                   "sample.unloading_stiffness.hertz_05",
                                   "sample.pressure_ratio.hertz_0",
                                   "sample.pressure_ratio.hertz_025",
                                   "sample.pressure_ratio.penalty_025",
                                   "sample.shear_over_pressure.penalty_025",
                                   "sample.axial_dip_strain.hertz_025",
                                   "sample.axial_dip_strain.penalty_025",
                                   "sample.kinetic_share",
                                   "sample.pressure_ratio.hertz_05",
                                   "sample.shear_over_pressure.hertz_025",
                                   "sample.shear_over_pressure.hertz_05",
                                   "liffman.normal_max_error.slope_60",
                                   "liffman.horizontal_max_error.slope_60",
                                   "liffman.minimum_lines_level.slope_deg_60",
                                   "liffman.line_horizontal_max_difference.slope_30",
                                   "liffman.line_horizontal_max_difference.large_30",
                                   "liffman.maximum_lines_level.slope_30",
                                   "liffman.minimum_lines_level.slope_30",
                                   "liffman.horizontal_explained.slope_32_6",
                                   "liffman.normal_centre.slope_32_6",
                                   "liffman.line_normal_centre.tent",
                                   "liffman.normal_centre.tent",
                                   "settling.at_rest.viscous_alone",
                                   "settling.spread_speed.viscous_alone",
                                   "settling.normal_max_error.wells",
                                   "settling.horizontal_max_error.wells",
                                   "switch.at_rest",
                                   "switch.soft_share",
                                   "switch.to_hard",
                                   "dip.difference.equal",
                                   "dip.standard_error.equal",
                                   "dip.standard_error"};
  std::set<std::string> all = keys;
  for (const char* others : {"unlike", "coulomb", "pentagons"}) {
    all.insert(std::string("dip.difference.") + others);
    all.insert(std::string("dip.standard_error.") + others);
  }
  for (const char* constants : {"ratio_025", "ratio_1", "poisson_0", "poisson_045"}) {
    const std::string key = std::string("sample.end_axial_stress_ratio.") + constants;
    all.insert(key);
    all.insert(key + "_friction_025");
  }
  for (const char* fraction : {"0.2", "0.35", "0.5"}) {
    const std::string key =
        std::string("gas.fraction_") + fraction + ".compressibility_over_theory.";
    all.insert(key + "pressure");
    all.insert(key + "standard_error.pressure");
  }
  for (const char* model :
       {"cantelaube", "cantelaube_minus", "cantelaube_plus", "osl", "cantelaube_asymmetric_zero"}) {
    all.insert(std::string("fit.") + model + ".chi2_per_dof");
    all.insert(std::string("fit.") + model + ".chi2_chance");
    all.insert(std::string("fit.") + model + ".rel_l2");
  }
  std::string text =
      R"({"dip.verdict": "dip", "dip.verdict.equal": "dip", "dip.verdict.unlike": "dip",
 "dip.verdict.coulomb": "dip", "dip.verdict.pentagons": "dip", "fit.cantelaube.branch": "zero")";
  for (const std::string& key : all) {
    std::string own = key;  // of a sweep's member
    for (const char* member :
         {".slope_", ".large_", ".tent", ".equal", ".unlike", ".coulomb", ".pentagons", ".hertz_",
          ".penalty_", ".viscous_alone", ".wells", ".ratio_", ".poisson_"}) {
      own = own.substr(0, own.find(member));
    }
    const std::string gas = ".pressure";  // other keys have it as the beginning of a word
    if (own.ends_with(gas)) own.resize(own.size() - gas.size());
    EXPECT_NE(find_summary_key(own), nullptr) << key;
    text += ", \"" + key + "\": 1.5";
  }
  for (const SourceFigure& f : source_figures()) folder.write(f.study + ".json", text + "}");
  EXPECT_THAT(reproduction_page(Results(folder.path())), Not(HasSubstr("not run")));
}

TEST(Reproduce, AgreementByItsRule) {
  SourceFigure f;
  f.unit = "deg";
  f.low = 27;
  f.high = 29;
  EXPECT_EQ(agreement(f, {28, 0.1}), "agrees");
  EXPECT_EQ(agreement(f, {30, 0.6}), "agrees");
  EXPECT_EQ(agreement(f, {30, 0.4}), "differs by 1 deg (2.5 standard errors)");
  EXPECT_EQ(agreement(f, {20, 10}), "spread too wide to tell");
  EXPECT_EQ(agreement(f, {28, std::nan("")}), "no error, no statement");
  // A ratio that cannot tell 1.09 from 1 says nothing, although its range holds 1.09.
  f.low = 1.08;
  f.high = 1.10;
  EXPECT_EQ(agreement(f, {1.0, 0.05}), "agrees");
  f.effect = 0.09;
  EXPECT_EQ(agreement(f, {1.0, 0.05}), "spread too wide to tell");
  EXPECT_EQ(agreement(f, {1.07, 0.02}), "agrees");
}

TEST(Reproduce, TakesAFinishedRunIn) {
  const Folder run, results;
  run.write("summary.json", R"({"case.name": "pile-elliptic", "repose.mean_deg": 31.5,
                               "case.command": "grainfield run pile-elliptic --set a=1"})");
  run.write("profiles.md", "# Profiles\n");
  run.write("report.html",
            R"(<img width="9" height="9" alt="Stress" src="data:image/png;base64,QQ==">)"
            R"(<img width="9" height="9" alt="Volume fraction" src="data:image/png;base64,UE5H">)"
            R"(<img width="9" height="9" alt="Vertical pressure on the base" )"
            R"(src="data:image/svg+xml;base64,PHN2Zy8+">)");
  const auto output = program("reproduce " + results.path() + " --add " + run.path() + " -o " +
                              (results / "page.txt"));
  ASSERT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(testing::read_text(results / "pile-elliptic.json"),
            testing::read_text(run / "summary.json"));
  EXPECT_EQ(testing::read_text(results / "pile-elliptic.profiles.md"), "# Profiles\n");
  EXPECT_EQ(testing::read_text(results / "pile-elliptic.base-pressure.svg"), "<svg/>");
  EXPECT_EQ(testing::read_text(results / "pile-elliptic.volume-fraction.png"), "PNG");
  const std::string page = testing::read_text(results / "page.txt");
  EXPECT_THAT(page, HasSubstr("| 31.5 deg |"));
  EXPECT_THAT(page, HasSubstr("| `grainfield run pile-elliptic --set a=1` |"));
  EXPECT_THAT(page, HasSubstr("(reproduction/results/pile-elliptic.profiles.md)"));
  EXPECT_THAT(page, HasSubstr("![base-pressure](reproduction/results/"));
  EXPECT_EQ(program("reproduce " + results.path() + " --add " + results.path()).code, 2);
}

TEST(Reproduce, ANameThatLeadsElsewhereIsRefused) {
  const Folder run, results;
  for (const std::string name : {"../escaped", "/tmp/escaped", "a/b", "..", ".hidden", ""}) {
    run.write("summary.json", "{\"case.name\": \"" + name + "\"}");
    const auto output = program("reproduce " + results.path() + " --add " + run.path());
    EXPECT_EQ(output.code, 2) << name;
    EXPECT_THAT(output.err, HasSubstr("case.name: found \"" + name + "\""));
  }
  EXPECT_TRUE(testing::fs::is_empty(results.path()));
}

TEST(Reproduce, RefusesFoldersAndFilesThatAreNone) {
  const Folder folder;
  const auto missing = program("reproduce " + (folder / "none"));
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, HasSubstr("none: no such folder"));
  folder.write("pile-elliptic.json", "{");
  const auto broken = program("reproduce " + folder.path() + " -o " + (folder / "page.md"));
  EXPECT_EQ(broken.code, 2);
  EXPECT_THAT(broken.err, HasSubstr("pile-elliptic.json: not a JSON object"));
  EXPECT_FALSE(testing::fs::exists(folder / "page.md"));
}

}  // namespace
}  // namespace grainfield::coupling
