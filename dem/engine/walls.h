// Walls as the step loop meets them.
#pragma once
#include <vector>

#include "dem/snapshot/snapshot.h"
#include "dem/space/plane.h"

namespace grainfield::dem {

template <int D>
class Walls {
 public:
  void add(const Wall& wall) {
    walls_.push_back(wall);
    planes_.push_back({in_space<D>(wall.point), in_space<D>(wall.normal)});
  }
  int size() const { return static_cast<int>(walls_.size()); }
  const std::vector<Wall>& all() const { return walls_; }
  const Plane<D>& plane(int w) const { return planes_[w]; }

 private:
  std::vector<Wall> walls_;
  std::vector<Plane<D>> planes_;
};

}  // namespace grainfield::dem
