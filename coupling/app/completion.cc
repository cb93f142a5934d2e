// What bash offers after `grainfield`.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "continuum/model.h"
#include "coupling/app/manual.h"
#include "coupling/case/study.h"

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

std::string study_words() {
  std::vector<std::string> names;
  for (const Study& study : studies()) names.push_back(study.name);
  return fmt::format("{}", fmt::join(names, " "));
}

bool is_word(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '_';
  });
}

std::vector<std::string> parts_of(const std::string& text, const std::string& between) {
  std::vector<std::string> out;
  for (std::size_t from = 0;;) {
    const std::size_t to = text.find(between, from);
    out.push_back(text.substr(from, to - from));
    if (to == std::string::npos) return out;
    from = to + between.size();
  }
}

/// The values that an option's help lists, as "a | b (default) | c; of others: d | e" or as
/// "a: meaning; b: meaning".
std::vector<std::string> values_of(const CLI::Option& option) {
  std::vector<std::string> listed, named;
  for (const std::string& part : parts_of(option.get_description(), "; ")) {
    const std::size_t bar = part.find(" | "), colon = part.find(": ");
    if (colon != std::string::npos && is_word(part.substr(0, colon))) {
      named.push_back(part.substr(0, colon));
    }
    if (bar == std::string::npos) continue;
    const bool headed = colon != std::string::npos && colon < bar;
    for (const std::string& choice : parts_of(headed ? part.substr(colon + 2) : part, " | ")) {
      const std::string word = choice.substr(0, choice.find_first_of(" :,"));
      if (is_word(word)) listed.push_back(word);
    }
  }
  if (!listed.empty()) return listed;
  return named.size() > 1 ? named : std::vector<std::string>{};
}

/// Rows of bash's case: "    'import --from') values="..." ;;".
std::string value_rows(const CLI::App& command) {
  std::string out;
  for (const CLI::Option* option : dashed_options(command)) {
    const std::vector<std::string> values = values_of(*option);
    if (is_flag(*option) || values.empty()) continue;
    for (const std::string& name : names_of(*option)) {
      out += fmt::format("    '{} {}') values=\"{}\" ;;\n", command.get_name(), name,
                         fmt::join(values, " "));
    }
  }
  return out;
}

/// What the words of a command without a dash are: "case", "model", "study" or, of files, "".
std::string kind_of_words(const CLI::App& command) {
  const auto positional = positional_options(command);
  if (positional.empty()) return "none";
  const std::string first = positional.front()->get_name(true);
  if (first == "case") return "case";
  if (command.get_name() == "keys") return "study";
  return command.get_name() == "model" ? "model" : "";
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  std::vector<std::string> names;
  std::string choices, values;
  for (const CLI::App* command : shown_commands(app)) {
    names.push_back(command->get_name());
    choices += fmt::format("    {}) options=\"{}\"; words=\"{}\" ;;\n", command->get_name(),
                           option_words(*command), kind_of_words(*command));
    values += value_rows(*command);
  }
  return fmt::format(
      R"(# bash completion for grainfield, written by the program from its own options
_grainfield() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} options words values=
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "{commands} {own}" -- "$current")
    return
  fi
  case ${{COMP_WORDS[1]}} in
{choices}    *) return ;;
  esac
  case "${{COMP_WORDS[1]}} $before" in
{values}    *) ;;
  esac
  if [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
  elif [ -n "$values" ]; then
    mapfile -t COMPREPLY < <(compgen -W "$values" -- "$current")
  elif [ "$words" = study ]; then
    mapfile -t COMPREPLY < <(compgen -W "{studies}" -- "$current")
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
      fmt::arg("choices", choices), fmt::arg("models", model_words()), fmt::arg("values", values),
      fmt::arg("studies", study_words()));
}

}  // namespace grainfield::coupling
