// Forces: on the base, at contacts, in chains, and how near the stress is to yield (Roul 3.2, 3.9,
// 4.2; figs 3.5, 3.7, 3.23).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>

#include "coupling/run/study_result.h"
#include "coupling/statistics/exponential_tail.h"
#include "coupling/structure/base_forces.h"
#include "coupling/structure/force_chains.h"
#include "coupling/structure/histogram.h"
#include "coupling/structure/yield.h"
#include "coupling/studies/pile/simulation.h"
#include "coupling/studies/pile_fields/drawing.h"
#include "coupling/studies/pile_fields/robust.h"
#include "coupling/studies/pile_fields/topic.h"

namespace grainfield::coupling {
namespace {

// P(n): bins up to this many mean forces.
constexpr double kMostForce = 5;
constexpr int kForceBins = 20;
// The tail begins at the mean force (Roul 3.2).
constexpr double kTail = 1;
constexpr int kTraceBins = 15;
// A point is at the limit when it mobilises this share of the angle of repose.
constexpr double kAtLimit = 0.95;
// Share of the half base within which a point belongs to the core.
constexpr double kCore = 0.25;
// Strains are drawn in units of 1e-4.
constexpr double kPlotted = 1e4;
constexpr double kPerRadian = 180 / std::numbers::pi;

// What all piles leave together.
struct Gathered {
  std::vector<double> base;  // normalised base forces
  dem::Snapshot contacts;    // contacts of all piles between free grains
  FigureSamples figures;
};

// Order 2 |mean exp(2 i a)| of contact normals and its axis, deg; weighted by the normal force or
// not.
std::pair<double, double> order_of(const dem::Snapshot& s, bool by_force) {
  std::complex<double> sum = 0;
  double weight = 0;
  for (const dem::Contact& c : s.contacts) {
    if (c.j < 0 || s.grains[static_cast<std::size_t>(c.i)].fixed ||
        s.grains[static_cast<std::size_t>(c.j)].fixed) {
      continue;
    }
    const double w = by_force ? c.normal_force : 1;
    sum += w * std::polar(1.0, 2 * std::atan2(c.normal.y(), c.normal.x()));
    weight += w;
  }
  return {2 * std::abs(sum) / weight, std::arg(sum) / 2 * kPerRadian};
}

// Base forces, contacts and chains of one pile.
struct PileForces {
  BaseForces base;
  ForceChains chains;
  double contact_order = 0, force_order = 0;
};
const std::vector<Figure<PileForces>>& pile_force_rows() {
  using P = const PileForces&;
  static const std::vector<Figure<PileForces>> rows{
      {"forces.base_grains", "-", "grains on the base",
       [](P p) { return static_cast<double>(p.base.force.size()); }},
      {"forces.contact_anisotropy", "-", "2 |mean exp(2 i a)| of the contact normals",
       [](P p) { return p.contact_order; }},
      {"forces.force_anisotropy", "-", "the same weighted by normal force",
       [](P p) { return p.force_order; }},
      {"chains.number", "-", "force chains of a pile (docs/structure.md)",
       [](P p) { return static_cast<double>(p.chains.chains.size()); }},
      {"chains.length", "-", "grains of a chain", [](P p) { return p.chains.mean_length; }},
      {"chains.share", "-", "share of the bearing grains in chains",
       [](P p) { return static_cast<double>(p.chains.in_chains) / p.chains.bearing; }},
      {"chains.stressed_share", "-", "share of the bearing grains loaded above the mean",
       [](P p) { return static_cast<double>(p.chains.stressed) / p.chains.bearing; }},
  };
  return rows;
}

const std::vector<ErrorFigure<ExponentialTail>>& tail_rows() {
  using T = const ExponentialTail&;
  static const std::vector<ErrorFigure<ExponentialTail>> rows{
      {"forces.tail_rate", "-", "of P(n) ~ exp(-rate n) above the mean, all piles together",
       [](T t) {
         return ValueWithError{t.rate, t.rate / std::sqrt(t.count)};
       }},
      {"forces.tail_grains", "-", "grains above the mean",
       [](T t) { return ValueWithError{std::int64_t{t.count}}; }},
      {"forces.tail_distance", "-", "largest difference of the cumulative distributions",
       [](T t) { return ValueWithError{t.distance}; }},
      {"forces.tail_p_value", "-", "probability of a larger one if the tail is exponential",
       [](T t) { return ValueWithError{t.p_value}; }},
  };
  return rows;
}

const std::vector<RunFigure<Gathered>>& gathered_rows() {
  static const std::vector<RunFigure<Gathered>> rows{
      {"forces.force_axis_deg", "deg", "axis of force_anisotropy from x, all piles together",
       [](const Gathered& all) { return order_of(all.contacts, true).second; }},
  };
  return rows;
}

// Mobilised friction of every pile.
struct Mobilised {
  double limit_deg = 0;
  std::vector<double> core, flanks, at_limit;
};
const std::vector<RunFigure<Mobilised>>& limit_rows() {
  static const std::vector<RunFigure<Mobilised>> rows{
      {"yield.phi_deg", "deg", "angle of repose that the limit is taken at",
       [](const Mobilised& m) { return m.limit_deg; }},
  };
  return rows;
}
const std::vector<MedianFigure<Mobilised>>& mobilised_rows() {
  using M = const Mobilised&;
  static const std::vector<MedianFigure<Mobilised>> rows{
      {"yield.mobilised_core_deg", "deg",
       "mobilised friction within 0.25 half bases of the apex; median over points and piles",
       [](M m) { return m.core; }},
      {"yield.mobilised_flanks_deg", "deg", "the same beyond", [](M m) { return m.flanks; }},
      {"yield.share_at_limit", "-", "share of the points inside that mobilise 95 % of it",
       [](M m) { return m.at_limit; }},
  };
  return rows;
}

// Traces of the changes of stress over those of strain, in bins.
const std::vector<RunFigure<Series>>& trace_rows() {
  static const std::vector<RunFigure<Series>> rows{
      {"invariants.trace_slope_ratio", "-",
       "slope of tr stress over tr strain, upper third over lower third of the points: 1 is linear",
       [](const Series& trace) {
         const Eigen::Index n = trace.x.size(), third = n / 3;
         if (third < 1) return double{NAN};
         const double low = (trace.y[third] - trace.y[0]) / (trace.x[third] - trace.x[0]);
         const double high =
             (trace.y[n - 1] - trace.y[n - 1 - third]) / (trace.x[n - 1] - trace.x[n - 1 - third]);
         return high / low;
       }},
  };
  return rows;
}

Gathered gather(const PileSet& piles) {
  Gathered out;
  for (int r = 0; r < piles.count(); ++r) {
    const Realization one = piles.realization(r);
    const dem::Snapshot& pile = one["pile"];
    const PileForces own{base_forces(pile), force_chains(pile), order_of(pile, false).first,
                         order_of(pile, true).first};
    out.base.insert(out.base.end(), own.base.normalised.begin(), own.base.normalised.end());
    add_samples(pile_force_rows(), own, out.figures);
    // One packing of all piles, for the polar histogram.
    const auto offset = static_cast<std::int64_t>(out.contacts.grains.size());
    for (const dem::Grain& g : pile.grains) {
      dem::Grain bare;
      bare.fixed = g.fixed;
      out.contacts.grains.push_back(bare);
    }
    for (dem::Contact c : pile.contacts) {
      if (c.j < 0) continue;
      c.i += offset;
      c.j += offset;
      out.contacts.contacts.push_back(c);
    }
  }
  return out;
}

void add_base(const Gathered& all, TopicResult& out) {
  const Eigen::VectorXd n = Eigen::Map<const Eigen::VectorXd>(
      all.base.data(), static_cast<Eigen::Index>(all.base.size()));
  const ExponentialTail tail = exponential_tail(n, kTail);
  add_values(tail_rows(), tail, out.summary);
  const DensityHistogram h = density_histogram(n, 0, kMostForce, kForceBins);
  const Eigen::VectorXd at = h.centres();
  std::vector<Eigen::Index> filled;
  for (Eigen::Index b = 0; b < at.size(); ++b) {
    if (h.counts[b] > 0) filled.push_back(b);
  }
  const Eigen::VectorXd density = h.density(filled), error = h.error(filled);
  Frame frame;
  frame.series.push_back({"grains on the base", at(filled), density.array().log10(),
                          error.array() / density.array() / std::numbers::ln10, true});
  const Eigen::VectorXd line = Eigen::VectorXd::LinSpaced(30, kTail, kMostForce);
  frame.series.push_back(
      {fmt::format("exponential, rate {:.2f}", tail.rate),
       line,
       ((tail.share * tail.rate * (-tail.rate * (line.array() - kTail)).exp()).log10()),
       {},
       false});
  Picture picture = curves("Distribution of the vertical forces on the base",
                           "n = force on a grain / mean", "log_{10} P(n)", {std::move(frame)});
  picture.caption = fmt::format(
      "All piles together, {} grains. Tail above the mean: rate {:.2f} ± {:.2f} by maximum "
      "likelihood; probability of a worse fit if it is exponential: {:.2g} (Roul fig. 3.7). Band: "
      "root of the counts.",
      n.size(), tail.rate, tail.rate / std::sqrt(tail.count), tail.p_value);
  out.sections.emplace_back(std::move(picture));
  Field field;
  field.points = Eigen::MatrixXd::Zero(at.size(), 2);
  field.points.col(0) = at;
  field.attributes["points"] = "x: force over the mean; y: 0";
  Column& column = field.add("density", "1");
  column.value = h.density;
  column.error = h.error;
  out.fields.emplace_back("base_forces", std::move(field));
}

double inner_median(const PileSet& piles, const Eigen::VectorXd& value, bool core) {
  const double half = (piles.mean(&PileFrame::half_left) + piles.mean(&PileFrame::half_right)) /
                      (2 * piles.height());
  std::vector<double> chosen;
  for (const Eigen::Index p : piles.inside()) {
    if ((std::fabs(piles.grid()(p, 0)) < kCore * half) == core) chosen.push_back(value[p]);
  }
  return median_of(std::move(chosen));
}

void add_yield(const PileSet& piles, TopicResult& out) {
  const double repose =
      (piles.mean(&PileFrame::repose_left_deg) + piles.mean(&PileFrame::repose_right_deg)) / 2;
  // Heaps without a slope to measure: the grains' own friction.
  const double phi =
      std::isfinite(repose) && repose > 0
          ? repose
          : std::atan(piles.setup().get<dem::PileSetup>().material.friction) * kPerRadian;
  Ensemble stresses;
  Mobilised found{phi, {}, {}, {}};
  for (int r = 0; r < piles.count(); ++r) {
    Field one;
    one.points = piles.grid();
    for (const char* name : {"sigma_xx", "sigma_yy", "sigma_xy", "sigma_yx"}) {
      one.add(name, "1").value = piles.fields(r).rest.find(name)->value / piles.frame(r).pressure();
    }
    stresses.add(one);
    add_yield_columns(one, phi);
    const Eigen::VectorXd& mobilised = one.find("mobilised_friction")->value;
    found.core.push_back(inner_median(piles, mobilised, true));
    found.flanks.push_back(inner_median(piles, mobilised, false));
    double at = 0, count = 0;
    for (const Eigen::Index p : piles.inside()) {
      if (std::isnan(mobilised[p])) continue;
      ++count;
      at += mobilised[p] >= kAtLimit * phi ? 1 : 0;
    }
    found.at_limit.push_back(at / count);
  }
  Field mean = piles.in_metres(stresses);
  add_yield_columns(mean, phi);
  add_values(limit_rows(), found, out.summary);
  add_medians(mobilised_rows(), found, piles.resamples(), out.summary);
  Picture friction = maps("Mobilised friction angle", "x / h", "y / h", "deg",
                          {map_of(piles, "", mean.find("mobilised_friction")->value)}, false);
  friction.caption = fmt::format(
      "Angle at which the mean stress would be at the limit; the heap's angle of repose is "
      "{:.1f}°. "
      "{}",
      phi, how_averaged(piles));
  out.sections.emplace_back(std::move(friction));
  Picture expression = maps("Mohr-Coulomb expression", "x / h", "y / h", "expression",
                            {map_of(piles, "", mean.find("mohr_coulomb")->value)}, true);
  expression.caption =
      "((σxx - σyy)² + 4σxy² - (σxx + σyy)² sin²φ)/(σxx + σyy)² with φ the angle of repose (Roul "
      "4.2): 0 at the limit, below 0 inside.";
  out.sections.emplace_back(std::move(expression));
  out.fields.emplace_back("yield", std::move(mean));
}

// Invariants of the change of stress against those of strain, as if gravity had risen: means of the
// stress and medians of the strain over piles, at the points inside (Roul fig. 3.23).
void add_invariants(const PileSet& piles, TopicResult& out) {
  std::vector<double> volume, pressure, shear, deviator;
  for (const Eigen::Index p : piles.inside()) {
    std::vector<double> e[3], s[3];
    for (int r = 0; r < piles.count(); ++r) {
      const Field &stress = piles.fields(r).stress_change, &strain = piles.fields(r).strain.field;
      const char* suffix[] = {"_xx", "_yy", "_xy"};
      for (int c = 0; c < 3; ++c) {
        e[c].push_back(strain.find(std::string("strain") + suffix[c])->value[p]);
        s[c].push_back(stress.find(std::string("sigma") + suffix[c])->value[p]);
      }
    }
    const double exx = median_of(e[0]), eyy = median_of(e[1]), exy = median_of(e[2]);
    const double sxx = median_of(s[0]), syy = median_of(s[1]), sxy = median_of(s[2]);
    volume.push_back(kPlotted * std::fabs(exx + eyy));
    pressure.push_back(std::fabs(sxx + syy));
    shear.push_back(kPlotted * std::hypot(exx - eyy, 2 * exy));
    deviator.push_back(std::hypot(sxx - syy, 2 * sxy));
  }
  const Series trace = binned("points inside the heap", volume, pressure, kTraceBins),
               dev = binned("points inside the heap", shear, deviator, kTraceBins);
  add_values(trace_rows(), trace, out.summary);
  Picture picture =
      curves("Invariants of incremental stress and strain", "invariant of the strain (10^{-4})",
             "invariant of the stress (N/m)",
             {Frame{"traces", {trace}}, Frame{"deviators (largest - smallest)", {dev}}});
  picture.caption =
      "Sizes, of medians over piles, in bins of equally many points; band: standard error within "
      "the bin (Roul fig. 3.23).";
  out.sections.emplace_back(std::move(picture));
}

TopicResult forces_of_piles(const PileSet& piles) {
  TopicResult out;
  const Gathered all = gather(piles);
  add_figures(out.summary, all.figures);
  add_base(all, out);
  Picture angles = contact_angles("Directions of contacts", all.contacts);
  angles.caption += " All piles together.";
  out.sections.emplace_back(std::move(angles));
  add_values(gathered_rows(), all, out.summary);
  const auto value = [&](const char* key) { return std::get<double>(out.summary.at(key)); };
  Table chains{
      "Force chains",
      "Definition: docs/structure.md. Means over piles.",
      {"figure", "value"},
      {{"chains of a pile", fmt::format("{:.4g}", value("chains.number"))},
       {"grains of a chain", fmt::format("{:.3g}", value("chains.length"))},
       {"share of bearing grains in chains", fmt::format("{:.1f} %", 100 * value("chains.share"))},
       {"share loaded above the mean",
        fmt::format("{:.1f} %", 100 * value("chains.stressed_share"))}}};
  add_yield(piles, out);
  add_invariants(piles, out);
  out.sections.emplace_back(std::move(chains));
  out.sentence = fmt::format(
      "P(n) of the base falls as exp(-{:.2f} n) above the mean force (p = {:.2g}); {:.0f} % of the "
      "bearing grains stand in chains of {:.1f} on average; mobilised friction {:.0f}° in the "
      "core, "
      "{:.0f}° in the flanks, repose {:.0f}°.",
      value("forces.tail_rate"), value("forces.tail_p_value"), 100 * value("chains.share"),
      value("chains.length"), value("yield.mobilised_core_deg"),
      value("yield.mobilised_flanks_deg"), value("yield.phi_deg"));
  return out;
}

std::vector<SummaryKey> force_figures() {
  return joined({declared(pile_force_rows()), declared(gathered_rows()), declared(tail_rows()),
                 declared(limit_rows()), declared(mobilised_rows()), declared(trace_rows())});
}

}  // namespace

Topic forces_topic() {
  return {"forces", "base forces, contact angles, force chains, nearness to yield", forces_of_piles,
          force_figures};
}

}  // namespace grainfield::coupling
