// The settled disk packings of data/, as engines. Law, parameters and time step as in their
// headers.
#pragma once
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include "dem/engine/engine.h"

namespace grainfield::benchmarks {

/// `tiles` copies side by side, every second one mirrored, so that grains at an inner wall meet
/// their mirror image.
inline std::unique_ptr<dem::Engine> packing_scene(const std::string& file, double width, int tiles,
                                                  int threads) {
  dem::EngineSettings settings;
  settings.law = dem::LinearLaw{2e7, 1e7, 4000, 2000};
  settings.integrator = dem::IntegratorKind::verlet;
  settings.time_step = 1e-5;
  settings.friction = 0.5;
  settings.threads = threads;
  auto engine = dem::make_engine(settings);
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.5});
  engine->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0.5});
  engine->add_wall({"right", {width * tiles, 0, 0}, {-1, 0, 0}, 0.5});
  for (int tile = 0; tile < tiles; ++tile) {
    std::ifstream in(file);
    if (!in) throw std::runtime_error("cannot read " + file);
    std::string line;
    while (std::getline(in, line)) {
      if (line.empty() || line[0] == '#' || line[0] == 'x') continue;
      for (char& c : line) c = c == ',' ? ' ' : c;
      std::istringstream fields(line);
      dem::NewGrain g;
      fields >> g.x >> g.y >> g.radius;
      g.x = width * tile + (tile % 2 == 0 ? g.x : width - g.x);
      g.density = 2500;
      engine->add(g);
    }
  }
  return engine;
}

}  // namespace grainfield::benchmarks
