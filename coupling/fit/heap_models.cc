#include "coupling/fit/heap_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "continuum/closed/cantelaube.h"
#include "continuum/closed/osl.h"
#include "continuum/constants.h"
#include "coupling/fit/two_sided_models.h"

namespace grainfield::coupling {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

using continuum::Settings;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::string text(double v) { return fmt::format("{}", v); }

// What finite elements of a heap are told of it, in units of the fits.
Settings told(const HeapFacts& facts, Settings more = {}) {
  more.insert({{"phi_deg", text(facts.slope_deg)}, {"rho_g", "1"}, {"h", "1"}});
  return more;
}

FitParameter beta_hat(double phi) {
  return {"beta_hat_deg", "deg", "half tip angle of the elastic core, from the vertical", 1,
          90 - phi / kDegree - 0.1};
}

// Roul 4.11, 4.8 with seven free numbers: inside |x| < Y tan(beta_hat), Y = -y,
//   (xx, yy, xy) = rho g ((a2 - 1) Y, (a1 - 1) Y + b1 |x|, a1 x)           y up: xy changes sign
// outside rho g (a_xx, a_yy, -+a_xy) (|x| tan(slope) - Y), blended over `blend`: free constants
// jump on the core's boundary, and the quadrature of a kernel would make steps of it.
MatrixXd cantelaube_free(const MatrixXd& points, const VectorXd& p, double slope, double rho_g,
                         double blend) {
  const double a1 = p[0], a2 = p[1], b1 = p[2], axx = p[3], ayy = p[4], axy = p[5];
  const double sine = std::sin(p[6] * kDegree), cosine = std::cos(p[6] * kDegree);
  MatrixXd out = no_stress(points);
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    const double x = points(k, 0), y = -points(k, 1), off = std::fabs(x);
    const double cover = off * std::tan(slope) - y;
    if (cover > 0) continue;
    const double beyond = (off * cosine - y * sine) / blend;  // of the core's boundary
    const double flank = 0.5 * std::erfc(-beyond / std::numbers::sqrt2);
    const Eigen::RowVector3d core((a2 - 1) * y, (a1 - 1) * y + b1 * off, a1 * x);
    const Eigen::RowVector3d side(axx * cover, ayy * cover, -axy * cover * (x < 0 ? -1 : 1));
    out.row(k) = rho_g * ((1 - flank) * core + flank * side);
  }
  return out;
}

std::vector<RegistryEntry> branches(const HeapFacts& facts, const Settings& elements) {
  const std::vector<std::pair<std::string, continuum::CoreBranch>> all{
      {"minus", continuum::CoreBranch::minus},
      {"zero", continuum::CoreBranch::zero},
      {"plus", continuum::CoreBranch::plus}};
  std::vector<RegistryEntry> out;
  for (const auto& [name, branch] : all) {
    const double angle = continuum::core_angle(facts.slope_deg * kDegree, branch) / kDegree;
    RegistryEntry& e = out.emplace_back(
        RegistryEntry{"cantelaube_" + name,
                      fmt::format("elastic core, {} branch ({:.1f} deg)", name, angle),
                      "cantelaube",
                      {{"branch", name}},
                      {}});
    e.elements = {{"fe_mohr_coulomb_wedge", elements}};
  }
  return out;
}

// The description with seven free numbers.
RegistryEntry free_cantelaube(const HeapFacts& facts) {
  const double phi = facts.slope_deg * kDegree, b = std::numbers::pi / 2 - phi;
  const double sxx = std::pow(std::sin(b), 2), syy = 1 + std::pow(std::cos(b), 2),
               sxy = std::sin(b) * std::cos(b);
  const auto coefficient = [](const std::string& name, const std::string& meaning) {
    return FitParameter{name, "-", meaning, -kInfinite, kInfinite};
  };
  RegistryEntry out{
      "cantelaube", "elastic core and flanks, seven free numbers (Roul 4.3)", "", {}, {}};
  out.parameters = {coefficient("a1", "core: sigma_yy under the axis = (a1 - 1) rho g y"),
                    coefficient("a2", "core: sigma_xx = (a2 - 1) rho g y"),
                    coefficient("b1", "core: kink of sigma_yy at the axis; below 0 a dip"),
                    coefficient("a_xx", "flanks: sigma_xx over the weight above"),
                    coefficient("a_yy", "flanks: sigma_yy over the weight above"),
                    coefficient("a_xy", "flanks: shear over the weight above"),
                    beta_hat(phi)};
  out.starts.clear();
  for (double angle = 14; angle < 88 - facts.slope_deg; angle += 4) {
    const continuum::CoreConstants c = continuum::core_constants(phi, angle * kDegree);
    out.starts.push_back(numbers({c.a1, c.a2, c.b1, sxx, syy, sxy, angle}));
  }
  if (out.starts.empty()) {
    out.absent = fmt::format("flanks of {:.1f} degrees leave no room for a core", facts.slope_deg);
  }
  out.unbalanced = true;
  out.description = [phi, rho_g = facts.rho_g, blend = facts.blend](const MatrixXd& points,
                                                                    const VectorXd& p) {
    return cantelaube_free(points, p, phi, rho_g, blend);
  };
  return out;
}

std::vector<RegistryEntry> osl_entries(const HeapFacts& facts) {
  const double phi = facts.slope_deg * kDegree;
  const FitParameter eta{"eta", "-", "sigma_xx / sigma_yy where there is no shear", 0.02, 3};
  const FitParameter mu{"mu", "-", "sigma_xx per shear; below 0 arching, a dip", -2,
                        1 / std::tan(phi)};
  RegistryEntry yield{"osl_yield",
                      "oriented stress linearity, mu fitted, eta from yield at the slope",
                      "osl",
                      {},
                      {"eta", "mu"},
                      {mu},
                      {numbers({-0.8}), numbers({-0.3}), numbers({0.0}), numbers({0.2})}};
  yield.values = [phi](const VectorXd& p) {
    return numbers({continuum::eta_at_yield(phi, p[0]), p[0]});
  };
  RegistryEntry both{
      "osl", "oriented stress linearity, eta and mu fitted", "osl", {}, {"eta", "mu"}, {eta, mu},
      {}};
  for (const auto& [start, beside] : {std::pair(0.6, 0.0), {0.75, -0.3}, {0.95, -0.9}}) {
    const double most = (1 / std::tan(phi) - beside) / std::tan(phi);  // of the hyperbolic range
    both.starts.push_back(numbers({start < most ? start : most / 2, beside}));
  }
  yield.elements = both.elements = {{"fe_osl_wedge", told(facts)}};
  return {yield, both};
}

}  // namespace

RunFacts facts_of(const HeapFacts& facts, const std::string& registry) {
  // Where the flanks are taken apart their friction angle is not the mean slope.
  const bool apart = registry == "cantelaube_asymmetric";
  return {0,
          facts.height,
          2,
          facts.height,
          "",
          {{"rho_g", facts.rho_g},
           {"phi_deg", apart ? facts.friction() : facts.slope_deg},
           {"left_deg", facts.left()},
           {"right_deg", facts.right()}}};
}

std::vector<RegistryEntry> heap_entries(const HeapFacts& facts) {
  // A slope at the friction angle stands without dilation only by luck (theory-plasticity.md).
  const Settings wedge = told(facts, {{"dilation_deg", text(std::min(10.0, facts.slope_deg))},
                                      {"history", "grow"},
                                      {"layers", "12"},
                                      {"cells", "24"}});
  std::vector<RegistryEntry> out;
  out.push_back({"hydrostatic", "weight above, isotropic", "hydrostatic", {}, {}});
  for (RegistryEntry& e : branches(facts, wedge)) out.push_back(std::move(e));
  out.push_back({"cantelaube_continuous",
                 "elastic core, its angle fitted, constants by continuity",
                 "cantelaube",
                 {},
                 {"beta_hat_deg"},
                 {beta_hat(facts.slope_deg * kDegree)},
                 {numbers({22}), numbers({38}), numbers({48})}});
  out.back().elements = {{"fe_mohr_coulomb_wedge", wedge}};
  out.push_back(free_cantelaube(facts));
  for (RegistryEntry& e : osl_entries(facts)) out.push_back(std::move(e));
  out.push_back({"fpa", "fixed principal axes", "fpa", {}, {}});
  out.push_back({"bcc", "Bouchaud, Cates and Claudin: mu = 0", "bcc", {}, {}});
  for (RegistryEntry& e : two_sided_entries(facts)) out.push_back(std::move(e));
  return out;
}

std::vector<FitModel> heap_models(const HeapFacts& facts) {
  std::vector<FitModel> out;
  for (const RegistryEntry& entry : heap_entries(facts)) {
    out.push_back(model_of_entry(entry, facts_of(facts, entry.registry)));
  }
  return out;
}

FitModel seen_through(FitModel model, std::shared_ptr<const HeapSight> sight) {
  model.stress = [exact = std::move(model.stress), sight = std::move(sight)](
                     const Eigen::MatrixXd& points, const Eigen::VectorXd& parameters) {
    const Eigen::MatrixXd seen =
        sight->through.seen([&](const Eigen::MatrixXd& nodes) { return exact(nodes, parameters); });
    return sight->places.pick(seen, points);
  };
  return model;
}

const FitModel& find_fit_model(const std::vector<FitModel>& models, const std::string& name) {
  std::vector<std::string> names;
  for (const FitModel& model : models) {
    if (model.name == name) return model;
    names.push_back(model.name);
  }
  throw std::invalid_argument(
      fmt::format("fit: found model {}, allowed: {}", name, fmt::join(names, ", ")));
}

}  // namespace grainfield::coupling
