// What the snapshots of soft disks under implicit motion share.
#pragma once
#include <fmt/format.h>

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

/// Attributes PREFIX:COLUMN with the column's values of all records, in one line.
template <std::size_t n, class Records>
void keep_columns(const std::string& prefix, const char* const (&columns)[n],
                  const Records& records, Snapshot& to) {
  for (std::size_t c = 0; c < n; ++c) {
    std::string text;
    for (const auto& r : records) text += fmt::format("{}{:.12g}", text.empty() ? "" : " ", r[c]);
    to.attributes[prefix + ":" + columns[c]] = text;
  }
}

}  // namespace grainfield::dem
