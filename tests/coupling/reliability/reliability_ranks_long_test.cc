// Ranks under mpirun: an interrupt, a kill or a failure of one of them ends all of them soon, with
// an exit code, and what was computed is resumed to the same bits.
#include <gmock/gmock.h>

#include "tests/coupling/reliability_cases.h"
#include "tests/coupling/reliability_state.h"

namespace grainfield::coupling::testing {
namespace {

// All ranks have ended by then, also on a busy machine. s
constexpr double kSoon = 30;

bool has_mpirun() { return std::system("command -v mpirun > /dev/null") == 0; }

// Two ranks; `second`: words for the second alone.
Start under_mpirun(const std::vector<std::string>& words, const Folder& temporary,
                   const std::vector<std::string>& second = {}) {
  Start start{words,
              {"mpirun", "--oversubscribe", "-np", second.empty() ? "2" : "1"},
              "",
              {{"OMPI_ALLOW_RUN_AS_ROOT", "1"},
               {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"},
               {"TMPDIR", temporary.path()}}};
  if (!second.empty()) {
    start.words.insert(start.words.end(), {":", "-np", "1", GRAINFIELD_PROGRAM});
    start.words.insert(start.words.end(), words.begin(), words.end());
    start.words.insert(start.words.end(), second.begin(), second.end());
  }
  return start;
}

// The children of a process and its threads.
std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> out;
  std::error_code gone;
  for (const auto& task :
       fs::directory_iterator("/proc/" + std::to_string(parent) + "/task", gone)) {
    std::istringstream numbers(read_text(task.path().string() + "/children"));
    for (pid_t child = 0; numbers >> child;) out.push_back(child);
  }
  return out;
}

struct Case {
  std::string folder, file;
  Contents whole;
};

Case tiny(const Folder& folder) {
  Case out{folder / "out",
           folder.write("x.toml", small_layer("[sweep]\nkey = \"material.friction\"\n"
                                              "values = [0.2, 0.5]\n")),
           {}};
  EXPECT_EQ(finish({{"run", out.file, "-o", folder / "whole"}, {}, "", {}}).code, 0);
  out.whole = results_in(folder / "whole");
  return out;
}

void expect_resumes(const Case& study) {
  EXPECT_FALSE(fs::exists(study.folder + "/summary.json"));
  Start start{{"run", study.file, "-o", study.folder, "--resume"}, {}, "", {}};
  const Ending ending = finish(start);
  EXPECT_EQ(ending.code, 0) << ending;
  EXPECT_EQ(difference(study.whole, results_in(study.folder)), "");
  EXPECT_EQ(leftovers(study.folder), "");
}

enum class To { mpirun, first, second, all };

void interrupt(To to, int signal, const char* phase) {
  SCOPED_TRACE(std::string(strsignal(signal)) + " to " + std::to_string(static_cast<int>(to)) +
               ", " + phase);
  const Folder folder, temporary;
  const Case study = tiny(folder);
  Child child(under_mpirun({"run", study.file, "-o", study.folder, "--checkpoint-seconds", "0.02"},
                           temporary));
  ASSERT_TRUE(child.wait_until([&] { return child.err().find(phase) != std::string::npos; }))
      << child.wait();
  if (std::string(phase) == "of grains") {
    child.wait_until([&] {
      for (const auto& entry : fs::directory_iterator(study.folder + "/checkpoint")) {
        if (entry.path().extension() == ".checkpoint") return true;
      }
      return false;
    });
  }
  const std::vector<pid_t> ranks = children_of(child.pid());
  ASSERT_EQ(ranks.size(), 2U);
  if (to == To::mpirun) child.send(signal);
  if (to == To::all) child.send_group(signal);
  if (to == To::first || to == To::all) kill(ranks[0], signal);
  if (to == To::second || to == To::all) kill(ranks[1], signal);
  const Ending ending = child.wait(kSoon);
  EXPECT_FALSE(ending.late) << ending;
  // The last to come may already find everything in its place.
  if (fs::exists(study.folder + "/summary.json")) {
    EXPECT_EQ(difference(study.whole, results_in(study.folder)), "");
    return;
  }
  EXPECT_NE(ending.code, 0) << ending;
  expect_resumes(study);
}

TEST(Ranks, InterruptsOfOneAndAll) {
  if (!has_mpirun()) GTEST_SKIP() << "no mpirun";
  for (const To to : {To::mpirun, To::first, To::second, To::all}) {
    for (const int signal : {SIGINT, SIGTERM}) interrupt(to, signal, "of grains");
  }
}

TEST(Ranks, InterruptsOfTheAnalysis) {
  if (!has_mpirun()) GTEST_SKIP() << "no mpirun";
  interrupt(To::mpirun, SIGINT, "models and comparison");
  interrupt(To::second, SIGTERM, "models and comparison");
  interrupt(To::first, SIGINT, "outputs");
  interrupt(To::second, SIGINT, "outputs");
}

TEST(Ranks, OneIsKilled) {
  if (!has_mpirun()) GTEST_SKIP() << "no mpirun";
  interrupt(To::first, SIGKILL, "of grains");
  interrupt(To::second, SIGKILL, "of grains");
  interrupt(To::second, SIGKILL, "outputs");
}

// What only the second rank has been told; the first must not wait for it for ever.
void fail_on_second(const std::vector<std::string>& second, const std::string& words) {
  SCOPED_TRACE(second.back());
  const Folder folder, temporary;
  const Case study = tiny(folder);
  const Ending ending =
      finish(under_mpirun({"run", study.file, "-o", study.folder}, temporary, second), kSoon);
  EXPECT_FALSE(ending.late) << ending;
  EXPECT_NE(ending.code, 0) << ending;
  EXPECT_THAT(ending.err, ::testing::HasSubstr(words));
  expect_resumes(study);
}

TEST(Ranks, OneFailsAlone) {
  if (!has_mpirun()) GTEST_SKIP() << "no mpirun";
  fail_on_second({"--set", "average.width=1e-6"}, "no point has enough grains");
  fail_on_second({"--set", "rest.max_time=1e-3"}, "rest.max_time");
}

}  // namespace
}  // namespace grainfield::coupling::testing
