#include "coupling/studies/sample/state_figures.h"

#include <algorithm>
#include <cmath>

#include "continuum/constants.h"

namespace grainfield::coupling {
namespace {

struct Secant {
  double modulus = kNan, strain = kNan;
};

// To the first strain at which `stress` has risen by half of its largest rise, by straight lines
// between the states.
Secant secant_of(const Eigen::VectorXd& strain, const Eigen::VectorXd& stress) {
  const double half = 0.5 * (stress.maxCoeff() - stress[0]);
  if (!(half > 0)) return {};
  for (Eigen::Index k = 1; k < stress.size(); ++k) {
    const double before = stress[k - 1] - stress[0], now = stress[k] - stress[0];
    if (now < half) continue;
    const double at =
        strain[k - 1] + (strain[k] - strain[k - 1]) * (half - before) / (now - before);
    return {half / (at - strain[0]), at};
  }
  return {};
}

// How many of the last states, which are at equal steps of strain, are beyond kCriticalFrom of it.
Eigen::Index critical_states(Eigen::Index states) {
  const double first = std::ceil(kCriticalFrom * static_cast<double>(states - 1));
  return states - static_cast<Eigen::Index>(first);
}

// A box without stress at the start has no strength that it could lose there.
std::vector<bool> bearing(const Eigen::VectorXd& p, const Eigen::VectorXd& inertial_number,
                          const Eigen::VectorXd& ratio) {
  std::vector<bool> out;
  for (Eigen::Index k = 0; k < p.size(); ++k) {
    const bool empty = k == 0 && !(p[0] > 0);
    out.push_back(empty || (p[k] > kLeastPressure * p[0] && inertial_number[k] < kMostInertia &&
                            std::isfinite(ratio[k])));
  }
  return out;
}

// Without states that have none.
double largest_number(const Eigen::VectorXd& values) {
  double out = kNan;
  for (const double v : values) {
    if (std::isfinite(v) && !(v <= out)) out = v;
  }
  return out;
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

std::map<std::string, std::vector<double>> state_figures(const StateTable& table,
                                                         const std::string& deformation,
                                                         int records) {
  std::map<std::string, std::vector<double>> out;
  const Driving driving = driving_of(deformation, table.dim());
  for (Eigen::Index r = 0; r < table.realizations(); ++r) {
    const auto column = [&](const std::string& name) -> Eigen::VectorXd {
      return table.of(name).col(r).head(records + 1);
    };
    const auto put = [&](const std::string& key, double value) {
      out["sample." + key].push_back(value);
    };
    const Eigen::VectorXd strain = column("strain"), ratio = column("q_over_p");
    put("initial_pressure", column("p")[0]);
    put("initial_solid_fraction", column("solid_fraction")[0]);
    put("initial_coordination", column("coordination_bearing")[0]);
    const std::vector<bool> bears = bearing(column("p"), column("inertial_number"), ratio);
    const Eigen::Index last = strain.size() - 1;
    put("final_pressure", column("p")[last]);
    const auto lost = std::find(bears.begin(), bears.end(), false);
    put("lost_strength", lost != bears.end());
    if (lost != bears.end()) put("strain_at_loss", strain[lost - bears.begin()]);
    put("volumetric_strain", column("volumetric_strain")[last]);
    put("inertial_number", largest_number(column("inertial_number")));
    const Eigen::VectorXd stress =
        driving.compression ? Eigen::VectorXd(-column(driving.stress)) : column(driving.stress);
    const Secant secant = secant_of(strain, stress);
    put("secant_modulus", secant.modulus);
    put("secant_strain", secant.strain);
    const Eigen::VectorXd balance = column("balance_error");
    if (balance.size() > 1 && balance.tail(balance.size() - 1).allFinite()) {
      put("energy_balance_error", balance.tail(balance.size() - 1).cwiseAbs().maxCoeff());
    }
    if (deformation == "uniaxial") {
      put("lateral_stress_ratio", column("sigma_xx")[last] / column(driving.stress)[last]);
    }
    if (deformation == "uniaxial" || deformation == "isotropic") continue;
    Eigen::Index peak = -1;
    for (Eigen::Index k = 0; k <= last; ++k) {
      if (!bears[static_cast<std::size_t>(k)] || !std::isfinite(ratio[k])) continue;
      if (peak < 0 || ratio[k] > ratio[peak]) peak = k;
    }
    if (peak >= 0) {
      put("peak_stress_ratio", ratio[peak]);
      put("strain_at_peak", strain[peak]);
      put("peak_friction_angle_deg", column("friction_angle_deg")[peak]);
    }
    const Eigen::Index n = critical_states(strain.size()), half = n / 2;
    if (n < 2 || std::find(bears.end() - n, bears.end(), false) != bears.end()) continue;
    put("critical_stress_ratio", ratio.tail(n).mean());
    put("critical_friction_angle_deg", column("friction_angle_deg").tail(n).mean());
    put("critical_solid_fraction", column("solid_fraction").tail(n).mean());
    put("critical_coordination", column("coordination_bearing").tail(n).mean());
    put("critical_drift", ratio.tail(half).mean() / ratio.tail(n).head(half).mean() - 1);
  }
  return out;
}

}  // namespace grainfield::coupling
