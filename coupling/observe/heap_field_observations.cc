// Stresses of heaps from a field in their frame.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coupling/observe/field_observations.h"
#include "coupling/observe/heap_rows.h"
#include "coupling/specimen/field_rows.h"
#include "coupling/specimen/heap_field.h"

namespace grainfield::coupling {
namespace {

constexpr double kNearHeight = 0.05;  // of h: a row further from a height than this is another one
constexpr double kSameHeight = 1e-6;  // of h

const FieldRow& row_at(const std::vector<FieldRow>& rows, double share, const std::string& where) {
  const FieldRow& best = nearest_row(rows, share - 1);
  if (std::fabs(1 + best.y - share) > kNearHeight) {
    throw std::invalid_argument(
        fmt::format("fit.heights: found {:g}; {} has no row nearer than {:g} h to it, its rows go "
                    "from {:.3g} to {:.3g}",
                    share, where, kNearHeight, 1 + rows.front().y, 1 + rows.back().y));
  }
  return best;
}

// The field without the realizations of these numbers, from 1, in its single values.
Field without_realizations(const Field& whole, const std::vector<double>& numbers,
                           const std::string& where) {
  if (numbers.empty()) return whole;
  const std::vector<std::size_t> kept =
      kept_realizations(static_cast<std::size_t>(whole.realizations), numbers);
  Field out = whole;
  const std::vector<int> chosen(kept.begin(), kept.end());
  out.realizations = static_cast<int>(chosen.size());
  for (Column& column : out.columns) {
    if (column.samples.size() == 0) {
      column.error.resize(0);
      continue;
    }
    column.samples = Eigen::MatrixXd(column.samples(Eigen::all, chosen));
    column.value = column.samples.rowwise().mean();
  }
  if (out.find("sigma_yy") == nullptr || out.find("sigma_yy")->samples.size() == 0) {
    throw std::invalid_argument(
        fmt::format("fit.leave_out: {} has no values of single realizations", where));
  }
  return out;
}

}  // namespace

Observations observe_heap_field(const FitSetup& setup, const Field& whole,
                                const std::string& where) {
  Field field = without_realizations(whole, setup.leave_out, where);
  if (field.points.cols() != 2) {
    refuse(where, fmt::format("is 3D; fits of heaps need a 2D field; {}", kCompareCones));
  }
  std::vector<std::string> missing;
  bool single = true;
  for (const std::string& component : setup.components) {
    const Column* column = field.find(component);
    if (column == nullptr)
      missing.push_back(component);
    else
      single = single && column->samples.size() > 0;
  }
  if (!missing.empty()) {
    refuse(where, fmt::format("has no column {}, which the fit needs (fit.components)",
                              fmt::join(missing, ", ")));
  }
  const auto count = static_cast<std::size_t>(single ? field.realizations : 1);
  require_compression(field, where);
  Observations out;
  HeapFieldFacts facts =
      heap_field_facts(whole, single ? static_cast<std::size_t>(whole.realizations) : 1, where);
  if (field.realizations != whole.realizations) {
    const std::vector<std::size_t> kept = kept_realizations(facts.height.size(), setup.leave_out);
    for (auto* list : {&facts.height, &facts.pressure, &facts.left_deg, &facts.right_deg}) {
      std::vector<double> of_kept;
      for (const std::size_t k : kept) of_kept.push_back((*list)[k]);
      *list = std::move(of_kept);
    }
  }
  const std::vector<double>& pressures = facts.pressure;
  const double height = facts.mean_height();
  for (std::size_t r = 0; r < count; ++r) {
    PileFrame one;
    one.height = facts.height[r];
    one.repose_left_deg = facts.left_deg[r];
    one.repose_right_deg = facts.right_deg[r];
    // pressure() is their product.
    one.grain_density = pressures[r] / facts.height[r];
    one.volume_fraction = one.gravity = 1;
    out.frames.push_back(one);
  }
  const HeapSlopes slope = slopes_of(setup, out.frames);
  out.width = field_number(field, "width", where);
  const auto kernel = kernel_of(field, where);
  out.kernel = make_kernel(kernel->name(), out.width / height);
  const double length = kernel->independent_length();
  out.facts = facts_of(setup, slope, *out.kernel);
  const Eigen::MatrixXd points = field.points / (field.is_over_height() ? 1.0 : height);
  const std::vector<FieldRow> rows = horizontal_rows(points, kSameHeight);

  HeapPlaces at;
  // Cells in the floor are flat and have measured each by itself.
  out.measured = field_word(field, "method", where) == "measured";
  const double reach = out.measured ? 0 : kernel->range() / height;
  const double apart = out.measured ? 0 : (single ? 0.5 : 1) * length / height;
  std::vector<double> used;
  for (const double share : setup.heights) {
    const FieldRow& row = row_at(rows, share, where);
    if (std::find(used.begin(), used.end(), row.y) != used.end()) continue;
    used.push_back(row.y);
    out.data.levels.push_back(fmt::format("{:.3g}", 1 + row.y));
    const double from = reach + row.y / slope.left(), to = -row.y / slope.right() - reach;
    double last = from - 2 * apart;
    for (const Eigen::Index k : row.at) {
      const double x = points(k, 0);
      if (x < from || x > to || x < last + (1 - kSameHeight) * apart) continue;
      last = x;
      at.chosen.push_back(k);
      at.level.push_back(static_cast<int>(out.data.levels.size()) - 1);
    }
  }
  std::vector<double> shares;
  for (const double y : used) shares.push_back(1 + y);
  // Cells in the floor feel what is above them, whatever their width.
  if (!out.measured) warn_of_low_heights(shares, height, out.width, out);
  warn_of_set_slopes(setup, out);
  const auto name = [&](std::size_t r) {
    return fmt::format("realization {} of {}", r + 1, where);
  };
  warn_of_unlike_heaps(name, out);
  at.pressure = facts.pressure;
  at.map_from = points.rows();
  if (field.nx > 1 && field.ny > 1) {
    at.map_from = 0;
    out.maps.columns = field.nx;
    out.maps.rows = field.ny;
    out.maps.points = points;
  }
  field.points = points;
  take_values(setup, field, at, name, out);
  if (count == 1 && field.realizations > 1) {
    out.note = fmt::format(
        "{} holds the mean of {} realizations without their single values (average them anew with "
        "`grainfield average --frame heap`)",
        where, field.realizations);
  }
  return out;
}

}  // namespace grainfield::coupling
