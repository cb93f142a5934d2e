// The two bodies of a pair: how they are made and where they touch.
#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include "coupling/studies/pair/simulation.h"
#include "dem/engine/pair_contact.h"
#include "dem/random/random.h"

namespace grainfield::dem {

/// Place and angle of the first body, in the plane of the path.
struct PairPose {
  double x = 0, y = 0, angle = 0;
};

struct PairBodies {
  NewGrain first, second;
  bool has_wall = false;
  Wall wall;
  EngineSettings settings;
  double stable_step = 0;  ///< s (engine.h: stable_time_step)
  double pair_mass = 0;    ///< m_i m_j/(m_i + m_j), kg

  std::unique_ptr<PairContact> contact() const;
  /// An engine with both, and the first moving like this.
  std::unique_ptr<Engine> engine(const PairState& first) const;
  /// An engine without grains, to restore one.
  std::unique_ptr<Engine> empty_engine() const;
  PairState state_of_first(const PairPose& pose) const;
  PairState state_of_second() const;
};

/// Throws std::invalid_argument naming the key.
void check_pair(const PairSetup& setup);
/// Draws of `random` what the setup leaves to chance. Throws likewise.
PairBodies make_pair(const PairSetup& setup, Random& random, int threads);

/// Where the first one touches the second as it comes along the x axis at this height: their
/// overlap is only just above 0. Throws std::invalid_argument naming pair.offset where they miss.
PairPose touching_pose(const PairBodies& bodies, double offset);

/// How often the outlines of two polygons cross at these states; 0 where one is round.
int crossings(const PairBodies& bodies, const PairState& first, const PairState& second);
/// Whether the outlines of any two bodies, or of the body and the wall, cross: neither lies apart
/// nor one within the other.
bool outlines_cross(const PairBodies& bodies, const PairState& first, const PairState& second);

}  // namespace grainfield::dem
