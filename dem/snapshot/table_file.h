// Tables of rows as groups of HDF5 datasets, by their lists of columns (columns.h).
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "dem/hdf5/file.h"
#include "dem/snapshot/columns.h"
#include "dem/snapshot/limits.h"

namespace grainfield::dem {

/// Names with commas between them. Throws std::invalid_argument for one with a comma.
std::string joined_names(const std::vector<std::string>& names, const std::string& what);
std::vector<std::string> split_names(const std::string& text);

/// What is read: for messages, and which columns there must be.
struct TableSource {
  std::string where;  ///< "FILE:/group"
  int dim = 2;
  int format = 1;
};

/// Throws std::invalid_argument "WHERE: WHAT has F rows where W are expected" unless they agree.
void require_rows(const TableSource& source, const std::string& what, std::size_t found,
                  std::size_t wanted);

namespace table {

inline double number(double v) { return v; }
inline long long number(std::int64_t v) { return v; }
inline long long number(bool v) { return v ? 1 : 0; }
inline long long number(int v) { return v; }

template <class Value>
constexpr bool is_list = !std::is_arithmetic_v<Value> && !std::is_same_v<Value, std::string>;
/// Numbers of a value in a row.
template <class Value>
constexpr int width_of() {
  if constexpr (is_list<Value>)
    return static_cast<int>(sizeof(Value) / sizeof(std::declval<Value&>()[0]));
  else
    return 1;
}
/// The i-th number of a value.
template <class Value>
auto& element(Value& value, [[maybe_unused]] int i) {
  if constexpr (is_list<std::remove_const_t<Value>>)
    return value[static_cast<std::size_t>(i)];
  else
    return value;
}

template <class Row, class Value>
Value value_type(Value Row::*);

/// Doubles are real, all else whole numbers.
template <class Value>
constexpr bool is_real =
    std::is_same_v<std::decay_t<decltype(element(std::declval<Value&>(), 0))>, double>;

template <class Row>
bool is_used(const Column<Row>& column, const std::vector<Row>& rows) {
  const Row plain;
  return std::visit(
      [&](auto member) {
        return std::any_of(rows.begin(), rows.end(),
                           [&](const Row& row) { return row.*member != plain.*member; });
      },
      column.member);
}

}  // namespace table

/// Whether the file gets the column.
template <class Row>
bool is_written(const Column<Row>& column, const std::vector<Row>& rows, int dim, int format) {
  switch (column.presence) {
    case Presence::in_3d:
      return dim == 3;
    case Presence::where_used:
      return table::is_used(column, rows);
    case Presence::derived:
      return format > 1 && table::is_used(column, rows);
    case Presence::always:
      break;
  }
  return true;
}

/// Whether all that the file gets was in the first format already.
template <class Row>
bool is_plain(const std::vector<Column<Row>>& columns, const std::vector<Row>& rows, int dim) {
  return std::none_of(columns.begin(), columns.end(), [&](const Column<Row>& column) {
    return column.presence != Presence::always && is_written(column, rows, dim, 1);
  });
}

/// Every column that is_written, into the group. Throws StorageFailed.
template <class Row>
void write_table(hid_t group, const std::vector<Column<Row>>& columns, const std::vector<Row>& rows,
                 int dim, int format) {
  for (const Column<Row>& column : columns) {
    if (!is_written(column, rows, dim, format)) continue;
    std::visit(
        [&](auto member) {
          using Value = decltype(table::value_type(member));
          if constexpr (std::is_same_v<Value, std::string>) {
            std::vector<std::string> names;
            std::vector<long long> places;
            for (const Row& row : rows) {
              const std::string& text = row.*member;
              const auto at = std::find(names.begin(), names.end(), text);
              places.push_back(text.empty() ? -1 : at - names.begin());
              if (!text.empty() && at == names.end()) names.push_back(text);
            }
            hdf5::write(group, column.name, places, 1, column.unit);
            hdf5::write_attribute(group, std::string(column.name) + "_names",
                                  joined_names(names, column.name));
          } else {
            constexpr int width = table::width_of<Value>();
            std::vector<std::conditional_t<table::is_real<Value>, double, long long>> values;
            values.reserve(rows.size() * width);
            for (const Row& row : rows)
              for (int k = 0; k < width; ++k)
                values.push_back(table::number(table::element(row.*member, k)));
            hdf5::write(group, column.name, values, width, column.unit);
          }
        },
        column.member);
  }
}

/// All rows of a table, with defaults for the columns that the file need not have. `row_name`:
/// what a row is called in messages; the columns before are filled. Throws std::invalid_argument:
/// what is missing, of another length, not finite, beyond kMostNumber, out of its range.
template <class Row>
std::vector<Row> read_table(hid_t group, const std::vector<Column<Row>>& columns,
                            const TableSource& source, const std::string& table_name,
                            const std::function<std::string(const Row&, std::size_t)>& row_name) {
  const std::string at = source.where + "/" + table_name;
  std::vector<Row> rows;
  const auto refuse = [&](const Column<Row>& column, std::size_t row, const auto& found,
                          const char* allowed) {
    throw std::invalid_argument(fmt::format("{}: {} of {} is {}; it must be {}", source.where,
                                            column.name, row_name(rows[row], row), found, allowed));
  };
  for (const Column<Row>& column : columns) {
    const bool required =
        column.presence == Presence::always ||
        (column.presence == Presence::in_3d && source.dim == 3 && source.format > 1);
    if (!required && !hdf5::has_link(group, column.name)) continue;
    const bool first = &column == &columns.front();
    std::visit(
        [&](auto member) {
          using Value = decltype(table::value_type(member));
          constexpr int width = table::width_of<Value>();
          const auto fit = [&](std::size_t numbers) {
            if (first) rows.resize(numbers / width);
            require_rows(source, fmt::format("{}/{}", table_name, column.name), numbers / width,
                         rows.size());
          };
          if constexpr (table::is_real<Value>) {
            const auto values = hdf5::read_doubles(group, column.name, width, at);
            fit(values.size());
            for (std::size_t k = 0; k < values.size(); ++k) {
              const bool untold = column.may_be_nan && std::isnan(values[k]);
              if (!std::isfinite(values[k]) && !untold)
                refuse(column, k / width, values[k], "a finite number");
              if (std::fabs(values[k]) > kMostNumber)
                refuse(column, k / width, values[k], "of size 1e+100 at most");
              table::element(rows[k / width].*member, static_cast<int>(k % width)) = values[k];
            }
          } else if constexpr (std::is_same_v<Value, std::string>) {
            const auto places = hdf5::read_integers(group, column.name, 1, at);
            fit(places.size());
            const auto names =
                split_names(hdf5::read_text_attribute(group, std::string(column.name) + "_names"));
            const auto count = static_cast<long long>(names.size());
            for (std::size_t k = 0; k < places.size(); ++k) {
              if (places[k] < -1 || places[k] >= count)
                refuse(column, k, places[k], "a place in its list of names, or -1");
              rows[k].*member = places[k] < 0 ? "" : names[static_cast<std::size_t>(places[k])];
            }
          } else {
            using Number = std::decay_t<decltype(table::element(std::declval<Value&>(), 0))>;
            const auto values = hdf5::read_integers(group, column.name, width, at);
            fit(values.size());
            for (std::size_t k = 0; k < values.size(); ++k) {
              if (std::is_same_v<Number, int> && (values[k] < -1'000'000 || values[k] > 1'000'000))
                refuse(column, k / width, values[k], "at most 1000000");
              auto& number = table::element(rows[k / width].*member, static_cast<int>(k % width));
              if (std::is_same_v<Number, bool> && values[k] != 0 && values[k] != 1)
                refuse(column, k / width, values[k], "0 or 1");
              if constexpr (std::is_same_v<Number, bool>)
                number = values[k] != 0;
              else
                number = static_cast<Number>(values[k]);
            }
          }
        },
        column.member);
  }
  return rows;
}

}  // namespace grainfield::dem
