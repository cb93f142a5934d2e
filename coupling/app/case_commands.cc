// check, keys, cases: what needs no computation.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "coupling/app/commands.h"
#include "coupling/app/shipped_cases.h"
#include "coupling/app/terminal.h"
#include "coupling/case/case.h"
#include "coupling/case/keys.h"
#include "coupling/run/studies.h"
#include "coupling/run/summary_keys.h"

namespace grainfield::coupling {

void warn_of_idle_keys(const Case& value) {
  for (const std::string& text : value.idle) {
    note("warning: {}", text);
  }
}

namespace {

// Grain-steps per CPU second of settled polygons, all awake (docs/benchmarks.md): an estimate.
constexpr double kRate = 5e6;

std::string duration(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", std::max(1.0, seconds));
  if (seconds < 5400) return fmt::format("{:.0f} minutes", seconds / 60);
  return fmt::format("{:.1f} hours", seconds / 3600);
}

/// The size of a case before it runs: members, realizations, time step, steps, cost.
std::string outlook_text(const Case& value) {
  const Study& study = study_of(value);
  if (!study.has_grains()) return "";
  const dem::Outlook o = study.make_run(value, 0, 1)->outlook();
  std::string out = fmt::format("  {} realization{}", value.ensemble.realizations,
                                value.ensemble.realizations == 1 ? "" : "s");
  if (!value.sweep.key.empty()) {
    out += fmt::format(" for each of {} values of {}", value.sweep.values.size(), value.sweep.key);
  }
  if (o.grains > 0) out += fmt::format(" of {} grains", o.grains);
  if (o.time_step > 0) out += fmt::format(", steps of {:.3g} s", o.time_step);
  if (!value.sweep.key.empty()) out += " (of the case as it is)";
  if (o.time == 0) return out + "\n";
  const double steps = o.time / o.time_step;
  // Grain by grain: half of them on average.
  const double seconds = 0.5 * o.grains * steps / kRate;
  return out + fmt::format(
                   "\n  pouring takes {:.1f} s, {:.1f} million steps: with every grain awake "
                   "about {} a realization on one core{}\n",
                   o.time, 1e-6 * steps, duration(seconds),
                   value.pile.sleep.on ? "; sleeping makes it less, several times when a "
                                         "pile is large and poured slowly"
                                       : "");
}

}  // namespace

void add_check(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("check", "validate a case without running it");
  auto file = std::make_shared<std::string>();
  auto sets = std::make_shared<std::vector<std::string>>();
  auto quick = std::make_shared<bool>(false);
  command->add_option("case", *file, "case file (TOML), or the name of a shipped case")->required();
  command->add_option("--set", *sets, "override: key.path=value")->allow_extra_args(false);
  command->add_flag("--quick", *quick, "with the case's quick setting");
  command->callback([=, &action] {
    action = [=] {
      *file = find_case(*file);
      const Case value = read_case(*file, *quick, *sets);
      warn_of_idle_keys(value);
      say("{}: ok ({}, {} model{})\n", *file, value.study, value.models.size(),
          value.models.size() == 1 ? "" : "s");
      say("{}", outlook_text(value));
      return 0;
    };
  });
}

void add_keys(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("keys", "every case key: type, unit, default, range, meaning");
  auto sections = std::make_shared<std::vector<std::string>>();
  auto markdown = std::make_shared<bool>(false);
  auto summary = std::make_shared<bool>(false);
  command->add_option(
      "section", *sections,
      "only these sections, keys or parts of keys, such as fit, fit.heights, frict");
  command->add_flag("--markdown", *markdown, "as the page docs/keys.md");
  command->add_flag("--summary", *summary, "the keys of summary.json instead");
  command->callback([=, &action] {
    action = [=] {
      if (*summary) {
        say("{}", *markdown ? summary_keys_markdown() : summary_keys_text());
      } else if (*markdown) {
        say("{}", keys_markdown());
      } else {
        std::vector<std::string> texts;
        for (const std::string& section : *sections) texts.push_back(keys_text(section));
        say("{}", sections->empty() ? keys_text("") : fmt::format("{}", fmt::join(texts, "\n")));
      }
      return 0;
    };
  });
}

void add_cases(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("cases", "the shipped studies, one line each");
  command->callback([&action] {
    action = [] {
      for (const auto& file : shipped_cases()) {
        say("{:<28} {}\n", file.filename().string(), case_title(file.string()));
      }
      say("in {}; grainfield run NAME\n", cases_folder().string());
      return 0;
    };
  });
}

}  // namespace grainfield::coupling
