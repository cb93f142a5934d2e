#include "coupling/studies/point_load/finished_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coupling/run/ensemble.h"
#include "coupling/run/finished_runs.h"
#include "coupling/studies/point_load/layer_figures.h"
#include "coupling/studies/point_load/simulation.h"
#include "dem/snapshot/contact_changes.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

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
  f["base.response_over_load"] = (dem::base_force(loaded) - dem::base_force(unloaded)).y() / found;
  dem::add_contact_changes(unloaded, loaded, f);
  return out;
}

double force_of(const Case& value) { return value.get<dem::PointLoadSetup>().load.force; }

}  // namespace

std::unique_ptr<dem::Run> make_layer(const Case& value, std::int64_t number, int threads) {
  if (!value.get<GrainFiles>().files.empty()) {
    return run_of(
        finished_layer(finished_run(value, number, kLayerStates, kLayerStudy), force_of(value)));
  }
  return dem::make_point_load_run(value.get<dem::PointLoadSetup>(), realization_seed(value, number),
                                  threads);
}

dem::Outlook foresee_layer(const Case& value, std::int64_t draws) {
  if (value.get<GrainFiles>().files.empty()) {
    return dem::foresee_point_load(value.get<dem::PointLoadSetup>(), realization_seeds(value),
                                   draws);
  }
  try_finished_runs(value, kLayerStates, kLayerStudy,
                    [&](const FinishedRun& layer) { finished_layer(layer, force_of(value)); });
  return {};
}

}  // namespace grainfield::coupling
