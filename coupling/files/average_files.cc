#include "coupling/files/average_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/container_hash/hash.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "coupling/averaging/base.h"
#include "coupling/averaging/contact_geometry.h"
#include "coupling/averaging/ensemble.h"
#include "coupling/averaging/extent.h"
#include "coupling/averaging/kernel.h"
#include "coupling/averaging/layer.h"
#include "coupling/averaging/rings.h"
#include "coupling/averaging/upright.h"
#include "coupling/files/placement.h"
#include "coupling/heap/pile_frame.h"
#include "coupling/import/packing_warnings.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

// Of a grid where none is asked for, in the plane and in space.
constexpr int kColumns = 81, kRows = 31, kSide = 31, kLayers = 21;

// A state, or with a response the loaded state and the unloaded one.
struct Item {
  SnapshotName state, unloaded;
  dem::Vec3 up{0, 0, 0};
};

dem::Vec3 usual_up(int dim) { return dem::Vec3::Unit(up_axis(dim)); }

// The item's packing as the frame sees it: in frame packing as it is.
std::shared_ptr<const dem::Snapshot> packing_of(const SnapshotName& name, const Item& item,
                                                const AverageRequest& request) {
  const auto held = snapshot_of(name);
  return request.frame == "packing" ? held : upright(held, item.up);
}

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

// The packings of all snapshots, as one.
struct Extents {
  double depth = 0, left = -std::numeric_limits<double>::infinity(),
         right = std::numeric_limits<double>::infinity(), diameter = 0, load = 0;
  double front = -std::numeric_limits<double>::infinity(),
         back = std::numeric_limits<double>::infinity();  // in space
  int dim = 2;
  std::vector<PileFrame> heaps;                                      // frame "heap" only
  double least = std::numeric_limits<double>::infinity(), most = 0;  // of the depths
};

// What makes the averages of states mean nothing, or something else than their user thinks.
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

Extents measure(std::vector<Item>& items, const AverageRequest& request,
                std::vector<std::string>& warnings) {
  Extents out;
  PackingWarnings of_forces;
  Independence independence;
  const auto& wanted = request.options.quantities;
  const bool forces =
      wanted.empty() || std::find(wanted.begin(), wanted.end(), "sigma") != wanted.end();
  const auto n = static_cast<double>(items.size());
  for (Item& item : items) {
    std::size_t idle = 0;
    const auto read = snapshot_of(item.state, &idle);
    item.up = up_for(*read, request, item.state.file + ":" + item.state.group, warnings);
    const auto held = packing_of(item.state, item, request);
    const dem::Snapshot& s = *held;
    if (&item != &items.front() && s.dim != out.dim)
      throw std::invalid_argument(
          fmt::format("{}:{} is {}D, the snapshot before it {}D; average "
                      "them apart",
                      item.state.file, item.state.group, s.dim, out.dim));
    out.dim = s.dim;
    independence.add(item.state, s);
    const Placement placed = place(s, request.frame);
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

// Where the rings' axis is, in the frame.
Eigen::Vector2d axis_of(const AverageRequest& request, const Extents& all) {
  if (!request.axis.empty()) return {request.axis[0], request.axis[1]};
  if (request.frame != "packing") return {0, 0};
  return {(all.left + all.right) / 2, (all.front + all.back) / 2};
}

// Points in the request's frame, with the shape of their grid where they have one.
Field points_of(const AverageRequest& request, const Extents& all, const dem::Snapshot& first) {
  Field out;
  out.points = request.points;
  if (request.points.size() != 0) return out;
  const Span span =
      span_of(first, request.frame, {all.left, all.right, 0, 0, all.front, all.back}, all.depth);
  std::vector<double> heights;
  for (const double share : request.cuts)
    heights.push_back(span.bottom + share * (span.top - span.bottom));
  if (request.rings) {
    const Eigen::Vector2d axis = axis_of(request, all);
    const double radius = std::min(
        {axis.x() - all.left, all.right - axis.x(), axis.y() - all.front, all.back - axis.y()});
    if (!(radius > 0))
      throw std::invalid_argument(
          fmt::format("--axis: ({:g}, {:g}) is outside the packing, {:g} to {:g} by {:g} to {:g}",
                      axis.x(), axis.y(), all.left, all.right, all.front, all.back));
    out.points = heights.empty()
                     ? grid_points(0, radius, request.nx, span.bottom, span.top, request.ny)
                     : cut_points(0, radius, request.nx, heights);
  } else if (all.dim == 3) {
    out.points = heights.empty() ? span.grid(request.nx, request.ny, request.nz)
                                 : cut_points({all.left, all.front}, {all.right, all.back},
                                              request.nx, request.ny, heights);
    out.nz = heights.empty() ? request.nz : static_cast<int>(heights.size());
  } else {
    out.points = heights.empty() ? span.grid(request.nx, request.ny)
                                 : cut_points(all.left, all.right, request.nx, heights);
  }
  if (heights.empty() || out.nz > 0) {
    out.nx = request.nx;
    out.ny = request.ny;
  }
  return out;
}

// Rings of the frame as rings of the packing.
Eigen::MatrixXd rings_in_packing(const Eigen::MatrixXd& rings, const Eigen::Vector2d& axis,
                                 const Placement& placed) {
  const auto places = [&](double share) {
    Eigen::MatrixXd at(rings.rows(), 3);
    at.col(0) = axis.x() + share * rings.col(0).array();
    at.col(1).setConstant(axis.y());
    at.col(2) = rings.col(1);
    return placed.to_packing(at);
  };
  const Eigen::MatrixXd on_ring = places(1);
  Eigen::MatrixXd out(rings.rows(), 2);
  out.col(0) = on_ring.col(0) - places(0).col(0);
  out.col(1) = on_ring.col(2);
  return out;
}

// The field of one item on the frame's points.
Field field_of(const Item& item, const AverageRequest& request, const Eigen::MatrixXd& points,
               const Eigen::Vector2d& axis, Gaps* gaps) {
  const auto held = packing_of(item.state, item, request);
  const dem::Snapshot& state = *held;
  const Placement placed = place(state, request.frame);
  const auto before = request.response ? packing_of(item.unloaded, item, request) : held;
  const dem::Snapshot& unloaded = *before;
  if (!request.rings) {
    const Eigen::MatrixXd there = placed.to_packing(points);
    return request.response ? response(unloaded, state, there, request.options, gaps)
                            : average(state, there, request.options, gaps);
  }
  const Eigen::MatrixXd centre =
      placed.to_packing(Eigen::MatrixXd(Eigen::RowVector3d(axis.x(), axis.y(), 0)));
  return average_on_rings(
      [&](const Eigen::MatrixXd& places, const AverageOptions& options) {
        return request.response ? response(unloaded, state, places, options)
                                : average(state, places, options);
      },
      {centre(0, 0), centre(0, 1)}, rings_in_packing(points, axis, placed), request.options, gaps);
}

// What the request asks for is there in this dimension.
void require_dimension(const AverageRequest& request, int dim) {
  if (request.rings && dim == 2)
    throw std::invalid_argument(
        "the snapshot is 2D; averages over rings need a 3D one; leave --rings out");
  if (!request.axis.empty() && request.frame != "packing")
    throw std::invalid_argument(
        fmt::format("--axis: frame {} has its own axis; it is for frame packing", request.frame));
  if (!request.axis.empty() && !request.rings)
    throw std::invalid_argument("--axis: it is that of --rings; give both");
  if (request.points.size() != 0) return;
  const bool flat = dim == 2 || request.rings || !request.cuts.empty();
  if (request.nx > 0 && flat != (request.nz == 0))
    throw std::invalid_argument(
        fmt::format("--grid: found {} x {}{}, allowed: {}", request.nx, request.ny,
                    request.nz > 0 ? fmt::format(" x {}", request.nz) : "",
                    dim == 2                ? "COLUMNSxROWS, the snapshot is 2D"
                    : request.rings         ? "RADIIxHEIGHTS of rings"
                    : !request.cuts.empty() ? "COLUMNSxROWS of horizontal cuts"
                                            : "COLUMNSxROWSxLAYERS, the snapshot is 3D"));
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

std::shared_ptr<const dem::Snapshot> snapshot_of(const SnapshotName& name, std::size_t* idle) {
  if (idle != nullptr) *idle = 0;
  if (name.held && count_idle(*name.held) == 0) return name.held;
  auto made = std::make_shared<dem::Snapshot>(
      name.held ? *name.held : dem::read_snapshot(name.file, name.group));
  const std::size_t left_out = leave_out_idle(*made);
  if (idle != nullptr) *idle = left_out;
  return made;
}

namespace {

// The snapshots REALIZATION/NAME of a file that has no snapshot called NAME itself.
std::vector<std::string> states_called(const std::string& file, const std::string& name) {
  std::vector<std::string> out;
  if (!std::filesystem::exists(file) || name.find('/') != std::string::npos) return out;
  for (const std::string& group : dem::list_snapshots(file)) {
    if (group == name || group == "/" + name) return {};
    if (group.ends_with("/" + name)) out.push_back(group);
  }
  return out;
}

}  // namespace

std::vector<SnapshotName> parse_snapshot_names(const std::vector<std::string>& texts) {
  std::vector<SnapshotName> out;
  for (const auto& text : texts) {
    const std::size_t at = text.rfind(':');
    if (at != std::string::npos && !std::filesystem::exists(text)) {
      const std::string file = text.substr(0, at), group = text.substr(at + 1);
      const std::vector<std::string> states = states_called(file, group);
      if (states.empty()) out.push_back({file, group, {}});
      for (const std::string& state : states) out.push_back({file, state, {}});
      continue;
    }
    const auto groups = dem::list_snapshots(text);
    if (groups.empty())
      throw std::invalid_argument(
          text +
          ": holds no snapshot (grainfield info shows what it holds; averaged and measured "
          "fields are for fit and compare)");
    for (const auto& group : groups) out.push_back({text, group, {}});
  }
  require_each_once(out);
  return out;
}

void require_each_once(const std::vector<SnapshotName>& names) {
  std::set<std::pair<std::string, std::string>> seen;
  for (const SnapshotName& name : names) {
    const std::string group = name.group.substr(name.group.starts_with('/') ? 1 : 0);
    std::error_code error;
    const std::string file = std::filesystem::weakly_canonical(name.file, error).string();
    if (!seen.insert({error ? name.file : file, group}).second) {
      throw std::invalid_argument(fmt::format(
          "{}:{}: named twice, allowed: every packing once (a copy is no realization of its own)",
          name.file, name.group));
    }
  }
}

void settle(AverageRequest& request, bool kernel_chosen, bool width_chosen) {
  if (request.options.method != "coarse_graining" && !kernel_chosen) {
    request.options.kernel = "circle";
  }
  if (width_chosen && !(request.options.width > 0)) {
    throw std::invalid_argument(
        fmt::format("--width: found {:g}, allowed: above 0", request.options.width));
  }
  for (const double share : request.cuts) {
    if (!(share >= 0 && share <= 1))
      throw std::invalid_argument(
          fmt::format("--cuts: found {:g}, allowed: 0 (floor) to 1 (surface)", share));
  }
}

NamedFields average_files(AverageRequest request, Gaps* gaps, std::vector<std::string>* warnings) {
  std::vector<Item> items = items_of(request);
  if (items.empty()) throw std::invalid_argument("no snapshot to average");
  require_frame(request.frame);
  std::vector<std::string> found;
  const Extents all = measure(items, request, found);
  if (warnings != nullptr) *warnings = found;
  AverageOptions& options = request.options;
  if (options.width == 0) {
    options.width = (options.method == "coarse_graining" ? 1.0 : 2.5) * all.diameter;
  }
  require_dimension(request, all.dim);
  if (request.nx == 0) {
    const bool box = all.dim == 3 && !request.rings;
    request.nx = box ? kSide : kColumns;
    request.ny = box ? kSide : kRows;
    request.nz = box && request.cuts.empty() ? kLayers : 0;
  }
  const Field where =
      points_of(request, all, *packing_of(items.front().state, items.front(), request));
  const Eigen::MatrixXd& points = where.points;
  const Eigen::Vector2d axis = request.rings ? axis_of(request, all) : Eigen::Vector2d(0, 0);
  const bool base = request.response && options.method == "coarse_graining" && all.dim == 2 &&
                    request.frame == "layer" &&
                    has_base(*packing_of(items.front().state, items.front(), request));
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
    field.attributes["frame"] = frame_text(request.frame, all.dim, request.rings);
    return field;
  };

  Ensemble fields, base_fields;
  for (const auto& item : items) {
    Field field = field_of(item, request, points, axis, gaps);
    field.points = points;
    field.nx = where.nx;
    field.ny = where.ny;
    field.nz = where.nz;
    fields.add(field);
    if (base) {
      const auto state = packing_of(item.state, item, request);
      Field line = base_response(*packing_of(item.unloaded, item, request), *state,
                                 x.array() + layer_frame(*state).load_x,
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
