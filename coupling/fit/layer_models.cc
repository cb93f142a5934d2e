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
using continuum::Settings;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Prediction =
    std::function<MatrixXd(const VectorXd&)>;  // parameters -> at all points of the operator

constexpr double kMostPoisson = 0.499;
constexpr double kLeastRho = -0.95, kMostRho = 20;  // below, the waves of a layer reach too far
constexpr double kLeastWidth = 0.1;  // of the load, h: narrower ones are blurred by any kernel

std::string text(double v) { return fmt::format("{}", v); }

Orthotropy medium(double rho, double t) { return {rho * std::sqrt(t), t}; }
Settings medium_settings(double rho, double t) {
  return {{"t", text(t)}, {"r", text(rho * std::sqrt(t))}};
}

class List {
 public:
  explicit List(std::shared_ptr<const LayerSight> seeing) : seeing_(std::move(seeing)) {}

  void add(const std::string& name, const std::string& label, std::vector<FitParameter> parameters,
           std::vector<VectorXd> starts, const Prediction& seen,
           std::vector<RegistryModel> in_registry, const std::string& equations = "elliptic") {
    models.push_back({name, label, std::move(parameters), std::move(starts),
                      [seeing = seeing_, seen](const MatrixXd& points, const VectorXd& p) {
                        return seeing->places().pick(seen(p), points);
                      },
                      ""});
    models.back().in_registry = std::move(in_registry);
    models.back().equations = equations;
  }
  // A model without parameters is evaluated once.
  void add_fixed(const std::string& name, const std::string& label, const Prediction& seen,
                 std::vector<RegistryModel> in_registry) {
    const auto kept = std::make_shared<MatrixXd>();
    const Prediction once = [kept, seen](const VectorXd& p) {
      if (kept->size() == 0) *kept = seen(p);
      return *kept;
    };
    add(name, label, {}, {VectorXd(0)}, once, std::move(in_registry));
  }

  std::vector<FitModel> models;

 private:
  std::shared_ptr<const LayerSight> seeing_;
};

// The names that have these settings.
std::vector<RegistryModel> known_as(std::initializer_list<const char*> names,
                                    const std::function<Settings(const VectorXd&, double)>& with) {
  std::vector<RegistryModel> out;
  for (const char* name : names) out.push_back({name, with});
  return out;
}

// The same whatever the constants and h.
std::function<Settings(const VectorXd&, double)> always(const Settings& settings) {
  return [settings](const VectorXd&, double) { return settings; };
}

MatrixXd flamant(const MatrixXd& nodes) {
  MatrixXd out(nodes.rows(), 3);
  for (Eigen::Index k = 0; k < nodes.rows(); ++k) {
    const auto s = continuum::flamant_stress(1, nodes(k, 0), nodes(k, 1));
    out.row(k) << s[0], s[1], s[2];
  }
  return out;
}

}  // namespace

std::vector<FitModel> layer_models(std::shared_ptr<const LayerSight> seeing) {
  List list(seeing);
  const LayerSight* at = seeing.get();  // the models hold it
  const FitParameter nu{"nu", "-", "Poisson's ratio", 0, kMostPoisson};
  const FitParameter rho{
      "rho", "-", "r/sqrt(t): below 0 two peaks, -1 the hyperbolic limit", kLeastRho, kMostRho, -1};
  const FitParameter t{"t", "-", "E_x/E_y", 0.02, 50, 0};
  // On a rough base Hooke's law itself counts, and must be of a solid: both bounds say so.
  const FitParameter shear{"shear", "-", "E_x/(2 G sqrt t) = rho + nu_ratio; isotropic: 1 + nu",
                           0.02, kMostRho};
  const FitParameter nu_ratio{"nu_ratio", "-", "nu_xy/sqrt t", -0.95, 0.95};
  const FitParameter eta{"eta", "-", "sigma_xx / sigma_yy where there is no shear", 0.02, 6};
  const FitParameter mu{"mu", "-", "sigma_xx per shear: tilts both characteristics", -2, 2};
  const FitParameter width{"width", "h", "the load is spread as 1 + cos over this width",
                           kLeastWidth, 4};
  list.add_fixed(
      "flamant", "isotropic half plane", [at](const VectorXd&) { return at->seen(flamant, true); },
      known_as({"flamant", "fe_elastic_half_space"}, always({})));
  list.add_fixed(
      "layer_smooth", "isotropic layer on a smooth base",
      [at](const VectorXd&) {
        return at->seen(OrthotropicWaves({1, 1}, 0, false));
      },
      known_as({"layer", "fe_elastic_layer"}, always({{"base", "smooth"}})));
  list.add(
      "layer_rough", "isotropic layer on a rough base", {nu}, {numbers({0.1}), numbers({0.4})},
      [at](const VectorXd& p) {
        return at->seen(OrthotropicWaves({1, 1}, p[0] / (1 - p[0]), true));
      },
      known_as({"layer", "fe_elastic_layer"}, [](const VectorXd& p, double) {
        return Settings{{"base", "rough"}, {"nu", text(p[0])}};
      }));
  const std::vector<VectorXd> media{numbers({1, 1}), numbers({-0.5, 0.3}), numbers({0.5, 3})};
  list.add(
      "orthotropic_half_plane", "orthotropic half plane", {rho, t}, media,
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
      },
      known_as({"orthotropic_half_plane"},
               [](const VectorXd& p, double) { return medium_settings(p[0], p[1]); }));
  list.add(
      "orthotropic_layer_smooth", "orthotropic layer on a smooth base", {rho, t}, media,
      [at](const VectorXd& p) { return at->seen(OrthotropicWaves(medium(p[0], p[1]), 0, false)); },
      known_as({"orthotropic_layer", "fe_orthotropic_layer"}, [](const VectorXd& p, double) {
        Settings out = medium_settings(p[0], p[1]);
        out["base"] = "smooth";
        return out;
      }));
  list.add(
      "orthotropic_layer_rough", "orthotropic layer on a rough base", {shear, t, nu_ratio},
      {numbers({1.3, 1, 0.3}), numbers({0.2, 0.3, 0.6}), numbers({0.7, 3, 0.2})},
      [at](const VectorXd& p) {
        const double ratio = std::max(p[0] - p[2], kLeastRho);
        return at->seen(OrthotropicWaves(medium(ratio, p[1]), p[2] * std::sqrt(p[1]), true));
      },
      known_as({"orthotropic_layer", "fe_orthotropic_layer"}, [](const VectorXd& p, double) {
        Settings out = medium_settings(std::max(p[0] - p[2], kLeastRho), p[1]);
        out["base"] = "rough";
        out["nu_xy"] = text(p[2] * std::sqrt(p[1]));
        return out;
      }));
  std::vector<VectorXd> starts;
  for (const double e : {0.1, 0.35, 1.0, 2.5}) {
    for (const double w : {0.3, 1.5}) starts.push_back(numbers({e, 0, w}));
  }
  for (const bool reflecting : {false, true}) {
    const std::string base = reflecting ? "reflecting" : "absorbing";
    const auto settings = [](const VectorXd& p, double h) {
      return Settings{{"eta", text(p[0])}, {"mu", text(p[1])}, {"width", text(p[2] * h)}};
    };
    std::vector<RegistryModel> known{{"osl_layer", [settings, base](const VectorXd& p, double h) {
                                        Settings out = settings(p, h);
                                        out["base"] = base;
                                        return out;
                                      }}};
    if (!reflecting) known.push_back({"fe_osl_layer", settings});
    const Prediction seen = [at, reflecting](const VectorXd& p) {
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
    };
    list.add("osl_layer_" + base, "oriented stress linearity, " + base + " base", {eta, mu, width},
             starts, seen, known, "hyperbolic");
  }
  return list.models;
}

std::vector<std::string> layer_model_names() {
  std::vector<std::string> out;
  for (const FitModel& model : layer_models(nullptr)) out.push_back(model.name);
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
