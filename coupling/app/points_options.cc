#include "coupling/app/points_options.h"

#include "coupling/app/points_csv.h"
#include "coupling/files/places.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
void PointsOptions::add_to(CLI::App& command) {
  command.add_option("--frame", frame,
                     "layer: load at 0,0, surface y = 0; heap: apex at 0,0, lengths over its "
                     "height, both with the last axis up; packing: as it is");
  command.add_option("--up", up,
                     "x | -x | y | -y | z | -z: up in the packing's axes; default against its "
                     "gravity, or its load");
  command.add_option("--points", points, "CSV with columns x,y (3D: x,y,z) in the frame");
  command.add_option("--grid", grid,
                     "COLUMNSxROWS over the packing; default 81x31; 3D: COLUMNSxROWSxLAYERS");
}

Eigen::MatrixXd PointsOptions::read(const std::vector<SnapshotName>& snapshots) {
  GridSize size;
  if (!grid.empty()) size = parse_grid(grid);
  columns = size.columns;
  rows = size.rows;
  layers = size.layers;
  Eigen::MatrixXd out;
  if (!points.empty()) {
    const SnapshotName& first = snapshots.front();
    out = rings ? read_rings_csv(points)
                : read_points_csv(points, dem::read_snapshot(first.file, first.group).dim);
  }
  require_few_places(static_cast<double>(out.rows()), size, static_cast<double>(snapshots.size()));
  return out;
}

}  // namespace grainfield::coupling
