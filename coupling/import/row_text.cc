#include "coupling/import/row_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

// Whether a quotation of the line is open at its end.
bool ends_quoted(std::string_view line) {
  return std::count(line.begin(), line.end(), '"') % 2 == 1;
}

// Excel's text ="1" is 1.
std::string_view without_formula(std::string_view value) {
  const bool text = value.size() > 3 && value.starts_with("=\"") && value.ends_with('"');
  return text ? value.substr(2, value.size() - 3) : value;
}

}  // namespace

std::string plain_exponent(std::string_view text) {
  std::string out(text);
  const std::size_t sign = out.find_first_of("dD");
  if (sign == std::string::npos || sign == 0 || sign + 1 == out.size()) return out;
  if (out.find_first_not_of("0123456789+-.,dD") == std::string::npos) out[sign] = 'E';
  return out;
}

std::optional<double> foreign_number(std::string_view text) {
  if (const auto number = parse_number(text)) return number;
  return text.find_first_of("dD") == std::string_view::npos ? std::nullopt
                                                            : parse_number(plain_exponent(text));
}

bool is_no_value(std::string_view value) {
  for (const std::string_view word : {"", "NA", "<NA>", "None", "N/A", "n/a", "-", "--"})
    if (value == word) return true;
  // Errors of spreadsheets, in any language: "#N/A", "#VALEUR!", "#DIV/0!".
  if (value.size() < 3 || value.front() != '#') return false;
  const auto in_error = [](char ch) {
    return (ch >= 'A' && ch <= 'Z') || std::string_view("/!?0").find(ch) != std::string_view::npos;
  };
  return value[1] >= 'A' && value[1] <= 'Z' &&
         std::all_of(value.begin() + 1, value.end(), in_error);
}

std::string_view without_comment(std::string_view line, char separator) {
  const std::size_t sign = line.rfind('#');
  if (sign == std::string_view::npos || sign == 0) return line;
  if (line[sign - 1] != ' ' && line[sign - 1] != '\t') return line;
  const std::string_view behind = line.substr(sign);
  if (separator != ' ' && is_no_value(trimmed(behind))) return line;
  if (separator != ' ' && behind.find(separator) != std::string_view::npos) return line;
  // "sand #1" is a value: a word goes on to a sign without a blank behind it.
  if (separator != ' ' && behind.size() > 1 && behind[1] != ' ') {
    const std::size_t before = line.rfind(separator, sign);
    const std::size_t start = before == std::string_view::npos ? 0 : before + 1;
    const std::string_view value = trimmed(line.substr(start, sign - start));
    if (!value.empty() && !parse_number(value)) return line;
  }
  return behind.find('"') == std::string_view::npos ? trimmed(line.substr(0, sign)) : line;
}

const std::vector<std::string_view>& RowParts::of(std::string_view line, char separator) {
  texts_.clear();
  fields_.clear();
  if (separator == ' ') {
    split(line, ' ', fields_);
  } else if (line.find('"') == std::string_view::npos) {
    split(line, separator, fields_);
  } else {
    part_quoted(line, separator);
  }
  return fields_;
}

const std::vector<std::string_view>& RowParts::of(std::string_view line, char separator,
                                                  Lines& lines) {
  line = without_comment(line, separator);
  if (separator == ' ' || !ends_quoted(line)) return of(line, separator);
  joined_ = line;
  const std::string where = lines.where();
  for (std::string_view more; ends_quoted(joined_);) {
    if (joined_.size() > Lines::longest || !lines.next(more))
      throw std::invalid_argument(where + ": a quotation mark is opened and not closed");
    joined_ += '\n';
    joined_ += more;
  }
  return of(joined_, separator);
}

void RowParts::part_quoted(std::string_view line, char separator) {
  std::size_t at = 0;
  while (true) {
    const std::size_t start = line.find_first_not_of(separator == '\t' ? " " : " \t", at);
    if (start == std::string_view::npos || line[start] != '"') {
      const std::size_t end = std::min(line.find(separator, at), line.size());
      fields_.push_back(without_formula(trimmed(line.substr(at, end - at))));
      if (end == line.size()) return;
      at = end + 1;
      continue;
    }
    std::size_t close = start + 1;
    bool doubled = false;
    while (true) {
      close = line.find('"', close);
      if (close == std::string_view::npos || close + 1 >= line.size() || line[close + 1] != '"')
        break;
      doubled = true;
      close += 2;
    }
    close = std::min(close, line.size());
    std::string_view value = line.substr(start + 1, close - start - 1);
    if (doubled) {
      std::string& text = texts_.emplace_back();
      for (std::size_t k = 0; k < value.size(); ++k) {
        text += value[k];
        if (value[k] == '"') ++k;
      }
      value = text;
    }
    fields_.push_back(trimmed(value));
    const std::size_t end = std::min(line.find(separator, close), line.size());
    if (end == line.size()) return;
    at = end + 1;
  }
}

}  // namespace grainfield::coupling
