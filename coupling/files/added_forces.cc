#include "coupling/files/added_forces.h"

#include <map>

#include "dem/snapshot/added_forces_mark.h"

namespace grainfield::coupling {

void copy_added_forces(const dem::Snapshot& from, Attributes& to) {
  std::map<std::string, std::string> names;
  dem::copy_added_forces(from.attributes, names);
  to.insert(names.begin(), names.end());
}

std::string added_forces_note(const Field& field) {
  std::map<std::string, std::string> names;
  for (const char* name : {dem::kAddedForces, dem::kFormerAddedForces}) {
    names.emplace(name, field.word(name));
  }
  return dem::added_forces_note(names);
}

}  // namespace grainfield::coupling
