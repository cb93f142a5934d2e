// VTK: points with a radius each (.vtk, .vtp, .vtu), and lines with the forces of contacts. What
// LIGGGHTS, MFiX and ParaView write. Arrays have names of their own: our columns by any of the
// names that other programs have for them.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "coupling/import/foreign_kind.h"
#include "coupling/import/format.h"
#include "coupling/import/text_source.h"
#include "coupling/import/told_units.h"
#include "coupling/import/vtk_arrays.h"

namespace grainfield::coupling {
namespace {

// Throws for what `export --to vtu` writes for the eye: outlines of grains, lines between centres
// whose walls are numbers, bands of force chains.
void refuse_pictures(const std::string& file, const VtkData& data) {
  const auto has = [&](const char* name) {
    const auto is_it = [&](const VtkArray& array) { return array.name == name; };
    return std::any_of(data.of_cells.begin(), data.of_cells.end(), is_it) ||
           std::any_of(data.of_points.begin(), data.of_points.end(), is_it);
  };
  const bool outlines = has("coordination") && has("radius") && data.vertices.empty();
  const bool contacts = has("i") && has("j") && has("wall") && has("sliding");
  const bool chains = has("chain") && has("relative_force");
  if (!outlines && !contacts && !chains) return;
  throw std::invalid_argument(fmt::format(
      "{}: found {} as grainfield export writes them for ParaView, allowed: points with a radius "
      "and lines with forces; FILE.h5 of the packing needs no import, and its tables, export --to "
      "csv, can be imported",
      file,
      outlines   ? "outlines of grains"
      : contacts ? "contacts"
                 : "force chains"));
}

std::vector<ForeignTable> scan(const std::string& file, ColumnNames& names) {
  const std::string bytes = TextSource::all_bytes(file);
  const bool legacy = bytes.starts_with("# vtk");
  if (!legacy && bytes.substr(0, 512).find("<VTKFile") == std::string::npos) {
    std::string found = bytes.substr(0, std::min<std::size_t>(bytes.find('\n'), 40));
    if (std::any_of(found.begin(), found.end(), [](unsigned char c) { return c < ' '; }))
      found = "(no text)";
    const std::string kind = foreign_kind(found, "vtk");
    throw std::invalid_argument(
        fmt::format("{}:1: found \"{}\", expected \"# vtk DataFile\" or \"<VTKFile\"{}", file,
                    found, kind.empty() ? "" : "; this is " + kind));
  }
  const VtkData data = legacy ? read_legacy_vtk(file, bytes) : read_xml_vtk(file, bytes);
  refuse_pictures(file, data);
  std::vector<ForeignTable> tables = vtk_tables(file, data, names);
  for (ForeignTable& table : tables) table.time = data.time;
  // The second line of a legacy file is a title.
  const std::size_t title = bytes.find('\n') + 1;
  if (legacy && title > 0)
    for (ForeignTable& table : tables)
      table.unit_remark = unit_remark(
          file, 2,
          bytes.substr(title, std::min<std::size_t>(bytes.find('\n', title) - title, 256)));
  return tables;
}

}  // namespace

ImportFormat vtk_format() {
  ImportFormat format;
  format.name = "vtk";
  format.summary = "points with a radius (.vtk, .vtp, .vtu), lines with forces";
  format.scan = scan;
  format.steps_by_name = true;
  for (const TableKind kind : {TableKind::grains, TableKind::contacts, TableKind::walls})
    for (const OurColumn& column : our_columns(kind))
      format.columns.emplace_back(column.name, column.name);
  return format;
}

}  // namespace grainfield::coupling
