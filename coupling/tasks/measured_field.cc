#include "coupling/tasks/measured_field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "continuum/model.h"
#include "coupling/base/unit.h"
#include "coupling/import/format.h"
#include "coupling/import/synonyms.h"
#include "coupling/tasks/measured_share.h"
#include "dem/shared/number.h"
#include "dem/snapshot/limits.h"

namespace grainfield::coupling {
namespace {

// What is plausible of measured heaps: places up to so many feet from the axis.
constexpr double kOutside = 1.1;
// A wrong unit, or another heap's size: no arching carries so much, or leaves so little of the
// weight above the places.
constexpr double kImpossible = 5, kTooLight = 0.05;
// Places that all lie within this share of the way to the nearer foot are in a wrong unit.
constexpr double kNarrow = 0.03;
// Share of the height.
constexpr double kWidestCell = 0.25;
constexpr std::size_t kEnoughToCarry = 5;
constexpr Eigen::Index kLeastToFit = 10;
// Shares of the values, in the median.
constexpr double kLeastError = 1e-3, kMostError = 1;

// Shears so many standard errors from 0 tell their sign; so many are enough, and so large a share
// of them turned is no noise.
constexpr double kClear = 2, kMostTurned = 0.75;
constexpr long kEnoughShears = 3;

constexpr double kSamePlace = 1e-9;   // of h
constexpr double kOffHeight = 0.01;   // of h: above the surface of a heap, or below its base
constexpr double kSmallWidth = 1e-3;  // of h: cells of which nothing is told
constexpr double kSteepest = 80;      // degrees
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using Units = std::vector<std::pair<std::string, double>>;

// In m; nan: h.
const Units& lengths() {
  static const Units units{{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"h", kNan}};
  return units;
}
// In Pa (2D: N/m); nan: rho g h, or F/h of a layer (3D: F/h2).
const Units& stresses() {
  static const Units units{{"Pa", 1},     {"kPa", 1e3},   {"MPa", 1e6},  {"N/m", 1},
                           {"N/m2", 1},   {"kN/m2", 1e3}, {"mbar", 1e2}, {"rho_g_h", kNan},
                           {"F/h", kNan}, {"F/h2", kNan}};
  return units;
}

// Whether one of `units` is of this kind, as that of parse_unit.
bool is_of(const std::string& kind, const Units& units) {
  return std::any_of(units.begin(), units.end(), [&](const auto& known) {
    const std::optional<Unit> unit = parse_unit(known.first);
    return unit && unit->kind == kind;
  });
}

// The stresses of space and of a plane that has a thickness.
bool is_per_area(const std::string& unit) {
  const std::optional<Unit> known = parse_unit(unit);
  return unit == "mbar" || (known && known->kind == parse_unit("Pa")->kind);
}

std::vector<std::string> names_of(const Units& units) {
  std::vector<std::string> names;
  for (const auto& [name, factor] : units) names.push_back(name);
  return names;
}

// A number's column and what its numbers are times.
struct Measure {
  ForeignColumn column;
  double factor = 1;
  explicit operator bool() const { return bool(column); }
  double of(const ForeignRow& row) const {
    const double value = factor * row.number(column);
    if (!(std::abs(value) <= dem::kMostNumber))
      row.refuse(
          fmt::format("column {}: found {}, which becomes {} in SI units, allowed: {:g} at "
                      "most, either way",
                      column.name, row.text(column), value, dem::kMostNumber));
    return value;
  }
};

class Reader {
 public:
  Reader(const MeasuredRequest& request, const ForeignTable& table)
      : request_(request), table_(table) {
    for (std::size_t k = 0; k < table.columns->size(); ++k)
      headings_.push_back(heading_of((*table.columns)[k], static_cast<int>(k)));
    name_value();
  }

  /// Component of all values, where their column has its name ("pressure"); else empty.
  const std::string& component() const { return component_; }
  bool has(const std::string& name) const { return find(name) != nullptr; }
  /// Whether it has columns of other names, one of which may be a column that is missing.
  bool has_others() const {
    const auto known = [](const Heading& h) {
      const std::string plain = plain_column_name(h.name);
      for (const char* name : {"x", "y", "z", "r", "component", "value", "error"})
        if (plain == name) return true;
      return plain.empty();
    };
    return !std::all_of(headings_.begin(), headings_.end(), known);
  }
  /// The unit of a column; empty: none, or no such column.
  std::string unit(const std::string& name) const {
    const Heading* found = find(name);
    return found == nullptr ? "" : found->unit;
  }
  ForeignColumn need(const std::string& name) const {
    if (const Heading* found = find(name)) return {name, found->index, std::nullopt, std::nullopt};
    std::vector<std::string> there;
    for (const Heading& h : headings_)
      there.push_back(h.name == "value" && !component_.empty() ? component_ : h.name);
    const std::string meant = continuum::misspelt(name, there);
    refuse(fmt::format(
        "no column \"{}\"; found: {}{}; expected x (UNIT), component, value (UNIT), error (UNIT) "
        "and, for cones, r (UNIT) instead of x, with empty cells where an error is unknown; a "
        "measurement of one component may write pressure (UNIT) or shear (UNIT) instead of both",
        name, fmt::join(there, ", "),
        meant.empty() ? "" : fmt::format("; did you mean {}?", meant)));
  }
  Measure length(const std::string& name, bool needed) const {
    return measure(name, needed, lengths(), request_.height);
  }
  Measure stress(const std::string& name, bool needed) const {
    return measure(name, needed, stresses(), kNan);
  }

 private:
  // Without columns component and value, the only column named by a component has the values.
  void name_value() {
    Heading* only = nullptr;
    for (Heading& h : headings_) {
      const std::string plain = plain_column_name(h.name);
      if (plain == "component" || plain == "value") return;
      if (plain.rfind("sigma", 0) == 0) return;
      if (plain != "pressure" && plain != "shear") continue;
      if (only != nullptr) return;
      only = &h;
    }
    if (only == nullptr) return;
    component_ = plain_column_name(only->name);
    only->name = "value";
  }
  // By its name; else the only one that is the same without regard to capitals and signs.
  const Heading* find(const std::string& name) const {
    for (const Heading& h : headings_)
      if (h.name == name) return &h;
    const auto plainly = [&](const Heading& h) { return plain_column_name(h.name) == name; };
    const auto at = std::find_if(headings_.begin(), headings_.end(), plainly);
    if (at == headings_.end() || std::any_of(at + 1, headings_.end(), plainly)) return nullptr;
    return &*at;
  }
  [[noreturn]] void refuse(const std::string& what) const {
    throw std::invalid_argument(fmt::format("{}:{}: {}", table_.file, table_.header_line, what));
  }
  Measure measure(const std::string& name, bool needed, const Units& units, double own) const {
    if (needed) need(name);
    const Heading* heading = find(name);
    if (heading == nullptr) return {};
    const std::string& called = name == "value" && !component_.empty() ? component_ : name;
    for (const auto& [unit, factor] : units) {
      if (unit != heading->unit) continue;
      const double scale = !std::isnan(factor) ? factor : &units == &lengths() ? own : scaled(unit);
      return {{called, heading->index, std::nullopt, std::nullopt}, scale};
    }
    if (const auto other = parse_unit(heading->unit); other && is_of(other->kind, units))
      return {{called, heading->index, std::nullopt, std::nullopt}, std::pow(10.0, other->ten)};
    const auto names = names_of(units);
    refuse(heading->unit.empty()
               ? fmt::format("column {}: found no unit, expected one in brackets, such as {} ({}); "
                             "allowed: {}",
                             called, called, names[1], fmt::join(names, ", "))
               : fmt::format("column {}: found the unit \"{}\", allowed: {}", called, heading->unit,
                             fmt::join(names, ", ")));
  }
  // The scale of the heap or the response.
  double scaled(const std::string& unit) const {
    const MeasuredRequest& r = request_;
    double out = kNan;
    if (unit == "rho_g_h") out = r.rho_g * r.height;
    if (unit == "F/h" && r.dim == 2) out = r.load / r.height;
    if (unit == "F/h2" && r.dim == 3) out = r.load / r.height / r.height;
    if (std::isnan(out))
      refuse(fmt::format("found the unit \"{}\", which needs {}", unit,
                         unit == "rho_g_h" ? "--rho-g"
                                           : fmt::format("--load and {} dimensions",
                                                         unit == "F/h" ? "two" : "three")));
    return out;
  }

  const MeasuredRequest& request_;
  const ForeignTable& table_;
  std::vector<Heading> headings_;
  std::string component_;
};

// Column of the field and the sign of a value in it.
std::pair<std::string, double> component_of(const ForeignRow& row, std::string_view word, int dim) {
  const bool space = dim == 3;
  if (word == "pressure") return {space ? "sigma_zz" : "sigma_yy", -1};
  if (word == "shear") return {space ? "sigma_xz" : "sigma_xy", 1};
  const auto& stresses_known = space ? kSpaceStress : kPlaneStress;
  if (std::find(stresses_known.begin(), stresses_known.end(), word) == stresses_known.end())
    row.refuse(fmt::format("component: found \"{}\", allowed: pressure, shear, {}", word,
                           fmt::join(stresses_known, ", ")));
  return {std::string(word), 1};
}

void require_above_zero(const char* option, double value, const char* why) {
  if (value > 0 && value <= dem::kMostNumber) return;
  throw std::invalid_argument(std::isnan(value)
                                  ? fmt::format("{}: is missing; {}", option, why)
                                  : fmt::format("{}: found {:g}, allowed: above 0, up to {:g}",
                                                option, value, dem::kMostNumber));
}

void check(const MeasuredRequest& r) {
  if (r.geometry != "heap" && r.geometry != "layer")
    throw std::invalid_argument(
        fmt::format("--geometry: found \"{}\", allowed: heap, layer; did you mean {}?", r.geometry,
                    continuum::nearest(r.geometry, {"heap", "layer"})));
  if (r.dim != 0 && r.dim != 2 && r.dim != 3)
    throw std::invalid_argument(fmt::format("--dim: found {}, allowed: 2, 3", r.dim));
  require_above_zero("--height", r.height, "the height of the heap or layer, m");
  if (!(r.width >= 0 && r.width <= kWidestCell * r.height))
    throw std::invalid_argument(fmt::format(
        "--width: found {:g}, allowed: above 0, up to {:g} (a quarter of --height), in m", r.width,
        kWidestCell * r.height));
  const auto refuse_given = [&](const char* option, double value, const char* geometry) {
    if (std::isnan(value)) return;
    throw std::invalid_argument(
        fmt::format("{}: found {:g}, allowed with --geometry {} alone", option, value, geometry));
  };
  if (r.geometry == "layer") {
    refuse_given("--slope, --left-deg", r.left_deg, "heap");
    refuse_given("--slope, --right-deg", r.right_deg, "heap");
    refuse_given("--rho-g", r.rho_g, "heap");
    if (!std::isnan(r.load)) require_above_zero("--load", r.load, "");
    return;
  }
  refuse_given("--load", r.load, "layer");
  require_above_zero("--rho-g", r.rho_g, "the weight per volume of the heap, N/m3 (2D: N/m2)");
  for (const auto& [option, slope] :
       {std::pair{"--left-deg", r.left_deg}, {"--right-deg", r.right_deg}}) {
    if (!(slope > 0 && slope <= kSteepest))
      throw std::invalid_argument(
          std::isnan(slope)
              ? fmt::format("{}: is missing; --slope sets both sides of the heap", option)
              : fmt::format("{}: found {:g}, allowed: above 0, up to {:g}", option, slope,
                            kSteepest));
  }
}

struct Value {
  double value = kNan, error = kNan;
  long long line = 0;
};
struct Place {
  std::array<double, 3> at{};  ///< x, across, up; m
  std::map<std::string, Value> values;
};

}  // namespace

const std::vector<std::string>& length_units() {
  static const std::vector<std::string> names = names_of(lengths());
  return names;
}
const std::vector<std::string>& stress_units() {
  static const std::vector<std::string> names = names_of(stresses());
  return names;
}

std::string name_of_measured(const Field& field) {
  const double h = field.number("h");
  const Eigen::VectorXd heights = field.points.col(field.points.cols() - 1);
  return (heights.array() + h).abs().maxCoeff() <= kSamePlace * h ? "base" : "measured";
}

namespace {

Eigen::Index places_outside(const Field& field, const MeasuredHeap& heap) {
  const auto x = field.points.col(0).array();
  return (x < -kOutside * heap.left || x > kOutside * heap.right).count();
}

// Places above the surface of the heap or layer, or below its base. All values at the surface of a
// layer are those of its load.
struct OffHeights {
  Eigen::Index above = 0, below = 0;
  Eigen::Index all() const { return above + below; }
};

OffHeights off_heights(const Field& field, const std::optional<MeasuredHeap>& heap) {
  const double h = field.number("h");
  const Eigen::Index up = field.points.cols() - 1;
  OffHeights out;
  for (Eigen::Index k = 0; k < field.points.rows(); ++k) {
    const double x = field.points(k, 0), height = field.points(k, up);
    const double away = up == 2 ? std::hypot(x, field.points(k, 1)) : std::abs(x);
    const double foot = heap ? (x < 0 ? heap->left : heap->right) : 0;
    const bool above =
        heap ? height > -h * std::min(1.0, away / foot) + kOffHeight * h : height > -kSamePlace * h;
    out.above += above;
    out.below += height < -(1 + kOffHeight) * h;
  }
  return out;
}

std::string of_heights(const Field& field, const OffHeights& off, bool heap,
                       const char* allowed = "") {
  const double h = field.number("h");
  const Eigen::Index up = field.points.cols() - 1;
  const char axis = "xyz"[up];
  const char* where = "above the surface or below the base";
  if (off.below == 0) where = heap ? "above the heap's surface" : "at or above the surface";
  if (off.above == 0) where = "below the base";
  std::string hint;
  if (field.points.col(up).minCoeff() >= 0) {
    hint = fmt::format(": are heights counted from the base? {} - {}", axis, h);
  } else if (off.above == 0) {
    hint = ": is the unit of heights right?";
  }
  return fmt::format("{} of {} places lie {}{}; {} is 0 at the {}, -{} on the base{}", off.all(),
                     field.points.rows(), where, allowed, axis, heap ? "apex" : "surface", h, hint);
}

void refuse_heights(const Field& field, const std::optional<MeasuredHeap>& heap) {
  const OffHeights off = off_heights(field, heap);
  if (4 * off.all() > field.points.rows())
    throw std::invalid_argument(
        of_heights(field, off, heap.has_value(), ", allowed: a quarter of them"));
}

std::string of_outside(const Field& field, const MeasuredHeap& heap, Eigen::Index outside) {
  return fmt::format("{} of {} places lie outside the heap, whose feet are at {:.3g} and {:.3g} m",
                     outside, field.points.rows(), -heap.left, heap.right);
}

void refuse_narrow(const Field& field, const MeasuredHeap& heap) {
  const std::vector<LevelPressure> base = base_pressures(field, heap);
  if (base.size() < kEnoughToCarry) return;
  const double outermost = std::max(-base.front().x, base.back().x);
  const double foot = std::min(heap.left, heap.right);
  if (outermost >= kNarrow * foot) return;
  throw std::invalid_argument(fmt::format(
      "all {} places on the base lie within {:.3g} m of the axis, where the feet are at {:.3g} and "
      "{:.3g} m, allowed: the outermost {:g} m or more away; correct the unit of x, or the height "
      "(--height, m)",
      base.size(), outermost, -heap.left, heap.right, kNarrow * foot));
}

void refuse_impossible(const Field& field) {
  const std::optional<MeasuredHeap> heap = measured_heap(field);
  if (!heap) return;
  if (const Eigen::Index outside = places_outside(field, *heap);
      4 * outside > field.points.rows()) {
    throw std::invalid_argument(
        of_outside(field, *heap, outside) +
        ", allowed: a quarter of them; correct the unit of x, or its origin: 0 is below the apex");
  }
  refuse_heights(field, heap);
  refuse_narrow(field, *heap);
  const std::optional<CarriedShare> carried = carried_share(field);
  if (!carried) return;
  const double share = carried->share;
  const bool heavy = share > kImpossible, light = share > 0 && share < kTooLight;
  if (!heavy && !light) return;
  throw std::invalid_argument(fmt::format(
      "{}, allowed: {}; correct the unit of the values, or --height, --slope, --rho-g",
      share_text(*carried),
      heavy ? fmt::format("up to {:g}", kImpossible) : fmt::format("{:g} or more", kTooLight)));
}

}  // namespace

namespace {

ForeignTable table_of(const std::string& file) {
  std::vector<std::string> units = names_of(lengths()), stresses_known = names_of(stresses());
  units.insert(units.end(), stresses_known.begin(), stresses_known.end());
  return scan_csv(
      file, {{"x", "y", "z", "r", "component", "value", "error", "pressure", "shear"}, units});
}

}  // namespace

std::string settle(MeasuredRequest& r) {
  check(r);
  const ForeignTable table = table_of(r.file);
  const Reader columns(r, table);
  for (const char* name : {"z", "r"}) {
    if (!columns.has(name)) continue;
    if (r.dim == 2)
      throw std::invalid_argument(
          fmt::format("--dim: found 2 with the column {} in {}, allowed: 3", name, r.file));
    r.dim = 3;
  }
  const std::string unit = columns.unit("value");
  if (r.dim != 0) return "";
  r.dim = unit == "F/h2" ? 3 : 2;
  if (!is_per_area(unit)) return "";
  if (r.geometry == "layer" && !std::isnan(r.load))
    throw std::invalid_argument(fmt::format(
        "--dim: is missing, and values in {} under a load in N are those of three dimensions: give "
        "--dim 3, or --dim 2 for a slice whose --load is N per metre of its thickness",
        unit));
  return fmt::format("values in {} are those of a {} (2D: 1 Pa counts as 1 N/m); of a {}: --dim 3",
                     unit, r.geometry == "heap" ? "long heap" : "slice",
                     r.geometry == "heap" ? "cone" : "layer in space");
}

Field measured_field(const MeasuredRequest& given) {
  MeasuredRequest request = given;
  settle(request);
  const double h = request.height;
  const ForeignTable table = table_of(request.file);
  const Reader columns(request, table);
  const bool space = request.dim == 3;
  const bool radial = columns.has("r") && !columns.has("x");
  const Measure x = columns.length(radial ? "r" : "x", true), side = columns.length("y", false),
                up = columns.length("z", false), value = columns.stress("value", true),
                error = columns.stress("error", columns.has_others());
  const std::string& all = columns.component();
  const ForeignColumn component = all.empty() ? columns.need("component") : ForeignColumn{};
  // By place, from left to right, lowest first.
  std::map<std::array<double, 3>, Place> found;
  TableReader reader;
  reader.read(table, [&](const ForeignRow& row) {
    const Measure& height = space ? up : side;
    const double at = height && !row.empty(height.column) ? height.of(row) : -h;
    const double beside = space && side && !radial ? side.of(row) : 0;
    if (radial && x.of(row) < 0)
      row.refuse(fmt::format("column r: found {}, allowed: 0 or more, a distance from the axis",
                             row.text(x.column)));
    const auto round = [&](double length) { return std::round(length / h / kSamePlace); };
    const auto [name, sign] =
        component_of(row, all.empty() ? row.text(component) : all, request.dim);
    Value one{sign * value.of(row), kNan, row.line};
    if (error && !row.empty(error.column)) one.error = error.of(row);
    if (one.error <= 0)
      row.refuse(
          fmt::format("column error: found {}, allowed: above 0, or empty where it is unknown",
                      row.text(error.column)));
    Place& place = found[{round(at), round(beside), round(x.of(row))}];
    if (place.values.empty()) place.at = {x.of(row), beside, at};
    const auto [there, fresh] = place.values.emplace(name, one);
    if (!fresh)
      row.refuse(fmt::format("{} at x = {:g} m is there already, at {}:{}",
                             all.empty() ? row.text(component) : all, x.of(row), request.file,
                             there->second.line));
  });
  if (found.empty())
    throw std::invalid_argument(
        request.file + ": holds no value, expected a row for each below the line of names");

  Field out;
  const auto n = static_cast<Eigen::Index>(found.size());
  out.points.resize(n, request.dim);
  for (const std::string& name : space ? kSpaceStress : kPlaneStress) {
    const bool measured = std::any_of(found.begin(), found.end(), [&](const auto& place) {
      return place.second.values.count(name) > 0;
    });
    if (!measured) continue;
    Column& column = out.add(name, space ? "Pa" : "N/m");
    column.value = column.error = Eigen::VectorXd::Constant(n, kNan);
  }
  Eigen::Index k = 0;
  for (const auto& [key, place] : found) {
    if (space)
      out.points.row(k) << place.at[0], place.at[1], place.at[2];
    else
      out.points.row(k) << place.at[0], place.at[2];
    for (Column& column : out.columns) {
      const auto one = place.values.find(column.name);
      if (one == place.values.end()) continue;
      column.value[k] = one->second.value;
      column.error[k] = one->second.error;
    }
    ++k;
  }
  auto& about = out.attributes;
  about["method"] = "measured";
  about["kernel"] = "heaviside";
  about["width"] = request.width > 0 ? request.width : kSmallWidth * h;
  about["h"] = h;
  about["measured_file"] = request.file;
  about["frame"] = request.geometry;
  if (request.geometry == "layer") {
    if (!std::isnan(request.load)) about["F"] = request.load;
    refuse_heights(out, std::nullopt);
    return out;
  }
  about["lengths"] = "m";
  about["rho_g_h"] = request.rho_g * h;
  about["left_deg"] = request.left_deg;
  about["right_deg"] = request.right_deg;
  refuse_impossible(out);
  return out;
}

namespace {

// Where most shear stresses pull the floor inwards: a heap spreads, and its free side (tension
// positive: sigma_xx < 0, sigma_xy = -sigma_xx tan(slope)) and its floor hold it; else empty.
std::string turned_shears(const Field& field) {
  const std::string name = field.points.cols() == 3 ? "sigma_xz" : "sigma_xy";
  const Column* shear = field.find(name);
  if (shear == nullptr) return "";
  long clear = 0, turned = 0;
  for (Eigen::Index k = 0; k < shear->value.size(); ++k) {
    const double x = field.points(k, 0), value = shear->value[k], error = shear->error[k];
    if (!(x * value != 0) || std::isnan(value)) continue;
    if (std::abs(value) < kClear * error) continue;  // an unknown error is nan
    ++clear;
    turned += x * value < 0;
  }
  if (clear < kEnoughShears ||
      static_cast<double>(turned) <= kMostTurned * static_cast<double>(clear))
    return "";
  return fmt::format(
      "{} of {} shear stresses ({}) are those of a heap that pulls its floor inwards: a heap that "
      "spreads has shear above 0 right of the axis (x > 0), below 0 left of it; turn their signs",
      turned, clear, name);
}

}  // namespace

std::vector<std::string> measured_doubts(const Field& field) {
  const std::optional<MeasuredHeap> heap = measured_heap(field);
  const std::optional<CarriedShare> carried = carried_share(field);
  std::vector<std::string> out;
  const OffHeights off = field.is_measured() ? off_heights(field, heap) : OffHeights{};
  if (off.all() > 0) out.push_back(of_heights(field, off, heap.has_value()));
  if (!heap) {
    if (carried) out.push_back(share_doubt(*carried));
    std::erase(out, "");
    return out;
  }
  if (const Eigen::Index outside = places_outside(field, *heap); outside > 0) {
    out.push_back(of_outside(field, *heap, outside) +
                  ": is the unit of x right, and its origin, 0 below the apex?");
  }
  const std::vector<LevelPressure> base = base_pressures(field, *heap);
  const auto pulls =
      std::count_if(base.begin(), base.end(), [](const auto& p) { return p.pressure < 0; });
  if (2 * pulls > static_cast<long>(base.size())) {
    out.push_back(
        fmt::format("{} of {} pressures are negative: a pressure is positive where the "
                    "heap presses; turn their signs",
                    pulls, base.size()));
  }
  if (const std::string turned = turned_shears(field); !turned.empty()) out.push_back(turned);
  Eigen::Index values = 0;
  for (const Column& column : field.columns) values += column.value.array().isFinite().count();
  if (values < kLeastToFit) {
    out.push_back(fmt::format("holds {} values; fit needs {} or more", values, kLeastToFit));
  }
  std::vector<double> shares;
  for (const Column& column : field.columns) {
    for (Eigen::Index k = 0; k < column.error.size(); ++k) {
      const double one = column.error[k] / std::fabs(column.value[k]);
      if (std::isfinite(one)) shares.push_back(one);
    }
  }
  const double error = shares.empty() ? kNan : boost::math::statistics::median(shares);
  if (error < kLeastError || error > kMostError) {
    out.push_back(fmt::format(
        "errors are {:.2g} times their values in the median: is their unit right?", error));
  }
  if (carried) out.push_back(share_doubt(*carried));
  std::erase(out, "");
  return out;
}

}  // namespace grainfield::coupling
