#include "coupling/fit/models.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "continuum/closed/cantelaube.h"
#include "continuum/closed/heap_field.h"
#include "continuum/closed/hydrostatic.h"
#include "continuum/closed/osl.h"
#include "continuum/constants.h"
#include "coupling/fit/two_sided_models.h"

namespace grainfield::coupling {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd nothing(const MatrixXd& points) {
  return MatrixXd::Constant(points.rows(), 3, std::numeric_limits<double>::quiet_NaN());
}

// One that needs no search.
FitModel fixed(const std::string& name, const std::string& label,
               std::function<MatrixXd(const MatrixXd&)> stress) {
  return {name,
          label,
          {},
          {VectorXd(0)},
          [stress](const MatrixXd& points, const VectorXd&) { return stress(points); },
          ""};
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
  MatrixXd out = nothing(points);
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

}  // namespace

std::vector<FitModel> heap_models(const HeapFacts& facts) {
  const double phi = facts.slope_deg * kDegree, rho_g = facts.rho_g;
  using continuum::Closure;
  using continuum::CoreBranch;
  std::vector<FitModel> out;
  out.push_back(
      fixed("hydrostatic", "weight above, isotropic",
            [setup = continuum::HydrostaticSetup{rho_g, 0, facts.left() * kDegree,
                                                 facts.right() * kDegree}](const MatrixXd& points) {
              return MatrixXd(continuum::hydrostatic_stress(setup, points));
            }));
  const std::vector<std::pair<std::string, CoreBranch>> branches{
      {"minus", CoreBranch::minus}, {"zero", CoreBranch::zero}, {"plus", CoreBranch::plus}};
  for (const auto& [name, branch] : branches) {
    const double angle = continuum::core_angle(phi, branch);
    out.push_back(fixed("cantelaube_" + name,
                        fmt::format("elastic core, {} branch ({:.1f} deg)", name, angle / kDegree),
                        [=](const MatrixXd& points) {
                          return continuum::cantelaube_field(phi, angle, rho_g).stress(points);
                        }));
  }
  out.push_back({"cantelaube_continuous",
                 "elastic core, its angle fitted, constants by continuity",
                 {beta_hat(phi)},
                 {numbers({22}), numbers({38}), numbers({48})},
                 [=](const MatrixXd& points, const VectorXd& p) {
                   return continuum::cantelaube_field(phi, p[0] * kDegree, rho_g).stress(points);
                 },
                 ""});
  const double b = std::numbers::pi / 2 - phi;
  const double sxx = std::pow(std::sin(b), 2), syy = 1 + std::pow(std::cos(b), 2),
               sxy = std::sin(b) * std::cos(b);
  std::vector<VectorXd> starts;
  for (double angle = 14; angle < 88 - facts.slope_deg; angle += 4) {
    const continuum::CoreConstants c = continuum::core_constants(phi, angle * kDegree);
    starts.push_back(numbers({c.a1, c.a2, c.b1, sxx, syy, sxy, angle}));
  }
  const auto coefficient = [](const std::string& name, const std::string& meaning) {
    return FitParameter{name, "-", meaning, -kInfinite, kInfinite};
  };
  out.push_back({"cantelaube",
                 "elastic core and flanks, seven free numbers (Roul 4.3)",
                 {coefficient("a1", "core: sigma_yy under the axis = (a1 - 1) rho g y"),
                  coefficient("a2", "core: sigma_xx = (a2 - 1) rho g y"),
                  coefficient("b1", "core: kink of sigma_yy at the axis; below 0 a dip"),
                  coefficient("a_xx", "flanks: sigma_xx over the weight above"),
                  coefficient("a_yy", "flanks: sigma_yy over the weight above"),
                  coefficient("a_xy", "flanks: shear over the weight above"), beta_hat(phi)},
                 starts,
                 [=](const MatrixXd& points, const VectorXd& p) {
                   return cantelaube_free(points, p, phi, rho_g, facts.blend);
                 },
                 starts.empty() ? fmt::format("flanks of {:.1f} degrees leave no room for a core",
                                              facts.slope_deg)
                                : ""});
  // c1 < cot(phi) and eta > 0, nan elsewhere.
  const auto osl = [=](const MatrixXd& points, double eta, double mu) {
    const Closure closure{eta, mu};
    if (!(eta > 0) || !(closure.c1() < 1 / std::tan(phi))) return nothing(points);
    return MatrixXd(continuum::osl_field(phi, closure, rho_g).stress(points));
  };
  const FitParameter eta{"eta", "-", "sigma_xx / sigma_yy where there is no shear", 0.02, 3};
  const double most_mu = 1 / std::tan(phi);
  const FitParameter mu{"mu", "-", "sigma_xx per shear; below 0 arching, a dip", -2, most_mu};
  out.push_back({"osl_yield",
                 "oriented stress linearity, mu fitted, eta from yield at the slope",
                 {mu},
                 {numbers({-0.8}), numbers({-0.3}), numbers({0.0}), numbers({0.2})},
                 [=](const MatrixXd& points, const VectorXd& p) {
                   return osl(points, continuum::eta_at_yield(phi, p[0]), p[0]);
                 },
                 ""});
  out.push_back({"osl",
                 "oriented stress linearity, eta and mu fitted",
                 {eta, mu},
                 {numbers({0.6, 0.0}), numbers({0.75, -0.3}), numbers({0.95, -0.9})},
                 [=](const MatrixXd& points, const VectorXd& p) { return osl(points, p[0], p[1]); },
                 ""});
  const auto text = [](double v) { return fmt::format("{}", v); };
  const auto heap = [text, slope = facts.slope_deg](double h) {
    return continuum::Settings{{"phi_deg", text(slope)}, {"rho_g", "1"}, {"h", text(h)}};
  };
  for (FitModel& model : out) {
    if (model.name == "osl" || model.name == "osl_yield") {
      const bool both = model.parameters.size() == 2;
      model.in_registry = {{"fe_osl_wedge", [=](const VectorXd& p, double h) {
                              continuum::Settings settings = heap(h);
                              const double of_yield = continuum::eta_at_yield(
                                  facts.slope_deg * std::numbers::pi / 180, p[p.size() - 1]);
                              settings["eta"] = text(both ? p[0] : of_yield);
                              settings["mu"] = text(p[p.size() - 1]);
                              return settings;
                            }}};
    } else if (model.name.starts_with("cantelaube_")) {
      model.in_registry = {{"fe_mohr_coulomb_wedge", [=](const VectorXd&, double h) {
                              continuum::Settings settings = heap(h);
                              // A slope at the friction angle stands without dilation only by luck
                              // (theory-plasticity.md).
                              settings.insert(
                                  {{"dilation_deg", text(std::min(10.0, facts.slope_deg))},
                                   {"history", "grow"},
                                   {"layers", "12"},
                                   {"cells", "24"}});
                              return settings;
                            }}};
    }
  }
  out.push_back(fixed("fpa", "fixed principal axes",
                      [=](const MatrixXd& points) { return osl(points, 1, -2 * std::tan(phi)); }));
  out.push_back(fixed("bcc", "Bouchaud, Cates and Claudin: mu = 0", [=](const MatrixXd& points) {
    return osl(points, continuum::eta_at_yield(phi, 0), 0);
  }));
  for (FitModel& model : two_sided_models(facts)) out.push_back(std::move(model));
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
