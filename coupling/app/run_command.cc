// run: a case from start to end, with progress.
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "coupling/app/commands.h"
#include "coupling/app/progress_text.h"
#include "coupling/app/shipped_cases.h"
#include "coupling/app/terminal.h"
#include "coupling/app/threads_option.h"
#include "coupling/case/case.h"
#include "coupling/case/keys.h"
#include "coupling/output/tables.h"
#include "coupling/run/run_case.h"
#include "coupling/system/printable.h"

namespace grainfield::coupling {
namespace {

/// One line that is rewritten on a terminal; elsewhere a line every few seconds.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

  void show(const EnsembleProgress& p) {
    if (quiet_) return;
    const auto now = std::chrono::steady_clock::now();
    constexpr auto kEvery = std::chrono::seconds(5);
    if (!terminal_ && now - last_ < kEvery) return;
    last_ = now;
    const std::string line = progress_text(p);
    if (terminal_) {
      put_progress(line);
      open_ = true;
    } else {
      put_log(line);
    }
  }

  void note(const std::string& text) {
    if (quiet_) return;
    end();
    put_log(text);
  }

  void end() {
    if (open_) put_log("");
    open_ = false;
  }

 private:
  bool quiet_, terminal_, open_ = false;
  std::chrono::steady_clock::time_point last_;
};

// Of the smaller radius; Roul's piles reach 0.04.
constexpr double kDeepOverlap = 0.1;
constexpr double kMostBetweenCheckpoints = 1e6;  // s; eleven days

struct Given {
  std::string file, output;
  std::vector<std::string> sets;
  bool quick = false, resume = false;
  int threads = 0;
  double checkpoint_seconds = 30;
  long stop_after_steps = 0;
};

// As a shell takes it: in single quotes where it holds more than plain characters.
std::string shell_word(const std::string& text) {
  const std::string plain = "_-+.,:=/@%";
  const bool quote = !std::all_of(text.begin(), text.end(), [&](unsigned char ch) {
    return std::isalnum(ch) != 0 || plain.find(static_cast<char>(ch)) != std::string::npos;
  });
  if (!quote && !text.empty()) return text;
  std::string out = "'";
  for (const char ch : text) out += ch == '\'' ? std::string("'\\''") : std::string(1, ch);
  return out + "'";
}

/// What decides the numbers, as it was typed: neither folder nor threads.
std::string command_of(const Given& given) {
  std::string out = "grainfield run " + shell_word(given.file);
  if (given.quick) out += " --quick";
  for (const std::string& text : given.sets) out += " --set " + shell_word(text);
  return out;
}

void say_result(const Case& value, const std::string& folder) {
  const Summary summary = read_summary(folder + "/summary.json");
  const auto sentence = summary.find("verdict.sentence");
  if (sentence != summary.end()) say("{}\n", std::get<std::string>(sentence->second));
  const auto differences = summary.find("sweep.sentence");
  if (differences != summary.end()) say("{}\n", std::get<std::string>(differences->second));
  const auto at = summary.find("dem.max_overlap_ratio");
  const double* overlap = at == summary.end() ? nullptr : std::get_if<double>(&at->second);
  if (overlap != nullptr && *overlap > kDeepOverlap) {
    const bool linear = value_text(*find_key("material.law"), value) == "\"linear\"";
    note(
        "warning: grains overlap by up to {:.0f} % of a radius, too soft for a "
        "contact law of small overlaps; raise material.{}",
        100 * *overlap, linear ? "normal_stiffness" : "young");
  }
  say("results: {}\n", printable_name(folder));
  if (value.output.report) say("report: {}/report.html\n", printable_name(folder));
}

int run(const Given& given) {
  if (!(given.checkpoint_seconds >= 0 && given.checkpoint_seconds <= kMostBetweenCheckpoints)) {
    throw std::invalid_argument(fmt::format("--checkpoint-seconds: found {:g}, allowed: 0 to {:g}",
                                            given.checkpoint_seconds, kMostBetweenCheckpoints));
  }
  const std::string case_file = find_case(given.file);
  Case value = read_case(case_file, given.quick, given.sets);
  value.command = command_of(given);
  const Ranks ranks;
  if (ranks.first()) warn_of_keys_without_effect(value);
  ProgressLine line(!ranks.first());
  RunOptions options;
  options.case_file = case_file;
  options.folder = !given.output.empty() ? given.output
                                         : "results/" + value.name + (given.quick ? "-quick" : "");
  while (options.folder.size() > 1 && options.folder.back() == '/') options.folder.pop_back();
  // Ranks share a machine: without a wish each takes one thread.
  const int cores = ranks.size() > 1 ? 1 : static_cast<int>(std::thread::hardware_concurrency());
  options.threads = given.threads > 0 ? given.threads : std::max(1, cores);
  options.resume = given.resume;
  options.checkpoint_seconds = given.checkpoint_seconds;
  options.stop_after_steps = given.stop_after_steps;
  options.progress = [&](const EnsembleProgress& p) { line.show(p); };
  options.note = [&](const std::string& text) { line.note(text); };
  options.warn = [&](const std::string& text) { line.note("grainfield: warning: " + text); };
  try {
    run_case(value, ranks, options);
  } catch (...) {
    line.end();
    finish_ranks_after_failure();
    throw;
  }
  line.end();
  if (ranks.first()) say_result(value, options.folder);
  finish_ranks();
  return 0;
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("run", "run a case: grains, averages, models, report");
  auto given = std::make_shared<Given>();
  command->add_option("case", given->file, "case file (TOML), or the name of a shipped case")
      ->required();
  add_output(*command, given->output, "folder; default results/CASE (CASE-quick)");
  command->add_flag("--quick", given->quick, "with the case's quick setting");
  command->add_option("--set", given->sets, "override: key.path=value")->allow_extra_args(false);
  add_threads(*command, given->threads,
              "default: all cores; under mpirun one per rank; the results do not depend on it");
  command->add_flag("--resume", given->resume, "continue an interrupted run");
  command->add_option("--checkpoint-seconds", given->checkpoint_seconds,
                      "wall time between checkpoints: what a crash may cost; default 30");
  command
      ->add_option("--stop-after-steps", given->stop_after_steps,
                   "for tests: stop as by Ctrl-C when a realization has made this many steps")
      ->group("");
  command->callback([=, &action] { action = [=] { return run(*given); }; });
}

}  // namespace grainfield::coupling
