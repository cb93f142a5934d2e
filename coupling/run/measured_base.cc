#include "coupling/run/measured_base.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "coupling/case/declare.h"
#include "coupling/store/field_io.h"

namespace grainfield::coupling {
namespace {

constexpr double kMiddleHalf = 0.25, kCentreHalf = 0.05;  // of the base
// The lines at 60 degrees through the apex meet the base where the line model's shear bends. The
// straight part is taken up to this share of the way: grains bend a fifth earlier at most, which
// was seen on the piles of liffman-soft-piles before this was set.
constexpr double kBeforeBend = 0.8;
// Places so far beyond the grains' outermost, over the base, still have a value of theirs.
constexpr double kBeyond = 1e-3;
// Places this share of the height off the base, and in space off the plane y = 0, are on it.
constexpr double kOnBase = 1e-5;
constexpr Eigen::Index kFewestPlaces = 5;

double attribute(const Field& field, const char* key, const std::string& file) {
  const double number = field.number(key);
  if (std::isfinite(number)) return number;
  throw std::invalid_argument(fmt::format(
      "measured.field: {} has no {} of a heap; found {}, expected a field of `grainfield "
      "import-field` with --height and --slope",
      file, key, field.has(key) ? "\"" + attribute_text(field.attributes.at(key)) + "\"" : "none"));
}

double largest(const Eigen::VectorXd& v) { return v.cwiseAbs().maxCoeff(); }

// The value of a curve through points with ascending x; nan beyond them.
double interpolated(const Eigen::VectorXd& x, const Eigen::VectorXd& y, double at) {
  if (x.size() == 0 || at < x[0] - kBeyond || at > x[x.size() - 1] + kBeyond) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  Eigen::Index k = 1;
  while (k + 1 < x.size() && x[k] < at) ++k;
  if (x.size() == 1) return y[0];
  const double share = (at - x[k - 1]) / (x[k] - x[k - 1]);
  return y[k - 1] + share * (y[k] - y[k - 1]);
}

// Root mean square of the differences, and their squares over the errors' where all are known.
struct Distance {
  double rms = 0, chi2 = 0;
  int places = 0;
  bool with_errors = true;
};
Distance distance(const BaseProfile& grains, const Eigen::VectorXd& of_grains,
                  const Eigen::VectorXd& grains_error, const BaseProfile& measured,
                  const Eigen::VectorXd& values, const Eigen::VectorXd& errors) {
  Distance out;
  for (Eigen::Index k = 0; k < measured.x.size(); ++k) {
    const double difference = interpolated(grains.x, of_grains, measured.x[k]) - values[k];
    if (!std::isfinite(difference)) continue;
    out.rms += difference * difference;
    ++out.places;
    double variance = errors.size() > 0 ? errors[k] * errors[k] : 0;
    const double ours = grains_error.size() > 0
                            ? interpolated(grains.x, grains_error, measured.x[k])
                            : std::numeric_limits<double>::quiet_NaN();
    if (std::isfinite(ours)) variance += ours * ours;
    out.with_errors = out.with_errors && variance > 0;
    out.chi2 += difference * difference / variance;
  }
  out.rms = std::sqrt(out.rms / out.places);
  return out;
}

Frame frame_of(const char* title, const BaseProfile& grains, const Eigen::VectorXd& of_grains,
               const Eigen::VectorXd& grains_error, const BaseProfile& measured,
               const Eigen::VectorXd& values, const Eigen::VectorXd& errors) {
  Frame frame;
  frame.title = title;
  frame.series.push_back({"grains", grains.x, of_grains, grains_error, true});
  Series there{"measured", measured.x, values, errors, false};
  there.banded = true;
  frame.series.push_back(std::move(there));
  return frame;
}

}  // namespace

void declare_measured_keys(SectionKeys s) {
  s.word(
      "field", GRAINFIELD_MEMBER(MeasuredSetup, field), {},
      "measured base forces to stand beside the grains: a file of `grainfield import-field` of a "
      "heap with pressures and shears; \"\": none",
      "Liffman et al. 1992, fig. 17");
  s.word("name", GRAINFIELD_MEMBER(MeasuredSetup, name), {}, "of the field in it");
}

std::vector<SummaryKey> measured_figures() {
  return {
      {"measured.places", "-", "places of the base where a pressure and a shear were measured"},
      {"measured.normal_rms", "-",
       "root mean square difference of the grains' normal forces from the measured ones, each over "
       "its own largest (Liffman fig. 17)"},
      {"measured.shear_rms", "-", "the same of the shear forces"},
      {"measured.normal_chi2", "-",
       "squares of these differences over those of the standard errors, mean over the places; "
       "needs errors of all"},
      {"measured.shear_chi2", "-", "the same of the shear forces"},
      {"measured.normal_centre", "-",
       "measured: mean normal force within 1/20 of the base of its middle over the largest"},
      {"measured.shear_slope_ratio", "-",
       "slope of the grains' shear in the middle of the base over that measured, each over its "
       "largest shear; each middle is that of liffman.horizontal_slope for its own heap"},
      {"measured.shear_explained", "-",
       "share of the measured shear's variance there that the line explains"},
  };
}

BaseProfile BaseProfile::normalized() const {
  BaseProfile out = *this;
  const double n = largest(normal), s = largest(shear);
  if (n > 0) out.normal /= n;
  if (n > 0 && out.normal_error.size() > 0) out.normal_error /= n;
  if (s > 0) out.shear /= s;
  if (s > 0 && out.shear_error.size() > 0) out.shear_error /= s;
  return out;
}

BaseProfile measured_base(const MeasuredSetup& setup) {
  Field field;
  try {
    field = read_field(setup.field, setup.name);
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(std::string("measured.field: ") + e.what());
  }
  const bool space = field.points.cols() == 3;
  const Column* pressure = field.find(space ? "sigma_zz" : "sigma_yy");
  const Column* shear = field.find(space ? "sigma_xz" : "sigma_xy");
  if (pressure == nullptr || shear == nullptr) {
    throw std::invalid_argument(
        fmt::format("measured.name: field \"{}\" of {} has no {}, needed: "
                    "pressures and shears of the base",
                    setup.name, setup.field, pressure == nullptr ? "pressure" : "shear"));
  }
  const double h = attribute(field, "h", setup.field);
  const auto foot = [&](const char* key) {
    return h / std::tan(attribute(field, key, setup.field) * std::numbers::pi / 180);
  };
  const double left = foot("left_deg"), right = foot("right_deg");
  std::vector<std::pair<double, Eigen::Index>> places;
  for (Eigen::Index k = 0; k < field.points.rows(); ++k) {
    const bool off = std::fabs(field.points(k, field.points.cols() - 1) + h) > kOnBase * h ||
                     (space && std::fabs(field.points(k, 1)) > kOnBase * h);
    if (off || !std::isfinite(pressure->value[k]) || !std::isfinite(shear->value[k])) continue;
    places.emplace_back(field.points(k, 0), k);
  }
  std::sort(places.begin(), places.end());
  const auto n = static_cast<Eigen::Index>(places.size());
  if (n < kFewestPlaces) {
    throw std::invalid_argument(fmt::format(
        "measured.field: {} has {} places on the base with a pressure and a shear, allowed: {} or "
        "more",
        setup.field, n, kFewestPlaces));
  }
  BaseProfile out;
  out.height = h / (left + right);
  out.x = out.normal = out.shear = out.normal_error = out.shear_error = Eigen::VectorXd(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto [x, k] = places[static_cast<std::size_t>(i)];
    out.x[i] = (x - 0.5 * (right - left)) / (left + right);
    out.normal[i] = -pressure->value[k];
    out.shear[i] = shear->value[k];
    out.normal_error[i] = pressure->error[k];
    out.shear_error[i] = shear->error[k];
  }
  return out;
}

MiddleShear middle_shear(const BaseProfile& base) {
  Eigen::VectorXd away = base.x.cwiseAbs();
  std::sort(away.data(), away.data() + away.size());
  const double fewest = away[std::min(kFewestPlaces, away.size()) - 1] + kBeyond;
  const double straight = std::min(kMiddleHalf, kBeforeBend * base.height / std::numbers::sqrt3);
  const double half = std::max(straight, fewest);
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (Eigen::Index k = 0; k < base.x.size(); ++k) {
    if (std::fabs(base.x[k]) > half) continue;
    n += 1;
    x += base.x[k];
    y += base.shear[k];
    xx += base.x[k] * base.x[k];
    xy += base.x[k] * base.shear[k];
    yy += base.shear[k] * base.shear[k];
  }
  const double sxx = xx - x * x / n, sxy = xy - x * y / n, syy = yy - y * y / n;
  return {sxy / sxx / largest(base.shear), syy > 0 ? sxy * sxy / (sxx * syy) : 1};
}

double centre_over_largest(const BaseProfile& base) {
  double sum = 0, count = 0, nearest = base.normal[0], best = std::fabs(base.x[0]);
  for (Eigen::Index k = 0; k < base.x.size(); ++k) {
    const double away = std::fabs(base.x[k]);
    if (away < best) nearest = base.normal[k];
    best = std::min(best, away);
    if (away > kCentreHalf) continue;
    sum += base.normal[k];
    count += 1;
  }
  return (count > 0 ? sum / count : nearest) / largest(base.normal);
}

Chart beside_measured(const BaseProfile& grains, const BaseProfile& measured, Summary& summary) {
  const BaseProfile a = grains.normalized(), b = measured.normalized();
  const Distance normal = distance(a, a.normal, a.normal_error, b, b.normal, b.normal_error);
  const Distance shear = distance(a, a.shear, a.shear_error, b, b.shear, b.shear_error);
  summary["measured.places"] = static_cast<std::int64_t>(b.x.size());
  summary["measured.normal_rms"] = normal.rms;
  summary["measured.shear_rms"] = shear.rms;
  if (normal.with_errors) summary["measured.normal_chi2"] = normal.chi2 / normal.places;
  if (shear.with_errors) summary["measured.shear_chi2"] = shear.chi2 / shear.places;
  const MiddleShear there = middle_shear(b);
  summary["measured.normal_centre"] = centre_over_largest(b);
  summary["measured.shear_slope_ratio"] = middle_shear(a).slope / there.slope;
  summary["measured.shear_explained"] = there.explained;
  Chart out;
  out.title = "Beside the measurement";
  out.x_label = "x / B";
  out.y_label = "force / largest";
  out.caption =
      "Normal and shear force on the ground over the largest of each, against the place over the "
      "base (Liffman fig. 17). Bands: standard errors, where they are known.";
  out.frames = {frame_of("N", a, a.normal, a.normal_error, b, b.normal, b.normal_error),
                frame_of("H", a, a.shear, a.shear_error, b, b.shear, b.shear_error)};
  return out;
}

}  // namespace grainfield::coupling
