#include "coupling/result/text_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>

namespace grainfield::coupling {
namespace {

// Characters of UTF-8 text.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

// Cells narrower than their column's width are padded.
std::string markdown_of(const std::vector<std::string>& header,
                        const std::vector<std::vector<std::string>>& rows,
                        const std::vector<std::size_t>& width) {
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string out = "|";
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const std::size_t own = width_of(cells[k]);
      out += " " + cells[k] + std::string(std::max(width[k], own) - own, ' ') + " |";
    }
    return out + "\n";
  };
  std::string out = line(header) + "|";
  for (const std::size_t w : width) out += std::string(std::max<std::size_t>(w + 2, 3), '-') + "|";
  out += "\n";
  for (const auto& row : rows) out += line(row);
  return out;
}

}  // namespace

std::string markdown_table(const std::vector<std::string>& header,
                           const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> width;
  for (std::size_t k = 0; k < header.size(); ++k) {
    width.push_back(width_of(header[k]));
    for (const auto& row : rows) width[k] = std::max(width[k], width_of(row[k]));
  }
  return markdown_of(header, rows, width);
}

std::string plain_markdown_table(const std::vector<std::string>& header,
                                 const std::vector<std::vector<std::string>>& rows) {
  return markdown_of(header, rows, std::vector<std::size_t>(header.size(), 0));
}

std::string escape_latex(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\textbackslash{}";
    } else if (c == '^' || c == '~') {
      out += fmt::format("\\{}{{}}", c);
    } else {
      if (std::string("&%$#_{}").find(c) != std::string::npos) out += '\\';
      out += c;
    }
  }
  boost::replace_all(out, "+-", "$\\pm$");
  boost::replace_all(out, "±", "$\\pm$");
  return out;
}

std::string latex_table(const std::vector<std::string>& header,
                        const std::vector<std::vector<std::string>>& rows) {
  const auto line = [](const std::vector<std::string>& cells) {
    std::vector<std::string> out;
    for (const std::string& cell : cells) out.push_back(escape_latex(cell));
    return fmt::format("{} \\\\\n", fmt::join(out, " & "));
  };
  std::string out = fmt::format("\\begin{{tabular}}{{{}}}\n\\hline\n{}\\hline\n",
                                std::string(header.size(), 'l'), line(header));
  for (const auto& row : rows) out += line(row);
  return out + "\\hline\n\\end{tabular}\n";
}

}  // namespace grainfield::coupling
