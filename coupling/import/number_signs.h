// What commas and points mean in the numbers of a table of text.
#pragma once
#include <string>
#include <string_view>

#include "coupling/import/table.h"

namespace grainfield::coupling {

/// Whether it is a number once its one comma is a point: "0,05".
bool is_decimal_comma(std::string_view value);

/// "51,223", "1,234,567": three digits behind each sign, and one to three before, of which the
/// first is not 0.
bool is_in_thousands(std::string_view value, char sign);

struct NumberSigns {
  char thousands = 0;           ///< 0: no number has a sign of thousands beside one of decimals
  bool decimal_commas = false;  ///< else points
  std::string doubt;            ///< why they may part thousands, a sentence; empty: no doubt
};
/// Signs of the table's first rows. Commas are decimal where no number has a point; beside
/// separating commas they stand in quotation marks.
NumberSigns number_signs(Lines& lines, const ForeignTable& table);

}  // namespace grainfield::coupling
