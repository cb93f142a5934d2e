#include "coupling/import/row_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace grainfield::coupling {

RowKeys row_keys(const ForeignTable& table, TableKind kind, ColumnNames& names,
                 TableReader& reader) {
  RowKeys out;
  if (!table.broken.empty()) return out;
  try {
    const TableColumns columns(table, names);
    const bool grains = kind == TableKind::grains;
    const ForeignColumn i = columns.find(grains ? "id" : "i");
    const ForeignColumn j = grains ? ForeignColumn{} : columns.find("j");
    const ForeignColumn wall = grains ? ForeignColumn{} : columns.find("wall");
    if (i.index < 0 || (!grains && j.index < 0 && wall.index < 0)) return out;
    reader.read(table, [&](const ForeignRow& row) {
      std::string first(row.text(i));
      if (!grains) {
        std::string second;
        if (wall.index >= 0 && !row.empty(wall))
          second = "wall " + std::string(row.text(wall));
        else if (j.index >= 0)
          second = std::string(row.text(j));
        if (second < first) std::swap(first, second);
        first += ' ' + second;
      }
      out.push_back(std::move(first));
    });
  } catch (const std::invalid_argument&) {
    return {};  // what is wrong is told where the table is imported
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

RowKeys place_keys(const ForeignTable& table, ColumnNames& names, TableReader& reader) {
  constexpr double kSide = 3;  // mean diameters
  RowKeys out;
  if (!table.broken.empty()) return out;
  try {
    const TableColumns columns(table, names);
    const ForeignColumn x = columns.need("x"), y = columns.need("y"), z = columns.find("z");
    const bool by_radius = columns.has("radius");
    const ForeignColumn size = columns.need(by_radius ? "radius" : "diameter");
    double sum = 0;
    reader.read(table, [&](const ForeignRow& row) { sum += row.number(size); });
    const double side = kSide * (by_radius ? 2 : 1) * sum / static_cast<double>(table.rows);
    const auto step = [&](const ForeignRow& row, const ForeignColumn& of) {
      return of ? std::floor(row.number(of) / side) : 0;
    };
    reader.read(table, [&](const ForeignRow& row) {
      out.push_back(fmt::format("{} {} {}", step(row, x), step(row, y), step(row, z)));
    });
  } catch (const std::invalid_argument&) {
    return {};  // what is wrong is told where the table is imported
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

bool are_apart(const RowKeys& a, const RowKeys& b) {
  RowKeys both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return !a.empty() && !b.empty() && 2 * both.size() < std::min(a.size(), b.size());
}

}  // namespace grainfield::coupling
