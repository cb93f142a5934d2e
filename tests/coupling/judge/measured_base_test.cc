// Measured base forces beside those of piles (Liffman fig. 17), and the lines of largest and
// smallest force (figures 10 and 16).
#include "coupling/run/measured_base.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "coupling/report/force_lines.h"
#include "coupling/result/tables.h"
#include "coupling/run/summary_keys.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;

double figure(const Summary& s, const std::string& key) {
  const auto at = s.find(key);
  if (at == s.end()) {
    ADD_FAILURE() << key << " is missing";
    return std::nan("");
  }
  if (const auto* whole = std::get_if<std::int64_t>(&at->second)) return *whole;
  return std::get<double>(at->second);
}

// What hard disks of an equilateral pile of 9 layers exert, N = 5 m g and H = m g (2i - 10)/(2 sqrt
// 3), as another laboratory might give it: its own length and unit of force, errors of 5 %.
std::string table(double dip) {
  std::string out = "x (mm),component,value (kPa),error (kPa)\n";
  for (int i = 1; i <= 9; ++i) {
    const double x = (i - 5) * 100.0 / 9, n = 5 * (i == 5 ? 1 - dip : 1);
    const double h = (2 * i - 10) / (2 * std::numbers::sqrt3);
    out += fmt::format("{},pressure,{},{}\n{},shear,{},{}\n", x, 3 * n, 0.75, x, 3 * h, 0.3);
  }
  return out;
}

std::string field_of(const Folder& folder, double dip) {
  const std::string file = folder / fmt::format("m{:g}.h5", dip);
  const Output out = program("import-field " + folder.write("m.csv", table(dip)) +
                             " --height 0.0866 --slope 60 --rho-g 300000 --width 0.002 -o " + file);
  EXPECT_EQ(out.code, 0) << out.err;
  return file;
}

constexpr const char* kPile = R"(study = "lattice-pile"
[lattice]
base_grains = 9
[ensemble]
realizations = 1
)";

TEST(MeasuredBase, StandsBesideTheGrainsInUnitsOfItsOwn) {
  const Folder folder;
  const std::string file = folder.write(
      "x.toml", std::string(kPile) + "[measured]\nfield = \"" + field_of(folder, 0) + "\"\n");
  const Output out = program("run " + file + " -o " + (folder / "out"));
  ASSERT_EQ(out.code, 0) << out.err;
  const Summary s = read_summary(folder / "out/summary.json");
  EXPECT_NO_THROW(require_documented(s));
  EXPECT_EQ(figure(s, "measured.places"), 9);
  EXPECT_LT(figure(s, "measured.normal_rms"), 2e-3);
  EXPECT_LT(figure(s, "measured.shear_rms"), 3e-3);
  EXPECT_LT(figure(s, "measured.normal_chi2"), 1e-2);
  EXPECT_LT(figure(s, "measured.shear_chi2"), 1e-2);
  EXPECT_NEAR(figure(s, "measured.normal_centre"), 1, 1e-12);
  EXPECT_NEAR(figure(s, "measured.shear_slope_ratio"), 1, 5e-3);
  EXPECT_NEAR(figure(s, "measured.shear_explained"), 1, 1e-9);
  EXPECT_NEAR(figure(s, "liffman.normal_centre"), 1, 2e-3);
  EXPECT_NEAR(figure(s, "liffman.horizontal_explained"), 1, 1e-4);
  EXPECT_NEAR(figure(s, "liffman.horizontal_slope"), 1, 1e-3);
  const std::string page = testing::read_text(folder / "out/report.html");
  for (const char* title :
       {"Beside the measurement", "Lines of maximum force", "Lines of minimum force"}) {
    EXPECT_THAT(page, HasSubstr(title));
  }
  // A dip that the grains do not have.
  const Output dip = program("run " + file + " -o " + (folder / "dip") +
                             " --set measured.field=" + field_of(folder, 0.3));
  ASSERT_EQ(dip.code, 0) << dip.err;
  const Summary with = read_summary(folder / "dip/summary.json");
  EXPECT_NEAR(figure(with, "measured.normal_centre"), 0.7, 1e-9);
  EXPECT_NEAR(figure(with, "measured.normal_rms"), 0.1, 5e-3);  // 0.3 at one of nine places
  EXPECT_NEAR(figure(with, "measured.normal_chi2"), 4, 0.4);    // (0.3/0.05)^2 at one of nine
}

TEST(MeasuredBase, StandsBesideAPouredPile) {
  const Folder folder;
  const std::string file = folder.write("x.toml", R"(study = "pile"
[shape]
kind = "disk"
[floor]
kind = "rough"
length = 0.5
[source]
grains = 40
above = 2
interval = 0.1
[material]
rolling_friction = 0.2
rolling_stiffness = 1e6
rolling_damping = 10
[rest]
unbalanced_force_ratio = 1e-3
kinetic_to_elastic_energy = 1e-3
[ensemble]
realizations = 8
[output]
fields = false
[measured]
field = ")" + field_of(folder, 0) + "\"\n");
  const Output out = program("run " + file + " -o " + (folder / "out"));
  ASSERT_EQ(out.code, 0) << out.err;
  const Summary s = read_summary(folder / "out/summary.json");
  EXPECT_NO_THROW(require_documented(s));
  EXPECT_EQ(figure(s, "measured.places"), 9);
  EXPECT_GT(figure(s, "measured.normal_rms"), 0.02);
  EXPECT_LT(figure(s, "measured.normal_rms"), 1);
  EXPECT_GT(figure(s, "measured.shear_slope_ratio"), 0);
  EXPECT_THAT(testing::read_text(folder / "out/report.html"), HasSubstr("Beside the measurement"));
}

TEST(MeasuredBase, MistakesAreNamed) {
  const Folder folder;
  const auto refusal = [&](const std::string& more) {
    const Output out = program("check " + folder.write("x.toml", std::string(kPile) + more));
    EXPECT_EQ(out.code, 2) << more;
    return out.err;
  };
  EXPECT_THAT(refusal("[measured]\nfield = \"none.h5\"\n"), HasSubstr("measured.field: none.h5"));
  EXPECT_THAT(refusal("[measured]\nfield = \"" + field_of(folder, 0) + "\"\nname = \"floor\"\n"),
              HasSubstr("floor"));
  const std::string few = folder / "few.h5";
  ASSERT_EQ(program("import-field " +
                    folder.write("few.csv",
                                 "x (mm),component,value (kPa),error (kPa)\n0,pressure,1,\n"
                                 "0,shear,0,\n5,pressure,1,\n") +
                    " --height 0.08 --slope 30 --rho-g 15000 -o " + few)
                .code,
            0);
  EXPECT_THAT(
      refusal("[measured]\nfield = \"" + few + "\"\n"),
      HasSubstr("has 1 places on the base with a pressure and a shear, allowed: 5 or more"));
}

// The line model's shear at 32.6 degrees is straight up to its bend at 0.184 of the base; a
// window that ends before it sees nothing but a line, whatever comes after.
TEST(MeasuredBase, TheMiddleOfTheShearEndsBeforeItsBend) {
  BaseProfile base;
  const double tangent = std::tan(32.6 * std::numbers::pi / 180);
  const double bend = tangent / 2 / std::numbers::sqrt3;
  base.height = tangent / 2;
  base.x = Eigen::VectorXd::LinSpaced(181, -0.5, 0.5);
  base.normal = Eigen::VectorXd::Ones(181);
  base.shear = base.x.unaryExpr([&](double x) {
    return std::fabs(x) < bend ? x / bend : std::copysign((0.5 - std::fabs(x)) / (0.5 - bend), x);
  });
  EXPECT_NEAR(middle_shear(base).explained, 1, 1e-12);
  EXPECT_NEAR(middle_shear(base).slope * base.shear.maxCoeff(), 1 / bend, 1e-9);
  base.height = 1;
  EXPECT_LT(middle_shear(base).explained, 0.97);
  // A low heap of few places: five of them, all on the line but the outermost two.
  base.height = 0.05;
  base.x = Eigen::VectorXd::LinSpaced(9, -0.5, 0.5);
  base.shear = base.x;
  base.shear[0] = base.shear[8] = 0;
  EXPECT_NEAR(middle_shear(base).slope * base.shear.maxCoeff(), 1, 1e-12);
}

// Three grains in a row on two walls' worth of forces: of 3 > 2 > 1 N the first is the strongest of
// two grains, the last the weakest of two.
TEST(ForceLines, AreTheStrongestAndWeakestContactsOfEachGrain) {
  dem::Snapshot s;
  s.grains.resize(4);
  const auto contact = [&](int i, int j, double force, double nx, double ny) {
    dem::Contact c;
    c.i = i;
    c.j = j;
    c.normal_force = force;
    c.normal = {nx, ny, 0};
    s.contacts.push_back(c);
  };
  contact(0, -1, 9, 0, -1);
  contact(0, 1, 3, 0.5, std::sqrt(0.75));
  contact(1, 2, 2, 0.5, -std::sqrt(0.75));
  contact(2, 3, 1, 1, 0);
  contact(0, 3, 0, 1, 0);  // touches without force
  EXPECT_EQ(extreme_contacts(s, Extreme::strongest), (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_EQ(extreme_contacts(s, Extreme::weakest), (std::vector<std::size_t>{1, 2, 3}));
  contact(1, 3, 0.5, 1, 0);
  EXPECT_EQ(extreme_contacts(s, Extreme::strongest), (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_EQ(extreme_contacts(s, Extreme::weakest), (std::vector<std::size_t>{1, 3, 5}));
  EXPECT_NEAR(horizontal_share(s, {1, 3, 5}), 2.0 / 3, 1e-15);
  EXPECT_EQ(horizontal_share(s, {}), 0);
}

}  // namespace
}  // namespace grainfield::coupling
