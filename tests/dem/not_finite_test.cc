// The first number that is not finite ends a run. The settings go round the ranges of the keys.
#include <gmock/gmock.h>

#include "tests/dem/pile_scene.h"

namespace grainfield::dem {
namespace {
void show(const char* what, const std::function<std::unique_ptr<Run>()>& make) {
  try {
    const auto run = make();
    for (int k = 0; k < 6; ++k) {
      const Progress p = run->progress();
      std::printf("%s %ld t=%g E=%g r=%g f=%g\n", what, p.steps, p.simulated_time, p.kinetic_energy, p.unbalanced_force_ratio, p.fraction);
      run->advance(500);
    }
  } catch (const std::exception& e) {
    std::printf("%s: %s\n", what, e.what());
  }
}
TEST(NotFinite, Explore) {
  PointLoadSetup b;
  b.packing.kind = "triangular"; b.packing.sizes = "mono"; b.packing.columns = 8; b.packing.rows = 4; b.load.force = 5;
  auto with = [&](const char* what, auto change) { PointLoadSetup s = b; change(s); show(what, [&] { return make_point_load_run(s, 3, 1); }); };
  with("dt", [](auto& s) { s.motion.time_step = 1e-300; });
  with("ramp", [](auto& s) { s.load.ramp_time = 1e300; });
  with("radius-100", [](auto& s) { s.packing.radius = 1e-100; });
  with("radius-200", [](auto& s) { s.packing.radius = 1e-200; });
  with("radius100", [](auto& s) { s.packing.radius = 1e100; });
  with("damping", [](auto& s) { s.material.damping = 1e6; });
  with("damping300", [](auto& s) { s.material.damping = 1e300; });
  with("young", [](auto& s) { s.material.young = 1e300; });
  with("density", [](auto& s) { s.material.density = 1e-300; });
  with("density", [](auto& s) { s.material.density = 1e300; });
  with("bg", [](auto& s) { s.rest.background_damping = 1e300; });
  with("gravity", [](auto& s) { s.material.gravity = 1e300; });
  with("gravity", [](auto& s) { s.material.gravity = 1e-300; });
  with("friction", [](auto& s) { s.material.friction = 1e300; });
  with("force", [](auto& s) { s.load.force = 1e300; });
  with("gear damping", [](auto& s) { s.motion.integrator = "gear"; s.material.damping = 1e6; });
  PileSetup p = small_pile("point", "disk");
  auto pile = [&](const char* what, auto change) { PileSetup s = p; change(s); show(what, [&] { return make_pile_run(s, 3, 1); }); };
  pile("p radius", [](auto& s) { s.shape.radius = 1e-100; s.floor.length = 1e-98; });
  pile("p damping", [](auto& s) { s.material.damping = 1e6; });
  pile("p dt", [](auto& s) { s.motion.time_step = 1e-300; });
  pile("p interval", [](auto& s) { s.source.interval = 1e6; });
}
}  // namespace
}  // namespace grainfield::dem
