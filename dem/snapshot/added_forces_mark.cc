#include "dem/snapshot/added_forces_mark.h"

#include <fmt/format.h>

#include <stdexcept>

namespace grainfield::dem {
namespace {

std::string names_in(const Snapshot& snapshot, const char* attribute) {
  const auto at = snapshot.attributes.find(attribute);
  return at == snapshot.attributes.end() ? "" : at->second;
}

}  // namespace

std::string added_forces_note(const std::string& now, const std::string& before) {
  if (!now.empty()) {
    return fmt::format("forces of a Python function act on these grains: {}{}", now,
                       before.empty() ? "" : fmt::format("; acted before: {}", before));
  }
  if (before.empty()) return "";
  return fmt::format("forces of a Python function acted here before: {}", before);
}

std::string added_forces_note(const Snapshot& snapshot) {
  return added_forces_note(names_in(snapshot, kAddedForces),
                           names_in(snapshot, kFormerAddedForces));
}

void refuse_added_forces(const Snapshot& snapshot, const std::string& where) {
  const std::string names = names_in(snapshot, kAddedForces);
  if (names.empty()) return;
  throw std::invalid_argument(
      fmt::format("{}: forces of a Python function act on these grains: found \"{}\", allowed: "
                  "none; go on in Python with gf.Engine and add_force",
                  where, names));
}

}  // namespace grainfield::dem
