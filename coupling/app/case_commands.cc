// check, keys, cases: what needs no computation.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <stdexcept>
#include <vector>

#include "coupling/app/commands.h"
#include "coupling/app/terminal.h"
#include "coupling/base/printable.h"
#include "coupling/case/case.h"
#include "coupling/case/cost.h"
#include "coupling/case/keys.h"
#include "coupling/case/shipped_cases.h"
#include "coupling/case/study.h"
#include "coupling/run/summary_keys.h"

namespace grainfield::coupling {

void warn_of_keys_without_effect(const Case& value) {
  for (const std::string& text : value.without_effect) {
    note("warning: {}", text);
  }
}

namespace {

// "point-load, compared with layer and flamant"; of a study that compares no model, its name.
std::string study_text(const Case& value) {
  std::string out = value.study;
  for (std::size_t k = 0; k < value.models.size(); ++k) {
    const bool last = k + 1 == value.models.size();
    out += (k == 0 ? ", compared with " : last ? " and " : ", ") + value.models[k].label;
  }
  return out;
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
      warn_of_keys_without_effect(value);
      say("{}: ok ({})\n", printable_name(*file), study_text(value));
      say("{}", outlook_text(value));
      return 0;
    };
  });
}

namespace {

// Keys of what has this name; of a case file or a shipped case, those of its study.
std::string keys_of(const std::string& name) {
  try {
    return keys_text(name);
  } catch (const std::invalid_argument&) {
    std::string file;
    try {
      file = find_case(name);
    } catch (const std::invalid_argument&) {
      // no case either: the first complaint lists what there is
    }
    if (file.empty()) throw;
    return keys_text(read_case(file, false, {}).study);
  }
}

}  // namespace

void add_keys(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("keys", "every case key: type, unit, default, range, meaning");
  auto names = std::make_shared<std::vector<std::string>>();
  auto markdown = std::make_shared<bool>(false);
  auto summary = std::make_shared<bool>(false);
  command->add_option("name", *names,
                      "only those of a study (pile) or a case of it (pile-point-source), a section "
                      "(fit), a key (fit.heights) or with a part (frict); cone, pair, sample and "
                      "wedge are studies and, with a dot "
                      "behind, sections (pair.)");
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
        for (const std::string& name : *names) texts.push_back(keys_of(name));
        say("{}", names->empty() ? keys_text("") : fmt::format("{}", fmt::join(texts, "\n")));
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
