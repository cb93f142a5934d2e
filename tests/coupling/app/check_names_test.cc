// Lists, labels and members of sweeps that a run could not use.
#include "coupling/case/keys.h"
#include "coupling/case/study.h"
#include "tests/coupling/check_scene.h"

namespace grainfield::coupling {
namespace {

using testing::complaint;
using ::testing::HasSubstr;

bool is_list(const Key& key) { return !entries_allowed(key).empty(); }

TEST(CheckLists, NoneIsEmptyThatTheAnalysisNeeds) {
  int seen = 0;
  for (const Study& study : studies()) {
    const std::string text = testing::small_case(study.name);
    ASSERT_EQ(complaint(text), "");
    for (const Key& key : keys()) {
      if (!is_list(key) || !key_applies(key, study.name) || key.section == "sweep") continue;
      const std::string what = complaint(text, {key.path() + "=[]"});
      if (!key.may_be_empty) {
        EXPECT_THAT(what, HasSubstr(key.path() + ": found an empty list, expected ")) << study.name;
        ++seen;
      } else if (key.path() != "compare.models") {
        EXPECT_EQ(what, "") << study.name << " " << key.path();
      }
    }
  }
  EXPECT_GE(seen, 14);
  EXPECT_THAT(complaint("[average]\nmethods = []\n"),
              HasSubstr("x.toml:2: average.methods: found an empty list, expected one or more"));
}

TEST(CheckLists, NoValueStandsTwice) {
  EXPECT_THAT(complaint("[average]\nmethods = [\"coarse_graining\", \"coarse_graining\"]\n"),
              HasSubstr("x.toml:2: average.methods: found coarse_graining twice, allowed: every "
                        "entry once"));
  // Curves and keys are named by six digits.
  EXPECT_THAT(complaint("[average]\ndepths = [0.5, 0.25, 0.50000001]\n"),
              HasSubstr("average.depths: found 0.50000001 beside 0.5, allowed: numbers that "
                        "differ in their first six digits"));
  EXPECT_THAT(complaint("[average]\ndepths = [0.50000001, 0.50000001]\n"),
              HasSubstr("average.depths: found 0.50000001 twice, allowed: every entry once"));
  EXPECT_THAT(complaint("study = \"pile-fields\"\n[fields]\ntopics = [\"fabric\", \"fabric\"]\n"),
              HasSubstr("fields.topics: found fabric twice"));
  EXPECT_THAT(complaint("study = \"pile\"\n[grains]\nfiles = [\"a.h5\", \"a.h5\"]\n"),
              HasSubstr("grains.files: found a.h5 twice"));
  // Corners of an outline share coordinates.
  EXPECT_EQ(complaint("study = \"pile\"\n[source]\ngrains = 500\n[shape]\nkind = \"outline\"\n"
                      "outline = [-1, -1, 1, -1, 1, 1, -1, 1]\n"),
            "");
}

TEST(CheckLists, NoneIsLongerThanAThousand) {
  std::string depths = "[average]\ndepths = [0.5";
  for (int k = 0; k < 1000; ++k) depths += ", 0.25";
  EXPECT_THAT(complaint(depths + "]\n"),
              HasSubstr("average.depths: found 1001 entries, allowed: up to 1000"));
}

std::string labelled(const std::string& label) {
  return "[compare]\nmodels = [\"" + label + "\"]\n[model.\"" + label + "\"]\nname = \"layer\"\n";
}

TEST(CheckLabels, AreThoseThatNameFieldsAndKeys) {
  EXPECT_EQ(complaint(labelled("rough_1-b")), "");
  EXPECT_THAT(complaint(labelled("ro ugh")),
              HasSubstr("x.toml:4: model.ro ugh: found the label \"ro ugh\", allowed: up to 100 "
                        "letters, digits, _ and -"));
  EXPECT_THAT(complaint(labelled("a/b")), HasSubstr("found the label \"a/b\""));
  EXPECT_THAT(complaint(labelled(std::string(101, 'a'))), HasSubstr("found the label"));
  EXPECT_THAT(complaint("[model.\"\"]\nname = \"layer\"\n"), HasSubstr("found the label \"\""));
  EXPECT_THAT(complaint("[compare]\nmodels = [\"Layer\", \"layer\"]\n[model.Layer]\n"
                        "name = \"layer\"\nnu = 0.2\n"),
              HasSubstr("compare.models: \"Layer\" and \"layer\" differ in small and capital"));
  std::string many;
  for (int k = 0; k < 201; ++k) many += "[model.m" + std::to_string(k) + "]\nname = \"layer\"\n";
  EXPECT_THAT(complaint(many), HasSubstr("found 201 tables [model.LABEL], allowed: up to 200"));
}

std::string variants(const std::vector<std::string>& names) {
  std::string out, list;
  for (const std::string& name : names) {
    list += (list.empty() ? "\"" : ", \"") + name + "\"";
    out += "[variant.\"" + name + "\".material]\nfriction = 0." + std::to_string(out.size()) + "\n";
  }
  return "[sweep]\nkey = \"variant\"\nvalues = [" + list + "]\n" + out;
}

TEST(CheckMembers, DoNotShareAFolder) {
  EXPECT_EQ(complaint(variants({"soft", "hard"})), "");
  EXPECT_THAT(
      complaint(variants({"a/b", "a_b"})),
      HasSubstr("x.toml:3: sweep.values: found \"a_b\", whose folder would be \"a_b\": that "
                "of \"a/b\" as well; choose another name"));
  EXPECT_THAT(complaint(variants({"Soft", "soft"})), HasSubstr("that of \"Soft\" as well"));
  EXPECT_THAT(complaint("[sweep]\nkey = \"packing.kind\"\nvalues = [\"triangular\", "
                        "\"\\\"triangular\\\"\"]\n"),
              HasSubstr("sweep.values"));
}

TEST(CheckMembers, LeaveTheRunItsOwnNames) {
  for (const std::string name : {"checkpoint", "Checkpoint", "standard_error", "least"}) {
    EXPECT_THAT(complaint(variants({name, "other"})),
                HasSubstr("sweep.values: found \"" + name + "\", whose folder"));
  }
  EXPECT_THAT(complaint(variants({"checkpoint"})), HasSubstr("the run keeps its state"));
  EXPECT_THAT(
      complaint("[sweep]\nkey = \"title\"\nvalues = [\"a.h5\", \"b\"]\n"),
      HasSubstr("whose folder would be \"title_a.h5\": files named *.h5 are the run's own"));
  EXPECT_THAT(complaint(variants({""})), HasSubstr("allowed: a name"));
  EXPECT_THAT(complaint(variants({std::string(101, 'a')})),
              HasSubstr("101 characters, allowed: up to 100"));
  EXPECT_EQ(complaint(variants({std::string(100, 'a')})), "");
}

}  // namespace
}  // namespace grainfield::coupling
