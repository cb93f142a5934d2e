#include "coupling/app/options.h"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "coupling/app/points_csv.h"
#include "coupling/base/unit.h"
#include "coupling/tasks/placement.h"
#include "dem/shared/number.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

std::string unit_complaint(const std::string& text, const OptionUnits& quantity) {
  return fmt::format("found \"{}\", expected {}, or with its unit, \"{}\"", text, quantity.meaning,
                     quantity.example);
}

CLI::Validator in_si_units(const OptionUnits& quantity) {
  return CLI::Validator(
      [quantity](std::string& text) -> std::string {
        if (text.find(' ') == std::string::npos && parse_number(text)) return "";
        const std::optional<double> value = parse_quantity(text, quantity.units);
        if (!value) return unit_complaint(text, quantity);
        text = fmt::format("{}", *value);
        return "";
      },
      "");
}

}  // namespace

OptionUnits option_length() { return {{"m"}, "a length in m", "80 mm"}; }
OptionUnits option_angle() { return {{"deg"}, "an angle in degrees", "0.5 rad"}; }
OptionUnits option_force() { return {{"N"}, "a force in N", "2 kN"}; }
OptionUnits option_time() { return {{"s"}, "a time in s", "2 us"}; }

OptionUnits weight_per_volume(int dim) {
  if (dim == 3) return {{"N/m3"}, "a weight per volume in N/m3", "15 kN/m3"};
  return {{"N/m3", "N/m2"}, "a weight per volume in N/m3 (2D: N/m2)", "15 kN/m3"};
}

OptionUnits mass_per_volume() {
  return {{"kg/m3", "kg/m2"}, "a density in kg/m3 (2D: kg/m2)", "2.5 g/cm3"};
}

double quantity_of(const std::string& name, const std::string& text, const OptionUnits& quantity) {
  const std::optional<double> value = parse_quantity(text, quantity.units);
  if (!value) throw std::invalid_argument(name + ": " + unit_complaint(text, quantity));
  return *value;
}

CLI::Option* add_quantity(CLI::App& command, const std::string& name, double& to,
                          const OptionUnits& quantity, const std::string& meaning) {
  return command.add_option(name, to, meaning)->transform(in_si_units(quantity));
}

CLI::Option* add_quantities(CLI::App& command, const std::string& name, std::vector<double>& to,
                            const OptionUnits& quantity, const std::string& meaning) {
  return command.add_option(name, to, meaning)->delimiter(',')->transform(in_si_units(quantity));
}

namespace {

constexpr int kMostThreads = 1024;

std::string complaint(const std::string& text) {
  const std::optional<long long> threads = parse_integer(text);
  const bool good = threads && *threads >= 1 && *threads <= kMostThreads;
  return good ? "" : fmt::format("found {}, allowed: 1 to {}", text, kMostThreads);
}

}  // namespace

void add_threads(CLI::App& command, int& threads, const std::string& meaning) {
  command.add_option("--threads", threads, meaning)->check(CLI::Validator(complaint, ""));
}

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
