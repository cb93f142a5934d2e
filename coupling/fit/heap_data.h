// Stresses of an ensemble of heaps on horizontal lines, as data for fits.
#pragma once
#include <string>
#include <vector>

#include "coupling/case/case.h"
#include "coupling/fit/data.h"
#include "coupling/fit/models.h"
#include "coupling/run/pile_frame.h"

namespace grainfield::coupling {

struct HeapData {
  FitData data;                   ///< scaled: lengths over h, stresses over rho g h of each heap
  HeapFacts facts;                ///< in the same units: rho_g = height = 1
  std::vector<PileFrame> frames;  ///< one per realization
  double width = 0;               ///< of the averaging kernel, m
  int left_out = 0;               ///< values that some realization does not have
};

/// Coarse-grained stresses (Lucy kernel, fit.width_diameters) of every file's snapshot "pile" at
/// fit.heights, on points half an independent length apart, no nearer to the flanks than the
/// kernel reaches. Throws std::invalid_argument for a file without a heap, and when fewer than 10
/// values are left.
HeapData heap_data(const Case& value, const std::vector<std::string>& files, int threads);

}  // namespace grainfield::coupling
