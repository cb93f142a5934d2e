// Stresses of an ensemble of heaps on horizontal lines, as data for fits: from the grains, or from
// a field that was averaged before.
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "coupling/averaging/kernel.h"
#include "coupling/case/case.h"
#include "coupling/field.h"
#include "coupling/fit/data.h"
#include "coupling/fit/models.h"
#include "coupling/fit/setup.h"
#include "coupling/fit/stress_maps.h"
#include "coupling/heap/pile_frame.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

struct HeapData {
  FitData data;                   ///< scaled: lengths over h, stresses over rho g h of each heap
  HeapFacts facts;                ///< in the same units: rho_g = height = 1
  std::vector<PileFrame> frames;  ///< one per realization
  double width = 0;               ///< of the averaging kernel, m
  int left_out = 0;               ///< values that some realization does not have
  std::string note;               ///< what the reader must know of the heaps; may be empty
  StressMaps maps;                ///< empty: of a field that is no grid
  std::shared_ptr<const Kernel> kernel;  ///< of the averaging, lengths over h
  std::vector<std::string> warnings;     ///< what makes the constants doubtful, a sentence each
};

/// Heaps one after the other, so that one at a time is in memory.
struct HeapReader {
  std::size_t count = 0;
  std::function<dem::Snapshot(std::size_t)> read;
  std::function<std::string(std::size_t)> name;  ///< for messages
};

/// The snapshot "pile" of every realization file of a run.
HeapReader heaps_of_runs(const std::vector<std::string>& files);

/// Coarse-grained stresses (Lucy kernel, width_diameters) of every heap at setup.heights, on points
/// half an independent length apart, no nearer to the flanks than the kernel reaches. Slopes and
/// friction angle are measured unless setup gives them. Warns of heaps that are unbalanced or not
/// carried by their floor, and of heights below the averaging width. Throws std::invalid_argument
/// naming the heap that has no slope or whose contacts pull, and when fewer than 10 values are
/// left.
HeapData heap_data(const FitSetup& setup, const HeapReader& heaps, int threads);

/// The same from a field in the heaps' frame (lengths over h) with the values of single
/// realizations, as `grainfield average --frame heap` leaves it: of its horizontal rows those
/// nearest to setup.heights. Without single values the mean alone. `where` names the field in
/// messages. Throws std::invalid_argument for another frame, missing components, heights that the
/// field does not have, tension throughout, and as above.
HeapData heap_data(const FitSetup& setup, const Field& field, const std::string& where);

/// Whether one of the models takes the two flanks apart (models.h).
bool takes_flanks_apart(const std::vector<std::string>& models);

}  // namespace grainfield::coupling
