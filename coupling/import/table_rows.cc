// Rows of tables: their values, and the files that they come from.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "coupling/import/number_signs.h"
#include "coupling/import/row_text.h"
#include "coupling/import/synonyms.h"
#include "coupling/import/table.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

constexpr long long kFewRows = 4;  // by whose lengths a last one is not judged, with itself

// Whether a line that begins with # parts into numbers as a row of the table does: a comment is
// other words, or has a blank behind its sign.
bool is_row_behind_sign(const std::vector<std::string_view>& fields, std::size_t columns) {
  if (columns < 3 || fields.size() != columns || fields.front().size() < 2 ||
      fields.front()[1] == ' ')
    return false;
  std::size_t numbers = 0, words = 0;
  for (std::size_t k = 1; k < fields.size(); ++k) {
    if (is_no_value(fields[k])) continue;
    (foreign_number(fields[k]) || is_decimal_comma(fields[k]) ? numbers : words) += 1;
  }
  return numbers > 1 && numbers >= words;
}

// What is expected in the place of a text that is no id.
std::string without_number(const std::string& told) {
  const std::string out = "a whole number";
  if (told.find_first_of("0123456789") != std::string::npos &&
      std::isalpha(static_cast<unsigned char>(told.front())) != 0)
    return out + "; leave the letters out in the tables of grains and of contacts";
  for (const char* word :
       {"total", "sum", "mean", "average", "count", "min", "max", "std", "median"})
    if (plain_column_name(told).starts_with(word))
      return out + "; leave out rows of sums and means";
  return out;
}

// "|---|:--:|", "+----+", "----- -----": a line below names, of Markdown and of text tables.
bool is_rule(std::string_view text) {
  if (text.find_first_not_of("-=+|: \t") != std::string_view::npos) return false;
  return text.find("---") != std::string_view::npos || text.find("===") != std::string_view::npos ||
         (text.find("--") != std::string_view::npos &&
          text.find_first_of("|+") != std::string_view::npos);
}

}  // namespace

const ArrayColumn* ForeignRow::array_of(const ForeignColumn& column) const {
  return arrays == nullptr || column.index < 0 ? nullptr
                                               : &(*arrays)[static_cast<std::size_t>(column.index)];
}

std::string_view ForeignRow::text(const ForeignColumn& column) const {
  if (const ArrayColumn* array = array_of(column)) {
    if (!array->words.empty()) return array->words[place];
    if (!array->whole.empty()) {
      shown_ = fmt::format("{}", array->whole[place]);
    } else {
      const double value = array->numbers[place];
      shown_ = std::isnan(value) ? "nan" : fmt::format("{}", value);
    }
    return shown_;
  }
  return column.index >= 0 ? (*fields)[static_cast<std::size_t>(column.index)] : std::string_view();
}

bool ForeignRow::empty(const ForeignColumn& column) const {
  const ArrayColumn* array = array_of(column);
  if (array != nullptr && !array->numbers.empty()) return std::isnan(array->numbers[place]);
  if (!column || column.constant) return !column;
  const std::string_view told = text(column);
  return is_no_value(told);  // nan may be what a program computed
}

std::string ForeignRow::name_of(const ForeignColumn& column) const {
  if (column.index < 0) return column.name;
  const std::string& theirs = (*columns)[static_cast<std::size_t>(column.index)];
  return theirs == column.name ? theirs : fmt::format("{} ({})", theirs, column.name);
}

void ForeignRow::refuse(const std::string& what) const {
  throw std::invalid_argument(fmt::format("{}:{}: {}", *file, line, what));
}

std::string ForeignRow::plain_number(const ForeignColumn& column) const {
  std::string told(text(column));
  if (thousands != 0) {
    const std::size_t end = told.find(decimal_commas ? ',' : '.');
    if (is_in_thousands(std::string_view(told).substr(0, end), thousands))
      std::erase(told, thousands);
  }
  if (!decimal_commas) return told;
  if (told.find('.') != std::string::npos)
    refuse(
        fmt::format("column {}: found \"{}\", expected a comma in decimals, as in the rows before",
                    name_of(column), told));
  std::replace(told.begin(), told.end(), ',', '.');
  return told;
}

double ForeignRow::number(const ForeignColumn& column) const {
  if (column.constant) return *column.constant;
  const ArrayColumn* array = array_of(column);
  std::optional<double> value;
  const auto read = [&](const std::string& told) {
    return column.unit ? in_si(plain_exponent(told), *column.unit) : foreign_number(told);
  };
  if (array != nullptr && !array->whole.empty()) {
    value = column.unit ? in_si(fmt::format("{}", array->whole[place]), *column.unit)
                        : static_cast<double>(array->whole[place]);
  } else if (array != nullptr && array->words.empty()) {
    value = array->numbers[place];
    // As the same number in a text would be.
    if (column.unit && std::isfinite(*value))
      value = in_si(fmt::format("{}", *value), *column.unit);
  } else {
    value = read(plain_number(column));
  }
  if (!value || !std::isfinite(*value)) {
    const std::string_view told = text(column);
    const bool comma = array == nullptr && std::count(told.begin(), told.end(), ',') == 1;
    const bool none = array == nullptr && (told == "nan" || told == "NaN");
    refuse(fmt::format(
        "column {}: found \"{}\", expected a finite number{}", name_of(column), told,
        comma  ? ": is the comma one of decimals or of thousands? Decimal commas are read where no "
                 "number of the table has a point"
        : none ? "; a column that may be missing may be empty, and the row of a lost grain may be "
                 "left out"
               : ""));
  }
  return *value;
}

ToldId ForeignRow::told_id(const ForeignColumn& column) const {
  const ArrayColumn* array = array_of(column);
  if (array != nullptr && !array->whole.empty()) return {array->whole[place], 0};
  const std::string told =
      column.constant ? fmt::format("{}", *column.constant) : plain_number(column);
  // A floating-point number in memory may be rounded, whatever its digits.
  const bool floating = array != nullptr && !array->numbers.empty();
  if (const auto value = parse_integer(told); value && !floating) return {*value, 0};
  const std::optional<double> value = parse_number(told);
  // Above, numbers of this type are no longer one apart.
  const bool single = array != nullptr && array->single;
  const double most = single ? 16777216.0 : 9007199254740992.0;
  if (!value || *value != std::floor(*value) || !(std::abs(*value) < most)) {
    const bool large = value && std::abs(*value) >= most && std::isfinite(*value);
    refuse(fmt::format(
        "column {}: found \"{}\", expected {}", column.constant ? column.name : name_of(column),
        told,
        large
            ? fmt::format("a whole number with all of its digits: as a floating-point number{} one "
                          "from {} on may stand for its neighbour",
                          single ? " of four bytes" : "", single ? "2^24" : "2^53")
            : without_number(told)));
  }
  const std::size_t e = told.find_first_of("eE");
  if (e == std::string::npos) return {static_cast<std::int64_t>(*value), 0};
  // Digits behind the last that is told may be any.
  int digits = 0;
  for (const char ch : told.substr(0, e)) digits += ch >= '0' && ch <= '9' ? 1 : 0;
  const int whole_digits =
      *value == 0 ? 1 : 1 + static_cast<int>(std::floor(std::log10(std::abs(*value)) + 1e-12));
  return {static_cast<std::int64_t>(*value), digits < whole_digits ? digits : 0};
}

int ForeignRow::digits(const ForeignColumn& column) const {
  constexpr int kDouble = 17, kSingle = 7;
  if (column.constant) return kDouble;
  if (const ArrayColumn* array = array_of(column)) return array->single ? kSingle : kDouble;
  int out = 0;
  for (const char ch : text(column)) {
    if (ch == 'e' || ch == 'E') break;
    // Zeros before the first other digit tell nothing.
    if (ch >= '0' && ch <= '9' && (ch != '0' || out > 0)) ++out;
  }
  return out;
}

bool ForeignRow::flag(const ForeignColumn& column) const {
  if (empty(column)) return false;
  const std::string_view told = column.constant ? std::string_view() : text(column);
  for (const std::string_view yes : {"True", "true", "TRUE", "yes", "Yes", "YES"})
    if (told == yes) return true;
  for (const std::string_view no : {"False", "false", "FALSE", "no", "No", "NO"})
    if (told == no) return false;
  const double value = number(column);
  if (value != 0 && value != 1)
    refuse(fmt::format("column {}: found {}, allowed: 0, 1", name_of(column), value));
  return value != 0;
}

double ForeignRow::coefficient(const ForeignColumn& column) const {
  const double value = number(column);
  if (!(value >= 0 && value <= kMostFriction))
    refuse(fmt::format("column {}: found {}, allowed: 0 to {:g}", name_of(column), value,
                       kMostFriction));
  return value;
}

void TableReader::read_arrays(const ForeignTable& table,
                              const std::function<void(const ForeignRow&)>& take) {
  ForeignRow row;
  row.file = &table.file;
  row.columns = table.columns.get();
  row.arrays = table.arrays.get();
  for (long long n = 0; n < table.rows; ++n) {
    row.line = n;
    row.place = static_cast<std::size_t>(n);
    take(row);
  }
}

Lines& TableReader::lines_of(const std::string& file) {
  constexpr std::size_t kMostOpen = 40;
  const auto at = std::find_if(files_.begin(), files_.end(),
                               [&](const Lines& lines) { return lines.file() == file; });
  if (at != files_.end()) {
    files_.splice(files_.begin(), files_, at);
  } else {
    if (files_.size() == kMostOpen) files_.pop_back();
    files_.emplace_front(file);
  }
  return files_.front();
}

void TableReader::check_end(const Lines& lines, std::string_view last, std::size_t shortest) {
  if (!lines.unfinished() || last.size() >= shortest || !foreign_number(last)) return;
  doubt_of_end_ = fmt::format(
      "{}: the file ends without a line end, and its last number, {}, is shorter than all before "
      "it: is it cut off?",
      lines.where(), last);
}

void TableReader::read(const ForeignTable& table,
                       const std::function<void(const ForeignRow&)>& take) {
  doubt_of_end_.clear();
  if (table.arrays) return read_arrays(table, take);
  Lines& lines = lines_of(table.file);
  lines.seek(table.first);
  RowParts parts;
  ForeignRow row;
  row.file = &table.file;
  row.columns = table.columns.get();
  row.decimal_commas = table.decimal_commas;
  row.thousands = table.thousands;
  const std::size_t columns = table.columns->size();
  std::vector<std::string_view> padded;
  std::string_view line;
  std::size_t shortest = 0, length = std::string::npos;  // of the last values
  for (long long n = 0; (table.rows < 0 || n < table.rows) && lines.next(line);) {
    row.line = lines.line();
    const std::string_view text = trimmed(line);
    if (text.empty() || (table.rows < 0 && is_rule(text))) continue;
    if (table.rows < 0 && text.front() == '#') {
      RowParts behind;
      const auto& values = behind.of(text, table.separator);
      if (!is_row_behind_sign(values, columns)) continue;
      if (!is_no_value(values.front()))
        row.refuse(
            fmt::format("found \"{}\", expected a row, or a comment with a blank behind its "
                        "sign: is it a row?",
                        text.substr(0, 60)));
    }
    ++n;
    const std::vector<std::string_view>& fields = parts.of(line, table.separator, lines);
    row.fields = &fields;
    shortest = n == 1 ? std::string::npos : std::min(shortest, length);
    length = fields.empty() ? 0 : fields.back().size();
    if (n >= kFewRows) check_end(lines, fields.empty() ? "" : fields.back(), shortest);
    if (fields.size() != columns) {
      const auto blank = [](std::string_view field) { return field.empty(); };
      if (std::all_of(fields.begin(), fields.end(), blank)) continue;
      const std::size_t both = std::min(fields.size(), columns);
      bool fits =
          std::all_of(fields.begin() + static_cast<std::ptrdiff_t>(both), fields.end(), blank);
      for (std::size_t k = both; k < columns; ++k) fits = fits && (*table.columns)[k].empty();
      if (!fits)
        row.refuse(fmt::format("{} values where the header at line {} names {} columns{}",
                               fields.size(), table.header_line, columns,
                               fields.size() == columns + 1
                                   ? "; are the first ones names of rows (R: write.table(..., "
                                     "row.names = FALSE) leaves them out)?"
                                   : ""));
      padded.assign(fields.begin(), fields.begin() + static_cast<std::ptrdiff_t>(both));
      padded.resize(columns);
      row.fields = &padded;
    } else if (table.rows < 0 && std::all_of(fields.begin(), fields.end(),
                                             [](std::string_view f) { return f.empty(); })) {
      continue;
    } else if (table.rows < 0 && std::equal(fields.begin(), fields.end(), table.columns->begin())) {
      continue;  // the line of names once more, of tables that were put behind each other
    }
    take(row);
  }
}

}  // namespace grainfield::coupling
