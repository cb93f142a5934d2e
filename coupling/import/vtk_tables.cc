// Which points and cells of a file of VTK are grains, and which are contacts.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <unordered_map>

#include "coupling/import/synonyms.h"
#include "coupling/import/vtk_arrays.h"

namespace grainfield::coupling {
namespace {

using Rows = std::vector<std::size_t>;

// "force" -> "force[0]", "force (kN)" -> "force[0] (kN)"
std::string component_name(const VtkArray& array, std::size_t component) {
  if (array.components == 1) return array.name;
  const Heading heading = heading_of(array.name, 0);
  const std::string name = fmt::format("{}[{}]", heading.name, component);
  return heading.unit.empty() ? name : fmt::format("{} ({})", name, heading.unit);
}

// Columns of arrays, one for each component.
class Columns {
 public:
  explicit Columns(const std::string& file) : file_(file) {}

  // The rows of `array`, in this order.
  void add(const VtkArray& array, const Rows& rows) {
    for (std::size_t c = 0; c < array.components; ++c) {
      ArrayColumn column;
      column.single = array.single;
      for (const std::size_t row : rows) {
        const std::size_t at = row * array.components + c;
        if (at < array.numbers.size())
          column.numbers.push_back(array.numbers[at]);
        else if (at < array.whole.size())
          column.whole.push_back(array.whole[at]);
        else
          throw std::invalid_argument(fmt::format("{}: array {} has {} values, expected {} or more",
                                                  file_, array.name, array.rows(), row + 1));
      }
      add(component_name(array, c), std::move(column));
    }
  }
  void add(const std::string& name, ArrayColumn&& column) {
    names_.push_back(name);
    columns_.push_back(std::move(column));
  }
  void add_numbers(const std::string& name, const Rows& numbers) {
    ArrayColumn column;
    column.whole.assign(numbers.begin(), numbers.end());
    add(name, std::move(column));
  }

  ForeignTable table(TableKind kind, std::size_t rows) const {
    for (std::size_t k = 0; k < columns_.size(); ++k)
      if (columns_[k].rows() != rows)
        throw std::invalid_argument(fmt::format("{}: array {} has {} values, expected {}", file_,
                                                names_[k], columns_[k].rows(), rows));
    ForeignTable out;
    out.file = file_;
    out.kind = kind;
    out.rows = static_cast<long long>(rows);
    out.any_names = true;
    out.columns = std::make_shared<const std::vector<std::string>>(names_);
    out.arrays = std::make_shared<const std::vector<ArrayColumn>>(columns_);
    return out;
  }

 private:
  const std::string& file_;
  std::vector<std::string> names_;
  std::vector<ArrayColumn> columns_;
};

Rows all_rows(std::size_t count) {
  Rows out(count);
  std::iota(out.begin(), out.end(), std::size_t{0});
  return out;
}

// Names of arrays, asked for ours as the user chooses and as other programs write them.
class Names {
 public:
  Names(const std::string& file, const std::vector<VtkArray>& arrays, ColumnNames& names) {
    std::vector<std::string> columns;
    for (const VtkArray& array : arrays)
      for (std::size_t c = 0; c < array.components; ++c)
        columns.push_back(component_name(array, c));
    table_.file = file;
    table_.any_names = true;
    table_.columns = std::make_shared<const std::vector<std::string>>(std::move(columns));
    found_.emplace(table_, names);
  }
  Names(const Names&) = delete;
  Names& operator=(const Names&) = delete;

  bool has(const char* ours) const { return found_->find(ours).index >= 0; }
  bool has_size() const { return has("radius") || has("diameter"); }
  bool has_force() const { return has("fx") || has("fnx") || has("fn"); }

 private:
  ForeignTable table_;
  std::optional<TableColumns> found_;
};

class Tables {
 public:
  Tables(const std::string& file, const VtkData& data, ColumnNames& names)
      : file_(file),
        data_(data),
        names_(names),
        points_(file, data.of_points, names),
        cells_(file, data.of_cells, names) {
    check(data.of_points, data.points.rows());
    if (!data.of_cells.empty()) check(data.of_cells, data.of_cells.front().rows());
  }

  std::vector<ForeignTable> all() {
    const bool sized = points_.has_size();
    if (!sized && points_.has("i") && points_.has("j")) return {contacts_at_points()};
    of_vertices_ = !sized && !data_.vertices.empty() && cells_.has_size();
    const bool contacts =
        !data_.of_cells.empty() && (!data_.lines.empty() || (cells_.has("i") && cells_.has("j")) ||
                                    (cells_.has_force() && !sized && !of_vertices_));
    std::vector<ForeignTable> out;
    if (contacts) out.push_back(contacts_of_cells(sized || of_vertices_ || points_.has("id")));
    if (sized || of_vertices_ || out.empty()) out.insert(out.begin(), grains());
    return out;
  }

 private:
  void check(const std::vector<VtkArray>& arrays, std::size_t rows) const {
    for (const VtkArray& array : arrays)
      if (array.rows() != rows)
        throw std::invalid_argument(fmt::format("{}: array {} has {} values, expected {}", file_,
                                                array.name, array.rows(), rows));
  }

  void add_places(const Rows& points, const std::array<const char*, 3>& names, Columns& out) const {
    for (std::size_t a = 0; a < 3; ++a) {
      VtkArray one;
      one.name = names[a];
      for (std::size_t k = a; k < data_.points.numbers.size(); k += 3)
        one.numbers.push_back(data_.points.numbers[k]);
      for (std::size_t k = a; k < data_.points.whole.size(); k += 3)
        one.whole.push_back(data_.points.whole[k]);
      out.add(one, points);
    }
  }

  // Points with the ids of two grains and a force: where the contacts are; of a line between the
  // grains both ends have them.
  ForeignTable contacts_at_points() const {
    Columns columns(file_);
    Rows rows;
    for (const VtkLine& line : data_.lines) rows.push_back(static_cast<std::size_t>(line.first));
    if (rows.empty()) {
      rows = all_rows(data_.points.rows());
      if (!points_.has("px")) add_places(rows, {"px", "py", "pz"}, columns);
    }
    for (const VtkArray& array : data_.of_points) columns.add(array, rows);
    return columns.table(TableKind::contacts, rows.size());
  }

  // Where the lines end: the centres of grains of another file, or anything else.
  void add_ends(Columns& out) const {
    Rows first, second;
    for (const VtkLine& line : data_.lines) {
      first.push_back(static_cast<std::size_t>(line.first));
      second.push_back(static_cast<std::size_t>(line.second));
    }
    if (first.empty() || cells_.has("x1")) return;
    add_places(first, {"x1", "y1", "z1"}, out);
    add_places(second, {"x2", "y2", "z2"}, out);
  }

  // The points of the grains, with the data of the cells that they are where these tell the size.
  Rows points_of_grains() const {
    if (!of_vertices_) return all_rows(data_.points.rows());
    Rows out;
    for (const VtkVertex& vertex : data_.vertices)
      out.push_back(static_cast<std::size_t>(vertex.point));
    return out;
  }

  ForeignTable grains() const {
    Columns columns(file_);
    const Rows points = points_of_grains();
    add_places(points, {"x", "y", "z"}, columns);
    for (const VtkArray& array : data_.of_points) columns.add(array, points);
    if (of_vertices_) {
      Rows rows;
      for (const VtkVertex& vertex : data_.vertices) rows.push_back(vertex.row);
      for (const VtkArray& array : data_.of_cells) columns.add(array, rows);
    }
    if (points_are_ids_) columns.add_numbers("id", points);
    return columns.table(TableKind::grains, points.size());
  }

  // Whether no array is one of ids, under any name.
  static bool has_no_ids(const ForeignTable& grains) {
    const std::vector<std::string>& sure = synonyms_of("id").sure;
    return std::none_of(grains.columns->begin(), grains.columns->end(), [&](const auto& name) {
      const std::string plain = plain_column_name(name);
      return plain == "id" || std::find(sure.begin(), sure.end(), plain) != sure.end();
    });
  }

  // Ids of the grains by the numbers of their points.
  std::unordered_map<std::int64_t, std::int64_t> ids() {
    const Rows points = points_of_grains();
    std::unordered_map<std::int64_t, std::int64_t> out;
    const ForeignTable table = grains();
    const TableColumns columns(table, names_);
    const ForeignColumn id = columns.find("id");
    if (!id && !has_no_ids(table)) columns.missing("id");
    points_are_ids_ = !id;
    TableReader().read(table, [&](const ForeignRow& row) {
      const auto point = static_cast<std::int64_t>(points[row.place]);
      out[point] = points_are_ids_ ? point : row.told_id(id).id;
    });
    return out;
  }

  ForeignTable contacts_of_cells(bool ends_are_grains) {
    Columns columns(file_);
    Rows rows;
    for (const VtkLine& line : data_.lines) rows.push_back(line.row);
    if (rows.empty()) rows = all_rows(data_.of_cells.front().rows());
    for (const VtkArray& array : data_.of_cells) columns.add(array, rows);
    if (!ends_are_grains || data_.lines.empty() || cells_.has("i") || cells_.has("j")) {
      add_ends(columns);
      return columns.table(TableKind::contacts, rows.size());
    }
    const auto ids_of_points = ids();
    const auto end_of = [&](std::int64_t point) {
      const auto at = ids_of_points.find(point);
      if (at != ids_of_points.end()) return at->second;
      throw std::invalid_argument(
          fmt::format("{}: a line ends at point {}, which is no grain", file_, point));
    };
    ArrayColumn first, second;
    for (const VtkLine& line : data_.lines) {
      first.whole.push_back(end_of(line.first));
      second.whole.push_back(end_of(line.second));
    }
    columns.add("i", std::move(first));
    columns.add("j", std::move(second));
    return columns.table(TableKind::contacts, rows.size());
  }

  const std::string& file_;
  const VtkData& data_;
  ColumnNames& names_;
  Names points_, cells_;
  bool of_vertices_ = false;     // grains are vertices, whose cell data tell their size
  bool points_are_ids_ = false;  // lines name the grains, and no array does
};

}  // namespace

std::vector<ForeignTable> vtk_tables(const std::string& file, const VtkData& data,
                                     ColumnNames& names) {
  return Tables(file, data, names).all();
}

}  // namespace grainfield::coupling
