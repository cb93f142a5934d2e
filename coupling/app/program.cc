#include "coupling/app/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "continuum/model.h"
#include "coupling/app/commands.h"
#include "coupling/app/list_words.h"
#include "coupling/app/manual.h"
#include "coupling/app/terminal.h"
#include "coupling/base/failure.h"
#include "coupling/base/signals.h"
#include "coupling/base/version.h"

namespace grainfield::coupling {
namespace {

int complain(int code, const std::string& what) {
  wait_if_stopping();
  note("{}", what);
  return code;
}

// The option that no command has, of a command line that could not be read; may be empty.
std::string unknown_option(const CLI::App& app) {
  for (const auto* chosen : app.get_subcommands()) {
    std::vector<std::string> names;
    for (const auto* option : chosen->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    for (const std::string& extra : chosen->remaining()) {
      if (extra == "--") break;  // behind it nothing is an option
      const std::string word = extra.substr(0, extra.find('='));
      if (!word.starts_with("--") || names.empty()) continue;
      return fmt::format("unknown option \"{}\"; did you mean {}?", word,
                         continuum::nearest(word, names));
    }
  }
  return "";
}

int parse_and_act(int argc, char** argv) {
  CLI::App app{"grainfield: grains in, fields out, and a verdict on the continuum models",
               "grainfield"};
  app.set_version_flag("--version", "grainfield " + version_and_commit());
  app.require_subcommand(1);
  Action action;
  add_run(app, action);
  add_check(app, action);
  add_keys(app, action);
  add_cases(app, action);
  add_model(app, action);
  add_average(app, action);
  add_compare(app, action);
  add_fit(app, action);
  add_power(app, action);
  add_import(app, action);
  add_import_field(app, action);
  add_export(app, action);
  add_strain(app, action);
  add_structure(app, action);
  add_info(app, action);
  add_samples(app, action);
  add_manual(app, action);
  if (argc > 1 && argv[1][0] != '-' && argv[1][0] != 0) {
    const auto called = [&](const CLI::App* command) { return command->get_name() == argv[1]; };
    if (app.get_subcommands(called).empty()) {
      std::vector<std::string> names;
      for (const auto* command : shown_commands(app)) names.push_back(command->get_name());
      return complain(2, fmt::format("unknown command \"{}\"; did you mean {}? (grainfield --help)",
                                     argv[1], continuum::nearest(argv[1], names)));
    }
  }
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (!words.empty() && !words.front().empty() && words.front().front() != '-') {
    CLI::App& command = *app.get_subcommand(words.front());
    const std::vector<std::string> rest(words.begin() + 1, words.end());
    words.resize(1);
    for (std::string& word : spread_lists(command, rest)) words.push_back(std::move(word));
  }
  std::reverse(words.begin(), words.end());  // CLI11 takes them from the end
  try {
    app.parse(words);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) {  // --help, --version
      std::ostringstream text;
      app.exit(e, text, text);
      put(text.str());
      return 0;
    }
    std::string who;
    for (const auto* chosen : app.get_subcommands()) who = chosen->get_name() + ": ";
    const std::string stranger = unknown_option(app);
    return complain(
        2, fmt::format("{}{} (grainfield {}--help)", who, stranger.empty() ? e.what() : stranger,
                       who.empty() ? "" : who.substr(0, who.size() - 2) + " "));
  }
  return action();
}

int act(int argc, char** argv) {
  try {
    return parse_and_act(argc, argv);
  } catch (...) {
    const Failure failure = failure_of(std::current_exception());
    if (failure.mistakes.empty()) return complain(failure.code, failure.text);
    for (const std::string& mistake : failure.mistakes) complain(failure.code, mistake);
    return failure.code;
  }
}

}  // namespace

CLI::Option* add_output(CLI::App& command, std::string& output, const std::string& meaning) {
  const auto complaint = [](const std::string& name) {
    return std::string(name.empty() ? "found no name, expected that of a file or folder" : "");
  };
  return command.add_option("-o,--output", output, meaning)->check(CLI::Validator(complaint, ""));
}

int run_program(int argc, char** argv) {
  hold_standard_streams();
  watch_signals();
  const int code = act(argc, argv);
  const int written = finish_output();
  return code != 0 ? code : written;
}

}  // namespace grainfield::coupling
