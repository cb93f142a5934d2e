#include "coupling/studies/point_load/finished_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coupling/run/ensemble.h"
#include "coupling/studies/point_load/layer_figures.h"
#include "coupling/studies/point_load/simulation.h"
#include "dem/snapshot/contact_changes.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

constexpr double kSame = 1e-9;  // relative: numbers that went through a file

// Throws where the layer was made with another number of this key.
void require_same(const char* key, double asked, double found, const FinishedRun& place) {
  if (std::fabs(asked - found) <= kSame * std::fabs(found)) return;
  throw std::invalid_argument(fmt::format("{}: found {:g}, the layer {}:{} has {:g}", key, asked,
                                          place.file, place.group, found));
}

dem::RunResult finished_layer(const FinishedRun& place, const dem::PointLoadSetup& setup) {
  const dem::Snapshot unloaded = dem::read_snapshot(place.file, place.group + "/unloaded");
  const dem::Snapshot loaded = dem::read_snapshot(place.file, place.group + "/loaded");
  const double force = setup.load.force, found = -loaded.applied_force.y();
  if (!(std::fabs(found - force) <= kSame * force)) {
    throw std::invalid_argument(
        fmt::format("load.force: found {:g}, the layer {}:{} carries {:g} N", force, place.file,
                    place.group, found));
  }
  require_same_material(setup.material, unloaded, place);
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

}  // namespace

void require_same_material(const dem::MaterialSetup& asked, const dem::Snapshot& layer,
                           const FinishedRun& place) {
  require_same("material.gravity", asked.gravity, layer.gravity.norm(), place);
  for (const dem::Grain& g : layer.grains) {
    if (g.fixed || !(g.volume > 0)) continue;
    require_same("material.density", asked.density, g.mass / g.volume, place);
    break;
  }
  for (const dem::Contact& c : layer.contacts) {
    if (c.j < 0) continue;
    require_same("material.friction", asked.friction, c.friction, place);
    break;
  }
}

std::unique_ptr<dem::Run> make_layer(const Case& value, std::int64_t number, int threads) {
  if (!value.get<GrainFiles>().files.empty()) {
    return run_of(finished_layer(finished_run(value, number, kLayerStates, kLayerStudy),
                                 value.get<dem::PointLoadSetup>()));
  }
  return dem::make_point_load_run(value.get<dem::PointLoadSetup>(), realization_seed(value, number),
                                  threads);
}

dem::Outlook foresee_layer(const Case& value, std::int64_t draws) {
  if (value.get<GrainFiles>().files.empty()) {
    return dem::foresee_point_load(value.get<dem::PointLoadSetup>(), realization_seeds(value),
                                   draws);
  }
  try_finished_runs(value, kLayerStates, kLayerStudy, [&](const FinishedRun& layer) {
    finished_layer(layer, value.get<dem::PointLoadSetup>());
  });
  return {};
}

}  // namespace grainfield::coupling
