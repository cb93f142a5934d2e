// Runs that are interrupted at random instants and resumed until they are done.
#pragma once
#include <gmock/gmock.h>

#include <optional>
#include <random>

#include "reliability_cases.h"
#include "reliability_state.h"

namespace grainfield::coupling::testing {

/// Where in a run a signal is meant to strike.
enum class Aim { anywhere, opening, grains, analysis, pictures, publishing };
inline constexpr std::array kAims{Aim::anywhere, Aim::opening,  Aim::grains,
                                  Aim::analysis, Aim::pictures, Aim::publishing};

struct Blow {
  Aim aim = Aim::anywhere;
  int signal = SIGINT;
  bool group = false;  ///< to the whole process group, as a terminal does
  int times = 1;
  double delay = 0;  ///< s after the aim is met
  double between = 0;
};

inline std::string name_of(const Blow& blow) {
  constexpr std::array kNames{"anywhere", "opening",  "grains",
                              "analysis", "pictures", "publishing"};
  return std::to_string(blow.times) + " x " + strsignal(blow.signal) +
         (blow.group ? " to the group, " : ", ") + kNames[static_cast<std::size_t>(blow.aim)] +
         " + " + std::to_string(blow.delay) + " s";
}

struct Tally {
  int signals = 0;          ///< sent to a run that was alive
  int killed = 0;           ///< of these, kill -9
  int stopped = 0;          ///< ended in 130
  int unborn = 0;           ///< ended before the program had begun to look at signals
  int whole = 0;            ///< ended in 0 with the whole result
  int finished = 0;         ///< runs that ended, resumed or not, with the same bits
  int damaged = 0;          ///< checkpoints that were damaged before --resume
  std::array<int, 6> at{};  ///< signals by aim

  void print(const char* what) const {
    std::printf(
        "reliability: %s: %d interruptions (kill -9 %d), of them at random %d, while opening %d, "
        "in "
        "the grains %d, the analysis %d, the pictures %d, publishing %d; ended in 130: %d, whole: "
        "%d, before the program began: %d; %d checkpoints damaged; %d runs to the same bits\n",
        what, signals, killed, at[0], at[1], at[2], at[3], at[4], at[5], stopped, whole, unborn,
        damaged, finished);
  }
};

/// A study, its uninterrupted run and an earlier run of other numbers, made once.
class Reference {
 public:
  explicit Reference(const TinyStudy& study)
      : name(study.name), file(folder_.write("x.toml", study.text)) {
    const auto start = std::chrono::steady_clock::now();
    whole = made("whole", {});
    seconds = seconds_since(start);
    earlier = made("earlier", {"--set", study.another});
  }

 private:
  Folder folder_;

 public:
  std::string name, file;
  Contents whole, earlier;
  double seconds = 0;
  std::string earlier_folder() const { return folder_ / "earlier"; }

 private:
  Contents made(const std::string& out, const std::vector<std::string>& more) {
    Start start{{"run", file, "-o", folder_ / out}, {}, "", {}};
    start.words.insert(start.words.end(), more.begin(), more.end());
    const Ending ending = finish(start);
    if (ending.code != 0) throw std::runtime_error(name + ": " + ending.err);
    return results_in(folder_ / out);
  }
};

inline const Reference& reference(const std::string& name) {
  static std::map<std::string, std::unique_ptr<Reference>> made;
  for (const TinyStudy& study : tiny_studies()) {
    if (study.name == name && made.count(name) == 0)
      made[name] = std::make_unique<Reference>(study);
  }
  return *made.at(name);
}

class InterruptedRun {
 public:
  InterruptedRun(const Reference& study, bool over_earlier, std::mt19937& random, Tally& tally)
      : study_(study),
        random_(random),
        tally_(tally),
        before_(over_earlier ? study.earlier : Contents{}) {
    if (over_earlier) fs::copy(study.earlier_folder(), out_, fs::copy_options::recursive);
    fs::create_directory(folder_ / "tmp");
  }

  /// One start that is struck. False where the run has come to its end.
  bool strike(const Blow& blow) {
    Child child(start());
    const std::string what = study_.name + ": " + name_of(blow);
    const std::set<std::string> safe = realizations();
    // What an earlier start left behind is no sign of this one: first it begins.
    const auto in_place = [&] {
      return blow.aim == Aim::anywhere || (child.catches(SIGTERM) && met(blow.aim, child));
    };
    if (!child.wait_until(in_place)) return after(child.wait(), blow, 0, false, safe, what);
    child.wait_until([] { return false; }, blow.delay);
    const bool caught = child.catches(blow.signal);
    int sent = 0;
    for (int k = 0; k < blow.times && child.running(); ++k, ++sent) {
      if (k > 0) sleep_for(blow.between);
      blow.group ? child.send_group(blow.signal) : child.send(blow.signal);
    }
    return after(child.wait(), blow, sent, caught, safe, what);
  }

  /// Every damage is a new start for that realization and no end.
  void damage() {
    for (const auto& entry : fs::directory_iterator(out_ + "/checkpoint")) {
      const std::string file = entry.path().string();
      if (!entry.is_regular_file() || entry.path().filename().string().rfind("realization", 0) != 0)
        continue;
      if (random_() % 4 == 0) continue;
      const auto size = fs::file_size(file);
      const unsigned way = random_() % 3;
      if (way == 0) fs::resize_file(file, size / 2);
      if (way == 1) fs::resize_file(file, 0);
      if (way == 2) {
        std::string noise(size, ' ');
        for (char& byte : noise) byte = static_cast<char>(random_());
        std::ofstream(file, std::ios::binary) << noise;
      }
      ++tally_.damaged;
    }
  }

  bool checkpoint() const { return fs::exists(out_ + "/checkpoint"); }
  bool work() const { return holds_work(out_); }

  /// To the end, undisturbed, if it is not there already: the same bits, and nothing else.
  void resume_to_the_end() {
    if (!done_) {
      const Ending ending = finish(start());
      EXPECT_EQ(ending.code, 0) << study_.name << " resumed: " << ending << history_;
    }
    // Where a kill came when all was in its place, nobody could tidy up: the next run does.
    if (done_ && killed_ && !leftovers(out_).empty()) {
      const Ending ending = finish({{"run", study_.file, "-o", out_}, {}, "", {}});
      EXPECT_EQ(ending.code, 0) << study_.name << " once more: " << ending << history_;
    }
    for (const std::string& orphan : orphans_) fs::remove(out_ + "/" + orphan);
    const std::string wrong = difference(study_.whole, results_in(out_));
    EXPECT_EQ(wrong, "") << study_.name << history_;
    EXPECT_EQ(leftovers(out_), "") << study_.name << history_;
    EXPECT_FALSE(checkpoint()) << study_.name << history_;
    if (wrong.empty()) ++tally_.finished;
  }

 private:
  // Continued where there is something to go on from or the program said so, else started anew.
  Start start() {
    Start out{{"run", study_.file, "-o", out_, "--threads", std::to_string(1 + random_() % 3),
               "--checkpoint-seconds", "0.05"},
              {},
              "",
              {{"TMPDIR", folder_ / "tmp"}}};
    if (work() || told_to_resume_) out.words.emplace_back("--resume");
    return out;
  }

  bool met(Aim aim, Child& child) const {
    const auto said = [&](const char* text) { return child.err().find(text) != std::string::npos; };
    if (aim == Aim::opening) return checkpoint();
    if (aim == Aim::grains) return said("of grains");
    if (aim == Aim::analysis) return said("models and comparison");
    if (aim == Aim::pictures) return said("outputs");
    if (aim == Aim::publishing)
      return said("outputs") && fs::exists(out_ + "/.partial/summary.json");
    return true;
  }

  // Realizations that are done.
  std::set<std::string> realizations() const {
    std::set<std::string> out;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(out_ + "/checkpoint", none)) {
      if (entry.path().extension() == ".h5") out.insert(entry.path().filename().string());
    }
    return out;
  }

  // But for what a kill -9 has left and no run has taken up yet.
  void expect_tidy() const {
    std::istringstream names(leftovers(out_));
    for (std::string name; names >> name;)
      EXPECT_EQ(orphans_.count(name) + stale_.count(name), 1U) << name << " is left" << history_;
  }

  bool after(const Ending& ending, const Blow& blow, int sent, bool caught,
             const std::set<std::string>& safe, const std::string& what) {
    history_ += "\n  " + what;
    tally_.signals += sent > 0;
    tally_.at[static_cast<std::size_t>(blow.aim)] += sent > 0;
    tally_.killed += sent > 0 && blow.signal == SIGKILL;
    EXPECT_FALSE(ending.late) << "still running: " << history_;
    killed_ = sent > 0 && blow.signal == SIGKILL;
    told_to_resume_ = ending.code == 130 && ending.err.find("--resume") != std::string::npos;
    Contents found = results_in(out_);
    for (const auto& [name, text] : found) {
      if (blow.signal == SIGKILL && is_orphan(name)) orphans_.insert(name);
    }
    std::erase_if(found, [&](const auto& file) { return orphans_.count(file.first) == 1; });
    if (ending.code == 0) {
      tally_.whole += sent > 0;
      EXPECT_EQ(difference(study_.whole, found), "") << history_;
      expect_tidy();
      EXPECT_FALSE(checkpoint()) << history_;
      done_ = true;
      return false;
    }
    if (sent == 0) {
      ADD_FAILURE() << "ended by itself: " << ending << history_;
      return false;
    }
    const bool unborn = !caught && ending.signal == blow.signal && ending.err.empty();
    if (blow.signal == SIGKILL) {
      EXPECT_EQ(ending.signal, SIGKILL) << ending << history_;
      EXPECT_EQ(mixture(before_, study_.whole, found), "") << history_;
      std::istringstream names(leftovers(out_));
      for (std::string name; names >> name;) {
        if (orphans_.count(name) == 0) stale_.insert(name);
      }
      // It may have struck after the last file came to its place.
      done_ = !checkpoint() && difference(study_.whole, found).empty();
      if (!done_) before_ = found;
    } else {
      EXPECT_TRUE(unborn || ending.code == 130) << ending << history_;
      // At the very end everything may be in its place: then there is nothing to resume.
      done_ = ending.code == 130 && !checkpoint() && difference(study_.whole, found).empty();
      if (done_) {
        EXPECT_FALSE(told_to_resume_) << ending << history_;
      } else {
        EXPECT_EQ(difference(before_, found), "") << history_;
      }
      if (!unborn) {
        expect_tidy();
        EXPECT_EQ(complaints(ending.err).size(), 1U) << ending << history_;
      }
      tally_.unborn += unborn;
      tally_.stopped += ending.code == 130;
    }
    EXPECT_TRUE(fs::is_empty(folder_ / "tmp")) << "files in TMPDIR" << history_;
    // Behind whole results the checkpoint goes.
    const bool whole = difference(study_.whole, found).empty();
    const std::set<std::string> left = realizations();
    for (const std::string& file : safe) {
      EXPECT_TRUE(whole || left.count(file) == 1) << file << " is lost" << history_;
    }
    return !done_;
  }

  const Reference& study_;
  std::mt19937& random_;
  Tally& tally_;
  Contents before_;
  Folder folder_;
  std::string out_ = folder_ / "out", history_;
  std::set<std::string> orphans_, stale_;
  bool done_ = false, told_to_resume_ = false, killed_ = false;
};

inline Blow random_blow(std::mt19937& random, double seconds) {
  const auto share = [&] { return std::uniform_real_distribution<>(0, 1)(random); };
  constexpr std::array kSignals{SIGKILL, SIGINT, SIGTERM, SIGHUP};
  Blow blow;
  blow.aim = kAims[random() % kAims.size()];
  blow.signal = kSignals[random() % kSignals.size()];
  blow.group = random() % 2 == 0;
  blow.times = 1 + static_cast<int>(random() % 2);
  blow.between = random() % 2 == 0 ? 0 : 0.05 * share();
  // The later the phase, the shorter it is.
  const std::map<Aim, double> spread{{Aim::anywhere, 1.1 * seconds}, {Aim::opening, 0.01},
                                     {Aim::grains, 0.7 * seconds},   {Aim::analysis, 0.1 * seconds},
                                     {Aim::pictures, 0.5 * seconds}, {Aim::publishing, 0.01}};
  blow.delay = share() * spread.at(blow.aim);
  return blow;
}

/// A suite stops when it has seen this many failures.
constexpr int kEnough = 12;
inline int failures() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  return test->result()->total_part_count();
}

/// Runs of all studies, each struck up to `most` times and then resumed, until `signals` were sent.
inline Tally interrupt_runs(int signals, int most, double damage_share) {
  Tally tally;
  std::mt19937 random(attack_seed());
  for (std::size_t round = 0; tally.signals < signals && failures() < kEnough; ++round) {
    const TinyStudy& tiny = tiny_studies()[round % tiny_studies().size()];
    const Reference& study = reference(tiny.name);
    InterruptedRun run(study, random() % 3 == 0, random, tally);
    for (int k = 0; k < most && run.strike(random_blow(random, study.seconds)); ++k) {
    }
    if (run.work() && std::uniform_real_distribution<>(0, 1)(random) < damage_share) run.damage();
    run.resume_to_the_end();
  }
  return tally;
}

}  // namespace grainfield::coupling::testing
