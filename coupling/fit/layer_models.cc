#include "coupling/fit/layer_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "continuum/closed/half_space.h"
#include "continuum/closed/orthotropic.h"
#include "continuum/closed/osl_layer.h"

namespace grainfield::coupling {
namespace {

using continuum::OrthotropicWaves;
using continuum::Orthotropy;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Prediction =
    std::function<MatrixXd(const VectorXd&)>;  // parameters -> at all points of the sight

constexpr double kMostPoisson = 0.499;
constexpr double kLeastRho = -0.95, kMostRho = 20;  // below, the waves of a layer reach too far
constexpr double kLeastWidth = 0.1;  // of the load, h: narrower ones are blurred by any kernel

double value_of(const Fit& fit, const std::string& name) {
  for (const FittedParameter& p : fit.parameters) {
    if (p.parameter.name == name) return p.value;
  }
  throw std::logic_error("no parameter " + name + " of " + fit.name);
}

std::string text(double v) { return fmt::format("{}", v); }

Orthotropy medium(double rho, double t) { return {rho * std::sqrt(t), t}; }

class List {
 public:
  explicit List(std::shared_ptr<const LayerSight> sight) : sight_(std::move(sight)) {}

  void add(const std::string& name, const std::string& label, std::vector<FitParameter> parameters,
           std::vector<VectorXd> starts, const Prediction& seen) {
    models.push_back({name, label, std::move(parameters), std::move(starts),
                      [sight = sight_, seen](const MatrixXd& points, const VectorXd& p) {
                        return sight->pick(seen(p), points);
                      },
                      ""});
  }
  // A model without parameters is evaluated once.
  void add_fixed(const std::string& name, const std::string& label, const Prediction& seen) {
    const auto kept = std::make_shared<MatrixXd>();
    add(name, label, {}, {VectorXd(0)}, [kept, seen](const VectorXd& p) {
      if (kept->size() == 0) *kept = seen(p);
      return *kept;
    });
  }

  std::vector<FitModel> models;

 private:
  std::shared_ptr<const LayerSight> sight_;
};

MatrixXd flamant(const MatrixXd& nodes) {
  MatrixXd out(nodes.rows(), 3);
  for (Eigen::Index k = 0; k < nodes.rows(); ++k) {
    const auto s = continuum::flamant_stress(1, nodes(k, 0), nodes(k, 1));
    out.row(k) << s[0], s[1], s[2];
  }
  return out;
}

}  // namespace

std::vector<FitModel> layer_models(std::shared_ptr<const LayerSight> sight) {
  List list(sight);
  const LayerSight* at = sight.get();  // the models hold the sight
  const FitParameter nu{"nu", "-", "Poisson's ratio", 0, kMostPoisson};
  const FitParameter rho{"rho", "-", "r/sqrt(t): below 0 two peaks, -1 the hyperbolic limit",
                         kLeastRho, kMostRho};
  const FitParameter t{"t", "-", "E_x/E_y", 0.02, 50};
  // On a rough base Hooke's law itself counts, and must be of a solid: both bounds say so.
  const FitParameter shear{"shear", "-", "E_x/(2 G sqrt t) = rho + nu_ratio; isotropic: 1 + nu",
                           0.02, kMostRho};
  const FitParameter nu_ratio{"nu_ratio", "-", "nu_xy/sqrt t", -0.95, 0.95};
  const FitParameter eta{"eta", "-", "sigma_xx / sigma_yy where there is no shear", 0.02, 6};
  const FitParameter mu{"mu", "-", "sigma_xx per shear: tilts both characteristics", -2, 2};
  const FitParameter width{"width", "h", "the load is spread as 1 + cos over this width",
                           kLeastWidth, 4};
  list.add_fixed("flamant", "isotropic half plane",
                 [at](const VectorXd&) { return at->seen(flamant, true); });
  list.add_fixed("layer_smooth", "isotropic layer on a smooth base", [at](const VectorXd&) {
    return at->seen(OrthotropicWaves({1, 1}, 0, false));
  });
  list.add("layer_rough", "isotropic layer on a rough base", {nu}, {numbers({0.1}), numbers({0.4})},
           [at](const VectorXd& p) {
             return at->seen(OrthotropicWaves({1, 1}, p[0] / (1 - p[0]), true));
           });
  const std::vector<VectorXd> media{numbers({1, 1}), numbers({-0.5, 0.3}), numbers({0.5, 3})};
  list.add("orthotropic_half_plane", "orthotropic half plane", {rho, t}, media,
           [at](const VectorXd& p) {
             const Orthotropy o = medium(p[0], p[1]);
             return at->seen(
                 [&o](const MatrixXd& nodes) {
                   MatrixXd out(nodes.rows(), 3);
                   for (Eigen::Index k = 0; k < nodes.rows(); ++k) {
                     const auto s = continuum::orthotropic_stress(1, o, nodes(k, 0), nodes(k, 1));
                     out.row(k) << s[0], s[1], s[2];
                   }
                   return out;
                 },
                 true);
           });
  list.add(
      "orthotropic_layer_smooth", "orthotropic layer on a smooth base", {rho, t}, media,
      [at](const VectorXd& p) { return at->seen(OrthotropicWaves(medium(p[0], p[1]), 0, false)); });
  list.add("orthotropic_layer_rough", "orthotropic layer on a rough base", {shear, t, nu_ratio},
           {numbers({1.3, 1, 0.3}), numbers({0.2, 0.3, 0.6}), numbers({0.7, 3, 0.2})},
           [at](const VectorXd& p) {
             const double ratio = std::max(p[0] - p[2], kLeastRho);
             return at->seen(OrthotropicWaves(medium(ratio, p[1]), p[2] * std::sqrt(p[1]), true));
           });
  std::vector<VectorXd> starts;
  for (const double e : {0.1, 0.35, 1.0, 2.5}) {
    for (const double w : {0.3, 1.5}) starts.push_back(numbers({e, 0, w}));
  }
  for (const bool reflecting : {false, true}) {
    const std::string base = reflecting ? "reflecting" : "absorbing";
    list.add("osl_layer_" + base, "oriented stress linearity, " + base + " base", {eta, mu, width},
             starts, [at, reflecting](const VectorXd& p) {
               const continuum::OslLayerField field(continuum::Closure{p[0], p[1]}, 1, 1, p[2],
                                                    reflecting ? 1 : 0);
               return at->seen(
                   [&field](const MatrixXd& nodes) {
                     MatrixXd out(nodes.rows(), 3);
                     for (Eigen::Index k = 0; k < nodes.rows(); ++k) {
                       out.row(k) = field.stress(nodes(k, 0), nodes(k, 1)).transpose();
                     }
                     return out;
                   },
                   false);
             });
  }
  return list.models;
}

const std::vector<std::string>& layer_model_names() {
  static const std::vector<std::string> names{"flamant",
                                              "layer_smooth",
                                              "layer_rough",
                                              "orthotropic_half_plane",
                                              "orthotropic_layer_smooth",
                                              "orthotropic_layer_rough",
                                              "osl_layer_absorbing",
                                              "osl_layer_reflecting"};
  return names;
}

std::string type_of_equations(const std::string& model) {
  return model.find("osl") != std::string::npos ? "hyperbolic" : "elliptic";
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

ModelChoice fitted_choice(const Fit& fit, double h) {
  ModelChoice out{fit.name, fit.name, {}};
  const auto starts = [&](const char* word) { return fit.name.rfind(word, 0) == 0; };
  const auto base = [&] { return fit.name.substr(fit.name.rfind('_') + 1); };
  if (starts("layer_")) {
    out.name = "layer";
    out.settings["base"] = base();
    if (base() == "rough") out.settings["nu"] = text(value_of(fit, "nu"));
  } else if (starts("orthotropic_")) {
    const double t = value_of(fit, "t");
    out.settings["t"] = text(t);
    out.settings["r"] = text(rho_of(fit).value * std::sqrt(t));
    if (starts("orthotropic_layer_")) {
      out.name = "orthotropic_layer";
      out.settings["base"] = base();
      if (base() == "rough") {
        out.settings["nu_xy"] = text(value_of(fit, "nu_ratio") * std::sqrt(t));
      }
    }
  } else if (starts("osl_layer_")) {
    out.name = "osl_layer";
    out.settings["base"] = base();
    out.settings["eta"] = text(value_of(fit, "eta"));
    out.settings["mu"] = text(value_of(fit, "mu"));
    out.settings["width"] = text(value_of(fit, "width") * h);
  }
  return out;
}

std::unique_ptr<ModelChoice> finite_element_choice(const std::string& name,
                                                   const std::vector<Fit>& fits, double h,
                                                   std::string& of, std::string& why) {
  static const std::map<std::string, std::string> represents{
      {"fe_elastic_half_space", "flamant"},
      {"fe_elastic_layer", "layer_"},
      {"fe_orthotropic_layer", "orthotropic_layer_"},
      {"fe_osl_layer", "osl_layer_absorbing"}};
  const auto word = represents.find(name);
  const Fit* best = nullptr;
  for (const Fit& f : fits) {
    if (word == represents.end() || f.name.rfind(word->second, 0) != 0) continue;
    if (best == nullptr || better(f, *best)) best = &f;
  }
  if (best == nullptr) {
    why = "no fitted model that it represents";
    return nullptr;
  }
  of = best->name;
  const ModelChoice fitted = fitted_choice(*best, h);
  auto out = std::make_unique<ModelChoice>(ModelChoice{name, name, {}});
  out->settings = fitted.settings;
  if (name == "fe_osl_layer") out->settings.erase("base");
  return out;
}

}  // namespace grainfield::coupling
