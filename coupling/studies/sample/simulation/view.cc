#include "coupling/studies/sample/simulation/view.h"

#include "coupling/studies/sample/simulation/path.h"
#include "coupling/studies/sample/simulation/state.h"

namespace grainfield::dem {

Vec3 sample_edges(const SamplePlan& plan, const Engine& engine) {
  Vec3 edges = Vec3::Zero();
  if (is_periodic(plan)) {
    const Cell<3> cell = engine.cell();
    for (int a = 0; a < plan.dim; ++a) edges[a] = cell.edges(a, a);
    return edges;
  }
  const std::vector<Wall> walls = engine.walls();
  for (int a = 0; a < plan.dim; ++a) {
    const auto there = [&](std::size_t k) { return walls[k].point[a]; };
    const auto first = static_cast<std::size_t>(2 * a);  // box_walls: pairs, axis by axis
    edges[a] = there(first + 1) - there(first);
  }
  return edges;
}

Vec3 held_pressure(const SamplePlan& plan, const Engine& engine) {
  if (is_periodic(plan)) return -engine.cell_stress().total().diagonal();
  Snapshot walls;
  walls.dim = plan.dim;
  walls.walls = engine.walls();
  return sample_state(walls).moved_pressure;
}

double solid_fraction(const SamplePlan& plan, const Engine& engine, double solid_volume) {
  const Vec3 now = sample_edges(plan, engine);
  double volume = 1;
  for (int a = 0; a < plan.dim; ++a) volume *= now[a];
  return solid_volume / volume;
}

}  // namespace grainfield::dem
