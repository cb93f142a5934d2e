// Models fitted to layers under a point load, from case file to report; variants; layers from
// files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupling/case/case.h"
#include "coupling/result/tables.h"
#include "tests/coupling/layer_verdict_case.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling::testing {
namespace {

using ::testing::HasSubstr;

std::string refusal(const Folder& folder, const std::string& text) {
  const std::string file = folder.write("bad.toml", text);
  const Output out = program("check " + file);
  EXPECT_EQ(out.code, 2) << out.err;
  return out.err;
}

TEST(LayerVerdictRun, FromCaseToReport) {
  const Folder folder;
  const std::string file = folder.write("verdict.toml", tiny_verdict());
  const Output run = program("run " + file + " -o " + (folder / "out"));
  ASSERT_EQ(run.code, 0) << run.err;
  for (const char* name :
       {"out/report.html", "out/summary.json", "out/even/report.html", "out/even/fits.csv",
        "out/even/fits.md", "out/even/fits.tex", "out/even/profiles.csv", "out/even/fields.h5",
        "out/uneven/report.html"}) {
    EXPECT_TRUE(fs::exists(folder / name)) << name;
  }
  const Summary all = read_summary(folder / "out/summary.json");
  for (const char* key :
       {"verdict.best_model.even", "verdict.equations.uneven", "verdict.sentence.even",
        "fit.layer_rough.nu.even", "fit.osl_layer_absorbing.eta.uneven",
        "fit.layer_smooth.heights_behind.even", "compare.layer_rough.rel_l2.even"}) {
    EXPECT_EQ(all.count(key), 1U) << key;
  }
  const std::string page = read_text(folder / "out/report.html");
  EXPECT_THAT(page, HasSubstr("even: grains, model and residual"));
  EXPECT_THAT(page, HasSubstr("uneven: models"));
  EXPECT_THAT(read_text(folder / "out/even/report.html"), HasSubstr("Directions of the contacts"));

  // The written-out case is the same study.
  const Case again = read_case(folder / "out/case.toml", false, {});
  ASSERT_EQ(again.variants.size(), 2U);
  EXPECT_EQ(again.variants[1].keys, std::vector<std::string>{"packing.jitter=0.04"});
  EXPECT_EQ(write_case(again), read_text(folder / "out/case.toml"));

  // The same layers from files: the same fits, also with other kernels beside its own.
  const std::string from =
      folder.write("from.toml", tiny_verdict("[variant.uneven.grains]\nfiles = [\"" +
                                             (folder / "out/uneven/snapshots.h5") + "\"]\n"));
  const Output second = program("run " + from + " -o " + (folder / "from") +
                                " --set sweep.values=[\\\"uneven\\\"] --set 'fit.kernel=[1, 40]'");
  ASSERT_EQ(second.code, 0) << second.err;
  EXPECT_EQ(read_text(folder / "from/uneven/fits.csv"), read_text(folder / "out/uneven/fits.csv"));
  const std::string verdict = read_text(folder / "from/uneven/verdict.md");
  EXPECT_THAT(verdict, HasSubstr("The verdict is the same at kernel widths of 1 diameters."));
  EXPECT_THAT(verdict, HasSubstr("Kernel widths of 40 diameters leave too few values."));
}

TEST(LayerVerdictRun, NoSpreadNoVerdict) {
  const Folder folder;
  const std::string file = folder.write("verdict.toml", tiny_verdict());
  const Output run = program("run " + file + " -o " + (folder / "out") +
                             " --set ensemble.realizations=1 --set sweep.values=[\\\"even\\\"]");
  ASSERT_EQ(run.code, 0) << run.err;
  const Summary all = read_summary(folder / "out/even/summary.json");
  EXPECT_THAT(std::get<std::string>(all.at("verdict.sentence")),
              ::testing::StartsWith("One layer cannot distinguish models: "));
}

TEST(LayerVerdictRun, MistakesAreNamed) {
  const Folder folder;
  EXPECT_THAT(refusal(folder, tiny_verdict("[variant.third.packing]\njiter = 0.1\n")),
              HasSubstr("packing.jiter: unknown key; did you mean packing.jitter"));
  EXPECT_THAT(refusal(folder, tiny_verdict("[variant.third.packing]\njitter = 2\n")),
              HasSubstr("packing.jitter: found 2"));
  EXPECT_THAT(refusal(folder, tiny_verdict("[variant.third.sweep]\nkey = \"x\"\n")),
              HasSubstr("variant.third.sweep.key: cannot be part of a variant"));
  std::string text = tiny_verdict();
  text.replace(text.find("\"uneven\"]"), 9, "\"unevn\"]");
  EXPECT_THAT(refusal(folder, text),
              HasSubstr("found \"unevn\", allowed: even, uneven; did you mean uneven"));
  EXPECT_THAT(refusal(folder, tiny_verdict("[fit.models]\n")), HasSubstr("fit.models"));
  text = tiny_verdict();
  text.replace(text.find("\"flamant\""), 9, "\"flamand\"");
  EXPECT_THAT(refusal(folder, text), HasSubstr("found \"flamand\", allowed: flamant |"));
  text = tiny_verdict("[variant.uneven.grains]\nfiles = [\"nowhere.h5\"]\n");
  EXPECT_THAT(refusal(folder, text), HasSubstr("nowhere.h5"));
}

}  // namespace
}  // namespace grainfield::coupling::testing
