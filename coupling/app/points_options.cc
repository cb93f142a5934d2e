#include "coupling/app/points_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "coupling/app/points_csv.h"
#include "dem/snapshot/number.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

// Points of a grid; and on how many points and snapshots a field may be averaged, each value some
// hundred bytes.
constexpr double kMostPoints = 1e6, kMostNumbers = 1e7;
constexpr double kUsualPoints = 81 * 31;  // where neither points nor a grid are given

void parse_grid(const std::string& text, int& columns, int& rows, int& layers) {
  const auto whole = [](std::string_view part, int& number) {
    // Too many for an int are many.
    const bool digits = part.find_first_not_of("0123456789") == std::string_view::npos;
    const long long most = std::numeric_limits<int>::max();
    number = digits && !part.empty()
                 ? static_cast<int>(std::min(dem::parse_integer(part).value_or(most), most))
                 : 0;
    return number >= 2;
  };
  const std::string_view all = text;
  const std::size_t x = all.find('x'), second = x == all.npos ? x : all.find('x', x + 1);
  const bool three = second != all.npos;
  if (x == all.npos || !whole(all.substr(0, x), columns) ||
      !whole(all.substr(x + 1, three ? second - x - 1 : all.npos), rows) ||
      (three && !whole(all.substr(second + 1), layers))) {
    throw std::invalid_argument(
        fmt::format("--grid: found \"{}\", expected COLUMNSxROWS, both 2 or more{}", text,
                    three ? ", or COLUMNSxROWSxLAYERS" : ""));
  }
  const double points = static_cast<double>(columns) * rows * std::max(layers, 1);
  if (points > kMostPoints) {
    throw std::invalid_argument(fmt::format("--grid: found {}, {:.3g} points, allowed: up to {:g}",
                                            text, points, kMostPoints));
  }
}

}  // namespace

void PointsOptions::add_to(CLI::App& command) {
  command.add_option("--frame", frame,
                     "layer: load at 0,0, surface y = 0; heap: apex at 0,0, lengths over its "
                     "height; packing: as it is; in 3D z is up");
  command.add_option("--points", points, "CSV with columns x,y (3D: x,y,z) in the frame");
  command.add_option("--grid", grid,
                     "COLUMNSxROWS over the packing; default 81x31; 3D: COLUMNSxROWSxLAYERS");
}

Eigen::MatrixXd PointsOptions::read(const std::vector<SnapshotName>& snapshots) {
  if (!grid.empty()) parse_grid(grid, columns, rows, layers);
  Eigen::MatrixXd out;
  if (!points.empty()) {
    const SnapshotName& first = snapshots.front();
    out = rings ? read_rings_csv(points)
                : read_points_csv(points, dem::read_snapshot(first.file, first.group).dim);
  }
  const double places = !points.empty() ? static_cast<double>(out.rows())
                        : grid.empty()  ? kUsualPoints
                                        : static_cast<double>(columns) * rows * std::max(layers, 1);
  const auto many = static_cast<double>(snapshots.size());
  if (places * many > kMostNumbers) {
    throw std::invalid_argument(
        fmt::format("{}: found {:g} points for {:g} snapshots, allowed: up to {:g} together",
                    points.empty() ? "--grid" : "--points", places, many, kMostNumbers));
  }
  return out;
}

}  // namespace grainfield::coupling
