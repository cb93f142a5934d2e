// fit: models fitted to heaps that are there.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>

#include "coupling/app/commands.h"
#include "coupling/app/options.h"
#include "coupling/app/progress_line.h"
#include "coupling/app/terminal.h"
#include "coupling/base/printable.h"
#include "coupling/result/judgement.h"
#include "coupling/tasks/fit_task.h"

namespace grainfield::coupling {
namespace {

// "FILE:/a, FILE:/b"; of many the first and the last.
std::string shown(const std::vector<std::string>& names) {
  if (names.size() <= 4) return fmt::format("{}", fmt::join(names, ", "));
  return fmt::format("{} packings, {} to {}", names.size(), names.front(), names.back());
}

}  // namespace

void add_fit(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "fit", "fit stress models to heaps: constants with errors, ranking, tables, report");
  auto given = std::make_shared<FitRequest>();
  FitRequest& request = *given;
  command
      ->add_option("inputs", request.inputs,
                   "heaps: SNAPSHOT.h5 (its piles) or SNAPSHOT.h5:group of run or import; or one "
                   "FIELD.h5[:field] of run or average --frame heap")
      ->required();
  command
      ->add_option("--model", request.models,
                   "NAME (grainfield keys fit), or NAME:p=free,q=0.3 or LABEL=NAME:... of a model "
                   "(grainfield model), repeatable; default all for symmetric heaps")
      ->allow_extra_args(false);
  command->add_option("--heights", request.heights, "fit.heights: shares of the heap's height")
      ->delimiter(',');
  command->add_option("--components", request.components, "fit.components")->delimiter(',');
  command->add_option("--width-diameters", request.width_diameters,
                      "fit.width_diameters: of the averaging (snapshots only)");
  command->add_option("--case", request.case_file, "TOML file or shipped case: its [fit] counts");
  command->add_option("--set", request.overrides, "fit.KEY=VALUE, repeatable")
      ->allow_extra_args(false);
  auto* coverage =
      command
          ->add_option("--coverage", request.coverage,
                       "sizes N: how often intervals from N of the heaps hold the constants of the "
                       "rest (in the output folder: coverage.md); takes long")
          ->delimiter(',');
  command->add_option("--draws", request.draws, "of --coverage, of each size; default 100")
      ->needs(coverage);
  add_output(*command, request.folder, "folder; default results/fit-INPUT");
  add_threads(*command, request.threads, "the results do not depend on it");
  command->callback([=, &action] {
    action = [=] {
      FitRequest wanted = *given;
      if (wanted.folder.empty()) {
        wanted.folder =
            "results/fit-" + std::filesystem::path(wanted.inputs.front()).stem().string();
      }
      const FitOutcome outcome = [&] {
        ProgressLine line(false);
        const TaskProgress tasks(line);
        return run_fit(wanted);
      }();
      if (!outcome.lacks.empty()) note("warning: {}", outcome.lacks);
      if (!outcome.gone.empty()) note("{}", outcome.gone);
      say("{}\n{}\n", judgement_text(outcome.comparison.judgement), outcome.constants);
      if (!outcome.carried.empty()) say("{}\n", outcome.carried);
      if (!outcome.coverage.empty()) say("{}\n", outcome.coverage);
      say("fitted to {}: {}\nreport: {}/report.html\n", shown(outcome.packings), outcome.note,
          printable_name(wanted.folder));
      return 0;
    };
  });
}

}  // namespace grainfield::coupling
