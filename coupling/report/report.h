// A self-contained HTML page made of sections: pictures, tables and text. Studies build a Report;
// write_report draws the pictures with gnuplot and puts everything into one file.
#pragma once
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "coupling/report/picture.h"
#include "coupling/result/text_table.h"

namespace grainfield::coupling {

struct Text {
  std::string title;     ///< heading, or empty
  std::string body;      ///< plain text; an empty line starts a paragraph
  bool verdict = false;  ///< shown large
  bool doubt = false;    ///< in a box of its own colour
};

using Section = std::variant<Text, Picture, Table>;

struct Report {
  std::string title, subtitle;
  std::vector<Section> sections;
};

/// Names and values, for a table of two columns.
using ReportRows = std::vector<std::pair<std::string, std::string>>;
/// Adds that table; without rows nothing.
void add_rows(Report& report, const std::string& title, const ReportRows& rows,
              const std::string& caption = "");

/// What became of the pictures.
struct ReportResult {
  int pictures = 0;  ///< drawn
  int missing = 0;   ///< that could not be drawn
  std::string
      why_missing;  ///< of the last of these, such as "gnuplot not found: install gnuplot-nox"

  /// "report.html: 2 of 5 pictures are missing: WHY"; empty when all are there.
  std::string complaint() const;
};

/// Writes the page complete or not at all. Pictures that cannot be drawn are replaced by the
/// reason.
ReportResult write_report(const std::string& file, const Report& report);

}  // namespace grainfield::coupling
