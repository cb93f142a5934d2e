// Keys of [material] that follow from others, and what is said of the contacts.
#include <filesystem>

#include "coupling/case/apply.h"
#include "coupling/case/material.h"
#include "coupling/case/shipped_cases.h"
#include "coupling/studies/point_load/simulation.h"
#include "coupling/studies/sample/simulation/setup.h"
#include "dem/laws/material_defaults.h"
#include "tests/coupling/check_scene.h"

namespace grainfield::coupling {
namespace {

using testing::accepted;
using testing::complaint;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kLayer = "study = \"point-load\"\n[material]\nlaw = \"linear\"\n";

const dem::MaterialSetup& material(const Case& value) {
  return value.get<dem::PointLoadSetup>().material;
}

// The mistake that began this: 20 kN/m alone left k_t at 2.857e6 N/m, k_t/k_n = 143.
TEST(CaseMaterial, DefaultsFollowTheNormalStiffness) {
  const Case one = accepted(kLayer + "normal_stiffness = \"20 kN/m\"\n");
  EXPECT_EQ(material(one).tangential_stiffness, 2 * 2e4 / 7);
  EXPECT_THAT(one.without_effect, IsEmpty());
  EXPECT_THAT(material_text(one), HasSubstr("k_t/k_n = 0.286, restitution 0.9 of two disks of "
                                            "radius 4.5 mm at 0.42 m/s"));
  EXPECT_DOUBLE_EQ(material(one).tangential_damping, 0.5 * material(one).normal_damping);
  // Twice the frequency, twice the dashpot.
  const Case stiff = accepted(kLayer + "normal_stiffness = \"80 kN/m\"\n");
  EXPECT_NEAR(material(stiff).normal_damping / material(one).normal_damping, 2, 1e-12);
  // What is given stays.
  const Case given = accepted(
      kLayer + "normal_stiffness = 2e4\ntangential_stiffness = 1e4\nnormal_damping = 70\n");
  EXPECT_EQ(material(given).tangential_stiffness, 1e4);
  EXPECT_EQ(material(given).normal_damping, 70);
  EXPECT_EQ(material(given).tangential_damping, 35);
  EXPECT_NEAR(material(given).restitution, 0.7, 0.25);
  // Also where nothing is given: today's numbers of k_t, to the bit.
  EXPECT_EQ(material(accepted(kLayer)).tangential_stiffness, 2e7 / 7);
}

TEST(CaseMaterial, ARestitutionSetsTheDashpotOfEveryLawThatHasOne) {
  const auto left = [](const std::string& text, int dim) {
    const Case value = accepted(text);
    const double radius = nominal_grain(value)->radius;
    return dem::head_on_restitution(value.get<dem::SampleSetup>().material, {dim, radius}, 0.1);
  };
  const std::string plane = "study = \"sample\"\n[material]\nrestitution = 0.6\nlaw = ";
  const std::string space =
      "study = \"sample\"\nsample.dim = 3\nsample.shape = \"sphere\"\n[material]\n"
      "restitution = 0.6\nlaw = ";
  EXPECT_NEAR(left(plane + "\"linear\"\n", 2), 0.6, 1e-4);
  EXPECT_NEAR(left(plane + "\"penalty\"\n", 2), 0.6, 1e-4);
  EXPECT_NEAR(left(space + "\"hertz\"\n", 3), 0.6, 1e-4);
  // Its dashpot lies between the speeds' extremes: at the deepest overlap of the time step's limit.
  const double light = left(space + "\"hertz\"\ndamping_model = \"viscoelastic\"\n", 3);
  EXPECT_GT(light, 0.6);
  EXPECT_LT(light, 0.95);
}

TEST(CaseMaterial, ARestitutionThatContradictsTheDashpotIsRefused) {
  EXPECT_THAT(complaint(kLayer + "restitution = 0.5\nnormal_damping = 500\n"),
              HasSubstr("x.toml:4: material.restitution: found 0.5 with material.normal_damping = "
                        "500, which leaves 0.9"));
  // A law of the overlap's area has no restitution for all speeds.
  EXPECT_THAT(accepted("study = \"point-load\"\n[material]\nrestitution = 0.5\n").without_effect,
              ElementsAre(HasSubstr("material.restitution: has no effect, only with material.law = "
                                    "linear or penalty or hertz or hertz_elliptic")));
}

TEST(CaseMaterial, MembersOfASweepFollowTheirOwnStiffness) {
  const Case value =
      accepted(kLayer + "[sweep]\nkey = \"material.normal_stiffness\"\nvalues = [1e5, 4e5]\n");
  const auto members = sweep_cases(value);
  ASSERT_EQ(members.size(), 2U);
  EXPECT_EQ(material(members[0].value).tangential_stiffness, 2e5 / 7);
  EXPECT_EQ(material(members[1].value).tangential_stiffness, 8e5 / 7);
  EXPECT_NEAR(material(members[1].value).normal_damping / material(members[0].value).normal_damping,
              2, 1e-12);
}

TEST(CaseMaterial, AWrittenOutCaseIsTheSame) {
  for (const std::string set :
       {"law = \"linear\"\nnormal_stiffness = 3e4\n", "law = \"penalty\"\nrestitution = 0.7\n"}) {
    const Case value = accepted("study = \"point-load\"\n[material]\n" + set);
    const std::string text = write_case(value);
    EXPECT_EQ(write_case(accepted(text)), text);
  }
}

TEST(CaseMaterial, UnusualRatiosAreWarnedOf) {
  EXPECT_THAT(
      accepted(kLayer + "normal_stiffness = 2e4\ntangential_stiffness = 2.857e6\n").without_effect,
      ElementsAre(
          HasSubstr("x.toml:5: material.tangential_stiffness: found 2.857e+06, k_t/k_n = "
                    "143; usual: 0.09 to 1.5; the time step is 12 times shorter than with "
                    "the normal spring alone; without this key it is 2/7 of k_n, 5714 N/m")));
  EXPECT_THAT(
      accepted(kLayer + "normal_damping = 0.5\n").without_effect,
      ElementsAre(HasSubstr("x.toml:4: material.normal_damping: found 0.5 1/s, which leaves "
                            "a restitution of 1 of two grains of radius 4.5 mm")));
  EXPECT_THAT(accepted(kLayer + "normal_damping = 0\n").without_effect, IsEmpty());
}

TEST(CaseMaterial, CheckSaysWhatTheStepFollows) {
  const testing::Folder folder;
  const auto says = [&](const std::string& more) {
    const testing::Output out = testing::program("check " + folder.write("x.toml", kLayer + more));
    EXPECT_EQ(out.code, 0) << out.err;
    return out.out;
  };
  EXPECT_THAT(
      says("normal_stiffness = 2e4\n"),
      HasSubstr("  contacts: k_t/k_n = 0.286, restitution 0.9 of two disks of radius 4.5 mm "
                "at 0.42 m/s\n  the step follows the normal spring\n"));
  EXPECT_THAT(says("tangential_stiffness = 2e7\n"), HasSubstr("follows the tangential spring\n"));
  EXPECT_THAT(says("normal_damping = 1e6\n"), HasSubstr("follows the dashpots\n"));
  EXPECT_THAT(says("[motion]\ntime_step = 1e-6\n"), HasSubstr("follows motion.time_step\n"));
}

// The integrated motion against the closed form of a spring and dashpot.
TEST(CaseMaterial, TheRestitutionIsThatOfTheClosedForm) {
  dem::MaterialSetup m;
  m.law = "penalty";
  m.normal_stiffness = 1e5;
  for (const double share : {0.0, 0.05, 0.3, 0.75, 1.0, 2.0}) {
    m.damping = share;
    EXPECT_NEAR(dem::head_on_restitution(m, {2, 0.01}, 0.3), dem::restitution_of_dashpot(share),
                1e-4)
        << share;
  }
  for (const double e : {0.01, 0.3, 0.9, 0.999, 1.0}) {
    EXPECT_NEAR(dem::restitution_of_dashpot(dem::dashpot_of_restitution(e)), e, 1e-12) << e;
  }
}

// So that a default can change without the shipped cases' bits.
TEST(CaseMaterial, ShippedCasesLeaveNothingToADefaultThatFollows) {
  const auto look = [](const std::string& name, const Case& value) {
    for (const Key& key : keys()) {
      if (key.follows.empty() || !key_applies(key, value.study)) continue;
      if (is_without_effect(key, value)) continue;
      const dem::MaterialSetup& m = find_study(value.study)->material(const_cast<Case&>(value));
      const bool dashpots = key.name == "normal_damping" || key.name == "tangential_damping";
      if (dashpots && m.law == "hertz" && m.damping_model == "critical") continue;
      EXPECT_TRUE(value.given.contains(key.path())) << name << ": " << key.path();
    }
  };
  // As written, without what finish() draws.
  int read = 0;
  for (const auto& file : shipped_cases()) {
    const std::vector<Assignment> all = read_document(file.string());
    Draft draft;
    for (const bool study : {true, false}) {
      for (const Assignment& a : all) {
        if (a.path.starts_with("quick") || (a.path == "study") != study) continue;
        apply(draft, a);
      }
    }
    if (find_study(draft.value.study)->material == nullptr) continue;
    ++read;
    const std::vector<Variant> variants = draft.value.variants;
    draft.value.sweep = {};
    if (variants.empty()) look(file.filename().string(), draft.value);
    for (const Variant& variant : variants) {
      Draft one = draft;
      for (const std::string& key : variant.keys) apply(one, parse_override(key));
      look(file.filename().string() + " " + variant.name, one.value);
    }
  }
  EXPECT_GT(read, 20);
}

}  // namespace
}  // namespace grainfield::coupling
