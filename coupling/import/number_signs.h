// What commas and points mean in the numbers of a table of text.
#pragma once
#include <string>
#include <string_view>

#include "coupling/import/table.h"

namespace grainfield::coupling {

/// Whether it is a number once its one comma is a point: "0,05".
bool is_decimal_comma(std::string_view value);

struct NumberSigns {
  bool decimal_commas = false;
  std::string doubt;  ///< why they may part thousands, a sentence; empty: no doubt
};
/// Of the first rows of the table. Commas are those of decimals where no number has a point; beside
/// separating commas they stand in quotation marks.
NumberSigns number_signs(Lines& lines, const ForeignTable& table);

}  // namespace grainfield::coupling
