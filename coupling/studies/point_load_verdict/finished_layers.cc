#include "coupling/studies/point_load_verdict/finished_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coupling/run/finished_runs.h"
#include "dem/snapshot/contact_changes.h"
#include "dem/snapshot/snapshot.h"
#include "dem/study/setup.h"

namespace grainfield::coupling {
namespace {

const std::vector<std::string> kStates{"unloaded", "loaded"};
constexpr const char* kStudy = "point-load";
constexpr double kSameForce = 1e-9;  // relative: numbers that went through a file

dem::RunResult finished_layer(const FinishedRun& place, double force) {
  const dem::Snapshot unloaded = dem::read_snapshot(place.file, place.group + "/unloaded");
  const dem::Snapshot loaded = dem::read_snapshot(place.file, place.group + "/loaded");
  const double found = -loaded.applied_force.y();
  if (!(std::fabs(found - force) <= kSameForce * force)) {
    throw std::invalid_argument(
        fmt::format("load.force: found {:g}, the layer {}:{} carries {:g} N", force, place.file,
                    place.group, found));
  }
  dem::RunResult out;
  out.snapshots = {{"unloaded", unloaded}, {"loaded", loaded}};
  auto& f = out.figures;
  f["dem.grains"] = static_cast<double>(std::count_if(
      unloaded.grains.begin(), unloaded.grains.end(), [](const auto& g) { return !g.fixed; }));
  f["load.force"] = found;
  f["base.response_over_load"] =
      (dem::base_force(loaded) - dem::base_force(unloaded)).y() / f["load.force"];
  const dem::ContactChanges c = dem::compare_contacts(unloaded, loaded);
  f["load.contacts_gained"] = c.gained;
  f["load.contacts_lost"] = c.lost;
  f["load.newly_sliding"] = c.newly_sliding;
  f["load.max_displacement_over_radius"] = c.max_displacement_over_radius;
  f["load.no_rearrangement"] = c.gained == 0 && c.lost == 0 ? 1 : 0;
  return out;
}

}  // namespace

std::unique_ptr<dem::Run> make_finished_layer_run(const Case& value, std::int64_t number) {
  return run_of(finished_layer(finished_run(value, number, kStates, kStudy),
                               value.get<dem::PointLoadSetup>().load.force));
}

void try_finished_layers(const Case& value) {
  try_finished_runs(value, kStates, kStudy, [&](const FinishedRun& layer) {
    finished_layer(layer, value.get<dem::PointLoadSetup>().load.force);
  });
}

std::string unused_layers(const Case& value) { return unused_runs(value, kStates, kStudy); }

}  // namespace grainfield::coupling
