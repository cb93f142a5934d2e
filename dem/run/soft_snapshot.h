// What the snapshots of soft disks under implicit motion share.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "dem/implicit/soft_disks.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// Disks with ids by their order; `angles`: since the start, rad.
std::vector<Grain> grains_of(const std::vector<Body<2>>& bodies, const std::vector<double>& angles);

/// The contact's forces at rest, without dashpots; its friction is left 0.
Contact contact_of(const SoftTouch& touch, const std::vector<Grain>& grains);

/// The table `name` of the snapshot: a row a record, of pure numbers.
template <std::size_t n, class Records>
void keep_columns(const std::string& name, const char* const (&columns)[n], const Records& records,
                  Snapshot& to) {
  NumberTable& table = to.tables[name];
  for (std::size_t c = 0; c < n; ++c) {
    table.push_back({columns[c], "1", {}});
    for (const auto& r : records) table.back().values.push_back(r[c]);
  }
}

}  // namespace grainfield::dem
