#include "coupling/run/average_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>

#include "coupling/averaging/base.h"
#include "coupling/averaging/ensemble.h"
#include "coupling/averaging/kernel.h"
#include "coupling/averaging/layer.h"
#include "coupling/averaging/nearest.h"
#include "coupling/averaging/region.h"
#include "coupling/run/pile_frame.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

const std::vector<std::string> frames{"layer", "heap", "packing"};

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

// The packings of all snapshots, as one.
struct Extents {
  double depth = 0, left = -std::numeric_limits<double>::infinity(),
         right = std::numeric_limits<double>::infinity(), diameter = 0, load = 0;
  int dim = 2;
  std::vector<PileFrame> heaps;  // frame "heap" only
};

// From the request's frame to the packing's axes, and the extents in the request's frame.
struct Placed {
  std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)> to_packing;
  double left = 0, right = 0, depth = 0;
  PileFrame heap = {};  // frame "heap" only
};

Placed place(const dem::Snapshot& s, const std::string& frame) {
  if (frame == "packing" && s.dim == 3) return {[](const auto& points) { return points; }, 0, 0, 0};
  const LayerFrame layer = layer_frame(s);
  if (frame == "heap") {
    const PileFrame heap = pile_frame(s);
    const Region region(s);
    return {[heap](const auto& points) { return heap.to_packing(points); },
            (region.left() - heap.apex_x) / heap.height,
            (region.right() - heap.apex_x) / heap.height, heap.height, heap};
  }
  if (frame == "packing")
    return {[](const auto& points) { return points; }, layer.left, layer.right, layer.depth()};
  const double half = std::min(layer.load_x - layer.left, layer.right - layer.load_x);
  return {[layer](const auto& points) { return layer.to_packing(points); }, -half, half,
          layer.depth()};
}

Extents measure(const std::vector<Item>& items, const AverageRequest& request) {
  Extents out;
  const auto n = static_cast<double>(items.size());
  for (const auto& item : items) {
    const dem::Snapshot s = read(item.state);
    out.dim = s.dim;
    const Placed placed = place(s, request.frame);
    out.depth += placed.depth / n;
    out.diameter += mean_diameter(s) / n;
    out.left = std::max(out.left, placed.left);
    out.right = std::min(out.right, placed.right);
    if (request.frame == "heap") out.heaps.push_back(placed.heap);
    const double force = -s.applied_force.y();
    if (request.response && &item != &items.front() && force != out.load) {
      throw std::invalid_argument(
          fmt::format("{}:{}: its load is {:g} N, that of the others {:g} N", item.state.file,
                      item.state.group, force, out.load));
    }
    out.load = &item == &items.front() || force == out.load ? force : 0;
  }
  return out;
}

// Points in the request's frame.
Eigen::MatrixXd points_of(const AverageRequest& request, const Extents& all,
                          const dem::Snapshot& first) {
  if (request.points.size() != 0) return request.points;
  if (all.dim == 3)
    throw std::invalid_argument("the snapshot is 3D; give --points with x,y,z and --frame packing");
  double bottom = -all.depth, top = 0;
  if (request.frame == "heap") bottom = -1;
  if (request.frame == "packing") {
    bottom = layer_frame(first).floor;
    top = bottom + all.depth;
  }
  if (request.cuts.empty())
    return grid_points(all.left, all.right, request.nx, bottom, top, request.ny);
  std::vector<double> heights;
  for (const double share : request.cuts) heights.push_back(bottom + share * (top - bottom));
  return cut_points(all.left, all.right, request.nx, heights);
}

// The single values of the stresses, for covariances.
Field with_samples(const Ensemble& ensemble) {
  Field out = ensemble.mean();
  if (ensemble.realizations() < 2) return out;
  for (Column& column : out.columns) {
    if (column.name.compare(0, 6, "sigma_") == 0) column.samples = ensemble.samples(column.name);
  }
  return out;
}

// "31.2,30.7": one number per heap.
std::string each(const std::vector<PileFrame>& heaps,
                 const std::function<double(const PileFrame&)>& number) {
  std::string out;
  for (const PileFrame& heap : heaps) {
    out += fmt::format("{}{}", out.empty() ? "" : ",", number(heap));
  }
  return out;
}

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

NamedFields average_files(AverageRequest request, Gaps* gaps) {
  const std::vector<Item> items = items_of(request);
  if (items.empty()) throw std::invalid_argument("no snapshot to average");
  if (std::find(frames.begin(), frames.end(), request.frame) == frames.end())
    throw std::invalid_argument(unknown_name("frame", request.frame, frames));
  const Extents all = measure(items, request);
  AverageOptions& options = request.options;
  if (options.width == 0) {
    options.width = (options.method == "coarse_graining" ? 1.0 : 2.5) * all.diameter;
  }
  const bool grid = request.points.size() == 0 && request.cuts.empty();
  const Eigen::MatrixXd points = points_of(request, all, read(items.front().state));
  const bool base = request.response && options.method == "coarse_graining" &&
                    request.frame == "layer" && has_base(read(items.front().state));
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(request.nx, all.left, all.right);
  const auto finish = [&](Field field) {
    field.attributes["method"] = options.method;
    field.attributes["kernel"] = options.kernel;
    field.attributes["width"] = fmt::format("{}", options.width);
    field.attributes["h"] = fmt::format("{}", all.depth);
    if (!all.heaps.empty()) {
      field.attributes["heap.h"] = each(all.heaps, [](const auto& f) { return f.height; });
      field.attributes["rho_g_h"] = each(all.heaps, [](const auto& f) { return f.pressure(); });
      field.attributes["left_deg"] =
          each(all.heaps, [](const auto& f) { return f.repose_left_deg; });
      field.attributes["right_deg"] =
          each(all.heaps, [](const auto& f) { return f.repose_right_deg; });
    }
    if (all.load > 0) field.attributes["F"] = fmt::format("{}", all.load);
    field.attributes["frame"] = request.frame == "layer" ? "models: load at (0, 0), surface y = 0"
                                : request.frame == "heap"
                                    ? "heap: apex at (0, 0), lengths over its height h"
                                    : "packing";
    return field;
  };

  Ensemble fields, base_fields;
  for (const auto& item : items) {
    const dem::Snapshot state = read(item.state);
    const Eigen::MatrixXd there = place(state, request.frame).to_packing(points);
    Field field = request.response ? response(read(item.unloaded), state, there, options, gaps)
                                   : average(state, there, options, gaps);
    field.points = points;
    field.nx = grid ? request.nx : 0;
    field.ny = grid ? request.ny : 0;
    fields.add(field);
    if (base) {
      Field line = base_response(read(item.unloaded), state, x.array() + layer_frame(state).load_x,
                                 *make_kernel(options.kernel, options.width));
      line.points.resize(x.size(), 2);
      line.points << x, Eigen::VectorXd::Constant(x.size(), -all.depth);
      base_fields.add(line);
    }
  }
  NamedFields out;
  out.emplace_back(request.response ? "response" : "average", finish(with_samples(fields)));
  if (base) out.emplace_back("base_response", finish(with_samples(base_fields)));
  return out;
}

}  // namespace grainfield::coupling
