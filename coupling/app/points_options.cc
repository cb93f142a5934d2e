#include "coupling/app/points_options.h"

#include <fmt/format.h>

#include <stdexcept>

#include "coupling/app/points_csv.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

void parse_grid(const std::string& text, int& columns, int& rows) {
  const std::size_t x = text.find('x');
  try {
    std::size_t used = 0;
    columns = std::stoi(text, &used);
    if (used != x) throw std::invalid_argument("");
    rows = std::stoi(text.substr(x + 1), &used);
    if (used + x + 1 != text.size() || columns < 2 || rows < 2) throw std::invalid_argument("");
  } catch (const std::exception&) {
    throw std::invalid_argument(
        fmt::format("--grid: found \"{}\", expected COLUMNSxROWS, both 2 or more", text));
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

Eigen::MatrixXd PointsOptions::read(const SnapshotName& snapshot) {
  if (!grid.empty()) parse_grid(grid, columns, rows);
  if (points.empty()) return {};
  return read_points_csv(points, dem::read_snapshot(snapshot.file, snapshot.group).dim);
}

}  // namespace grainfield::coupling
