#include "coupling/fit/layer_models.h"

#include <algorithm>
#include <cmath>

namespace grainfield::coupling {
namespace {

using Eigen::VectorXd;

constexpr double kMostPoisson = 0.499;
constexpr double kLeastRho = -0.95, kMostRho = 20;  // below, the waves of a layer reach too far
constexpr double kLeastWidth = 0.1;  // of the load, h: narrower ones are blurred by any kernel

RegistryEntry osl_entry(const std::string& base) {
  RegistryEntry out{"osl_layer_" + base,
                    "oriented stress linearity, " + base + " base",
                    "osl_layer",
                    {{"base", base}},
                    {"eta", "mu", "width"}};
  out.parameters = {
      {"eta", "-", "sigma_xx / sigma_yy where there is no shear", 0.02, 6},
      {"mu", "-", "sigma_xx per shear: tilts both characteristics", -2, 2},
      {"width", "h", "the load is spread as 1 + cos over this width", kLeastWidth, 4}};
  out.starts.clear();
  for (const double e : {0.1, 0.35, 1.0, 2.5}) {
    for (const double w : {0.3, 1.5}) out.starts.push_back(numbers({e, 0, w}));
  }
  if (base == "absorbing") out.elements = {{"fe_osl_layer", {}}};
  return out;
}

std::vector<RegistryEntry> isotropic_entries() {
  const FitParameter nu{"nu", "-", "Poisson's ratio", 0, kMostPoisson};
  RegistryEntry flamant{"flamant", "isotropic half plane", "flamant", {}, {}};
  flamant.elements = {{"fe_elastic_half_space", {}}};
  RegistryEntry smooth{
      "layer_smooth", "isotropic layer on a smooth base", "layer", {{"base", "smooth"}}, {}};
  RegistryEntry rough{
      "layer_rough", "isotropic layer on a rough base", "layer", {{"base", "rough"}}, {"nu"},
      {nu},          {numbers({0.1}), numbers({0.4})}};
  smooth.elements = rough.elements = {{"fe_elastic_layer", {}}};
  return {flamant, smooth, rough};
}

// rho and t as the registry's r and t.
VectorXd medium(const VectorXd& p) { return numbers({p[0] * std::sqrt(p[1]), p[1]}); }

// shear, t and nu_ratio as its r, t and nu_xy.
VectorXd rough_medium(const VectorXd& p) {
  const double root = std::sqrt(p[1]);
  return numbers({std::max(p[0] - p[2], kLeastRho) * root, p[1], p[2] * root});
}

std::vector<RegistryEntry> orthotropic_entries() {
  const FitParameter rho{
      "rho", "-", "r/sqrt(t): below 0 two peaks, -1 the hyperbolic limit", kLeastRho, kMostRho, -1};
  const FitParameter t{"t", "-", "E_x/E_y", 0.02, 50, 0};
  // On a rough base Hooke's law itself counts, and must be of a solid: both bounds say so.
  const FitParameter shear{"shear", "-", "E_x/(2 G sqrt t) = rho + nu_ratio; isotropic: 1 + nu",
                           0.02, kMostRho};
  const FitParameter nu_ratio{"nu_ratio", "-", "nu_xy/sqrt t", -0.95, 0.95};
  RegistryEntry plane{"orthotropic_half_plane",
                      "orthotropic half plane",
                      "orthotropic_half_plane",
                      {},
                      {"r", "t"},
                      {rho, t},
                      {numbers({1, 1}), numbers({-0.5, 0.3}), numbers({0.5, 3})}};
  plane.values = medium;
  RegistryEntry smooth = plane;
  smooth.name = "orthotropic_layer_smooth";
  smooth.label = "orthotropic layer on a smooth base";
  smooth.registry = "orthotropic_layer";
  smooth.fixed = {{"base", "smooth"}};
  RegistryEntry rough{"orthotropic_layer_rough",
                      "orthotropic layer on a rough base",
                      "orthotropic_layer",
                      {{"base", "rough"}},
                      {"r", "t", "nu_xy"},
                      {shear, t, nu_ratio},
                      {numbers({1.3, 1, 0.3}), numbers({0.2, 0.3, 0.6}), numbers({0.7, 3, 0.2})}};
  rough.values = rough_medium;
  smooth.elements = rough.elements = {{"fe_orthotropic_layer", {}}};
  return {plane, smooth, rough};
}

}  // namespace

RunFacts facts_of_layer() { return {1, 1, 2, 0.1, "", {}}; }

std::vector<RegistryEntry> layer_entries() {
  std::vector<RegistryEntry> out = isotropic_entries();
  for (RegistryEntry& e : orthotropic_entries()) out.push_back(std::move(e));
  for (const char* base : {"absorbing", "reflecting"}) out.push_back(osl_entry(base));
  return out;
}

std::vector<FitModel> layer_models(std::shared_ptr<const LayerSight> sight) {
  std::vector<FitModel> out;
  for (const RegistryEntry& entry : layer_entries()) {
    out.push_back(model_of_entry(entry, facts_of_layer(), sight));
  }
  return out;
}

Ratio rho_of(const Fit& fit) {
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    const FittedParameter& p = fit.parameters[k];
    if (p.parameter.name == "rho") return {p.value, p.error};
    if (p.parameter.name != "shear") continue;
    const FittedParameter& nu = fit.parameters[k + 2];
    const double covariance =
        fit.correlation(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k) + 2) * p.error *
        nu.error;
    return {std::max(p.value - nu.value, kLeastRho),
            std::sqrt(p.error * p.error + nu.error * nu.error - 2 * covariance)};
  }
  return {std::nan(""), std::nan("")};
}

}  // namespace grainfield::coupling
