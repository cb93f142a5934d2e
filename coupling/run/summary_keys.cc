#include "coupling/run/summary_keys.h"

#include <fmt/format.h>

#include <boost/algorithm/string/replace.hpp>
#include <stdexcept>

namespace grainfield::coupling {
namespace {

// '*' matches any text that is not empty.
bool matches(const char* pattern, const char* text) {
  if (*pattern == '\0') return *text == '\0';
  if (*pattern == '*') {
    for (const char* t = text; *t != '\0'; ++t) {
      if (matches(pattern + 1, t + 1)) return true;
    }
    return false;
  }
  return *pattern == *text && matches(pattern + 1, text + 1);
}

}  // namespace

const std::vector<SummaryKey>& summary_keys() {
  static const std::vector<SummaryKey> before_models = {
      {"case.name", "text", "name of the case file"},
      {"case.command", "text", "what was run, without folder and threads (they change no number)"},
      {"case.study", "text", "kind of study"},
      {"case.hash", "text", "FNV-1a hash of the written-out case (case.toml)"},
      {"version", "text",
       "of grainfield, with the commit it was built from (+: files were changed)"},
      {"ensemble.realizations", "-", "independent packings"},
      {"ensemble.seed", "-", "seed from which the realizations' seeds are derived"},
      {"dem.grains", "-", "moving grains"},
      {"dem.contacts", "-",
       "contacts that transmit force, in the last state (piles: before any change)"},
      {"dem.sliding_contacts", "-", "of these, at the Coulomb limit"},
      {"dem.steps", "-", "time steps"},
      {"dem.time_step", "s", "time step"},
      {"dem.unbalanced_force_ratio", "-", "mean resultant over mean contact force at the end"},
      {"dem.unbalanced_moment_ratio", "-",
       "mean |moment| on a grain over its radius, over mean contact force, at the end"},
      {"dem.unbalanced_force_max_ratio", "-",
       "largest resultant over mean contact force at the end"},
      {"dem.kinetic_to_elastic_energy", "-", "kinetic over elastic energy at the end"},
      {"dem.max_overlap_ratio", "-", "largest overlap over the smaller radius"},
      {"dem.layer_height", "m", "height of the layer from its columns' highest grains"},
      {"dem.layer_width", "m", "distance of the side walls"},
      {"dem.volume_fraction", "-",
       "layer: area of the grains over width times height; pile: as heap.volume_fraction"},
      {"base.weight_ratio", "-",
       "vertical force on the base over the weight, before any load or change"},
      {"base.response_over_load", "-", "vertical base force, loaded - unloaded, over the load"},
      {"dem.repose_angle_left_deg", "deg", "slope of the pile's left flank (robust line)"},
      {"dem.repose_angle_right_deg", "deg", "slope of the right flank"},
      {"repose.mean_deg", "deg", "mean of both flanks"},
      {"repose.left_minus_right_deg", "deg", "how much steeper the left flank is"},
      {"liffman.rows", "-", "rows of a lattice pile"},
      {"liffman.base_grains", "-", "disks in its lowest row"},
      {"liffman.grain_weight", "N", "m g of a disk"},
      {"liffman.softness", "-", "m g/(K d), linear law; m g/(E d), overlap-area law (Liffman 46)"},
      {"liffman.row_contacts", "-", "contacts between neighbours of a row that carry force"},
      {"liffman.normal_max_error", "-",
       "largest difference of a base disk's N from the closed form of hard close-packed disks "
       "(Liffman 42 at 60 degrees) over the largest N"},
      {"liffman.horizontal_max_error", "-", "the same of H (Liffman 44 at 60 degrees)"},
      {"liffman.line_normal_max_difference", "-",
       "largest difference of N from the line model (Liffman 52-59) over its largest N"},
      {"liffman.line_horizontal_max_difference", "-", "the same of H"},
      {"liffman.normal_largest", "N", "largest N of the base disks"},
      {"liffman.horizontal_largest", "N", "largest H of the base disks"},
      {"pair.restitution_normal", "-",
       "velocity at the contact along the first normal, after over before, with the sign turned"},
      {"pair.restitution_tangential", "-", "the same across the normal, along the slip before"},
      {"pair.duration", "s", "from the first touch until the normal force is 0"},
      {"pair.max_depth", "m", "largest overlap along the normal; random loops: of the first"},
      {"pair.max_force", "N", "largest normal force"},
      {"pair.energy_lost", "-", "share of the kinetic energy before that is not there after"},
      {"pair.parted", "-", "1: the bodies came apart; 0: not within 2000 half periods"},
      {"pair.closed_form.restitution_normal", "-",
       "closed form of a force that never pulls (linear; hertz, critical; energy, square)"},
      {"pair.closed_form.restitution_tangential", "-",
       "linear law without dashpots: slip throughout where the spring of friction is always at its "
       "limit, else as without slip, which is the limit of small angles (Walton 1993)"},
      {"pair.closed_form.duration", "s", "where the law has one: linear, and without dashpot"},
      {"pair.closed_form.max_depth", "m", "where the law has one"},
      {"pair.closed_form.max_force", "N", "where the law has one, without dashpot"},
      {"pair.work", "J", "work on the first body along the path; random: along the first loop"},
      {"pair.stored_most", "J", "largest energy stored on the path; random: on the first loop"},
      {"pair.loops", "-", "closed paths that were passed"},
      {"pair.loop_work_over_energy", "-",
       "|work| round a closed path over the largest energy stored on it; random: the largest"},
      {"pair.loop_work_over_energy_mean", "-", "its mean over the loops"},
      {"pair.loops_crossing", "-", "loops on which the outlines cross at more than two places"},
      {"pair.loops_unsettled", "-",
       "loops whose work finer steps still changed by more than 2e-6 of that energy"},
      {"pair.stable_time_step", "s", "limit of the time step of these two bodies"},
      {"pair.*.restitution_normal", "-",
       "of a further impact: pair.speed_V or pair.angle_A; with closed_form. its closed form"},
      {"pair.*.restitution_tangential", "-", "likewise"},
      {"pair.*.duration", "s", "likewise"},
      {"pair.*.max_depth", "m", "likewise"},
      {"pair.*.max_force", "N", "likewise"},
      {"pair.*.energy_lost", "-", "likewise"},
      {"pair.*.parted", "-", "likewise"},
      {"pile.repose_error_left_deg", "deg", "standard error of one flank's line, from its scatter"},
      {"pile.repose_error_right_deg", "deg", "the same, right"},
      {"pile.height", "m", "h of a pile: its highest point above the floor"},
      {"pile.apex_x", "m", "where the flanks' lines meet, packing's axes"},
      {"pile.half_base_left", "m", "from the apex to the left flank's foot"},
      {"pile.half_base_right", "m", "from the apex to the right flank's foot"},
      {"pile.mean_diameter", "m", "of the grains' bounding circles"},
      {"pile.pour_time", "s", "simulated time of pouring"},
      {"pile.awake_mean", "-", "grains awake, mean over the pouring"},
      {"pile.grains_not_poured", "-", "line source: left over when the pile came to a point"},
      {"source.kind", "text", "point | line"},
      {"source.interval", "s", "point source: from one grain to the next"},
      {"sleep.wake_reach", "-", "as in the case, when grains sleep while the pile is poured"},
      {"dem.grain_steps", "-", "grains times steps, all realizations"},
      {"pile.volume_fraction_centre", "-", "in a window about the apex (dem/heap)"},
      {"pile.volume_fraction_surface", "-", "in windows along the flanks"},
      {"heap.volume_fraction", "-",
       "mean of the inside: that of rho; piles too small for it: of all below the surface"},
      {"heap.rho_g_h", "N/m",
       "unit of pressure: grain density times heap.volume_fraction times g times height"},
      {"heap.coordination", "-", "contacts of a grain"},
      {"density.ratio", "-", "volume fraction about the apex over that along the flanks"},
      {"density.p_value", "-",
       "one-sided probability of a ratio this high if it were 1 (Student's t over realizations)"},
      {"base.centre_pressure", "rho g h", "ensemble mean under the apex, smeared"},
      {"base.largest_pressure", "rho g h", "largest of the ensemble mean"},
      {"base.largest_at", "h", "its distance from the apex"},
      {"base.smearing_width", "m", "width of the kernel that smears base forces"},
      {"dip.ratio", "-", "centre pressure over largest pressure at the base, ensemble mean"},
      {"dip.centre", "rho g h", "mean base pressure for |x| below heap.centre half bases"},
      {"dip.shoulder", "rho g h",
       "mean base pressure from heap.shoulder_from to heap.shoulder_to, both sides"},
      {"dip.window_ratio", "-", "dip.centre over dip.shoulder"},
      {"dip.difference", "rho g h", "shoulder - centre, mean over realizations: above 0 is a dip"},
      {"dip.standard_error", "rho g h", "its standard error over realizations"},
      {"dip.p_value", "-",
       "one-sided probability of a difference this high if it were 0 (Student's t); nan below 3 "
       "realizations"},
      {"dip.verdict", "text", "dip | peak | neither | undecided (at 5 %)"},
      {"change.*.coordination", "-", "contacts of a grain under the changed gravity"},
      {"change.*.coordination_ratio", "-", "the same over that of the pile"},
      {"change.*.dip_difference_change", "rho g h",
       "change of shoulder - centre, in units of the changed rho g h"},
      {"change.*.contacts_gained", "-", "contacts that the change of gravity closed"},
      {"change.*.contacts_lost", "-", "contacts that it opened"},
      {"change.*.unbalanced_force_ratio", "-", "mean resultant over mean contact force there"},
      {"change.*.load_steps", "-", "load steps of Newton's method on the way there"},
      {"change.*.iterations", "-", "its iterations in all of them"},
      {"change.*.newly_sliding", "-", "contacts that it brought to the Coulomb limit"},
      {"change.*.max_displacement_over_radius", "-",
       "largest displacement from the pile, over the grain's radius"},
      {"change.*.coordination_bearing", "-", "contacts of a grain without rattlers"},
      {"change.*.coordination_bearing_ratio", "-", "the same over that of the pile"},
      {"change.*.rattlers", "-", "share of the grains that bear nothing"},
      {"heap.coordination_bearing", "-", "contacts of a grain without rattlers"},
      {"heap.rattlers", "-", "share of the grains that bear nothing"},
      {"fields.rve_radius", "m", "radius of the RVE"},
      {"fields.points_inside", "-", "points of the map whose RVE is inside the heap"},
      {"fields.change", "text", "state that strains and constants are taken from"},
      {"rve_size.grains", "-", "grains an RVE needs: the most that a quantity asks for"},
      {"rve_size.limited_by", "text", "that quantity"},
      {"rve_size.*_grains", "-",
       "grains from which on larger RVEs differ by less than half the tolerance in the mean and "
       "scatter by less than it between piles; nan: none that fits"},
      {"rve_size.*_scatter", "-",
       "robust relative scatter between piles of a single RVE of the size used for the fields"},
      {"strain.*.difference", "-",
       "relative difference of the strain tensor from Cambou's over the points inside; median"},
      {"strain.*.difference_yy", "-", "the same of the yy component"},
      {"strain.*.difference_yy_low", "-",
       "the same of the mean over piles along the lowest row of elements"},
      {"strain.*.ratio", "-", "projection of the strain onto Cambou's: 1 is equal size; median"},
      {"strain.*.misfit", "-", "share of the displacements that the gradient leaves; median"},
      {"strain.dip_ratio", "-",
       "Cambou's vertical strain within 0.1 half bases of the apex over that from 0.15 to 0.4, "
       "along "
       "the lowest row; median over piles"},
      {"fit.values", "-", "stress values that are fitted, all components and heights"},
      {"fit.slope_deg", "deg", "mean slope of the piles: the models' slope and friction angle"},
      {"fit.left_deg", "deg", "slope of the left flank, for models that take the flanks apart"},
      {"fit.right_deg", "deg", "the same on the right"},
      {"fit.friction_deg", "deg", "friction angle of these models"},
      {"fit.weights", "text", "values, covariance and what is missing for a better one"},
      {"fit.warnings", "text",
       "what makes the constants doubtful: unbalanced heaps, heights below the averaging width"},
      {"fit.covariance", "text", "kind of covariance that weights the values"},
      {"fit.correlation_length", "h", "length of the values' correlation (Matern 3/2)"},
      {"fit.effective_values", "-", "independent values among them"},
      {"fit.*.error", "-", "error of the parameter from the covariance, in its unit"},
      {"fit.*.bootstrap_error", "-", "the same from draws of the piles"},
      {"fit.*.chi2_per_dof", "-", "whitened squared residual over values less parameters"},
      {"fit.*.chi2_chance", "-", "chi2/dof that a true model exceeds in 1.35 of 1000"},
      {"fit.*.rel_l2", "-", "|grains - model| / |grains|"},
      {"fit.*.note", "text", "what the reader must know of the fit: bounds, no convergence"},
      {"fit.*.aicc_difference", "-", "corrected Akaike criterion, from the best model"},
      {"fit.*.cv_behind", "-",
       "cross-validation over piles: squared difference per effective value on the pile left out, "
       "from the best model"},
      {"fit.*.cv_behind_error", "-", "its standard error over the piles"},
      {"fit.*.cv_heights", "-", "the same on the height left out, not a difference"},
      {"fit.*.supported", "text", "yes: not behind the best in both; no"},
      {"fit.*.branch", "text", "branch of Cantelaube's theory with the nearest core angle"},
      {"fit.*.beta_hat_deg", "deg", "half tip angle of the elastic core, from the vertical"},
      {"fit.*.a1", "-", "core: sigma_yy under the axis = (a1 - 1) rho g depth (Roul 4.6)"},
      {"fit.*.a2", "-", "core: sigma_xx = (a2 - 1) rho g depth"},
      {"fit.*.b1", "-", "core: kink of sigma_yy at the axis; below 0 a dip"},
      {"fit.*.a_xx", "-", "flanks: sigma_xx over the weight above (Roul 4.9)"},
      {"fit.*.a_yy", "-", "flanks: sigma_yy over the weight above"},
      {"fit.*.a_xy", "-", "flanks: shear over the weight above"},
      {"fit.*.eta", "-", "OSL: sigma_xx / sigma_yy without shear"},
      {"fit.*.mu", "-", "OSL: sigma_xx per shear; below 0 a dip"},
      {"fit.*.friction_deg", "deg", "two slopes: friction angle"},
      {"fit.*.yield_ray_deg", "deg",
       "two slopes: ray on which the core yields, from the downward vertical, positive to the "
       "right"},
      {"fit.*.k_left", "-", "two slopes: left flank's sigma_xx over the depth below its slope"},
      {"fit.*.k_right", "-", "the same on the right"},
      {"fit.*.ray_deg", "deg",
       "two slopes: ray of the core's kink, from the downward vertical, positive to the right"},
      {"fit.*.kink", "-", "two slopes: slope of the kink (rho g); below 0 a dip"},
      {"fit.*.K", "-", "OSL: ratio of the normal stresses on the fixed axes (Roul 4.23)"},
      {"fit.*.tau_deg", "deg", "OSL: angle of the fixed axes (Roul 4.23)"},
      {"fit.*.nu", "-", "Poisson's ratio of an isotropic layer"},
      {"fit.*.rho", "-", "r/sqrt(t) of an orthotropic body: below 0 two peaks, -1 hyperbolic"},
      {"fit.*.t", "-", "E_x/E_y of an orthotropic body"},
      {"fit.*.shear", "-", "E_x/(2 G sqrt t): rho + nu_xy/sqrt t"},
      {"fit.*.nu_ratio", "-", "nu_xy/sqrt t of an orthotropic layer on a rough base"},
      {"fit.*.width", "h", "OSL layer: width over which the load is spread"},
      {"fe.*.constants_of", "text", "fitted model whose constants a finite-element solve took"},
      {"fe.*.note", "text", "why it was not solved; empty: it was"},
      {"fe.*.chi2_per_dof", "-", "of its field, on the fit's points with the fit's weights"},
      {"fe.*.rel_l2", "-", "|grains - it| / |grains|"},
      {"fe.*.from_closed_form", "-", "|it - fitted closed form| / |closed form|"},
      {"verdict.equations", "text", "elliptic | hyperbolic | not distinguishable"},
      {"verdict.agrees", "text", "yes: chi2/dof of the best model is what chance allows; no"},
      {"verdict.distinguishable", "text", "yes: one model is supported alone; no"},
      {"elastic.bulk", "N/m", "K of the plane, one fit a pile; median over piles"},
      {"elastic.shear", "N/m", "G likewise"},
      {"elastic.young", "N/m", "E = 3 G - G^2/K likewise"},
      {"elastic.poisson", "-", "nu likewise"},
      {"elastic.young_over_grain", "-", "E over the grains' stiffness (material)"},
      {"elastic.bulk_share", "-", "share of the change of pressure that K explains; median"},
      {"elastic.shear_share", "-", "share of the change of shear that G explains; median"},
      {"elastic.rearranged", "-", "piles whose strain stands out: grains rearranged"},
      {"elastic.rearranged_piles", "text", "their numbers, from 0"},
      {"elastic.young_pooled", "N/m", "E from the points of all piles in one fit"},
      {"elastic.young_pooled_kept", "N/m", "the same without the rearranged piles"},
      {"elastic.normal_ratio", "-", "C11/C22 of the orthotropic fit: 1 if isotropic"},
      {"elastic.shear_ratio", "-", "4 C66/(C11 + C22 - 2 C12): 1 if isotropic"},
      {"elastic.isotropy_p", "-",
       "probability of such ratios if isotropy holds; nan below 4 piles"},
      {"elastic.isotropy", "text", "holds | rejected (at 5 %) | undecided"},
      {"elastic.residual_isotropic", "-", "stress that the isotropic fit leaves, relative"},
      {"elastic.residual_orthotropic", "-", "stress that the orthotropic fit leaves, relative"},
      {"elastic.*_fabric_correlation", "-",
       "correlation of a constant with tr F over the points inside (medians, means over piles)"},
      {"fabric.angle_to_stress_deg", "deg",
       "between the major axes of fabric and stress; median over the points inside"},
      {"fabric.angle_to_strain_deg", "deg", "the same of fabric and strain"},
      {"fabric.angle_stress_strain_deg", "deg", "the same of stress and strain"},
      {"fabric.anisotropy", "-", "F_D / tr F; median over the points inside"},
      {"fabric.anisotropy_centre", "-", "the same within 0.4 half bases of the apex"},
      {"fabric.anisotropy_flanks", "-", "the same beyond"},
      {"fabric.axis_left_deg", "deg",
       "fabric's major axis from x, mean beyond 0.4 half bases on the left"},
      {"fabric.axis_right_deg", "deg", "the same on the right"},
      {"fabric.nu_c_correlation", "-", "of tr F with nu c over the points of all piles"},
      {"fabric.nu_c_slope", "-", "slope of tr F over nu c"},
      {"fabric.trace_over_nu_c", "-", "sum of tr F over sum of nu c, points of all piles"},
      {"fabric.nu_correlation", "-", "of tr F with nu over the points of all piles"},
      {"fabric.nu_slope", "-", "slope of tr F over nu"},
      {"fabric.g2", "-", "tr F/(nu c) of all grains of a pile"},
      {"fabric.g2_theory", "-", "g2 by Madadi et al. (2004) from the grains' sizes"},
      {"orientation.order", "-", "nematic order of the grains' long axes"},
      {"orientation.random_order", "-", "that of as many random axes"},
      {"orientation.director_deg", "deg", "mean long axis from x"},
      {"forces.base_grains", "-", "grains on the base"},
      {"forces.tail_rate", "-", "of P(n) ~ exp(-rate n) above the mean, all piles together"},
      {"forces.tail_grains", "-", "grains above the mean"},
      {"forces.tail_distance", "-", "largest difference of the cumulative distributions"},
      {"forces.tail_p_value", "-", "probability of a larger one if the tail is exponential"},
      {"forces.contact_anisotropy", "-", "2 |mean exp(2 i a)| of the contact normals"},
      {"forces.force_anisotropy", "-", "the same weighted by normal force"},
      {"forces.force_axis_deg", "deg", "its axis from x, all piles together"},
      {"chains.number", "-", "force chains of a pile (docs/structure.md)"},
      {"chains.length", "-", "grains of a chain"},
      {"chains.share", "-", "share of the bearing grains in chains"},
      {"chains.stressed_share", "-", "share of the bearing grains loaded above the mean"},
      {"yield.phi_deg", "deg", "angle of repose that the limit is taken at"},
      {"yield.mobilised_core_deg", "deg",
       "mobilised friction within 0.25 half bases of the apex; median over points and piles"},
      {"yield.mobilised_flanks_deg", "deg", "the same beyond"},
      {"yield.share_at_limit", "-", "share of the points inside that mobilise 95 % of it"},
      {"invariants.trace_slope_ratio", "-",
       "slope of tr stress over tr strain, upper third over lower third of the points: 1 is "
       "linear"},
      {"load.force", "N", "applied force F"},
      {"load.x", "m", "abscissa of the loaded grain, packing's axes"},
      {"load.y", "m", "height of the loaded grain, packing's axes"},
      {"load.contacts_gained", "-", "contacts that the load closed"},
      {"load.contacts_lost", "-", "contacts that the load opened"},
      {"load.newly_sliding", "-", "contacts that the load brought to the Coulomb limit"},
      {"load.max_displacement_over_radius", "-",
       "largest displacement by the load over the radius"},
      {"load.unbalanced_force_ratio", "-",
       "mean resultant over mean contact force under the load, where Newton's method applied it"},
      {"load.load_steps", "-", "load steps of Newton's method"},
      {"load.iterations", "-", "its iterations in all of them"},
      {"load.no_rearrangement", "-", "share of realizations without a gained or lost contact"},
      {"layer.depth", "m", "h of the models: mean over realizations"},
      {"layer.F_over_h", "N/m", "load over depth: the unit of normalised responses"},
      {"layer.mean_diameter", "m", "of the moving grains"},
      {"average.width", "m", "w of the coarse-graining kernel"},
      {"average.rve_radius", "m", "of the particle-centre averaging"},
      {"average.*.balance_rms", "-",
       "rms of div sigma + rho g (and wall and load forces) over rho g, "
       "mean over realizations, by averaging method"},
      {"average.*.balance_largest", "-", "largest residual of the same kind"},
      {"average.*.fluctuation", "-",
       "mean standard error over the largest response, by method, at "
       "the profiles below the surface"},
      {"response.total_over_load", "-", "integral of the base response over F; mean"},
      {"response.peak", "N/m", "largest base pressure response"},
      {"response.peak_at", "m", "its distance from the load"},
      {"response.peak_over_F_per_h", "-",
       "largest base pressure response over F/h (half plane 0.637, "
       "smooth rigid base 0.920)"},
      {"response.width", "m", "between the outermost crossings of half the peak"},
      {"response.rms_width", "m", "root of the second central moment"},
      {"response.peaks", "-", "number of peaks of the base response"},
      {"response.integral", "N", "trapezoidal integral of the base response"},
      {"response.*.peaks", "-",
       "number of peaks of a profile, e.g. depth_0.5 (share of the depth)"},
      {"response.*.peak", "N/m", "largest pressure response there"},
      {"compare.*.rel_l2", "-", "relative L2 distance of model and simulation, all profiles"},
      {"compare.*.max", "N/m", "largest distance"},
      {"compare.*.chi2_per_dof", "-",
       "chi squared per degree of freedom with the ensemble's errors"},
      {"compare.*.dof", "-", "independent points"},
      {"compare.*.peak", "N/m", "the model's peak on the last profile"},
      {"compare.*.peak_over_F_per_h", "-", "the same over F/h"},
      {"verdict.best_model", "text", "label of the model nearest to the simulation"},
      {"verdict.sentence", "text", "the verdict for people"},
      {"verdict.position", "-", "0: the losing family's best model, 1: the winning family's"},
      {"verdict.position_error", "-", "its standard error over realizations"},
      {"wedge.*.base_shape", "text", "pressure on the heap's base: dip, plateau, peak"},
      {"wedge.*.base_axis", "-",
       "mean pressure on the base within 5 % of its half width from the axis, over rho g h; where "
       "the pressure has a kink there, not its value at x = 0 (Cantelaube's minus branch at 28 "
       "deg: 0.31, at x = 0 0.22)"},
      {"wedge.*.base_largest", "-", "largest pressure on the base over rho g h"},
      {"wedge.*.base_largest_at", "-", "its distance from the axis over h"},
      {"wedge.*.dip_ratio", "-", "base_axis over base_largest"},
      {"wedge.*.nearest", "text", "label of the closed wedge nearest to the heap's base pressure"},
      {"wedge.*.nearest_rel_l2", "-", "its relative L2 distance from it"},
      {"wedge.*.failed", "text", "why there is no such heap"},
      {"wedge.heaps", "-", "heaps that were tried"},
      {"wedge.equilibria", "-", "of these, heaps with an equilibrium"},
      {"wedge.dips", "-", "of these, with a dip"},
      {"wedge.plateaus", "-", "with a plateau"},
      {"wedge.peaks", "-", "with a peak"},
  };
  static const std::vector<SummaryKey> after_models = {
      {"time.dem_cpu_s", "s",
       "CPU time of the realizations, all starts together; of a sweep: of each member"},
      {"time.dem_s", "s",
       "wall time of the realizations (this start; of a sweep: of all members together)"},
      {"time.analysis_s", "s", "wall time of averaging and comparison"},
      {"time.continuum_s", "s", "wall time of the models"},
      {"time.model.*_s", "s", "wall time of one model"},
      {"time.total_s", "s", "wall time of the run (this start)"},
      {"memory.peak_MB", "MB", "most memory that the process had so far: simulation and analysis"},
      {"sweep.key", "text", "key that was swept"},
      {"sweep.sentence", "text", "which members differ beyond chance, and by how much"},
      {"sweep.difference.*", "-", "member minus the first, in the unit of the figure"},
      {"sweep.difference_error.*", "-", "its standard error"},
      {"sweep.p_value.*", "-", "two-sided p of that difference (Welch's t over realizations)"},
      {"sweep.p_holm.*", "-", "the same, corrected for all that are compared (Holm)"},
      {"sweep.members", "-",
       "its number of values; every other key carries .NAME_VALUE at its end"},
      {"*.least", "-", "least over realizations, in the unit of the figure"},
      {"*.most", "-", "largest over realizations, in the unit of the figure"},
      {"*.standard_error", "-", "standard error over realizations, in the unit of the figure"},
  };
  static const std::vector<SummaryKey> all = [] {
    auto joined = before_models;
    for (const auto& part : {model_figure_keys(), after_models})
      joined.insert(joined.end(), part.begin(), part.end());
    return joined;
  }();
  return all;
}

const SummaryKey* find_summary_key(const std::string& key) {
  for (const auto& entry : summary_keys()) {
    if (matches(entry.pattern.c_str(), key.c_str())) return &entry;
  }
  return nullptr;
}

void require_documented(const Summary& summary) {
  for (const auto& [key, value] : summary) {
    if (find_summary_key(key) == nullptr) {
      throw std::logic_error("summary key " + key + " is not declared in run/summary_keys.cc");
    }
  }
}

std::string summary_keys_text() {
  std::string out;
  for (const auto& key : summary_keys()) {
    out += fmt::format("{}  ({})\n    {}\n", key.pattern, key.unit == "-" ? "no unit" : key.unit,
                       key.meaning);
  }
  return out;
}

std::string summary_keys_markdown() {
  std::string out =
      "# Keys of summary.json\n\nGenerated by `grainfield keys --summary --markdown`. `*` stands "
      "for "
      "a name; SI units. Figures of the grains are means over realizations. In a sweep every key "
      "carries the member at its end, e.g. `response.peaks.friction_0.3`.\n\n"
      "| key | unit | meaning |\n|---|---|---|\n";
  for (const auto& key : summary_keys()) {
    out += fmt::format("| `{}` | {} | {} |\n", key.pattern, key.unit,
                       boost::replace_all_copy(key.meaning, "|", "\\|"));
  }
  return out;
}

}  // namespace grainfield::coupling
