#include "coupling/fit/finished_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "dem/snapshot/snapshot.h"
#include "dem/study/contact_changes.h"

namespace grainfield::coupling {
namespace {

constexpr double kSameForce = 1e-9;  // relative: numbers that went through a file

struct Place {
  std::string file, group;
};

std::vector<Place> places(const std::vector<std::string>& files) {
  constexpr std::string_view name = "/loaded";
  std::vector<Place> out;
  for (const std::string& file : files) {
    const std::size_t before = out.size();
    std::vector<std::string> groups;
    try {
      groups = dem::list_snapshots(file);
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(std::string("grains.files: ") + e.what());
    }
    for (const std::string& group : groups) {
      if (group.size() < name.size()) continue;
      const std::string above = group.substr(0, group.size() - name.size());
      if (group.substr(above.size()) == name &&
          std::find(groups.begin(), groups.end(), above + "/unloaded") != groups.end()) {
        out.push_back({file, above});
      }
    }
    if (out.size() == before) {
      throw std::invalid_argument(fmt::format(
          "grains.files: {} holds no snapshots named unloaded and loaded, expected snapshots.h5 of "
          "a run of study point-load",
          file));
    }
  }
  return out;
}

class FinishedLayer final : public dem::Run {
 public:
  FinishedLayer(const Place& place, double force)
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
  const std::vector<Place> there = places(value.grains.files);
  const auto count = static_cast<std::int64_t>(there.size());
  if (value.ensemble.realizations > count) {
    throw std::invalid_argument(fmt::format(
        "ensemble.realizations: found {}, allowed: up to {}, the layers in grains.files",
        value.ensemble.realizations, count));
  }
  return std::make_unique<FinishedLayer>(there[static_cast<std::size_t>(number)],
                                         value.layer.load.force);
}

}  // namespace grainfield::coupling
