// Settled spheres in a box: the same packing for this engine and, as a file, for LAMMPS
// (against_lammps.sh).
#pragma once
#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "dem/engine/engine.h"
#include "dem/random/random.h"

namespace grainfield::benchmarks {

/// Laws of against_lammps.sh; every grain awake. Hertz' with what LAMMPS' gran/hertz/history has.
inline dem::EngineSettings sphere_settings(bool hertz, int threads) {
  dem::EngineSettings s;
  s.shape = dem::ShapeKind::sphere;
  if (hertz) {
    dem::HertzLaw law{1e7, 0.3, 0};
    law.displacement = law.viscoelastic = true;
    law.normal_damping = 4e6;
    law.tangential_damping = 2e6;
    s.law = law;
  } else {
    s.law = dem::LinearLaw{1e5, 3e4, 2000, 1000};
  }
  s.integrator = dem::IntegratorKind::verlet;
  s.friction = 0.5;
  s.time_step = 1e-5;
  s.gravity_x = s.gravity_y = 0;
  s.gravity_z = -9.81;
  s.threads = threads;
  return s;
}

inline constexpr double kSphereBox = 0.2;  ///< width of the box along x and y, m

inline void add_sphere_box(dem::Engine& engine) {
  engine.add_wall({"floor", {0, 0, 0}, {0, 0, 1}, 0.5});
  engine.add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0.5});
  engine.add_wall({"right", {kSphereBox, 0, 0}, {-1, 0, 0}, 0.5});
  engine.add_wall({"front", {0, 0, 0}, {0, 1, 0}, 0.5});
  engine.add_wall({"back", {0, kSphereBox, 0}, {0, -1, 0}, 0.5});
}

/// 10,000 spheres of 3.5 to 4.5 mm, dropped from a grid and damped for 0.15 s, with their springs.
inline dem::Snapshot settled_spheres(bool hertz) {
  constexpr int kSpheres = 10000, kColumns = 22;
  const double cell = kSphereBox / kColumns;
  const auto engine = dem::make_engine(sphere_settings(hertz, 2));
  add_sphere_box(*engine);
  dem::Random random(1);
  for (int k = 0; k < kSpheres; ++k) {
    dem::NewGrain g;
    g.radius = 0.0035 + 0.001 * random.uniform();
    const auto at = [&](int n) { return (n + 0.5) * cell + (random.uniform() - 0.5) * 1e-4; };
    g.x = at(k % kColumns);
    g.y = at(k / kColumns % kColumns);
    g.z = at(k / (kColumns * kColumns));
    g.density = 2500;
    engine->add(g);
  }
  engine->set_background_damping(10);
  engine->step(15000);
  return engine->snapshot();
}

/// That packing; from the file GRAINFIELD_SPHERES of the environment (Hertz' with "_hertz" added)
/// where there is one, which otherwise is written: settling takes longer than measuring.
inline dem::Snapshot find_spheres(bool hertz) {
  const char* given = std::getenv("GRAINFIELD_SPHERES");
  if (given == nullptr) return settled_spheres(hertz);
  const std::string file = given + std::string(hertz ? "_hertz" : "");
  if (std::ifstream(file).good()) return dem::read_snapshot(file, "/spheres");
  const dem::Snapshot settled = settled_spheres(hertz);
  dem::write_snapshot(file, "/spheres", settled);
  std::ofstream table(file + ".csv");
  for (const dem::Grain& g : settled.grains)
    table << fmt::format("{},{},{},{}\n", g.position.x(), g.position.y(), g.position.z(), g.radius);
  if (!table.flush()) throw std::runtime_error("cannot write " + file + ".csv");
  return settled;
}
inline const dem::Snapshot& sphere_packing(bool hertz) {
  static std::map<bool, dem::Snapshot> packings;
  const auto found = packings.find(hertz);
  if (found != packings.end()) return found->second;
  return packings[hertz] = find_spheres(hertz);
}

inline std::unique_ptr<dem::Engine> sphere_scene(bool hertz, int threads) {
  return dem::make_engine(sphere_settings(hertz, threads), sphere_packing(hertz));
}

}  // namespace grainfield::benchmarks
