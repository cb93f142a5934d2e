#include "coupling/case/case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "continuum/settings.h"
#include "coupling/base/mistakes.h"
#include "coupling/case/apply.h"
#include "coupling/case/members.h"
#include "coupling/case/study.h"

namespace grainfield::coupling {
namespace {

constexpr std::string_view kQuick = "quick.";

bool is_quick(const Assignment& a) {
  return a.path == "quick" || a.path.compare(0, kQuick.size(), kQuick) == 0;
}

Assignment without_quick(Assignment a) {
  a.path = a.path.substr(std::min(a.path.size(), kQuick.size()));
  return a;
}

void put(Draft& draft, const std::vector<Assignment>& assignments, MistakeList& mistakes) {
  for (const auto& a : assignments) mistakes.attempt([&] { apply(draft, a); });
}

bool names_key(const std::vector<Assignment>& list, const std::string& path) {
  return std::any_of(list.begin(), list.end(), [&](const auto& a) { return a.path == path; });
}

// SECTION.KEY, or SECTION alone, in the section's present name: also within a variant.
void rename_section(const std::string& former, const std::string& now, std::string& path) {
  std::size_t at = 0;
  if (path.starts_with("variant.")) at = path.find('.', std::string_view("variant.").size()) + 1;
  const std::size_t end = std::min(path.find('.', at), path.size());
  if (path.compare(at, end - at, former) == 0) path.replace(at, former.size(), now);
}

// A study's former name becomes its present one, with the sections and keys that it stood for.
// `lists` in their order: keys of the later ones count.
void take_former_names(const std::vector<std::vector<Assignment>*>& lists) {
  const auto is_named = [](const Assignment& a, const FormerName& former) {
    return a.path == "study" && !a.list && a.items.size() == 1 &&
           scalar_text(a.items.front()) == former.name;
  };
  for (const Study& study : studies()) {
    for (const FormerName& former : study.former) {
      const auto where = std::find_if(lists.begin(), lists.end(), [&](const auto* list) {
        return std::any_of(list->begin(), list->end(),
                           [&](const Assignment& a) { return is_named(a, former); });
      });
      if (where == lists.end()) continue;
      std::string origin;
      for (std::vector<Assignment>* list : lists) {
        for (Assignment& a : *list) {
          if (is_named(a, former)) {
            a.items = {study.name};
            if (origin.empty()) origin = a.origin;
          }
          for (const auto& [old, now] : former.sections) {
            rename_section(old, now, a.path);
            if (a.path != "sweep.key" || a.items.size() != 1) continue;
            std::string swept = scalar_text(a.items.front());
            rename_section(old, now, swept);
            a.items = {swept};
          }
        }
      }
      std::vector<Assignment> meant;
      for (const std::string& text : former.keys) {
        Assignment key = parse_override(text);
        key.origin = origin;
        if (std::none_of(lists.begin(), where + 1,
                         [&](const auto* list) { return names_key(*list, key.path); })) {
          meant.push_back(std::move(key));
        }
      }
      (*where)->insert((*where)->end(), meant.begin(), meant.end());
    }
  }
}

std::string stem(const std::string& file) { return std::filesystem::path(file).stem().string(); }

std::string model_value(const continuum::Parameter& parameter, const std::string& value) {
  return parameter.choices.empty() && !continuum::is_text(parameter) ? value : "\"" + value + "\"";
}

}  // namespace

Case read_case(const std::string& file, bool quick, const Overrides& overrides) {
  std::vector<Assignment> base, fast;
  for (auto& a : read_document(file)) {
    if (!is_quick(a)) {
      base.push_back(std::move(a));
    } else if (a.path != "quick") {
      fast.push_back(without_quick(std::move(a)));
    } else if (!a.table) {
      reject(a, "quick", "found a value, expected a table of keys");
    }
  }
  if (base.empty() && fast.empty() && overrides.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: holds no key; a case names at least its study, e.g. study = \"{}\"", file,
                    default_study()));
  }
  if (quick && fast.empty()) {
    throw std::invalid_argument(
        fmt::format("--quick: found no [quick] settings in {}; run it without, or add a table such "
                    "as [quick.ensemble]",
                    file));
  }
  std::vector<Assignment> set = parse_overrides(overrides);
  take_former_names({&base, &fast, &set});

  Draft draft;
  draft.file = file;
  draft.value.name = stem(file);
  MistakeList mistakes;
  // Some keys mean another member in another study, wherever the study is named.
  for (const auto* list : {&base, &fast, &set}) {
    if (list == &fast && !quick) continue;
    for (const auto& a : *list) {
      if (a.path == "study") mistakes.attempt([&] { apply(draft, a); });
    }
  }
  const bool known_study = mistakes.empty();
  put(draft, base, mistakes);
  // The quick setting is checked even where it is not used: a mistake shows before it is needed.
  Draft with_quick = draft;
  put(with_quick, fast, mistakes);
  put(quick ? with_quick : draft, set, mistakes);
  // Mistakes of single keys are told together. Those of several keys are told where there is none.
  if (known_study) {
    check_keys(with_quick, mistakes);
    if (!quick) check_keys(draft, mistakes);
  }
  mistakes.sort_by_line(file);
  mistakes.require_none();
  if (quick || !fast.empty()) finish(with_quick);
  if (quick) return with_quick.value;
  finish(draft);
  return draft.value;
}

std::vector<SweepCase> sweep_cases(const Case& value) {
  if (value.sweep.key.empty()) return {{"", value}};
  Draft draft;
  draft.value = value;
  for (const auto& model : value.models) {
    auto& table = draft.models[model.label];
    table["name"] = parse_override("model." + model.label + ".name=" + model.name);
    for (const auto& [parameter, setting] : model.settings) {
      table[parameter] = parse_override("model." + model.label + "." + parameter + "=" + setting);
    }
  }
  const Members members(draft);
  std::vector<SweepCase> out;
  for (const auto& text : value.sweep.values) {
    Draft one = members.of(text);
    finish(one);
    out.push_back({member_name(value.sweep.key, text), one.value});
  }
  return out;
}

std::string write_case(const Case& value) {
  std::string out, current;
  for (const Key& key : keys()) {
    if (!key_applies(key, value.study)) continue;
    if (key.section == "sweep" && value.sweep.key.empty()) continue;
    if (key.section != current) {
      current = key.section;
      out += fmt::format("\n[{}]\n", current);
    }
    std::string remark = key.unit == "-" ? "" : key.unit + "; ";
    remark += key.meaning;
    if (!key.choices.empty()) remark = allowed(key, value.study) + "; " + remark;
    // A written-out case says what holds: keys without effect are there for those who look.
    const bool no_effect = is_without_effect(key, value);
    if (no_effect) remark = fmt::format("only with {}; {}", condition(key), remark);
    out += fmt::format("# {}\n{}{} = {}\n", remark, no_effect || key.remarked ? "# " : "", key.name,
                       value_text(key, value));
  }
  for (const auto& model : value.models) {
    const auto& info = continuum::find_model(model.name);
    const auto label = plain_name(model.label) ? model.label : "\"" + model.label + "\"";
    out += fmt::format("\n[model.{}]\nname = \"{}\"\n", label, model.name);
    for (const auto& p : info.parameters) {
      const auto given = model.settings.find(p.name);
      const std::string remark =
          fmt::format("{}{}", p.unit == "-" || p.unit.empty() ? "" : p.unit + "; ", p.meaning);
      if (given != model.settings.end()) {
        out += fmt::format("# {}\n{} = {}\n", remark, p.name, model_value(p, given->second));
      } else if (filled_by_run(p.name, value.study)) {
        out += fmt::format("# {} is filled from the run: {}\n", p.name, remark);
      } else if (std::isnan(p.value)) {
        out += fmt::format("# {} is unset: {}\n", p.name, remark);
      } else {
        const std::string standard = continuum::is_text(p) ? std::string()
                                     : p.choices.empty()   ? fmt::format("{}", p.value)
                                                           : p.choices.front();
        out += fmt::format("# {}\n{} = {}\n", remark, p.name, model_value(p, standard));
      }
    }
  }
  for (const Variant& variant : value.variants) {
    out += fmt::format("\n[variant.{}]\n",
                       plain_name(variant.name) ? variant.name : toml_text(variant.name));
    for (const std::string& key : variant.keys) out += key + "\n";
  }
  return out;
}

std::string grain_keys_text(const Case& value) {
  std::vector<std::string> others{"compare", "output"};
  for (const KeySection& section : study_sections()) {
    if (section.role == KeyRole::analysis) others.emplace_back(section.name);
  }
  std::string out;
  for (const Key& key : keys()) {
    if (!key_applies(key, value.study) || key.path() == "title" ||
        key.path() == "ensemble.realizations" ||
        std::find(others.begin(), others.end(), key.section) != others.end()) {
      continue;
    }
    out += fmt::format("{} = {}\n", key.path(), value_text(key, value));
  }
  for (const Variant& variant : value.variants) {
    for (const std::string& key : variant.keys) {
      if (std::find(others.begin(), others.end(), key.substr(0, key.find('.'))) == others.end()) {
        out += fmt::format("variant {}: {}\n", variant.name, key);
      }
    }
  }
  return out;
}

bool filled_by_run(const std::string& parameter, const std::string& study) {
  const Study* known = find_study(study);
  return known != nullptr &&
         std::find(known->fills.begin(), known->fills.end(), parameter) != known->fills.end();
}

std::string case_title(const std::string& file) {
  for (const auto& a : read_document(file)) {
    if (a.path == "title" && a.items.size() == 1) return scalar_text(a.items.front());
  }
  return "";
}

}  // namespace grainfield::coupling
