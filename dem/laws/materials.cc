#include "dem/laws/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace grainfield::dem {
namespace {

constexpr std::size_t kMostMaterials = 255;  // the engine keeps a byte of each grain

void check_friction(const std::string& key, double friction) {
  if (!(friction >= 0)) {
    throw std::invalid_argument(fmt::format("{}: found {}, allowed: 0 or more", key, friction));
  }
}

void check_rolling(const std::string& prefix, const RollingLaw& r) {
  const std::pair<const char*, double> numbers[] = {
      {"rolling_stiffness", r.stiffness},       {"rolling_damping", r.damping},
      {"rolling_friction", r.friction},         {"twisting_stiffness", r.twisting_stiffness},
      {"twisting_damping", r.twisting_damping}, {"twisting_friction", r.twisting_friction}};
  for (const auto& [name, value] : numbers) {
    if (!(value >= 0 && std::isfinite(value))) {
      throw std::invalid_argument(
          fmt::format("{}{}: found {}, allowed: 0 or more", prefix, name, value));
    }
  }
  const auto require_force = [&](const char* kind, double mu, double k, double g) {
    if (mu > 0 && k == 0 && g == 0) {
      throw std::invalid_argument(fmt::format(
          "{0}{1}_friction: found {2} without {1}_stiffness and {1}_damping, allowed: above 0 with "
          "one of them above 0",
          prefix, kind, mu));
    }
  };
  require_force("rolling", r.friction, r.stiffness, r.damping);
  require_force("twisting", r.twisting_friction, r.twisting_stiffness, r.twisting_damping);
}

}  // namespace

bool Materials::resist_rolling() const {
  return (materials.empty() && rolling.on()) ||
         std::any_of(material_pairs.begin(), material_pairs.end(),
                     [](const MaterialPair& pair) { return pair.rolling.on(); });
}

void check_materials(const Materials& m) {
  check_friction("material.friction", m.friction);
  check_rolling("material.", m.rolling);
  if (m.materials.size() > kMostMaterials) {
    throw std::invalid_argument(fmt::format("materials: found {}, allowed: at most {}",
                                            m.materials.size(), kMostMaterials));
  }
  for (auto it = m.materials.begin(); it != m.materials.end(); ++it) {
    if (it->empty() || std::find(m.materials.begin(), it, *it) != it) {
      throw std::invalid_argument(fmt::format(
          "materials: found \"{}\" twice or without a name, allowed: names that differ", *it));
    }
  }
  std::vector<std::pair<int, int>> seen;
  for (const MaterialPair& pair : m.material_pairs) {
    const std::string key = fmt::format("material pair {} - {}", pair.first, pair.second);
    int a = material_index(m, key, pair.first), b = material_index(m, key, pair.second);
    check_friction(key, pair.friction);
    check_rolling(key + ": ", pair.rolling);
    if (a > b) std::swap(a, b);
    if (std::find(seen.begin(), seen.end(), std::pair(a, b)) != seen.end()) {
      throw std::invalid_argument(fmt::format("{}: found twice, allowed: once", key));
    }
    seen.emplace_back(a, b);
    if (pair.law.index() != m.material_pairs.front().law.index()) {
      const auto word = [](const AnyLaw& law) {
        return std::visit([](const auto& l) { return l.name; }, law);
      };
      throw std::invalid_argument(
          fmt::format("{}: found law \"{}\", allowed: \"{}\" as for {} - {}", key, word(pair.law),
                      word(m.material_pairs.front().law), m.material_pairs.front().first,
                      m.material_pairs.front().second));
    }
  }
}

int material_index(const Materials& m, const std::string& key, const std::string& name) {
  if (m.materials.empty()) {
    if (name.empty()) return 0;
    throw std::invalid_argument(fmt::format(
        "{}: found material \"{}\", allowed: none, as no materials are named", key, name));
  }
  const auto at = std::find(m.materials.begin(), m.materials.end(), name);
  if (at == m.materials.end()) refuse_word(key, name, m.materials);
  return static_cast<int>(at - m.materials.begin());
}

void refuse_pair(const std::string& first, const std::string& second) {
  throw std::invalid_argument(fmt::format(
      "material pair {} - {}: found none, allowed: a law and a friction for every two materials "
      "that can meet",
      first, second));
}

}  // namespace grainfield::dem
