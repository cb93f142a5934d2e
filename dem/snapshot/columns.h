// The columns of a snapshot's tables. One list per table drives writing and reading; a new column
// is a member of Grain, Contact or Wall and one line in columns.cc.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// The newest layout that is written and read. Of the first one are the files of grainfield 1:
/// without the columns of 3D, cells, images, materials and walls other than planes at rest. What
/// needs none of these is still written as the first.
inline constexpr int kSnapshotFormat = 2;

/// Which files have a column. One that a file need not have takes the row's default there.
enum class Presence {
  always,
  in_3d,       ///< in 3D, from format 2 on
  where_used,  ///< where a row differs from the default
  derived      ///< likewise, in format 2 only: a file of the first one has it from the contacts
};

/// A member of a row and how it stands in a file. Texts are places in a list of names, the group's
/// attribute NAME_names, or -1 for "".
template <class Row>
struct Column {
  using Member = std::variant<double Row::*, std::int64_t Row::*, bool Row::*, Vec3 Row::*,
                              std::array<double, 2> Row::*, std::array<double, 4> Row::*,
                              std::array<int, 3> Row::*, std::string Row::*>;
  const char* name;
  const char* unit;
  const char* meaning;  ///< for docs/columns.md
  Member member;
  Presence presence = Presence::always;
  bool may_be_nan = false;  ///< a coefficient that other programs do not tell
};

/// Those of `dim`, in the order of the file.
std::vector<Column<Grain>> grain_columns(int dim);
const std::vector<Column<Contact>>& contact_columns();
const std::vector<Column<Wall>>& wall_columns();

}  // namespace grainfield::dem
