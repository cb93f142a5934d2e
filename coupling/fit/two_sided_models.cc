#include "coupling/fit/two_sided_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "continuum/closed/cantelaube_asymmetric.h"
#include "continuum/constants.h"

namespace grainfield::coupling {
namespace {

using continuum::AsymmetricHeap;
using continuum::CoreBranch;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMostFriction = 75;  // deg
constexpr double kLeastWindow = 0.5;  // deg: of yield rays worth a search
constexpr double kLeastCoefficient = 0.02, kMostCoefficient = 5;  // of a flank; active: below 1

// A core that yields on a ray; the search keeps to the rays for which there is one.
RegistryEntry yielding(const std::string& branch, const std::string& label,
                       const AsymmetricHeap& heap, CoreBranch core) {
  RegistryEntry out{
      "cantelaube_asymmetric_" + branch, label, "cantelaube_asymmetric", {{"branch", branch}}, {}};
  const auto window = continuum::yield_rays(heap, core);
  if (!window) {
    out.absent = fmt::format("no core yields so between flanks of {:.1f} and {:.1f} degrees",
                             heap.left / kDegree, heap.right / kDegree);
    return out;
  }
  const double from = window->first / kDegree, to = window->second / kDegree;
  if (to - from < kLeastWindow) {
    const double ray = (from + to) / 2;
    out.label += fmt::format(" ({:.1f} deg, the only one)", ray);
    out.fixed["yield_ray_deg"] = fmt::format("{}", ray);
    return out;
  }
  out.open = {"yield_ray_deg"};
  out.parameters = {
      {"yield_ray_deg", "deg",
       "ray on which the core yields, from the downward vertical, positive to the right", from,
       to}};
  out.starts = {numbers({from + 0.2 * (to - from)}), numbers({(from + to) / 2}),
                numbers({from + 0.8 * (to - from)})};
  return out;
}

}  // namespace

std::vector<RegistryEntry> two_sided_entries(const HeapFacts& facts) {
  const AsymmetricHeap heap{facts.friction() * kDegree, facts.left() * kDegree,
                            facts.right() * kDegree, true, true};
  const double rho_g = facts.rho_g, left = heap.left, right = heap.right;
  const std::string name = "cantelaube_asymmetric";
  std::vector<RegistryEntry> out;
  out.push_back(
      {name + "_zero",
       fmt::format("two slopes, one linear core, friction angle {:.1f} deg", facts.friction()),
       name,
       {},
       {}});
  out.push_back(
      yielding("minus", "two slopes, the core yields on a ray: dip", heap, CoreBranch::minus));
  out.push_back(
      yielding("plus", "two slopes, the core yields on a ray: peak", heap, CoreBranch::plus));
  const double steeper = std::max(facts.left(), facts.right());
  out.push_back(
      {name + "_friction",
       "two slopes, one linear core, friction angle fitted",
       name,
       {},
       {"phi_deg"},
       {{"friction_deg", "deg", "friction angle of the flanks, at least the steeper slope", steeper,
         std::max(kMostFriction, steeper + 5)}},
       {numbers({steeper + 1}), numbers({steeper + 8}), numbers({steeper + 20})}});
  const auto coefficient = [](const std::string& side) {
    return FitParameter{"k_" + side, "-", side + " flank: sigma_xx over the depth below its slope",
                        kLeastCoefficient, kMostCoefficient};
  };
  const double k_left = continuum::flank_coefficient(heap.phi, left, true);
  const double k_right = continuum::flank_coefficient(heap.phi, right, true);
  const auto kinked = [=](double kl, double kr, double ray, double kink, const MatrixXd& points) {
    const auto field = continuum::kinked_field({left, right, kl, kr, ray, kink}, rho_g, heap.phi);
    return field ? MatrixXd(field->stress(points)) : no_stress(points);
  };
  // Flanks that need not yield: descriptions in equilibrium.
  RegistryEntry flanks{name + "_flanks", "two slopes, one linear core, flanks fitted", "", {}, {}};
  flanks.parameters = {coefficient("left"), coefficient("right")};
  flanks.starts = {numbers({k_left, k_right}), numbers({0.8 * k_left, 0.8 * k_right}),
                   numbers({1.3 * k_left, 1.3 * k_right})};
  flanks.description = [=](const MatrixXd& points, const VectorXd& p) {
    return kinked(p[0], p[1], 0, 0, points);
  };
  RegistryEntry kink{name, "two slopes, flanks and a kink in the core fitted", "", {}, {}};
  kink.parameters = {
      coefficient("left"),
      coefficient("right"),
      {"ray_deg", "deg",
       "ray of the core's kink, from the downward vertical, positive to the right", -60, 60},
      {"kink", "-", "slope of the kink (rho g); below 0 a dip",
       -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}};
  kink.starts.clear();
  for (const double ray : {-8.0, 0.0, 8.0}) {
    for (const double size : {-0.2, 0.2}) {
      kink.starts.push_back(numbers({k_left, k_right, ray, size}));
    }
  }
  kink.description = [=](const MatrixXd& points, const VectorXd& p) {
    return kinked(p[0], p[1], p[2] * kDegree, p[3], points);
  };
  out.push_back(std::move(flanks));
  out.push_back(std::move(kink));
  return out;
}

}  // namespace grainfield::coupling
