#include "coupling/app/list_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

namespace fs = std::filesystem;

// Endings of the files that commands read.
constexpr std::array kFileEndings{".h5",   ".hdf5", ".csv", ".toml",  ".txt", ".dump",
                                  ".xdmf", ".vtu",  ".gz",  ".local", ".dat", ".json"};
// Lists whose entries are NAME=VALUE, those of them that commas part as well, and names that commas
// part. Models know their own commas (parse_choices.h); numbers are parted by CLI11.
constexpr std::array kSettings{"set", "column", "wall", "periodic"};
constexpr std::array kParted{"field", "step", "periodic"};

template <std::size_t N>
bool is_among(const std::array<const char*, N>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool may_be_file(const std::string& word) {
  std::error_code unknown;
  if (fs::exists(word, unknown)) return true;
  const std::string file = word.substr(0, word.rfind(':'));
  if (file.size() < word.size() && fs::exists(file, unknown)) return true;
  return std::any_of(kFileEndings.begin(), kFileEndings.end(), [&](std::string_view ending) {
    return word.ends_with(ending) || file.ends_with(ending);
  });
}

bool is_option(const std::string& word) {
  return word.size() > 1 && word.front() == '-' && !parse_number(word);
}

bool is_list(const CLI::Option& option) {
  return option.get_items_expected_max() >= CLI::detail::expected_max_vector_size;
}

// Name without dashes of an option of the command that takes any number of entries; "": none.
std::string list_named(const CLI::App& command, const std::string& word) {
  if (!word.starts_with("--")) return "";
  const std::string name = word.substr(2, word.find('=') - 2);
  for (const CLI::Option* option : command.get_options()) {
    if (is_list(*option) && option->check_lname(name)) return name;
  }
  return "";
}

std::vector<std::string> entries_of(const std::string& name, const std::string& text) {
  if (name == "set") return split_settings(text);
  if (!is_among(kParted, name)) return {text};
  std::vector<std::string> out;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    out.push_back(text.substr(from, to - from));
    from = to + 1;
  }
  return out;
}

// Whether a command that has not been told its inputs yet needs this last word for them.
bool is_needed(const CLI::App& command, bool any_before, bool last) {
  if (any_before || !last) return false;
  const auto options = command.get_options();
  return std::any_of(options.begin(), options.end(), [](const CLI::Option* option) {
    return option->get_positional() && option->get_required();
  });
}

}  // namespace

std::vector<std::string> split_settings(const std::string& text) {
  std::vector<std::string> out;
  std::size_t begin = 0;
  int depth = 0;
  char quote = 0;
  const auto begins_name = [&](std::size_t at) {
    const std::size_t end = text.find('=', at);
    if (end == std::string::npos || end == at) return false;
    return std::all_of(
        text.begin() + static_cast<long>(at), text.begin() + static_cast<long>(end),
        [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.'; });
  };
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == ',' && depth == 0 && begins_name(k + 1)) {
      out.push_back(text.substr(begin, k - begin));
      begin = k + 1;
    }
  }
  out.push_back(text.substr(begin));
  return out;
}

std::vector<std::string> spread_lists(CLI::App& command,
                                      const std::vector<std::string>& arguments) {
  for (CLI::Option* option : command.get_options()) {
    if (!option->get_positional() && is_list(*option)) option->allow_extra_args(false);
  }
  std::vector<std::string> out;
  bool any_input = false;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const std::string& word = arguments[k];
    if (word == "--") {
      out.insert(out.end(), arguments.begin() + static_cast<long>(k), arguments.end());
      break;
    }
    const std::string name = list_named(command, word);
    if (name.empty()) {
      any_input = any_input || !is_option(word);
      out.push_back(word);
      // What follows an option with one value is that value.
      if (is_option(word) && word.find('=') == std::string::npos && k + 1 < arguments.size()) {
        const CLI::Option* option = command.get_option_no_throw(word);
        for (int n = option == nullptr ? 0 : option->get_items_expected_min();
             n > 0 && k + 1 < arguments.size(); --n) {
          out.push_back(arguments[++k]);
        }
      }
      continue;
    }
    std::vector<std::string> entries;
    if (const std::size_t equals = word.find('='); equals != std::string::npos) {
      entries.push_back(word.substr(equals + 1));
    } else if (k + 1 < arguments.size()) {
      entries.push_back(arguments[++k]);
    }
    if (entries.empty()) {
      out.push_back(word);  // CLI11 says that the value is missing
      continue;
    }
    while (k + 1 < arguments.size()) {
      const std::string& next = arguments[k + 1];
      if (is_option(next) || may_be_file(next)) break;
      if (is_among(kSettings, name) && next.find('=') == std::string::npos) break;
      if (is_needed(command, any_input, k + 2 == arguments.size())) break;
      entries.push_back(next);
      ++k;
    }
    for (const std::string& entry : entries) {
      for (const std::string& part : entries_of(name, entry)) {
        out.push_back("--" + name);
        out.push_back(part);
      }
    }
  }
  return out;
}

}  // namespace grainfield::coupling
