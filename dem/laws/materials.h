// How materials act on each other: law and friction by pair.
#pragma once
#include <string>
#include <vector>

#include "dem/laws/registry.h"
#include "dem/laws/rolling.h"

namespace grainfield::dem {

/// Two materials, or one with itself, in any order.
struct MaterialPair {
  std::string first, second;
  AnyLaw law;
  double friction = 0.5;
  RollingLaw rolling{};
};

/// Between all grains, and of grains with walls that have a material.
struct Materials {
  AnyLaw law;                                ///< where no materials are named
  double friction = 0.5;                     ///< likewise; grain on grain
  std::vector<std::string> materials;        ///< names; empty: there is one, without a name
  std::vector<MaterialPair> material_pairs;  ///< of every two that can meet; all of one kind of law
  /// Where no materials are named; also of grains with walls. A wall without a material has that of
  /// each grain with its like.
  RollingLaw rolling{};

  /// Some pair resists rolling or twisting.
  bool resist_rolling() const;
};

/// Throws std::invalid_argument naming what does not hold: a friction, or a number of rolling, that
/// is below 0 or not finite, a name twice, a pair of unknown materials, a pair twice, laws of
/// several kinds, more than 255 materials.
void check_materials(const Materials& materials);

/// Its place in the list; 0 for "" without a list. Throws std::invalid_argument naming `key`.
int material_index(const Materials& materials, const std::string& key, const std::string& name);

/// Throws std::invalid_argument: nothing is known of these two.
[[noreturn]] void refuse_pair(const std::string& first, const std::string& second);

/// Law and friction by pair of places in the list.
template <class Law>
class Rules {
 public:
  struct Rule {
    Law law;
    double friction = 0;
    bool given = false;
    RollingLaw rolling{};
  };

  Rules() = default;
  /// One for all.
  Rules(const Law& law, double friction) : rules_{{law, friction, true}} {}
  /// `materials` must have been checked, and its laws be this one.
  explicit Rules(const Materials& materials)
      : names_(materials.materials),
        count_(names_.empty() ? 1 : static_cast<int>(names_.size())),
        rules_(static_cast<std::size_t>(count_) * count_) {
    if (names_.empty())
      rules_[0] = {std::get<Law>(materials.law), materials.friction, true, materials.rolling};
    for (const MaterialPair& pair : materials.material_pairs) {
      const int a = material_index(materials, "material pair", pair.first);
      const int b = material_index(materials, "material pair", pair.second);
      at(a, b) = at(b, a) = {std::get<Law>(pair.law), pair.friction, true, pair.rolling};
    }
  }

  int count() const { return count_; }
  std::string name(int kind) const { return names_.empty() ? "" : names_[kind]; }
  const Rule& of(int a, int b) const {
    return count_ == 1 ? rules_[0] : rules_[static_cast<std::size_t>(a) * count_ + b];
  }
  /// Throws std::invalid_argument when nothing is known of the two.
  void require(int a, int b) const {
    if (!of(a, b).given) refuse_pair(names_[a], names_[b]);
  }

 private:
  Rule& at(int a, int b) { return rules_[static_cast<std::size_t>(a) * count_ + b]; }

  std::vector<std::string> names_;
  int count_ = 1;
  std::vector<Rule> rules_ = std::vector<Rule>(1);
};

}  // namespace grainfield::dem
