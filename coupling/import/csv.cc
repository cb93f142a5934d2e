// Tables of text with a line of names: separated by commas, semicolons, tabs or blanks. A table of
// pairs (i and j, under any of their names) is one of contacts, one with name and nx one of walls,
// any other one of grains.
//
// The line of names is the one of the first lines with the most names that are known; titles and
// "sep=;" may stand before it, a line of units behind it. Where no line has two, it is a comment
// (numpy.savetxt writes "# id,x,y"), and else the last line of words before the first numbers.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "coupling/import/foreign_kind.h"
#include "coupling/import/format.h"
#include "coupling/import/number_signs.h"
#include "coupling/import/row_text.h"
#include "coupling/import/synonyms.h"
#include "coupling/import/told_units.h"

namespace grainfield::coupling {
namespace {

constexpr std::size_t kHead = 60;  // lines before the rows, at most

struct HeadLine {
  std::string text;  // of a comment: without its sign
  long long line = 0;
  Lines::Place behind;
  bool comment = false;
};

// The first lines that are not blank, and the separator that a line "sep=;" names.
struct Head {
  std::vector<HeadLine> lines;
  char separator = 0;
  HeadWords known;
};

Head head_of(Lines& lines) {
  Head head;
  std::string_view line;
  while (head.lines.size() < kHead && lines.next(line)) {
    std::string_view text = trimmed(line);
    if (text.empty()) continue;
    const std::size_t sign = line.find("sep=");
    if (head.lines.empty() && head.separator == 0 && sign <= 1 && line.size() > sign + 4) {
      head.separator = line[sign + 4];
      continue;
    }
    // "#,x,y": the sign is a name, of numbers.
    const bool number =
        text.size() > 1 && std::string_view(",;\t|").find(text[1]) != std::string_view::npos;
    std::size_t sign_of_comment = text.starts_with("//") ? 2 : 0;
    if (text.front() == '%' || (text.front() == '#' && !number)) sign_of_comment = 1;
    const bool comment = sign_of_comment > 0;
    text.remove_prefix(sign_of_comment);
    std::string whole(text);
    const long long first = lines.line();
    // A name over several lines, "x\n(mm)" in quotation marks.
    const auto is_open = [&] { return std::count(whole.begin(), whole.end(), '"') % 2 == 1; };
    while (!comment && is_open() && whole.size() < Lines::longest && lines.next(line))
      whole += fmt::format(" {}", line);
    head.lines.push_back({std::move(whole), first, lines.place(), comment});
  }
  return head;
}

std::vector<std::string> values_of(const HeadLine& line, char separator) {
  RowParts parts;
  const auto& fields = parts.of(without_comment(line.text, separator), separator);
  return {fields.begin(), fields.end()};
}

// Without empty ones at the end.
std::size_t count_of(const std::vector<std::string>& values) {
  std::size_t count = values.size();
  while (count > 0 && values[count - 1].empty()) --count;
  return count;
}

bool is_number(std::string_view value, char separator) {
  return foreign_number(value).has_value() || (separator != ',' && is_decimal_comma(value));
}

// More numbers than words.
bool is_row(const std::vector<std::string>& values, char separator) {
  std::size_t numbers = 0, words = 0;
  for (const std::string& value : values) {
    if (value.empty()) continue;
    (is_number(value, separator) ? numbers : words) += 1;
  }
  return numbers > 0 && numbers >= words;
}

int known_names(const std::vector<std::string>& values, const HeadWords& known) {
  return static_cast<int>(
      std::count_if(values.begin(), values.end(), [&](const std::string& value) {
        const std::string name = heading_of(value, 0).name;
        return is_known_name(name) || std::find(known.names.begin(), known.names.end(),
                                                plain_column_name(name)) != known.names.end();
      }));
}

// The one by which a line has the most names that are known. Without any: the one of which the
// first line has the most.
char separator_of(const Head& head) {
  if (head.separator != 0) return head.separator;
  char best = 0;
  int most = 0;
  for (const char separator : {',', ';', '\t', '|', ' '})
    for (const HeadLine& line : head.lines) {
      const auto values = values_of(line, separator);
      if (values.size() < 2) continue;
      const int known = is_row(values, separator) ? 0 : known_names(values, head.known);
      // A comment counts where rows have as many values: any other is only words.
      const auto as_many = [&](const HeadLine& other) {
        return !other.comment && values_of(other, separator).size() == values.size();
      };
      if (line.comment && !std::any_of(head.lines.begin(), head.lines.end(), as_many)) continue;
      // Names may have blanks in them, beside any other separator.
      const bool blanks = separator == ' ';
      if (known <= most ||
          (blanks && (known < 2 || line.text.find_first_of(",;\t|") != std::string::npos)))
        continue;
      most = known;
      best = separator;
    }
  if (best != 0) return best;
  std::size_t parts = 1;
  for (const HeadLine& line : head.lines) {
    if (line.comment) continue;
    // Rows of numbers without any names.
    if (values_of(line, ' ').size() > 1 && is_row(values_of(line, ' '), ' ') &&
        line.text.find_first_of(",;\t|") == std::string::npos)
      return ' ';
    for (const char separator : {',', ';', '\t', '|'}) {
      if (values_of(line, separator).size() <= parts) continue;
      parts = values_of(line, separator).size();
      best = separator;
    }
    break;
  }
  return best == 0 ? ',' : best;
}

[[noreturn]] void refuse_empty(const std::string& file) {
  throw std::invalid_argument(file +
                              ": is empty, expected a line of names such as id,x,y,radius,mass");
}

// Throws where the first line is that of another format.
void refuse_other_formats(const std::string& file, const HeadLine& first) {
  const std::string line = (first.comment ? "# " : "") + first.text;
  if (const std::string kind = foreign_kind(line, "csv"); !kind.empty())
    throw std::invalid_argument(fmt::format("{}:{}: found \"{}\": this is {}", file, first.line,
                                            trimmed(first.text).substr(0, 40), kind));
}

class HeaderSearch {
 public:
  HeaderSearch(const std::string& file, const Head& head, char separator)
      : file_(file), head_(head), separator_(separator) {
    for (const HeadLine& line : head.lines) values_.push_back(values_of(line, separator));
    const auto row = [&](std::size_t k) {
      return !head.lines[k].comment && count_of(values_[k]) > 1 && is_row(values_[k], separator);
    };
    rows_.resize(values_.size());
    for (std::size_t k = 0; k < values_.size(); ++k) rows_[k] = row(k);
  }

  void find(ForeignTable& table) const {
    const std::size_t none = values_.size();
    std::size_t names = most_known(false);
    if (names == none) names = most_known(true);
    const bool any_row = std::find(rows_.begin(), rows_.end(), true) != rows_.end();
    if (names == none && (any_row || head_.lines.size() < kHead)) names = words_before_numbers();
    if (names == none) refuse();
    const std::size_t units = units_line(names);
    table.columns = std::make_shared<const std::vector<std::string>>(
        units < none ? names_with_units(values_[names], *units_of(units, names)) : values_[names]);
    table.header_line = head_.lines[names].line;
    if (table.columns->front() == "#") {
      std::vector<std::string> named = *table.columns;
      named.front() = "id";
      table.columns = std::make_shared<const std::vector<std::string>>(std::move(named));
    }
    const bool behind = units < none && units > names && !head_.lines[units].comment;
    table.first = head_.lines[behind ? units : names].behind;
    if (units == none) table.unit_remark = remark(names);
  }

 private:
  // The line, or the comment, with the most known names; of several the first.
  std::size_t most_known(bool comment) const {
    std::size_t best = values_.size();
    int most = 1;
    for (std::size_t k = 0; k < values_.size(); ++k) {
      if (rows_[k] || head_.lines[k].comment != comment) continue;
      if (comment && !has_row_of(count_of(values_[k]))) continue;
      const int known = known_names(values_[k], head_.known);
      if (known <= most) continue;
      most = known;
      best = k;
    }
    return best;
  }
  // Also where there is no row at all.
  bool has_row_of(std::size_t count) const {
    bool any = false;
    for (std::size_t k = 0; k < values_.size(); ++k) {
      any = any || rows_[k];
      if (rows_[k] && values_[k].size() == count) return true;
    }
    return !any;
  }
  // The last line of words before the first row, or the first line where there are no rows.
  std::size_t words_before_numbers() const {
    std::size_t found = values_.size();
    for (std::size_t k = 0; k < values_.size() && !rows_[k]; ++k)
      if (!head_.lines[k].comment) found = k;
    return found;
  }
  // The units of a line of nothing else; a comment has one for each name.
  std::optional<std::vector<std::string>> units_of(std::size_t k, std::size_t names) const {
    const HeadLine& line = head_.lines[k];
    auto units = units_row(line.text, separator_, values_[names].size(), head_.known.units);
    if (units && line.comment && count_of(*units) < count_of(values_[names]) &&
        count_of(values_[k]) != count_of(values_[names]))
      units.reset();
    return units;
  }
  // Below the names up to the first row, or above them, also as a comment, the nearest.
  std::size_t units_line(std::size_t names) const {
    for (std::size_t k = names + 1; k < values_.size() && !rows_[k]; ++k)
      if (units_of(k, names)) return k;
    for (std::size_t k = names; k-- > 0 && !rows_[k];)
      if (units_of(k, names)) return k;
    return values_.size();
  }
  // A unit in a title or a comment.
  std::string remark(std::size_t names) const {
    for (std::size_t k = 0; k < values_.size(); ++k) {
      const HeadLine& line = head_.lines[k];
      if (k == names || rows_[k] || (k > names && !line.comment)) continue;
      if (std::string text = unit_remark(file_, line.line, line.text); !text.empty()) return text;
    }
    return "";
  }

  [[noreturn]] void refuse() const {
    const auto& lines = head_.lines;
    if (lines.size() == kHead && std::find(rows_.begin(), rows_.end(), true) == rows_.end())
      throw std::invalid_argument(fmt::format(
          "{}: no line of names among its first {} lines, expected one such as id,x,y,radius,mass; "
          "take out the lines before it",
          file_, kHead));
    const auto text = std::find_if(lines.begin(), lines.end(),
                                   [](const HeadLine& line) { return !line.comment; });
    if (text == lines.end()) refuse_empty(file_);
    const auto k = static_cast<std::size_t>(text - lines.begin());
    throw std::invalid_argument(fmt::format(
        "{}:{}: found \"{}\" and no line of names above, expected one such as "
        "id,x,y,radius,mass for the {} columns",
        file_, head_.lines[k].line, head_.lines[k].text.substr(0, 60), values_[k].size()));
  }

  const std::string& file_;
  const Head& head_;
  char separator_;
  std::vector<std::vector<std::string>> values_;
  std::vector<bool> rows_;  // more numbers than words
};

}  // namespace

ForeignTable scan_csv(const std::string& file, HeadWords&& known) {
  Lines lines(file);
  Head head = head_of(lines);
  head.known = std::move(known);
  if (head.lines.empty()) refuse_empty(file);
  refuse_other_formats(file, head.lines.front());
  ForeignTable table;
  table.file = file;
  table.separator = separator_of(head);
  table.any_names = true;
  HeaderSearch(file, head, table.separator).find(table);
  NumberSigns signs = number_signs(lines, table);
  table.decimal_commas = signs.decimal_commas;
  table.thousands = signs.thousands;
  if (!signs.doubt.empty()) table.doubts.push_back(std::move(signs.doubt));
  return table;
}

ImportFormat csv_format() {
  ImportFormat format;
  format.name = "csv";
  format.summary = "tables of grains, contacts and walls with a line of names";
  format.scan = [](const std::string& file, ColumnNames&) {
    if (auto states = scan_xyz(file)) return std::move(*states);
    return std::vector<ForeignTable>{scan_csv(file)};
  };
  for (const TableKind kind : {TableKind::grains, TableKind::contacts, TableKind::walls})
    for (const OurColumn& column : our_columns(kind)) {
      // Scaled places are told by dumps alone, which tell the box, too.
      if (column.name.size() <= 3 && column.name.find('s') == 1) continue;
      format.columns.emplace_back(column.name, column.name);
    }
  return format;
}

}  // namespace grainfield::coupling
