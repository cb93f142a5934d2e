#include "coupling/import/foreign_kind.h"

#include <initializer_list>

#include "coupling/import/lines.h"

namespace grainfield::coupling {

std::string foreign_kind(std::string_view line, std::string_view format) {
  struct Beginning {
    std::string_view text, format, what;
  };
  line = trimmed(line);
  // A sign of comments belongs to the formats that begin with one.
  std::string_view behind = line;
  if (behind.starts_with('#')) behind = trimmed(behind.substr(1));
  const bool comment = behind.size() < line.size();
  for (const Beginning& other : std::initializer_list<Beginning>{
           {"ITEM:", "dump", "a dump of LAMMPS or LIGGGHTS: --from lammps, --from liggghts"},
           {"LAMMPS data file", "",
            "a data file: read_data and a dump custom (id x y z radius mass) write what is read"},
           {"creator:", "", "a dump of style yaml: write one of style custom or local"},
           {"<?xml", "vtk", "a file of XML: --from vtk reads those of VTK"},
           {"<VTKFile", "vtk", "a file of VTK: --from vtk"},
           {"<html", "", "a page of HTML: save the table as CSV"},
           {"<!DOCTYPE", "", "a page of HTML: save the table as CSV"},
           {"{", "", "JSON: write the tables as CSV"},
           {"[", "", "JSON: write the tables as CSV"}}) {
    if (comment || format == other.format || !line.starts_with(other.text)) continue;
    // "[mm]" may begin a line of units.
    if (other.text.size() == 1 && line.find_first_of("])", 1) != std::string_view::npos) continue;
    return std::string(other.what);
  }
  if (line == "---") return "a dump of style yaml: write one of style custom or local";
  if (comment && behind.starts_with("vtk DataFile") && format != "vtk")
    return "a file of VTK: --from vtk";
  if (comment && behind.starts_with("format ") && format != "yade")
    return "text of YADE: --from yade";
  return "";
}

}  // namespace grainfield::coupling
