#include "coupling/studies/sample/figures.h"

#include <algorithm>
#include <cmath>

#include "continuum/constants.h"
#include "coupling/studies/sample/simulation/path.h"

namespace grainfield::coupling {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Value = std::optional<double>;

double slope(const VectorXd& strain, const VectorXd& stress, Index from, Index to) {
  return (stress[to] - stress[from]) / (strain[to] - strain[from]);
}

double area_under(const VectorXd& strain, const VectorXd& stress, Index from, Index to) {
  double area = 0;
  for (Index k = from; k < to; ++k) {
    area += 0.5 * (stress[k] + stress[k + 1]) * (strain[k + 1] - strain[k]);
  }
  return area;
}

struct Secant {
  double modulus = kNan, strain = kNan;
};

// To the first strain at which `stress` has risen by half of its largest rise, by straight lines
// between the states.
Secant secant_of(const VectorXd& strain, const VectorXd& stress) {
  const double half = 0.5 * (stress.maxCoeff() - stress[0]);
  if (!(half > 0)) return {};
  for (Index k = 1; k < stress.size(); ++k) {
    const double before = stress[k - 1] - stress[0], now = stress[k] - stress[0];
    if (now < half) continue;
    const double at =
        strain[k - 1] + (strain[k] - strain[k - 1]) * (half - before) / (now - before);
    return {half / (at - strain[0]), at};
  }
  return {};
}

// Without states that have none.
double largest_number(const VectorXd& values) {
  double out = kNan;
  for (const double v : values) {
    if (std::isfinite(v) && !(v <= out)) out = v;
  }
  return out;
}

// One realization, with what several figures need.
struct SamplePath {
  SamplePath(const StateTable& all, const dem::SamplePlan& of, Index r)
      : table(all), plan(of), realization(r) {
    const Driving driving = driving_of(plan.deformation, plan.dim);
    strain = loading("strain");
    driven = driving.compression ? VectorXd(-loading(driving.stress)) : loading(driving.stress);
    secant = secant_of(strain, driven);
    const VectorXd p = loading("p"), inertia = loading("inertial_number"),
                   ratio = loading("q_over_p");
    bool bore = true;
    for (Index k = 0; k < strain.size(); ++k) {
      // A box without stress at the start has no strength that it could lose there.
      const bool empty = k == 0 && !(p[0] > 0), known = std::isfinite(ratio[k]);
      const bool bears =
          empty || (p[k] > kLeastPressure * p[0] && inertia[k] < kMostInertia && known);
      if (bore && !bears) lost = k;
      bore = bore && bears;
      if (bears && known && (peak < 0 || ratio[k] > ratio[peak])) peak = k;
      bearing_since = bears ? bearing_since : k + 1;
    }
    if (uniaxial() || plan.deformation == "isotropic") peak = -1;
  }

  bool uniaxial() const { return plan.deformation == "uniaxial"; }
  // There and back again along an axis.
  bool returns() const { return dem::unloads(plan) && !dem::shears(plan); }
  VectorXd way(const std::string& name) const { return table.of(name).col(realization); }
  VectorXd loading(const std::string& name) const { return way(name).head(plan.records + 1); }
  Index last() const { return plan.records; }
  VectorXd inside() const { return -way(plan.dim == 2 ? "sigma_yy" : "sigma_zz"); }
  VectorXd outside() const { return dem::is_periodic(plan) ? inside() : way("pressure_on_lid"); }
  // The largest of the loading's states at a tenth of its strain or beyond.
  double largest_late(const VectorXd& values) const {
    const Index from = std::max<Index>(1, (last() + 9) / 10);
    return values.segment(from, last() - from + 1).maxCoeff();
  }
  // A number over p of the first state; nullopt for a box that bears nothing yet.
  Value over_first_pressure(double value) const {
    const double first = way("p")[0];
    return first > 0 ? Value(value / first) : Value();
  }
  // A column in a state; nullopt without the state.
  Value at(const char* name, Index state) const {
    return state < 0 ? Value() : Value(way(name)[state]);
  }
  // How many of the last states, which are at equal steps of strain, are beyond kCriticalFrom of
  // it; 0: the sample has no critical state.
  Index critical_states() const {
    if (uniaxial() || plan.deformation == "isotropic") return 0;
    const Index n =
        strain.size() - static_cast<Index>(std::ceil(kCriticalFrom * static_cast<double>(last())));
    return n < 2 || bearing_since > strain.size() - n ? 0 : n;
  }
  Value critical(const char* name) const {
    const Index n = critical_states();
    return n == 0 ? Value() : Value(loading(name).tail(n).mean());
  }

  const StateTable& table;
  const dem::SamplePlan& plan;
  Index realization;
  VectorXd strain, driven;     // of the loading; driven: compression positive
  Index lost = -1, peak = -1;  // states: the first without load; the largest q/p; -1: none
  Index bearing_since = 0;     // from this state on all bear load
  Secant secant;
};
using P = const SamplePath&;

Value strain_of_least_pressure(P s) {
  if (!dem::shears(s.plan) || s.plan.constant != "volume") return {};  // a held one has no least
  Index least = 0;
  s.inside().head(s.last() + 1).minCoeff(&least);
  return s.strain[least] / 2;
}

Value largest_balance_error(P s) {
  const VectorXd balance = s.loading("balance_error");
  if (balance.size() < 2 || !balance.tail(balance.size() - 1).allFinite()) return {};
  return balance.tail(balance.size() - 1).cwiseAbs().maxCoeff();
}

Value critical_drift(P s) {
  const Index n = s.critical_states(), half = n / 2;
  if (n == 0) return {};
  const VectorXd ratio = s.loading("q_over_p");
  return ratio.tail(half).mean() / ratio.tail(n).head(half).mean() - 1;
}

// Slopes of the axial stress between two shares (in quarters of the loading) over two others'.
Value stiffening(P s, Index least, Index from, Index to, Index from_over, Index to_over) {
  const Index end = s.last();
  if (!s.uniaxial() || end < least) return {};
  const VectorXd inside = s.inside();
  return slope(s.strain, inside, from * end / 4, to * end / 4) /
         slope(s.strain, inside, from_over * end / 4, to_over * end / 4);
}

// Strain at which the axial stress falls to that of the first state, or to a small share of the
// largest where the first one is below it, by straight lines.
Value plastic_strain(P s) {
  if (!s.returns()) return {};
  const VectorXd strain = s.way("strain"), stress = s.outside();
  const double unloaded = std::max(stress[0], dem::kLeastUnloaded * stress[s.last()]);
  for (Index k = s.last() + 1; k < stress.size(); ++k) {
    if (stress[k] > unloaded) continue;
    const double share = (stress[k - 1] - unloaded) / (stress[k - 1] - stress[k]);
    return strain[k - 1] + share * (strain[k] - strain[k - 1]);
  }
  return {};
}

Value unloading_stiffness(P s) {
  if (!s.returns()) return {};
  const Index end = s.last(), late = std::min<Index>(end - 1, 3 * end / 4);
  const Index middle = end + std::max<Index>(1, s.plan.unload_records / 2);
  return slope(s.way("strain"), s.outside(), end, middle) /
         slope(s.way("strain"), s.outside(), late, end);
}

Value loop_loss(P s) {
  if (!s.returns()) return {};
  const VectorXd strain = s.way("strain"), outside = s.outside();
  const double loaded = area_under(strain, outside, 0, s.last());
  return (loaded + area_under(strain, outside, s.last(), strain.size() - 1)) / loaded;
}

const std::vector<Figure<SamplePath>>& packing_rows() {
  // clang-format off
  static const std::vector<Figure<SamplePath>> all{
      {"initial_pressure", "N/m (3D: Pa)", "p of a sample at rest, before it is deformed", [](P s) { return s.at("p", 0); }},
      {"initial_solid_fraction", "-", "its solid fraction then; overlaps count twice", [](P s) { return s.at("solid_fraction", 0); }, "first solid fraction"},
      {"initial_coordination", "-", "contacts of a grain then, without rattlers", [](P s) { return s.at("coordination_bearing", 0); }},
      {"gap_spheres", "-", "dropped: spheres that fill the gap below the lid"},
      {"dropped_solid_fraction", "-", "dropped: solid fraction as the lid has been put on and the gap filled"},
  };
  // clang-format on
  return all;
}

const std::vector<Figure<SamplePath>>& loading_rows() {
  // clang-format off
  static const std::vector<Figure<SamplePath>> all{
      {"final_pressure", "N/m (3D: Pa)", "p of the last state of the loading", [](P s) { return s.at("p", s.last()); }},
      {"lost_strength", "-", "share of the samples that lose their strength: some state has less than 1 % of the first pressure, or an inertial number above 0.1", [](P s) { return Value(s.lost >= 0 ? 1 : 0); }},
      {"strain_at_loss", "-", "imposed strain of the first such state, of these samples", [](P s) { return s.at("strain", s.lost); }},
      {"lateral_stress_ratio", "-", "uniaxial: lateral over axial stress of the last state of the loading, K0", [](P s) { return s.uniaxial() ? Value(s.loading("sigma_xx")[s.last()] / -s.driven[s.last()]) : Value(); }},
      {"peak_stress_ratio", "-", "largest q/p of the recorded states (states.csv) that bear load (sample.lost_strength)", [](P s) { return s.at("q_over_p", s.peak); }, "peak q/p"},
      {"strain_at_peak", "-", "imposed strain of that state", [](P s) { return s.at("strain", s.peak); }, "at strain"},
      {"peak_friction_angle_deg", "deg", "mobilised friction angle of that state", [](P s) { return s.at("friction_angle_deg", s.peak); }},
      {"critical_stress_ratio", "-", "mean q/p of the states in the last quarter of strain", [](P s) { return s.critical("q_over_p"); }, "critical q/p"},
      {"critical_friction_angle_deg", "deg", "mobilised friction angle, likewise", [](P s) { return s.critical("friction_angle_deg"); }},
      {"critical_solid_fraction", "-", "solid fraction, likewise", [](P s) { return s.critical("solid_fraction"); }, "critical solid fraction"},
      {"critical_coordination", "-", "contacts of a grain without rattlers, likewise", [](P s) { return s.critical("coordination_bearing"); }},
      {"critical_drift", "-", "mean q/p of the second half of these states over that of the first, less 1: near 0 where the critical state is reached", critical_drift},
      {"secant_modulus", "N/m (3D: Pa)", "rise of the driving stress over strain, to half of its largest rise: shear stress (simple shear), q (axial), axial pressure (uniaxial), p (isotropic)", [](P s) { return Value(s.secant.modulus); }, "secant modulus"},
      {"secant_strain", "-", "imposed strain there", [](P s) { return Value(s.secant.strain); }},
      {"volumetric_strain", "-", "ln(V/V0) of the last state, dilation positive", [](P s) { return s.at("volumetric_strain", s.last()); }, "volumetric strain"},
      {"inertial_number", "-", "largest rate d sqrt(rho/p) of the states: below 1e-3 quasi-static", [](P s) { return Value(largest_number(s.loading("inertial_number"))); }, "inertial number"},
      {"stress_error", "-", "largest relative error of a servo's stress at any of its measurements in the deformation"},
      {"stress_rms_error", "-", "root of the mean square of the same"},
      {"kinetic_share", "-", "largest kinetic over elastic energy of the states after the first one", [](P s) { const VectorXd share = s.way("kinetic_energy").array() / s.way("elastic_energy").array(); return Value(share.tail(share.size() - 1).maxCoeff()); }},
      {"late_kinetic_share", "-", "the same of the states of the loading beyond a tenth of its strain", [](P s) { return Value(s.largest_late(s.way("kinetic_energy").cwiseQuotient(s.way("elastic_energy")))); }},
      {"late_inertial_number", "-", "largest inertial number of the same states", [](P s) { return Value(s.largest_late(s.way("inertial_number"))); }},
      {"pressure_ratio", "-", "p at the end of the loading over that of the first state", [](P s) { return s.over_first_pressure(s.way("p")[s.last()]); }},
      {"shear_over_pressure", "-", "simple shear: shear stress at the end of the loading over p of the first state", [](P s) { return dem::shears(s.plan) ? s.over_first_pressure(s.driven[s.last()]) : Value(); }},
      {"first_shear_stiffness", "-", "simple shear at constant volume: rise of the shear stress to the state after the first one, over its strain and over p of the first state", [](P s) { return dem::shears(s.plan) ? s.over_first_pressure(slope(s.strain, s.driven, 0, 1)) : Value(); }},
      {"axial_dip_strain", "-", "simple shear at constant volume: shear strain (half the shear) of the recorded state of the loading whose axial pressure is least; it falls first and rises then", strain_of_least_pressure},
      {"end_stress_ratio", "-", "uniaxial: q/p at the end of the loading", [](P s) { return s.uniaxial() ? s.at("q_over_p", s.last()) : Value(); }},
      {"end_axial_stress_ratio", "-", "uniaxial in three dimensions: q/p there with q the axial pressure less the mean lateral one (Wellmann 32), as axial_q_over_p of states.csv", [](P s) { return s.uniaxial() && s.plan.dim == 3 ? s.at("axial_q_over_p", s.last()) : Value(); }},
      {"stiffening", "-", "uniaxial: rise of the axial stress in the second half of the strain over that in the first half; 1 of a straight line", [](P s) { return stiffening(s, 2, 2, 4, 0, 2); }},
      {"stiffening_late", "-", "the same of the last quarter over the second one", [](P s) { return stiffening(s, 4, 3, 4, 1, 2); }},
      {"plastic_strain", "-", "unloading: strain where the axial stress (of the lid; in a cell of the contacts) is that of the first state again, or a thousandth of the largest where the first one is below it", plastic_strain},
      {"unloading_stiffness", "-", "its slope to the middle state of the unloading over that of the loading's last quarter", unloading_stiffness},
      {"loop_loss", "-", "area of its loop over that under the loading", loop_loss},
      {"residual_stress", "-", "axial stress of the contacts after the unloading over that at the end of the loading", [](P s) { const VectorXd inside = s.inside(); return s.returns() ? Value(inside[inside.size() - 1] / inside[s.last()]) : Value(); }},
      {"energy_balance_error", "-", "largest change of the energies' sum less the work, over the work, of the states", largest_balance_error},
  };
  // clang-format on
  return all;
}

}  // namespace

Driving driving_of(const std::string& deformation, int dim) {
  if (deformation == "simple_shear")
    return {dim == 2 ? "sigma_xy" : "sigma_xz", false, "shear stress"};
  if (deformation == "axial") return {"q", false, "deviator"};
  if (deformation == "uniaxial") {
    return {dim == 2 ? "sigma_yy" : "sigma_zz", true, "axial pressure"};
  }
  return {"p", false, "mean stress"};
}

bool is_loaded(const dem::SamplePlan& plan) { return plan.strain >= kLeastLoading; }

FigureSamples sample_samples(const StateTable& table, const dem::SamplePlan& plan) {
  FigureSamples out;
  for (Index r = 0; r < table.realizations(); ++r) {
    const SamplePath path(table, plan, r);
    add_samples(packing_rows(), path, out, "sample.");
    if (is_loaded(plan)) add_samples(loading_rows(), path, out, "sample.");
  }
  return out;
}

std::vector<SummaryKey> sample_figures() {
  std::vector<SummaryKey> out = declared(packing_rows(), "sample.");
  for (SummaryKey& key : declared(loading_rows(), "sample.")) out.push_back(std::move(key));
  return out;
}

}  // namespace grainfield::coupling
