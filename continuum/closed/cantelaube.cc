#include "continuum/closed/cantelaube.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "continuum/closed/models.h"
#include "continuum/constants.h"
#include "continuum/settings.h"
#include "continuum/without_effect.h"

namespace grainfield::continuum {
namespace {

// Degrees. The coefficients grow like the square of 1/beta_hat.
constexpr double kNarrowest = 1e-6;

CoreBranch branch_of(const std::string& word) {
  if (word == "zero") return CoreBranch::zero;
  return word == "plus" ? CoreBranch::plus : CoreBranch::minus;
}

std::unique_ptr<Model> make(const Settings& s) {
  const double phi = number_of(s, "phi_deg") * kDegree;
  const double most = 90 - number_of(s, "phi_deg");
  double beta_hat = number_of(s, "beta_hat_deg");
  std::vector<std::size_t> yielding_rays;
  if (std::isnan(beta_hat)) {
    if (s.at("branch") != "zero") yielding_rays = {2};
    beta_hat = core_angle(phi, branch_of(s.at("branch")));
  } else if (beta_hat < most) {
    beta_hat *= kDegree;
  } else {
    throw BadParameter(
        fmt::format("model cantelaube: beta_hat_deg = {} is not inside the heap; allowed: at least "
                    "{:g} and below 90 - phi_deg = {:g} deg",
                    s.at("beta_hat_deg"), kNarrowest, most));
  }
  const CoreConstants core = core_constants(phi, beta_hat);
  auto field =
      std::make_unique<SectorField>(cantelaube_field(phi, beta_hat, number_of(s, "rho_g")));
  return std::make_unique<HeapModel>(std::move(field), [=](const HeapField& f) {
    return std::map<std::string, double>{{"beta_hat_deg", beta_hat / kDegree},
                                         {"a1", core.a1},
                                         {"a2", core.a2},
                                         {"b1", core.b1},
                                         {"yield_residual", f.off_yield({0, 3}, yielding_rays)}};
  });
}

}  // namespace

double core_angle(double phi, CoreBranch branch) {
  const double s = std::cos(phi), c = std::sin(phi);  // of beta
  // The minus branch with its difference of nearly equal terms multiplied out.
  const double less = 1 - c, more = 1 + c;
  if (branch == CoreBranch::zero) return std::atan(s / std::sqrt(1 + c * c));
  if (branch == CoreBranch::minus) return std::atan(s / (std::sqrt(1 + less * less) + 1));
  return std::atan(s / (more * more) * (std::sqrt(1 + more * more) + 1));
}

CoreConstants core_constants(double phi, double beta_hat) {
  const double s = std::cos(phi), c = std::sin(phi), t = std::tan(beta_hat);
  const double difference = c / s - 1 / t;
  return {-s * c * difference, 1 + s * s * (t * c / s - 1),
          c / s + (c * c + s * c / t) * difference};
}

SectorField cantelaube_field(double phi, double beta_hat, double rho_g) {
  const double s = std::cos(phi), c = std::sin(phi);
  const CoreConstants k = core_constants(phi, beta_hat);
  // With y up sigma_xy changes sign.
  LinearStress flank, core;
  flank = Eigen::Vector3d(s * s, 1 + c * c, -s * c) * Eigen::RowVector2d(c / s, 1);
  core << 0, 1 - k.a2, k.b1, 1 - k.a1, k.a1, 0;
  flank *= rho_g;
  core *= rho_g;
  const double slope = std::numbers::pi / 2 - phi;
  return {{{"left flank", -slope, -beta_hat},
           {"left core", -beta_hat, 0},
           {"right core", 0, beta_hat},
           {"right flank", beta_hat, slope}},
          {mirrored(flank), mirrored(core), core, flank},
          rho_g,
          phi};
}

ModelInfo cantelaube_info() {
  return {"cantelaube",
          "heap with an elastic core between plastic flanks",
          2,
          {friction_angle(), weight(),
           choice("branch",
                  "minus: the axis yields, a dip; zero: no kink at the axis, a plateau; plus: the "
                  "axis yields, a peak",
                  "Roul, below 4.12", {"minus", "zero", "plus"}),
           may_be_free(optional_number(
                           "beta_hat_deg", "deg",
                           "half tip angle of the core, instead of a branch; below 90 - phi_deg",
                           "Roul 4.10", kNarrowest, 90),
                       1, 89)},
          make,
          heap_figures(
              {{"beta_hat_deg", "deg", "half tip angle of the elastic core, from the vertical"},
               {"a1", "-", "core: sigma_yy under the axis = (a1 - 1) rho g depth (Roul 4.11)"},
               {"a2", "-", "core: sigma_xx = (a2 - 1) rho g depth"},
               {"b1", "-", "core: kink of sigma_yy at the axis; below 0 a dip"},
               yield_figure("flanks and a yielding axis")}),
          [](const std::string& parameter, const Settings& s) -> std::string {
            const bool chosen = !std::isnan(number_of(s, "beta_hat_deg"));
            if (parameter != "branch" || !chosen) return {};
            return replaced_by("beta_hat_deg", s, "its angle");
          }};
}

}  // namespace grainfield::continuum
