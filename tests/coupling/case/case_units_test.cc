// Numbers with units in case files and settings.
#include <gmock/gmock.h>

#include "coupling/case/units.h"
#include "tests/coupling/check_scene.h"

namespace grainfield::coupling {
namespace {

using testing::accepted;
using testing::complaint;
using ::testing::HasSubstr;

TEST(CaseUnits, HaveTheBitsOfTheNumberInSi) {
  const std::vector<std::pair<std::string, double>> expected = {
      {"3.6 mm", 0.0036},   {"1.5 cm", 0.015},   {"10 MPa", 1e7},      {"0.7 kPa", 700},
      {"2.5 g/cm3", 2500},  {"9.81 m/s2", 9.81}, {"12 kN/m", 12000},   {"5 1/ms", 5000},
      {"1.7e2 um", 1.7e-4}, {"3 N mm", 3e-3},    {"45 deg", 45},       {"20 ms", 0.02},
      {"7 kg/m2", 7},       {"1 mm^2", 1e-6},    {"0.3 mN s/m", 3e-4}, {"-4 km", -4000},
  };
  for (const auto& [text, value] : expected) {
    const auto measure = parse_measure(text);
    ASSERT_TRUE(measure.has_value()) << text;
    EXPECT_EQ(measure->value, value) << text;
  }
  EXPECT_NEAR(parse_measure("0.5 rad")->value, 28.64788975654116, 1e-13);
}

TEST(CaseUnits, OtherTextsHaveNone) {
  for (const char* text :
       {"", "3", "mm", "3 inch", "3mm", "3 /s", "3 m/s/s", "x mm", "3 mm2x", "nan"}) {
    EXPECT_FALSE(parse_measure(text).has_value()) << text;
  }
}

TEST(CaseUnits, EveryUnitOfTheKeysIsUnderstood) {
  int units = 0;
  for (const Key& key : keys()) {
    const UnitKinds kinds = kinds_of(key.unit);
    EXPECT_NE(kinds.plane, "") << key.path() << ": " << key.unit;
    EXPECT_NE(kinds.space, "") << key.path() << ": " << key.unit;
    units += key.unit != "-";
  }
  EXPECT_GT(units, 50);
}

TEST(CaseUnits, ACaseInMillimetresIsTheOneInMetres) {
  const std::string head = "study = \"point-load\"\n[packing]\n";
  const Case metres = accepted(head +
                               "radius_min = 0.0036\nradius_max = 0.0054\nwidth = 0.6\n[load]\n"
                               "force = 10\n[material]\ngravity = 9.81\n");
  const Case millimetres =
      accepted(head +
               "radius_min = \"3.6 mm\"\nradius_max = \"5.4 mm\"\nwidth = \"60 cm\"\n[load]\n"
               "force = \"0.01 kN\"\n[material]\ngravity = \"9.81 m/s2\"\n");
  EXPECT_EQ(write_case(metres), write_case(millimetres));
  const Case set = accepted(head, {"packing.width=600 mm", "packing.radius_min=3.6 mm"});
  EXPECT_EQ(value_text(*find_key("packing.width"), set), "0.6");
}

TEST(CaseUnits, ThereIsNoUnitOfTheWholeCase) {
  const std::string words =
      ": unknown: numbers are in SI units, and a value in another carries it, as in radius = "
      "\"3.6 mm\"";
  EXPECT_EQ(complaint("units = \"mm\"\n"), "x.toml:1: units" + words);
  EXPECT_EQ(complaint("study = \"point-load\"\n[units]\nlength = \"mm\"\n"),
            "x.toml:3: units" + words);
}

TEST(CaseUnits, AnotherKindIsRefused) {
  const std::string head = "study = \"point-load\"\n[packing]\n";
  EXPECT_THAT(complaint(head + "width = \"3 kPa\"\n"),
              HasSubstr("packing.width: found \"3 kPa\", expected a number in m, or with a unit of "
                        "that kind"));
  EXPECT_THAT(complaint(head + "width = \"3 inch\"\n"),
              HasSubstr("packing.width: found \"3 inch\", expected a number in m, or with a unit "
                        "(m g s N Pa J Hz rad deg, with n u m c d k M G before; a blank before "
                        "both, as in \"3.6 mm\")"));
  EXPECT_THAT(complaint(head + "width = \"4mm\"\n"), HasSubstr("found \"4mm\", expected"));
  EXPECT_THAT(complaint(head + "width = \"wide\"\n"), HasSubstr("expected a number"));
  EXPECT_THAT(complaint("study = \"point-load\"\n[material]\nfriction = \"0.5 m\"\n"),
              HasSubstr("expected a number without unit"));
  // Stiffness of grains in the plane is N/m.
  EXPECT_THAT(complaint("study = \"point-load\"\n[material]\nyoung = \"10 MPa\"\n"),
              HasSubstr("material.young: found \"10 MPa\" for grains in two dimensions, expected a "
                        "number in N/m (3D: Pa)"));
  EXPECT_EQ(complaint("study = \"point-load\"\n[material]\nyoung = \"10 MN/m\"\n"), "");
  const std::string space = std::string(GRAINFIELD_CASES) + "/point-load-3d.toml";
  EXPECT_EQ(testing::complaint_of(space, {"material.young=20 MPa"}), "");
  EXPECT_THAT(testing::complaint_of(space, {"material.young=20 MN/m"}),
              HasSubstr("for grains in three dimensions"));
}

}  // namespace
}  // namespace grainfield::coupling
