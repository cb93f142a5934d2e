// `grainfield fit` and `compare` on packings that were made elsewhere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "continuum/closed/osl.h"
#include "coupling/result/tables.h"
#include "coupling/store/field_io.h"
#include "tests/coupling/import_scene.h"
#include "tests/coupling/program.h"
#include "tests/coupling/stressed_heap.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Output;
using testing::program;

constexpr double kSlope = 28, kEta = 0.74, kMu = -0.31;

void expect_refusal(const Output& output, const std::string& words) {
  EXPECT_EQ(output.code, 2) << output.err;
  EXPECT_THAT(output.err, HasSubstr(words));
  EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
}

dem::Snapshot osl_heap(std::uint64_t seed, double floor = 0.3) {
  const auto field =
      continuum::osl_field(kSlope * std::numbers::pi / 180, {kEta, kMu}, test::lattice_rho_g());
  return test::stressed_heap({kSlope, kSlope, 0.01, 35, floor, 1.7, 0.2, seed},
                             [&](double x, double y) { return field.stress(x, y); });
}

// Four heaps as another program would hand them over, imported into one file.
std::string imported(const Folder& folder, int heaps = 4) {
  for (int k = 0; k < heaps; ++k) {
    const dem::Snapshot heap = osl_heap(static_cast<std::uint64_t>(k + 1));
    const std::string n = std::to_string(k + 1);
    const std::string files = folder.write("grains" + n + ".csv", test::csv_grains(heap)) + " " +
                              folder.write("contacts" + n + ".csv", test::csv_contacts(heap)) +
                              " " + folder.write("walls" + n + ".csv", test::csv_walls(heap));
    const Output out = program("import --from csv " + files + " --group heap_" + n + " --add -o " +
                               (folder / "heaps.h5"));
    EXPECT_EQ(out.code, 0) << out.err;
    EXPECT_THAT(out.out, HasSubstr("unbalanced force ratio: 0."));
  }
  return folder / "heaps.h5";
}

double value(const Summary& s, const std::string& key) {
  const auto at = s.find(key);
  if (at == s.end()) {
    ADD_FAILURE() << key << " is missing";
    return std::nan("");
  }
  return std::get<double>(at->second);
}

void expect_osl(const Summary& s) {
  EXPECT_NEAR(value(s, "fit.slope_deg"), kSlope, 0.7);
  EXPECT_NEAR(value(s, "fit.osl.eta"), kEta, 0.03);
  EXPECT_NEAR(value(s, "fit.osl.mu"), kMu, 0.06);
  EXPECT_LT(value(s, "fit.osl.rel_l2"), 0.04);
  EXPECT_GT(value(s, "fit.hydrostatic.chi2_per_dof"), 3 * value(s, "fit.osl.chi2_per_dof"));
  EXPECT_EQ(std::get<std::string>(s.at("verdict.best_model")), "osl");
  EXPECT_EQ(std::get<std::string>(s.at("fit.hydrostatic.supported")), "no");
}

TEST(FitCommand, ImportedHeapsGiveTheirConstantsBack) {
  const Folder folder;
  const std::string heaps = imported(folder);
  const std::string models =
      " --model osl --model hydrostatic --model cantelaube_plus --set "
      "fit.bootstrap=20 -o ";
  const Output fit = program("fit " + heaps + models + (folder / "fit"));
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.out, HasSubstr("/heap_1, "));
  EXPECT_THAT(fit.out, HasSubstr("of 4 piles at 3 heights, each in units of rho g h"));
  EXPECT_THAT(fit.out, ::testing::StartsWith(
                           "The grains support osl, none of the other 2 models (4 piles, 95 %)."));
  for (const char* file :
       {"fits.csv", "fits.md", "fits.tex", "profiles.csv", "profiles.md", "profiles.tex",
        "report.html", "summary.json", "fit.toml", "verdict.md", "verdict.tex", "verdict.json"}) {
    EXPECT_TRUE(testing::fs::exists(folder / (std::string("fit/") + file))) << file;
  }
  const Summary from_grains = read_summary(folder / "fit/summary.json");
  expect_osl(from_grains);
  EXPECT_THAT(testing::read_text(folder / "fit/fits.csv"), HasSubstr("osl,eta,-,0.7"));

  // The settings that were written give the same again.
  const Output again = program("fit " + heaps + " --case " + (folder / "fit/fit.toml") + " -o " +
                               (folder / "again"));
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(testing::read_text(folder / "fit/fits.csv"),
            testing::read_text(folder / "again/fits.csv"));

  // An average of the same heaps keeps the values of each and gives the same constants.
  const Output average = program(
      "average " + heaps + " --frame heap --width 0.02 --grid 101x31 -o " + (folder / "field.h5"));
  ASSERT_EQ(average.code, 0) << average.err;
  EXPECT_EQ(read_field(folder / "field.h5", "average").find("sigma_yy")->samples.cols(), 4);
  const Output of_field = program("fit " + (folder / "field.h5") + models + (folder / "fit2"));
  ASSERT_EQ(of_field.code, 0) << of_field.err;
  EXPECT_THAT(of_field.out, HasSubstr("of 4 piles"));
  expect_osl(read_summary(folder / "fit2/summary.json"));

  // Any models against the field: what the heap knows is filled in.
  const Output compare = program(
      "compare " + (folder / "field.h5") +
      " --model hydrostatic --model o2=osl:eta=0.74,mu=-0.31 --model peak=cantelaube:branch="
      "plus --model ife --components sigma_xx,sigma_yy,sigma_xy -o " +
      (folder / "compare"));
  ASSERT_EQ(compare.code, 0) << compare.err;
  EXPECT_THAT(compare.out,
              ::testing::StartsWith("The grains support osl, none of the other 3 models (4 piles"));
  EXPECT_THAT(fit.out, HasSubstr("| eta "));
  const Summary compared = read_summary(folder / "compare/summary.json");
  EXPECT_LT(value(compared, "compare.o2.rel_l2"), 0.05);
  EXPECT_GT(value(compared, "compare.peak.rel_l2"), value(compared, "compare.o2.rel_l2"));
  EXPECT_TRUE(std::isfinite(value(compared, "verdict.position_error")));
  EXPECT_THAT(testing::read_text(folder / "compare/profiles.csv"), Not(HasSubstr("-nan")));
  // A name that a user has given stands with the model's own in every table.
  EXPECT_THAT(testing::read_text(folder / "compare/profiles.csv"), HasSubstr(",o2_N/m,"));
  for (const char* file : {"profiles.md", "profiles.tex", "report.html"}) {
    EXPECT_THAT(testing::read_text(folder / (std::string("compare/") + file)),
                HasSubstr("o2=osl (eta=0.74, mu=-0.31)"))
        << file;
  }
  // The base itself is a height like any other, as it is for fit; what lies outside is refused.
  const Output base =
      program("compare " + (folder / "field.h5") +
              " --heights 0,0.2 --model hydrostatic --model ife -o " + (folder / "base"));
  ASSERT_EQ(base.code, 0) << base.err;
  EXPECT_THAT(testing::read_text(folder / "base/profiles.csv"), HasSubstr("sigma_yy"));
  // How many heaps would distinguish models that are not, and what another kernel says.
  const Output power = program("power " + heaps + " --model osl --model osl_yield --model bcc -o " +
                               (folder / "power"));
  ASSERT_EQ(power.code, 0) << power.err;
  EXPECT_THAT(power.out, HasSubstr("To distinguish these models from osl"));
  EXPECT_THAT(power.out, HasSubstr("piles needed"));
  expect_refusal(program("power " + heaps + " --model osl -o " + (folder / "power")),
                 "--model: found one model, allowed: two or more");
  const Output wider =
      program("fit " + heaps + models + (folder / "wider") + " --set 'fit.kernel=[1, 50]'");
  ASSERT_EQ(wider.code, 0) << wider.err;
  EXPECT_THAT(wider.out, HasSubstr("The verdict is the same at kernel widths of 1 diameters."));
  EXPECT_THAT(wider.out, HasSubstr("Kernel widths of 50 diameters leave too few values."));
  expect_refusal(program("compare " + (folder / "field.h5") + " --heights=-0.1 --model ife -o " +
                         (folder / "none")),
                 "--heights: found -0.1, allowed: 0 (the base) to 1, shares of the height");
}

TEST(FitCommand, MapsAreOfTheBestModelWhereverItIsNamed) {
  const Folder folder;
  const Output fit =
      program("fit " + imported(folder) +
              " --model hydrostatic --model osl --set fit.bootstrap=0 -o " + (folder / "fit"));
  ASSERT_EQ(fit.code, 0) << fit.err;
  const std::string page = testing::read_text(folder / "fit/report.html");
  EXPECT_THAT(page, HasSubstr("Where osl fails"));
  EXPECT_THAT(page, Not(HasSubstr("Where hydrostatic fails")));
}

TEST(FitCommand, TooFewHeapsFallBackAndSaySo) {
  const Folder folder;
  const std::string heaps = imported(folder, 2);
  const std::string models = " --model osl --model hydrostatic --width-diameters 1 -o ";
  const Output two = program("fit " + heaps + models + (folder / "two"));
  ASSERT_EQ(two.code, 0) << two.err;
  EXPECT_THAT(two.out, HasSubstr("2 piles cannot distinguish models"));
  const Output one = program("fit " + heaps + ":/heap_1" + models + (folder / "one"));
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_THAT(one.out, HasSubstr("one realization: no errors, nothing is distinguishable"));
  EXPECT_THAT(one.out, HasSubstr("One pile cannot distinguish models"));
  EXPECT_NEAR(value(read_summary(folder / "one/summary.json"), "fit.osl.eta"), kEta, 0.1);
}

TEST(FitCommand, CopiesOfAHeapAreNoRealizations) {
  const Folder folder;
  const std::string heap = folder / "heap.h5";
  dem::write_snapshot(heap, "/1/pile", osl_heap(1));
  dem::write_snapshot(heap, "/2/pile", osl_heap(2));
  testing::fs::copy_file(heap, folder / "copy.h5");
  const std::string models = " --model osl --model hydrostatic --set fit.bootstrap=0 -o ";
  const Output copied =
      program("fit " + heap + ":/1/pile " + (folder / "copy.h5") + models + (folder / "out"));
  ASSERT_EQ(copied.code, 0) << copied.err;
  EXPECT_THAT(copied.out, HasSubstr("copy.h5:/1/pile is a copy of " + heap +
                                    ":/1/pile: copies are no independent realizations"));
  EXPECT_THAT(copied.out, HasSubstr(" of 2 piles at 3 heights"));
  // The same packing named again is refused, by fit and by average.
  const std::string again = heap + ":/1/pile " + heap + ":/2/pile " + heap + ":/1/pile";
  const std::string refusal = heap + ":/1/pile: named twice";
  expect_refusal(program("fit " + again + models + (folder / "again")), refusal);
  expect_refusal(program("average " + again + " --frame heap -o " + (folder / "again.h5")),
                 refusal);

  testing::fs::copy_file(heap, folder / "second.h5");
  const std::string copies =
      heap + ":/1/pile " + (folder / "copy.h5") + ":/1/pile " + (folder / "second.h5") + ":/1/pile";
  const Output thrice = program("fit " + copies + models + (folder / "thrice"));
  ASSERT_EQ(thrice.code, 0) << thrice.err;
  EXPECT_THAT(thrice.out, HasSubstr("(likewise 1 other)"));
  EXPECT_THAT(thrice.out,
              ::testing::StartsWith("One pile cannot distinguish models: osl is nearest ("));

  expect_refusal(program("average " + heap + ":/1/pile " + (folder / "copy.h5") +
                         ":/1/pile --frame heap -o " + (folder / "f.h5")),
                 "copy.h5:/1/pile is a copy of ");
  ASSERT_EQ(program("average " + heap + ":/1/pile " + heap +
                    ":/2/pile --frame heap --width 0.02 --grid 61x31 -o " + (folder / "f.h5"))
                .code,
            0);
  // Fields that others made may hold copies all the same.
  Field twice = read_field(folder / "f.h5", "average");
  for (Column& column : twice.columns) {
    if (column.samples.size() == 0) continue;
    column.samples.conservativeResize(Eigen::NoChange, 3);
    column.samples.col(2) = Eigen::VectorXd(column.samples.col(0));
  }
  for (const char* name : {"heap.h", "rho_g_h", "left_deg", "right_deg"}) {
    auto& each = std::get<std::vector<double>>(twice.attributes.at(name));
    each.push_back(each.front());
  }
  twice.realizations = 3;
  testing::fs::remove(folder / "f.h5");
  write_fields(folder / "f.h5", {{"average", twice}});
  const Output field = program("fit " + (folder / "f.h5") + models + (folder / "field"));
  ASSERT_EQ(field.code, 0) << field.err;
  EXPECT_THAT(field.out, HasSubstr("ealization 3 of "));
  EXPECT_THAT(field.out, HasSubstr(" of 2 piles"));
}

TEST(FitCommand, RefusesWithOneLine) {
  const Folder folder;
  const std::string heap = folder / "heap.h5", out = " -o " + (folder / "out");
  dem::write_snapshot(heap, "/pile", osl_heap(1));
  expect_refusal(program("fit " + heap + " --model jansen" + out),
                 "--model: fit.models: found \"jansen\"");
  expect_refusal(program("fit " + heap + " --set material.friction=1" + out), "allowed: fit");
  expect_refusal(
      program("fit " + heap + " --set fit.heights=20,40" + out),
      "fit.heights: found \"20,40\" (text), expected a list of numbers, written [0.2, 0.4]");
  expect_refusal(program("fit " + heap + " --heights 1.5" + out), "fit.heights: found 1.5");
  expect_refusal(program("fit " + heap + " --heights 0.98" + out), "fit.heights: found 0 values");
  expect_refusal(program("fit " + heap +
                         " --model cantelaube_asymmetric_zero --set "
                         "fit.friction_deg=10" +
                         out),
                 "fit.friction_deg: found 10");
  expect_refusal(program("fit " + (folder / "none.h5") + out), "none.h5");
  expect_refusal(program("fit " + heap + ":/none" + out),
                 "grainfield: " + heap + ":/none: no snapshot there");

  dem::Snapshot few = osl_heap(1);
  few.grains.resize(9);
  std::erase_if(few.contacts, [](const dem::Contact& c) { return c.i > 8 || c.j > 8; });
  dem::write_snapshot(folder / "few.h5", "/pile", few);
  expect_refusal(program("fit " + (folder / "few.h5") + out), "fit.left_deg");

  dem::Snapshot tilted = osl_heap(1);
  tilted.gravity = {1, -9.7, 0};
  dem::write_snapshot(folder / "tilted.h5", "/pile", tilted);
  expect_refusal(program("fit " + (folder / "tilted.h5") + out), "found gravity (1, -9.7)");
  tilted.contacts.clear();
  dem::write_snapshot(folder / "loose.h5", "/pile", tilted);
  expect_refusal(program("fit " + (folder / "loose.h5") + out), "has no contacts");

  dem::Snapshot solid = osl_heap(1);
  solid.dim = 3;
  for (auto& g : solid.grains) g.moments.setConstant(1e-6);
  dem::write_snapshot(folder / "solid.h5", "/pile", solid);
  const Output solid_fit = program("fit " + (folder / "solid.h5") + out);
  expect_refusal(solid_fit, "is 3D");
  EXPECT_THAT(solid_fit.err, HasSubstr("`grainfield compare FIELD.h5 --model cone_osl"));

  dem::write_snapshot(folder / "steps.h5", "/step_1", osl_heap(1));
  dem::write_snapshot(folder / "steps.h5", "/step_2", osl_heap(1));
  expect_refusal(program("fit " + (folder / "steps.h5") + out), "time steps of one packing");
  dem::write_snapshot(folder / "layer.h5", "/a/loaded", osl_heap(1));
  dem::write_snapshot(folder / "layer.h5", "/a/unloaded", osl_heap(1));
  expect_refusal(program("fit " + (folder / "layer.h5") + out), "holds loaded layers");

  const std::string average = "average " + heap + " --grid 41x21 ";
  ASSERT_EQ(program(average + "--frame heap --quantities density -o " + (folder / "f.h5")).code, 0);
  expect_refusal(program("fit " + (folder / "f.h5") + out),
                 "has no column sigma_xx, sigma_yy, sigma_xy");
  ASSERT_EQ(program(average + "--frame packing -o " + (folder / "p.h5")).code, 0);
  expect_refusal(program("fit " + (folder / "p.h5") + out), "needed: that of a heap");
  expect_refusal(program("compare " + (folder / "p.h5") + " --model hydrostatic" + out),
                 "--origin X,Y");
  ASSERT_EQ(program(average + "--frame heap -o " + (folder / "h.h5")).code, 0);
  expect_refusal(program("compare " + (folder / "h.h5") + " --model flamant" + out),
                 "needs the load F");
  expect_refusal(program("fit " + (folder / "h.h5") + " " + heap + out), "a field is fitted alone");
  EXPECT_FALSE(testing::fs::exists(folder / "out"));
}

}  // namespace
}  // namespace grainfield::coupling
