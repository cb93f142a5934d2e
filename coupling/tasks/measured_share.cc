#include "coupling/tasks/measured_share.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>

#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kSameLevel = 1e-6;  // of h
constexpr std::size_t kLeastPlaces = 5;

// Places, pressures and errors of one level, from left to right; in space by the distance from the
// axis, means over places of one distance.
std::vector<LevelPressure> pressures_at(const Field& field, double height, double tolerance) {
  const bool space = field.points.cols() == 3;
  const Column* stress = field.find(space ? "sigma_zz" : "sigma_yy");
  std::vector<LevelPressure> out;
  if (stress == nullptr) return out;
  for (Eigen::Index k = 0; k < field.points.rows(); ++k) {
    const double up = field.points(k, field.points.cols() - 1);
    if (std::fabs(up - height) > tolerance || !std::isfinite(stress->value[k])) continue;
    const double x =
        space ? std::hypot(field.points(k, 0), field.points(k, 1)) : field.points(k, 0);
    out.push_back({x, -stress->value[k], stress->error.size() > 0 ? stress->error[k] : kUnknown});
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  if (!space) return out;
  std::vector<LevelPressure> rings;
  for (std::size_t k = 0; k < out.size();) {
    LevelPressure mean{out[k].x, 0, 0};
    double count = 0;
    for (; k < out.size() && out[k].x - mean.x <= tolerance; ++k, ++count) {
      mean.pressure += out[k].pressure;
      mean.error += out[k].error * out[k].error;
    }
    rings.push_back({mean.x, mean.pressure / count, std::sqrt(mean.error) / count});
  }
  return rings;
}

struct Force {
  double value = 0, error = 0;
};

// The force of pressures that are straight between the places: along x, N/m.
Force along(const std::vector<LevelPressure>& level) {
  Force out;
  double variance = 0;
  for (std::size_t k = 0; k < level.size(); ++k) {
    const double before = k > 0 ? level[k].x - level[k - 1].x : 0;
    const double after = k + 1 < level.size() ? level[k + 1].x - level[k].x : 0;
    const double weight = 0.5 * (before + after);
    out.value += weight * level[k].pressure;
    variance += std::pow(weight * level[k].error, 2);
  }
  out.error = std::sqrt(variance);
  return out;
}

// Over rings out to the last place, N; within the first the pressure is that of the first.
// Integral of p r over a piece where p is straight: (b - a) ((2a + b) p_a + (a + 2b) p_b)/6.
Force over_rings(const std::vector<LevelPressure>& level) {
  std::vector<double> weight(level.size(), 0.0);
  weight[0] += std::numbers::pi * level[0].x * level[0].x;
  for (std::size_t k = 0; k + 1 < level.size(); ++k) {
    const double a = level[k].x, b = level[k + 1].x, piece = std::numbers::pi / 3 * (b - a);
    weight[k] += piece * (2 * a + b);
    weight[k + 1] += piece * (a + 2 * b);
  }
  Force out;
  double variance = 0;
  for (std::size_t k = 0; k < level.size(); ++k) {
    out.value += weight[k] * level[k].pressure;
    variance += std::pow(weight[k] * level[k].error, 2);
  }
  out.error = std::sqrt(variance);
  return out;
}

// "13870", for a command line.
std::string four_digits(double value) {
  return fmt::format("{}", parse_number(fmt::format("{:.4g}", value)).value_or(value));
}

Force force_of(const std::vector<LevelPressure>& level, int dim) {
  return dim == 3 ? over_rings(level) : along(level);
}

// The share of `whole` that the level carries, beside that of a pressure which is known everywhere.
CarriedShare share_of(std::vector<LevelPressure> level, int dim, double whole,
                      const std::function<double(double)>& reference) {
  const Force force = force_of(level, dim);
  CarriedShare out;
  out.share = force.value / whole;
  out.error = force.error / whole;
  out.carrier = "the pressures on the base";
  for (LevelPressure& place : level) place.pressure = reference(place.x);
  const double seen = force_of(level, dim).value / whole;
  out.least = std::min(1.0, seen);
  out.most = std::max(1.0, seen);
  return out;
}

std::optional<CarriedShare> share_of_weight(const Field& field, const MeasuredHeap& heap) {
  const std::vector<LevelPressure> base = base_pressures(field, heap);
  if (base.size() < kLeastPlaces) return std::nullopt;
  const bool space = heap.dim == 3;
  const double weight =
      space ? heap.weight_within(base.back().x) : heap.weight_above(base.front().x, base.back().x);
  const double pressure = field.number("rho_g_h");
  CarriedShare out = share_of(base, heap.dim, weight, [&](double x) {
    return pressure * std::max(0.0, 1 - (x < 0 ? -x / heap.left : x / heap.right));
  });
  out.carried = "the weight above them";
  out.instead = "--rho-g " + four_digits(out.share * pressure / field.number("h"));
  return out;
}

// A half plane's or half space's share at the depth d: Flamant, Boussinesq.
double half_body(double load, double x, double d, int dim) {
  return dim == 3
             ? 3 * load * std::pow(d, 3) / (2 * std::numbers::pi) * std::pow(x * x + d * d, -2.5)
             : 2 * load * std::pow(d, 3) / std::numbers::pi * std::pow(x * x + d * d, -2);
}

std::optional<CarriedShare> share_of_load(const Field& field, double load, double h) {
  // The level with the most places.
  std::map<double, int> levels;
  for (Eigen::Index k = 0; k < field.points.rows(); ++k) {
    ++levels[std::round(field.points(k, field.points.cols() - 1) / h / kSameLevel) * kSameLevel *
             h];
  }
  const auto most =
      std::max_element(levels.begin(), levels.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == levels.end()) return std::nullopt;
  const auto level = pressures_at(field, most->first, 2 * kSameLevel * h);
  if (level.size() < kLeastPlaces) return std::nullopt;
  const auto dim = static_cast<int>(field.points.cols());
  CarriedShare out =
      share_of(level, dim, load, [&](double x) { return half_body(load, x, -most->first, dim); });
  if (std::fabs(most->first + h) > 2 * kSameLevel * h) {
    out.carrier = fmt::format("the pressures {:.3g} m below the surface", -most->first);
  }
  out.carried =
      dim == 3 ? fmt::format("the load, within {:.3g} m of its axis", level.back().x)
               : fmt::format("the load, from {:.3g} to {:.3g} m", level.front().x, level.back().x);
  out.instead = "--load " + four_digits(out.share * load);
  return out;
}

}  // namespace

double MeasuredHeap::weight_above(double from, double to) const {
  const auto until = [&](double x) {  // from the left foot, of a wedge of weight 1
    const double length = left + right;
    if (x <= 0) return std::pow(std::max(0.0, x + left), 2) / (left * length);
    return 1 - std::pow(std::max(0.0, right - x), 2) / (right * length);
  };
  return weight * (until(to) - until(from));
}

double MeasuredHeap::weight_within(double radius) const {
  const double share = std::min(1.0, radius / left);
  return weight * share * share * (3 - 2 * share);
}

std::optional<MeasuredHeap> measured_heap(const Field& field) {
  const auto dim = static_cast<int>(field.points.cols());
  const double h = field.number("h"), pressure = field.number("rho_g_h");
  const double left_deg = field.number("left_deg"), right_deg = field.number("right_deg");
  if (!(left_deg > 0) || !(right_deg > 0) || !(pressure > 0) ||
      field.find(dim == 3 ? "sigma_zz" : "sigma_yy") == nullptr) {
    return std::nullopt;
  }
  MeasuredHeap out{dim, h / std::tan(left_deg * kRadiansPerDegree),
                   h / std::tan(right_deg * kRadiansPerDegree), 0};
  out.weight = dim == 3 ? pressure * std::numbers::pi / 3 * out.left * out.left
                        : 0.5 * pressure * (out.left + out.right);
  return out;
}

std::vector<LevelPressure> base_pressures(const Field& field, const MeasuredHeap& heap) {
  const double h = field.number("h");
  std::vector<LevelPressure> out = pressures_at(field, -h, kSameLevel * h);
  const double left = heap.dim == 3 ? 0 : -heap.left;
  std::erase_if(out, [&](const LevelPressure& p) { return p.x < left || p.x > heap.right; });
  return out;
}

std::optional<CarriedShare> carried_share(const Field& field) {
  if (const auto heap = measured_heap(field)) return share_of_weight(field, *heap);
  const double load = field.number("F"), h = field.number("h");
  if (!(load > 0) || !(h > 0)) return std::nullopt;
  return share_of_load(field, load, h);
}

std::string share_text(const CarriedShare& s) {
  const std::string error =
      std::isfinite(s.error) ? fmt::format(" ± {:.2g}", s.error) : std::string();
  return fmt::format("{} carry {:.3g}{} of {}", s.carrier, s.share, error, s.carried);
}

std::string share_doubt(const CarriedShare& s) {
  const double off = std::max(s.share - s.most, s.least - s.share);
  const bool clear = off > kClearShare && off > kClearErrors * s.error;
  const bool far = s.share < kLeastShare || s.share > kMostShare;
  if (!far && !clear) return "";
  const bool weight = s.carried == "the weight above them";
  std::string out = share_text(s);
  if (clear) out += fmt::format(", {:.{}f} errors off", off / s.error, off < 10 * s.error ? 1 : 0);
  out += weight ? ": are the units, --height, --slope and --rho-g right?"
                : ": are the units, --load and --dim right, and do the places reach far enough?";
  if (!(s.share > 0)) return out;
  return out + fmt::format(
                   " Models carry all of it. Multiply the values by {:.4g} if their scale is in "
                   "doubt, or give what was measured, {}",
                   1 / s.share, s.instead);
}

}  // namespace grainfield::coupling
