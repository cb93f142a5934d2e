// Stresses of heaps from a field in their frame.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coupling/averaging/kernel.h"
#include "coupling/fit/heap_rows.h"
#include "coupling/heap/field_rows.h"
#include "coupling/heap/heap_field.h"

namespace grainfield::coupling {
namespace {

constexpr double kNearRow = 0.05;  // of h: a row further from a height than this is another one
constexpr double kSameRow = 1e-6;  // of h

const FieldRow& row_at(const std::vector<FieldRow>& rows, double share, const std::string& where) {
  const FieldRow& best = nearest_row(rows, share - 1);
  if (std::fabs(1 + best.y - share) > kNearRow) {
    throw std::invalid_argument(
        fmt::format("fit.heights: found {:g}; {} has no row nearer than {:g} h to it, its rows go "
                    "from {:.3g} to {:.3g}",
                    share, where, kNearRow, 1 + rows.front().y, 1 + rows.back().y));
  }
  return best;
}

std::string kernel_name(const Field& field, const std::string& where) {
  return field_attribute(field, "method", where) == "coarse_graining"
             ? field_attribute(field, "kernel", where)
             : "heaviside";
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

// Of one field: values that have no error are left out, said with their places, unless none has
// one. Whether errors are left, finite where `all` is. Rows: components x places.
bool pair_with_errors(const FitSetup& setup, const Eigen::MatrixXd& places, Eigen::MatrixXd& all,
                      Eigen::MatrixXd& errors, Observations& out) {
  constexpr std::size_t most_named = 5;
  const Eigen::Index n = places.rows();
  std::vector<Eigen::Index> with, without;
  for (Eigen::Index row = 0; row < all.rows(); ++row) {
    const std::string& name = kPlaneStress[static_cast<std::size_t>(row / n)];
    const bool wanted =
        std::find(setup.components.begin(), setup.components.end(), name) != setup.components.end();
    if (!std::isfinite(all(row, 0))) errors(row, 0) = std::nan("");
    if (!wanted || !std::isfinite(all(row, 0))) continue;
    (errors(row, 0) > 0 ? with : without).push_back(row);
  }
  if (with.empty()) return false;
  std::vector<std::string> names;
  for (const Eigen::Index row : without) {
    all(row, 0) = errors(row, 0) = std::nan("");
    if (names.size() < most_named) {
      names.push_back(fmt::format("{} at x = {:.3g} h",
                                  kPlaneStress[static_cast<std::size_t>(row / n)],
                                  places(row % n, 0)));
    }
  }
  out.without_error = without.size();
  if (!without.empty()) {
    out.warnings.push_back(fmt::format("{} of {} values have no error and are left out: {}{}",
                                       without.size(), with.size() + without.size(),
                                       fmt::join(names, ", "),
                                       without.size() > names.size() ? ", ..." : ""));
  }
  return true;
}

}  // namespace

Observations observe_heap_field(const FitSetup& setup, const Field& whole,
                                const std::string& where) {
  const Field field = without_realizations(whole, setup.leave_out, where);
  if (field.points.cols() != 2) {
    refuse_field(where, fmt::format("is 3D; fits of heaps need a 2D field; {}", kCompareCones));
  }
  std::vector<std::string> missing;
  std::vector<const Column*> columns;
  bool single = true;
  for (const std::string& name : kPlaneStress) {
    columns.push_back(field.find(name));
    const bool wanted =
        std::find(setup.components.begin(), setup.components.end(), name) != setup.components.end();
    if (wanted && columns.back() == nullptr) missing.push_back(name);
    if (wanted && columns.back() != nullptr && columns.back()->samples.size() == 0) single = false;
  }
  if (!missing.empty()) {
    refuse_field(where, fmt::format("has no column {}, which the fit needs (fit.components)",
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
  const double height = facts.mean_height(), pressure = facts.mean_pressure();
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
  const auto kernel = make_kernel(kernel_name(field, where), out.width);
  out.kernel = make_kernel(kernel->name(), out.width / height);
  const double length = kernel->independent_length();
  out.facts = facts_of(setup, slope, *out.kernel);
  const Eigen::MatrixXd points = field.points / (facts.in_metres ? height : 1.0);
  const std::vector<FieldRow> rows = horizontal_rows(points, kSameRow);

  std::vector<Eigen::Index> chosen;
  std::vector<int> level;
  // Cells in the floor are flat and have measured each by itself.
  out.measured = field_attribute(field, "method", where) == "measured";
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
      if (x < from || x > to || x < last + (1 - kSameRow) * apart) continue;
      last = x;
      chosen.push_back(k);
      level.push_back(static_cast<int>(out.data.levels.size()) - 1);
    }
  }
  const auto n = static_cast<Eigen::Index>(chosen.size());
  Eigen::MatrixXd places(n, 2);
  Eigen::MatrixXd all =
      Eigen::MatrixXd::Constant(3 * n, static_cast<Eigen::Index>(count), std::nan(""));
  Eigen::MatrixXd errors = Eigen::MatrixXd::Constant(3 * n, 1, std::nan(""));
  for (Eigen::Index p = 0; p < n; ++p) {
    const Eigen::Index k = chosen[static_cast<std::size_t>(p)];
    places.row(p) = points.row(k);
    for (Eigen::Index c = 0; c < 3; ++c) {
      const Column* column = columns[static_cast<std::size_t>(c)];
      if (column == nullptr) continue;
      for (std::size_t r = 0; r < count; ++r) {
        const auto at = static_cast<Eigen::Index>(r);
        all(c * n + p, at) = (single ? column->samples(k, at) : column->value[k]) / pressures[r];
      }
      if (column->error.size() > k) errors(c * n + p, 0) = column->error[k] / pressure;
    }
  }
  Eigen::MatrixXd grid(0, static_cast<Eigen::Index>(count));
  const bool mapped = field.nx > 1 && field.ny > 1;
  if (mapped) {
    out.maps.columns = field.nx;
    out.maps.rows = field.ny;
    out.maps.points = points;
    const Eigen::Index cells = points.rows();
    grid = Eigen::MatrixXd::Constant(3 * cells, static_cast<Eigen::Index>(count), std::nan(""));
    for (Eigen::Index c = 0; c < 3; ++c) {
      const Column* column = columns[static_cast<std::size_t>(c)];
      if (column == nullptr) continue;
      for (std::size_t r = 0; r < count; ++r) {
        const auto at = static_cast<Eigen::Index>(r);
        const Eigen::VectorXd values = single ? column->samples.col(at) : column->value;
        grid.block(c * cells, at, cells, 1) = values / pressures[r];
      }
    }
  }
  drop_copies(
      all, grid, [&](std::size_t r) { return fmt::format("realization {} of {}", r + 1, where); },
      out);
  if (mapped) fill_heap_maps(grid, out.facts, out.width / height, out.maps);
  std::vector<double> shares;
  for (const double y : used) shares.push_back(1 + y);
  // Cells in the floor feel what is above them, whatever their width.
  if (!out.measured) warn_of_low_heights(shares, height, out.width, out);
  warn_of_set_slopes(setup, out);
  warn_of_unlike_heaps(
      [&](std::size_t r) { return fmt::format("realization {} of {}", r + 1, where); }, out);
  set_mean_heap(out);
  const bool with_errors = count == 1 && pair_with_errors(setup, places, all, errors, out);
  keep_rows(setup, places, level, all, out);
  if (with_errors) {
    Observations beside;
    beside.data.levels = out.data.levels;
    beside.measured = out.measured;
    beside.without_error = out.without_error;
    keep_rows(setup, places, level, errors, beside);
    out.data.error = beside.data.samples.col(0);
  }
  if (count == 1) {
    if (field.realizations > 1)
      out.note = fmt::format(
          "{} holds the mean of {} realizations without their single values (average them anew "
          "with "
          "`grainfield average --frame heap`)",
          where, field.realizations);
  }
  return out;
}

}  // namespace grainfield::coupling
