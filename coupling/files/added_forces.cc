#include "coupling/files/added_forces.h"

#include "dem/snapshot/added_forces_mark.h"

namespace grainfield::coupling {

void copy_added_forces(const dem::Snapshot& from, Attributes& to) {
  for (const char* name : {dem::kAddedForces, dem::kFormerAddedForces}) {
    const auto at = from.attributes.find(name);
    if (at != from.attributes.end()) to.try_emplace(name, at->second);
  }
}

std::string added_forces_note(const Field& field) {
  return dem::added_forces_note(field.word(dem::kAddedForces), field.word(dem::kFormerAddedForces));
}

}  // namespace grainfield::coupling
