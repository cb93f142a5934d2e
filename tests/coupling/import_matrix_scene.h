// Packings as the files of every program that the import reads, with the habits that such files
// have.
#pragma once
#include <string>
#include <vector>

#include "coupling/import/import.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::test {

/// Two states of one packing: the second has moved, in periodic cells by more than half the cell.
/// Places of `before` lie in the cell; those of `after` are not carried back, its images are 0.
struct Motion {
  std::string name;
  dem::Snapshot before, after;
};
std::vector<Motion> motions();

enum class Dialect { csv, semicolons, tabs, numpy, lammps, liggghts, yade, mercury, vtk, vtp };
const std::vector<Dialect>& dialects();
std::string name_of(Dialect dialect);

enum class Habit {
  plain,
  crlf,
  carriage_returns,
  byte_order_mark,
  utf16,
  blank_lines,
  shuffled,
  quoted,
  titled,
  unit_row,
  trailing,
  comments,
  ids_beyond_million,
  ids_beyond_40_bits,
  step_twice,
  both_directions,
  no_force_pairs,
  unwrapped,
  scaled,
  image_flags,
  units,
  gzip,
  bzip2,
  xz,
  zstd,
  six_digits,
  rounded_ids,
  wall_first,
  other_names,
  copies,
  flipped
};
const std::vector<Habit>& habits();
std::string name_of(Habit habit);

/// Whether files of this kind exist: superfluous combinations are left out.
bool exists(Dialect dialect, Habit habit, const Motion& motion);

/// The files' contents by their names, and what the user says beside them.
struct Written {
  std::vector<std::pair<std::string, std::string>> files;  ///< of the state
  coupling::ImportOptions options;
};
Written write_as(Dialect dialect, Habit habit, const Motion& motion, bool after);

}  // namespace grainfield::test
