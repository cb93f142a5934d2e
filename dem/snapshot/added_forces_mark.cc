#include "dem/snapshot/added_forces_mark.h"

#include <fmt/format.h>

#include <stdexcept>

namespace grainfield::dem {
namespace {

using Attributes = std::map<std::string, std::string>;

std::string names_in(const Attributes& attributes, const char* attribute) {
  const auto at = attributes.find(attribute);
  return at == attributes.end() ? "" : at->second;
}

}  // namespace

std::string added_forces_note(const Attributes& attributes) {
  const std::string now = names_in(attributes, kAddedForces),
                    before = names_in(attributes, kFormerAddedForces);
  if (!now.empty()) {
    return fmt::format("forces of a Python function act on these grains: {}{}", now,
                       before.empty() ? "" : fmt::format("; acted before: {}", before));
  }
  if (!before.empty())
    return fmt::format("forces of a Python function acted here before: {}", before);
  return "";
}

void copy_added_forces(const Attributes& from, Attributes& to) {
  for (const char* name : {kAddedForces, kFormerAddedForces}) {
    const std::string names = names_in(from, name);
    if (!names.empty()) to.try_emplace(name, names);
  }
}

void refuse_added_forces(const Snapshot& snapshot, const std::string& where) {
  const std::string names = names_in(snapshot.attributes, kAddedForces);
  if (names.empty()) return;
  throw std::invalid_argument(
      fmt::format("{}: forces of a Python function act on these grains: found \"{}\", allowed: "
                  "none; go on in Python with gf.Engine and add_force",
                  where, names));
}

}  // namespace grainfield::dem
