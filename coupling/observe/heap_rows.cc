#include "coupling/observe/heap_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "continuum/constants.h"
#include "coupling/averaging/points.h"
#include "coupling/models/parse_choices.h"

namespace grainfield::coupling {
namespace {

constexpr int kMapColumns = 101, kMapRows = 33;
constexpr double kRounding = 1e-9;  // of the largest value
constexpr double kFarSlope = 5;     // degrees: more than any heap's flanks are in doubt by

double tangent(double degrees) { return std::tan(degrees * std::numbers::pi / 180); }

// Mean over the heaps that have one; nan without.
double mean_of(const std::vector<PileFrame>& frames, double PileFrame::*member) {
  double sum = 0;
  int count = 0;
  for (const PileFrame& frame : frames) {
    if (!std::isfinite(frame.*member)) continue;
    sum += frame.*member;
    ++count;
  }
  return count > 0 ? sum / count : std::nan("");
}

// The mean of the heaps' own means over both flanks.
double mean_slope(const std::vector<PileFrame>& frames) {
  double sum = 0;
  int heaps = 0;
  for (const PileFrame& frame : frames) {
    double own = 0;
    int count = 0;
    for (const double slope : {frame.repose_left_deg, frame.repose_right_deg}) {
      if (!std::isfinite(slope)) continue;
      own += slope;
      ++count;
    }
    if (count == 0) continue;
    sum += own / count;
    ++heaps;
  }
  return heaps > 0 ? sum / heaps : std::nan("");
}

// Whether two packings have the same values, and the same places without one.
bool same(const Eigen::MatrixXd& all, Eigen::Index a, Eigen::Index b) {
  double largest = 0, off = 0;
  for (Eigen::Index k = 0; k < all.rows(); ++k) {
    if (std::isfinite(all(k, a)) != std::isfinite(all(k, b))) return false;
    if (!std::isfinite(all(k, a))) continue;
    largest = std::max(largest, std::fabs(all(k, a)));
    off = std::max(off, std::fabs(all(k, a) - all(k, b)));
  }
  return off <= kRounding * largest;
}

Eigen::MatrixXd columns(const Eigen::MatrixXd& all, const std::vector<Eigen::Index>& kept) {
  Eigen::MatrixXd out(all.rows(), static_cast<Eigen::Index>(kept.size()));
  for (std::size_t k = 0; k < kept.size(); ++k) {
    out.col(static_cast<Eigen::Index>(k)) = all.col(kept[k]);
  }
  return out;
}

}  // namespace

double HeapSlopes::left() const { return tangent(apart ? left_deg : mean_deg); }
double HeapSlopes::right() const { return tangent(apart ? right_deg : mean_deg); }

bool takes_flanks_apart(const std::vector<std::string>& models) {
  return std::any_of(models.begin(), models.end(), [](const std::string& text) {
    const bool chosen = text.find_first_of(":=") != std::string::npos;
    const std::string name = chosen ? parse_choice(text, "fit: model").name : text;
    return name.starts_with("cantelaube_asymmetric");
  });
}

HeapSlopes slopes_of(const FitSetup& setup, const std::vector<PileFrame>& frames) {
  HeapSlopes out;
  const bool given = setup.left_deg > 0 && setup.right_deg > 0;
  out.left_deg = setup.left_deg > 0 ? setup.left_deg : mean_of(frames, &PileFrame::repose_left_deg);
  out.right_deg =
      setup.right_deg > 0 ? setup.right_deg : mean_of(frames, &PileFrame::repose_right_deg);
  if (!std::isfinite(out.left_deg)) out.left_deg = out.right_deg;
  if (!std::isfinite(out.right_deg)) out.right_deg = out.left_deg;
  if (!std::isfinite(out.left_deg)) {
    throw std::invalid_argument(
        "fit: no heap has flanks long enough for a slope (five columns of a grain diameter on a "
        "side); use larger heaps, or set fit.left_deg and fit.right_deg");
  }
  out.mean_deg = given || setup.left_deg > 0 || setup.right_deg > 0
                     ? (out.left_deg + out.right_deg) / 2
                     : mean_slope(frames);
  out.apart = takes_flanks_apart(setup.models);
  for (const double slope : {out.left_deg, out.right_deg}) {
    if (slope > 0 && slope < 89) continue;
    throw std::invalid_argument(fmt::format(
        "fit: found a flank of {:.1f} degrees, allowed: above 0, up to 89; the snapshot "
        "is no heap with its apex up, or set fit.left_deg and fit.right_deg",
        slope));
  }
  return out;
}

HeapFacts facts_of(const FitSetup& setup, const HeapSlopes& slopes, const Kernel& kernel) {
  const double deviation = kernel.independent_length() / (2 * std::sqrt(std::numbers::pi));
  HeapFacts out{slopes.mean_deg, 1, 1, deviation};
  if (slopes.apart) {
    out.left_deg = slopes.left_deg;
    out.right_deg = slopes.right_deg;
  }
  const double steeper =
      slopes.apart ? std::max(slopes.left_deg, slopes.right_deg) : slopes.mean_deg;
  if (setup.friction_deg > 0) {
    if (setup.friction_deg < steeper) {
      throw std::invalid_argument(
          fmt::format("fit.friction_deg: found {:g}, allowed: from the steeper slope, {:.2f}",
                      setup.friction_deg, steeper));
    }
    out.friction_deg = setup.friction_deg;
  }
  return out;
}

double depth_below_flank(const HeapFacts& facts, double x, double y) {
  return -y - std::fabs(x) * std::tan((x < 0 ? facts.left() : facts.right()) * kDegree);
}

StressMaps heap_map_grid(const HeapSlopes& slopes) {
  StressMaps out;
  out.columns = kMapColumns;
  out.rows = kMapRows;
  out.points = grid_points(-1 / slopes.left(), 1 / slopes.right(), kMapColumns, -1, 0, kMapRows);
  return out;
}

void warn_of_low_heights(const std::vector<double>& heights, double height, double width,
                         Observations& out) {
  std::vector<std::string> low;
  for (const double share : heights) {
    if (share * height < width) low.push_back(fmt::format("{:.3g}", share));
  }
  if (low.empty()) return;
  out.warnings.push_back(fmt::format(
      "height{} {} h nearer to the floor than the averaging width {:.3g} m ({:.3g} h): the average "
      "mixes in what lies below the floor and biases the constants; choose heights from {:.2g}, "
      "or a smaller fit.width_diameters",
      low.size() == 1 ? "" : "s", fmt::join(low, ", "), width, width / height,
      std::ceil(100 * width / height) / 100));
}

void warn_of_round_tops(Observations& out) {
  double sum = 0;
  for (const PileFrame& frame : out.frames) sum += frame.weight_over_wedge();
  out.weight_over_wedge = sum / static_cast<double>(out.frames.size());
  if (!(out.weight_over_wedge > kMostOverWedge || out.weight_over_wedge < 1 / kMostOverWedge))
    return;
  out.warnings.push_back(fmt::format(
      "the heaps weigh {:.2f} times the wedge of their height and slopes{}, and models of heaps "
      "are "
      "of wedges",
      out.weight_over_wedge, out.weight_over_wedge > 1 ? ": their tops are round or flat" : ""));
}

void warn_of_unlike_heaps(const std::function<std::string(std::size_t)>& name, Observations& out) {
  if (out.frames.size() < 2) return;
  std::vector<double> heights;
  for (const PileFrame& frame : out.frames) heights.push_back(frame.height);
  std::sort(heights.begin(), heights.end());
  const double median = heights[heights.size() / 2];
  std::vector<std::string> unlike;
  for (std::size_t k = 0; k < out.frames.size(); ++k) {
    const double h = out.frames[k].height;
    if (h <= kUnlikeHeights * median && median <= kUnlikeHeights * h) continue;
    unlike.push_back(fmt::format("{} (number {}, {:.3g} m)", name(k), k + 1, h));
  }
  if (unlike.empty()) return;
  out.warnings.push_back(fmt::format(
      "heaps {:.3g} to {:.3g} m high in one ensemble: are they realizations of one? Unlike the "
      "others ({:.3g} m): {}; fit.leave_out=[NUMBER, ...] leaves them out",
      heights.front(), heights.back(), median, fmt::join(unlike, ", ")));
}

std::vector<std::size_t> kept_realizations(std::size_t count, const std::vector<double>& numbers) {
  std::vector<std::size_t> out;
  for (const double number : numbers) {
    if (number >= 1 && number <= static_cast<double>(count) && number == std::floor(number)) {
      continue;
    }
    throw std::invalid_argument(
        fmt::format("fit.leave_out: found {:g}, allowed: whole numbers 1 to {}", number, count));
  }
  for (std::size_t k = 0; k < count; ++k) {
    if (std::find(numbers.begin(), numbers.end(), static_cast<double>(k + 1)) == numbers.end()) {
      out.push_back(k);
    }
  }
  if (out.empty()) throw std::invalid_argument("fit.leave_out: leaves no realization");
  return out;
}

void warn_of_set_slopes(const FitSetup& setup, Observations& out) {
  const auto compare = [&](const char* key, double set, double PileFrame::*member) {
    const double measured = mean_of(out.frames, member);
    if (!(set > 0) || !(std::fabs(set - measured) > kFarSlope)) return;
    out.warnings.push_back(
        fmt::format("fit.{}: set to {:.4g} degrees, measured {:.3g}: models are cut off at a slope "
                    "that the heaps do not have",
                    key, set, measured));
  };
  compare("left_deg", setup.left_deg, &PileFrame::repose_left_deg);
  compare("right_deg", setup.right_deg, &PileFrame::repose_right_deg);
}

namespace {

// `all`, `grid`: values x packings.
void drop_copies(Eigen::MatrixXd& all, Eigen::MatrixXd& grid,
                 const std::function<std::string(std::size_t)>& name, Observations& out) {
  std::vector<Eigen::Index> kept;
  std::string first;
  for (Eigen::Index r = 0; r < all.cols(); ++r) {
    const auto original = std::find_if(kept.begin(), kept.end(),
                                       [&](Eigen::Index other) { return same(all, other, r); });
    if (original == kept.end()) {
      kept.push_back(r);
    } else if (first.empty()) {
      first = fmt::format("{} is a copy of {}", name(static_cast<std::size_t>(r)),
                          name(static_cast<std::size_t>(*original)));
    }
  }
  const std::size_t copies = static_cast<std::size_t>(all.cols()) - kept.size();
  if (copies == 0) return;
  std::vector<PileFrame> frames;
  for (const Eigen::Index r : kept) frames.push_back(out.frames[static_cast<std::size_t>(r)]);
  out.frames = std::move(frames);
  all = columns(all, kept);
  grid = columns(grid, kept);
  out.warnings.push_back(fmt::format(
      "{}{}: copies are no independent realizations and do not count", first,
      copies == 1 ? ""
                  : fmt::format(" (likewise {} other{})", copies - 1, copies == 2 ? "" : "s")));
}

// average_maps without what is above the mean flanks, and nearer to the floor than the averaging
// width: there the average mixes in what lies below the floor.
void fill_heap_maps(const Eigen::MatrixXd& samples, double margin, Observations& out) {
  average_maps(
      samples,
      [&](double x, double y) {
        return depth_below_flank(out.facts, x, y) >= 0 && 1 + y >= margin;
      },
      out.maps);
}

void set_mean_heap(Observations& out) {
  const double n = static_cast<double>(out.frames.size());
  double height = 0, pressure = 0;
  for (const PileFrame& f : out.frames) {
    height += f.height / n;
    pressure += f.pressure() / n;
  }
  out.scale = scale_of_heaps(height, pressure, scaled_alone(static_cast<int>(out.frames.size())));
}

// One field's values that have no error are left out, said with their places, unless none has
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

// What helps where too few values are left.
std::string advice_on_rows(const Observations& out) {
  if (out.without_error > 0) {
    return fmt::format(
        "{} more have no error and are left out; give every value an error, or none: then there "
        "are constants without errors",
        out.without_error);
  }
  return out.measured ? "a fit takes places between the feet of the heap, at these heights"
                      : "choose lower heights, a smaller fit.width_diameters or larger piles";
}

// Chooses the components, and of these the complete rows. `all`: values of sigma_xx on all points,
// then sigma_yy, sigma_xy; columns realizations.
void keep_rows(const FitSetup& setup, const Eigen::MatrixXd& points, const std::vector<int>& level,
               const Eigen::MatrixXd& all, Observations& out) {
  const Eigen::Index n = points.rows();
  FitData chosen;
  chosen.components = setup.components;
  chosen.levels = out.data.levels;
  const auto count = static_cast<Eigen::Index>(setup.components.size());
  chosen.points = points.replicate(count, 1);
  chosen.samples.resize(count * n, all.cols());
  for (Eigen::Index c = 0; c < count; ++c) {
    const auto at = std::find(kPlaneStress.begin(), kPlaneStress.end(),
                              setup.components[static_cast<std::size_t>(c)]);
    chosen.samples.middleRows(c * n, n) = all.middleRows((at - kPlaneStress.begin()) * n, n);
    chosen.component.insert(chosen.component.end(), static_cast<std::size_t>(n),
                            static_cast<int>(c));
    chosen.level.insert(chosen.level.end(), level.begin(), level.end());
  }
  keep_complete_rows(chosen, "fit.heights", advice_on_rows(out), out);
}

// The stresses one after the other on these points, over the pressure; nan: not in the field.
Eigen::MatrixXd stacked(const Field& field, const std::vector<Eigen::Index>& at,
                        const std::vector<double>& pressure) {
  const auto n = static_cast<Eigen::Index>(at.size()), count = std::ssize(pressure);
  Eigen::MatrixXd out = Eigen::MatrixXd::Constant(3 * n, count, std::nan(""));
  for (Eigen::Index c = 0; c < 3; ++c) {
    const Column* column = field.find(kPlaneStress[static_cast<std::size_t>(c)]);
    if (column == nullptr) continue;
    for (Eigen::Index r = 0; r < count; ++r) {
      const bool single = column->samples.cols() == count;
      const Eigen::VectorXd values =
          single ? Eigen::VectorXd(column->samples(at, r)) : Eigen::VectorXd(column->value(at));
      out.block(c * n, r, n, 1) = values / pressure[static_cast<std::size_t>(r)];
    }
  }
  return out;
}

}  // namespace

void take_values(const FitSetup& setup, const Field& field, const HeapPlaces& at,
                 const std::function<std::string(std::size_t)>& name, Observations& out) {
  std::vector<Eigen::Index> of_map(static_cast<std::size_t>(field.points.rows() - at.map_from));
  std::iota(of_map.begin(), of_map.end(), at.map_from);
  Eigen::MatrixXd all = stacked(field, at.chosen, at.pressure);
  Eigen::MatrixXd grid = stacked(field, of_map, at.pressure);
  drop_copies(all, grid, name, out);
  set_mean_heap(out);
  if (!of_map.empty()) fill_heap_maps(grid, out.width / out.scale.h, out);
  const Eigen::MatrixXd places = field.points(at.chosen, Eigen::all);
  Eigen::MatrixXd errors = Eigen::MatrixXd::Constant(all.rows(), 1, std::nan(""));
  for (std::size_t c = 0; c < 3; ++c) {
    const Column* column = field.find(kPlaneStress[c]);
    if (column == nullptr || column->error.size() == 0) continue;
    errors.middleRows(static_cast<Eigen::Index>(c) * places.rows(), places.rows()) =
        column->error(at.chosen) / at.pressure.front();
  }
  const bool with_errors =
      at.pressure.size() == 1 && pair_with_errors(setup, places, all, errors, out);
  keep_rows(setup, places, at.level, all, out);
  if (!with_errors) return;
  Observations beside;
  beside.data.levels = out.data.levels;
  beside.measured = out.measured;
  beside.without_error = out.without_error;
  keep_rows(setup, places, at.level, errors, beside);
  out.data.error = beside.data.samples.col(0);
}

}  // namespace grainfield::coupling
