// The pipeline from contact forces to the verdict, on packings that carry a known field.
#include "tests/coupling/known_truth.h"

#include <gmock/gmock.h>

#include "coupling/result/tables.h"
#include "coupling/store/field_io.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;

// Resultants of a few contacts of a grain, over the mean contact force: round-off.
constexpr double kRoundOff = 1e-11;

double rel_l2(const Eigen::MatrixXd& seen, const Eigen::MatrixXd& exact) {
  const auto known = seen.array().isFinite() && exact.array().isFinite();
  return std::sqrt(known.select((seen - exact).array().square(), 0).sum() /
                   known.select(exact.array().square(), 0).sum());
}

Eigen::MatrixXd stresses(const Field& field) {
  Eigen::MatrixXd out(field.points.rows(), 3);
  for (int c = 0; c < 3; ++c)
    out.col(c) = field.find(kPlaneStress[static_cast<std::size_t>(c)])->value;
  return out;
}

TEST(KnownTruth, EveryGrainIsBalanced) {
  test::KnownTally tally;
  test::KnownLayers layers;
  layers.setup.disorder.noise = 1;
  for (std::size_t truth = 0; truth < layers.models.size(); ++truth) {
    layers.fields(truth, 2, 10 * truth + 1, tally);
  }
  EXPECT_LT(tally.imbalance, kRoundOff);
  RunFacts facts;
  facts.numbers = {{"phi_deg", 28}, {"rho_g", grainfield::test::carried_rho_g()}};
  for (const auto& truth : test::heap_truths()) {
    const dem::Snapshot heap =
        grainfield::test::carried_heap({}, test::stress_of(truth.text, facts));
    EXPECT_LT(grainfield::test::largest_imbalance(heap), kRoundOff) << truth.text;
    // The check sees a force that is off by a millionth.
    dem::Snapshot off = heap;
    off.contacts[off.contacts.size() / 2].force *= 1 + 1e-6;
    EXPECT_GT(grainfield::test::largest_imbalance(off), 1e-9) << truth.text;
  }
}

// What an average of many layers has to converge to is the field itself, seen through the kernel:
// at half the depth and below, where the kernel smooths little.
TEST(KnownTruth, TheAverageIsTheFieldThatTheForcesCarry) {
  test::KnownLayers layers;
  layers.setup.disorder.noise = 0;
  for (std::size_t truth = 0; truth < layers.models.size(); ++truth) {
    test::KnownTally tally;
    const NamedFields fields = layers.fields(truth, 4, 100 * truth + 1, tally);
    RunFacts facts;
    facts.force = layers.setup.load;
    facts.height = layers.setup.depth();
    const auto stress = test::stress_of(layers.models[truth], facts);
    const Field& field = fields.front().second;
    Eigen::MatrixXd exact = stress(field.points);
    for (Eigen::Index k = 0; k < exact.rows(); ++k) {
      if (field.points(k, 1) > -0.45 * facts.height) exact.row(k).setConstant(kNan);
    }
    EXPECT_LT(rel_l2(stresses(field), exact), 0.1) << layers.models[truth];
  }
}

TEST(KnownTruth, LayersGiveTheirModelBack) {
  test::KnownLayers layers;
  for (const std::size_t truth : {0U, 1U}) {  // a half plane, a layer; known_truth_long_test: all
    test::KnownTally tally;
    layers.strike(truth, 8, 1000 * truth + 1, tally);
    EXPECT_EQ(tally.best, 1) << layers.models[truth] << ": " << tally.text();
    EXPECT_EQ(tally.wrong, 0) << layers.models[truth] << ": " << tally.text();
  }
}

TEST(KnownTruth, HeapsGiveTheirModelBack) {
  test::KnownHeaps heaps;
  for (const auto& truth : test::heap_truths()) {
    test::KnownTally tally;
    heaps.strike(truth, 6, 1, tally);
    EXPECT_EQ(tally.best, 1) << truth.text << ": " << tally.text();
    EXPECT_EQ(tally.wrong, 0) << truth.text << ": " << tally.text();
  }
}

// The same by commands, file by file.
TEST(KnownTruth, CommandsLeadFromTablesToTheVerdict) {
  const Folder folder;
  test::KnownLayers layers;
  RunFacts facts;
  facts.force = layers.setup.load;
  facts.height = layers.setup.depth();
  const auto smooth = test::stress_of("layer:base=smooth", facts);
  for (int r = 1; r <= 3; ++r) {
    layers.setup.disorder.seed = static_cast<std::uint64_t>(r);
    const auto made = grainfield::test::carried_layer(layers.setup, smooth);
    for (const auto& [name, state] :
         {std::pair{"unloaded", &made.unloaded}, std::pair{"loaded", &made.loaded}}) {
      std::string files;
      files += folder.write("grains.csv", grainfield::test::csv_grains(*state)) + " ";
      files += folder.write("contacts.csv", grainfield::test::csv_contacts(*state)) + " ";
      files += folder.write("walls.csv", grainfield::test::csv_walls(*state));
      const std::string load =
          state->loaded_grain < 0 ? "" : fmt::format(" --load {}=0,-10", state->loaded_grain);
      const Output out = program(fmt::format("import --from csv {} --group r{}/{} --add{} -o {}",
                                             files, r, name, load, folder / "layers.h5"));
      ASSERT_EQ(out.code, 0) << out.err;
      EXPECT_THAT(out.out, HasSubstr("weight carried by walls and fixed grains: 1\n"));
      // The lattice leaves gaps to its sides, and noise makes some contacts pull.
      EXPECT_THAT(out.err, ::testing::Not(::testing::ContainsRegex("unbalanced|weight|hardly")));
    }
  }
  const Output average =
      program("average --response " + (folder / "layers.h5") +
              " --cuts 0.25 0.5 0.75 --grid 61x3 --width 0.0135 -o " + (folder / "field.h5"));
  ASSERT_EQ(average.code, 0) << average.err;
  const Output compare =
      program("compare " + (folder / "field.h5") +
              " --model flamant --model smooth=layer:base=smooth -o " + (folder / "verdict"));
  ASSERT_EQ(compare.code, 0) << compare.err;
  const Summary summary = read_summary(folder / "verdict/summary.json");
  EXPECT_EQ(std::get<std::string>(summary.at("verdict.best_model")), "smooth") << compare.out;
}

}  // namespace
}  // namespace grainfield::coupling
