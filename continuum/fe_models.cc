// The finite-element models as the registry lists them. Their solvers are in a library of their own
// (continuum/fe), which is loaded when the first of them is made: with it come deal.II's two
// hundred libraries, and a program that only checks a case must not wait for those.
#include "continuum/fe_models.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <mutex>

#include "continuum/closed/transverse.h"
#include "continuum/fe/block.h"
#include "continuum/fe/elastic.h"
#include "continuum/fe/plugin.h"
#include "continuum/installed.h"
#include "continuum/settings.h"
#include "continuum/size.h"

namespace grainfield::continuum {
namespace {

constexpr char layer_name[] = "fe_elastic_layer";
constexpr char orthotropic_name[] = "fe_orthotropic_layer";
constexpr char core_name[] = "fe_cantelaube_core";
constexpr char half_space_name[] = "fe_elastic_half_space";
constexpr char transverse_layer_name[] = "fe_transverse_layer";
constexpr char transverse_half_space_name[] = "fe_transverse_half_space";
constexpr char wedge_name[] = "fe_mohr_coulomb_wedge";
constexpr char cone_name[] = "fe_cone";

Ranks g_ranks = Ranks::all;

// Beside the program, where an installed program or module has it, or where it was built.
void* open_library() {
  std::error_code error;
  const auto folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  const std::filesystem::path built = GRAINFIELD_FE_LIBRARY;
  std::vector<std::filesystem::path> files{folder / built.filename()};
  for (const auto& prefix : installed_prefixes())
    files.push_back(prefix / "lib/grainfield" / built.filename());
  files.push_back(built);
  for (const auto& file : files) {
    if (!std::filesystem::exists(file, error)) continue;
    if (void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) return library;
    throw ComputationFailed(fmt::format(
        "the finite-element library cannot be loaded: {}; install the packages of packages.txt",
        dlerror()));
  }
  throw ComputationFailed(fmt::format(
      "the finite-element library {} is neither beside the program nor in ../lib/grainfield",
      built.filename().string()));
}

// A function of the library, which is loaded once.
void* function_of_library(const char* symbol) {
  static std::mutex once;
  static void* library = nullptr;
  const std::lock_guard lock(once);
  if (library == nullptr) library = open_library();
  void* function = dlsym(library, symbol);
  if (function == nullptr)
    throw ComputationFailed("the finite-element library is of another version");
  return function;
}

fe::MakeFunction plugin() {
  return reinterpret_cast<fe::MakeFunction>(function_of_library(fe::kMakeSymbol));
}

template <const char* name>
std::unique_ptr<Model> make_in_plugin(const Settings& settings) {
  return make_in_fe_library(name, settings);
}

std::vector<Parameter> common_parameters() {
  return {choice("dim", "2: plane strain; 3: space", "elasticity", {"2", "3"}),
          number("F", "N", "load at the origin, down", "Roul 5.6", 1, 0, kUnbounded),
          number("E", "Pa", "Young's modulus (N/m in 2D); the stress does not depend on it",
                 "elasticity", 1e7, kAboveZero, kUnbounded),
          // Beyond this displacement elements lock and the iterations grow.
          number("nu", "-", "Poisson's ratio", "elasticity", 0.3, 0, 0.49)};
}

Parameter most_unknowns() {
  return number("most_unknowns", "-",
                "of equations that adaptive refinement may come to; a million take about a "
                "gigabyte of memory",
                "numerics", kMostUnknowns, 100, 1e9);
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

std::vector<Parameter> point_load() {
  return {number("F", "N", "load at the origin, down", "elasticity", 1, 0, kUnbounded)};
}

std::vector<Parameter> joined(std::initializer_list<std::vector<Parameter>> parts) {
  std::vector<Parameter> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

// Figures of the elastic solver, and with adaptive refinement.
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

// Parameters of heaps of Mohr-Coulomb material, in the plane and as cones.
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
      number("base_friction_deg", "deg", "friction angle of a frictional base", source, 28, 0, 80),
      number("base_stiffness", "E/h",
             "springs of a frictional base, per length; with a map E is its mean over the heap",
             "numerics", 100, kAboveZero, kUnbounded),
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
      whole_number("layers", "of the histories rise and grow", "numerics", 8, 1, 1000),
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

}  // namespace

void solve_on(Ranks ranks) { g_ranks = ranks; }

std::unique_ptr<Model> make_in_fe_library(const char* name, const Settings& settings) {
  std::unique_ptr<Model> model;
  reinterpret_cast<fe::WatchFunction>(function_of_library(fe::kWatchSymbol))(progress_watcher());
  plugin()(name, settings, g_ranks, model);
  return model;
}

std::vector<BlockState> load_block(const BlockMaterial& material,
                                   const Eigen::Matrix3d& initial_stress,
                                   const std::vector<BlockLoad>& path, int cells) {
  std::vector<BlockState> states;
  reinterpret_cast<fe::BlockFunction>(function_of_library(fe::kBlockSymbol))(
      material, initial_stress, path, cells, states);
  return states;
}

ModelInfo fe_elastic_layer_info() {
  return {layer_name,
          "elastic layer on a rigid base under a point load, finite elements",
          0,
          joined({common_parameters(), layer_parameters(),
                  numerical_parameters("over F/h (3D: F/h2); 0: 2e-4 in 2D, 5e-3 in 3D", 6)}),
          make_in_plugin<layer_name>,
          solver_figures({})};
}

ModelInfo fe_orthotropic_layer_info() {
  const char* source = "Otto et al. 2003";
  return {
      orthotropic_name,
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
      make_in_plugin<orthotropic_name>,
      solver_figures(
          {{"r", "-", "(E_x/G - 2 nu_xy)/2; of a map: at the load"},
           {"t", "-", "E_x/E_y; of a map: at the load"},
           {"nu_xy", "-", "-eps_yy/eps_xx under sigma_xx, where it is set or a map gives it"},
           {"map_share", "-",
            "part of the layer for which the map has constants of its own; elsewhere those of its "
            "nearest node"}})};
}

ModelInfo fe_elastic_half_space_info() {
  return {
      half_space_name,
      "elastic half plane or half space under a small loaded patch, finite elements",
      0,
      joined(
          {common_parameters(), half_space_parameters(),
           numerical_parameters(
               "over F/r (3D: F/r2), r the distance from the load; 0: 2e-3 in 2D, 1e-2 in 3D", 4)}),
      make_in_plugin<half_space_name>,
      half_space_figures()};
}

ModelInfo fe_transverse_layer_info() {
  return {
      transverse_layer_name,
      "elastic layer with a vertical axis of symmetry on a rigid base under a point load, finite "
      "elements",
      3,
      joined({point_load(), transverse_parameters(), layer_parameters(),
              numerical_parameters("over F/h2; 0: 5e-3", 6)}),
      make_in_plugin<transverse_layer_name>,
      solver_figures({})};
}

ModelInfo fe_transverse_half_space_info() {
  return {transverse_half_space_name,
          "elastic half space with a vertical axis of symmetry under a small loaded patch, finite "
          "elements",
          3,
          joined({point_load(), transverse_parameters(), half_space_parameters(),
                  numerical_parameters("over F/r2, r the distance from the load; 0: 1e-2", 4)}),
          make_in_plugin<transverse_half_space_name>,
          half_space_figures()};
}

ModelInfo fe_cantelaube_core_info() {
  const char* source = "Roul 4.3";
  return {
      core_name,
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
       number("base_stiffness", "E/h", "springs of an elastic base, per area", "elasticity", 1,
              kAboveZero, kUnbounded),
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
      make_in_plugin<core_name>,
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
          false)};
}

ModelInfo fe_mohr_coulomb_wedge_info() {
  const char* source = "Mohr-Coulomb";
  return {
      wedge_name,
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
      make_in_plugin<wedge_name>,
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
            "with a map: its mean Young's modulus over rho g h, the E of base_stiffness"}})};
}

ModelInfo fe_cone_info() {
  const char* source = "Mohr-Coulomb";
  return {
      cone_name,
      "cone of elastic-plastic Mohr-Coulomb material under its weight, finite elements",
      3,
      joined({{number("phi_deg", "deg", "friction angle", source, 28, 1, 60),
               number("slope_deg", "deg", "slope, apex at the origin; 0: as phi_deg", source, 0, 0,
                      80),
               number("h", "m", "height; the base is z = -h", source, 1, kAboveZero, kUnbounded),
               number("rho_g", "N/m^3", "weight per volume", source, 1, kAboveZero, kUnbounded)},
              heap_material(source),
              heap_numerics(source)}),
      make_in_plugin<cone_name>,
      heap_figures(
          {{"beta_hat_deg", "deg",
            "angle from the vertical of the line from the apex that has half of the flank's inner "
            "border on either side"},
           {"beta_hat_misfit", "-", "median distance of the border from that line over the depth"},
           {"base_centre", "-", "pressure on the base at its middle over rho g h"},
           {"base_largest", "-", "largest pressure on the base over rho g h"},
           {"dip_ratio", "-", "base_centre over base_largest; 1: no dip"}})};
}

}  // namespace grainfield::continuum
