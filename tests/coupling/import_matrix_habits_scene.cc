// Dialects and habits of the matrix, and which of their combinations exist.
#include "import_matrix_rows.h"

namespace grainfield::test {

const std::vector<Dialect>& dialects() {
  static const std::vector<Dialect> all{
      Dialect::csv,      Dialect::semicolons, Dialect::tabs,    Dialect::numpy, Dialect::lammps,
      Dialect::liggghts, Dialect::yade,       Dialect::mercury, Dialect::vtk,   Dialect::vtp};
  return all;
}

std::string name_of(Dialect dialect) {
  static const char* const names[] = {"csv",      "semicolons", "tabs",    "numpy", "lammps",
                                      "liggghts", "yade",       "mercury", "vtk",   "vtp"};
  return names[static_cast<int>(dialect)];
}

const std::vector<Habit>& habits() {
  static const std::vector<Habit> all = [] {
    std::vector<Habit> out;
    for (int k = 0; k <= static_cast<int>(Habit::flipped); ++k) out.push_back(Habit(k));
    return out;
  }();
  return all;
}

std::string name_of(Habit habit) {
  static const char* const names[] = {"plain",
                                      "crlf",
                                      "carriage returns",
                                      "byte order mark",
                                      "utf16",
                                      "blank lines",
                                      "shuffled",
                                      "quoted",
                                      "titled",
                                      "unit row",
                                      "trailing",
                                      "comments",
                                      "ids beyond million",
                                      "ids beyond 40 bits",
                                      "step twice",
                                      "both directions",
                                      "no force pairs",
                                      "unwrapped",
                                      "scaled",
                                      "image flags",
                                      "units",
                                      "gzip",
                                      "bzip2",
                                      "xz",
                                      "zstd",
                                      "six digits",
                                      "rounded ids",
                                      "wall first",
                                      "other names",
                                      "copies",
                                      "flipped"};
  return names[static_cast<int>(habit)];
}

bool exists(Dialect d, Habit h, const Motion& m) {
  const bool periodic = m.before.cell.is_periodic();
  const bool tilted = periodic && !m.before.cell.edges.isDiagonal(0);
  const bool polygons = has_polygons(m.before);
  if (polygons && !(d == Dialect::csv || d == Dialect::tabs || d == Dialect::semicolons))
    return false;
  // A cell that is tilted stands in dumps alone.
  if (tilted && !is_dump(d)) return false;
  if (d == Dialect::liggghts && tilted) return false;
  switch (h) {
    case Habit::utf16:
    case Habit::carriage_returns:
    case Habit::gzip:
    case Habit::bzip2:
    case Habit::xz:
    case Habit::zstd:
    case Habit::byte_order_mark:
      return !is_vtk(d);
    case Habit::blank_lines:
    case Habit::crlf:
      return d != Dialect::vtp;
    case Habit::shuffled:
      return d != Dialect::mercury;
    case Habit::quoted:
      return d == Dialect::csv || d == Dialect::semicolons || d == Dialect::tabs;
    case Habit::titled:
    case Habit::trailing:
    case Habit::unit_row:
      return d == Dialect::csv || d == Dialect::semicolons || d == Dialect::tabs;
    case Habit::comments:
      return is_table(d) || d == Dialect::yade;
    case Habit::ids_beyond_million:
    case Habit::ids_beyond_40_bits:
      return d != Dialect::mercury;
    case Habit::rounded_ids:
      return is_dump(d) || d == Dialect::csv;
    case Habit::step_twice:
      return is_dump(d);
    case Habit::unwrapped:
      return periodic && d != Dialect::mercury;
    case Habit::image_flags:
      return periodic && d != Dialect::mercury;
    case Habit::scaled:
      return is_dump(d);
    case Habit::wall_first:
      return !m.before.walls.empty() && !is_dump(d) && d != Dialect::mercury;
    case Habit::other_names:
      return is_table(d) || is_vtk(d);
    case Habit::units:
      return d != Dialect::mercury && !polygons;
    case Habit::six_digits:
      return !polygons;
    case Habit::both_directions:
      return d != Dialect::mercury;  // always so there
    case Habit::copies:
      return d == Dialect::mercury && periodic;
    default:
      return true;
  }
}

}  // namespace grainfield::test
