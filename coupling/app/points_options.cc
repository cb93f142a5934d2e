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

void parse_grid(const std::string& text, int& columns, int& rows) {
  const auto whole = [](std::string_view part, int& number) {
    // Too many for an int are many.
    const bool digits = part.find_first_not_of("0123456789") == std::string_view::npos;
    const long long most = std::numeric_limits<int>::max();
    number = digits && !part.empty()
                 ? static_cast<int>(std::min(dem::parse_integer(part).value_or(most), most))
                 : 0;
    return number >= 2;
  };
  const std::size_t x = text.find('x');
  if (x == std::string::npos || !whole(std::string_view(text).substr(0, x), columns) ||
      !whole(std::string_view(text).substr(x + 1), rows)) {
    throw std::invalid_argument(
        fmt::format("--grid: found \"{}\", expected COLUMNSxROWS, both 2 or more", text));
  }
  if (static_cast<double>(columns) * rows > kMostPoints) {
    throw std::invalid_argument(fmt::format("--grid: found {}, {:.3g} points, allowed: up to {:g}",
                                            text, static_cast<double>(columns) * rows,
                                            kMostPoints));
  }
}

}  // namespace

void PointsOptions::add_to(CLI::App& command) {
  command.add_option("--frame", frame,
                     "layer: load at 0,0, surface y = 0; heap: apex at 0,0, lengths over its "
                     "height; packing: as it is");
  command.add_option("--points", points, "CSV with columns x,y (3D: x,y,z) in the frame");
  command.add_option("--grid", grid, "COLUMNSxROWS over the packing; default 81x31");
}

Eigen::MatrixXd PointsOptions::read(const std::vector<SnapshotName>& snapshots) {
  if (!grid.empty()) parse_grid(grid, columns, rows);
  Eigen::MatrixXd out;
  if (!points.empty()) {
    const SnapshotName& first = snapshots.front();
    out = read_points_csv(points, dem::read_snapshot(first.file, first.group).dim);
  }
  const double places =
      points.empty() ? static_cast<double>(columns) * rows : static_cast<double>(out.rows());
  const auto many = static_cast<double>(snapshots.size());
  if (places * many > kMostNumbers) {
    throw std::invalid_argument(
        fmt::format("{}: found {:g} points for {:g} snapshots, allowed: up to {:g} together",
                    points.empty() ? "--grid" : "--points", places, many, kMostNumbers));
  }
  return out;
}

}  // namespace grainfield::coupling
