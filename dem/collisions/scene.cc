#include "dem/collisions/scene.h"

#include <fmt/format.h>

#include <stdexcept>

namespace grainfield::dem {
namespace {

// Overlaps of this share of a radius are round-off.
constexpr double kTouching = 1e-10;

void check_law(const ImpactLaw& law) {
  if (!(law.restitution >= 0 && law.restitution <= 1)) {
    throw std::invalid_argument(
        fmt::format("restitution: found {:g}, allowed: 0 to 1", law.restitution));
  }
  if (!(law.friction >= 0 && std::isfinite(law.friction))) {
    throw std::invalid_argument(
        fmt::format("friction: found {:g}, allowed: 0 or more", law.friction));
  }
}

template <int D>
void check_box(const HardBox<D>& box, double width) {
  for (int a = 0; a < D; ++a) {
    const double least = box.periodic[a] ? 3.001 * width : 0;
    if (std::isfinite(box.size[a]) && box.size[a] > least) continue;
    throw std::invalid_argument(
        box.periodic[a]
            ? fmt::format("box: found {:g} m along a periodic axis, allowed: above {:g}, three "
                          "diameters of the largest grain",
                          box.size[a], least)
            : fmt::format("box: found {:g} m along an axis, allowed: above 0", box.size[a]));
  }
}

}  // namespace

template <int D>
void check_scene(const HardScene<D>& scene, const std::vector<Body<D>>& grains) {
  check_law(scene.grains);
  for (const HardWall<D>& wall : scene.walls) check_law(wall.law);
  if (!(scene.contact_time >= 0 && std::isfinite(scene.contact_time))) {
    throw std::invalid_argument(
        fmt::format("contact time: found {:g} s, allowed: 0 or more", scene.contact_time));
  }
  for (std::size_t k = 0; k < grains.size(); ++k) {
    const Body<D>& g = grains[k];
    if (!(g.radius > 0) || !g.position.allFinite() || !g.velocity.allFinite()) {
      throw std::invalid_argument(fmt::format(
          "grain {}: found radius {:g} m, allowed: above 0, with a finite place and velocity", k,
          g.radius));
    }
    for (const HardWall<D>& wall : scene.walls) {
      const double depth = g.radius - (g.position - wall.point).dot(wall.normal);
      if (depth <= kTouching * g.radius) continue;
      throw std::invalid_argument(
          fmt::format("grain {}: found {:g} m behind a wall, allowed: none", k, depth));
    }
  }
  check_box(scene.box, widest(grains));
  Cells<D> cells(scene.box, widest(grains), grains.size());
  for (std::size_t k = 0; k < grains.size(); ++k) {
    const VectorOf<D> place = inside(scene.box, grains[k].position);
    cells.near(cells.of(place), [&](std::int32_t other, const VectorOf<D>&) {
      const VectorOf<D> r = nearest_way(scene.box, grains[other].position, place);
      const double depth = grains[k].radius + grains[other].radius - r.norm();
      if (depth <= kTouching * grains[k].radius) return;
      throw std::invalid_argument(
          fmt::format("grains {} and {}: found an overlap of {:g} m at the start, allowed: none",
                      other, k, depth));
    });
    cells.put(static_cast<std::int32_t>(k), cells.of(place));
  }
}

template void check_scene(const HardScene<2>&, const std::vector<Body<2>>&);
template void check_scene(const HardScene<3>&, const std::vector<Body<3>>&);

}  // namespace grainfield::dem
