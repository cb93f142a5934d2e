// What goes together in a sample's setup.
#pragma once
#include "coupling/studies/sample/simulation/grains.h"
#include "dem/engine/engine.h"
#include "dem/run/groundwork.h"

namespace grainfield::dem {

/// What is known of a sample before it is run.
struct SampleFrame {
  EngineSettings settings;      ///< without threads and cell
  double compression_time = 0;  ///< s, at least
  double drop_time = 0;         ///< s, about; 0: the grains are placed
  double deformation_time = 0;  ///< s
};

/// What its run starts from (Groundwork).
struct SampleGroundwork {
  using Setup = SampleSetup;
  static constexpr const char* kName = "sample";
  /// A shape or law of another dimension, a servo without a target, words that do not go together.
  static void check(const Setup& setup);
  static std::vector<ShapedGrain> draw(const Setup& setup, Random& random, Allowance& allowance);
  /// Stable step, speeds, the size of the box (of grains of mean volume).
  static SampleFrame settings(const Setup& setup, const std::vector<ShapedGrain>& grains,
                              double reserve = 1);
  static Outlook outlook(const Setup& setup, const SampleFrame& frame);
};

/// Least edge that the sample can have in its first state, at most, m: its grains are of mean
/// volume, and a pressure is not reached before they fill the least that carries load.
double widest_first_edge(const SamplePlan& plan);

}  // namespace grainfield::dem
