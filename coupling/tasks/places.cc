#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "coupling/tasks/placement.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

// Points of a grid; and on how many points and snapshots a field may be averaged, each value some
// hundred bytes.
constexpr double kMostPoints = 1e6, kMostNumbers = 1e7;
constexpr double kUsualPoints = 81 * 31;  // where neither points nor a grid are given

double points_of(const GridSize& grid) {
  return static_cast<double>(grid.columns) * grid.rows * std::max(grid.layers, 1);
}

}  // namespace

GridSize parse_grid(const std::string& text) {
  GridSize out;
  const auto whole = [](std::string_view part, int& number) {
    // Too many for an int are many.
    const bool digits = part.find_first_not_of("0123456789") == std::string_view::npos;
    const long long most = std::numeric_limits<int>::max();
    number = digits && !part.empty()
                 ? static_cast<int>(std::min(parse_integer(part).value_or(most), most))
                 : 0;
    return number >= 2;
  };
  const std::string_view all = text;
  const std::size_t x = all.find('x'), second = x == all.npos ? x : all.find('x', x + 1);
  const bool three = second != all.npos;
  if (x == all.npos || !whole(all.substr(0, x), out.columns) ||
      !whole(all.substr(x + 1, three ? second - x - 1 : all.npos), out.rows) ||
      (three && !whole(all.substr(second + 1), out.layers))) {
    throw std::invalid_argument(
        fmt::format("--grid: found \"{}\", expected COLUMNSxROWS, both 2 or more{}", text,
                    three ? ", or COLUMNSxROWSxLAYERS" : ""));
  }
  if (points_of(out) > kMostPoints) {
    throw std::invalid_argument(fmt::format("--grid: found {}, {:.3g} points, allowed: up to {:g}",
                                            text, points_of(out), kMostPoints));
  }
  return out;
}

void require_few_places(double points, const GridSize& grid, double snapshots) {
  const double places = points > 0 ? points : grid.columns == 0 ? kUsualPoints : points_of(grid);
  if (places * snapshots > kMostNumbers) {
    throw std::invalid_argument(
        fmt::format("{}: found {:g} points for {:g} snapshots, allowed: up to {:g} together",
                    points > 0 ? "--points" : "--grid", places, snapshots, kMostNumbers));
  }
}

}  // namespace grainfield::coupling
