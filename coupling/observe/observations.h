// What is judged and how it was seen: stresses of an ensemble of heaps, of layers under a load on
// one point, or of anything else whose frame is known; in the plane or in space; from grains, from
// a field file or from a laboratory's table. Models are seen through the same places and kernels.
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "continuum/constants.h"
#include "coupling/averaging/kernel.h"
#include "coupling/base/field.h"
#include "coupling/case/case.h"
#include "coupling/compare/compare.h"
#include "coupling/models/evaluate_model.h"
#include "coupling/observe/data.h"
#include "coupling/observe/heap_facts.h"
#include "coupling/observe/setup.h"
#include "coupling/observe/stress_maps.h"
#include "coupling/specimen/pile_frame.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

enum class Specimen {
  heap,   ///< under its weight: stresses over rho g h
  layer,  ///< under a load on one point: over F/h, in space F/h^2
  rest,   ///< a layer at rest, or any other field: 1 N/m (in space 1 Pa)
};

/// One stress along one horizontal line: m and N/m (in space Pa), models' frame.
struct ObservedLine {
  Profile profile;
  PointSet places;                       ///< where a model is evaluated for it, and through what
  std::shared_ptr<const Kernel> kernel;  ///< of the places
  int component = 1;  ///< of the models' stresses: place in kPlaneStress, in space kSpaceStress
  double sign = -1;   ///< profile over stress: pressures are positive, shear keeps its sign
  /// The places are radii from 0, which the profile has on both sides; pictures may need more of
  /// them.
  bool both_sides = false;
};

struct Observations {
  Specimen specimen = Specimen::heap;
  bool measured = false;  ///< in a laboratory: texts speak of no grains
  int realizations = 1;
  Scale scale;       ///< length h, m: mean over the realizations; unit of stresses
  RunFacts told;     ///< what models are told of the specimen; its `dim` is that of the stresses
  std::string note;  ///< what the reader must know; may be empty
  std::vector<std::string> warnings;  ///< what makes the constants doubtful, a sentence each

  // What models as they are given are compared with.
  std::vector<ObservedLine> lines;
  Field map;                      ///< further places where they are given as they are; may be empty
  double apex = 0;                ///< m, of the models' heap above the origin of lines and map
  std::vector<std::string> seen;  ///< how each field was averaged, for people

  // What models with free constants are fitted to: lengths over h, stresses over the unit of each
  // realization. Heaps: apex at (0, 0), inside y < 0. Layers: loaded - unloaded, load at (0, 0),
  // base y = -1; a value counts in F over its depth, which the peak of every model falls off with.
  FitData data;
  std::shared_ptr<const Kernel> kernel;  ///< of the averaging, lengths over h
  double width = 0;                      ///< of this kernel, m
  StressMaps maps;                       ///< empty: of a field that is no grid
  int left_out = 0;                      ///< values that some realization does not have
  std::size_t without_error = 0;         ///< values left out of one field beside some with errors
  HeapFacts facts;                       ///< in the same units: rho_g = height = 1
  std::vector<PileFrame> frames;         ///< of heaps, one per realization
  double weight_over_wedge = kNan;       ///< mean over the heaps (PileFrame); nan: not known

  /// Height of the models' heap over that of the grains.
  double spanned() const { return scale.h > 0 ? 1 + apex / scale.h : 1; }
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
