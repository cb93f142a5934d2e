#include "coupling/studies/sample/simulation/state.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "dem/snapshot/cell_stress.h"

namespace grainfield::dem {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const Wall& wall_named(const Snapshot& s, const std::string& name) {
  for (const Wall& wall : s.walls) {
    if (wall.name == name) return wall;
  }
  throw std::invalid_argument(
      fmt::format("found a sample without the wall \"{}\", allowed: one between the walls of a "
                  "box, or periodic along every axis",
                  name));
}

// The box between its walls: floor and lid are level, left and right parallel.
void measure_box(const Snapshot& s, SampleState& state) {
  const int last = s.dim - 1;
  const Wall &left = wall_named(s, "left"), &right = wall_named(s, "right");
  const Wall &floor = wall_named(s, "floor"), &lid = wall_named(s, "lid");
  const double height = lid.point[last] - floor.point[last];
  const double width = left.normal.dot(right.point - left.point) / left.normal.x();
  double depth = 1;
  state.edges(0, 0) = width;
  // Along the left wall from floor to lid.
  state.edges(0, last) = -left.normal[last] / left.normal.x() * height;
  state.edges(last, last) = height;
  state.volume = width * height;
  const auto put_pressure = [&](int axis, const Wall& fixed, const Wall& moved, double area) {
    const double there = -fixed.force.dot(fixed.normal) / area;
    state.moved_pressure[axis] = -moved.force.dot(moved.normal) / area;
    state.wall_pressure[axis] = 0.5 * (there + state.moved_pressure[axis]);
  };
  if (s.dim == 3) {
    const Wall &front = wall_named(s, "front"), &back = wall_named(s, "back");
    depth = back.point.y() - front.point.y();
    state.edges(1, 1) = depth;
    state.volume *= depth;
    put_pressure(1, front, back, width * height);
  }
  // A tilted side is longer than the box is high.
  put_pressure(0, left, right, depth * height / std::fabs(left.normal.x()));
  put_pressure(last, floor, lid, width * depth);
  state.lid_shear = lid.force.x() / (width * depth);
}

}  // namespace

SampleState sample_state(const Snapshot& s) {
  SampleState state;
  if (s.cell.is_periodic()) {
    state.edges = s.cell.edges;
    state.volume = cell_volume(s.cell, s.dim);
    const CellStress stress = cell_stress(s);
    state.stress = stress.total();
    state.contact_stress = stress.contacts;
    state.wall_pressure = state.moved_pressure = Vec3::Constant(kNan);
    state.lid_shear = kNan;
  } else {
    measure_box(s, state);
    for (const Contact& c : s.contacts) {
      const Vec3 end = c.j < 0 ? c.point : s.grains[static_cast<std::size_t>(c.j)].position;
      const Vec3 branch = end - s.grains[static_cast<std::size_t>(c.i)].position;
      state.contact_stress += c.force * branch.transpose() / state.volume;
    }
    state.stress = state.contact_stress;
    for (const Grain& g : s.grains) {
      state.stress -= g.mass / state.volume * g.velocity * g.velocity.transpose();
    }
  }
  double solid = 0;
  for (const Grain& g : s.grains) solid += g.volume;
  state.solid_fraction = solid / state.volume;
  return state;
}

}  // namespace grainfield::dem
