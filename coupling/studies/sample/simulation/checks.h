// What goes together in a sample's setup.
#pragma once
#include "coupling/studies/sample/simulation/grains.h"
#include "dem/engine/engine.h"

namespace grainfield::dem {

/// What is known of a sample before it is run.
struct SampleFrame {
  EngineSettings settings;      ///< without threads and cell
  double compression_time = 0;  ///< s, at least
  double drop_time = 0;         ///< s, about; 0: the grains are placed
  double deformation_time = 0;  ///< s
};

/// Throws std::invalid_argument naming the key: a shape or law of another dimension, a servo
/// without a target, words that do not go together.
void check_sample(const SampleSetup& setup);

/// The same for what depends on grains: stable step, speeds, the size of the box (of grains of mean
/// volume). `reserve` as in engine_settings.
SampleFrame sample_frame(const SampleSetup& setup, const GrainExtremes& extremes,
                         double reserve = 1);

/// Least edge that the sample can have in its first state, at most, m: its grains are of mean
/// volume, and a pressure is not reached before they fill the least that carries load.
double widest_first_edge(const SamplePlan& plan);

}  // namespace grainfield::dem
