#include "coupling/import/outline_text.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "coupling/base/unit.h"
#include "coupling/import/lines.h"

namespace grainfield::coupling {

dem::Outline parse_outline(std::string_view text, int ten) {
  dem::Outline outline;
  std::vector<std::string_view> corners, numbers;
  split(text, ';', corners);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    split(corners[k], ' ', numbers);
    std::array<double, 2> corner{};
    bool good = numbers.size() == 2;
    for (std::size_t d = 0; good && d < 2; ++d) {
      const std::optional<double> number = times_ten(std::string(numbers[d]), ten);
      good = number && std::isfinite(*number);
      if (good) corner[d] = *number;
    }
    if (!good)
      throw std::invalid_argument(
          fmt::format("corner {} of the outline: found \"{}\", expected two finite numbers \"x y\"",
                      k + 1, corners[k]));
    outline.push_back(corner);
  }
  return outline;
}

}  // namespace grainfield::coupling
