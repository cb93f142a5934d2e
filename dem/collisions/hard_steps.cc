#include "dem/collisions/hard_steps.h"

#include <fmt/format.h>

#include <algorithm>

namespace grainfield::dem {

template <int D>
HardSteps<D>::HardSteps(const HardScene<D>& scene, const std::vector<Body<D>>& grains,
                        double time_step)
    : scene_(scene), bodies_(grains), time_step_(time_step) {
  if (!(time_step > 0 && std::isfinite(time_step))) {
    throw std::invalid_argument(
        fmt::format("time step: found {:g} s, allowed: above 0", time_step));
  }
  check_scene(scene, grains);
  cells_ = Cells<D>(scene.box, widest(grains), grains.size());
}

template <int D>
void HardSteps<D>::step(long steps) {
  const VectorOf<D> kick = time_step_ * scene_.gravity, fall = 0.5 * time_step_ * kick;
  for (; steps > 0; --steps) {
    for (Body<D>& b : bodies_) {
      b.position += time_step_ * b.velocity;
      if (b.inverse_mass > 0) {
        b.position += fall;
        b.velocity += kick;
      }
      b.position = inside(scene_.box, b.position);
    }
    ++steps_;
    collide_pairs();
    collide_walls();
  }
}

template <int D>
void HardSteps<D>::collide_pairs() {
  cells_.clear();
  const auto n = static_cast<std::int32_t>(bodies_.size());
  for (std::int32_t i = 0; i < n; ++i) cells_.put(i, cells_.of(bodies_[i].position));
  for (std::int32_t i = 0; i < n; ++i) {
    touching_.clear();
    cells_.near(cells_.of(bodies_[i].position), [&](std::int32_t j, const VectorOf<D>& shift) {
      if (j <= i) return;
      const double distance = bodies_[i].radius + bodies_[j].radius;
      const VectorOf<D> way = bodies_[j].position + shift - bodies_[i].position;
      if (way.squaredNorm() < distance * distance) touching_.push_back(j);
    });
    std::sort(touching_.begin(), touching_.end());
    for (const std::int32_t j : touching_) {
      const VectorOf<D> way = nearest_way(scene_.box, bodies_[i].position, bodies_[j].position);
      const Impact<D> impact =
          collide<D>(bodies_[i], bodies_[j], VectorOf<D>(way.normalized()), scene_.grains);
      if (impact.normal > 0) ++collisions_;
    }
  }
}

template <int D>
void HardSteps<D>::collide_walls() {
  for (const HardWall<D>& wall : scene_.walls) {
    const VectorOf<D> place = wall.place(time());
    for (Body<D>& b : bodies_) {
      if (!((b.position - place).dot(wall.normal) < b.radius)) continue;
      Body<D> plane = wall.body();
      if (collide<D>(b, plane, VectorOf<D>(-wall.normal), wall.law).normal > 0) ++collisions_;
    }
  }
}

template class HardSteps<2>;
template class HardSteps<3>;

}  // namespace grainfield::dem
