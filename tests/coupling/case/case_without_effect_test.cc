// Keys without effect: said when they are written, and really without effect.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "coupling/case/case.h"
#include "coupling/case/keys.h"
#include "coupling/case/study.h"
#include "tests/coupling/program.h"
#include "tests/paths.h"

namespace grainfield::coupling {
namespace {

using ::testing::ElementsAre;
using testing::Folder;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Words = std::vector<std::string>;

Case read(const std::string& text, const Overrides& set = {}, bool quick = false) {
  const Folder folder;
  return read_case(folder.write("x.toml", text), quick, set);
}

const char* const kTinyPile = R"(study = "pile"
[shape]
polydispersity = 0.2
[source]
grains = 5
height = 0.03
interval = 0.03
length = 0.03
[floor]
length = 0.3
[motion]
time_step_fraction = 0.9
[rest]
background_damping = 100
unbalanced_force_ratio = 0.05
kinetic_to_elastic_energy = 0.01
[change]
ramp_time = 0.02
)";

/// What the grains of a case come to: every place, speed and force to the last bit.
std::vector<double> outcome(const Case& value) {
  const auto run = study_of(value).make_run(value, 0, 1);
  while (!run->done()) run->advance(100000);
  std::vector<double> out;
  for (const auto& [name, snapshot] : run->result().snapshots) {
    for (const auto& g : snapshot.grains) {
      out.insert(out.end(), {g.position.x(), g.position.y(), g.angle, g.velocity.x(),
                             g.velocity.y(), g.radius, g.mass});
    }
    for (const auto& c : snapshot.contacts) out.insert(out.end(), {c.force.x(), c.force.y()});
  }
  return out;
}

/// The key with another value than the default, as an override.
std::string changed(const Key& key) {
  const Case defaults;
  const std::string type = type_name(key), now = value_text(key, defaults);
  if (type == "boolean") return key.path() + (now == "true" ? "=false" : "=true");
  if (type == "integer") return key.path() + "=" + std::to_string(std::stol(now) + 1);
  if (type == "number") {
    const double other = std::stod(now) == 0 ? 0.01 : 0.9 * std::stod(now);
    return fmt::format("{}={}", key.path(), other);
  }
  if (type == "list of numbers") return key.path() + "=[1, 0, 0, 1, -1, -0.5]";
  for (const std::string& choice : key.choices) {
    if (toml_text(choice) != now) return key.path() + "=" + choice;
  }
  throw std::logic_error("no other value of " + key.path());
}

/// A choice against the need and that these tiny cases can run.
std::string choice_against(const Need& need) {
  const Key& other = *find_key(need.key);
  if (need.values.empty()) return other.path() + "=[]";
  if (type_name(other) == "boolean") return other.path() + "=false";
  if (type_name(other) == "number") return other.path() + "=1e-5";
  for (const std::string& choice : other.choices) {
    if (std::find(need.values.begin(), need.values.end(), choice) == need.values.end() &&
        choice != "outline") {
      return other.path() + "=" + choice;
    }
  }
  throw std::logic_error("every " + other.path() + " meets the need");
}

TEST(IdleKeys, DependOnKeysAndValuesThatExist) {
  for (const Key& key : keys()) {
    for (const Need& need : key.needs) {
      const Key* other = find_key(need.key);
      ASSERT_NE(other, nullptr) << key.path();
      EXPECT_TRUE(!need.values.empty() || other->may_be_empty) << key.path();
      for (const std::string& value : need.values) {
        if (other->choices.empty()) continue;
        EXPECT_THAT(other->choices, ::testing::Contains(value)) << key.path();
      }
      EXPECT_NO_THROW(choice_against(need)) << key.path();
    }
  }
}

// With the choice that leaves it without effect the grains come to the same bits, whatever the key
// says.
TEST(IdleKeys, ChangeNothing) {
  const Words of_grains{"shape", "source", "packing", "material", "motion", "sleep", "change"};
  std::map<std::string, std::vector<double>> baselines;
  int seen = 0;
  for (const Key& key : keys()) {
    if (std::find(of_grains.begin(), of_grains.end(), key.section) == of_grains.end()) continue;
    const bool pile = key_applies(key, "pile");
    const auto need = std::find_if(key.needs.begin(), key.needs.end(), [&](const Need& n) {
      return key_applies(*find_key(n.key), pile ? "pile" : "point-load");
    });
    if (need == key.needs.end()) continue;
    const std::string text = pile ? kTinyPile : testing::tiny_case();
    Overrides set{choice_against(*need)};
    // A choice of space alone: the tiny layer is in the plane.
    if (set[0] == "packing.kind=close_packed") continue;
    if (!pile) set.insert(set.end(), {"packing.width=0.1", "packing.depth=0.03"});
    if (need->key == "packing.sizes" || need->key == "packing.shape") {
      set.push_back("packing.kind=layered");
    }
    if (pile && key.section == "material") set.push_back("shape.kind=disk");
    if (key.section == "change") set.push_back("change.gravity=[9.5]");
    const Case without = read(text, set);
    EXPECT_TRUE(is_without_effect(key, without)) << key.path();
    const std::string start = key.path() + "=";
    set.erase(std::remove_if(set.begin(), set.end(),
                             [&](const std::string& one) { return one.rfind(start, 0) == 0; }),
              set.end());
    set.push_back(changed(key));
    Case with;
    try {
      with = read(text, set);
    } catch (const std::invalid_argument& e) {
      EXPECT_THAT(e.what(), HasSubstr("allowed"));  // refused, which says it too
      continue;
    }
    ASSERT_THAT(with.without_effect, ::testing::Contains(HasSubstr("--set: " + key.path())))
        << key.path();
    const std::string baseline =
        fmt::format("{} {}", pile, fmt::join(set.begin(), set.end() - 1, " "));
    if (baselines.count(baseline) == 0) baselines[baseline] = outcome(without);
    EXPECT_EQ(baselines[baseline], outcome(with)) << key.path();
    ++seen;
  }
  EXPECT_GT(seen, 30);
}

TEST(IdleKeys, AreNamedWithLineAndRemedy) {
  const std::string text = "study = \"pile\"\n[source]\nkind = \"line\"\nheight = 0.4\n";
  EXPECT_THAT(read(text).without_effect,
              ElementsAre(HasSubstr("x.toml:4: source.height: has no effect, only with "
                                    "source.kind = point, source.above = 0.0 (now \"line\")")));
  EXPECT_THAT(read(text, {"source.kind=point"}).without_effect, IsEmpty());
  // One of the values of a list is enough; a key of a key without effect has none either.
  EXPECT_THAT(read(testing::tiny_case(), {"average.kernel=gaussian"}).without_effect, IsEmpty());
  EXPECT_THAT(
      read(testing::tiny_case(), {"average.methods=[\"area_exact\"]", "average.kernel=gaussian"})
          .without_effect,
      ElementsAre(HasSubstr("--set: average.kernel: has no effect, only with "
                            "average.methods = coarse_graining (study point-load, pile, cone) "
                            "(now [\"area_exact\"])")));
  EXPECT_THAT(read(testing::tiny_case(), {"packing.side=0.01"}).without_effect,
              ElementsAre(HasSubstr("packing.side")));
}

TEST(IdleKeys, AreNotWhatARunVaries) {
  const std::string text = "study = \"pile\"\n[source]\nheight = 0.4\nlength = 0.9\n";
  EXPECT_THAT(read(text).without_effect, ElementsAre(HasSubstr("source.length")));
  EXPECT_THAT(read(text + "[sweep]\nkey = \"source.kind\"\nvalues = [\"line\", \"point\"]\n")
                  .without_effect,
              IsEmpty());
}

const char* const kTinySample = R"(study = "sample"
[sample]
grains = 20
pressure = 1e4
strain = 0.002
strain_rate = 1
records = 1
[material]
law = "linear"
normal_damping = 4000
)";

// Each of its needs leaves a key without effect, and the message says which.
TEST(IdleKeys, MayHaveSeveralNeeds) {
  const std::string only =
      "only with sample.boundary = walls, sample.deformation = simple_shear (now ";
  EXPECT_THAT(read(kTinySample, {"sample.sides=upright"}).without_effect,
              ElementsAre("--set: sample.sides: has no effect, " + only + "\"periodic\")"));
  EXPECT_THAT(read(kTinySample,
                   {"sample.sides=upright", "sample.boundary=walls", "sample.deformation=axial"})
                  .without_effect,
              ElementsAre("--set: sample.sides: has no effect, " + only + "\"axial\")"));
  EXPECT_THAT(read(kTinySample, {"sample.sides=upright", "sample.boundary=walls"}).without_effect,
              IsEmpty());
}

TEST(IdleKeys, OfSamplesChangeNothing) {
  const auto periodic = outcome(read(kTinySample));
  const Case rough = read(kTinySample, {"material.wall_friction=0.7"});
  EXPECT_THAT(rough.without_effect,
              ElementsAre(HasSubstr("material.wall_friction: has no effect, only with "
                                    "sample.boundary = walls (study sample) (now ")));
  EXPECT_EQ(outcome(rough), periodic);
  EXPECT_THAT(
      read(kTinySample, {"material.wall_friction=0.7", "sample.boundary=walls"}).without_effect,
      IsEmpty());
  const Overrides axial{"sample.boundary=walls", "sample.deformation=axial"};
  Overrides upright = axial;
  upright.emplace_back("sample.sides=upright");
  EXPECT_EQ(outcome(read(kTinySample, upright)), outcome(read(kTinySample, axial)));
  // Other studies always have walls.
  EXPECT_THAT(read(testing::tiny_case(), {"material.wall_friction=0.7"}).without_effect, IsEmpty());
}

TEST(IdleKeys, OfPathsAreTheTimeStepAndItsIntegrator) {
  const std::string path = "study = \"pair\"\n[pair]\nkind = \"path\"\nsteps = 50\n";
  const Case usual = read(path);
  for (const char* set :
       {"motion.time_step=1.0", "motion.time_step_fraction=0.5", "motion.integrator=gear"}) {
    const Case other = read(path, {set});
    EXPECT_THAT(other.without_effect, ElementsAre(HasSubstr("only with pair.kind = collision")))
        << set;
    EXPECT_EQ(outcome(other), outcome(usual)) << set;
  }
  EXPECT_THAT(read("study = \"pair\"\n", {"motion.integrator=gear"}).without_effect, IsEmpty());
  EXPECT_THAT(read(testing::tiny_case(), {"motion.integrator=gear"}).without_effect, IsEmpty());
  const Folder folder;
  const auto check = [&](const std::string& text) {
    return testing::program("check " + folder.write("x.toml", text)).out;
  };
  EXPECT_THAT(check(path), ::testing::Not(HasSubstr("steps of")));
  EXPECT_THAT(check("study = \"pair\"\n"), HasSubstr("steps of"));
}

TEST(IdleKeys, ASweptOneIsWarnedOf) {
  const std::string pile = "study = \"pile\"\n[source]\n";
  const std::string sweep = "[sweep]\nkey = \"source.height\"\nvalues = [\"0.5\", \"0.4\"]\n";
  EXPECT_THAT(read(pile + "kind = \"line\"\n" + sweep).without_effect,
              ElementsAre(HasSubstr("x.toml:5: sweep.key: source.height has no effect, only with "
                                    "source.kind = point, source.above = 0.0 (now \"line\")")));
  EXPECT_THAT(read(pile + "kind = \"point\"\n" + sweep).without_effect, IsEmpty());
}

TEST(IdleKeys, AWrittenOutCaseHasNone) {
  const std::string text = write_case(read(kTinyPile));
  EXPECT_THAT(text, HasSubstr("# length = 0.03"));
  EXPECT_THAT(text, HasSubstr("# only with source.kind = line; m; "));
  const Case again = read(text);
  EXPECT_THAT(again.without_effect, IsEmpty());
}

TEST(IdleKeys, OfShippedCasesAreNone) {
  for (const auto& entry : std::filesystem::directory_iterator(GRAINFIELD_CASES)) {
    if (entry.path().extension() != ".toml") continue;
    for (const bool quick : {false, true}) {
      EXPECT_THAT(read_case(entry.path().string(), quick, {}).without_effect, IsEmpty())
          << entry.path();
    }
  }
}

TEST(IdleKeys, AreWarnedOfByRunAndCheck) {
  const Folder folder;
  const std::string file = folder.write("x.toml", testing::tiny_case());
  const auto out = testing::program("run " + file + " -o " + folder.path() +
                                    "/out --set packing.width=0.2 --set "
                                    "ensemble.realizations=1");
  EXPECT_EQ(out.code, 0) << out.err;
  EXPECT_THAT(out.err, HasSubstr("grainfield: warning: --set: packing.width: has no effect, only "
                                 "with packing.kind = layered or random (now \"triangular\")"));
  const auto check = testing::program("check " + file + " --set packing.width=0.2");
  EXPECT_EQ(check.code, 0);
  EXPECT_THAT(check.err, HasSubstr("grainfield: warning: --set: packing.width: has no effect"));
}

}  // namespace
}  // namespace grainfield::coupling
