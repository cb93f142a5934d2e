// What is fitted and how it was seen: stresses of an ensemble of heaps on horizontal lines, from
// the grains or from a field that was averaged before, or responses of an ensemble of layers to a
// point load.
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "continuum/constants.h"
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

enum class Specimen { heap, layer };

/// Lengths over h. Stresses of heaps over rho g h of each heap, apex at (0, 0), inside is y < 0; of
/// layers loaded - unloaded over F/h, load at (0, 0), base y = -1, working unit F over the value's
/// depth, which the peak of every model falls off with.
struct Observations {
  Specimen specimen = Specimen::heap;
  FitData data;
  std::shared_ptr<const Kernel> kernel;  ///< of the averaging, lengths over h
  StressMaps maps;                       ///< empty: of a field that is no grid
  double height = 0;                     ///< h, m: mean over the realizations
  double unit = 0;                       ///< of stresses, N/m: mean rho g h, or F/h
  double width = 0;                      ///< of the averaging kernel, m
  bool measured = false;                 ///< in a laboratory: texts speak of no grains
  int left_out = 0;                      ///< values that some realization does not have
  std::size_t without_error = 0;         ///< values left out of one field beside some with errors
  std::string note;                      ///< what the reader must know; may be empty
  std::vector<std::string> warnings;     ///< what makes the constants doubtful, a sentence each
  // Of heaps.
  HeapFacts facts;                  ///< in the same units: rho_g = height = 1
  std::vector<PileFrame> frames;    ///< one per realization
  double weight_over_wedge = kNan;  ///< mean over the heaps (PileFrame); nan: not known
};

/// Moves the rows of `all` that are finite in every realization into out.data and counts the
/// others. Throws std::invalid_argument, "KEY: found N values in the heaps (layers), needed: ...;
/// ADVICE", when fewer than 10 are left.
void keep_complete_rows(const FitData& all, const std::string& key, const std::string& advice,
                        Observations& out);

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
Observations observe_heaps(const FitSetup& setup, const HeapReader& heaps, int threads);

/// The same from a field in the heaps' frame (lengths over h) with the values of single
/// realizations, as `grainfield average --frame heap` leaves it: of its horizontal rows those
/// nearest to setup.heights. Without single values the mean alone. `where` names the field in
/// messages. Throws std::invalid_argument for another frame, missing components, heights that the
/// field does not have, tension throughout, and as above.
Observations observe_heap_field(const FitSetup& setup, const Field& field,
                                const std::string& where);

/// The verdict.components at average.depths and on the base (without sigma_xx, which nobody
/// measures there), averaged by the first of average.methods, on points half an independent length
/// apart, no nearer to the side walls than the kernel reaches. `files`: of realizations with the
/// states "unloaded" and "loaded". Throws std::invalid_argument for files of something else, and
/// when fewer than 10 values are left.
Observations observe_layers(const Case& value, const std::vector<std::string>& files, int threads);

/// Whether one of the models takes the two flanks apart (models.h).
bool takes_flanks_apart(const std::vector<std::string>& models);

}  // namespace grainfield::coupling
