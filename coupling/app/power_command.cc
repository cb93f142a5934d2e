// power: how many realizations would distinguish the models.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "coupling/app/commands.h"
#include "coupling/app/options.h"
#include "coupling/app/progress_line.h"
#include "coupling/app/terminal.h"
#include "coupling/base/printable.h"
#include "coupling/judge/words.h"
#include "coupling/result/text_table.h"
#include "coupling/store/field_io.h"
#include "coupling/tasks/compare_task.h"
#include "coupling/tasks/fit_task.h"

namespace grainfield::coupling {
namespace {

struct PowerRequest {
  std::vector<std::string> inputs, models, components;
  std::vector<double> heights;
  std::string folder;
  int threads = 1;
};

bool holds_responses(const std::string& file) {
  const std::vector<std::string> names = list_fields(file);
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return read_field(file, name).has("F"); });
}

// Responses to a load are compared with models as they are given, heaps are fitted.
Judgement judgement_of(const PowerRequest& given) {
  if (given.inputs.size() == 1 && holds_responses(given.inputs.front())) {
    CompareRequest request;
    request.file = given.inputs.front();
    request.models = given.models;
    request.lines.components = given.components;
    request.lines.heights = given.heights;
    request.folder = given.folder;
    return run_compare(request).comparison.judgement;
  }
  FitRequest request;
  request.inputs = given.inputs;
  request.models = given.models;
  request.heights = given.heights;
  request.components = given.components;
  request.folder = given.folder;
  request.threads = given.threads;
  return run_fit(request).comparison.judgement;
}

}  // namespace

void add_power(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "power", "how many realizations would distinguish the models, from those at hand");
  auto given = std::make_shared<PowerRequest>();
  command
      ->add_option("inputs", given->inputs,
                   "heaps: SNAPSHOT.h5 or a field of them, which are fitted; or FIELD.h5 of "
                   "responses to a load, which is compared")
      ->required();
  command
      ->add_option("--model", given->models,
                   "as of fit (heaps) and of compare (responses); two or more")
      ->allow_extra_args(false);
  command->add_option("--heights", given->heights, "as of fit and compare")->delimiter(',');
  command->add_option("--components", given->components, "as of fit and compare")->delimiter(',');
  add_output(*command, given->folder,
             "folder of that fit or comparison; default results/power-INPUT");
  add_threads(*command, given->threads, "the results do not depend on it");
  command->callback([=, &action] {
    action = [=] {
      PowerRequest wanted = *given;
      if (wanted.folder.empty()) {
        wanted.folder =
            "results/power-" + std::filesystem::path(wanted.inputs.front()).stem().string();
      }
      const Judgement judgement = [&] {
        ProgressLine line(false);
        const TaskProgress tasks(line);
        return judgement_of(wanted);
      }();
      const JudgementTable table = power_table(judgement);
      if (table.rows.empty()) {
        throw std::invalid_argument("--model: found one model, allowed: two or more");
      }
      say("To distinguish these models from {} at 95 % with a power of 80 %:\n\n{}\n{}\n\n",
          judgement.best_model().label, markdown_table(table.header, table.rows), table.note);
      say("{}\nreport: {}/report.html\n", sentence(judgement), printable_name(wanted.folder));
      return 0;
    };
  });
}

}  // namespace grainfield::coupling
