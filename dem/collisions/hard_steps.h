// The same grains in steps of time, as Liffman's program moves them: all fly freely for a step;
// then those that overlap and approach collide, each pair once, in the order of their numbers.
//
// A collision comes late by up to a step, by half of one in the mean, and what three grains do
// within a step comes in the order of numbers. Energy is that of hard_engine.h: an elastic grain
// keeps it to round-off.
#pragma once
#include <vector>

#include "dem/collisions/scene.h"

namespace grainfield::dem {

template <int D>
class HardSteps {
 public:
  /// Steps of `time_step`, s. Throws what check_scene does, and std::invalid_argument for a step
  /// that is not above 0. The scene's contact time is not used.
  HardSteps(const HardScene<D>& scene, const std::vector<Body<D>>& grains, double time_step);

  void step(long steps);

  double time() const { return static_cast<double>(steps_) * time_step_; }
  const std::vector<Body<D>>& bodies() const { return bodies_; }
  long collisions() const { return collisions_; }

 private:
  void collide_pairs();
  void collide_walls();

  HardScene<D> scene_;
  std::vector<Body<D>> bodies_;
  double time_step_ = 0;
  long steps_ = 0, collisions_ = 0;
  Cells<D> cells_;
  std::vector<std::int32_t> touching_;
};

extern template class HardSteps<2>;
extern template class HardSteps<3>;

}  // namespace grainfield::dem
