// info: what an HDF5 file of ours holds.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <set>

#include "coupling/app/commands.h"
#include "coupling/app/terminal.h"
#include "coupling/store/field_io.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

void show_snapshot(const std::string& file, const std::string& group) {
  const dem::Snapshot s = dem::read_snapshot(file, group);
  std::size_t fixed = 0;
  for (const auto& g : s.grains) fixed += g.fixed ? 1 : 0;
  say("snapshot {}: {}D, {} grains ({} fixed), {} contacts, {} walls, time {:g} s\n", group, s.dim,
      s.grains.size(), fixed, s.contacts.size(), s.walls.size(), s.time);
  if (s.cell.is_periodic()) say("  {}\n", cell_text(s.cell));
  std::set<std::string> materials;
  for (const auto& g : s.grains) materials.insert(g.material);
  for (const auto& w : s.walls) materials.insert(w.material);
  materials.erase("");
  if (!materials.empty()) say("  materials: {}\n", fmt::join(materials, ", "));
  for (const auto& w : s.walls) {
    if (w.shape != "plane") say("  wall {}: {}\n", w.name, w.shape);
  }
  say("  units: m, s, kg, N, rad{}\n", s.dim == 2 ? "; volume m2" : "; volume m3");
  if (s.loaded_grain >= 0) {
    say("  load on grain {}: {:g} {:g} {:g} N\n", s.loaded_grain, s.applied_force.x(),
        s.applied_force.y(), s.applied_force.z());
  }
  for (const auto& [name, value] : s.attributes) {
    if (name.compare(0, 7, "figure:") != 0) say("  {}: {}\n", name, value);
  }
  for (const auto& [name, table] : s.tables) {
    std::vector<std::string> columns;
    for (const dem::NumberColumn& c : table) {
      columns.push_back(c.unit.empty() || c.unit == "1" ? c.name : c.name + " (" + c.unit + ")");
    }
    say("  table {}, {} rows: {}\n", name, table.empty() ? 0 : table.front().values.size(),
        fmt::join(columns, ", "));
  }
}

void show_field(const std::string& file, const std::string& name) {
  const Field f = read_field(file, name);
  say("field {}: {} points in {}D{}, {} realization{}\n", name, f.points.rows(), f.points.cols(),
      f.nx == 0  ? ""
      : f.nz > 0 ? fmt::format(" (grid {} x {} x {})", f.nx, f.ny, f.nz)
                 : fmt::format(" (grid {} x {})", f.nx, f.ny),
      f.realizations, f.realizations == 1 ? "" : "s");
  for (const auto& column : f.columns) say("  {} ({})\n", column.name, column.unit);
  for (const auto& [key, value] : f.attributes) say("  {}: {}\n", key, attribute_text(value));
}

}  // namespace

void add_info(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("info", "what a snapshot or field file holds");
  auto file = std::make_shared<std::string>();
  command->add_option("file", *file, "HDF5 file")->required();
  command->callback([=, &action] {
    action = [=] {
      const auto snapshots = dem::list_snapshots(*file);
      const auto fields = list_fields(*file);
      if (snapshots.empty() && fields.empty()) {
        throw std::invalid_argument(*file +
                                    ": holds no snapshot and no field of grainfield (import and "
                                    "import-field make them of other files)");
      }
      for (const auto& group : snapshots) show_snapshot(*file, group);
      for (const auto& name : fields) show_field(*file, name);
      return 0;
    };
  });
}

}  // namespace grainfield::coupling
