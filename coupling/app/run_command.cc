// run: a case from start to end, with progress.
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <vector>

#include "coupling/app/commands.h"
#include "coupling/app/options.h"
#include "coupling/app/progress_line.h"
#include "coupling/app/terminal.h"
#include "coupling/base/printable.h"
#include "coupling/case/case.h"
#include "coupling/result/tables.h"
#include "coupling/run/run_request.h"
#include "coupling/store/atomic_file.h"

namespace grainfield::coupling {
namespace {

void say_result(const Case& value, const std::string& folder) {
  const Summary summary = read_summary(folder + "/summary.json");
  const std::filesystem::path verdict = std::filesystem::path(folder) / "verdict.md";
  if (std::filesystem::exists(verdict)) say("{}\n", read_text_file(verdict.string()));
  // A sweep has one for each member.
  const std::string of = "verdict.sentence.";
  const auto is_member = [&](auto at) { return at != summary.end() && at->first.starts_with(of); };
  const auto first = summary.lower_bound(of);
  const bool alone = is_member(first) && !is_member(std::next(first));
  for (auto at = first; is_member(at); ++at) {
    const std::string member = at->first.substr(of.size());
    const std::filesystem::path own = std::filesystem::path(folder) / member / "verdict.md";
    if (alone && std::filesystem::exists(own)) {
      say("{}\n", read_text_file(own.string()));
    } else {
      say("{}: {}\n", member, std::get<std::string>(at->second));
    }
  }
  const auto differences = summary.find("sweep.sentence");
  if (differences != summary.end()) say("{}\n", std::get<std::string>(differences->second));
  const std::string overlap = deep_overlap(value, summary);
  if (!overlap.empty()) note("warning: {}", overlap);
  say("results: {}\n", printable_name(folder));
  if (value.output.report) say("report: {}/report.html\n", printable_name(folder));
}

int run(const RunRequest& given) {
  RunPlan plan = plan_run(given);
  const Case& value = plan.value;
  RunOptions& options = plan.options;
  const Ranks ranks;
  options.threads = threads_for(given.threads, ranks);
  if (ranks.first()) warn_of_keys_without_effect(value);
  ProgressLine line(!ranks.first());
  options.progress = [&](const EnsembleProgress& p) {
    line.show([&] { return progress_text(p); });
  };
  options.note = [&](const std::string& text) { line.note(text); };
  options.warn = [&](const std::string& text) { line.note("grainfield: warning: " + text); };
  try {
    const TaskProgress tasks(line);
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
  auto given = std::make_shared<RunRequest>();
  command->add_option("case", given->file, "case file (TOML), or the name of a shipped case")
      ->required();
  add_output(*command, given->folder, "folder; default results/CASE (CASE-quick)");
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
