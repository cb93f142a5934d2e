// What a run fills into the settings of its models.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/models/evaluate_model.h"

namespace grainfield::coupling {
namespace {

using ::testing::HasSubstr;

RunFacts heap_facts(double left, double right) {
  RunFacts out;
  out.height = out.depth = 0.2;
  out.numbers = {
      {"rho_g", 4000}, {"phi_deg", (left + right) / 2}, {"left_deg", left}, {"right_deg", right}};
  return out;
}

TEST(FilledModels, HeapsGetWhatWasMeasured) {
  for (const char* name : {"cantelaube", "osl", "fpa", "bcc", "ife"}) {
    const auto s = filled_settings({name, name, {}}, heap_facts(27, 29));
    EXPECT_EQ(s.at("phi_deg"), "28") << name;
    EXPECT_EQ(s.at("rho_g"), "4000") << name;
    EXPECT_NO_THROW(continuum::make_model(name, s));
  }
  const auto s = filled_settings({"hydrostatic", "hydrostatic", {}}, heap_facts(27, 29));
  EXPECT_EQ(s, (continuum::Settings{{"rho_g", "4000"}, {"left_deg", "27"}, {"right_deg", "29"}}));
}

TEST(FilledModels, TheUsersSettingsHold) {
  const auto s =
      filled_settings({"x", "osl", {{"phi_deg", "30"}, {"mu", "0"}}}, heap_facts(27, 29));
  EXPECT_EQ(s.at("phi_deg"), "30");
  EXPECT_EQ(s.at("mu"), "0");
  EXPECT_EQ(s.count("eta"), 0U);
}

TEST(FilledModels, FrictionIsAtLeastTheSteeperSlope) {
  const ModelChoice choice{"two", "cantelaube_asymmetric", {}};
  for (const auto& facts : {heap_facts(31, 22), heap_facts(22, 31)}) {
    const auto s = filled_settings(choice, facts);
    EXPECT_EQ(s.at("phi_deg"), "31");
    EXPECT_NO_THROW(continuum::make_model(choice.name, s));
  }
  // Not what the user said.
  const ModelChoice given{"two", "cantelaube_asymmetric", {{"phi_deg", "33"}}};
  EXPECT_EQ(filled_settings(given, heap_facts(31, 22)).at("phi_deg"), "33");
  const ModelChoice slope{"two", "cantelaube_asymmetric", {{"left_deg", "35"}}};
  EXPECT_EQ(filled_settings(slope, heap_facts(31, 22)).at("phi_deg"), "35");
}

TEST(FilledModels, NothingIsGuessedOnAHeapTooSmallToMeasure) {
  const RunFacts facts = heap_facts(std::nan(""), std::nan(""));
  try {
    filled_settings({"mine", "bcc", {}}, facts);
    ADD_FAILURE();
  } catch (const continuum::BadParameter& e) {
    EXPECT_THAT(e.what(), HasSubstr("model bcc: phi_deg cannot be measured on this heap"));
    EXPECT_THAT(e.what(), HasSubstr("set it in [model.mine]"));
  }
  EXPECT_NO_THROW(filled_settings({"mine", "bcc", {{"phi_deg", "28"}}}, facts));
  const continuum::Settings level{{"left_deg", "0"}, {"right_deg", "0"}};
  EXPECT_NO_THROW(filled_settings({"mine", "hydrostatic", level}, facts));
}

TEST(FilledModels, TheBaseOnlyWhereItsWordIsKnown) {
  RunFacts facts;
  facts.force = 3;
  facts.height = 0.5;
  facts.base = "rough";
  EXPECT_EQ(filled_settings({"layer", "layer", {}}, facts).at("base"), "rough");
  const auto s = filled_settings({"osl_layer", "osl_layer", {}}, facts);
  EXPECT_EQ(s.count("base"), 0U);
  EXPECT_EQ(s.at("F"), "3");
  EXPECT_EQ(s.at("h"), "0.5");
}

}  // namespace
}  // namespace grainfield::coupling
