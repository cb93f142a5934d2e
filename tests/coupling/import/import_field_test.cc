// `grainfield import-field`: what was measured in a laboratory beside the models.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <regex>

#include "continuum/closed/osl.h"
#include "coupling/result/tables.h"
#include "coupling/store/field_io.h"
#include "dem/random/random.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Output;
using testing::program;

constexpr double kSlope = 30, kHeight = 0.08, kRhoG = 15000, kEta = 0.74, kMu = -0.31;

// Base pressures and shears of OSL with errors of 2 %, in kPa at places in mm; all times a factor.
std::string measured(std::uint64_t seed, double factor = 1) {
  const auto field = continuum::osl_field(kSlope * std::numbers::pi / 180, {kEta, kMu}, kRhoG);
  dem::Random random(seed);
  std::string out = "# a heap of sand\nx (mm),component,value (kPa),error (kPa)\n";
  const double foot = kHeight / std::tan(kSlope * std::numbers::pi / 180);
  for (int k = -12; k <= 12; ++k) {
    const double x = 0.9 * foot * k / 12;
    const Eigen::Vector3d stress = field.stress(x, -kHeight);
    for (const auto& [name, value] : {std::pair{"pressure", -stress[1]}, {"shear", stress[2]}}) {
      const double error = 0.02 * std::max(std::fabs(value), 20.0);
      // An error of unit variance, nearly normal.
      double off = -6;
      for (int n = 0; n < 12; ++n) off += random.uniform(0, 1);
      out += fmt::format("{},{},{},{}\n", 1000 * x, name, factor * (value + error * off) / 1000,
                         factor * error / 1000);
    }
  }
  return out;
}

std::string heap_options(const std::string& rho_g = fmt::format("{}", kRhoG)) {
  return fmt::format(" --height {} --slope {} --rho-g {} --width 0.002", kHeight, kSlope, rho_g);
}

double figure(const Summary& s, const std::string& key) {
  const auto at = s.find(key);
  if (at == s.end()) {
    ADD_FAILURE() << key << " is missing";
    return std::nan("");
  }
  return std::get<double>(at->second);
}

// Cells are flat and lie in the floor: how long they are changes nothing where the stress is
// straight along them, and no place is lost.
TEST(ImportField, ConstantsDoNotHangOnTheCells) {
  const Folder folder;
  const auto field = continuum::osl_field(kSlope * std::numbers::pi / 180, {kEta, kMu}, kRhoG);
  std::string text = "x (mm),component,value (Pa),error (Pa)\n";
  const double foot = kHeight / std::tan(kSlope * std::numbers::pi / 180);
  for (int k = -12; k <= 12; ++k) {
    const double x = 0.9 * foot * k / 12;
    const Eigen::Vector3d stress = field.stress(x, -kHeight);
    text += fmt::format("{},pressure,{},{}\n", 1000 * x, -stress[1], -0.02 * stress[1]);
    // One shear is without an error, and so has no weight.
    text += fmt::format("{},shear,{},{}\n", 1000 * x, stress[2], k == 3 ? "" : "10");
  }
  const std::string file = folder.write("m.csv", text);
  for (const char* width : {"0.1 mm", "2 mm", "4 mm"}) {
    const Output in =
        program("import-field " + file +
                fmt::format(" --height '80 mm' --slope {} --rho-g {} --width '{}' -o ", kSlope,
                            kRhoG, width) +
                (folder / "f.h5"));
    ASSERT_EQ(in.code, 0) << in.err;
    const Output out = program("fit " + (folder / "f.h5") + " --model osl -o " + (folder / "fit"));
    ASSERT_EQ(out.code, 0) << out.err;
    EXPECT_THAT(out.out, HasSubstr("49 values"));
    EXPECT_THAT(out.out, HasSubstr("1 of 50 values have no error and are left out: sigma_xy at x"));
    const Summary fit = read_summary(folder / "fit/summary.json");
    EXPECT_NEAR(figure(fit, "fit.osl.eta"), kEta, 0.003) << width;
    EXPECT_NEAR(figure(fit, "fit.osl.mu"), kMu, 0.005) << width;
    EXPECT_LT(figure(fit, "fit.osl.chi2_per_dof"), 0.05) << width;
  }
}

// The same heap, with its numbers in SI and in units.
TEST(ImportField, QuantitiesOfTheCommandLineMayHaveUnits) {
  const Folder folder;
  const std::string command = "import-field " + folder.write("m.csv", measured(7)) + " -o ";
  const Output plain = program(command + (folder / "a.h5") +
                               " --height 0.08 --slope 30 --rho-g 15000 --width 0.002");
  ASSERT_EQ(plain.code, 0) << plain.err;
  const Output units =
      program(command + (folder / "b.h5") +
              " --height '80 mm' --slope '30 deg' --rho-g '15 kN/m3' --width '2 mm'");
  ASSERT_EQ(units.code, 0) << units.err;
  const Field a = read_field(folder / "a.h5", "base"), b = read_field(folder / "b.h5", "base");
  EXPECT_EQ(a.attributes, b.attributes);
  EXPECT_EQ(a.find("sigma_yy")->value, b.find("sigma_yy")->value);
}

// A measurement whose errors are unknown has constants all the same.
TEST(ImportField, WithoutErrorsThereAreConstantsWithoutErrors) {
  const Folder folder;
  std::string text;
  std::istringstream given(measured(7));
  for (std::string line; std::getline(given, line);) {
    const bool value = line.find("pressure") != line.npos || line.find("shear") != line.npos;
    text += (value ? line.substr(0, line.rfind(',') + 1) : line) + "\n";
  }
  ASSERT_EQ(program("import-field " + folder.write("m.csv", text) + heap_options() + " -o " +
                    (folder / "f.h5"))
                .code,
            0);
  const Output out =
      program("fit " + (folder / "f.h5") + " --model osl --model bcc -o " + (folder / "fit"));
  ASSERT_EQ(out.code, 0) << out.err;
  EXPECT_THAT(out.out, HasSubstr("no errors, nothing is distinguishable"));
  EXPECT_NEAR(figure(read_summary(folder / "fit/summary.json"), "fit.osl.eta"), kEta, 0.05);
}

// What was measured is not called grains: verdicts, tables and pictures know where it is from.
TEST(ImportField, TextsSpeakOfTheMeasurement) {
  const Folder folder;
  const std::string field = folder / "f.h5";
  ASSERT_EQ(program("import-field " + folder.write("m.csv", measured(7)) + heap_options() + " -o " +
                    field)
                .code,
            0);
  const auto page_of = [&](const std::string& command, const char* name, Output* said = nullptr) {
    const Output out = program(command + " -o " + (folder / name));
    EXPECT_EQ(out.code, 0) << out.err;
    if (said != nullptr) *said = out;
    return testing::read_text(folder / name + "/report.html");
  };
  Output apart, near, none;
  const std::string page =
      page_of("compare " + field + " --model osl:eta=0.74,mu=-0.31 --model bcc", "a", &apart);
  EXPECT_THAT(apart.out,
              HasSubstr("The measurement supports osl, not bcc (one field with errors, 95 %)."));
  EXPECT_THAT(apart.out, HasSubstr("(1) the measurement is at "));
  EXPECT_THAT(page, HasSubstr("Distance of the models from the measurement"));
  page_of("compare " + field + " --model hydrostatic:rho_g=90000 --model bcc:rho_g=60000", "n",
          &none);
  EXPECT_THAT(none.out, HasSubstr("No model describes the measurement: "));
  page_of("compare " + field + " --model bcc", "one", &near);
  EXPECT_THAT(near.out, HasSubstr("with the measurement (one field with errors, 95 %)."));
  const std::string fit = page_of("fit " + field + " --model osl --model bcc", "f");
  EXPECT_THAT(fit, HasSubstr("Measurement and the best models: sigma_yy"));
  EXPECT_THAT(fit, HasSubstr("behind, Akaike"));
  for (const std::string& text : {page, fit, apart.out, near.out, none.out}) {
    EXPECT_THAT(text, ::testing::Not(::testing::ContainsRegex("[gG]rains")));
  }
}

TEST(ImportField, GivesTheConstantsOfAnExperimentBack) {
  const Folder folder;
  const std::string file = folder / "field.h5";
  Output out = program("import-field " + folder.write("m.csv", measured(7)) + heap_options() +
                       " -o " + file);
  ASSERT_EQ(out.code, 0) << out.err;
  EXPECT_THAT(out.out, HasSubstr("base: 25 points, h = 0.08 m"));
  EXPECT_THAT(out.out, HasSubstr("sigma_yy: 25 values, 25 with errors (N/m)"));
  out = program("fit " + file +
                " --heights 0 --components sigma_yy,sigma_xy --model osl --model bcc -o " +
                (folder / "fit"));
  ASSERT_EQ(out.code, 0) << out.err;
  const Summary fit = read_summary(folder / "fit/summary.json");
  for (const auto& [name, value] : {std::pair{"eta", kEta}, {"mu", kMu}}) {
    const double error = figure(fit, fmt::format("fit.osl.{}.error", name));
    EXPECT_GT(error, 0);
    EXPECT_LT(error, 0.1);
    EXPECT_NEAR(figure(fit, fmt::format("fit.osl.{}", name)), value, 3 * error);
  }
  const double osl = figure(fit, "fit.osl.chi2_per_dof");
  EXPECT_GT(osl, 0.4);
  EXPECT_LT(osl, 2);
  EXPECT_GT(figure(fit, "fit.bcc.chi2_per_dof"), 5 * osl);
  EXPECT_GT(figure(fit, "fit.bcc.chi2_per_dof"), 5);
  EXPECT_EQ(std::get<std::string>(fit.at("fit.osl.supported")), "yes");
  EXPECT_EQ(std::get<std::string>(fit.at("fit.bcc.supported")), "no");
  EXPECT_EQ(std::get<std::string>(fit.at("fit.warnings")), "");
  // The errors that came in go out with the profiles, and so into every plot.
  const std::string table = testing::read_text(folder / "fit/profiles.csv");
  EXPECT_THAT(table, HasSubstr(",x_m,measured_N/m,"));
  std::istringstream profiles(table);
  int rows = 0;
  for (std::string line; std::getline(profiles, line);) {
    if (!line.starts_with("sigma_")) continue;
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    ASSERT_GT(cells.size(), 7U);
    EXPECT_GT(std::stod(cells[4]), 0) << line;
    EXPECT_LT(std::fabs(std::stod(cells[7])), 6) << line;
    ++rows;
  }
  EXPECT_EQ(rows, 50);

  out = program(fmt::format("compare {} --model osl:eta={},mu={} --model bcc -o {}", file, kEta,
                            kMu, folder / "compare"));
  ASSERT_EQ(out.code, 0) << out.err;
  const Summary compare = read_summary(folder / "compare/summary.json");
  EXPECT_LT(figure(compare, "compare.osl.chi2_per_dof"), 2);
  // A mean of 25 values of 1.3 is as far from 1 as one standard deviation of a true model's.
  EXPECT_GT(figure(compare, "compare.bcc.chi2_per_dof"), 2.5);
  EXPECT_THAT(std::get<std::string>(compare.at("verdict.sentence")), HasSubstr("misfit"));
  EXPECT_GT(figure(compare, "verdict.position_error"), 0) << "by the errors that came with it";
}

TEST(ImportField, TakesResponsesInTheirOwnUnits) {
  const Folder folder;
  // 2 F/(pi h) (1 + (x/h)^2)^-2 of Flamant on the depth h, in units of h and F/h.
  std::string text = "x [h],y [h],component,value [F/h],error [F/h]\n";
  for (int k = -5; k <= 5; ++k) {
    const double x = 0.2 * k;
    text += fmt::format("{},-0.5,pressure,{},0.01\n", x,
                        4 / std::numbers::pi / std::pow(1 + 4 * x * x, 2));
  }
  const std::string file = folder / "field.h5";
  Output out = program("import-field " + folder.write("m.csv", text) +
                       " --geometry layer --height 0.3 --load 12 --width 0.0001 -o " + file);
  ASSERT_EQ(out.code, 0) << out.err;
  const Field field = read_field(file, "measured");
  EXPECT_NEAR(field.points(0, 0), -0.3, 1e-12);
  EXPECT_NEAR(field.points(0, 1), -0.15, 1e-12);
  EXPECT_NEAR(field.find("sigma_yy")->value[5], -4 / std::numbers::pi * 12 / 0.3, 1e-9);
  EXPECT_NEAR(field.find("sigma_yy")->error[5], 0.01 * 12 / 0.3, 1e-12);
  out = program("compare " + file + " --model flamant --model layer -o " + (folder / "c"));
  ASSERT_EQ(out.code, 0) << out.err;
  const Summary compare = read_summary(folder / "c/summary.json");
  EXPECT_LT(figure(compare, "compare.flamant.rel_l2"), 1e-3);
  EXPECT_GT(figure(compare, "compare.layer.rel_l2"), 0.05);
}

TEST(ImportField, TakesConesInSpace) {
  const Folder folder;
  std::string text = "x (cm),component,value (Pa),error (Pa)\n";
  for (int k = -4; k <= 4; ++k)
    text += fmt::format("{},pressure,{},\n", 2 * k, 1000 - 20 * std::abs(k));
  Output out = program("import-field " + folder.write("m.csv", text) +
                       " --dim 3 --height 0.1 --slope 33 --rho-g 15000 -o " + (folder / "f.h5"));
  ASSERT_EQ(out.code, 0) << out.err;
  const Field field = read_field(folder / "f.h5", "base");
  EXPECT_EQ(field.points.cols(), 3);
  EXPECT_DOUBLE_EQ(field.points(4, 2), -0.1);
  EXPECT_DOUBLE_EQ(field.find("sigma_zz")->value[4], -1000);
  EXPECT_TRUE(std::isnan(field.find("sigma_zz")->error[4]));
  EXPECT_EQ(program("compare " + (folder / "f.h5") + " --model cone_fpa -o " + (folder / "c")).code,
            0);
}

TEST(ImportField, WarnsOfWhatIsHardlySo) {
  const Folder folder;
  const auto told = [&](const std::string& head, double sign, const std::string& options) {
    std::string text = head + ",component,value (kPa),error (kPa)\n";
    for (int k = -6; k <= 6; ++k)
      text += fmt::format("{},pressure,{},0.02\n", 20 * k, sign * (1.0 - 0.14 * std::abs(k)));
    const Output out =
        program("import-field " + folder.write("m.csv", text) + options + " -o " + (folder / "f"));
    EXPECT_EQ(out.code, 0) << out.err;
    return out.err;
  };
  EXPECT_EQ(told("x (mm)", 1, " --height 0.08 --slope 30 --rho-g 12800"), "");
  EXPECT_THAT(told("x (mm)", 1, " --height 0.06 --slope 30 --rho-g 20000"),
              HasSubstr("warning: base: 2 of 13 places lie outside the heap, whose feet are at "
                        "-0.104 and 0.104 m: is the unit of x right, and its origin"));
  EXPECT_THAT(told("x (mm)", -1, heap_options()),
              HasSubstr("13 of 13 pressures are negative: a pressure is positive"));
  // These carry 1.07, five of its errors off, 1.28 and 0.8 of it.
  EXPECT_THAT(
      told("x (mm)", 1, " --height 0.08 --slope 30 --rho-g 12000"),
      ::testing::ContainsRegex(
          "carry 1.07 ± 0.01 of the weight above them, [67](.[0-9])? errors off: are the "
          "units, --height, --slope and --rho-g right\\? Models carry all of it. Multiply the "
          "values by 0.93[0-9]+ if their scale is in doubt, or give what was measured, "
          "--rho-g 12[0-9]+"));
  EXPECT_THAT(told("x (mm)", 1, " --height 0.08 --slope 30 --rho-g 10000"),
              HasSubstr("carry 1.28 ± 0.012 of the weight above them"));
  EXPECT_THAT(told("x (mm)", 1, " --height 0.08 --slope 30 --rho-g 16000"),
              HasSubstr("carry 0.799"));
  EXPECT_THAT(told("x (mm)", 1, " --height 0.08 --slope 30 --rho-g 4000"),
              HasSubstr("errors off: are the units"));
  // The verdict says it again.
  const std::string file = folder / "f";
  const Output out = program("fit " + file + " --model osl --model bcc -o " + (folder / "fit"));
  EXPECT_EQ(out.code, 0) << out.err;
  EXPECT_THAT(out.out,
              HasSubstr("- The pressures on the base carry 3.2 ± 0.031 of the weight above"));
  const Output compared = program("compare " + file + " --model osl -o " + (folder / "compare"));
  EXPECT_EQ(compared.code, 0) << compared.err;
  EXPECT_THAT(compared.out, HasSubstr("- The pressures on the base carry 3.2 ± 0.031"));
  EXPECT_THAT(
      std::get<std::string>(read_summary(folder / "compare/summary.json").at("verdict.doubts")),
      HasSubstr("or give what was measured, --rho-g 127"));
}

// Seven per cent of the weight decide between theories: the judge says so, with the way out.
TEST(ImportField, AWeightThatIsShortByItsErrorsIsADoubt) {
  const Folder folder;
  const auto verdict = [&](double factor, const std::string& options) {
    const Output field = program("import-field " + folder.write("m.csv", measured(7, factor)) +
                                 options + " -o " + (folder / "m.h5"));
    EXPECT_EQ(field.code, 0) << field.err;
    return program("fit " + (folder / "m.h5") + " --model osl --model bcc -o " + (folder / "f"))
        .out;
  };
  EXPECT_THAT(verdict(1, heap_options()), ::testing::Not(HasSubstr("errors off")));
  const std::string short_of = verdict(0.93, heap_options());
  EXPECT_THAT(short_of, HasSubstr("Models carry all of it. Multiply the values by "));
  // As it says.
  std::smatch found;
  ASSERT_TRUE(std::regex_search(short_of, found, std::regex("--rho-g ([0-9.]+)\\.")));
  EXPECT_THAT(verdict(0.93, heap_options(found[1])), ::testing::Not(HasSubstr("errors off")));
}

// The share that the values carry, with its error, of heaps, cones and responses.
TEST(ImportField, SaysHowMuchTheValuesCarry) {
  const Folder folder;
  const auto told = [&](const std::string& text, const std::string& options) {
    return program("import-field " + folder.write("m.csv", text) + options + " -o " +
                   (folder / "f.h5"));
  };
  // A wedge and a cone that carry what stands above: rho g times the height there.
  std::string wedge = "x (m),component,value (N/m),error (N/m)\n",
              cone = "r (m),component,value (Pa),error (Pa)\n";
  for (int k = -10; k <= 10; ++k) {
    wedge += fmt::format("{},pressure,{},10\n", 0.1 * k, 0.83 * 1000 * (1 - 0.1 * std::abs(k)));
    if (k >= 0) cone += fmt::format("{},pressure,{},10\n", 0.1 * k, 1000 * (1 - 0.1 * k));
  }
  const std::string heap = " --height 1 --slope 45 --rho-g 1000";
  Output out = told(wedge, heap);
  EXPECT_EQ(out.code, 0) << out.err;
  // sqrt(19 + 2/4) * 0.1 * 10 over 1000.
  EXPECT_THAT(out.out,
              HasSubstr("the pressures on the base carry 0.83 ± 0.0044 of the weight above them"));
  EXPECT_THAT(out.err, HasSubstr("warning: base: the pressures on the base carry 0.83"));
  out = told(cone, heap);
  EXPECT_EQ(out.code, 0) << out.err;
  EXPECT_THAT(out.out, HasSubstr("base: 11 points in space, h = 1 m"));
  EXPECT_THAT(out.out, HasSubstr("carry 1 ± 0.0"));
  EXPECT_EQ(out.err, "");
  EXPECT_DOUBLE_EQ(read_field(folder / "f.h5", "base").points(3, 0), 0.3);
  // Boussinesq's response on the depth 1: 3 F/(2 pi) (1 + r^2)^-5/2, and half of it.
  const auto response = [](double share) {
    std::string text = "r (m),z (m),component,value (Pa),error (Pa)\n";
    for (int k = 0; k <= 80; ++k) {
      const double r = 0.05 * k;
      text += fmt::format("{},-1,pressure,{},0.1\n", r,
                          share * 150 / std::numbers::pi * std::pow(1 + r * r, -2.5));
    }
    return text;
  };
  const std::string layer = " --geometry layer --height 1 --load 100";
  out = told(response(1), layer);
  EXPECT_THAT(out.out, HasSubstr("the pressures on the base carry 0.98"));
  EXPECT_THAT(out.out, HasSubstr("of the load, within 4 m of its axis"));
  EXPECT_EQ(out.err, "");
  out = told(response(0.5), layer);
  EXPECT_THAT(out.err, HasSubstr("warning: base: the pressures on the base carry 0.49"));
  EXPECT_THAT(out.err, HasSubstr("of the load, within 4 m of its axis, "));
  EXPECT_THAT(out.err, HasSubstr(" errors off: are the units, --load"));
  out = program("compare " + (folder / "f.h5") + " --model boussinesq:nu=0.3 -o " +
                (folder / "compare"));
  EXPECT_EQ(out.code, 0) << out.err;
  EXPECT_THAT(out.out, HasSubstr("- The pressures on the base carry 0.49"));
}

// The commonest table has no errors; a column of another name may be one of them.
TEST(ImportField, ATableWithoutErrors) {
  const Folder folder;
  const auto import = [&](const std::string& head) {
    std::string text = head + "\n";
    for (int k = -4; k <= 4; ++k) text += fmt::format("{},pressure,900,9\n", 20 * k);
    if (head.find("std") == std::string::npos)
      text = std::regex_replace(text, std::regex(",9\n"), "\n");
    return program("import-field " + folder.write("m.csv", text) +
                   " --height 0.08 --slope 30 --rho-g 15000 -o " + (folder / "m.h5"));
  };
  EXPECT_EQ(import("x (mm),component,value (Pa)").code, 0);
  EXPECT_THAT(import("x (mm),component,value (Pa),std (Pa)").err, HasSubstr("no column \"error\""));
}

// Heights count from the apex upwards, or from the surface of a layer.
TEST(ImportField, HeightsThatAreNotInTheHeapOrLayer) {
  const Folder folder;
  const auto refusal = [&](const char* y, const std::string& options) {
    std::string text = "x (mm),y (mm),component,value (Pa),error (Pa)\n";
    for (int k = -4; k <= 4; ++k) text += fmt::format("{},{},pressure,900,9\n", 20 * k, y);
    return program("import-field " + folder.write("m.csv", text) + options + " -o " +
                   (folder / "m.h5"))
        .err;
  };
  const std::string heap = " --height 0.08 --slope 30 --rho-g 15000",
                    layer = " --geometry layer --dim 2 --height 0.1 --load 200";
  EXPECT_THAT(
      refusal("0", heap),
      HasSubstr("8 of 9 places lie above the heap's surface, allowed: a quarter of them; y is 0 at "
                "the apex, -0.08 on the base: are heights counted from the base? y - 0.08"));
  EXPECT_THAT(refusal("20", heap), HasSubstr("9 of 9 places lie above the heap's surface"));
  EXPECT_THAT(refusal("-160", heap), HasSubstr("9 of 9 places lie below the base"));
  EXPECT_THAT(refusal("-80", heap), Not(HasSubstr("places lie")));
  EXPECT_THAT(refusal("0", layer), HasSubstr("9 of 9 places lie at or above the surface"));
  EXPECT_THAT(refusal("100", layer), HasSubstr("are heights counted from the base?"));
  EXPECT_THAT(refusal("-300", layer), HasSubstr("9 of 9 places lie below the base"));
  EXPECT_THAT(refusal("-50", layer), Not(HasSubstr("places lie")));
}

// What the file says of dimensions is not ignored, and options of the other geometry neither.
TEST(ImportField, DimensionsAndOptionsThatContradictAreSaid) {
  const Folder folder;
  const auto told = [&](const std::string& head, const std::string& options) {
    return program("import-field " + folder.write("m.csv", head + "0.1,-1,pressure,1,0.1\n") +
                   options + " -o " + (folder / "f.h5"));
  };
  const std::string z = "x (m),z (m),component,value (Pa),error (Pa)\n",
                    y = "x (m),y (m),component,value (kPa),error (kPa)\n";
  const std::string heap = " --height 1 --slope 45 --rho-g 1000";
  Output out = told(z, heap);
  EXPECT_EQ(out.code, 0) << out.err;
  EXPECT_EQ(read_field(folder / "f.h5", "base").points.cols(), 3);
  out = told(z, heap + " --dim 2");
  EXPECT_EQ(out.code, 2);
  EXPECT_THAT(out.err, HasSubstr("--dim: found 2 with the column z"));
  out = told(y, heap);
  EXPECT_THAT(out.out, HasSubstr("values in kPa are those of a long heap (2D: 1 Pa counts as 1 "
                                 "N/m); of a cone: --dim 3"));
  EXPECT_THAT(told(y, heap + " --dim 2").out, Not(HasSubstr("--dim 3")));
  out = told(y, " --geometry layer --height 1 --load 30");
  EXPECT_EQ(out.code, 2);
  EXPECT_THAT(out.err, HasSubstr("--dim: is missing, and values in kPa under a load in N are those "
                                 "of three dimensions"));
  EXPECT_EQ(told(y, " --geometry layer --height 1 --load 30 --dim 2").code, 0);
  out = told(y, " --geometry layer --height 1 --slope 30");
  EXPECT_EQ(out.code, 2);
  EXPECT_THAT(out.err, HasSubstr("found 30, allowed with --geometry heap alone"));
  out = told(y, heap + " --load 30");
  EXPECT_EQ(out.code, 2);
  EXPECT_THAT(out.err, HasSubstr("--load: found 30, allowed with --geometry layer alone"));
}

TEST(ImportField, SaysWhatIsWrongInOneLine) {
  const Folder folder;
  const auto refused = [&](const std::string& text, const std::string& options,
                           const std::string& words) {
    const Output out =
        program("import-field " + folder.write("m.csv", text) + options + " -o " + (folder / "f"));
    EXPECT_EQ(out.code, 2) << out.out;
    EXPECT_THAT(out.err, HasSubstr(words));
    EXPECT_EQ(std::count(out.err.begin(), out.err.end(), '\n'), 1) << out.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "f"));
  };
  const std::string head = "x (mm),component,value (kPa),error (kPa)\n", good = heap_options();
  std::string heavy = head;
  for (int k = -3; k <= 3; ++k) heavy += fmt::format("{},pressure,20,0.1\n", 40 * k);
  refused(heavy, good, "allowed: up to 5; correct the unit of the values, or --height");
  std::string light = "x (mm),component,value (Pa),error (kPa)\n";
  for (int k = -3; k <= 3; ++k) light += fmt::format("{},pressure,0.5,0.1\n", 40 * k);
  refused(light, good, "of the weight above them, allowed: 0.05 or more; correct the unit");
  std::string toe = head;
  for (int k = 0; k <= 12; ++k) toe += fmt::format("{},pressure,1,0.1\n", 40 * k);
  refused(toe, good,
          "9 of 13 places lie outside the heap, whose feet are at -0.139 and 0.139 m, allowed: "
          "a quarter of them; correct the unit of x, or its origin: 0 is below the apex");
  refused(head + "0,pressure,1,0.1\n", " --height '80 mm' --slope 30 --rho-g 15000 --width 2",
          "--width: found 2, allowed: above 0, up to 0.02 (a quarter of --height), in m");
  refused("position (mm),pressure (kPa)\n", good,
          "no column \"x\"; found: position, pressure; expected x (UNIT), component, value (UNIT), "
          "error (UNIT)");
  refused("r (mm),component,value (kPa),error (kPa)\n-1,pressure,1,0.1\n", good,
          "column r: found -1, allowed: 0 or more, a distance from the axis");
  refused(head + "0,pressure,1e299,1\n", good, "m.csv:2: column value: found 1e299");
  refused(head + "0,pressure,1,1e299\n", good, "m.csv:2: column error: found 1e299");
  refused("x (mm),komponent,value (kPa),error (kPa)\n", good,
          "m.csv:1: no column \"component\"; found: x, komponent, value, error; did you mean "
          "komponent");
  refused("x (mm),component,value (bar),error (kPa)\n", good,
          "m.csv:1: column value: found the unit \"bar\", allowed: Pa, kPa");
  refused("x,component,value (kPa),error (kPa)\n", good,
          "m.csv:1: column x: found no unit, expected one in brackets, such as x (cm)");
  refused(head + "1,presure,2,0.1\n", good,
          "m.csv:2: component: found \"presure\", allowed: "
          "pressure, shear, sigma_xx, sigma_yy, sigma_xy");
  refused(head + "1,pressure,2,-0.1\n", good,
          "m.csv:2: column error: found -0.1, allowed: above 0, or empty where it is unknown");
  refused(head + "1,pressure,two,0.1\n", good,
          "m.csv:2: column value (kPa) (value): found \"two\", expected a finite number");
  refused(head + "1,pressure,2,0.1\n1,pressure,3,0.1\n", good,
          "m.csv:3: pressure at x = 0.001 m is there already, at " + (folder / "m.csv") + ":2");
  refused(head, good, "m.csv: holds no value");
  refused(head, " --height 0.1 --slope 30", "--rho-g: is missing");
  refused(head, " --height 0.1 --rho-g 15000", "--left-deg: is missing; --slope sets both");
  refused(head, " --rho-g 15000 --slope 30", "--height: is missing");
  refused(head, " --rho-g 15000 --slope 30 --height 80mm",
          "--height: found \"80mm\", expected a length in m, or with its unit, \"80 mm\"");
  const std::string sloped = " --slope 30 --height '80 mm'";
  refused(head, sloped + " --rho-g '15 kg/m3'",
          "--rho-g: found \"15 kg/m3\", expected a weight per volume in N/m3 (2D: N/m2), or with "
          "its unit, \"15 kN/m3\"");
  refused(head, sloped + " --rho-g '15 kN/m2' --dim 3",
          "--rho-g: found \"15 kN/m2\", expected a weight per volume in N/m3, or with");
  refused(head, good + " --load '3 kg'",
          "--load: found \"3 kg\", expected a force in N, or with its unit, \"2 kN\"");
  refused(head, " --rho-g 15000 --height 0.1 --slope '30 m'",
          "--slope: found \"30 m\", expected an angle in degrees, or with its unit, \"0.5 rad\"");
  refused(head, good + " --hight 3", "unknown option \"--hight\"; did you mean --height");
  refused(head, good + " --geometry wege", "--geometry: found \"wege\", allowed: heap, layer");
  refused("x (mm),component,value (F/h),error (F/h)\n", good,
          "m.csv:1: found the unit \"F/h\", which needs --load");
}

}  // namespace
}  // namespace grainfield::coupling
