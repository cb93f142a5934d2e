#include "dem/snapshot/number_tables.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "dem/hdf5/file.h"
#include "dem/shared/number.h"
#include "dem/snapshot/table_file.h"

namespace grainfield::dem {
namespace {

constexpr const char* kTables = "tables";
// Attributes that held columns as texts of numbers, and the tables that these are now; the longer
// of two names with the same beginning comes first.
struct OldColumns {
  std::string begin, table;
};
const std::array<OldColumns, 6> kOldColumns{{{"gas:", "gas"},
                                             {"pair:loop_", "loops"},
                                             {"pair:", "pair"},
                                             {"settling:", "settling"},
                                             {"switch:soft_", "soft"},
                                             {"switch:", "switch"}}};

std::optional<std::vector<double>> numbers_of(const std::string& text) {
  std::vector<double> out;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto number = parse_number(word);
    if (!number) return std::nullopt;
    out.push_back(*number);
  }
  return out;
}

NumberTable read_one(hid_t parent, const std::string& name, const std::string& where) {
  const hdf5::Handle group = hdf5::open_group(parent, name);
  const std::string at = fmt::format("{}/{}/{}", where, kTables, name);
  NumberTable out;
  for (const std::string& column : split_names(hdf5::read_text_attribute(group, "columns"))) {
    out.push_back({column, "", hdf5::read_doubles(group, column, 1, at)});
    const hdf5::Handle data(H5Dopen2(group, column.c_str(), H5P_DEFAULT), H5Dclose);
    out.back().unit = hdf5::read_text_attribute(data, "unit");
    const std::size_t rows = out.back().values.size(), wanted = out.front().values.size();
    if (rows != wanted) {
      throw std::invalid_argument(
          fmt::format("{}: {} has {} rows where {} are expected", at, column, rows, wanted));
    }
  }
  return out;
}

void take_old_columns(Snapshot& s) {
  for (const OldColumns& old : kOldColumns) {
    for (auto at = s.attributes.lower_bound(old.begin);
         at != s.attributes.end() && at->first.starts_with(old.begin);) {
      auto numbers = numbers_of(at->second);
      if (numbers) {
        s.tables[old.table].push_back({at->first.substr(old.begin.size()), "", *numbers});
        at = s.attributes.erase(at);
      } else {
        ++at;
      }
    }
  }
}

}  // namespace

void write_number_tables(hid_t group, const Snapshot& s) {
  if (s.tables.empty()) return;
  const hdf5::Handle all = hdf5::create_group(group, kTables);
  for (const auto& [name, table] : s.tables) {
    const hdf5::Handle one = hdf5::create_group(all, name);
    std::vector<std::string> names;
    for (const NumberColumn& column : table) {
      hdf5::write(one, column.name, column.values, 1, column.unit);
      names.push_back(column.name);
    }
    hdf5::write_attribute(one, "columns", joined_names(names, name));
  }
}

void read_number_tables(hid_t group, const std::string& where, Snapshot& s) {
  take_old_columns(s);
  if (!hdf5::has_link(group, kTables)) return;
  const hdf5::Handle all = hdf5::open_group(group, kTables);
  for (const std::string& name : hdf5::groups(all)) s.tables[name] = read_one(all, name, where);
}

}  // namespace grainfield::dem
