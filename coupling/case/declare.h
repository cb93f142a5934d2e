// How sections declare their keys; used by the *_keys.cc files only.
#pragma once
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "coupling/case/keys.h"

namespace grainfield::coupling {

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

struct Range {
  double least = -kNoLimit, most = kNoLimit;
  bool open_least = false;
};
inline constexpr Range kPositive{0, kNoLimit, true};
inline constexpr Range kNotNegative{0, kNoLimit, false};

/// Collects the keys of one section.
class Section {
 public:
  Section(std::vector<Key>& keys, std::string name) : keys_(keys), name_(std::move(name)) {}

  void number(const std::string& name, const std::string& unit, Binding where, Range range,
              const std::string& meaning, const std::string& source = "") {
    Key& key = add(name, unit, where, meaning, source);
    key.least = range.least;
    key.most = range.most;
    key.open_least = range.open_least;
  }
  void word(const std::string& name, Binding where, std::vector<std::string> choices,
            const std::string& meaning, const std::string& source = "") {
    add(name, "-", where, meaning, source).choices = std::move(choices);
  }
  /// The last key, a list, may be without any value.
  void or_none() { keys_.back().may_be_empty = true; }
  /// The last key, a list, may hold a value more than once.
  void with_repeats() { keys_.back().may_repeat = true; }
  /// The last key has an effect only where another one is (or, of a list, holds) one of these.
  void only(const std::string& needs, std::vector<std::string> needed) {
    keys_.back().needs = needs;
    keys_.back().needed = std::move(needed);
  }
  void flag(const std::string& name, Binding where, const std::string& meaning) {
    add(name, "-", where, meaning, "").most = 1;
  }

 private:
  Key& add(const std::string& name, const std::string& unit, Binding where,
           const std::string& meaning, const std::string& source) {
    Key key{};
    key.section = name_;
    key.name = name;
    key.unit = unit;
    key.where = where;
    key.meaning = meaning;
    key.source = source;
    return keys_.emplace_back(std::move(key));
  }

  std::vector<Key>& keys_;
  std::string name_;
};

void declare_grain_keys(std::vector<Key>& keys);
void declare_pile_keys(std::vector<Key>& keys);
void declare_lattice_keys(std::vector<Key>& keys);
void declare_heap_keys(std::vector<Key>& keys);
void declare_grain_files_keys(std::vector<Key>& keys);
void declare_fields_keys(std::vector<Key>& keys);
void declare_fit_keys(std::vector<Key>& keys);
void declare_verdict_keys(std::vector<Key>& keys);
void declare_analysis_keys(std::vector<Key>& keys);

}  // namespace grainfield::coupling
