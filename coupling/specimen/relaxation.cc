#include "coupling/specimen/relaxation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include "dem/snapshot/contact_changes.h"

namespace grainfield::coupling {
namespace {

using dem::Contact;
using dem::Grain;
using dem::Snapshot;
using dem::Vec3;

constexpr int kLevels = 10;
constexpr double kLeastAbove = 0.05;  // of the weight

double weight_of_centres_above(const Snapshot& s, double level) {
  double mass = 0;
  for (const Grain& g : s.grains) {
    if (!g.fixed && g.position.y() > level) mass += g.mass;
  }
  return mass * std::fabs(s.gravity.y());
}

double largest_error(const Snapshot& s, double top) {
  const double all = weight_of_centres_above(s, -std::numeric_limits<double>::infinity());
  double largest = 0;
  for (int k = 0; k < kLevels; ++k) {
    const double level = top * k / kLevels;
    if (weight_of_centres_above(s, level) < kLeastAbove * all) break;
    largest = std::max(largest, std::fabs(weight_carried_error(s, level)));
  }
  return largest;
}

double change_of_forces(const Snapshot& before, const Snapshot& after) {
  std::map<std::pair<std::int64_t, std::int64_t>, Vec3> forces;
  double sum = 0, change = 0;
  for (const Contact& c : before.contacts) {
    forces.try_emplace({c.i, c.j}, 0, 0, 0).first->second += c.force;
    sum += c.force.norm();
  }
  for (const Contact& c : after.contacts) {
    forces.try_emplace({c.i, c.j}, 0, 0, 0).first->second -= c.force;
  }
  for (const auto& [pair, difference] : forces) change += difference.norm();
  return sum > 0 ? change / sum : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

double weight_carried_error(const Snapshot& s, double level) {
  const auto is_above = [&](std::int64_t i) {
    return !s.grains[i].fixed && s.grains[i].position.y() > level;
  };
  double force = 0;
  for (const Contact& c : s.contacts) {
    const bool first = is_above(c.i), second = c.j >= 0 && is_above(c.j);
    if (first != second) force += first ? c.force.y() : -c.force.y();
  }
  const double weight = weight_of_centres_above(s, level);
  return weight > 0 ? force / weight - 1 : std::numeric_limits<double>::quiet_NaN();
}

Relaxation measure_relaxation(const Snapshot& before, const Snapshot& after, double diameter) {
  if (before.grains.size() != after.grains.size()) {
    throw std::invalid_argument("relaxation: found different numbers of grains");
  }
  Relaxation r;
  double top = 0, way = 0;
  int free = 0;
  for (std::size_t k = 0; k < before.grains.size(); ++k) {
    const Grain &a = before.grains[k], &b = after.grains[k];
    if (a.id != b.id) throw std::invalid_argument("relaxation: found different grains");
    if (a.fixed) continue;
    const double moved = (b.position - a.position).norm() / diameter;
    r.largest_displacement = std::max(r.largest_displacement, moved);
    way += moved;
    top = std::max(top, a.position.y());
    ++free;
  }
  if (free == 0) throw std::invalid_argument("relaxation: found no grain that can move");
  r.mean_displacement = way / free;
  r.base_before = base_force(before).y() /
                  weight_of_centres_above(before, -std::numeric_limits<double>::infinity());
  r.levels_before = largest_error(before, top);
  r.levels_after = largest_error(after, top);
  r.forces = change_of_forces(before, after);
  return r;
}

}  // namespace grainfield::coupling
