#include "coupling/case/keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <unordered_map>

#include "continuum/model.h"
#include "coupling/case/common_keys.h"
#include "coupling/case/declare.h"
#include "coupling/case/study.h"
#include "coupling/result/text_table.h"

namespace grainfield::coupling {
namespace {

template <class T>
constexpr bool is_list =
    std::is_same_v<T, std::vector<double>> || std::is_same_v<T, std::vector<std::string>>;

// The shortest text that reads back to the same number, and is a TOML float.
std::string number_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string item_text(double value) { return number_text(value); }
std::string item_text(const std::string& value) { return toml_text(value); }
std::string item_text(bool value) { return value ? "true" : "false"; }
std::string item_text(std::int64_t value) { return std::to_string(value); }
std::string item_text(int value) { return std::to_string(value); }

std::string heading(const std::string& section) {
  return section.empty() ? "top level" : "[" + section + "]";
}

const std::vector<std::string>& sections_of_every_study() {
  static const std::vector<std::string> names{"", "compare", "output", "sweep"};
  return names;
}

std::string note_of(const std::string& section) {
  std::vector<std::string> names;
  for (const Study& study : studies()) {
    if (section_applies(section, study.name)) names.push_back(study.name);
  }
  return names.size() == studies().size() ? ""
                                          : fmt::format("Studies: {}.", fmt::join(names, ", "));
}

// The key's own studies where they are fewer than its section's, with the remark's end.
std::string own_studies(const Key& key) {
  std::vector<std::string> names;
  bool fewer = false;
  for (const Study& study : studies()) {
    if (key_applies(key, study.name)) {
      names.push_back(study.name);
    } else {
      fewer = fewer || section_applies(key.section, study.name);
    }
  }
  return fewer ? fmt::format("{}: ", fmt::join(names, ", ")) : "";
}

// The default, and those of studies that differ from the first one to which the key applies.
struct Defaults {
  std::string first;
  std::vector<std::pair<std::string, std::string>> others;  // study, default
};

std::string default_of(const Key& key, const Study& study) {
  if (!key.follows.empty()) return key.follows;
  Case value;
  value.study = study.name;
  return value_text(key, value);
}

Defaults defaults_of(const Key& key) {
  Defaults out;
  for (const Study& study : studies()) {
    if (!key_applies(key, study.name)) continue;
    const std::string text =
        key.path() == "study" ? value_text(key, Case()) : default_of(key, study);
    if (out.first.empty()) {
      out.first = text;
    } else if (text != out.first) {
      out.others.emplace_back(study.name, text);
    }
  }
  return out;
}

// "list of numbers, one or more, each once".
std::string type_shown(const Key& key) {
  const std::string entries = entries_allowed(key);
  return type_name(key) + (entries.empty() ? "" : ", " + entries);
}

// " (study pair)": of a need that not all studies with the key have.
std::string studies_of(const Need& need, const Key& key) {
  std::vector<std::string> names;
  bool fewer = false;
  for (const Study& study : studies()) {
    if (!key_applies(key, study.name)) continue;
    if (key_applies(*find_key(need.key), study.name)) {
      names.push_back(study.name);
    } else {
      fewer = true;
    }
  }
  return fewer ? fmt::format(" (study {})", fmt::join(names, ", ")) : "";
}

bool is_unmet(const Need& need, const Case& value) {
  const Key& other = *find_key(need.key);
  if (!key_applies(other, value.study)) return false;
  if (value.sweep.key == "variant" || value.sweep.key == need.key) return false;
  if (is_without_effect(other, value)) return true;
  const auto is_needed = [&](const std::string& word) {
    return std::find(need.values.begin(), need.values.end(), word) != need.values.end();
  };
  return std::visit(
      [&](auto where) {
        const auto& held = where(const_cast<Case&>(value));  // only read
        using T = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<T, std::vector<std::string>>) {
          return need.values.empty() ? held.empty()
                                     : std::none_of(held.begin(), held.end(), is_needed);
        } else if constexpr (std::is_same_v<T, std::string>) {
          return !is_needed(held);
        } else {
          return !is_needed(value_text(other, value));
        }
      },
      other.where);
}

Key& key_of(const std::string& path, const Study& study, std::vector<Key>& list) {
  const auto key =
      std::find_if(list.begin(), list.end(), [&](const Key& k) { return k.path() == path; });
  if (key == list.end()) {
    throw std::logic_error(fmt::format("study {}: no key {}", study.name, path));
  }
  return *key;
}

// Those of a study come before the key's own.
void add_needs(const Study& study, std::vector<Key>& list) {
  for (const OwnNeed& own : study.needs) {
    Key& key = key_of(own.path, study, list);
    key.needs.insert(key.needs.begin(), Need{own.key, own.values});
  }
}

void add_words(const Study& study, std::vector<Key>& list) {
  for (const OwnWords& own : study.words) {
    std::vector<std::string>& all = key_of(own.path, study, list).choices;
    for (const std::string& word : own.choices) {
      if (std::find(all.begin(), all.end(), word) == all.end()) all.push_back(word);
    }
  }
}

// Null where the study has the key's own words.
const OwnWords* own_words(const Key& key, const std::string& study) {
  const Study* known = find_study(study);
  if (known == nullptr) return nullptr;
  for (const OwnWords& own : known->words) {
    if (own.path == key.path()) return &own;
  }
  return nullptr;
}

// Meaning of a key, with what one study adds to it ("": all of them).
std::string meaning_of(const Key& key, const std::string& study) {
  std::string out = key.meaning;
  for (const Study& one : studies()) {
    if (!study.empty() && one.name != study) continue;
    const OwnWords* own = own_words(key, one.name);
    if (own == nullptr || own->meaning.empty()) continue;
    out += (study.empty() ? "; " + one.name + ": " : ": ") + own->meaning;
  }
  return out;
}

// What stands before a key's meaning: for which studies and with which choices it has an effect.
std::string limits(const Key& key) {
  const std::string with = condition(key);
  return own_studies(key) + (with.empty() ? "" : "with " + with + ": ");
}

// A key's path is nearest to keys, a word to sections and studies.
[[noreturn]] void refuse_name(const std::string& name) {
  const bool path = name.find('.') != std::string::npos;
  std::vector<std::string> near = sections(), names;
  for (const Study& study : studies()) names.push_back(study.name);
  const std::string known =
      fmt::format("sections: {}; studies: {}", fmt::join(near, ", "), fmt::join(names, ", "));
  near.insert(near.end(), names.begin(), names.end());
  if (path) {
    near.clear();
    for (const Key& key : keys()) near.push_back(key.path());
  }
  throw std::invalid_argument(fmt::format("keys: no {} '{}'; {}; did you mean {}?",
                                          path ? "key" : "section or study", name, known,
                                          continuum::nearest(name, near)));
}

// Letters that a search for keys takes.
constexpr std::size_t kLeastPart = 3;

// What has the name "" (all), of a study, a section, a key or a part of keys, whichever comes
// first.
std::vector<const Key*> keys_named(const std::string& name) {
  const auto of = [](auto wanted) {
    std::vector<const Key*> out;
    for (const Key& key : keys()) {
      if (wanted(key)) out.push_back(&key);
    }
    return out;
  };
  if (name.empty()) return of([](const Key&) { return true; });
  if (find_study(name) != nullptr) return of([&](const Key& k) { return key_applies(k, name); });
  const auto section = of([&](const Key& k) { return k.section == name; });
  if (!section.empty()) return section;
  if (const Key* one = find_key(name)) return {one};
  const auto part = of([&](const Key& k) {
    return name.size() >= kLeastPart && k.path().find(name) != std::string::npos;
  });
  if (part.empty()) refuse_name(name);
  return part;
}

// A key as `grainfield keys` prints it; of one study with its default, null: of all.
std::string key_lines(const Key& key, const Study* study) {
  std::string standard;
  if (study != nullptr) {
    standard = default_of(key, *study);
  } else {
    const Defaults defaults = defaults_of(key);
    standard = defaults.first;
    for (const auto& [other, text] : defaults.others) {
      standard += fmt::format("; {}: {}", other, text);
    }
  }
  const std::string with = condition(key);
  const std::string before =
      study == nullptr ? limits(key) : (with.empty() ? "" : "with " + with + ": ");
  return fmt::format("  {} = {}  ({}; {}; {})\n      {}{}{}\n", key.name, standard, type_shown(key),
                     key.unit == "-" ? "no unit" : key.unit,
                     allowed(key, study == nullptr ? "" : study->name), before,
                     meaning_of(key, study == nullptr ? "" : study->name),
                     key.source.empty() ? "" : " [" + key.source + "]");
}

// Whether members of the sweep may differ in their grains' number of dimensions.
bool varies_dimension(const Case& value) {
  const Study* study = find_study(value.study);
  if (study == nullptr || study->dimension_key.empty()) return false;
  const std::string& key = study->dimension_key;
  if (value.sweep.key != "variant") return value.sweep.key == key;
  return std::any_of(value.variants.begin(), value.variants.end(), [&](const Variant& variant) {
    return std::any_of(variant.keys.begin(), variant.keys.end(),
                       [&](const std::string& text) { return text.rfind(key, 0) == 0; });
  });
}

}  // namespace

std::string toml_text(const std::string& text) {
  std::string out = "\"";
  for (const char ch : text) {
    const auto code = static_cast<unsigned char>(ch);
    if (ch == '"' || ch == '\\') out += '\\';
    if (ch == '\n') {
      out += "\\n";
    } else if ((code < 0x20 && ch != '\t') || code == 0x7f) {
      out += fmt::format("\\u{:04X}", code);  // TOML has no other way
    } else {
      out += ch;
    }
  }
  return out + "\"";
}

bool plain_name(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char ch) {
    return std::isalnum(ch) != 0 || ch == '_' || ch == '-';
  });
}

const std::vector<Key>& keys() {
  static const std::vector<Key> all = [] {
    // Files read best in the order study, ensemble, grains, averaging, models, output.
    std::vector<Key> list;
    declare_first_keys(list);
    for (const KeySection& section : study_sections()) section.declare({list, section.name});
    declare_last_keys(list);
    for (const Study& study : studies()) {
      add_needs(study, list);
      add_words(study, list);
    }
    return list;
  }();
  return all;
}

const Key* find_key(const std::string& path) {
  static const std::unordered_map<std::string, const Key*> by_path = [] {
    std::unordered_map<std::string, const Key*> out;
    for (const Key& key : keys()) out.emplace(key.path(), &key);
    return out;
  }();
  const auto at = by_path.find(path);
  return at == by_path.end() ? nullptr : at->second;
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
  const auto& always = sections_of_every_study();
  if (std::find(always.begin(), always.end(), section) != always.end()) return true;
  const Study* known = find_study(study);
  if (known == nullptr) return false;
  if (section == "ensemble") return known->has_grains();
  return std::any_of(known->sections.begin(), known->sections.end(),
                     [&](const KeySection& s) { return s.name == section; });
}

bool key_applies(const Key& key, const std::string& study) {
  if (!section_applies(key.section, study)) return false;
  if (key.space && !may_be_in_space(study)) return false;
  const Study* known = find_study(study);
  return known == nullptr || std::find(known->without.begin(), known->without.end(), key.path()) ==
                                 known->without.end();
}

int dimension_of(const Case& value) {
  const Study* study = find_study(value.study);
  return study == nullptr || study->dimension == nullptr ? 2 : study->dimension(value);
}

bool may_be_in_space(const std::string& study) {
  const Study* known = find_study(study);
  return known != nullptr && known->dimension != nullptr;
}

bool is_without_effect(const Key& key, const Case& value) {
  if (key.space && dimension_of(value) == 2 && !varies_dimension(value)) return true;
  return unmet_need(key, value) != nullptr;
}

const Need* unmet_need(const Key& key, const Case& value) {
  for (const Need& need : key.needs) {
    if (is_unmet(need, value)) return &need;
  }
  return nullptr;
}

std::string condition(const Key& key) {
  std::vector<std::string> all;
  if (key.space) all.emplace_back("3D");
  for (const Need& need : key.needs) {
    const std::string values =
        need.values.empty() ? " given" : fmt::format(" = {}", fmt::join(need.values, " or "));
    all.push_back(need.key + values + studies_of(need, key));
  }
  return fmt::format("{}", fmt::join(all, ", "));
}

std::string without_effect_text(const Key& key, const Case& value) {
  const Need* need = unmet_need(key, value);
  const Study* study = find_study(value.study);
  const std::string decides =
      study == nullptr || study->dimension_key.empty() ? "study" : study->dimension_key;
  const std::string now = need != nullptr ? need->key : decides;
  return fmt::format("has no effect, only with {} (now {})", condition(key),
                     value_text(*find_key(now), value));
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

std::string entries_allowed(const Key& key) {
  const bool list = std::visit(
      [](auto where) { return is_list<std::decay_t<decltype(where(std::declval<Case&>()))>>; },
      key.where);
  if (!list) return "";
  return std::string(key.may_be_empty ? "none or more" : "one or more") +
         (key.may_repeat ? "" : ", each once");
}

const std::vector<std::string>& choices_of(const Key& key, const std::string& study) {
  const OwnWords* own = own_words(key, study);
  return own != nullptr ? own->choices : key.choices;
}

ModelTextCheck model_check_of(const Key& key, const std::string& study) {
  const OwnWords* own = own_words(key, study);
  return own != nullptr ? own->check : nullptr;
}

std::string allowed(const Key& key, const std::string& study) {
  if (const std::vector<std::string>& choices = choices_of(key, study); !choices.empty()) {
    std::vector<std::string> words;
    for (const std::string& word : choices) {
      const auto among = [&](const std::vector<std::string>& some) {
        return std::find(some.begin(), some.end(), word) != some.end();
      };
      words.push_back(word + (among(key.plane_words)   ? " (2D)"
                              : among(key.space_words) ? " (3D)"
                                                       : ""));
    }
    return fmt::format("{}", fmt::join(words, " | "));
  }
  const std::string type = type_name(key);
  if (type == "boolean") return "true | false";
  if (type == "text" || type == "list of words") return "any";
  // Whole numbers in full, others in six digits.
  const auto shown = [&](double limit) {
    return type == "integer" ? fmt::format("{:.0f}", limit) : fmt::format("{:g}", limit);
  };
  return fmt::format("{}{} to {}", key.or_zero ? "0, or " : "", shown(key.least), shown(key.most));
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

std::string keys_text(const std::string& name) {
  const Study* study = find_study(name);
  std::string out = study == nullptr ? "" : fmt::format("study {}: {}\n", name, study->meaning);
  std::string current = "-";
  for (const Key* key : keys_named(name)) {
    if (key->section != current) {
      current = key->section;
      out += fmt::format("{}{}\n", out.empty() ? "" : "\n", heading(current));
      const auto note = study == nullptr ? note_of(current) : "";
      if (!note.empty()) out += "  # " + note + "\n";
    }
    out += key_lines(*key, study);
  }
  return out;
}

std::string keys_markdown() {
  std::string out =
      "# Case keys\n\nGenerated by `grainfield keys --markdown` from the declarations in "
      "`coupling/case/`; SI units (2D: areal density in kg/m2, stiffness in N/m). `[quick]` holds "
      "any of these keys, in tables of the same names (`[quick.ensemble]`), and overrides them "
      "with `--quick`. `[model.LABEL]` holds a model's parameters (`grainfield model NAME --list`) "
      "and optionally `name`.\n";
  std::string current = "-";
  const auto cell = [](const std::string& text) {
    return boost::replace_all_copy(text, "|", "\\|");
  };
  std::vector<std::vector<std::string>> rows;
  const auto end_section = [&] {
    if (rows.empty()) return;
    out += plain_markdown_table({"key", "type", "unit", "default", "allowed", "meaning", "source"},
                                rows);
    rows.clear();
  };
  for (const Key& key : keys()) {
    if (key.section != current) {
      end_section();
      current = key.section;
      out += fmt::format("\n## {}\n\n", current.empty() ? "Top level" : heading(current));
      if (const auto note = note_of(current); !note.empty()) out += note + "\n\n";
    }
    const Defaults defaults = defaults_of(key);
    std::string standard = fmt::format("`{}`", cell(defaults.first));
    for (const auto& [study, text] : defaults.others) {
      standard += fmt::format("; {}: `{}`", study, cell(text));
    }
    rows.push_back({fmt::format("`{}`", key.name), type_shown(key), key.unit, standard,
                    cell(allowed(key)), cell(limits(key) + meaning_of(key, "")), key.source});
  }
  end_section();
  return out;
}

}  // namespace grainfield::coupling
