#include "coupling/result/csv.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace grainfield::coupling {

Csv& Csv::comment(std::string_view text) {
  fmt::format_to(std::back_inserter(text_), "# {}\n", text);
  return *this;
}

Csv& Csv::end_row() {
  text_ += '\n';
  in_row_ = false;
  return *this;
}

void Csv::separate() {
  if (in_row_) text_ += ',';
  in_row_ = true;
}

void Csv::put(std::string_view cell) {
  separate();
  if (cell.find_first_of(",\"\r\n") == std::string_view::npos) {
    text_ += cell;
    return;
  }
  text_ += '"';
  for (const char c : cell) {
    if (c == '"') text_ += '"';
    text_ += c;
  }
  text_ += '"';
}

void Csv::put(double cell) {
  separate();
  const auto to = std::back_inserter(text_);
  if (std::isnan(cell))
    text_ += "nan";
  else if (digits_ == kAllDigits)
    fmt::format_to(to, "{}", cell);
  else
    fmt::format_to(to, "{:.{}g}", cell, digits_);
}

void Csv::put(long long cell) {
  separate();
  fmt::format_to(std::back_inserter(text_), "{}", cell);
}

std::string csv_heading(const std::string& name, const std::string& unit) {
  return unit.empty() || unit == "1" || unit == "-" ? name : name + "_" + unit;
}

}  // namespace grainfield::coupling
