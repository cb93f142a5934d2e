#include "coupling/run/average_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <stdexcept>

#include "coupling/averaging/base.h"
#include "coupling/averaging/ensemble.h"
#include "coupling/averaging/kernel.h"
#include "coupling/averaging/layer.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

// A state, or with a response the loaded state and the unloaded one.
struct Item {
  SnapshotName state, unloaded;
};

// Pairs by what stands before "/loaded" and "/unloaded".
std::vector<Item> items_of(const AverageRequest& request) {
  std::vector<Item> out;
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
      throw std::invalid_argument(fmt::format(
          "{}: --response needs the snapshots \"loaded\" and \"unloaded\"; {} is missing", prefix,
          loaded.file.empty() ? "loaded" : "unloaded"));
    }
    out.push_back({loaded, unloaded});
  }
  return out;
}

dem::Snapshot read(const SnapshotName& name) { return dem::read_snapshot(name.file, name.group); }

}  // namespace

std::vector<SnapshotName> parse_snapshot_names(const std::vector<std::string>& texts) {
  std::vector<SnapshotName> out;
  for (const auto& text : texts) {
    const std::size_t at = text.rfind(':');
    if (at != std::string::npos && !std::filesystem::exists(text)) {
      out.push_back({text.substr(0, at), text.substr(at + 1)});
      continue;
    }
    const auto groups = dem::list_snapshots(text);
    if (groups.empty()) throw std::invalid_argument(text + ": holds no snapshot");
    for (const auto& group : groups) out.push_back({text, group});
  }
  return out;
}

NamedFields average_files(AverageRequest request) {
  const std::vector<Item> items = items_of(request);
  if (items.empty()) throw std::invalid_argument("no snapshot to average");
  // The layers as one rectangle in the models' frame.
  double depth = 0, half = std::numeric_limits<double>::infinity(), diameter = 0, load = 0;
  const auto n = static_cast<double>(items.size());
  for (const auto& item : items) {
    const dem::Snapshot s = read(item.state);
    const LayerFrame frame = layer_frame(s);
    depth += frame.depth() / n;
    diameter += mean_diameter(s) / n;
    half = std::min({half, frame.load_x - frame.left, frame.right - frame.load_x});
    const double force = -s.applied_force.y();
    if (request.response && &item != &items.front() && force != load) {
      throw std::invalid_argument(
          fmt::format("{}:{}: its load is {:g} N, that of the others {:g} N", item.state.file,
                      item.state.group, force, load));
    }
    load = &item == &items.front() || force == load ? force : 0;
  }
  AverageOptions& options = request.options;
  if (options.width == 0) {
    options.width = (options.method == "particle_centre" ? 2.5 : 1.0) * diameter;
  }
  const bool grid = request.points.size() == 0;
  const Eigen::MatrixXd points =
      grid ? grid_points(-half, half, request.nx, -depth, 0, request.ny) : request.points;
  const bool base = request.response && options.method == "coarse_graining";
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(request.nx, -half, half);
  const auto finish = [&](Field field) {
    field.attributes["method"] = options.method;
    field.attributes["kernel"] = options.kernel;
    field.attributes["width"] = fmt::format("{}", options.width);
    field.attributes["h"] = fmt::format("{}", depth);
    if (load > 0) field.attributes["F"] = fmt::format("{}", load);
    field.attributes["frame"] = "models: load at (0, 0), surface y = 0";
    return field;
  };

  Ensemble fields, base_fields;
  for (const auto& item : items) {
    const dem::Snapshot state = read(item.state);
    const LayerFrame frame = layer_frame(state);
    const Eigen::MatrixXd there = frame.to_packing(points);
    Field field = request.response ? response(read(item.unloaded), state, there, options)
                                   : average(state, there, options);
    field.points = points;
    field.nx = grid ? request.nx : 0;
    field.ny = grid ? request.ny : 0;
    fields.add(field);
    if (base) {
      Field line = base_response(read(item.unloaded), state, x.array() + frame.load_x,
                                 *make_kernel(options.kernel, options.width));
      line.points.resize(x.size(), 2);
      line.points << x, Eigen::VectorXd::Constant(x.size(), -depth);
      base_fields.add(line);
    }
  }
  NamedFields out;
  out.emplace_back(request.response ? "response" : "average", finish(fields.mean()));
  if (base) out.emplace_back("base_response", finish(base_fields.mean()));
  return out;
}

}  // namespace grainfield::coupling
