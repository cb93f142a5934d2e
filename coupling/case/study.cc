#include "coupling/case/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

namespace grainfield::coupling {
namespace {

// Studies that were added, until somebody asks for all of them.
struct Added {
  std::vector<Study (*)()> makers;
  bool closed = false;
};

Added& added() {
  static Added one;
  return one;
}

std::vector<Study> all_studies() {
  std::vector<Study> all = shipped_studies();
  added().closed = true;
  for (Study (*make)() : added().makers) {
    Study study = make();
    for (const Study& other : all) {
      if (other.name == study.name) throw std::logic_error("two studies " + study.name);
    }
    all.push_back(std::move(study));
  }
  return all;
}

std::vector<KeySection>::iterator find_section(std::vector<KeySection>& all,
                                               std::string_view name) {
  return std::find_if(all.begin(), all.end(), [&](const KeySection& s) { return s.name == name; });
}

// A section that is new stands before the next one of its study that is there already.
std::vector<KeySection> sections_of_role(KeyRole role) {
  std::vector<KeySection> all;
  for (const Study& study : studies()) {
    for (std::size_t k = 0; k < study.sections.size(); ++k) {
      const KeySection& section = study.sections[k];
      if (section.role != role) continue;
      if (const auto at = find_section(all, section.name); at != all.end()) {
        if (at->declare == section.declare) continue;
        throw std::logic_error(fmt::format("two sections [{}]", section.name));
      }
      auto place = all.end();
      for (std::size_t n = k + 1; n < study.sections.size() && place == all.end(); ++n) {
        place = find_section(all, study.sections[n].name);
      }
      all.insert(place, section);
    }
  }
  return all;
}

}  // namespace

const std::vector<Study>& studies() {
  static const std::vector<Study> all = all_studies();
  return all;
}

bool add_study(Study (*make)()) {
  if (added().closed) throw std::logic_error("add_study: the studies have been asked for");
  added().makers.push_back(make);
  return true;
}

std::string default_study() { return studies().front().name; }

const Study* find_study(const std::string& name) {
  for (const Study& study : studies()) {
    if (study.name == name) return &study;
  }
  return nullptr;
}

const Study& study_of(const Case& value) {
  const Study* study = find_study(value.study);
  if (study == nullptr) throw std::logic_error("unknown study " + value.study);
  return *study;
}

const std::vector<KeySection>& study_sections() {
  static const std::vector<KeySection> all = [] {
    std::vector<KeySection> out = sections_of_role(KeyRole::grains);
    for (const KeySection& s : sections_of_role(KeyRole::analysis)) out.push_back(s);
    return out;
  }();
  return all;
}

}  // namespace grainfield::coupling
