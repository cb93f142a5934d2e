// CSV text: the one place that joins cells.
#pragma once
#include <concepts>
#include <ranges>
#include <string>
#include <string_view>

namespace grainfield::coupling {

/// Rows of cells with commas between them, after lines of comment.
class Csv {
 public:
  static constexpr int kAllDigits = 0;  ///< as many as give the same double back
  /// Numbers are written with so many significant digits.
  explicit Csv(int digits = 9) : digits_(digits) {}

  /// "# text"; a text without an end of line.
  Csv& comment(std::string_view text);
  /// Cells: texts, quoted where they must be; numbers, a nan without a sign; truth as 0 or 1; and
  /// lists of these.
  template <class... Cells>
  Csv& row(const Cells&... cells) {
    (add(cells), ...);
    return end_row();
  }
  /// Cells of a row that end_row() ends.
  template <class Cell>
  Csv& add(const Cell& cell) {
    if constexpr (std::convertible_to<Cell, std::string_view>)
      put(std::string_view(cell));
    else if constexpr (std::floating_point<Cell>)
      put(cell);
    else if constexpr (std::integral<Cell>)
      put(static_cast<long long>(cell));
    else
      for (const auto& one : cell) add(one);
    return *this;
  }
  Csv& end_row();

  const std::string& text() const { return text_; }

 private:
  void put(std::string_view cell);
  void put(double cell);
  void put(long long cell);
  void separate();

  int digits_;
  bool in_row_ = false;
  std::string text_;
};

/// "name_unit", the name alone for pure numbers ("1", "-" or empty).
std::string csv_heading(const std::string& name, const std::string& unit);

}  // namespace grainfield::coupling
