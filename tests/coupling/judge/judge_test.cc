// The judge on made evidence: what it concludes, what is said, and how many realizations more.
#include "coupling/judge/judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/algorithm/string/split.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>

#include "coupling/judge/power.h"
#include "coupling/judge/words.h"
#include "coupling/result/judgement.h"
#include "coupling/result/text_table.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr int kValues = 12;

Candidate candidate(const std::string& name, double value, int free = 0) {
  Candidate out;
  out.model.name = out.model.label = name;
  out.model.free = free;
  out.model.misfit = 1;
  out.model.chance = 2;
  out.model.rel_l2 = std::fabs(value - 1);
  out.forecast = Eigen::MatrixXd::Constant(kValues, 1, value);
  return out;
}

// Realizations about 1.
Evidence evidence(int realizations, double noise, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Evidence out;
  out.samples.resize(kValues, realizations);
  for (double& v : out.samples.reshaped()) v = 1 + noise * normal(random);
  out.errors_from = ErrorsFrom::realizations;
  out.realizations = realizations;
  return out;
}

std::size_t words_in(const std::string& text) {
  std::vector<std::string> words;
  boost::split(words, text, [](char c) { return c == ' '; });
  return words.size();
}

TEST(Judge, NamesTheFewestFreeNumbersOfThoseThatCannotBeDistinguished) {
  const Judgement j = judge(evidence(8, 0.1), {candidate("rich", 1, 2), candidate("poor", 1.001, 0),
                                               candidate("wrong", 1.5, 0)});
  EXPECT_EQ(j.best, "poor");
  EXPECT_EQ(j.find("rich")->distinguishable, Answer::no);
  EXPECT_EQ(j.find("wrong")->distinguishable, Answer::yes);
  EXPECT_EQ(j.distinguishable, Answer::no);
  EXPECT_THAT(headlines(j).front(), HasSubstr(" and "));
  EXPECT_THAT(headlines(j).front(), HasSubstr("cannot be distinguished (8 realizations, 95 %)"));
}

TEST(Judge, AModelThatContainsTheBestDoesNotOutbidIt) {
  Candidate rich = candidate("rich", 1, 2);
  rich.model.special_cases = {"poor"};
  const Judgement j =
      judge(evidence(8, 0.1), {rich, candidate("poor", 1.001), candidate("wrong", 1.5)});
  EXPECT_EQ(j.best, "poor");
  EXPECT_EQ(j.distinguishable, Answer::yes);
  EXPECT_EQ(headlines(j).front(), "The grains support poor, not wrong (8 realizations, 95 %).");
  EXPECT_EQ(j.find("rich")->supported(), Answer::yes);
  // It alone agrees.
  Candidate poor = candidate("poor", 1.001);
  poor.model.misfit = 3;
  EXPECT_EQ(headlines(judge(evidence(8, 0.1), {rich, poor, candidate("wrong", 1.5)})).front(),
            "The grains support rich (8 realizations, 95 %); 1 more cannot be distinguished, but "
            "does not agree.");
}

// The first line names one set of models: those that the table calls supported.
TEST(Judge, SupportedModelsAreNamedAlone) {
  std::vector<Candidate> all;
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
    all.push_back(candidate(name, 1.001 + 1e-4 * static_cast<double>(all.size())));
  }
  for (std::size_t k = 3; k < all.size(); ++k) all[k].model.misfit = 3;  // these do not agree
  for (const char* name : {"x", "y", "z"}) all.push_back(candidate(name, 1.6));
  Judgement j = judge(evidence(8, 0.1), all);
  for (const JudgedModel& m : j.models) {
    EXPECT_EQ(m.supported(),
              std::string("abc").find(m.name) != std::string::npos ? Answer::yes : Answer::no)
        << m.name;
  }
  const std::string line = headlines(j).front();
  EXPECT_THAT(line, StartsWith("The grains support "));
  EXPECT_THAT(line, ::testing::EndsWith(", which cannot be distinguished (8 realizations, 95 %)."));
  EXPECT_THAT(line, ::testing::Not(::testing::ContainsRegex("more|worse|other")));
  EXPECT_THAT(agreement_line(j), StartsWith("6 of the models agree within the errors, 3 "
                                            "supported: "));
  // A description that agrees is no model.
  Candidate description = candidate("d1", 1.0001, 7);
  description.model.description = true;
  all.push_back(description);
  EXPECT_THAT(agreement_line(judge(evidence(8, 0.1), all)),
              StartsWith("6 of the models and the description d1 agree within the errors, 3 "
                         "supported: "));
  all.push_back(description);
  all.back().model.name = "d2";
  EXPECT_THAT(agreement_line(judge(evidence(8, 0.1), all)),
              StartsWith("6 of the models and 2 descriptions agree within the errors, "));
  all.resize(all.size() - 2);
  const std::vector<Candidate> alone{description};
  EXPECT_THAT(agreement_line(judge(evidence(8, 0.1), alone)),
              StartsWith("The description d1 agrees within the errors: misfit 1, "));
  std::vector<Candidate> poor{candidate("x", 1.1), description};
  poor[0].model.misfit = 3;
  EXPECT_THAT(agreement_line(judge(evidence(8, 0.1), poor)),
              StartsWith("No model agrees within the errors, only the description d1: the misfit "
                         "of x is 3, "));
  // One agrees, and the rest of those that cannot be distinguished do not.
  for (std::size_t k = 1; k < all.size(); ++k) all[k].model.misfit = 3;
  j = judge(evidence(8, 0.1), all);
  EXPECT_EQ(headlines(j).front(),
            "The grains support a (8 realizations, 95 %); 5 more cannot be distinguished, but do "
            "not agree.");
}

TEST(Judge, TellsEquationsOfWhatIsLeft) {
  std::vector<Candidate> all{candidate("a", 1), candidate("b", 1.0005), candidate("c", 1.5)};
  all[0].model.equations = "elliptic";
  all[1].model.equations = "hyperbolic";
  all[2].model.equations = "hyperbolic";
  EXPECT_EQ(judge(evidence(8, 0.1), all).equations, "not distinguishable");
  all[1].model.equations = "elliptic";
  EXPECT_EQ(judge(evidence(8, 0.1), all).equations, "elliptic");
  Evidence one = evidence(1, 0.1);
  one.errors_from = ErrorsFrom::nothing;
  EXPECT_EQ(judge(one, all).equations, "not distinguishable");
}

TEST(Judge, WhatDisagreesIsNearerAndNotSupported) {
  std::vector<Candidate> all{candidate("half plane", 1.5), candidate("finite layer", 1.1)};
  for (Candidate& c : all) c.model.misfit = 3.7;
  for (Candidate& c : all) c.model.chance = 3.3;
  const Judgement j = judge(evidence(16, 0.05), all);
  EXPECT_EQ(j.find("finite layer")->supported(), Answer::no);
  EXPECT_EQ(
      sentence(j),
      "The finite layer is nearer to the grains than the half plane (16 realizations, 95 %). No "
      "model agrees within the errors: the misfit of finite layer is 3.7, and a true model "
      "exceeds 3.3 in 1 of 100 ensembles.");
}

// Every kind of first line, with names as the shipped models have them.
TEST(Judge, FirstLinesHaveAtMost25Words) {
  const std::vector<std::string> names{"fe_elastic_layer",      "orthotropic_half_plane",
                                       "osl_layer_absorbing",   "cantelaube_continuous",
                                       "cantelaube_asymmetric", "hydrostatic"};
  for (const int realizations : {1, 2, 8}) {
    for (const double noise : {0.02, 5.0}) {
      for (std::size_t models = 1; models <= names.size(); ++models) {
        for (const double misfit : {1.0, 3.0}) {
          std::vector<Candidate> all;
          for (std::size_t k = 0; k < models; ++k) {
            all.push_back(candidate(names[k], 1.1 + 0.05 * static_cast<double>(k)));
            all.back().model.family = k < 2 ? "finite layer" : "";
            all.back().model.misfit = misfit;
          }
          Evidence e = evidence(realizations, noise);
          if (realizations == 1) e.errors_from = ErrorsFrom::nothing;
          for (const std::string& line : headlines(judge(e, all))) {
            EXPECT_LE(words_in(line), 25U) << line;
            EXPECT_EQ(line.back(), '.') << line;
          }
        }
      }
    }
  }
}

TEST(Judge, EveryOutputShowsTheSameVerdict) {
  const Judgement j = judge(evidence(8, 0.1), {candidate("a_b", 1), candidate("c", 1.5)});
  const std::string first = headlines(j).front(), second = agreement_line(j);
  const std::string text = judgement_text(j), latex = judgement_latex(j);
  EXPECT_THAT(text, StartsWith(first + "\n\n" + second + "\n\n| model "));
  EXPECT_THAT(latex, StartsWith(escape_latex(first) + "\n\n" + escape_latex(second)));
  const auto json = nlohmann::json::parse(judgement_json(j));
  EXPECT_EQ(json["headlines"][0], first);
  EXPECT_EQ(json["agreement"], second);
  EXPECT_EQ(json["models"][0]["supported"], "yes");
  EXPECT_EQ(json["models"][1]["supported"], "no");
  Summary summary;
  add_judgement(summary, j);
  EXPECT_EQ(std::get<std::string>(summary.at("verdict.sentence")), first + " " + second);
  EXPECT_EQ(std::get<std::string>(summary.at("verdict.best_model")), "a_b");
}

TEST(Judge, TheNearestIsTheReference) {
  const std::vector<Candidate> two{candidate("a", 1), candidate("b", 1.5)};
  const Judgement j = judge(evidence(8, 0.1), two);
  EXPECT_STREQ(j.find("a")->distinguishable_text(), "reference");
  EXPECT_STREQ(j.find("b")->distinguishable_text(), "yes");
  EXPECT_EQ(j.find("a")->supported(), Answer::yes);
  const auto json = nlohmann::json::parse(judgement_json(j));
  EXPECT_EQ(json["models"][0]["distinguishable"], "reference");
  EXPECT_EQ(json["models"][1]["distinguishable"], "yes");
  const JudgementTable table = table_of(j);
  const auto column = std::find(table.header.begin(), table.header.end(), "distinguishable");
  ASSERT_NE(column, table.header.end());
  const auto k = static_cast<std::size_t>(column - table.header.begin());
  EXPECT_EQ(table.rows[0][k], "-");
  EXPECT_EQ(table.rows[1][k], "yes");
  // Without errors nothing was compared.
  EXPECT_STREQ(judge(evidence(2, 0.1), two).models.front().distinguishable_text(), "unknown");
}

// The line under the table says what the glossary says.
TEST(Judge, TheLegendHasTheWordsOfTheGlossary) {
  const auto in_one_line = [](std::string text) {
    text = std::regex_replace(text, std::regex(R"(\$\\chi\^2\$)"), "chi2");
    text = std::regex_replace(text, std::regex("[*`]"), "");
    return std::regex_replace(text, std::regex("\\s+"), " ");
  };
  const std::string glossary =
      in_one_line(testing::read_text(std::string(GRAINFIELD_CASES) + "/../docs/glossary.md"));
  std::vector<Candidate> all{candidate("a", 1, 1), candidate("b", 1.1), candidate("c", 1.2, 7)};
  all.back().model.description = true;
  for (Candidate& c : all) {
    c.model.equations = "elliptic";
    c.heights = c.forecast;
    c.akaike = c.model.rel_l2;
  }
  Evidence field = evidence(1, 0.1);
  field.errors_from = ErrorsFrom::data;
  field.error = Eigen::VectorXd::Constant(kValues, 0.1);
  const Judgement j = judge(field, all);
  const JudgementTable table = table_of(j);
  EXPECT_EQ(table.header.size(), 12U);  // all columns
  int meanings = 0;
  for (const std::string& meaning : table.meanings) {
    if (meaning.empty()) continue;
    ++meanings;
    EXPECT_THAT(table.note, HasSubstr(meaning));
    std::string entry = meaning.substr(0, meaning.size() - 1);  // without its full stop
    entry[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(entry[0])));
    const std::size_t colon = entry.find(": ");
    EXPECT_THAT(glossary, HasSubstr(entry.substr(0, colon + 2)));
    EXPECT_THAT(glossary, HasSubstr(entry.substr(colon + 2)));
  }
  EXPECT_EQ(meanings, 10);
  EXPECT_THAT(glossary, HasSubstr("description: the model need not be in equilibrium"));
  EXPECT_THAT(table.note, ::testing::EndsWith(" Description: the model need not be in equilibrium, "
                                              "and is never supported."));
  EXPECT_THAT(judgement_text(j), HasSubstr("\n\n" + table.note + "\n"));
  EXPECT_THAT(judgement_latex(j), HasSubstr(escape_latex(table.note)));
}

// What the number promises: of ensembles of that size 80 in 100 find the difference.
TEST(Power, RealizationsFindTheDifferenceIn80Of100) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const double size : {0.3, 0.7, 1.5}) {
    const int n = static_cast<int>(std::ceil(realizations_for_power(size, 1)));
    const double t = least_errors(n);
    int found = 0;
    constexpr int kTrials = 4000;
    for (int trial = 0; trial < kTrials; ++trial) {
      double sum = 0, squares = 0;
      for (int k = 0; k < n; ++k) {
        const double v = size + normal(random);
        sum += v;
        squares += v * v;
      }
      const double mean = sum / n, error = std::sqrt((squares / n - mean * mean) / (n - 1));
      found += mean > t * error;
    }
    // A whole number of realizations has a power a little above; 0.025: four standard errors.
    EXPECT_GT(found, (0.8 - 0.025) * kTrials) << size << " " << n;
    EXPECT_LT(found, (n < 8 ? 0.95 : 0.85) * kTrials) << size << " " << n;
  }
  EXPECT_TRUE(std::isinf(realizations_for_power(0, 1)));
  EXPECT_EQ(realizations_for_power(1, 0), 3);
}

TEST(Power, IsForeseenFromFewAndSaidWhereModelsAreNotDistinguished) {
  const std::vector<Candidate> two{candidate("a", 1), candidate("b", 1.05)};
  // D = sum of (s - b)^2 - (s - a)^2 over 12 values: mean 12 x 0.05^2, deviation 2 x 0.05 x noise
  // x sqrt(12).
  const double noise = 0.6, mean = kValues * 0.05 * 0.05,
               deviation = 2 * 0.05 * noise * std::sqrt(kValues);
  const double truth = realizations_for_power(mean, deviation);
  EXPECT_NEAR(judge(evidence(40000, noise), two).find("b")->power.realizations / truth, 1, 0.15);
  int inside = 0, said = 0, open = 0, why = 0;
  constexpr int kTrials = 200;
  for (unsigned seed = 1; seed <= kTrials; ++seed) {
    const Judgement j = judge(evidence(16, noise, seed), two);
    const Power& power = j.find(j.rival)->power;
    inside += power.least <= truth && truth <= power.most;
    if (j.distinguishable == Answer::yes) continue;
    const std::string line = note_lines(j).back();
    said += line.find("with a power of 80 % takes ") != std::string::npos;
    open += std::isinf(power.most) && std::isfinite(power.least);
    why += line.find("There is no upper limit, because b is behind a by ") != std::string::npos ||
           line.find("There is no upper limit, because a is behind b by ") != std::string::npos;
  }
  EXPECT_GT(open, 0);
  EXPECT_EQ(why, open);
  // Four standard deviations below 80 in 100.
  EXPECT_GT(inside, 0.69 * kTrials);
  EXPECT_GT(said, kTrials / 2);
}

TEST(Power, NoNumberWouldTellOneStressFromItself) {
  const Judgement j = judge(evidence(8, 0.1), {candidate("a", 1), candidate("b", 1 + 1e-9)});
  EXPECT_TRUE(j.find(j.rival)->power.same);
  EXPECT_THAT(note_lines(j).back(), HasSubstr("they are the same stress here"));
}

}  // namespace
}  // namespace grainfield::coupling
