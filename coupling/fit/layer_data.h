// Responses of an ensemble of layers to a point load, as data for fits.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "coupling/averaging/kernel.h"
#include "coupling/case/case.h"
#include "coupling/fit/data.h"

namespace grainfield::coupling {

struct LayerData {
  /// loaded - unloaded; lengths over h, stresses over F/h; base: y = -1. Working unit: F over the
  /// value's depth, which the peak of every model falls off with.
  FitData data;
  double depth = 0;       ///< h, m: mean over realizations
  double force = 0;       ///< F, N
  double diameter = 0;    ///< mean of the grains, m
  double half_width = 0;  ///< from the load to the nearer side wall, least of the realizations, m
  std::unique_ptr<Kernel> kernel;  ///< of the averaging, its width over h
  int left_out = 0;                ///< values that some realization does not have
};

/// The verdict.components at average.depths and on the base (without sigma_xx, which nobody
/// measures there), averaged by the first of average.methods, on points half an independent length
/// apart, no nearer to the side walls than the kernel reaches. Throws std::invalid_argument for
/// files of something else, and when fewer than 10 values are left.
LayerData layer_data(const Case& value, const std::vector<std::string>& files, int threads);

}  // namespace grainfield::coupling
