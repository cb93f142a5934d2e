// Which integrators go with a shape.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "dem/engine/engine.h"
#include "dem/motion/runge_kutta3.h"
#include "dem/shapes/disk_store.h"
#include "dem/shapes/polygon_store.h"
#include "dem/shapes/sphere_store.h"
#include "dem/shapes/superellipsoid_store.h"

namespace grainfield::dem {
namespace {

std::vector<std::string> integrators_of(const ShapeKind& shape) {
  return shape.visit([]<class S>(S) {
    return words_where<AnyIntegrator>([]<class K>() { return Moves<K, typename S::Store>; });
  });
}

}  // namespace

void refuse_integrator(const EngineSettings& settings) {
  throw std::invalid_argument(
      fmt::format("motion.integrator: found \"{}\", allowed for grains of this shape ({}): {}",
                  settings.integrator.name(), settings.shape.name(),
                  fmt::join(integrators_of(settings.shape), ", ")));
}

void check_integrator(const EngineSettings& settings) {
  const auto words = integrators_of(settings.shape);
  if (std::find(words.begin(), words.end(), settings.integrator.name()) == words.end()) {
    refuse_integrator(settings);
  }
}

}  // namespace grainfield::dem
