// Ids of the grains of a packing in LAMMPS.
#pragma once
#include <cstdint>
#include <string>
#include <unordered_map>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// The grains' ids where LAMMPS can have them all, 1 to 2^31 - 1 (its default build); one more
/// where they begin with 0; else their places in the packing, from 1.
class LammpsIds {
 public:
  explicit LammpsIds(const dem::Snapshot& packing);

  bool kept() const { return kept_; }
  /// The id of a grain in LAMMPS. Throws std::out_of_range for an id that the packing does not
  /// have.
  std::int64_t of(std::int64_t id) const { return ids_.at(id); }
  /// Says how ids are changed and how they come back. For `copied` packings they do not.
  std::string note(bool copied) const;
  /// A table id,original: LAMMPS' and the packing's.
  std::string csv(const dem::Snapshot& packing) const;

 private:
  bool kept_ = true;
  bool shifted_ = false;
  std::unordered_map<std::int64_t, std::int64_t> ids_;
};

}  // namespace grainfield::coupling
