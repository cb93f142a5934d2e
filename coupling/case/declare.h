// How sections declare their keys; used by the files of keys only.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupling/case/keys.h"
#include "coupling/case/study.h"

/// Binds a key to the member MEMBER of the case's setup SETUP: the default is that member's.
#define GRAINFIELD_MEMBER(SETUP, MEMBER) \
  +[](Case & c) -> auto& {               \
    return c.get<SETUP>().MEMBER;        \
  }

namespace grainfield::coupling {

struct Range {
  double least = 0, most = 0;
  bool or_zero = false;  ///< 0 is allowed besides, where it means "not given" or "none"

  Range with_zero() const { return {least, most, true}; }
};
/// What SI units of sand, gravel and boulders reach, and far beyond; further out sums of squares
/// and quotients lose their digits.
inline constexpr Range kRadius{1e-6, 1e3};        ///< m
inline constexpr Range kLength{1e-6, 1e6};        ///< m
inline constexpr Range kOffset{-1e6, 1e6};        ///< m
inline constexpr Range kTime{1e-6, 1e6};          ///< s
inline constexpr Range kForce{1e-9, 1e12};        ///< N
inline constexpr Range kStiffness{1e-3, 1e15};    ///< N/m
inline constexpr Range kRate{0, 1e9};             ///< 1/s
inline constexpr Range kAcceleration{1e-6, 1e6};  ///< m/s2
inline constexpr Range kRatioOfForces{1e-14, 0.1};

/// Collects the keys of one section.
class SectionKeys {
 public:
  SectionKeys(std::vector<Key>& keys, std::string name) : keys_(keys), name_(std::move(name)) {}

  void number(const std::string& name, const std::string& unit, Binding where, Range range,
              const std::string& meaning, const std::string& source = "") {
    Key& key = add(name, unit, where, meaning, source);
    key.least = range.least;
    key.most = range.most;
    key.or_zero = range.or_zero;
  }
  void word(const std::string& name, Binding where, std::vector<std::string> choices,
            const std::string& meaning, const std::string& source = "") {
    add(name, "-", where, meaning, source).choices = std::move(choices);
  }
  /// The last key, a list, may be without any value.
  void or_none() { keys_.back().may_be_empty = true; }
  /// The last key, a list, may hold a value more than once.
  void with_repeats() { keys_.back().may_repeat = true; }
  /// The last key has an effect only where another one is (or, of a list, holds) one of these. Of
  /// several such needs all hold; those of keys that a study does not have do not concern it.
  void only(const std::string& key, std::vector<std::string> values) {
    keys_.back().needs.push_back({key, std::move(values)});
  }
  /// The last key's words are shapes of grains in the plane: one of three dimensions is refused as
  /// such.
  void plane_shapes() { keys_.back().plane_shapes = true; }
  /// The default of the last key follows another key: "2/7 of normal_stiffness".
  void follows(const std::string& what) { keys_.back().follows = what; }
  /// The last key is a remark in a case that is written out: another one there says the same.
  void remarked() { keys_.back().remarked = true; }
  /// The last key means something in three dimensions only.
  void space() { keys_.back().space = true; }
  /// Names the last key's words that are valid in two or in three dimensions only.
  void words_of_dimensions(std::vector<std::string> plane, std::vector<std::string> space) {
    keys_.back().plane_words = std::move(plane);
    keys_.back().space_words = std::move(space);
  }
  /// The section's other keys have an effect only where this one, a list, holds anything.
  void others_need_any(const std::string& name) {
    for (Key& key : keys_) {
      if (key.section == name_ && key.name != name) key.needs.push_back({name_ + "." + name, {}});
    }
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

}  // namespace grainfield::coupling
