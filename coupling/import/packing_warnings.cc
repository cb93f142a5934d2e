#include "coupling/import/packing_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "continuum/constants.h"
#include "coupling/averaging/layer.h"

namespace grainfield::coupling {
namespace {

constexpr double kUnbalanced = 0.1;  // unbalanced force ratio of a packing that is not at rest
constexpr double kSupport = 0.1;     // of the weight: missing or too much at walls
constexpr double kClearSupport = 0.02, kClearErrors = 3;  // or beyond both: share, its own errors
constexpr double kManyPull = 0.01;                        // of the contacts
constexpr double kMostPull = 0.9;  // of those between grains, or with walls: their signs are turned
constexpr double kManySteep = 0.1;  // of the pairs, with more tangential than normal force
constexpr int kFewSteep = 2;
constexpr int kFewPairs = 3;   // too few to tell that there is no friction
constexpr int kExplains = 10;  // a turned sign is the cause where it leaves a tenth of the pulls
constexpr double kOtherUnits = 0.02;  // of the weight: less is no matter of some missing contacts
constexpr double kLeastDensity = 10, kMostDensity = 30000;    // kg/m3, kg/m2
constexpr double kLeastDiameter = 1e-7, kMostDiameter = 100;  // m
// Moment of inertia over mass and radius squared: a ring's is 1, a needle's about its axis smaller.
constexpr double kLeastInertia = 1e-4, kMostInertia = 2;

std::string unbalanced(const PackingCheck& check) {
  if (!(check.unbalanced_force_ratio > kUnbalanced)) return "";
  const bool along = check.loaded_pairs >= kFewPairs && check.pairs_along == check.loaded_pairs;
  return fmt::format(
      "unbalanced force ratio {:.3g}, above {:g}: not at rest, or contacts with walls or gravity "
      "are missing{}",
      check.unbalanced_force_ratio, kUnbalanced,
      along ? "; the forces between grains have no tangential part: is it in other columns?" : "");
}

std::string unsupported(const PackingCheck& check) {
  const double off = std::fabs(check.support_ratio - 1);
  if (!(off > kSupport) && !(off > kClearSupport && off > kClearErrors * check.support_error)) {
    return "";
  }
  // Gravity against the force across it.
  const auto down = [&](Eigen::Index axis) {
    return 0 - 9.81 * std::round(check.across[axis] / check.across.norm());
  };
  const char* why = "gravity or masses are too small, or contacts stand there twice";
  if (check.support_ratio < 1) {
    why =
        "contacts with the floor are missing (a wall: --wall, a table of walls; grains of the "
        "floor: --fixed)";
  }
  if (check.support_ratio < 0) {
    why = "gravity points the other way (--gravity), or the forces from below do";
  } else if (check.across.norm() > (1 - kSupport) * check.weight) {
    return fmt::format(
        "walls and fixed grains carry {:.3g} of the weight along gravity and {:.3g} along ({:.2g}, "
        "{:.2g}, {:.2g}): is that upwards (--gravity {:g},{:g},{:g})?",
        check.support_ratio, check.across.norm() / check.weight, check.across.x() / check.weight,
        check.across.y() / check.weight, check.across.z() / check.weight, down(0), down(1),
        down(2));
  } else if (check.wall_contacts > 0 && check.support_ratio < kOtherUnits) {
    why =
        "contacts with the floor are missing, or forces, lengths and masses are not all in SI "
        "units "
        "(N, m, kg)";
  }
  const std::string error = off > kSupport ? "" : fmt::format(" ± {:.2g}", check.support_error);
  return fmt::format("walls and fixed grains carry {:.3g}{} of the weight: {}", check.support_ratio,
                     error, why);
}

// What of kAxesChanges is why contacts pull, and what it leaves; empty: none is.
std::string axes_remedy(const PackingCheck& check) {
  const auto most = std::max_element(check.pushing_changed.begin(), check.pushing_changed.end());
  const int left = check.bearing - *most;
  if (kExplains * left > check.pulling || left >= check.bearing - check.pulling) return "";
  const auto k = static_cast<std::size_t>(most - check.pushing_changed.begin());
  return fmt::format("{}, which leaves {} that pull", kAxesChanges[k].text,
                     check.pulling_changed[k]);
}

// Whether the forces between grains alone, or those with walls alone, have the other sign.
bool pull_together(int pulling, int bearing) {
  return pulling > 0 && pulling >= kMostPull * bearing;
}
bool push_together(int pulling, int bearing) { return pulling <= (1 - kMostPull) * bearing; }

std::string turned_pairs_or_walls(const PackingCheck& check) {
  const int pairs = check.bearing - check.bearing_walls;
  const int pulling_pairs = check.pulling - check.pulling_walls;
  const bool of_pairs = pull_together(pulling_pairs, pairs) &&
                        push_together(check.pulling_walls, check.bearing_walls);
  const bool of_walls = pull_together(check.pulling_walls, check.bearing_walls) &&
                        push_together(pulling_pairs, pairs);
  if (of_pairs == of_walls || check.bearing_walls == 0 || pairs == 0 || !axes_remedy(check).empty())
    return "";
  return fmt::format(
      "{} of {} contacts {} pull, {} of {} {} push: forces count on grain i, by j or the wall; "
      "turn the sign of those {} alone (import --flip-forces={}) unless they stick",
      of_pairs ? pulling_pairs : check.pulling_walls, of_pairs ? pairs : check.bearing_walls,
      of_pairs ? "between grains" : "with walls",
      of_pairs ? check.bearing_walls - check.pulling_walls : pairs - pulling_pairs,
      of_pairs ? check.bearing_walls : pairs, of_pairs ? "with walls" : "between grains",
      of_pairs ? "between grains" : "with walls", of_pairs ? "pairs" : "walls");
}

// Where friction is unknown: places, ids and axes that do not belong to the forces.
std::string steep_forces(const PackingCheck& check) {
  if (check.steep < kFewSteep || !(check.steep > kManySteep * check.unknown_friction)) return "";
  return fmt::format(
      "{} of {} contacts between grains bear more tangential than normal force (friction above 1): "
      "do ids, axes and signs of forces fit the places?",
      check.steep, check.unknown_friction);
}

std::string pulling(const PackingCheck& check) {
  if (std::string text = turned_pairs_or_walls(check); !text.empty()) return text;
  if (!(check.pulling > kManyPull * check.bearing)) return "";
  const std::string axes = axes_remedy(check);
  return fmt::format(
      "{} of {} contacts ({:.0f} %) pull, their normal force is tension: {}", check.pulling,
      check.bearing, 100.0 * check.pulling / check.bearing,
      !axes.empty() ? axes
      : !steep_forces(check).empty()
          ? "do ids, axes and signs of forces fit the places, or do the grains stick together?"
          : "turn the sign of their forces, unless the grains stick together (cohesion, liquid "
            "bridges)");
}

std::string off_walls(const PackingCheck& check) {
  if (check.off_wall_contacts == 0) return "";
  return fmt::format(
      "{} of {} contacts with walls are more than two radii off their wall: is it where it says?",
      check.off_wall_contacts, check.wall_contacts);
}

std::string odd_normals(const PackingCheck& check) {
  if (check.odd_normals == 0) return "";
  return fmt::format(
      "{} of {} contacts between round grains have a normal more than 60 degrees off the line of "
      "centres (the first: {} and {}); it points from i to j",
      check.odd_normals, check.round_pairs, check.odd_i, check.odd_j);
}

std::string turned_normals(const PackingCheck& check) {
  if (check.turned_normals == 0) return "";
  return fmt::format(
      "{} of {} contacts of polygons have a normal more than 90 degrees off the line of centres "
      "(the first: {} and {}); it points from i to j",
      check.turned_normals, check.polygon_pairs, check.turned_i, check.turned_j);
}

std::string beyond_friction(const PackingCheck& check) {
  if (check.beyond_friction == 0) return "";
  return fmt::format(
      "{} of {} contacts of known friction bear a tangential force beyond friction times normal "
      "force and are not marked as sliding",
      check.beyond_friction, check.known_friction);
}

// One of each kind; empty: none.
std::vector<std::string> warning_texts(const PackingCheck& check) {
  return {unbalanced(check),  unsupported(check),    pulling(check),         off_walls(check),
          odd_normals(check), turned_normals(check), beyond_friction(check), steep_forces(check)};
}

}  // namespace

GrainSizes grain_sizes(const dem::Snapshot& packing) {
  double mass = 0, volume = 0, spheres = 0, diameters = 0;
  int count = 0;
  const auto free = [](const dem::Grain& grain) { return !grain.fixed; };
  const bool any = std::any_of(packing.grains.begin(), packing.grains.end(), free);
  for (const dem::Grain& grain : packing.grains) {
    // Where all are fixed they are what there is.
    if (any && grain.fixed) continue;
    mass += grain.mass;
    volume += grain.volume;
    spheres += 4.0 / 3 * std::numbers::pi * std::pow(grain.radius, 3);
    diameters += 2 * grain.radius;
    ++count;
  }
  if (count == 0) return {kNan, kNan, kNan};
  return {mass / volume, mass / spheres, any ? mean_diameter(packing) : diameters / count};
}

std::string tension_in(const PackingCheck& check) {
  if (std::string text = turned_pairs_or_walls(check); !text.empty()) return text;
  const double along = check.pairs_along_gravity + check.walls_along_gravity;
  // Without gravity, or across it, the mean stress tells.
  const double mean = check.pairs.trace() + check.walls.trace();
  if (!(along > 0) && !(mean > 0)) return "";
  const bool by_gravity = along > 0;
  const std::string remedy = "forces count on grain i, by j; turn their sign";
  if (const std::string axes = axes_remedy(check); !axes.empty())
    return fmt::format(
        "the contacts pull: the stress{} is tension ({:.3g} N m over all contacts, compression is "
        "negative), {} of {} contacts pull; {}",
        by_gravity ? " along gravity" : "", by_gravity ? along : mean, check.pulling, check.bearing,
        axes);
  if (by_gravity && check.walls_along_gravity < 0)
    return fmt::format(
        "contacts between grains pull (stress along gravity is tension, {:.3g} N m), those with "
        "walls push: {} in the table of the pairs",
        check.pairs_along_gravity, remedy);
  if (by_gravity)
    return fmt::format(
        "the contacts pull: stress along gravity is tension ({:.3g} N m over all contacts, "
        "compression is negative); {} (import --flip-forces)",
        along, remedy);
  return fmt::format(
      "the contacts pull: the mean stress is tension (its trace {:.3g} N m over all contacts, "
      "compression is negative); {} (import --flip-forces) unless the grains stick together",
      mean, remedy);
}

std::vector<std::string> warnings_of(const PackingCheck& check) {
  std::vector<std::string> out;
  for (std::string& text : warning_texts(check)) {
    if (!text.empty()) out.push_back(std::move(text));
  }
  return out;
}

// Mean over the free grains that have one of their moment of inertia over mass and radius squared.
double relative_inertia(const dem::Snapshot& packing) {
  double sum = 0;
  int count = 0;
  for (const dem::Grain& g : packing.grains) {
    const double disk = g.mass * g.radius * g.radius;
    if (g.fixed || !(g.inertia > 0) || !(disk > 0)) continue;
    sum += g.inertia / disk;
    ++count;
  }
  return count > 0 ? sum / count : kNan;
}

std::string strange_units(const dem::Snapshot& packing) {
  const GrainSizes sizes = grain_sizes(packing);
  const char* unit = packing.dim == 2 ? "kg/m2" : "kg/m3";
  const auto strange = [](double density) {
    return density < kLeastDensity || density > kMostDensity;
  };
  // In the plane a mass may be that of spheres, as LAMMPS has it.
  if (strange(sizes.density) && !(packing.dim == 2 && !strange(sizes.density_as_spheres))) {
    return fmt::format(
        "mean density {:.3g} {}, where grains have {:g} to {:g}: are the file's units SI "
        "(import --units)?",
        sizes.density, unit, kLeastDensity, kMostDensity);
  }
  if (sizes.diameter < kLeastDiameter || sizes.diameter > kMostDiameter) {
    return fmt::format(
        "mean diameter {:.3g} m, where grains have {:g} to {:g}: are the file's "
        "units SI (import --units)?",
        sizes.diameter, kLeastDiameter, kMostDiameter);
  }
  const double inertia = relative_inertia(packing);
  if (inertia < kLeastInertia || inertia > kMostInertia) {
    return fmt::format(
        "moments of inertia are {:.3g} times mass and radius squared in the mean, where grains "
        "have {:g} to {:g}: are they in kg m2, whatever the unit of lengths?",
        inertia, kLeastInertia, kMostInertia);
  }
  return "";
}

void PackingWarnings::add(std::size_t kind, const std::string& packing, const std::string& text) {
  if (text.empty()) return;
  Entry& entry = entries_[kind];
  if (entry.first.empty()) {
    entry.first = packing + ": " + text;
  } else {
    ++entry.others;
  }
}

void PackingWarnings::add(const std::string& packing, const PackingCheck& check) {
  std::size_t kind = 0;
  for (const std::string& text : warning_texts(check)) {
    add(kind++, packing, text);
  }
}

std::vector<std::string> PackingWarnings::lines(const std::string& noun) const {
  std::vector<std::string> out;
  for (const auto& [kind, entry] : entries_) {
    out.push_back(entry.first);
    if (entry.others > 0) {
      out.back() +=
          fmt::format(" (likewise {} {}{})", entry.others, noun, entry.others == 1 ? "" : "s");
    }
  }
  return out;
}

}  // namespace grainfield::coupling
