// The heaps of Mohr-Coulomb material as the registry lists them. A row beside the solver makes each
// of them (plugin.h).
#include "continuum/fe_models.h"
#include "continuum/settings.h"
#include "continuum/size.h"
#include "continuum/without_effect.h"

namespace grainfield::continuum {
namespace {

// The material of heaps in the plane and of cones.
std::vector<Parameter> heap_material(const char* source) {
  return {number("dilation_deg", "deg",
                 "dilation angle, at most phi_deg; equal to it: associated flow", source, 0, 0, 60),
          number("cohesion", "rho_g h",
                 "regularization: cohesionless material at its angle of repose has no strength to "
                 "spare; lower it until the answer stands still",
                 "numerics", 1e-3, 0, kUnbounded),
          number("E", "rho_g h", "Young's modulus; strains, not stresses, go with 1/E",
                 "elasticity", 1000, kAboveZero, kUnbounded),
          number("nu", "-", "Poisson's ratio", "elasticity", 0.3, 0, 0.49)};
}

std::vector<Parameter> heap_numerics(const char* source) {
  return {
      choice("base",
             "rough: no displacement; frictional: Coulomb friction on stiff springs; smooth: no "
             "shear, on which only cohesion holds a heap",
             source, {"rough", "frictional", "smooth"}),
      only_with(number("base_friction_deg", "deg", "friction angle of a frictional base", source,
                       28, 0, 80),
                "base", {"frictional"}),
      only_with(number("base_stiffness", "E/h",
                       "springs of a frictional base, per length; with a map E is its mean over "
                       "the heap",
                       "numerics", 100, kAboveZero, kUnbounded),
                "base", {"frictional"}),
      choice("history",
             "at_once: gravity on the whole heap; rise: horizontal layers; grow: layers along the "
             "slopes, as from a source above",
             source, {"at_once", "rise", "grow"}),
      whole_number("steps", "equal load steps to try for the heap's or a layer's weight",
                   "numerics", 1, 1, 1000),
      number("viscous_step", "-",
             "a step of the load that fails and is not longer than this part is taken in "
             "viscoplastic time, until the material is at rest; 0: never",
             "Duvaut and Lions 1972", 0.25, 0, 1),
      only_with(whole_number("layers", "of the histories rise and grow", "numerics", 8, 1, 1000),
                "history", {"rise", "grow"}),
      whole_number("cells", "triangles along each side; a multiple of 2 layers fits the layers",
                   "numerics", 32, 2, 1000),
      whole_number("refinements",
                   "times that the triangles with the largest estimated errors of stress are cut "
                   "and the heap is laid anew; figure stress_error says what is left",
                   "numerics", 0, 0, 12),
      most_unknowns(),
      number(
          "tolerance", "-",
          "residual over a cell's weight at which Newton's method ends; where it stalls 1e-5 will "
          "do (figure largest_residual)",
          "numerics", 1e-9, 1e-13, 1e-3),
      whole_number("iterations", "most Newton iterations in a load step", "numerics", 25, 1, 1000),
      whole_number("work",
                   "most Newton iterations for the heap's or a layer's weight, failed steps and "
                   "viscoplastic time included: then there is no equilibrium to be found",
                   "numerics", 1000, 1, 1000000)};
}

std::vector<Figure> heap_figures(std::vector<Figure> own) {
  std::vector<Figure> all{
      {"unknowns", "-", "unknowns of the last mesh"},
      {"load_steps", "-", "steps of the load, all layers"},
      {"newton_iterations", "-", "iterations of Newton's method, failed steps included"},
      {"largest_residual", "-", "largest residual of a node at a step's end over a cell's weight"},
      {"viscous_steps", "-", "steps of viscoplastic time, where Newton's method alone failed"},
      {"largest_overstress", "-", "overstress left at rest in viscoplastic time, over rho g h"},
      {"stress_error", "-",
       "estimated error of the stress over the stress, 2-norms over the heap (Zienkiewicz and Zhu "
       "1987)"},
      {"weight_ratio", "-", "vertical force of the ground over the weight"},
      {"core_share", "-",
       "part of the depths from 0.3 to 0.9 h, on all sides, at which the plastic flank has an "
       "inner "
       "border"},
      {"axis_mobilized", "-", "mobilized strength on the axis, mean over the same depths"},
      {"plastic_share", "-", "part that yielded in the last load step"}};
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

FirstMesh first_mesh(const Settings& s) {
  const double along = number_of(s, "cells");
  return {4 * along * along, {"cells"}};
}

ModelInfo wedge() {
  const char* source = "Mohr-Coulomb";
  return {
      "fe_mohr_coulomb_wedge",
      "heap of elastic-plastic Mohr-Coulomb material under its weight, finite elements",
      2,
      joined({{number("phi_deg", "deg", "friction angle", source, 28, 1, 60),
               number("left_deg", "deg", "slope on the left, apex at the origin; 0: as phi_deg",
                      source, 0, 0, 80),
               number("right_deg", "deg", "slope on the right; 0: as left_deg", source, 0, 0, 80),
               number("h", "m", "height; the base is y = -h", source, 1, kAboveZero, kUnbounded),
               number("rho_g", "N/m^2", "weight per area of the section", source, 1, kAboveZero,
                      kUnbounded)},
              heap_material(source),
              {text("map",
                    "file of measured elastic constants in place of E and nu: elastic_map.csv of a "
                    "study "
                    "of elastic constants (columns x,y,young,poisson; SI units, apex at the "
                    "origin), for a "
                    "quarter or more of either half; empty: none",
                    "measured")},
              heap_numerics(source)}),
      in_fe_library("fe_mohr_coulomb_wedge"),
      heap_figures(
          {{"thrust_ratio", "-",
            "horizontal force of the ground over the weight; 0 in equilibrium"},
           {"beta_hat_left_deg", "deg",
            "angle from the vertical of the line from the apex that has half of the left flank's "
            "inner "
            "border on either side"},
           {"beta_hat_right_deg", "deg", "the same on the right"},
           {"beta_hat_left_misfit", "-",
            "median distance of the border from that line over the depth"},
           {"beta_hat_right_misfit", "-", "the same on the right"},
           {"map_share", "-",
            "part of the heap for which the map has constants of its own; elsewhere those of its "
            "nearest node"},
           {"map_young", "-",
            "with a map: its mean Young's modulus over rho g h, the E of base_stiffness"}}),
      [](const std::string& parameter, const Settings& s) {
        const bool constant = parameter == "E" || parameter == "nu";
        return constant && !s.at("map").empty() ? replaced_by("map", s) : std::string();
      },
      first_mesh};
}

ModelInfo cone() {
  const char* source = "Mohr-Coulomb";
  return {
      "fe_cone",
      "cone of elastic-plastic Mohr-Coulomb material under its weight, finite elements",
      3,
      joined({{number("phi_deg", "deg", "friction angle", source, 28, 1, 60),
               number("slope_deg", "deg", "slope, apex at the origin; 0: as phi_deg", source, 0, 0,
                      80),
               number("h", "m", "height; the base is z = -h", source, 1, kAboveZero, kUnbounded),
               number("rho_g", "N/m^3", "weight per volume", source, 1, kAboveZero, kUnbounded)},
              heap_material(source),
              heap_numerics(source)}),
      in_fe_library("fe_cone"),
      heap_figures(
          {{"beta_hat_deg", "deg",
            "angle from the vertical of the line from the apex that has half of the flank's inner "
            "border on either side"},
           {"beta_hat_misfit", "-", "median distance of the border from that line over the depth"},
           {"base_centre", "-", "pressure on the base at its middle over rho g h"},
           {"base_largest", "-", "largest pressure on the base over rho g h"},
           {"dip_ratio", "-", "base_centre over base_largest; 1: no dip"}}),
      {},
      first_mesh};
}

}  // namespace

std::vector<ModelInfo> heap_models() { return {wedge(), cone()}; }

}  // namespace grainfield::continuum
