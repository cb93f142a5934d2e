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
#include "coupling/studies/pile_fields/topic_result.h"

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
  std::map<std::string, std::vector<double>> figures;
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

Gathered gather(const PileSet& piles) {
  Gathered out;
  auto& f = out.figures;
  for (int r = 0; r < piles.count(); ++r) {
    const Realization one = piles.realization(r);
    const dem::Snapshot& pile = one["pile"];
    const BaseForces base = base_forces(pile);
    out.base.insert(out.base.end(), base.normalised.begin(), base.normalised.end());
    f["forces.base_grains"].push_back(static_cast<double>(base.force.size()));
    const ForceChains chains = force_chains(pile);
    f["chains.number"].push_back(static_cast<double>(chains.chains.size()));
    f["chains.length"].push_back(chains.mean_length);
    f["chains.share"].push_back(static_cast<double>(chains.in_chains) / chains.bearing);
    f["chains.stressed_share"].push_back(static_cast<double>(chains.stressed) / chains.bearing);
    const auto [by_count, unused] = order_of(pile, false);
    const auto [by_force, axis] = order_of(pile, true);
    f["forces.contact_anisotropy"].push_back(by_count);
    f["forces.force_anisotropy"].push_back(by_force);
    (void)unused;
    (void)axis;
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
  out.summary["forces.tail_rate"] = tail.rate;
  out.summary["forces.tail_rate.standard_error"] = tail.rate / std::sqrt(tail.count);
  out.summary["forces.tail_grains"] = static_cast<std::int64_t>(tail.count);
  out.summary["forces.tail_distance"] = tail.distance;
  out.summary["forces.tail_p_value"] = tail.p_value;
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
  std::vector<double> core, flank, limit;
  for (int r = 0; r < piles.count(); ++r) {
    Field one;
    one.points = piles.grid();
    for (const char* name : {"sigma_xx", "sigma_yy", "sigma_xy", "sigma_yx"}) {
      one.add(name, "1").value = piles.fields(r).rest.find(name)->value / piles.frame(r).pressure();
    }
    stresses.add(one);
    add_yield_columns(one, phi);
    const Eigen::VectorXd& mobilised = one.find("mobilised_friction")->value;
    core.push_back(inner_median(piles, mobilised, true));
    flank.push_back(inner_median(piles, mobilised, false));
    double at = 0, count = 0;
    for (const Eigen::Index p : piles.inside()) {
      if (std::isnan(mobilised[p])) continue;
      ++count;
      at += mobilised[p] >= kAtLimit * phi ? 1 : 0;
    }
    limit.push_back(at / count);
  }
  Field mean = piles.in_metres(stresses);
  add_yield_columns(mean, phi);
  out.summary["yield.phi_deg"] = phi;
  add_median(out.summary, "yield.mobilised_core_deg", core, piles.resamples());
  add_median(out.summary, "yield.mobilised_flanks_deg", flank, piles.resamples());
  add_median(out.summary, "yield.share_at_limit", limit, piles.resamples());
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
  // Slope of the upper third of the bins over that of the lower third: 1 is linear.
  const Eigen::Index n = trace.x.size(), third = n / 3;
  double ratio = NAN;
  if (third >= 1) {
    const double low = (trace.y[third] - trace.y[0]) / (trace.x[third] - trace.x[0]);
    const double high =
        (trace.y[n - 1] - trace.y[n - 1 - third]) / (trace.x[n - 1] - trace.x[n - 1 - third]);
    ratio = high / low;
  }
  out.summary["invariants.trace_slope_ratio"] = ratio;
  Picture picture =
      curves("Invariants of incremental stress and strain", "invariant of the strain (10^{-4})",
             "invariant of the stress (N/m)",
             {Frame{"traces", {trace}}, Frame{"deviators (largest - smallest)", {dev}}});
  picture.caption =
      "Sizes, of medians over piles, in bins of equally many points; band: standard error within "
      "the bin (Roul fig. 3.23).";
  out.sections.emplace_back(std::move(picture));
}

}  // namespace

TopicResult forces_of_piles(const PileSet& piles) {
  TopicResult out;
  const Gathered all = gather(piles);
  add_figures(out.summary, all.figures);
  add_base(all, out);
  Picture angles = contact_angles("Directions of contacts", all.contacts);
  angles.caption += " All piles together.";
  out.sections.emplace_back(std::move(angles));
  out.summary["forces.force_axis_deg"] = order_of(all.contacts, true).second;
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

}  // namespace grainfield::coupling
