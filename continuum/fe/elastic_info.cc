// The elastic finite-element models as the registry lists them. A row beside the solver makes each
// of them (plugin.h).
#include <fmt/format.h>

#include <cmath>

#include "continuum/closed/transverse.h"
#include "continuum/fe_models.h"
#include "continuum/settings.h"
#include "continuum/size.h"
#include "continuum/without_effect.h"

namespace grainfield::continuum {
namespace {

std::vector<Parameter> common_parameters() {
  return {choice("dim", "2: plane strain; 3: space", "elasticity", {"2", "3"}),
          number("F", "N", "load at the origin, down", "Roul 5.6", 1, 0, kUnbounded),
          number("E", "Pa", "Young's modulus (N/m in 2D); the stress does not depend on it",
                 "elasticity", 1e7, kAboveZero, kUnbounded),
          // Beyond this displacement elements lock and the iterations grow.
          number("nu", "-", "Poisson's ratio", "elasticity", 0.3, 0, 0.49),
          text("moduli",
               "instead of E and nu: CSV file of constants by depth, columns depth,E,nu or "
               "depth,E_v,E_h,nu_h,nu_v,G_v, linear between the rows, constant below the last; the "
               "first depth is 0",
               "Holl 1940")};
}

// Why E or nu has no effect beside a table.
std::string moduli_replace(const std::string& parameter, const Settings& s) {
  const bool constant = parameter == "E" || parameter == "nu";
  return constant && !s.at("moduli").empty() ? replaced_by("moduli", s) : std::string();
}

std::vector<Parameter> numerical_parameters(const std::string& tolerances, int refinements) {
  return {
      whole_number(
          "degree",
          "polynomial degree of the elements, cost per unknown grows with it; 0: 3, but 2 for "
          "the layer in 3D",
          "numerics", 0, 0, 4),
      number("tolerance", "-",
             "change of the stress by the last refinement at which refinement ends; " + tolerances,
             "numerics", 0, 0, 1),
      number("refinements", "-", "most cycles of adaptive refinement", "numerics", refinements, 1,
             20),
      most_unknowns(),
      whole_number("iterations", "most iterations of conjugate gradients in a solve", "numerics",
                   500, 1, 100000)};
}

std::vector<Parameter> layer_parameters() {
  return {
      number("h", "m", "depth of the layer", "Roul 5.6", 1, kAboveZero, kUnbounded),
      choice("base", "smooth: no shear; rough: no displacement", "Roul 5.6", {"smooth", "rough"}),
      number("half_width", "h", "half the width of the domain, in depths", "numerics", 8, 1, 1000),
      choice("sides",
             "free: no traction, as far out in an unbounded layer; smooth: rigid walls "
             "without shear, as of a box",
             "elasticity", {"free", "smooth"}),
      whole_number("cells", "cells over the depth before refinement", "numerics", 2, 1, 1000)};
}

Parameter load_depth() {
  return number("load_depth", "h",
                "depth of the load below the surface, over h, from 1e-4 on; the load is spread "
                "over a Gaussian "
                "whose standard deviation is a fifth of this depth, and tolerance is over F/r (3D: "
                "F/r2), r the distance from it, up to h; 0: a point of the surface",
                "elasticity", 0, 0, 0.9);
}

// The first mesh fills the layer with cells of the given degree.
FirstMesh layer_mesh(const Settings& s, bool space) {
  const double down = number_of(s, "cells") * nonzero_or(s, "degree", space ? 2 : 3);
  const double across = 2 * number_of(s, "half_width") * down;
  return {space ? 3 * down * across * across : 2 * down * across,
          {"cells", "half_width", "degree"}};
}

std::vector<Parameter> half_space_parameters() {
  return {number("depth", "m", "depth of interest, to which the mesh is fitted", "numerics", 0.15,
                 kAboveZero, kUnbounded),
          number("patch", "depth",
                 "width of the loaded strip or square, in depths, from 1e-4 on; what is felt of it "
                 "falls like its square; 0: 0.05 in 2D, 0.02 in 3D",
                 "numerics", 0, 0, 1),
          number("radius", "depth",
                 "least distance of the mesh's end from the load, in depths; what is felt "
                 "of the end falls like 1/radius (3D: its square); 0: 10000 in 2D, 50 in 3D",
                 "numerics", 0, 0, 1e9),
          number("cells", "-",
                 "cells per distance from the load before refinement; 0: 2 in 2D, 1 in 3D",
                 "numerics", 0, 0, 100)};
}

// Rings around the load, each twice as wide as the one before.
FirstMesh half_space_mesh(const Settings& s, bool space) {
  const double rings = 1 + std::log2(nonzero_or(s, "radius", space ? 50 : 10000) /
                                     nonzero_or(s, "patch", space ? 0.02 : 0.05));
  const double along = nonzero_or(s, "cells", space ? 1 : 2) * nonzero_or(s, "degree", 3);
  return {rings * (space ? 12 * along * along * along : 8 * along * along), {"cells", "degree"}};
}

bool in_space(const Settings& s) { return s.at("dim") == "3"; }

std::vector<Parameter> point_load() {
  return {number("F", "N", "load at the origin, down", "elasticity", 1, 0, kUnbounded)};
}

// Figures of the elastic solver, also with adaptive refinement.
std::vector<Figure> solver_figures(std::vector<Figure> own, bool refined = true) {
  std::vector<Figure> all{
      {"unknowns", "-", "unknowns of the last mesh"},
      {"cells", "-", "cells of the last mesh"},
      {"solves", "-", "linear solves, all meshes and iterations"},
      {"cg_iterations", "-", "iterations of conjugate gradients in the last solve"},
      {"residual", "-", "largest residual of the linear equations over the load's"},
      {"assemble_s", "s", "wall time of assembling, all solves"},
      {"solve_s", "s", "wall time of solving"}};
  if (refined) {
    all.push_back({"refinement_cycles", "-", "cycles of adaptive refinement"});
    all.push_back({"change", "-",
                   "largest change of the stress by the last of them, over the model's scale of "
                   "stress (parameter tolerance)"});
  }
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

std::vector<Figure> half_space_figures() {
  return solver_figures({{"truncation_radius", "m", "half width and depth of the mesh"},
                         {"patch_width", "m", "width of the loaded strip or square"}});
}

ModelInfo elastic_layer() {
  return {"fe_elastic_layer",
          "elastic layer on a rigid base under a point load, finite elements",
          0,
          joined({common_parameters(),
                  layer_parameters(),
                  {load_depth()},
                  numerical_parameters("over F/h (3D: F/h2); 0: 2e-4 in 2D, 5e-3 in 3D", 8)}),
          in_fe_library("fe_elastic_layer"),
          solver_figures({}),
          moduli_replace,
          [](const Settings& s) { return layer_mesh(s, in_space(s)); }};
}

ModelInfo orthotropic_layer() {
  const char* source = "Otto et al. 2003";
  return {
      "fe_orthotropic_layer",
      "layer with vertical and horizontal elastic axes on a rigid base under a line load, finite "
      "elements",
      2,
      joined(
          {{number("F", "N", "load at the origin, down", "Roul 5.2", 1, 0, kUnbounded),
            number("r", "-", "(E_x/G - 2 nu_xy)/2, above -sqrt(t); isotropic: 1", source, 1,
                   -kUnbounded, kUnbounded),
            number("t", "-", "E_x/E_y; isotropic: 1", source, 1, kAboveZero, kUnbounded),
            optional_number("E_x", "Pa", "with E_y, G and nu_xy instead of r and t", source,
                            kAboveZero, kUnbounded),
            optional_number("E_y", "Pa", "vertical modulus", source, kAboveZero, kUnbounded),
            optional_number("G", "Pa", "shear modulus", source, kAboveZero, kUnbounded),
            optional_number(
                "nu_xy", "-",
                "-eps_yy/eps_xx under sigma_xx; between max(-r, -sqrt(t)) and sqrt(t). "
                "Needed with moduli, with base = rough and with sides = smooth; free sides on a "
                "smooth base do not feel it",
                source, -kUnbounded, kUnbounded),
            text("map",
                 "instead of constants: CSV file of a regular grid, columns x,y and young,poisson "
                 "(elastic_map.csv) or E_x,E_y,nu_xy,G, for a quarter or more of either half of "
                 "the layer; beyond the grid as on its border",
                 "elastic constants")},
           layer_parameters(),
           numerical_parameters("over F/h; 0: 2e-4", 8)}),
      in_fe_library("fe_orthotropic_layer"),
      solver_figures(
          {{"r", "-", "(E_x/G - 2 nu_xy)/2; of a map: at the load"},
           {"t", "-", "E_x/E_y; of a map: at the load"},
           {"nu_xy", "-", "-eps_yy/eps_xx under sigma_xx, where it is set or a map gives it"},
           {"map_share", "-",
            "part of the layer for which the map has constants of its own; elsewhere those of its "
            "nearest node"}}),
      [](const std::string& parameter, const Settings& s) {
        const bool constant = parameter == "r" || parameter == "t" || parameter == "E_x" ||
                              parameter == "E_y" || parameter == "G" || parameter == "nu_xy";
        return constant && !s.at("map").empty() ? replaced_by("map", s)
                                                : ratios_beside_moduli(parameter, s);
      },
      [](const Settings& s) { return layer_mesh(s, false); }};
}

ModelInfo elastic_half_space() {
  return {
      "fe_elastic_half_space",
      "elastic half plane or half space under a small loaded patch, finite elements",
      0,
      joined(
          {common_parameters(), half_space_parameters(),
           numerical_parameters(
               "over F/r (3D: F/r2), r the distance from the load; 0: 2e-3 in 2D, 1e-2 in 3D", 4)}),
      in_fe_library("fe_elastic_half_space"),
      half_space_figures(),
      moduli_replace,
      [](const Settings& s) { return half_space_mesh(s, in_space(s)); }};
}

ModelInfo transverse_layer() {
  return {
      "fe_transverse_layer",
      "elastic layer with a vertical axis of symmetry on a rigid base under a point load, finite "
      "elements",
      3,
      joined({point_load(),
              transverse_parameters(),
              layer_parameters(),
              {load_depth()},
              numerical_parameters("over F/h2; 0: 5e-3", 6)}),
      in_fe_library("fe_transverse_layer"),
      solver_figures({}),
      {},
      [](const Settings& s) { return layer_mesh(s, true); }};
}

ModelInfo transverse_half_space() {
  return {"fe_transverse_half_space",
          "elastic half space with a vertical axis of symmetry under a small loaded patch, finite "
          "elements",
          3,
          joined({point_load(), transverse_parameters(), half_space_parameters(),
                  numerical_parameters("over F/r2, r the distance from the load; 0: 1e-2", 4)}),
          in_fe_library("fe_transverse_half_space"),
          half_space_figures(),
          {},
          [](const Settings& s) { return half_space_mesh(s, true); }};
}

std::string core_without_effect(const std::string& parameter, const Settings& s) {
  const std::string &axis = s.at("axis"), &branch = s.at("branch");
  if (parameter == "axis_iterations" &&
      (axis == "continuous" || (axis == "branch" && branch == "zero")))
    return fmt::format(
        "with axis = {}, branch = {}: the axis does not yield; leave it out, or set axis = yields "
        "or branch = minus or plus",
        axis, branch);
  // A yielding axis takes from the branch which stress is the largest.
  if (parameter == "branch" && !std::isnan(number_of(s, "beta_hat_deg")) && axis == "continuous")
    return replaced_by("beta_hat_deg", s, "its angle") + ", or set axis = yields";
  return {};
}

ModelInfo cantelaube_core() {
  const char* source = "Roul 4.3";
  return {
      "fe_cantelaube_core",
      "heap with an elastic core solved under its plastic flanks, finite elements",
      2,
      {number("phi_deg", "deg", "friction angle and slope", source, 28, 5, 60),
       number("rho_g", "N/m^2", "weight per area of the section", source, 1, kAboveZero,
              kUnbounded),
       number("h", "m", "height; the base is y = -h", source, 1, kAboveZero, kUnbounded),
       choice("branch",
              "half tip angle of the core: that of the closed form's branch, see cantelaube; plus "
              "also chooses sigma_yy as the largest compression of a yielding axis, and only that "
              "beside beta_hat_deg",
              source, {"zero", "minus", "plus"}),
       optional_number("beta_hat_deg", "deg",
                       "half tip angle of the core instead of a branch's; below 90 - phi_deg",
                       source, kAboveZero, 90),
       choice("axis",
              "branch: the condition of the branch; continuous: no displacement across; yields: "
              "sigma_xx in the ratio of the friction angle to sigma_yy, with base = closed only",
              source, {"branch", "continuous", "yields"}),
       choice("base",
              "closed: the displacement of the closed form; rough: rigid, no displacement; smooth: "
              "rigid, no shear; elastic: springs in both directions",
              "elasticity", {"closed", "rough", "smooth", "elastic"}),
       only_with(number("base_stiffness", "E/h", "springs of an elastic base, per area",
                        "elasticity", 1, kAboveZero, kUnbounded),
                 "base", {"elastic"}),
       number("nu", "-", "Poisson's ratio of the core", "elasticity", 0.3, 0, 0.49),
       whole_number("degree", "polynomial degree of the elements", "numerics", 2, 1, 4),
       whole_number("refinement", "halvings of the three cells of the half core", "numerics", 4, 0,
                    10),
       whole_number("adaptive", "further cycles of adaptive refinement", "numerics", 0, 0, 20),
       most_unknowns(),
       whole_number("iterations", "most iterations of conjugate gradients in a solve", "numerics",
                    2000, 1, 100000),
       whole_number("axis_iterations", "most solves for a yielding axis on a mesh", "numerics", 100,
                    1, 10000)},
      in_fe_library("fe_cantelaube_core"),
      solver_figures(
          {{"beta_hat_deg", "deg", "half tip angle of the elastic core, from the vertical"},
           {"axis_iterations", "-",
            "solves on the last mesh until a yielding axis meets its condition"},
           {"axis_misfit", "-",
            "largest misfit of sigma_xx = K sigma_yy on a yielding axis over rho g h"},
           {"axis_ratio", "-", "sigma_xx/sigma_yy on the axis at half depth"},
           {"flank_jump", "-",
            "largest jump of the normal stress along the core's border, between 5 and 95 % of the "
            "depth, over rho g h: 0 is the closed form's core"},
           {"closed_form_error", "-",
            "largest difference of a stress component from the closed form with this beta_hat, "
            "samples on border, base and axis, over rho g h"},
           {"mobilised_sine_ratio", "-",
            "largest sin(mobilised friction angle)/sin(phi), of samples on the core's border, base "
            "and axis below 5 % of the height"},
           {"base_centre", "-", "pressure on the base at x = 0 over rho g h"},
           {"base_largest", "-", "largest pressure on the core's base over rho g h"},
           {"dip_ratio", "-", "base_centre over base_largest"}},
          false),
      core_without_effect,
      [](const Settings& s) -> FirstMesh {
        const double across = std::exp2(number_of(s, "refinement")) * number_of(s, "degree");
        return {2 * 3 * across * across, {"refinement", "degree"}};
      }};
}

}  // namespace

std::vector<ModelInfo> elastic_models() {
  return {elastic_layer(),    orthotropic_layer(),     elastic_half_space(),
          transverse_layer(), transverse_half_space(), cantelaube_core()};
}

}  // namespace grainfield::continuum
