// Setup of fits to heaps and to layers: [fit] of a case.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace grainfield::coupling {

/// What is fitted to heaps where nobody chooses.
inline const std::vector<std::string> kUsualHeapModels = {"hydrostatic",
                                                          "cantelaube_minus",
                                                          "cantelaube_zero",
                                                          "cantelaube_plus",
                                                          "cantelaube_continuous",
                                                          "cantelaube",
                                                          "osl_yield",
                                                          "osl",
                                                          "fpa",
                                                          "bcc"};

/// ... and to layers.
inline const std::vector<std::string> kUsualLayerModels = {"flamant",
                                                           "layer_smooth",
                                                           "layer_rough",
                                                           "orthotropic_half_plane",
                                                           "orthotropic_layer_smooth",
                                                           "orthotropic_layer_rough",
                                                           "osl_layer_absorbing",
                                                           "osl_layer_reflecting"};

/// What is fitted to piles and to loaded layers (coupling/fit).
struct FitSetup {
  std::vector<std::string> models;           ///< empty: none is fitted
  std::vector<std::string> finite_elements;  ///< solved with the constants, beside the fits
  std::vector<std::string> components = {"sigma_xx", "sigma_yy", "sigma_xy"};
  std::vector<double> heights = {0.1, 0.25, 0.4};
  bool base = true;               ///< of layers: the forces on the base, too
  std::vector<double> leave_out;  ///< numbers of realizations, from 1
  std::vector<double> kernel;     ///< widths, diameters, at which it is judged again; may be empty
  double width_diameters = 2;
  double left_deg = 0, right_deg = 0;  ///< slopes of the flanks; 0: measured
  double friction_deg = 0;             ///< of the two-sided models; 0: the steeper slope
  double huber = 0;
  std::int64_t bootstrap = 200;
  std::vector<double> coverage;  ///< sizes of draws: fit/coverage.h; empty: not done
  std::int64_t coverage_draws = 100;
};

}  // namespace grainfield::coupling
