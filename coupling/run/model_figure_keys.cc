// The figures that a model gives of its evaluation, model.LABEL.FIGURE in summary.json.
#include "coupling/run/summary_keys.h"

namespace grainfield::coupling {

std::vector<SummaryKey> model_figure_keys() {
  return {
      {"model.*.name", "text", "registry name of a compared model"},
      // Of solvers.
      {"model.*.unknowns", "-", "unknowns of the last mesh"},
      {"model.*.cells", "-", "cells of the last mesh"},
      {"model.*.solves", "-", "linear solves, all meshes and iterations"},
      {"model.*.cg_iterations", "-", "iterations of conjugate gradients in the last solve"},
      {"model.*.residual", "-", "largest residual of the linear equations over the load's"},
      {"model.*.assemble_s", "s", "wall time of assembling, all solves"},
      {"model.*.solve_s", "s", "wall time of solving"},
      {"model.*.refinement_cycles", "-", "cycles of adaptive refinement"},
      {"model.*.change", "-",
       "largest change of the stress by the last of them, over the model's scale of stress "
       "(parameter tolerance)"},
      {"model.*.truncation_radius", "m", "half width and depth of the mesh of a half space"},
      {"model.*.patch_width", "m", "width of the loaded strip or square of a half space"},
      // Of elastic layers and half planes.
      {"model.*.r", "-", "(E_x/G - 2 nu_xy)/2; of a map: at the load"},
      {"model.*.t", "-", "E_x/E_y; of a map: at the load"},
      {"model.*.nu_xy", "-",
       "-eps_yy/eps_xx under sigma_xx, where it is set or a map gives it (at the load)"},
      {"model.*.map_share", "-",
       "part of the layer or heap for which the map has constants of its own; elsewhere those of "
       "its nearest node"},
      {"model.*.peaks", "-", "peaks of a half plane's pressure at any depth"},
      {"model.*.peak_at_over_depth", "-", "their distance from the axis over the depth"},
      // Of Cantelaube's core and other closed wedges.
      {"model.*.beta_hat_deg", "deg", "half tip angle of the elastic core, from the vertical"},
      {"model.*.a1", "-", "core: sigma_yy under the axis = (a1 - 1) rho g depth (Roul 4.6)"},
      {"model.*.a2", "-", "core: sigma_xx = (a2 - 1) rho g depth"},
      {"model.*.b1", "-", "core: kink of sigma_yy at the axis; below 0 a dip"},
      {"model.*.core_left_deg", "deg", "ray between core and left flank, from the vertical"},
      {"model.*.core_right_deg", "deg", "ray between core and right flank, from the vertical"},
      {"model.*.ray_*_deg", "deg",
       "ray between two regions of a closed wedge, counted from the left, from the vertical"},
      {"model.*.mobilised_sine_ratio", "-",
       "largest sin(mobilised friction angle)/sin(phi): above 1 the limit of friction is exceeded "
       "somewhere, inf: the heap pulls somewhere. Closed wedges: all over the heap; "
       "fe_cantelaube_core: of samples on the core's "
       "border, base and axis below 5 % of the height"},
      {"model.*.equilibrium_residual", "-",
       "closed wedges and hydrostatic: largest |div sigma - (0, rho g)| over rho g, of samples "
       "inside "
       "the heap; of hydrostatic the tangent of its steeper slope"},
      {"model.*.closure_residual", "-",
       "osl, fpa, bcc: largest |sigma_xx - eta sigma_yy - mu sign(x) sigma_xy| (compression "
       "positive, "
       "y down) over rho g h"},
      {"model.*.yield_residual", "-",
       "largest |sin(mobilised friction angle)/sin(phi) - 1| where the field is to yield: flanks "
       "and "
       "a yielding axis or inner ray of cantelaube and cantelaube_asymmetric, ife everywhere"},
      {"model.*.axis_iterations", "-",
       "fe_cantelaube_core: solves on the last mesh until a yielding axis meets its condition"},
      {"model.*.axis_misfit", "-",
       "fe_cantelaube_core: largest misfit of sigma_xx = K sigma_yy on a yielding axis over rho g "
       "h"},
      {"model.*.axis_ratio", "-",
       "fe_cantelaube_core: sigma_xx/sigma_yy on the axis at half depth"},
      {"model.*.flank_jump", "-",
       "fe_cantelaube_core: largest jump of the normal stress along the core's border, between 5 "
       "and 95 % of the depth, over rho g h: 0 is the closed form's core"},
      {"model.*.closed_form_error", "-",
       "fe_cantelaube_core: largest difference of a stress component from the closed form with "
       "this beta_hat, samples on border, base and axis, over rho g h"},
      {"model.*.base_centre", "-",
       "fe_cantelaube_core: pressure on the base at x = 0 over rho g h"},
      {"model.*.base_largest", "-",
       "fe_cantelaube_core: largest pressure on the core's base over rho g h"},
      {"model.*.dip_ratio", "-", "fe_cantelaube_core: base_centre over base_largest"},
      // Of oriented stress linearity.
      {"model.*.eta", "-", "OSL: sigma_xx/sigma_yy without shear"},
      {"model.*.mu", "-", "OSL: sigma_xx per shear; below 0 a dip"},
      {"model.*.eta_at_yield", "-", "OSL: the eta with which the slope yields, with this mu"},
      {"model.*.K", "-", "OSL: ratio of the normal stresses on the fixed axes (Roul 4.23)"},
      {"model.*.tau_deg", "deg", "OSL: angle of the fixed axes (Roul 4.23)"},
      {"model.*.c1", "-", "OSL: dx/d(depth) of the characteristic to the right"},
      {"model.*.c2", "-", "OSL: dx/d(depth) of the characteristic to the left"},
      {"model.*.half_width", "m", "OSL: half the width of the solved body at its base"},
      {"model.*.steps", "-", "OSL by marching: steps in depth"},
      {"model.*.base_force", "N", "OSL: vertical force on the base"},
      {"model.*.side_force", "N", "OSL: vertical force on the sides"},
      {"model.*.weight", "N", "OSL: weight of the body"},
      {"model.*.load", "N", "OSL: vertical load on the surface"},
      {"model.*.force_balance", "-",
       "OSL: what base_force + side_force differ from weight + load by, over the largest of them"},
      // Of the elastic-plastic heap.
      {"model.*.load_steps", "-", "plastic heap: steps of the load, all layers"},
      {"model.*.newton_iterations", "-",
       "plastic heap: iterations of Newton's method, failed steps included"},
      {"model.*.largest_residual", "-",
       "plastic heap: largest residual of a node at a step's end over a cell's weight"},
      {"model.*.viscous_steps", "-",
       "plastic heap: steps of viscoplastic time, where Newton's method alone failed"},
      {"model.*.largest_overstress", "-",
       "plastic heap: overstress left at rest in viscoplastic time, over rho g h"},
      {"model.*.stress_error", "-",
       "plastic heap: estimated error of the stress over the stress, 2-norms over the heap "
       "(Zienkiewicz and Zhu 1987)"},
      {"model.*.weight_ratio", "-", "plastic heap: vertical force of the ground over the weight"},
      {"model.*.thrust_ratio", "-",
       "plastic heap: horizontal force of the ground over the weight; 0 in equilibrium"},
      {"model.*.core_share", "-",
       "plastic heap: part of the depths from 0.3 to 0.9 h, both sides, at which the plastic flank "
       "has an inner border"},
      {"model.*.axis_mobilized", "-",
       "plastic heap: mobilized strength on the axis, mean over the same depths"},
      {"model.*.plastic_share", "-", "plastic heap: part that yielded in the last load step"},
      {"model.*.beta_hat_left_deg", "deg",
       "plastic heap: angle from the vertical of the line from the apex that has half of the left "
       "flank's inner border on either side"},
      {"model.*.beta_hat_right_deg", "deg", "the same on the right"},
      {"model.*.beta_hat_left_misfit", "-",
       "plastic heap: median distance of the border from that line over the depth"},
      {"model.*.beta_hat_right_misfit", "-", "the same on the right"},
      {"model.*.map_young", "-",
       "plastic heap with a map: its mean Young's modulus over rho g h, the E of base_stiffness"},
  };
}

}  // namespace grainfield::coupling
