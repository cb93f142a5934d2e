#include "coupling/case/keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>

#include "continuum/model.h"
#include "coupling/case/declare.h"

namespace grainfield::coupling {
namespace {

template <class T>
constexpr bool is_list =
    std::is_same_v<T, std::vector<double>> || std::is_same_v<T, std::vector<std::string>>;

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char ch : text) {
    if (ch == '"' || ch == '\\') out += '\\';
    if (ch == '\n') {
      out += "\\n";
    } else {
      out += ch;
    }
  }
  return out + "\"";
}

// The shortest text that reads back to the same number, and is a TOML float.
std::string number_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string item_text(double value) { return number_text(value); }
std::string item_text(const std::string& value) { return quoted(value); }
std::string item_text(bool value) { return value ? "true" : "false"; }
std::string item_text(std::int64_t value) { return std::to_string(value); }
std::string item_text(int value) { return std::to_string(value); }

std::string heading(const std::string& section) {
  return section.empty() ? "top level" : "[" + section + "]";
}

std::string note_of(const std::string& section) {
  if (section.empty()) return "";
  std::vector<std::string> studies;
  for (const char* study : {"point-load", "elastic-layer", "elastic-half-space"}) {
    if (section_applies(section, study)) studies.emplace_back(study);
  }
  return studies.size() == 3 ? "" : fmt::format("Studies: {}.", fmt::join(studies, ", "));
}

}  // namespace

const std::vector<Key>& keys() {
  static const std::vector<Key> all = [] {
    std::vector<Key> list, grains;
    declare_analysis_keys(list);
    declare_grain_keys(grains);
    // Files read best in the order study, ensemble, grains, averaging, models, output.
    const auto after = std::find_if(list.begin(), list.end(),
                                    [](const Key& key) { return key.section == "average"; });
    list.insert(after, grains.begin(), grains.end());
    return list;
  }();
  return all;
}

const Key* find_key(const std::string& path) {
  for (const Key& key : keys()) {
    if (key.path() == path) return &key;
  }
  return nullptr;
}

std::vector<std::string> sections() {
  std::vector<std::string> out;
  for (const Key& key : keys()) {
    if (!key.section.empty() && (out.empty() || out.back() != key.section)) {
      out.push_back(key.section);
    }
  }
  return out;
}

bool section_applies(const std::string& section, const std::string& study) {
  const auto in = [&](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), section) != names.end();
  };
  if (in({"packing", "material", "motion", "rest", "load", "ensemble", "average"})) {
    return study == "point-load";
  }
  if (in({"elastic"})) return study != "point-load";
  return true;
}

std::string type_name(const Key& key) {
  return std::visit(
      [&](auto where) -> std::string {
        using T = std::decay_t<decltype(where(std::declval<Case&>()))>;
        if constexpr (std::is_same_v<T, double>) return "number";
        if constexpr (std::is_same_v<T, bool>) return "boolean";
        if constexpr (std::is_integral_v<T>) return "integer";
        if constexpr (std::is_same_v<T, std::vector<double>>) return "list of numbers";
        if constexpr (std::is_same_v<T, std::vector<std::string>>) return "list of words";
        return key.choices.empty() ? "text" : "word";
      },
      key.where);
}

std::string allowed(const Key& key) {
  if (!key.choices.empty()) return fmt::format("{}", fmt::join(key.choices, " | "));
  const std::string type = type_name(key);
  if (type == "boolean") return "true | false";
  if (type == "text" || type == "list of words") return "any";
  const bool lower = std::isfinite(key.least), upper = std::isfinite(key.most);
  if (key.open_least) {
    return upper ? fmt::format("above {:g}, up to {:g}", key.least, key.most)
                 : fmt::format("above {:g}", key.least);
  }
  if (lower && upper) return fmt::format("{} to {}", key.least, key.most);
  if (lower) return fmt::format("{:g} or more", key.least);
  return "any";
}

std::string value_text(const Key& key, const Case& value) {
  return std::visit(
      [&](auto where) -> std::string {
        // The bindings give references to change; here they are only read.
        const auto& held = where(const_cast<Case&>(value));
        using T = std::decay_t<decltype(held)>;
        if constexpr (is_list<T>) {
          std::vector<std::string> items;
          for (const auto& item : held) items.push_back(item_text(item));
          return fmt::format("[{}]", fmt::join(items, ", "));
        } else {
          return item_text(held);
        }
      },
      key.where);
}

std::string keys_text(const std::string& section) {
  const auto names = sections();
  if (!section.empty() && std::find(names.begin(), names.end(), section) == names.end()) {
    throw std::invalid_argument(fmt::format("keys: no section '{}'; nearest: {}; known: {}",
                                            section, continuum::nearest(section, names),
                                            fmt::join(names, ", ")));
  }
  const Case defaults;
  std::string out, current = "-";
  for (const Key& key : keys()) {
    if (!section.empty() && key.section != section) continue;
    if (key.section != current) {
      current = key.section;
      out += fmt::format("{}{}\n", out.empty() ? "" : "\n", heading(current));
      if (const auto note = note_of(current); !note.empty()) out += "  # " + note + "\n";
    }
    out += fmt::format("  {} = {}  ({}; {}; {})\n      {}{}\n", key.name, value_text(key, defaults),
                       type_name(key), key.unit == "-" ? "no unit" : key.unit, allowed(key),
                       key.meaning, key.source.empty() ? "" : " [" + key.source + "]");
  }
  return out;
}

std::string keys_markdown() {
  const Case defaults;
  std::string out =
      "# Case keys\n\nGenerated by `grainfield keys --markdown` from the declarations in "
      "`coupling/case/`; SI units (2D: areal density in kg/m2, stiffness in N/m). `[quick]` holds "
      "any of these keys, in tables of the same names (`[quick.ensemble]`), and overrides them "
      "with `--quick`. `[model.LABEL]` holds a model's parameters (`grainfield model NAME --list`) "
      "and optionally `name`.\n";
  std::string current = "-";
  const auto cell = [](std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) {
      text.replace(at, 1, "\\|");
    }
    return text;
  };
  for (const Key& key : keys()) {
    if (key.section != current) {
      current = key.section;
      out += fmt::format("\n## {}\n\n", current.empty() ? "Top level" : heading(current));
      if (const auto note = note_of(current); !note.empty()) out += note + "\n\n";
      out += "| key | type | unit | default | allowed | meaning | source |\n";
      out += "|---|---|---|---|---|---|---|\n";
    }
    out += fmt::format("| `{}` | {} | {} | `{}` | {} | {} | {} |\n", key.name, type_name(key),
                       key.unit, cell(value_text(key, defaults)), cell(allowed(key)),
                       cell(key.meaning), key.source);
  }
  return out;
}

}  // namespace grainfield::coupling
