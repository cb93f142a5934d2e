#include "coupling/reproduce/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/reproduce/box_figures.h"
#include "coupling/reproduce/dips.h"
#include "coupling/reproduce/fit_figures.h"
#include "coupling/reproduce/liffman_figures.h"

namespace grainfield::coupling {
namespace {

using Number = std::function<std::optional<Measured>(const Results&)>;

Number of(const std::string& study, const std::string& key) {
  return [=](const Results& r) { return r.number(study, key); };
}

// The steeper (or flatter) flank by the ensemble's means.
Number flank(const std::string& study, bool steeper) {
  return [=](const Results& r) -> std::optional<Measured> {
    const auto left = r.number(study, "dem.repose_angle_left_deg");
    const auto right = r.number(study, "dem.repose_angle_right_deg");
    if (!left || !right) return std::nullopt;
    return (left->value > right->value) == steeper ? left : right;
  };
}

// Without its sign.
Number size_of(const std::string& study, const std::string& key) {
  return [=](const Results& r) -> std::optional<Measured> {
    const auto found = r.number(study, key);
    if (!found) return std::nullopt;
    return Measured{std::fabs(found->value), found->error};
  };
}

// a / b of independent ensembles. The error is that of a - rho b over b, at the rho of the source's
// range nearest to ours (Fieller): it holds however uncertain b is, where propagation to first
// order does not.
Number ratio(const Number& a, const Number& b, double low, double high) {
  return [=](const Results& r) -> std::optional<Measured> {
    const auto x = a(r), y = b(r);
    if (!x || !y) return std::nullopt;
    const double q = x->value / y->value, rho = std::clamp(q, low, high);
    return Measured{q, std::hypot(x->error, rho * y->error) / std::fabs(y->value)};
  };
}

SourceFigure number(const char* source, const char* what, const char* unit, const char* study,
                    const char* theirs, double low, double high, Number ours, double effect = 0) {
  return {source, what, unit, study, theirs, low, high, {}, std::move(ours), nullptr, effect};
}

SourceFigure dip(const char* source, const char* what, const char* study, const char* theirs,
                 std::vector<std::string> words) {
  const std::string name = study;
  return {
      source,
      what,
      "",
      study,
      theirs,
      0,
      0,
      std::move(words),
      nullptr,
      [name](const Results& r) -> std::optional<std::string> {
        const auto dip = recorded_dip(r, name);
        const auto centre = r.plain(name, "dip.ratio");
        if (!dip || !centre) return std::nullopt;
        return fmt::format(
            "{}: shoulder - centre = {:.3f} ± {:.3f} ρgh, p = {:.2g} if there were none ({:.2g} "
            "over all pours); centre over largest {:.2f}",
            dip->word, dip->difference.value, dip->difference.error, dip->p_value, dip->p_holm,
            *centre);
      },
      0};
}

// A word with the number that supports it.
SourceFigure word(const char* source, const char* what, const char* study, const char* theirs,
                  std::vector<std::string> words, const char* key,
                  std::string (*describe)(double)) {
  const std::string name = study, from = key;
  return {source,
          what,
          "",
          study,
          theirs,
          0,
          0,
          std::move(words),
          nullptr,
          [=](const Results& r) -> std::optional<std::string> {
            const auto value = r.plain(name, from);
            return value ? std::optional(describe(*value)) : std::nullopt;
          },
          0};
}

std::string rve_word(double grains) {
  if (std::isnan(grains)) return "more than fit: none of the sizes tried";
  return fmt::format("{}: {:.0f} grains",
                     grains < 100 ? "fewer" : (grains > 200 ? "more" : "100-200"), grains);
}

std::string tail_word(double p) {
  return fmt::format("{}: p = {:.2g} of a worse fit", p >= 0.05 ? "exponential" : "not exponential",
                     p);
}

std::string within_word(double largest) {
  return fmt::format("{} 1 %: {:.2g} %", largest <= 0.01 ? "within" : "beyond", 100 * largest);
}

std::string peaks_word(double peaks) {
  return peaks == 1 ? "one peak" : fmt::format("{:.0f} peaks", peaks);
}

std::string slope_word(double ratio) {
  return fmt::format("{}: slope at high over slope at low strain {:.2f}",
                     std::fabs(std::log(ratio)) > std::log(1.25) ? "nonlinear" : "linear", ratio);
}

std::string director_word(double degrees) {
  return fmt::format("{}: mean long axis {:.1f}° from the horizontal",
                     std::fabs(degrees) <= 10 ? "horizontal" : "inclined", degrees);
}

}  // namespace

const std::vector<SourceFigure>& source_figures() {
  constexpr const char *kPoint = "pile-point-source", *kLine = "pile-line-source",
                       *kElliptic = "pile-elliptic", *kAsymmetricLine = "pile-asymmetric-line",
                       *kAsymmetricPoint = "pile-asymmetric-point",
                       *kGravity = "pile-gravity-levels", *kFields = "pile-fields",
                       *kFieldsLine = "pile-fields-line", *kFieldsElliptic = "pile-fields-elliptic",
                       *kLattice = "liffman-lattice", *kPentagons = "point-load-pentagons";
  // Of a point source over the surface; a flat fraction is one without it.
  constexpr double kDenserMiddle = 0.09;
  // Angles are read to 1 degree, fractions to 0.01.
  static const std::vector<SourceFigure> own{
      number("Roul 3.1", "angle of repose, point source", "deg", kPoint, "28", 27, 29,
             of(kPoint, "repose.mean_deg")),
      number("Roul 3.1", "angle of repose, line source", "deg", kLine, "27", 26, 28,
             of(kLine, "repose.mean_deg")),
      number("Roul 3.1", "angle of repose, elliptic grains", "deg", kElliptic, "31", 30, 32,
             of(kElliptic, "repose.mean_deg")),
      number("Roul 3.11", "asymmetric line source, steeper flank", "deg", kAsymmetricLine, "31", 30,
             32, flank(kAsymmetricLine, true)),
      number("Roul 3.11", "asymmetric line source, flatter flank", "deg", kAsymmetricLine, "22", 21,
             23, flank(kAsymmetricLine, false)),
      number("Roul 3.11", "asymmetric point source, steeper flank", "deg", kAsymmetricPoint, "28",
             27, 29, flank(kAsymmetricPoint, true)),
      number("Roul 3.11", "asymmetric point source, flatter flank", "deg", kAsymmetricPoint, "21",
             20, 22, flank(kAsymmetricPoint, false)),
      dip("Roul 3.3", "base pressure, point source", kPoint, "dip", {"dip"}),
      dip("Roul 3.3", "base pressure, line source", kLine, "no dip", {"neither", "peak"}),
      dip("Roul 3.3", "base pressure, elliptic grains", kElliptic, "dip", {"dip"}),
      number("Roul 3.3", "depth of the dip, elliptic over round", "", kElliptic, "about 2", 1.5,
             2.5, ratio(of(kElliptic, "dip.difference"), of(kPoint, "dip.difference"), 1.5, 2.5)),
      number("Roul 3.4", "volume fraction, line source", "", kLine, "0.79", 0.78, 0.80,
             of(kLine, "heap.volume_fraction")),
      number("Roul 3.4", "the same, middle over near the surface", "", kLine, "1 (flat)", 0.99,
             1.01, of(kLine, "density.ratio"), kDenserMiddle),
      number("Roul 3.4", "volume fraction, point source, middle over near the surface", "", kPoint,
             "1.08-1.10", 1.08, 1.10, of(kPoint, "density.ratio"), kDenserMiddle),
      word("Roul 5.3", "response on the base, irregular pentagons", kPentagons, "one peak",
           {"one peak"}, "response.peaks", peaks_word),
      word("Liffman 42", "N below 45 layers, largest difference from the closed form", kLattice,
           "0 (within 1 %)", {"within 1 %"}, "liffman.normal_max_error.slope_deg_60", within_word),
      word("Liffman 44", "H below 45 layers, likewise", kLattice, "0 (within 1 %)", {"within 1 %"},
           "liffman.horizontal_max_error.slope_deg_60", within_word),
      number("Roul 3.9", "coordination at a tenth of gravity over that at gravity", "", kGravity,
             "0.92", 0.91, 0.93, of(kGravity, "change.gravity_0.98.coordination_ratio"), 0.08),
      number("Roul 3.9", "coordination at 1.9 times gravity over that at gravity", "", kGravity,
             "1.04", 1.03, 1.05, of(kGravity, "change.gravity_18.6.coordination_ratio"), 0.04),
      word("Roul 2.8", "grains that an RVE of the stress needs", kFields, "100-200", {"100-200"},
           "rve_size.stress_grains", rve_word),
      word("Roul 2.9", "grains that an RVE of the strain needs", kFields, "100-200", {"100-200"},
           "rve_size.strain_grains", rve_word),
      word("Roul 2.10", "grains that an RVE of the fabric needs", kFields, "100-200", {"100-200"},
           "rve_size.fabric_grains", rve_word),
      word("Roul fig. 3.7", "tail of P(n) of the base forces above the mean", kFields,
           "exponential", {"exponential"}, "forces.tail_p_value", tail_word),
      number("Roul fig. 3.14", "order of the long axes, round grains", "", kFields,
             "no direction (0-0.05)", 0, 0.05, of(kFields, "orientation.order"), 1),
      word("Roul fig. 3.15", "mean long axis, elliptic grains", kFieldsElliptic, "horizontal",
           {"horizontal"}, "orientation.director_deg", director_word),
      number("Roul fig. 3.17", "vertical strain under the apex over that beside it, line source",
             "", kFieldsLine, "1 or more (no dip)", 1, 2, of(kFieldsLine, "strain.dip_ratio")),
      number("Roul fig. 3.19", "vertical strain under the apex over that beside it, point source",
             "", kFields, "below 1 (dip)", 0, 1, of(kFields, "strain.dip_ratio")),
      number("Roul fig. 3.19", "Cundall's strain against Cambou's, lowest row", "", kFields,
             "a few % (0-0.05)", 0, 0.05, of(kFields, "strain.cundall.difference_yy_low")),
      number("Roul fig. 3.19", "Liao's strain against Cambou's, lowest row", "", kFields,
             "up to 0.30-0.40", 0.3, 0.4, of(kFields, "strain.liao.difference_yy_low")),
      number("Roul fig. 3.19", "strain from derivatives against Cambou's, lowest row", "", kFields,
             "agrees inside (0-0.10)", 0, 0.1, of(kFields, "strain.derivative.difference_yy_low")),
      number("Roul fig. 3.20", "anisotropy of the fabric, F_D / tr F", "", kFields, "0.05-0.15",
             0.05, 0.15, of(kFields, "fabric.anisotropy")),
      number("Roul fig. 3.20", "fabric's major axis in the left flank, from the horizontal", "deg",
             kFields, "40 (sense not given)", 39, 41, size_of(kFields, "fabric.axis_left_deg")),
      number("Roul fig. 3.20", "fabric's major axis in the right flank, from the horizontal", "deg",
             kFields, "40 (sense not given)", 39, 41, size_of(kFields, "fabric.axis_right_deg")),
      number("Roul fig. 3.21", "g2 = tr F/(nu c), radii within 30 %", "", kFields, "1.045", 1.035,
             1.055, of(kFields, "fabric.g2"), 0.045),
      number("Roul fig. 3.21", "correlation of tr F with nu c", "", kFields, "linear (0.9-1)", 0.9,
             1, of(kFields, "fabric.nu_c_correlation")),
      number("Roul fig. 3.22", "correlation of tr F with nu", "", kFields, "roughly linear (0.7-1)",
             0.7, 1, of(kFields, "fabric.nu_correlation")),
      word("Roul fig. 3.23", "trace of incremental stress against that of strain", kFields,
           "nonlinear", {"nonlinear"}, "invariants.trace_slope_ratio", slope_word),
      number("Roul fig. 3.24", "coordination at 0.1 g over that at g, quasi-static", "", kFields,
             "0.92", 0.91, 0.93, of(kFields, "change.gravity_0.981.coordination_ratio"), 0.08),
      number("Roul fig. 3.24", "coordination at 1.9 g over that at g, quasi-static", "", kFields,
             "1.04", 1.03, 1.05, of(kFields, "change.gravity_18.639.coordination_ratio"), 0.04),
      number("Roul fig. 3.25", "E of the pile over E of the grains", "", kFields, "about 0.1",
             0.075, 0.125, of(kFields, "elastic.young_over_grain")),
      number("Roul fig. 3.26", "correlation of K with tr F", "", kFields, "linear (0.7-1)", 0.7, 1,
             of(kFields, "elastic.bulk_fabric_correlation")),
      number("Roul fig. 3.26", "correlation of E with tr F", "", kFields, "roughly linear (0.7-1)",
             0.7, 1, of(kFields, "elastic.young_fabric_correlation")),
      number("Roul fig. 3.26", "correlation of G with tr F", "", kFields, "roughly linear (0.7-1)",
             0.7, 1, of(kFields, "elastic.shear_fabric_correlation")),
  };
  static const std::vector<SourceFigure> all = [] {
    std::vector<SourceFigure> out = own;
    for (SourceFigure& figure : fit_figures()) out.push_back(std::move(figure));
    for (SourceFigure& figure : box_figures()) out.push_back(std::move(figure));
    for (SourceFigure& figure : liffman_figures()) out.push_back(std::move(figure));
    return out;
  }();
  return all;
}

std::string agreement(const SourceFigure& figure, const Measured& ours) {
  if (std::isnan(ours.error)) return "no error, no statement";
  const double middle = (figure.low + figure.high) / 2, reach = 2 * ours.error;
  const double miss = std::max({0.0, figure.low - ours.value, ours.value - figure.high});
  if (miss > reach) {
    const std::string unit = figure.unit.empty() ? "" : " " + figure.unit;
    return fmt::format("differs by {:.2g}{} ({:.1f} standard errors)", miss, unit,
                       miss / ours.error);
  }
  const double stake = figure.effect > 0 ? figure.effect : std::fabs(middle);
  if (reach > kTooWide * stake) return kWideSpread;
  return "agrees";
}

}  // namespace grainfield::coupling
