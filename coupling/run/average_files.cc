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
#include "coupling/import/doubts.h"
#include "coupling/run/pile_frame.h"
#include "coupling/run/placement.h"
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

// The packings of all snapshots, as one.
struct Extents {
  double depth = 0, left = -std::numeric_limits<double>::infinity(),
         right = std::numeric_limits<double>::infinity(), diameter = 0, load = 0;
  int dim = 2;
  std::vector<PileFrame> heaps;                                      // frame "heap" only
  double least = std::numeric_limits<double>::infinity(), most = 0;  // of the depths
};

// What makes the averages of states mean nothing, or something else than their user thinks: each
// doubt once, with the first state that has it.
class Doubts {
 public:
  explicit Doubts(const AverageOptions& options) {
    const auto& wanted = options.quantities;
    forces_ = wanted.empty() || std::find(wanted.begin(), wanted.end(), "sigma") != wanted.end();
  }

  void look_at(const SnapshotName& name, const dem::Snapshot& s) {
    if (!forces_) return;
    const bool bare = s.contacts.empty();
    Doubt& doubt = bare ? bare_ : pulls_;
    const std::string text =
        bare ? "has no contacts: stress and fabric are 0" : tension_in(check_packing(s));
    if (text.empty()) return;
    if (doubt.text.empty()) {
      doubt.text = fmt::format("{}:{}: {}", name.file, name.group, text);
    } else {
      ++doubt.others;
    }
  }

  void add_to(std::vector<std::string>& warnings) const {
    for (const Doubt& doubt : {bare_, pulls_}) {
      if (doubt.text.empty()) continue;
      warnings.push_back(doubt.others == 0
                             ? doubt.text
                             : fmt::format("{} (likewise {} other{})", doubt.text, doubt.others,
                                           doubt.others == 1 ? "" : "s"));
    }
  }

 private:
  struct Doubt {
    std::string text;
    int others = 0;
  };
  bool forces_ = true;
  Doubt bare_, pulls_;
};

Extents measure(const std::vector<Item>& items, const AverageRequest& request,
                std::vector<std::string>& warnings) {
  Extents out;
  Doubts doubts(request.options);
  const auto n = static_cast<double>(items.size());
  for (const auto& item : items) {
    const dem::Snapshot s = read(item.state);
    out.dim = s.dim;
    const Placement placed = place(s, request.frame);
    doubts.look_at(item.state, s);
    if (request.response) doubts.look_at(item.unloaded, read(item.unloaded));
    out.depth += placed.depth / n;
    out.least = std::min(out.least, placed.depth);
    out.most = std::max(out.most, placed.depth);
    out.diameter += mean_diameter(s) / n;
    out.left = std::max(out.left, placed.left);
    out.right = std::min(out.right, placed.right);
    if (request.frame == "heap") {
      out.heaps.push_back(placed.heap);
      if (!placed.heap.in_flight.empty()) {
        warnings.push_back(
            fmt::format("{}:{}: {}", item.state.file, item.state.group, placed.heap.in_flight));
      }
    }
    const double force = -s.applied_force.y();
    if (request.response && &item != &items.front() && force != out.load) {
      throw std::invalid_argument(
          fmt::format("{}:{}: its load is {:g} N, that of the others {:g} N", item.state.file,
                      item.state.group, force, out.load));
    }
    out.load = &item == &items.front() || force == out.load ? force : 0;
  }
  doubts.add_to(warnings);
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

// Points in the request's frame.
Eigen::MatrixXd points_of(const AverageRequest& request, const Extents& all,
                          const dem::Snapshot& first) {
  if (request.points.size() != 0) return request.points;
  const Span span = span_of(first, request.frame, all.left, all.right, all.depth);
  if (request.cuts.empty()) return span.grid(request.nx, request.ny);
  std::vector<double> heights;
  for (const double share : request.cuts)
    heights.push_back(span.bottom + share * (span.top - span.bottom));
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

NamedFields average_files(AverageRequest request, Gaps* gaps, std::vector<std::string>* warnings) {
  const std::vector<Item> items = items_of(request);
  if (items.empty()) throw std::invalid_argument("no snapshot to average");
  require_frame(request.frame);
  std::vector<std::string> found;
  const Extents all = measure(items, request, found);
  if (warnings != nullptr) *warnings = found;
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
    field.attributes["frame"] = frame_text(request.frame);
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
