// Snapshots by the names that a user gives, and as they are read.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// A snapshot in a file; or one in memory, which file and group then only name.
struct SnapshotName {
  std::string file, group;
  std::shared_ptr<const dem::Snapshot> held{};
};

/// The snapshot, read or held, without pairs that bear no force across a gap; `idle` (may be null):
/// how many these are. Throws as dem::read_snapshot.
std::shared_ptr<const dem::Snapshot> snapshot_of(const SnapshotName& name,
                                                 std::size_t* idle = nullptr);

/// "FILE.h5" (every snapshot of the file), "FILE.h5:GROUP" or "FILE.h5:STATE", which is every
/// REALIZATION/STATE of a file without a group STATE. Throws std::invalid_argument, also
/// when one is named twice.
std::vector<SnapshotName> parse_snapshot_names(const std::vector<std::string>& texts);
/// Throws std::invalid_argument, "FILE:GROUP: named twice", for a snapshot of an ensemble that is
/// there more than once.
void require_each_once(const std::vector<SnapshotName>& names);

}  // namespace grainfield::coupling
