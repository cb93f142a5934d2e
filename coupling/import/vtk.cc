// VTK: points with a radius each (.vtk, .vtp, .vtu), and lines with the forces of contacts. What
// LIGGGHTS, MFiX and ParaView write. Arrays have names of their own: our columns by any of the
// names that other programs have for them.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "coupling/import/format.h"
#include "coupling/import/synonyms.h"
#include "coupling/import/vtk_arrays.h"
#include "coupling/system/read_input.h"
#include "dem/snapshot/number.h"

namespace grainfield::coupling {
namespace {

// Columns of arrays, one for each component.
class Columns {
 public:
  void add(const VtkArray& array) {
    for (std::size_t c = 0; c < array.components; ++c) {
      ArrayColumn column;
      for (std::size_t k = c; k < array.numbers.size(); k += array.components)
        column.numbers.push_back(array.numbers[k]);
      for (std::size_t k = c; k < array.whole.size(); k += array.components)
        column.whole.push_back(array.whole[k]);
      add(array.components == 1 ? array.name : fmt::format("{}[{}]", array.name, c),
          std::move(column));
    }
  }
  void add(const std::string& name, ArrayColumn&& column) {
    names_.push_back(name);
    columns_.push_back(std::move(column));
  }
  bool has(const std::string& ours) const {
    return std::any_of(names_.begin(), names_.end(), [&](const std::string& name) {
      const auto& sure = synonyms_of(ours).sure;
      const std::string plain = plain_column_name(name);
      return plain == ours || std::find(sure.begin(), sure.end(), plain) != sure.end();
    });
  }
  const ArrayColumn* find(const std::string& name) const {
    const auto at = std::find(names_.begin(), names_.end(), name);
    return at == names_.end() ? nullptr : &columns_[static_cast<std::size_t>(at - names_.begin())];
  }

  ForeignTable table(const std::string& file, TableKind kind, std::size_t rows) && {
    for (std::size_t k = 0; k < columns_.size(); ++k)
      if (columns_[k].rows() != rows)
        throw std::invalid_argument(fmt::format("{}: array {} has {} values, expected {}", file,
                                                names_[k], columns_[k].rows(), rows));
    ForeignTable out;
    out.file = file;
    out.kind = kind;
    out.rows = static_cast<long long>(rows);
    out.any_names = true;
    out.columns = std::make_shared<const std::vector<std::string>>(std::move(names_));
    out.arrays = std::make_shared<const std::vector<ArrayColumn>>(std::move(columns_));
    return out;
  }

 private:
  std::vector<std::string> names_;
  std::vector<ArrayColumn> columns_;
};

// Ids of the ends of a line: those of the points, or their numbers.
void add_ends(const VtkData& data, const Columns& points, Columns& contacts) {
  const ArrayColumn* ids = points.find("id");
  for (std::size_t end = 0; end < 2; ++end) {
    ArrayColumn column;
    for (const auto& line : data.lines) {
      const std::int64_t point = line[end];
      const bool known =
          ids != nullptr && point >= 0 && static_cast<std::size_t>(point) < ids->whole.size();
      column.whole.push_back(known ? ids->whole[static_cast<std::size_t>(point)] : point);
    }
    contacts.add(end == 0 ? "i" : "j", std::move(column));
  }
}

// "dump100.vtk" -> 100
std::optional<long long> step_of(const std::string& file) {
  const std::size_t slash = file.rfind('/');
  std::string name = file.substr(slash == std::string::npos ? 0 : slash + 1);
  name = name.substr(0, name.rfind('.'));
  std::size_t end = name.size();
  while (end > 0 && std::isdigit(static_cast<unsigned char>(name[end - 1])) == 0) --end;
  std::size_t begin = end;
  while (begin > 0 && std::isdigit(static_cast<unsigned char>(name[begin - 1])) != 0) --begin;
  if (begin == end || end - begin > 18) return std::nullopt;
  return dem::parse_integer(std::string_view(name).substr(begin, end - begin));
}

std::vector<ForeignTable> scan(const std::string& file) {
  require_regular_file(file, "a file of VTK");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::invalid_argument(file + ": cannot be read");
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  const bool legacy = bytes.starts_with("# vtk");
  if (!legacy && bytes.substr(0, 512).find("<VTKFile") == std::string::npos)
    throw std::invalid_argument(
        fmt::format("{}:1: found \"{}\", expected \"# vtk DataFile\" or \"<VTKFile\"", file,
                    bytes.substr(0, std::min<std::size_t>(bytes.find('\n'), 40))));
  const VtkData data = legacy ? read_legacy_vtk(file, bytes) : read_xml_vtk(file, bytes);

  Columns points;
  const char* axes[] = {"x", "y", "z"};
  for (std::size_t a = 0; a < 3; ++a) {
    ArrayColumn column;
    for (std::size_t k = a; k < data.points.numbers.size(); k += 3)
      column.numbers.push_back(data.points.numbers[k]);
    points.add(axes[a], std::move(column));
  }
  for (const VtkArray& array : data.of_points) points.add(array);
  Columns contacts;
  for (const VtkArray& array : data.of_cells) contacts.add(array);
  const bool sized = points.has("radius") || points.has("diameter");
  std::vector<ForeignTable> out;
  if (contacts.has("fx") || contacts.has("fnx")) {
    if (sized && !contacts.has("i")) add_ends(data, points, contacts);
    const std::size_t rows = data.of_cells.front().rows();
    out.push_back(std::move(contacts).table(file, TableKind::contacts, rows));
  }
  if (sized || out.empty())
    out.insert(out.begin(), std::move(points).table(file, TableKind::grains, data.points.rows()));
  for (ForeignTable& table : out) table.step = step_of(file);
  return out;
}

}  // namespace

ImportFormat vtk_format() {
  ImportFormat format;
  format.name = "vtk";
  format.summary = "points with a radius (.vtk, .vtp, .vtu), lines with forces";
  format.scan = scan;
  for (const TableKind kind : {TableKind::grains, TableKind::contacts, TableKind::walls})
    for (const OurColumn& column : our_columns(kind))
      format.columns.emplace_back(column.name, column.name);
  return format;
}

}  // namespace grainfield::coupling
