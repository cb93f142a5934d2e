// Tables of text for Markdown and LaTeX.
#pragma once
#include <string>
#include <vector>

namespace grainfield::coupling {

/// A table as every page and file shows it.
struct Table {
  std::string title, caption;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> meanings = {};  ///< of the columns, as a page shows under the pointer
};

/// Columns are padded to one width, so that the text is a table on a terminal too.
std::string markdown_table(const std::vector<std::string>& header,
                           const std::vector<std::vector<std::string>>& rows);
/// The same without padding: of generated pages, a changed row changes its own line alone.
std::string plain_markdown_table(const std::vector<std::string>& header,
                                 const std::vector<std::vector<std::string>>& rows);
/// A tabular environment with left-aligned columns.
std::string latex_table(const std::vector<std::string>& header,
                        const std::vector<std::vector<std::string>>& rows);
/// The text with LaTeX's special characters escaped; "+-" and "±" become \pm.
std::string escape_latex(const std::string& text);

}  // namespace grainfield::coupling
