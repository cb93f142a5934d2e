// `grainfield import-field`: heads, units and signs that people's tables of measured stresses have.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "coupling/tasks/measured_field.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using ::testing::Contains;
using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;

Field field_of(const Folder& folder, const std::string& text) {
  MeasuredRequest request;
  request.file = folder.write("m.csv", text);
  request.height = 0.08;
  request.left_deg = request.right_deg = 30;
  request.rho_g = 15000;
  return measured_field(request);
}

// Rows of x, component, value, error in mm and kPa: the weight above, and shears of a heap that
// pushes its floor outwards.
std::string rows(double sign = 1, const std::string& separator = ",") {
  std::string out;
  for (int x = -120; x <= 120; x += 20) {
    const double height = 0.08 * (1 - std::abs(x) / 138.6);
    out += fmt::format("{1}{0}pressure{0}{2}{0}0.02\n", separator, x, 15 * height);
    out += fmt::format("{1}{0}shear{0}{2}{0}0.02\n", separator, x,
                       sign *
                           (x < 0   ? -1
                            : x > 0 ? 1
                                    : 0) *
                           2 * height);
  }
  return out;
}

TEST(ImportFieldForms, HeadsOfOtherWritersAreTheSame) {
  const Folder folder;
  const Field plain = field_of(folder, "x (mm),component,value (kPa),error (kPa)\n" + rows());
  const std::vector<std::string> same{
      "x,component,value,error\nmm,-,kPa,kPa\n" + rows(),
      "x,component,value,error\n[mm],,[kPa],[kPa]\n" + rows(),
      "X (mm),Component,Value (kN/m²),Error (kN/m^2)\n" + rows(),
      "x [mm];component;value [kN/m2];error [kPa]\n" + rows(1, ";"),
      "x\tcomponent\tvalue\terror\nmm\t\tkPa\tkPa\n" + rows(1, "\t")};
  for (const std::string& text : same) {
    const Field field = field_of(folder, text);
    EXPECT_EQ(field.points, plain.points) << text.substr(0, 60);
    ASSERT_EQ(field.columns.size(), plain.columns.size());
    for (std::size_t k = 0; k < field.columns.size(); ++k) {
      EXPECT_EQ(field.columns[k].value, plain.columns[k].value) << text.substr(0, 60);
      EXPECT_EQ(field.columns[k].error, plain.columns[k].error) << text.substr(0, 60);
    }
  }
  const Field scaled = field_of(folder,
                                "x,component,value,error\nh,-,rho_g_h,rho_g_h\n0,pressure,1,0.1\n"
                                "0.5,pressure,0.7,0.1\n");
  EXPECT_EQ(scaled.columns[0].value[0], -1200);
}

// Pressures alone need no column that says so in every row.
TEST(ImportFieldForms, AColumnMayBeNamedByItsComponent) {
  const Folder folder;
  const std::string places[] = {"-100", "0", "100"};
  std::string two = "x (mm),component,value (kPa),error (kPa)\n",
              one = "x (mm);Pressure (kPa);error (kPa)\n";
  for (const std::string& x : places) {
    two += x + ",pressure,0.5,0.1\n";
    one += x + ";0,5;0,1\n";
  }
  const Field plain = field_of(folder, two), named = field_of(folder, one);
  ASSERT_EQ(named.columns.size(), 1U);
  EXPECT_EQ(named.columns[0].name, "sigma_yy");
  EXPECT_EQ(named.points, plain.points);
  EXPECT_EQ(named.columns[0].value, plain.columns[0].value);
  EXPECT_EQ(named.columns[0].error, plain.columns[0].error);
  EXPECT_THAT(field_of(folder, "x (mm),shear (Pa)\n-100,-30\n100,30\n").columns[0].name,
              "sigma_xy");
  const auto refused = [&](const std::string& text) -> std::string {
    try {
      field_of(folder, text);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  // Two components in one row: whose is the error?
  EXPECT_THAT(
      refused("x (mm),pressure (kPa),shear (kPa),error (kPa)\n0,1,0,0.1\n"),
      HasSubstr("no column \"value\"; found: x, pressure, shear, error; expected x (UNIT)"));
  // Words about the column have its own name.
  EXPECT_THAT(
      refused("x (mm),pressure\n0,1\n"),
      HasSubstr("column pressure: found no unit, expected one in brackets, such as pressure ("));
  EXPECT_THAT(refused("x (mm),Value (Pa),VALUE (Pa),pressure (Pa)\n0,1,2,3\n"),
              HasSubstr("no column \"value\""));
  EXPECT_THAT(refused("x (mm),pressure (kPa),sigma_xx (kPa)\n0,1,2\n"),
              HasSubstr("no column \"value\""));
  EXPECT_THAT(refused("x (mm),component,valeu (kPa)\n0,pressure,1\n"),
              HasSubstr("did you mean valeu?"));
}

TEST(ImportFieldForms, UnitsOfAnotherKindAreRefused) {
  const Folder folder;
  EXPECT_THROW(field_of(folder, "x (mm),component,value (kg),error (kPa)\n" + rows()),
               std::invalid_argument);
  EXPECT_THROW(field_of(folder, "x (kPa),component,value (kPa),error (kPa)\n" + rows()),
               std::invalid_argument);
}

// A heap spreads: its floor holds it from both sides.
TEST(ImportFieldForms, ShearOfTheOtherSignIsWarnedOf) {
  const Folder folder;
  const std::string head = "x (mm),component,value (kPa),error (kPa)\n";
  const auto warning = Contains(HasSubstr(
      "10 of 10 shear stresses (sigma_xy) are those of a heap that pulls its floor inwards"));
  EXPECT_THAT(measured_doubts(field_of(folder, head + rows(-1))), warning);
  EXPECT_THAT(measured_doubts(field_of(folder, head + rows())),
              Not(Contains(HasSubstr("pulls its floor"))));
  // Values that their errors hide have no sign.
  EXPECT_THAT(measured_doubts(field_of(folder, head + rows(-0.001))),
              Not(Contains(HasSubstr("pulls its floor"))));
}

}  // namespace
}  // namespace grainfield::coupling
