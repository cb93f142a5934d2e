// The options by which average and strain are told where.
#pragma once
#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <string>

#include "coupling/files/average_files.h"

namespace grainfield::coupling {

struct PointsOptions {
  std::string frame = "layer", up, points, grid;
  int columns = 0, rows = 0, layers = 0;  ///< 0 where --grid does not say
  bool rings = false;                     ///< points are radius and height

  void add_to(CLI::App& command);
  /// Reads --grid, and the file of --points if one is given (else no rows), with the axes of the
  /// snapshot. Throws std::invalid_argument.
  Eigen::MatrixXd read(const std::vector<SnapshotName>& snapshots);
};

}  // namespace grainfield::coupling
