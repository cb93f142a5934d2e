// Every name that a fit prints is a model of every command.
#include "coupling/models/fit_names.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "continuum/settings.h"
#include "coupling/fit/heap_models.h"
#include "coupling/fit/layer_models.h"
#include "coupling/models/evaluate_model.h"
#include "coupling/models/parse_choices.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;

TEST(FitNames, AreTheRegistrysWithTheSettingsOfTheFit) {
  HeapFacts facts;
  facts.slope_deg = facts.left_deg = facts.right_deg = 28;
  std::vector<RegistryEntry> all = heap_entries(facts);
  for (const RegistryEntry& entry : layer_entries()) all.push_back(entry);
  ASSERT_GT(all.size(), 20U);
  for (const RegistryEntry& entry : all) {
    const FitName* known = find_fit_name(entry.name);
    if (entry.registry.empty()) continue;  // a description
    if (known == nullptr) {
      EXPECT_EQ(entry.name, entry.registry);
      continue;
    }
    const std::string needed = known->needs.empty() ? "" : ":" + known->needs + "=30";
    const ModelChoice choice = parse_choice(entry.name + needed);
    EXPECT_EQ(choice.label, entry.name);
    EXPECT_EQ(choice.name, entry.registry);
    continuum::Settings fixed = choice.settings;
    fixed.erase(known->needs);
    const continuum::Settings whole =
        continuum::complete(continuum::find_model(entry.registry), entry.fixed);
    for (const auto& [name, value] : fixed) EXPECT_EQ(whole.at(name), value) << entry.name;
    EXPECT_EQ(model_label(choice), known->needs.empty()
                                       ? entry.name
                                       : fmt::format("{} ({}=30)", entry.name, known->needs));
  }
}

TEST(FitNames, EveryCommandTakesThem) {
  const Folder folder;
  std::string table = "x (m),component,value (Pa),error (Pa)\n";
  for (int k = -6; k <= 6; ++k) {
    table += fmt::format("{},pressure,{},20\n", 0.02 * k, 1200 - 130 * std::abs(k));
  }
  const std::string field = folder / "m.h5";
  ASSERT_EQ(program("import-field " + folder.write("m.csv", table) +
                    " --height 0.08 --slope 28 --rho-g 15000 -o " + field)
                .code,
            0);
  const Output compared =
      program("compare " + field + " --model cantelaube_minus,cantelaube_plus " +
              "--model cantelaube_continuous:beta_hat_deg=40 -o " + (folder / "c"));
  ASSERT_EQ(compared.code, 0) << compared.err;
  EXPECT_THAT(compared.out, HasSubstr("| cantelaube_minus "));
  EXPECT_THAT(compared.out, HasSubstr("| cantelaube_continuous (beta_hat_deg=40) "));
  const std::string points = folder.write("p.csv", "x,y\n0,-0.5\n0.2,-0.7\n");
  const auto evaluated = [&](const std::string& model) {
    const Output out = program("model " + model + " --points " + points);
    EXPECT_EQ(out.code, 0) << out.err;
    return out.out;
  };
  EXPECT_EQ(evaluated("cantelaube_plus"), evaluated("cantelaube --set branch=plus"));
  EXPECT_NE(evaluated("cantelaube_plus"), evaluated("cantelaube"));
  EXPECT_EQ(program("check point-load-mono --set 'compare.models=[\"layer_rough\"]'").code, 0);
  for (const auto& [arguments, words] : std::vector<std::pair<std::string, std::string>>{
           {"cantelaube_continuous", "beta_hat_deg is missing, which `grainfield fit` finds"},
           {"cantelaube_plus:branch=minus", "the name says plus; write cantelaube:branch=minus"},
           {"cantelaube_asymmetric_flanks", "is a description with numbers that only"}}) {
    const Output out =
        program("compare " + field + " --model " + arguments + " -o " + (folder / "none"));
    EXPECT_EQ(out.code, 2);
    EXPECT_THAT(out.err, HasSubstr(words));
  }
}

}  // namespace
}  // namespace grainfield::coupling
