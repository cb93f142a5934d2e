// Options that several commands have: numbers with a unit, threads, and where a field is wanted.
#pragma once
#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/app/commands.h"
#include "coupling/tasks/average_task.h"

namespace grainfield::coupling {

struct OptionUnits {
  std::vector<std::string> units;  ///< its kinds; a number without unit is in SI, of angles degrees
  std::string meaning;             ///< for messages: "a length in m"
  std::string example;             ///< "80 mm"
};

OptionUnits option_length();
OptionUnits option_angle();
OptionUnits option_force();
OptionUnits option_time();
/// Units of grains, in the plane per area too: where lengths across count as 1 m.
OptionUnits weight_per_volume(int dim);
OptionUnits mass_per_volume();

/// Throws std::invalid_argument "NAME: found ..., expected a length in m, or with its unit ...".
double quantity_of(const std::string& name, const std::string& text, const OptionUnits& quantity);

/// An option that is such a quantity: a number, or one with its unit, "80 mm"; of lists each.
CLI::Option* add_quantity(CLI::App& command, const std::string& name, double& to,
                          const OptionUnits& quantity, const std::string& meaning);
CLI::Option* add_quantities(CLI::App& command, const std::string& name, std::vector<double>& to,
                            const OptionUnits& quantity, const std::string& meaning);

/// Adds --threads, from 1 to 1024; without it `threads` stays as it is.
void add_threads(CLI::App& command, int& threads, const std::string& meaning);

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
