#include "continuum/number_table.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>

#include "continuum/model.h"
#include "dem/shared/number.h"

namespace grainfield::continuum {
namespace {

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> out(1);
  for (const char ch : text) {
    if (ch == ',')
      out.emplace_back();
    else if (ch != ' ' && ch != '\t' && ch != '\r')
      out.back() += ch;
  }
  return out;
}

bool is_comment(const std::string& text) { return text.empty() || text == "\r" || text[0] == '#'; }

// It is read more than once, and a pipe would have to be waited for.
void require_regular_file(const std::string& file) {
  std::error_code error;
  const auto there = std::filesystem::status(file, error);
  if (!std::filesystem::exists(there) || std::filesystem::is_regular_file(there)) return;
  throw BadParameter(
      fmt::format("{}: is {}, expected a file", file,
                  std::filesystem::is_directory(there) ? "a folder" : "a pipe or device"));
}

NumberRow read_row(const std::string& file, int line, const std::string& text, std::size_t columns,
                   std::size_t may_lack_from) {
  NumberRow row{line, {}};
  for (const auto& word : split(text)) {
    const std::optional<double> number = parse_number(word);
    row.values.push_back(number.value_or(0));
    const bool lacks = row.values.size() > may_lack_from && std::isnan(row.values.back());
    if (!number || !(lacks || std::isfinite(*number)))
      refuse_line(file, line, fmt::format("\"{}\" is not a finite number", word));
  }
  if (row.values.size() != columns)
    refuse_line(file, line, fmt::format("{} numbers, expected {}", row.values.size(), columns));
  return row;
}

}  // namespace

void refuse_line(const std::string& file, int line, const std::string& why) {
  throw BadParameter(fmt::format("{}:{}: {}", file, line, why));
}

NumberTable read_number_table(
    const std::string& file,
    const std::function<std::string(const std::vector<std::string>&)>& header,
    std::size_t may_lack_from) {
  require_regular_file(file);
  std::ifstream stream(file);
  if (!stream) throw BadParameter(file + ": cannot be opened");
  NumberTable table;
  table.file = file;
  for (std::string text; std::getline(stream, text);) {
    ++table.last_line;
    if (is_comment(text)) continue;
    if (!table.names.empty()) {
      table.rows.push_back(
          read_row(file, table.last_line, text, table.names.size(), may_lack_from));
      continue;
    }
    table.names = split(text);
    const std::string wrong = header(table.names);
    if (!wrong.empty())
      refuse_line(file, table.last_line, fmt::format("the header is \"{}\"; {}", text, wrong));
  }
  return table;
}

std::vector<std::string> table_columns(const std::string& file) {
  require_regular_file(file);
  std::ifstream stream(file);
  for (std::string text; std::getline(stream, text);) {
    if (!is_comment(text)) return split(text);
  }
  return {};
}

}  // namespace grainfield::continuum
