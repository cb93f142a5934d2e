// What bash offers after `grainfield`.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "continuum/model.h"
#include "coupling/app/manual.h"

namespace grainfield::coupling {
namespace {

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> out;
  for (const std::string& name : option.get_lnames()) out.push_back("--" + name);
  for (const std::string& name : option.get_snames()) out.push_back("-" + name);
  return out;
}

std::string option_words(const CLI::App& command) {
  std::vector<std::string> out;
  for (const CLI::Option* option : dashed_options(command)) {
    const auto names = names_of(*option);
    out.insert(out.end(), names.begin(), names.end());
  }
  return fmt::format("{}", fmt::join(out, " "));
}

std::string model_words() {
  std::vector<std::string> names;
  for (const auto& info : continuum::registry()) names.push_back(info.name);
  return fmt::format("{}", fmt::join(names, " "));
}

/// What the words of a command without a dash are: "case", "model" or, of files, "".
std::string kind_of_words(const CLI::App& command) {
  const auto positional = positional_options(command);
  if (positional.empty()) return "none";
  const std::string first = positional.front()->get_name(true);
  if (first == "case") return "case";
  return command.get_name() == "model" ? "model" : "";
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  std::vector<std::string> names;
  std::string choices;
  for (const CLI::App* command : shown_commands(app)) {
    names.push_back(command->get_name());
    choices += fmt::format("    {}) options=\"{}\"; words=\"{}\" ;;\n", command->get_name(),
                           option_words(*command), kind_of_words(*command));
  }
  return fmt::format(
      R"(# bash completion for grainfield, written by the program from its own options
_grainfield() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} options words
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "{commands} {own}" -- "$current")
    return
  fi
  case ${{COMP_WORDS[1]}} in
{choices}    *) return ;;
  esac
  if [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
  elif [ "$before" = --model ] || {{ [ "$words" = model ] && [ "$COMP_CWORD" -eq 2 ]; }}; then
    mapfile -t COMPREPLY < <(compgen -W "{models}" -- "$current")
  elif [ "$words" = case ] && [ "$COMP_CWORD" -eq 2 ]; then
    local shipped
    shipped=$("${{COMP_WORDS[0]}}" cases 2> /dev/null | sed -n 's/\.toml .*//p')
    mapfile -t COMPREPLY < <(compgen -W "$shipped" -- "$current"; compgen -f -- "$current")
  elif [ "$words" != none ] || [[ $before == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}}
complete -o filenames -F _grainfield grainfield
)",
      fmt::arg("commands", fmt::join(names, " ")), fmt::arg("own", option_words(app)),
      fmt::arg("choices", choices), fmt::arg("models", model_words()));
}

}  // namespace grainfield::coupling
