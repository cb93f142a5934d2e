// Runs that are interrupted anywhere lose nothing: the short form of
// reliability_interrupts_long_test.cc.
#include "tests/coupling/reliability_interrupts.h"

namespace grainfield::coupling::testing {
namespace {

TEST(Interrupts, NothingIsLost) { interrupt_runs(5, 2, 0.3).print("interrupts"); }

// Each of these lost something once.
TEST(Interrupts, AtEverySpot) {
  Tally tally;
  std::mt19937 random(attack_seed());
  const std::vector<std::pair<const char*, Blow>> spots{
      {"layer", {Aim::pictures, SIGINT, true, 1, 0.02}},
      {"layer", {Aim::analysis, SIGTERM, false, 1, 0}},
      {"layer", {Aim::publishing, SIGHUP, false, 2, 0}},
      {"layer", {Aim::publishing, SIGKILL, false, 1, 0}},
      {"models", {Aim::analysis, SIGINT, false, 1, 0}}};
  for (const auto& [study, blow] : spots) {
    InterruptedRun run(reference(study), true, random, tally);
    run.strike(blow);
    run.resume_to_the_end();
  }
}

TEST(Interrupts, DamagedCheckpointsStartAgain) {
  Tally tally;
  std::mt19937 random(attack_seed());
  for (int round = 0; round < 2; ++round) {
    InterruptedRun run(reference("layer"), false, random, tally);
    run.strike({Aim::grains, SIGINT, false, 1, 0.4 * reference("layer").seconds});
    if (run.work()) run.damage();
    run.resume_to_the_end();
  }
}

// Whoever starts a long run by nohup and closes the terminal wants it to go on.
TEST(Interrupts, NohupHolds) {
  const Folder folder;
  const std::string file = folder.write("x.toml", small_layer());
  Child child({{"run", file, "-o", folder / "out"}, {"nohup"}, "", {}});
  child.wait_until([&] { return fs::exists(folder / "out/checkpoint/case.toml"); });
  child.send(SIGHUP);
  child.send_group(SIGHUP);
  const Ending ending = child.wait();
  EXPECT_EQ(ending.code, 0) << ending;
}

}  // namespace
}  // namespace grainfield::coupling::testing
