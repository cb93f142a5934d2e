#include "coupling/tasks/average_items.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/container_hash/hash.hpp>
#include <map>
#include <stdexcept>
#include <utility>

#include "coupling/averaging/contact_geometry.h"
#include "coupling/averaging/extent.h"
#include "coupling/averaging/upright.h"
#include "coupling/import/packing_warnings.h"
#include "coupling/store/added_forces.h"
#include "coupling/tasks/placement.h"
#include "dem/snapshot/added_forces_mark.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

dem::Vec3 usual_up(int dim) { return dem::Vec3::Unit(up_axis(dim)); }

// Which way is up in a packing.
dem::Vec3 up_for(const dem::Snapshot& s, const AverageRequest& request, const std::string& packing,
                 std::vector<std::string>& warnings) {
  const bool levels = request.rings || !request.cuts.empty();
  const char last = "xyz"[up_axis(s.dim)];
  if (request.frame == "packing" && !levels && request.up.empty()) {
    // Points are as they are given: up is asked for the load alone.
    if (!request.response) return usual_up(s.dim);
    const dem::Vec3 load = dem::total_applied_force(s);
    if (!(load.norm() > 0)) return usual_up(s.dim);
  }
  const dem::Vec3 up = up_of(s, request.up);
  if (up.isZero()) {
    if (request.frame == "heap") {
      throw std::invalid_argument(fmt::format(
          "{}: has no gravity, and a heap needs it: import --gravity keeps it with the packing",
          packing));
    }
    if (request.frame == "layer" && warnings.empty()) {  // of the first one
      warnings.push_back(fmt::format(
          "{}: neither gravity nor a load says which way is up; {} is taken (--up changes it)",
          packing, last));
    }
    return usual_up(s.dim);
  }
  if (request.frame == "packing" && levels && up != usual_up(s.dim)) {
    throw std::invalid_argument(fmt::format(
        "{}: in frame packing {} go by {}, and up is another axis; use --frame layer or heap",
        packing, request.rings ? "rings" : "cuts", last));
  }
  return up;
}

// Names of the request's snapshots, the first ones.
std::string groups_of(const AverageRequest& request) {
  constexpr std::size_t most = 6;
  std::string out;
  for (std::size_t k = 0; k < request.snapshots.size() && k < most; ++k)
    out += (k == 0 ? "" : ", ") + request.snapshots[k].group;
  return out + (request.snapshots.size() > most ? ", ..." : "");
}

// Refuses what makes an ensemble of one packing: copies, and states of the same realization.
class Independence {
 public:
  void add(const SnapshotName& name, const dem::Snapshot& s) {
    const std::string shown = name.file + ":" + name.group;
    const std::size_t at = name.group.rfind('/');
    if (at != std::string::npos && at > 0) {
      const std::string above = name.file + ":" + name.group.substr(0, at);
      const auto [first, own] = states_.emplace(above, name.group);
      if (!own) {
        throw std::invalid_argument(fmt::format(
            "{} and {}:{} are states of one packing, allowed: one state of each packing, as {}:{}",
            shown, name.file, first->second, name.file, name.group.substr(at + 1)));
      }
    }
    std::size_t places = s.grains.size();
    for (const dem::Grain& g : s.grains) {
      for (int a = 0; a < s.dim; ++a) boost::hash_combine(places, g.position[a]);
    }
    for (const dem::Contact& c : s.contacts) {
      for (int a = 0; a < s.dim; ++a) boost::hash_combine(places, c.force[a]);
    }
    const auto [first, own] = packings_.emplace(places, shown);
    if (own || s.grains.empty()) return;
    throw std::invalid_argument(
        fmt::format("{} is a copy of {}: places and forces are the same, allowed: every packing "
                    "once (a copy is no realization of its own)",
                    shown, first->second));
  }

 private:
  std::map<std::string, std::string> states_;
  std::map<std::size_t, std::string> packings_;
};

// Facts that make the averages of states mean nothing, or something unexpected.
void add_warnings(const SnapshotName& name, const dem::Snapshot& s, std::size_t idle,
                  PackingWarnings& out) {
  const std::string packing = name.file + ":" + name.group;
  out.add(2, packing, idle_text(idle));
  if (s.contacts.empty()) {
    out.add(0, packing, "has no contacts: stress and fabric are 0");
  } else {
    out.add(1, packing, tension_in(check_packing(s)));
  }
}

}  // namespace

// Pairs by what stands before "/loaded" and "/unloaded".
std::vector<AveragedItem> averaged_items(const AverageRequest& request) {
  std::vector<AveragedItem> out;
  if (!request.response) {
    for (const auto& name : request.snapshots) out.push_back({name, {}});
    return out;
  }
  std::map<std::string, std::pair<SnapshotName, SnapshotName>> pairs;
  std::vector<std::string> order;
  for (const auto& name : request.snapshots) {
    const std::size_t at = name.group.rfind('/');
    const std::string prefix =
        name.file + ":" + (at == std::string::npos ? "" : name.group.substr(0, at));
    const std::string last = at == std::string::npos ? name.group : name.group.substr(at + 1);
    if (pairs.find(prefix) == pairs.end()) order.push_back(prefix);
    if (last == "loaded") pairs[prefix].first = name;
    if (last == "unloaded") pairs[prefix].second = name;
  }
  for (const auto& prefix : order) {
    const auto& [loaded, unloaded] = pairs[prefix];
    if (loaded.file.empty() || unloaded.file.empty()) {
      throw std::invalid_argument(
          fmt::format("{}: --response needs the snapshots \"loaded\" and \"unloaded\"; {} is "
                      "missing; there: {} "
                      "(import --group NAME/unloaded and NAME/loaded name them so)",
                      prefix, loaded.file.empty() ? "loaded" : "unloaded", groups_of(request)));
    }
    out.push_back({loaded, unloaded});
  }
  return out;
}

// The item's packing as the frame sees it: in frame packing as it is.
std::shared_ptr<const dem::Snapshot> packing_in_frame(const SnapshotName& name,
                                                      const AveragedItem& item,
                                                      const AverageRequest& request) {
  const auto held = snapshot_of(name);
  return request.frame == "packing" ? held : upright(held, item.up);
}

AveragedExtents measure_items(std::vector<AveragedItem>& items, const AverageRequest& request,
                              std::vector<std::string>& warnings) {
  AveragedExtents out;
  PackingWarnings of_forces;
  Independence independence;
  const auto& wanted = request.options.quantities;
  const bool forces =
      wanted.empty() || std::find(wanted.begin(), wanted.end(), "sigma") != wanted.end();
  const auto n = static_cast<double>(items.size());
  for (AveragedItem& item : items) {
    std::size_t idle = 0;
    const auto read = snapshot_of(item.state, &idle);
    item.up = up_for(*read, request, item.state.file + ":" + item.state.group, warnings);
    const auto held = packing_in_frame(item.state, item, request);
    const dem::Snapshot& s = *held;
    if (&item != &items.front() && s.dim != out.dim)
      throw std::invalid_argument(
          fmt::format("{}:{} is {}D, the snapshot before it {}D; average "
                      "them apart",
                      item.state.file, item.state.group, s.dim, out.dim));
    out.dim = s.dim;
    independence.add(item.state, s);
    const Placement placed = place(s, request.frame);
    of_forces.add(3, item.state.file + ":" + item.state.group,
                  dem::added_forces_note(s.attributes));
    copy_added_forces(s, out.added_forces);
    if (forces) add_warnings(item.state, s, idle, of_forces);
    if (forces && request.response) {
      const auto unloaded = snapshot_of(item.unloaded, &idle);
      add_warnings(item.unloaded, *unloaded, idle, of_forces);
    }
    out.depth += placed.depth / n;
    out.least = std::min(out.least, placed.depth);
    out.most = std::max(out.most, placed.depth);
    out.diameter += mean_diameter(s) / n;
    out.left = std::max(out.left, placed.left);
    out.right = std::min(out.right, placed.right);
    out.front = std::max(out.front, placed.front);
    out.back = std::min(out.back, placed.back);
    if (request.frame == "heap") {
      out.heaps.push_back(placed.heap);
      if (!placed.heap.in_flight.empty()) {
        warnings.push_back(
            fmt::format("{}:{}: {}", item.state.file, item.state.group, placed.heap.in_flight));
      }
    }
    const double force = -dem::total_applied_force(*read).dot(item.up);
    if (request.response && &item != &items.front() && force != out.load) {
      throw std::invalid_argument(fmt::format(
          "{}:{}: its load is {:g} N, that of the others {:g} N; name those of one load, "
          "as FILE.h5:GROUP",
          item.state.file, item.state.group, force, out.load));
    }
    out.load = &item == &items.front() || force == out.load ? force : 0;
  }
  for (std::string& line : of_forces.lines("other")) warnings.push_back(std::move(line));
  if (out.most > kUnlikeHeights * out.least) {
    warnings.push_back(fmt::format(
        "packings {:.3g} to {:.3g} m high in one average{}: are they realizations of one?",
        out.least, out.most,
        request.frame == "heap" ? ", one averaging width in m for all" : ", points in m"));
  }
  if (request.response && out.load == 0) {
    warnings.push_back("no load is known: models of a load will want it (import --load ID=FX,FY)");
  }
  return out;
}

}  // namespace grainfield::coupling
