// What wedge and cone have in common as models of the registry.
#include <algorithm>

#include "continuum/fe/wedge.h"
#include "continuum/settings.h"

namespace grainfield::continuum {

WedgeProblem heap_problem(const Settings& s, bool cone) {
  const auto whole = [&s](const char* name) { return static_cast<int>(number_of(s, name)); };
  WedgeProblem p;
  p.cone = cone;
  p.friction_deg = number_of(s, "phi_deg");
  p.left_deg = number_of(s, cone ? "slope_deg" : "left_deg");
  p.right_deg = cone ? 0 : number_of(s, "right_deg");
  if (p.left_deg == 0) p.left_deg = p.friction_deg;
  if (p.right_deg == 0) p.right_deg = p.left_deg;
  p.height = number_of(s, "h");
  p.rho_g = number_of(s, "rho_g");
  p.young = number_of(s, "E");
  p.poisson = number_of(s, "nu");
  p.dilation_deg = number_of(s, "dilation_deg");
  p.cohesion = number_of(s, "cohesion");
  const std::string& base = s.at("base");
  p.base = base == "rough"    ? WedgeBase::rough
           : base == "smooth" ? WedgeBase::smooth
                              : WedgeBase::frictional;
  p.base_friction_deg = number_of(s, "base_friction_deg");
  p.base_stiffness = number_of(s, "base_stiffness");
  const std::string& history = s.at("history");
  p.history = history == "at_once" ? WedgeHistory::at_once
              : history == "rise"  ? WedgeHistory::rise
                                   : WedgeHistory::grow;
  p.steps = whole("steps");
  p.layers = whole("layers");
  p.cells = whole("cells");
  p.iterations = whole("iterations");
  p.refinements = whole("refinements");
  p.most_unknowns = number_of(s, "most_unknowns");
  p.viscous_step = number_of(s, "viscous_step");
  p.work = whole("work");
  p.tolerance = number_of(s, "tolerance");
  check_wedge(p);
  return p;
}

std::map<std::string, double> heap_figures(const WedgeResult& result, const WedgeCore& core) {
  double iterations = 0, plastic = 0, residual = 0, viscous = 0, overstress = 0;
  for (const auto& step : result.steps) {
    iterations += step.iterations;
    residual = std::max(residual, step.history.back());
    viscous += step.viscous_steps;
    overstress = std::max(overstress, step.overstress);
  }
  for (const auto& p : result.points) plastic += (p.regime != plasticity::Regime::elastic) * p.area;
  return {{"unknowns", result.unknowns},
          {"load_steps", static_cast<double>(result.steps.size())},
          {"newton_iterations", iterations},
          {"largest_residual", residual},
          {"viscous_steps", viscous},
          {"largest_overstress", overstress},
          {"stress_error", result.relative_error},
          {"weight_ratio", result.base_force[1] / result.weight},
          {"core_share", core.share},
          {"axis_mobilized", core.axis_mobilized},
          {"plastic_share", plastic * result.problem.rho_g / result.weight}};
}

CellMeans cell_means(const WedgeResult& r, int triangle) {
  CellMeans out;
  for (std::size_t q = 0; q < 3; ++q) {
    const auto& p = r.points[3 * static_cast<std::size_t>(triangle) + q];
    out.plastic += (p.regime != plasticity::Regime::elastic) / 3.;
    out.shear += p.plastic_shear / 3;
    out.volume += p.plastic_strain.head<3>().sum() / 3;
  }
  return out;
}

}  // namespace grainfield::continuum
