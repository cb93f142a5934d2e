// Reading case files: values, overrides, and one clear line for every mistake.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <sstream>

#include "coupling/case/keys.h"
#include "coupling/observe/setup.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/studies/lattice_pile/simulation.h"
#include "coupling/studies/pile/simulation.h"
#include "coupling/studies/point_load/simulation.h"
#include "tests/coupling/check_scene.h"
#include "tests/refusal.h"

namespace grainfield::coupling {
namespace {

using testing::accepted;
using testing::complaint;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Output;
using testing::program;

// What a run keeps for --resume is read again, whatever the title.
TEST(ReadCase, TextsAreWrittenSoThatTheyAreReadAgain) {
  const Folder folder;
  std::string title;
  for (char ch = 1; ch < 0x7f; ++ch) title += ch;
  title += "\x7f \u00e9 \U0001F3D6";
  const std::string text = "study = \"pile\"\ntitle = " + toml_text(title) + "\n";
  const Case once = read_case(folder.write("x.toml", text), false, {});
  EXPECT_EQ(once.title, title);
  EXPECT_EQ(read_case(folder.write("again.toml", write_case(once)), false, {}).title, title);
}

TEST(ReadCase, FitsNeedEveryEntryOnce) {
  const auto fit = [](const std::string& line) {
    return complaint("study = \"pile\"\n[fit]\n" + line + "\n");
  };
  EXPECT_EQ(fit("models = [\"osl\", \"bcc\"]"), "");
  EXPECT_EQ(fit("models = []"), "");
  EXPECT_THAT(fit("components = []"), HasSubstr("x.toml:3: fit.components: found an empty list"));
  EXPECT_THAT(fit("models = [\"osl\", \"osl\"]"), HasSubstr("fit.models: found osl twice"));
  EXPECT_THAT(fit("components = [\"sigma_yy\", \"sigma_yy\"]"),
              HasSubstr("fit.components: found sigma_yy twice"));
  EXPECT_THAT(fit("heights = [0.1, 0.2, 0.1]"), HasSubstr("fit.heights: found 0.1 twice"));
}

TEST(ReadCase, AFormerStudyIsThePresentOneWithWhatItMeant) {
  const Folder folder;
  const auto read = [&](const std::string& text, const Overrides& set = {}) {
    return read_case(folder.write("x.toml", text), false, set);
  };
  const Case plain = read("study = \"pile-fit\"\n[shape]\nradius = 0.003\n");
  EXPECT_EQ(plain.study, "pile");
  EXPECT_EQ(plain.get<FitSetup>().models, kUsualHeapModels);
  EXPECT_TRUE(read("study = \"pile\"\n").get<FitSetup>().models.empty());
  const std::vector<std::string> own{"osl"};
  EXPECT_EQ(read("[fit]\nmodels = [\"osl\"]\n", {"study=pile-fit"}).get<FitSetup>().models, own);
  EXPECT_EQ(read("study = \"pile-fit\"\n", {"fit.models=[\"osl\"]"}).get<FitSetup>().models, own);
  // What is written out is of the present study.
  EXPECT_EQ(read(write_case(plain)).get<FitSetup>().models, kUsualHeapModels);
}

// point-load-verdict had a section [verdict], also in variants and in what a sweep varies.
TEST(ReadCase, AFormerStudysSectionIsThePresentOne) {
  const Folder folder;
  const auto read = [&](const std::string& text, const Overrides& set = {}, bool quick = false) {
    return read_case(folder.write("x.toml", text), quick, set);
  };
  const std::string study = "study = \"point-load-verdict\"\n";
  const Case plain = read(study);
  EXPECT_EQ(plain.study, "point-load");
  EXPECT_TRUE(plain.models.empty());
  const FitSetup& usual = plain.get<FitSetup>();
  EXPECT_EQ(usual.models, kUsualLayerModels);
  EXPECT_THAT(usual.finite_elements,
              ::testing::ElementsAre("fe_elastic_layer", "fe_orthotropic_layer"));
  EXPECT_EQ(usual.bootstrap, 100);
  const Case again = read(write_case(plain));
  EXPECT_EQ(write_case(again), write_case(plain));

  const std::string text = study +
                           "[verdict]\nfinite_elements = []\nkernel = [2]\n[quick.verdict]\n"
                           "bootstrap = 20\n[sweep]\nkey = \"variant\"\nvalues = [\"a\", \"b\"]\n"
                           "[variant.a]\nverdict.base = false\n[variant.b.verdict]\nmodels = "
                           "[\"flamant\"]\n";
  const Case one = read(text, {"verdict.coverage=[4]"});
  EXPECT_TRUE(one.get<FitSetup>().finite_elements.empty());
  EXPECT_EQ(one.get<FitSetup>().bootstrap, 100);
  EXPECT_EQ(one.get<FitSetup>().coverage, std::vector<double>{4});
  const std::vector<SweepCase> members = sweep_cases(one);
  ASSERT_EQ(members.size(), 2u);
  EXPECT_FALSE(members[0].value.get<FitSetup>().base);
  EXPECT_EQ(members[0].value.get<FitSetup>().models, kUsualLayerModels);
  EXPECT_EQ(members[1].value.get<FitSetup>().models, std::vector<std::string>{"flamant"});
  EXPECT_EQ(read(text, {}, true).get<FitSetup>().bootstrap, 20);
  const Case swept =
      read(study + "[sweep]\nkey = \"verdict.bootstrap\"\nvalues = [\"0\", \"10\"]\n", {});
  EXPECT_EQ(swept.sweep.key, "fit.bootstrap");

  EXPECT_THAT(complaint("study = \"point-load\"\n[verdict]\nbase = false\n"),
              HasSubstr("x.toml:3: verdict: found the section's former name, now: fit"));
}

// Heaps and layers share [fit], with words and keys of their own: one line for each mistake.
TEST(ReadCase, MistakesOfFitsNameWhatTheStudyTakes) {
  const auto fit = [](const std::string& study, const std::string& lines) {
    return complaint("study = \"" + study + "\"\n[fit]\n" + lines + "\n");
  };
  const auto layer = [&](const std::string& line) {
    return fit("point-load", "models = [\"flamant\"]\n" + line);
  };
  const auto heap = [&](const std::string& line) {
    return fit("pile", "models = [\"osl\"]\n" + line);
  };
  EXPECT_EQ(layer(""), "");
  EXPECT_EQ(fit("point-load", "models = [\"layer_ruff\"]"),
            "x.toml:3: fit.models: found \"layer_ruff\", allowed: flamant | layer_smooth | "
            "layer_rough | orthotropic_half_plane | orthotropic_layer_smooth | "
            "orthotropic_layer_rough | osl_layer_absorbing | osl_layer_reflecting; did you mean "
            "layer_rough?");
  EXPECT_EQ(fit("pile", "models = [\"cantelaub\"]"),
            "x.toml:3: fit.models: found \"cantelaub\", allowed: " +
                allowed(*find_key("fit.models"), "pile") + "; did you mean cantelaube?");
  // A model of the other specimen is no word here.
  EXPECT_THAT(fit("point-load", "models = [\"bcc\"]"), HasSubstr("x.toml:3: fit.models: "));
  EXPECT_THAT(fit("pile", "models = [\"layer_rough\"]"), HasSubstr("x.toml:3: fit.models: "));
  EXPECT_EQ(layer("finite_elements = [\"fe_osl_wedge\"]"),
            "x.toml:4: fit.finite_elements: found \"fe_osl_wedge\", allowed: "
            "fe_elastic_half_space | fe_elastic_layer | fe_orthotropic_layer | fe_osl_layer; did "
            "you mean fe_osl_layer?");
  EXPECT_EQ(heap("finite_elements = [\"fe_osl_layer\"]"),
            "x.toml:4: fit.finite_elements: found \"fe_osl_layer\", allowed: fe_osl_wedge | "
            "fe_mohr_coulomb_wedge; did you mean fe_osl_wedge?");
  for (const auto& bad : {layer("kernel = [0.001]"), heap("kernel = [0.001]")}) {
    EXPECT_EQ(bad, "x.toml:4: fit.kernel: found 0.001, allowed: 0.01 to 100");
  }
  for (const auto& bad : {layer("bootstrap = -1"), heap("bootstrap = -1")}) {
    EXPECT_EQ(bad, "x.toml:4: fit.bootstrap: found -1, allowed: 0 to 10000");
  }
  EXPECT_EQ(layer("coverage = [2]"), "x.toml:4: fit.coverage: found 2, allowed: 3 to 1e+06");
  EXPECT_EQ(layer("base = 3"),
            "x.toml:4: fit.base: found 3 (integer), expected a boolean, written true or false");
  EXPECT_EQ(layer("kernal = [1]"), "x.toml:4: fit.kernal: unknown key; did you mean fit.kernel?");
  // Keys of the other study's fits.
  EXPECT_EQ(layer("heights = [0.2]"),
            "x.toml:4: fit.heights: has no meaning for study = \"point-load\"");
  EXPECT_EQ(heap("base = false"), "x.toml:4: fit.base: has no meaning for study = \"pile\"");
}

// A study without models of [fit] compares with its usual ones; those of [fit] take their place.
TEST(ReadCase, FittedModelsTakeThePlaceOfTheUsualOnes) {
  EXPECT_FALSE(accepted("study = \"point-load\"\n").models.empty());
  EXPECT_TRUE(accepted("study = \"point-load\"\n[fit]\nmodels = [\"flamant\"]\n").models.empty());
  EXPECT_THAT(
      complaint("study = \"point-load\"\n[compare]\nmodels = [\"layer\"]\n[fit]\nmodels = "
                "[\"flamant\"]\n"),
      HasSubstr("x.toml:3: compare.models: found \"layer\", allowed: none with fit.models"));
}

TEST(ReadCase, FitsOfPilesNeedModelsAndComparisonsNone) {
  EXPECT_THAT(complaint("study = \"pile\"\n[compare]\nmodels = [\"bcc\"]\n[fit]\nmodels = "
                        "[\"osl\"]\n"),
              HasSubstr("compare.models: found \"bcc\", allowed: none with fit.models"));
  const Case value = accepted("study = \"pile\"\n[fit]\nheights = [0.2]\n");
  EXPECT_THAT(
      value.without_effect,
      ElementsAre(HasSubstr("fit.heights: has no effect, only with fit.models given (now [])")));
}

TEST(ReadCase, FillsTheStructsAndKeepsDefaults) {
  const Case value = accepted(R"(title = "t"
[packing]
radius_max = 0.006
[material]
friction = 1
[ensemble]
realizations = 7
[average]
depths = [0.1, 0.9]
[output]
vtu = false
)");
  EXPECT_EQ(value.name, "x");
  EXPECT_EQ(value.title, "t");
  EXPECT_EQ(value.get<dem::PointLoadSetup>().packing.radius_max, 0.006);
  EXPECT_EQ(value.get<dem::PointLoadSetup>().packing.radius_min, dem::PackingSetup().radius_min);
  EXPECT_EQ(value.get<dem::PointLoadSetup>().material.friction, 1.0);
  EXPECT_EQ(value.ensemble.realizations, 7);
  EXPECT_EQ(value.get<AverageSetup>().depths, (std::vector<double>{0.1, 0.9}));
  EXPECT_FALSE(value.output.vtu);
  ASSERT_EQ(value.models.size(), 3U);
  EXPECT_EQ(value.models[0].name, "flamant");
}

TEST(ReadCase, OverridesComeLast) {
  const std::string text = "[material]\nfriction = 0.1\n[quick.material]\nfriction = 0.2\n";
  const Folder folder;
  const std::string slow = folder.write("slow.toml", "[material]\nfriction = 0.1\n");
  EXPECT_THAT(refusal_of([&] { read_case(slow, true, {}); }),
              HasSubstr("--quick: found no [quick] settings in "));
  EXPECT_EQ(accepted(text).get<dem::PointLoadSetup>().material.friction, 0.1);
  EXPECT_EQ(accepted(text, {}, true).get<dem::PointLoadSetup>().material.friction, 0.2);
  EXPECT_EQ(
      accepted(text, {"material.friction=0.3"}, true).get<dem::PointLoadSetup>().material.friction,
      0.3);
  EXPECT_EQ(accepted(text, {"material.friction=0.3"}).get<dem::PointLoadSetup>().material.friction,
            0.3);
}

TEST(ReadCase, OverridesTakeBareWordsListsAndTitles) {
  const Case value =
      accepted("", {"packing.floor=rough", "compare.models=flamant", "average.depths=[0.2, 0.4]",
                    "title=5 grains", "motion.time_step = 0"});
  EXPECT_EQ(value.get<dem::PointLoadSetup>().packing.floor, "rough");
  EXPECT_EQ(value.compare.models, std::vector<std::string>{"flamant"});
  EXPECT_EQ(value.get<AverageSetup>().depths.size(), 2U);
  EXPECT_EQ(value.title, "5 grains");
}

TEST(ReadCase, ModelTablesByLabel) {
  const Case value = accepted(R"([compare]
models = ["layer", "r"]
[model.r]
name = "layer"
base = "rough"
nu = 0.2
)");
  ASSERT_EQ(value.models.size(), 2U);
  EXPECT_EQ(value.models[1].label, "r");
  EXPECT_EQ(value.models[1].name, "layer");
  EXPECT_EQ(value.models[1].settings.at("base"), "rough");
  EXPECT_EQ(std::stod(value.models[1].settings.at("nu")), 0.2);
}

TEST(ReadCase, TheWrittenCaseReadsBackToItself) {
  const Folder folder;
  const Case value = accepted(testing::tiny_case());
  const std::string once = write_case(value);
  const Case again = read_case(folder.write("x.toml", once), false, {});
  EXPECT_EQ(write_case(again), once);
  EXPECT_EQ(again.get<dem::PointLoadSetup>().packing.jitter,
            value.get<dem::PointLoadSetup>().packing.jitter);
  // Every key of the study is spelled out; those without effect as remarks.
  for (const Key& key : keys()) {
    if (!key_applies(key, "point-load") || key.section == "sweep") continue;
    const std::string start = is_without_effect(key, value) ? "\n# " : "\n";
    EXPECT_THAT(once, HasSubstr(start + key.name + " = ")) << key.path();
  }
}

TEST(ReadCase, SweepMembers) {
  const Case value = accepted("[sweep]\nkey = \"material.friction\"\nvalues = [0.3, 0.6]\n");
  const auto members = sweep_cases(value);
  ASSERT_EQ(members.size(), 2U);
  EXPECT_EQ(members[1].suffix, "friction_0.6");
  EXPECT_EQ(members[1].value.get<dem::PointLoadSetup>().material.friction, 0.6);
  EXPECT_TRUE(members[1].value.sweep.key.empty());
  EXPECT_EQ(members[1].value.models.size(), value.models.size());
  // A value of the swept key from the command line would count nowhere.
  const Folder swept;
  const std::string file = swept.write(
      "s.toml",
      "study = \"point-load\"\n[sweep]\nkey = \"material.friction\"\nvalues = [0.3, 0.6]\n");
  EXPECT_THAT(
      [&] { read_case(file, false, {"material.friction=0.1"}); },
      ::testing::ThrowsMessage<std::invalid_argument>(HasSubstr(
          "--set: material.friction: this case sweeps it (0.3, 0.6), so that the value would "
          "count nowhere; set sweep.values=[...] instead")));
  EXPECT_EQ(sweep_cases(read_case(file, false, {"sweep.values=[0.1]"})).size(), 1U);
  // The written-out case has the sweep.
  const Folder folder;
  EXPECT_EQ(sweep_cases(read_case(folder.write("x.toml", write_case(value)), false, {})).size(),
            2U);
}

TEST(ReadCase, AnEmptyVariantIsTheCaseAsItIs) {
  const Case value = accepted(
      "[material]\nfriction = 0.4\n[sweep]\nkey = \"variant\"\nvalues = [\"base\", \"rough\"]\n"
      "[variant.base]\n[variant.rough]\nmaterial.friction = 0.9\n");
  const auto members = sweep_cases(value);
  ASSERT_EQ(members.size(), 2U);
  EXPECT_EQ(members[0].value.get<dem::PointLoadSetup>().material.friction, 0.4);
  EXPECT_EQ(members[1].value.get<dem::PointLoadSetup>().material.friction, 0.9);
  const Folder folder;
  EXPECT_EQ(sweep_cases(read_case(folder.write("x.toml", write_case(value)), false, {})).size(),
            2U);
}

TEST(CaseErrors, UnknownNames) {
  EXPECT_EQ(complaint("\n[material]\nfrction = 0.5\n"),
            "x.toml:3: material.frction: unknown key; did you mean material.friction?");
  EXPECT_EQ(complaint("[materiel]\nfriction = 0.5\n"),
            "x.toml:2: materiel: unknown section; did you mean material?");
  EXPECT_EQ(complaint("[materiel]\n"),
            "x.toml:1: materiel: unknown section; did you mean material?");
  EXPECT_EQ(complaint("tittle = \"a\"\n"), "x.toml:1: tittle: unknown key; did you mean title?");
  EXPECT_EQ(complaint("[variant.\"a.b\"]\n"),
            "x.toml:1: \"a.b\": a name in quotes cannot hold a dot");
  // A key in the wrong section is found where it belongs.
  EXPECT_EQ(complaint("[packing]\nfriction = 0.5\n"),
            "x.toml:2: packing.friction: unknown key; did you mean material.friction?");
}

TEST(CaseErrors, EveryKeyIsFoundFromAMisspelling) {
  std::mt19937 random(7);
  for (const Key& key : keys()) {
    if (key.name.size() < 5) continue;
    std::string wrong = key.name;
    std::swap(wrong[2], wrong[3]);
    if (wrong == key.name || find_key(key.section + "." + wrong) != nullptr) continue;
    const std::string text =
        key.section.empty() ? wrong + " = 1\n" : "[" + key.section + "]\n" + wrong + " = 1\n";
    EXPECT_THAT(complaint(text), EndsWith("did you mean " + key.path() + "?")) << wrong;
  }
}

// Every mistake has its line and its way out, in the order of the file; the quick tables and the
// command line with it.
TEST(CaseErrors, AllMistakesOfAFileAtOnce) {
  const Folder folder;
  const std::string file = folder.write("x.toml", R"(study = "point-load"
[material]
fricton = 0.3
density = "heavy"
[compare]
models = ["layr", "flamant", "flat"]
[model.flat]
name = "layer"
nuu = 0.2
base = "ruff"
[source]
grains = 7
[quick.ensemble]
realisations = 2
)");
  const std::vector<std::pair<int, std::string>> expected{
      {3, "material.fricton: unknown key; did you mean material.friction"},
      {4, "material.density: found \"heavy\" (text), expected a number"},
      {6, "compare.models: no model 'layr'; did you mean 'layer'?"},
      {9, "model.flat.nuu: "},
      {10, "model.flat.base: "},
      {12, "source.grains: has no meaning for study"},
      {14, "ensemble.realisations: unknown key; did you mean ensemble.realizations"}};
  for (const std::string& command : {"check " + file, "run " + file + " -o " + (folder / "out")}) {
    const Output out = program(command + " --set material.frction=0.1");
    EXPECT_EQ(out.code, 2);
    std::istringstream lines(out.err);
    std::string line;
    for (const auto& [number, words] : expected) {
      std::getline(lines, line);
      EXPECT_THAT(line,
                  ::testing::StartsWith(fmt::format("grainfield: {}:{}: {}", file, number, words)));
    }
    std::getline(lines, line);
    EXPECT_THAT(line, HasSubstr("--set: material.frction: unknown key; did you mean "));
    EXPECT_FALSE(std::getline(lines, line)) << line;
  }
}

TEST(CaseErrors, WrongTypes) {
  EXPECT_EQ(complaint("[material]\nfriction = \"high\"\n"),
            "x.toml:2: material.friction: found \"high\" (text), expected a number");
  EXPECT_EQ(complaint("[packing]\nrows = 2.5\n"),
            "x.toml:2: packing.rows: found 2.5 (number), expected an integer");
  EXPECT_EQ(complaint("[output]\nvtu = 1\n"),
            "x.toml:2: output.vtu: found 1 (integer), expected a boolean, written true or false");
  EXPECT_EQ(complaint("[packing]\nfloor = true\n"),
            "x.toml:2: packing.floor: found true (boolean), expected a word");
  EXPECT_EQ(complaint("[packing]\nradius = [1, 2]\n"),
            "x.toml:2: packing.radius: found a list [1, 2], expected a number");
  EXPECT_EQ(complaint("[packing]\nradius = 1979-05-27\n"),
            "x.toml:2: packing.radius: found a date or time, expected a number");
  EXPECT_EQ(complaint("material = 3\n"),
            "x.toml:1: material: found 3 (integer), expected a section [material] (its keys: "
            "grainfield keys material)");
}

TEST(CaseErrors, OutOfRange) {
  EXPECT_EQ(complaint("[material]\nfriction = -1\n"),
            "x.toml:2: material.friction: found -1, allowed: 0 to 10");
  EXPECT_EQ(complaint("[material]\nyoung = 0\n"),
            "x.toml:2: material.young: found 0, allowed: 0.001 to 1e+15");
  EXPECT_EQ(complaint("[material]\nyoung = nan\n"),
            "x.toml:2: material.young: found nan, allowed: 0.001 to 1e+15");
  EXPECT_EQ(complaint("[material]\nyoung = inf\n"),
            "x.toml:2: material.young: found inf, allowed: 0.001 to 1e+15");
  EXPECT_EQ(
      complaint("[packing]\nfloor = \"rouhg\"\n"),
      "x.toml:2: packing.floor: found \"rouhg\", allowed: smooth | rough; did you mean rough?");
  EXPECT_EQ(complaint("[average]\ndepths = [0.5, 1.5]\n"),
            "x.toml:2: average.depths: found 1.5, allowed: 1e-06 to 1");
  EXPECT_EQ(complaint("[average]\ndepths = []\n"),
            "x.toml:2: average.depths: found an empty list, expected numbers");
}

TEST(CaseErrors, BetweenKeys) {
  EXPECT_EQ(complaint("[packing]\nradius_min = 0.01\n"),
            "x.toml:2: packing.radius_min: found 0.01, allowed: up to packing.radius_max = 0.0054");
  EXPECT_THAT(complaint("study = \"elastic-layer\"\n[packing]\nrows = 3\n"),
              HasSubstr("x.toml:3: packing.rows: has no meaning for study = \"elastic-layer\""));
  for (const char* key : {"height = 0.1", "force = 2"}) {
    EXPECT_THAT(complaint(std::string("study = \"osl-layer\"\n[elastic]\n") + key + "\n"),
                HasSubstr("x.toml:3: elastic: found the section's former name, now: problem"));
  }
  EXPECT_THAT(
      complaint("study = \"elastic-layer\"\n[problem]\nheight = 0.1\ndepths = [0.2]\n"),
      HasSubstr("x.toml:4: problem.depths: found 0.2, allowed: up to problem.height = 0.1"));
}

TEST(CaseErrors, TimeStepAboveTheStableLimitNamesTheLimit) {
  const std::string what = complaint("[motion]\n\ntime_step = 0.1\n");
  EXPECT_THAT(what, HasSubstr("x.toml:3: motion.time_step: found 0.1 s, allowed: at most"));
  EXPECT_THAT(what,
              HasSubstr("(the stable limit) for grains of this shape and material with verlet"));
}

TEST(CaseErrors, Piles) {
  const auto pile = [](const std::string& text) { return complaint("study = \"pile\"\n" + text); };
  EXPECT_EQ(pile(""), "");
  EXPECT_THAT(pile("[shape]\nkind = \"disc\"\n"),
              HasSubstr("x.toml:3: shape.kind: found \"disc\", allowed: disk | rand1 | regular | "
                        "irregular | outline; did you mean disk"));
  EXPECT_THAT(pile("[shape]\ncorners_min = 2\n"),
              HasSubstr("x.toml:3: shape.corners_min: found 2, allowed: 3 to 64"));
  EXPECT_THAT(pile("[shape]\ncorners_min = 9\n"),
              HasSubstr("shape.corners_max: found 8, allowed: at least shape.corners_min = 9"));
  EXPECT_THAT(pile("[shape]\npolydispersity = 1.0\n"),
              HasSubstr("shape.polydispersity: found 1, allowed: 0 to 0.99"));
  EXPECT_THAT(pile("[shape]\nkind = \"outline\"\noutline = [0.0, 0.0, 1.0, 0.0]\n"),
              HasSubstr("x.toml:4: shape.outline"));
  EXPECT_THAT(pile("[source]\nkind = \"lines\"\n"), HasSubstr("did you mean line"));
  EXPECT_THAT(pile("[source]\ngrains = 2\n"), HasSubstr("source.grains: found 2, allowed: 3 to"));
  EXPECT_THAT(pile("[source]\ninterval = 0.0\n"),
              HasSubstr("source.interval: found 0, allowed: 1e-06 to 1e+06"));
  EXPECT_THAT(pile("[source]\ninterval = 0.001\n"), HasSubstr("x.toml:3: source.interval: "));
  EXPECT_THAT(pile("[floor]\nlength = -1.0\n"),
              HasSubstr("floor.length: found -1, allowed: 1e-06 to 1e+06"));
  EXPECT_THAT(pile("[sleep]\non = 1\n"),
              HasSubstr("sleep.on: found 1 (integer), expected a boolean, written true or false"));
  EXPECT_THAT(pile("radius = 0.002\n"),
              HasSubstr("radius: unknown key; did you mean shape.radius?"));
  EXPECT_THAT(pile("[floor]\nfriction = 0.5\n"),
              HasSubstr("floor.friction: unknown key; did you mean material.floor_friction"));
  EXPECT_THAT(pile("[change]\ngravity = [0.0]\n"),
              HasSubstr("change.gravity: found 0, allowed: 1e-06 to 1e+06"));
  EXPECT_THAT(pile("[change]\nmethod = \"newtons\"\n"), HasSubstr("did you mean newton"));
  EXPECT_THAT(pile("[heap]\nheights = [1.5]\n"),
              HasSubstr("heap.heights: found 1.5, allowed: 1e-06 to 1"));
  EXPECT_THAT(pile("[heap]\nheights = []\n"), HasSubstr("found an empty list"));
  EXPECT_THAT(
      pile("[heap]\nshoulder_from = 0.5\n"),
      HasSubstr("x.toml:3: heap.shoulder_from: found 0.5, allowed: below heap.shoulder_to = "
                "0.4"));
  EXPECT_THAT(
      pile("[heap]\ncentre = 0.3\n"),
      HasSubstr("x.toml:3: heap.centre: found 0.3, allowed: up to heap.shoulder_from = 0.15"));
  // Keys of other studies, and of sections that only partly belong.
  EXPECT_THAT(pile("[load]\nforce = 1.0\n"),
              HasSubstr("x.toml:3: load.force: has no meaning for study = \"pile\""));
  EXPECT_THAT(pile("[average]\ndepths = [0.5]\n"),
              HasSubstr("x.toml:3: average.depths: has no meaning for study = \"pile\""));
  EXPECT_THAT(complaint("[source]\ngrains = 10\n"),
              HasSubstr("source.grains: has no meaning for study = \"point-load\""));
}

TEST(ReadCase, SharedKeysFillTheSetupOfTheStudy) {
  const std::string text = "study = \"pile\"\n[material]\nfriction = 0.7\n[change]\ngravity = []\n";
  const Case pile = accepted(text);
  EXPECT_EQ(pile.get<dem::PileSetup>().material.friction, 0.7);
  EXPECT_EQ(pile.get<dem::PileSetup>().material.floor_friction, 0.54);
  EXPECT_EQ(pile.get<dem::PointLoadSetup>().material.friction, 0.5);
  EXPECT_TRUE(pile.models.empty());
  EXPECT_EQ(accepted("study = \"pile\"\n[compare]\nmodels = [\"hydrostatic\"]\n").models.size(),
            1U);
  // The study may be chosen from the command line: the keys follow it.
  const Case chosen = accepted("[material]\nfriction = 0.7\n", {"study=pile"});
  EXPECT_EQ(chosen.get<dem::PileSetup>().material.friction, 0.7);
  EXPECT_EQ(chosen.get<dem::PointLoadSetup>().material.friction, 0.5);
  EXPECT_EQ(
      accepted("", {"study=pile", "change.gravity=[5, 20]"}).get<dem::PileSetup>().change.gravity,
      (std::vector<double>{5, 20}));
  const Case lattice = accepted("study = \"lattice-pile\"\n[material]\nfloor_friction = 0.9\n");
  EXPECT_EQ(lattice.get<dem::LatticePileSetup>().material.floor_friction, 0.9);
  EXPECT_EQ(lattice.get<dem::LatticePileSetup>().material.friction, 0);
  EXPECT_EQ(lattice.get<dem::PileSetup>().material.floor_friction, 0.54);
}

TEST(ReadCase, GrainKeysLeaveTheAnalysisOut) {
  const std::string text = "study = \"pile\"\n";
  const std::string before = grain_keys_text(accepted(text));
  for (const char* same :
       {"[average]\nwidth = 0.01\n", "[heap]\ncentre = 0.05\n", "[output]\nvtu = false\n",
        "[ensemble]\nrealizations = 7\n", "[compare]\nmodels = [\"hydrostatic\"]\n"}) {
    EXPECT_EQ(grain_keys_text(accepted(text + same)), before) << same;
  }
  for (const char* other : {"[shape]\nradius = 0.003\n", "[material]\nfriction = 0.3\n",
                            "[ensemble]\nseed = 7\n", "[sleep]\non = false\n"}) {
    EXPECT_NE(grain_keys_text(accepted(text + other)), before) << other;
  }
}

TEST(CaseErrors, Models) {
  EXPECT_THAT(complaint("[compare]\nmodels = [\"flamand\"]\n"),
              HasSubstr("x.toml:2: compare.models: no model 'flamand'; did you mean 'flamant'?"));
  EXPECT_THAT(complaint("[compare]\nmodels = [\"layer\", \"layer\"]\n"),
              HasSubstr("\"layer\" twice"));
  EXPECT_THAT(complaint("[compare]\nmodels = [\"boussinesq\"]\n"),
              HasSubstr("x.toml:2: compare.models: \"boussinesq\" is three-dimensional"));
  EXPECT_THAT(
      complaint("[model.layer]\nnuu = 0.3\n"),
      HasSubstr("x.toml:2: model.layer.nuu: model layer: no parameter 'nuu'; did you mean 'nu'?"));
  EXPECT_THAT(complaint("[model.layer]\nnu = 0.7\n"),
              HasSubstr("x.toml:2: model.layer.nu: model layer: nu = 0.7 is out of range"));
  EXPECT_THAT(complaint("[model.mine]\nnu = 0.3\n"), HasSubstr("no model 'mine'"));
}

TEST(CaseErrors, Sweeps) {
  EXPECT_THAT(complaint("[sweep]\nkey = \"material.frction\"\nvalues = [1]\n"),
              HasSubstr("x.toml:2: sweep.key: material.frction: unknown key; did you mean "
                        "material.friction"));
  EXPECT_THAT(complaint("[sweep]\nkey = \"material.friction\"\nvalues = [0.1, -1]\n"),
              HasSubstr("x.toml:3: sweep.values: material.friction: found -1, allowed: 0 to 10"));
  EXPECT_THAT(complaint("[sweep]\nkey = \"material.friction\"\n"), HasSubstr("needs sweep.values"));
  EXPECT_THAT(complaint("[sweep]\nkey = \"material.friction\"\nvalues = [1, 1]\n"),
              HasSubstr("twice"));
}

TEST(CaseErrors, TomlSyntaxAndDuplicates) {
  EXPECT_THAT(complaint("[material\nfriction = 1\n"), HasSubstr("x.toml:1: not valid TOML: "));
  EXPECT_THAT(complaint("[material]\nfriction = 1\nfriction = 2\n"),
              HasSubstr("x.toml:3: not valid TOML: "));
  EXPECT_THAT(complaint("a = 1\n\xff\xfe"), HasSubstr("not valid TOML: "));
}

TEST(CaseErrors, DecimalCommas) {
  const std::string head = "study = \"point-load\"\n[material]\n";
  EXPECT_EQ(complaint(head + "friction = 0,5\n"),
            "x.toml:3: friction: found 0,5, allowed: a decimal point; write friction = 0.5");
  EXPECT_EQ(
      complaint(head + "density = 5000\nfriction =\t-1,5e-3  # of steel\r\n"),
      "x.toml:4: friction: found -1,5e-3, allowed: a decimal point; write friction = -1.5e-3");
  EXPECT_EQ(complaint(head + "friction = \"0,5\"\n"),
            "x.toml:3: material.friction: found \"0,5\", allowed: a decimal point; write 0.5");
  EXPECT_EQ(complaint("study = \"point-load\"\n[packing]\nradius = \"3,6 mm\"\n"),
            "x.toml:3: packing.radius: found \"3,6 mm\", allowed: a decimal point; write "
            "\"3.6 mm\"");
  EXPECT_EQ(complaint(head, {"material.friction=0,5"}),
            "--set: material.friction: found \"0,5\", allowed: a decimal point; write 0.5");
  EXPECT_EQ(complaint(head + "density = 5,000\n"),
            "x.toml:3: density: found 5,000, allowed: a decimal point; write density = 5.000 or "
            "5000");
  EXPECT_EQ(complaint(head + "friction = 0,125\n"),
            "x.toml:3: friction: found 0,125, allowed: a decimal point; write friction = 0.125");
  for (const char* other : {"1,", ",5,", "1,2,3", "0,5 0,6", "a,5"}) {
    EXPECT_THAT(complaint(head + "friction = " + other + "\n"),
                HasSubstr("x.toml:3: not valid TOML: "))
        << other;
  }
}

TEST(CaseErrors, QuickIsCheckedEvenWhenUnused) {
  EXPECT_EQ(complaint("[quick.material]\nfrction = 0.5\n"),
            "x.toml:2: material.frction: unknown key; did you mean material.friction?");
  EXPECT_THAT(complaint("quick = 1\n"), HasSubstr("x.toml:1: quick: found a value"));
}

TEST(CaseErrors, Overrides) {
  EXPECT_EQ(complaint("", {"material.frction=1"}),
            "--set: material.frction: unknown key; did you mean material.friction?");
  EXPECT_EQ(complaint("", {"material.friction=-1"}),
            "--set: material.friction: found -1, allowed: 0 to 10");
  EXPECT_EQ(complaint("", {"material.friction=much"}),
            "--set: material.friction: found \"much\" (text), expected a number");
  EXPECT_EQ(complaint("", {"material.friction"}),
            "--set: found \"material.friction\", expected key.path=value");
  EXPECT_EQ(complaint("", {"=3"}), "--set: found \"=3\", expected key.path=value");
}

TEST(CaseErrors, FilesThatCannotBeRead) {
  const Folder folder;
  EXPECT_THROW(read_case(folder / "none.toml", false, {}), std::invalid_argument);
  try {
    read_case(folder.path(), false, {});
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr("is a folder, expected a case file"));
  }
}

TEST(CaseErrors, AFileWithoutKeysIsNoCase) {
  const Folder folder;
  for (const char* text : {"", "# nothing\n", "\n\n"}) {
    try {
      read_case(folder.write("none.toml", text), false, {});
      FAIL() << text;
    } catch (const std::invalid_argument& e) {
      EXPECT_THAT(e.what(), HasSubstr("none.toml: holds no key; a case names at least its study"));
    }
  }
}

// Random bytes and random cuts of a valid file: always a case or one line, never anything else.
TEST(CaseErrors, RandomDamageGivesOneLine) {
  std::mt19937 random(11);
  const std::string good = testing::tiny_case();
  int refused = 0;
  for (int n = 0; n < 300; ++n) {
    std::string text = good;
    const int changes = 1 + static_cast<int>(random() % 3);
    for (int c = 0; c < changes; ++c)
      text[random() % text.size()] = static_cast<char>(32 + random() % 95);
    if (n % 3 == 0) text.resize(random() % text.size());
    refused += complaint(text).empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 100);
}

TEST(ShippedCases, AreValidWithTitleAndQuickSetting) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(GRAINFIELD_CASES)) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    const std::string file = entry.path().string();
    EXPECT_NO_THROW(read_case(file, false, {})) << file;
    EXPECT_NO_THROW(read_case(file, true, {})) << file;
    EXPECT_FALSE(case_title(file).empty()) << file;
    EXPECT_NE(write_case(read_case(file, true, {})), write_case(read_case(file, false, {})))
        << file;
  }
  EXPECT_GE(count, 6);
}

}  // namespace
}  // namespace grainfield::coupling
