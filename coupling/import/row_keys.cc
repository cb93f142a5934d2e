#include "coupling/import/row_keys.h"

#include <algorithm>
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

bool are_apart(const RowKeys& a, const RowKeys& b) {
  RowKeys both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return !a.empty() && !b.empty() && 2 * both.size() < std::min(a.size(), b.size());
}

}  // namespace grainfield::coupling
