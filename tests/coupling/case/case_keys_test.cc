// The declarations of case keys and summary keys, and the pages generated from them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "continuum/model.h"
#include "coupling/case/keys.h"
#include "coupling/case/study.h"
#include "coupling/run/summary_keys.h"
#include "tests/coupling/program.h"
#include "tests/paths.h"

namespace grainfield::coupling {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(Keys, EveryPathIsDeclaredOnceWithMeaningUnitAndDefault) {
  std::set<std::string> seen;
  const Case defaults;
  for (const Key& key : keys()) {
    EXPECT_TRUE(seen.insert(key.path()).second) << key.path();
    EXPECT_FALSE(key.meaning.empty()) << key.path();
    EXPECT_FALSE(key.unit.empty()) << key.path();
    EXPECT_FALSE(value_text(key, defaults).empty()) << key.path();
    EXPECT_EQ(find_key(key.path()), &key);
  }
  EXPECT_GT(keys().size(), 50U);
}

TEST(Keys, TwoKeysNeverShareAMember) {
  std::set<const void*> seen;
  Case value;
  for (const Key& key : keys()) {
    const void* where = std::visit([&](auto f) -> const void* { return &f(value); }, key.where);
    EXPECT_TRUE(seen.insert(where).second) << key.path();
  }
}

TEST(Keys, EveryDefaultIsAllowed) {
  // The written-out default case of every study is valid.
  const testing::Folder folder;
  for (const Study& study : studies()) {
    Case value;
    value.study = study.name;
    value.title = "defaults";
    // The study of plastic heaps has no other models by default than layers do, and needs its own.
    if (study.name == "wedge") value.compare.models = {"fe_mohr_coulomb_wedge", "cantelaube"};
    const std::string file = folder.write(study.name + ".toml", write_case(value));
    EXPECT_NO_THROW(read_case(file, false, {})) << study.name;
  }
}

TEST(Keys, TextNamesUnitRangeAndSource) {
  const std::string text = keys_text("material");
  EXPECT_THAT(text, HasSubstr("[material]"));
  EXPECT_THAT(text, HasSubstr("friction = 0.5; pile: 0.54; pile-fields: 0.54; lattice-pile: 0.0  "
                              "(number; no unit; 0 to 10)"));
  EXPECT_THAT(text, HasSubstr("[Roul tables 5.1, 2]"));
  EXPECT_EQ(text.find("[packing]"), std::string::npos);
}

TEST(Keys, OneKeyAlone) {
  const std::string text = keys_text("fit.heights");
  EXPECT_THAT(text, HasSubstr("[fit]"));
  EXPECT_THAT(text, HasSubstr("  heights = [0.1, 0.25, 0.4]"));
  EXPECT_EQ(text.find("huber"), std::string::npos);
  EXPECT_THAT(keys_text("study"), HasSubstr("study = "));
  const std::string found = keys_text("frict");
  EXPECT_THAT(found, HasSubstr("floor_friction = "));
  EXPECT_THAT(found, HasSubstr("  friction = "));
  EXPECT_THAT(found, Not(HasSubstr("young = ")));
  try {
    keys_text("fit.hights");
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(),
                ::testing::ContainsRegex("no key 'fit.hights'; .*; did you mean fit.heights\\?"));
  }
}

TEST(Keys, OfOneStudyWithItsOwnDefaults) {
  const std::string text = keys_text("pile");
  EXPECT_THAT(text, StartsWith("study pile: grains poured into a pile"));
  EXPECT_THAT(text, HasSubstr("  study = \"pile\"  ("));
  EXPECT_THAT(text, HasSubstr("\n[heap]\n"));
  EXPECT_THAT(text, HasSubstr("  friction = 0.54  (number"));
  EXPECT_THAT(text, Not(HasSubstr("[packing]")));
  EXPECT_THAT(text, Not(HasSubstr("half_width = ")));  // of [average], not of piles
  // A study with the name of one of its sections; the section has a dot.
  EXPECT_THAT(keys_text("pair"), HasSubstr("\n[material]\n"));
  EXPECT_THAT(keys_text("pair."), StartsWith("[pair]\n"));
  EXPECT_THAT(keys_text("pair."), Not(HasSubstr("[material]")));
}

// [fit] is of heaps and of layers: each study lists its own words and keys, the key alone all.
TEST(Keys, WordsOfOneStudyAreListedWithIt) {
  const std::string heaps = keys_text("pile"), layers = keys_text("point-load");
  EXPECT_THAT(heaps, HasSubstr("hydrostatic | cantelaube_minus"));
  EXPECT_THAT(heaps, HasSubstr("cantelaube_minus; "));  // with its constants
  EXPECT_THAT(heaps, Not(HasSubstr("osl_layer_absorbing")));
  EXPECT_THAT(heaps, Not(HasSubstr("coverage_draws")));
  EXPECT_THAT(layers, HasSubstr("flamant | layer_smooth | layer_rough"));
  EXPECT_THAT(layers, HasSubstr("layer_rough (nu)"));
  EXPECT_THAT(layers, Not(HasSubstr("cantelaube_minus")));
  EXPECT_THAT(layers, Not(HasSubstr("left_deg = ")));
  const std::string both = keys_text("fit.models");
  EXPECT_THAT(both, HasSubstr("; point-load: flamant; "));
  EXPECT_THAT(both, HasSubstr("; pile: hydrostatic; "));
}

TEST(Keys, UnknownSectionNamesTheNearest) {
  try {
    keys_text("materiel");
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr("no section or study 'materiel'; sections: "));
    EXPECT_THAT(e.what(), HasSubstr("; did you mean material?"));
    EXPECT_THAT(e.what(), HasSubstr("; studies: point-load, "));
  }
}

TEST(Keys, ThePagesInDocsAreThoseOfTheDeclarations) {
  const std::string docs = std::string(GRAINFIELD_CASES) + "/../docs/";
  EXPECT_EQ(testing::read_text(docs + "keys.md"), keys_markdown())
      << "regenerate: grainfield keys --markdown > docs/keys.md";
  EXPECT_EQ(testing::read_text(docs + "summary-keys.md"), summary_keys_markdown())
      << "regenerate: grainfield keys --summary --markdown > docs/summary-keys.md";
}

// The shipped cases say it of models with finite elements (shipped.h).
TEST(SummaryKeys, EveryFigureOfAClosedModelHasAnEntry) {
  const std::map<std::string, continuum::Settings> needed{
      {"osl", {{"mu", "-0.3"}}}, {"orthotropic_layer", {{"nu_xy", "0.3"}}}};
  int figures = 0;
  for (const auto& info : continuum::registry()) {
    if (info.name.rfind("fe_", 0) == 0) continue;
    const auto settings = needed.find(info.name);
    const auto model = continuum::make_model(
        info.name, settings == needed.end() ? continuum::Settings() : settings->second);
    Eigen::MatrixXd points(1, info.dim == 3 ? 3 : 2);
    points.setConstant(-0.1);
    model->stress(points);
    for (const auto& [name, value] : model->figures()) {
      ++figures;
      EXPECT_NE(find_summary_key("model.some_label." + name), nullptr)
          << info.name << ": " << name << " in its ModelInfo";
    }
  }
  EXPECT_GT(figures, 30);
}

TEST(SummaryKeys, PatternsMatchWholeNames) {
  ASSERT_NE(find_summary_key("compare.layer_rough.base.rel_l2"), nullptr);
  EXPECT_EQ(find_summary_key("compare.layer.rel_l2")->pattern, "compare.*.rel_l2");
  EXPECT_EQ(find_summary_key("model.fe_rough.flank_jump")->pattern, "model.*.flank_jump");
  EXPECT_EQ(find_summary_key("model.fe.nobody_knows"), nullptr);
  // A star stops at a dot, unless it is that of a number.
  EXPECT_EQ(find_summary_key("fit.osl.anything.eta"), nullptr);
  EXPECT_EQ(find_summary_key("compare.osl.height_0.4.dof")->pattern, "compare.*.*.dof");
  EXPECT_EQ(find_summary_key("compare.osl.height_0.4.more.dof"), nullptr);
  EXPECT_EQ(find_summary_key("response.peak.least")->pattern, "*.least");
  EXPECT_EQ(find_summary_key("nobody.knows.least"), nullptr);
  EXPECT_EQ(find_summary_key("sweep.p_holm.dem.contacts.friction_0.3")->pattern, "sweep.p_holm.*");
  EXPECT_EQ(find_summary_key("sweep.p_holm.nobody.knows.friction_0.3"), nullptr);
  EXPECT_EQ(find_summary_key("dem.grainz"), nullptr);
  EXPECT_EQ(find_summary_key("compare..rel"), nullptr);
  EXPECT_THROW(require_documented({{"nobody.knows", 1.0}}), std::logic_error);
}

}  // namespace
}  // namespace grainfield::coupling
