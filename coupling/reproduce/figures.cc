#include "coupling/reproduce/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

// a / b with the errors of independent ensembles.
Number ratio(const Number& a, const Number& b) {
  return [=](const Results& r) -> std::optional<Measured> {
    const auto x = a(r), y = b(r);
    if (!x || !y) return std::nullopt;
    const double q = x->value / y->value;
    return Measured{q, std::fabs(q) * std::hypot(x->error / x->value, y->error / y->value)};
  };
}

SourceFigure number(const char* source, const char* what, const char* unit, const char* study,
                    const char* theirs, double low, double high, Number ours, double effect = 0) {
  return {source, what, unit, study, theirs, low, high, {}, std::move(ours), nullptr, effect};
}

SourceFigure dip(const char* source, const char* what, const char* study, const char* theirs,
                 std::vector<std::string> words) {
  const std::string name = study;
  return {source,
          what,
          "",
          study,
          theirs,
          0,
          0,
          std::move(words),
          nullptr,
          [name](const Results& r) -> std::optional<std::string> {
            const auto verdict = r.text(name, "dip.verdict");
            const auto difference = r.number(name, "dip.difference");
            const auto p = r.plain(name, "dip.p_value");
            const auto centre = r.plain(name, "dip.ratio");
            if (!verdict || !difference || !p || !centre) return std::nullopt;
            return fmt::format(
                "{}: shoulder - centre = {:.3f} ± {:.3f} ρgh, p = {:.2g}; centre over largest "
                "{:.2f}",
                *verdict, difference->value, difference->error, *p, *centre);
          },
          0};
}

}  // namespace

const std::vector<SourceFigure>& source_figures() {
  constexpr const char *kPoint = "pile-point-source", *kLine = "pile-line-source",
                       *kElliptic = "pile-elliptic", *kAsymmetricLine = "pile-asymmetric-line",
                       *kAsymmetricPoint = "pile-asymmetric-point",
                       *kGravity = "pile-gravity-levels";
  // Of a point source over the surface; a flat fraction is one without it.
  constexpr double kDenserMiddle = 0.09;
  // Angles are read to 1 degree, fractions to 0.01.
  static const std::vector<SourceFigure> all{
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
             2.5, ratio(of(kElliptic, "dip.difference"), of(kPoint, "dip.difference"))),
      number("Roul 3.4", "volume fraction, line source", "", kLine, "0.79", 0.78, 0.80,
             of(kLine, "heap.volume_fraction")),
      number("Roul 3.4", "the same, middle over near the surface", "", kLine, "1 (flat)", 0.99,
             1.01, of(kLine, "density.ratio"), kDenserMiddle),
      number("Roul 3.4", "volume fraction, point source, middle over near the surface", "", kPoint,
             "1.08-1.10", 1.08, 1.10, of(kPoint, "density.ratio"), kDenserMiddle),
      number("Roul 3.9", "coordination at a tenth of gravity over that at gravity", "", kGravity,
             "0.92", 0.91, 0.93, of(kGravity, "change.gravity_0.98.coordination_ratio"), 0.08),
      number("Roul 3.9", "coordination at 1.9 times gravity over that at gravity", "", kGravity,
             "1.04", 1.03, 1.05, of(kGravity, "change.gravity_18.6.coordination_ratio"), 0.04),
  };
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
  if (reach > kTooWide * stake) return "spread too wide to tell";
  return "agrees";
}

}  // namespace grainfield::coupling
