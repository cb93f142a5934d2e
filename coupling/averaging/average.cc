#include "coupling/averaging/average.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "coupling/averaging/kernel.h"
#include "coupling/averaging/periodic.h"
#include "coupling/averaging/weights.h"
#include "coupling/base/unknown_name.h"
#include "coupling/statistics/parallel.h"
#include "dem/snapshot/same_grain.h"

namespace grainfield::coupling {
namespace {

void check(const dem::Snapshot& snapshot, const Eigen::MatrixXd& points,
           const AverageOptions& options) {
  const auto refuse = [](std::string text) { throw std::invalid_argument(std::move(text)); };
  if (!(options.width > 0) || !std::isfinite(options.width))
    refuse(fmt::format("averaging width is {} m; it must be positive (a grain diameter or more)",
                       options.width));
  if (options.threads < 1)
    refuse(fmt::format("averaging on {} threads; at least 1 is needed", options.threads));
  if (options.least_grains < 0)
    refuse(fmt::format("averages from at least {} grains; it must be 0 or more",
                       options.least_grains));
  if (options.free_surface != "open" && options.free_surface != "normalised")
    refuse(unknown_name("free surface", options.free_surface, {"open", "normalised"}));
  if (points.cols() != snapshot.dim)
    refuse(
        fmt::format("points have {} coordinates; averaging needs {}", points.cols(), snapshot.dim));
  if (!points.allFinite()) refuse("points hold a value that is not finite");
  find_method(options);
}

/// Grains with their facts, and where they are.
struct Packing {
  explicit Packing(const dem::Snapshot& s) : snapshot(s), facts(grain_facts(s)) {}

  const dem::Snapshot& snapshot;
  std::vector<GrainFacts> facts;
};

// How far from a point grains count.
double reach_of(const AverageOptions& options, int dim) {
  if (options.method != "coarse_graining") return 2 * options.width;  // the half diagonal of a cube
  return make_kernel(options.kernel, options.width, dim)->range();
}

// Points whose sums are held at once: some 30 MB.
constexpr Eigen::Index kBlock = 1 << 16;

// The values at the points of one block, which begins at `start` of the field.
void average_block(const Packing& packing, const Region& region, const Eigen::MatrixXd& points,
                   const AverageOptions& options, const Layout& layout, Eigen::Index start,
                   Field& field, Gaps& found) {
  const Method& method = find_method(options);
  const Job job{packing.snapshot, region, points, options, layout, packing.facts};
  const Eigen::Index n = points.rows();
  Sums sums{RowMatrix::Zero(n, layout.size()), std::vector<char>(static_cast<std::size_t>(n), 0)};
  // Every point belongs to one thread.
  in_parts(n, options.threads,
           [&](Eigen::Index first, Eigen::Index last) { method.add(job, first, last, sums); });
  std::vector<char> empty = sums.outside;
  for (Eigen::Index p = 0; p < n; ++p) {
    const double grains = sums.rows(p, layout.count());
    if (empty[static_cast<std::size_t>(p)]) {
      found.outside.emplace(start + p, 1);
    } else if (grains < options.least_grains) {
      empty[static_cast<std::size_t>(p)] = 1;
      found.few_grains.emplace(start + p, grains);
    }
  }
  for (std::size_t c = 0; c < layout.components().size(); ++c) {
    const Layout::Component& component = layout.components()[c];
    Eigen::VectorXd& value = field.columns[c].value;
    const bool count = component.column == "grains";
    for (Eigen::Index p = 0; p < n; ++p)
      if (count || !empty[static_cast<std::size_t>(p)])
        value[start + p] = layout.value(component, sums.rows.row(p).data());
  }
}

Field average_in(const Packing& packing, const Region& region, const Eigen::MatrixXd& points,
                 const AverageOptions& options, Gaps* gaps) {
  const Layout layout(packing.snapshot.dim, options.quantities);
  Field field;
  field.points = points;
  for (const Layout::Component& component : layout.components())
    field.add(component.column, component.unit);
  Gaps found;
  found.points = points.rows();
  found.least_grains = options.least_grains;
  for (Eigen::Index start = 0; start < points.rows(); start += kBlock) {
    const Eigen::Index n = std::min(kBlock, points.rows() - start);
    average_block(packing, region, points.middleRows(start, n), options, layout, start, field,
                  found);
  }
  if (gaps) gaps->add(found);
  field.attributes["sign"] = "tension positive";
  say_averaging(options, field);
  return field;
}

// act(packing): the snapshot, a periodic one with the images around the points. Facts are of the
// original: its contacts are complete.
template <class Act>
auto with_images(const dem::Snapshot& snapshot, const Eigen::MatrixXd& points,
                 const AverageOptions& options, Act act) {
  Packing packing(snapshot);
  if (!snapshot.cell.is_periodic()) return act(packing);
  const Surrounded around = surround(snapshot, points, reach_of(options, snapshot.dim));
  Packing wide(around.snapshot);
  for (std::size_t g = 0; g < wide.facts.size(); ++g) {
    wide.facts[g] = packing.facts[around.source[g]];
    wide.facts[g].grain = &around.snapshot.grains[g];
  }
  return act(wide);
}

// loaded - unloaded, in the region of the unloaded one.
Field difference(const Packing& unloaded, const Packing& loaded, const Eigen::MatrixXd& points,
                 const AverageOptions& options, Gaps* gaps) {
  const Region region(unloaded.snapshot);
  const Field before = average_in(unloaded, region, points, options, gaps);
  Field change =
      change_between(before, average_in(loaded, region, points, options, gaps), "grains");
  change.attributes["what"] = "loaded - unloaded";
  return change;
}

}  // namespace

Field change_between(const Field& before, Field after, const std::string& counted) {
  after.points = before.points;
  for (std::size_t c = 0; c < after.columns.size(); ++c) {
    Eigen::VectorXd& value = after.columns[c].value;
    const Eigen::VectorXd& former = before.columns[c].value;
    if (after.columns[c].name == counted)
      value = value.cwiseMin(former);
    else
      value -= former;
  }
  return after;
}

void say_averaging(const AverageOptions& options, Field& field) {
  field.attributes["method"] = options.method;
  field.attributes["kernel"] = options.kernel;
  field.attributes["width"] = options.width;
}

const std::vector<Method>& methods() {
  static const std::vector<Method> all{
      {"coarse_graining", add_coarse_graining, kernel_names},
      {"particle_centre", add_particle_centre, support_names},
      {"area_exact", add_area_exact, support_names},
  };
  return all;
}

const Method& find_method(const AverageOptions& options) {
  std::vector<std::string> names;
  for (const Method& method : methods()) {
    names.push_back(method.name);
    if (method.name != options.method) continue;
    for (const std::string& kernel : method.kernels())
      if (kernel == options.kernel) return method;
    throw std::invalid_argument(
        unknown_name("kernel of " + method.name, options.kernel, method.kernels()));
  }
  throw std::invalid_argument(unknown_name("averaging method", options.method, names));
}

Field average(const dem::Snapshot& snapshot, const Eigen::MatrixXd& points,
              const AverageOptions& options, Gaps* gaps) {
  check(snapshot, points, options);
  return with_images(snapshot, points, options, [&](const Packing& packing) {
    return average_in(packing, Region(packing.snapshot), points, options, gaps);
  });
}

void require_same_grains(const dem::Snapshot& unloaded, const dem::Snapshot& loaded) {
  const auto refuse = [](const std::string& why) {
    throw std::invalid_argument("snapshots do not belong together: " + why);
  };
  if (unloaded.dim != loaded.dim)
    refuse(fmt::format("one is {}D, the other {}D", unloaded.dim, loaded.dim));
  if (unloaded.grains.size() != loaded.grains.size())
    refuse(
        fmt::format("{} grains unloaded, {} loaded", unloaded.grains.size(), loaded.grains.size()));
  if (unloaded.walls.size() != loaded.walls.size())
    refuse(fmt::format("{} walls unloaded, {} loaded", unloaded.walls.size(), loaded.walls.size()));
  for (std::size_t g = 0; g < unloaded.grains.size(); ++g) {
    const dem::Grain &a = unloaded.grains[g], &b = loaded.grains[g];
    if (a.id != b.id)
      refuse(fmt::format("grain {} is id {} unloaded, id {} loaded", g, a.id, b.id));
    if (!dem::same_radius(a, b))
      refuse(fmt::format("grain id {} has radius {} m unloaded, {} m loaded", a.id, a.radius,
                         b.radius));
    if (!dem::same_outline(a, b))
      refuse(fmt::format("grain id {} has another outline loaded than unloaded", a.id));
    if (a.fixed != b.fixed) refuse(fmt::format("grain id {} is fixed in one of them only", a.id));
  }
}

Field response(const dem::Snapshot& unloaded, const dem::Snapshot& loaded,
               const Eigen::MatrixXd& points, const AverageOptions& options, Gaps* gaps) {
  require_same_grains(unloaded, loaded);
  check(unloaded, points, options);
  return with_images(unloaded, points, options, [&](const Packing& before) {
    return with_images(loaded, points, options, [&](const Packing& after) {
      return difference(before, after, points, options, gaps);
    });
  });
}

}  // namespace grainfield::coupling
