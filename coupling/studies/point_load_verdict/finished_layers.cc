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

class FinishedLayer final : public dem::Run {
 public:
  FinishedLayer(const FinishedRun& place, double force)
      : unloaded_(dem::read_snapshot(place.file, place.group + "/unloaded")),
        loaded_(dem::read_snapshot(place.file, place.group + "/loaded")) {
    const double found = -loaded_.applied_force.y();
    if (!(std::fabs(found - force) <= kSameForce * force)) {
      throw std::invalid_argument(
          fmt::format("load.force: found {:g}, the layer {}:{} carries {:g} N", force, place.file,
                      place.group, found));
    }
  }
  void advance(long) override {}
  bool done() const override { return true; }
  dem::Progress progress() const override {
    dem::Progress out;
    out.phase = "from a file";
    out.fraction = 1;
    return out;
  }
  // There is nothing to save: the file is there.
  void save(const std::string&) const override {}
  void restore(const std::string&) override {}
  dem::RunResult result() const override {
    dem::RunResult out;
    out.snapshots = {{"unloaded", unloaded_}, {"loaded", loaded_}};
    auto& f = out.figures;
    f["dem.grains"] = static_cast<double>(std::count_if(
        unloaded_.grains.begin(), unloaded_.grains.end(), [](const auto& g) { return !g.fixed; }));
    f["load.force"] = -loaded_.applied_force.y();
    f["base.response_over_load"] =
        (dem::base_force(loaded_) - dem::base_force(unloaded_)).y() / f["load.force"];
    const dem::ContactChanges c = dem::compare_contacts(unloaded_, loaded_);
    f["load.contacts_gained"] = c.gained;
    f["load.contacts_lost"] = c.lost;
    f["load.newly_sliding"] = c.newly_sliding;
    f["load.max_displacement_over_radius"] = c.max_displacement_over_radius;
    f["load.no_rearrangement"] = c.gained == 0 && c.lost == 0 ? 1 : 0;
    return out;
  }

 private:
  dem::Snapshot unloaded_, loaded_;
};

}  // namespace

std::unique_ptr<dem::Run> make_finished_layer_run(const Case& value, std::int64_t number) {
  return std::make_unique<FinishedLayer>(finished_run(value, number, kStates, kStudy),
                                         value.get<dem::PointLoadSetup>().load.force);
}

void try_finished_layers(const Case& value) {
  try_finished_runs(value, kStates, kStudy, [&](const FinishedRun& layer) {
    FinishedLayer(layer, value.get<dem::PointLoadSetup>().load.force);
  });
}

std::string unused_layers(const Case& value) { return unused_runs(value, kStates, kStudy); }

}  // namespace grainfield::coupling
