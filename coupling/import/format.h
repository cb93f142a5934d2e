// A foreign format: how its tables are found and what its columns are called. A new format is one
// file with a function that returns this, and one line in formats.cc.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupling/import/table.h"

namespace grainfield::coupling {

struct ImportFormat {
  std::string name, summary;
  /// Finds the tables of a file without keeping their rows. Throws std::invalid_argument naming
  /// file and line.
  std::vector<ForeignTable> (*scan)(const std::string& file, ColumnNames& names);
  /// Our columns under their names, (ours, theirs); several for one of ours: the first found
  /// counts.
  std::vector<std::pair<std::string, std::string>> columns;
  double force_sign = 1;  ///< times the file's force of a contact = force on grain i
  /// The ids are the numbers of the rows, from 0.
  bool rows_are_ids = false;
  /// Steps have a time and no number: they are counted from 0 in the order of their times.
  bool steps_by_time = false;
  /// Steps are told by the files' names.
  bool steps_by_name = false;
  /// Normal and tangential directions are turned together (MercuryDPM: those of walls are).
  bool directions_turn_together = false;
  /// A density, of a column or told, is that of spheres, in the plane, too.
  bool densities_of_spheres = false;
  /// Copies across periodic sides have numbers of their own; a column overlap tells their centres.
  bool copies_have_numbers = false;
};

/// Every format, in the order of the documentation.
const std::vector<ImportFormat>& import_formats();
/// Throws std::invalid_argument with the nearest name and all names.
const ImportFormat& find_import_format(const std::string& name);

ImportFormat lammps_format();
ImportFormat liggghts_format();
ImportFormat yade_format();
ImportFormat csv_format();
ImportFormat mercury_format();
ImportFormat vtk_format();

/// Names of columns and units that a CSV file's head is known by, beside those of import.
struct HeadWords {
  std::vector<std::string> names, units;
};
/// The table of a CSV file, with the units of a row of units behind its names.
ForeignTable scan_csv(const std::string& file, HeadWords&& known = {});

/// Tables of a file of extended XYZ, one a state; nothing for any other file. Throws
/// std::invalid_argument naming file and line.
std::optional<std::vector<ForeignTable>> scan_xyz(const std::string& file);

/// Tables of a LAMMPS or LIGGGHTS dump file.
std::vector<ForeignTable> scan_dump(const std::string& file, ColumnNames&);
/// What both call the columns of a grain, and after them these of a contact: (ours, theirs).
std::vector<std::pair<std::string, std::string>> dump_columns(
    const std::vector<std::pair<std::string, std::string>>& contact);

}  // namespace grainfield::coupling
