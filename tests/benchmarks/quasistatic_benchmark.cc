// A small load on a settled layer of spheres by Newton's method: 1,728 and 8,000 spheres, six
// unknowns each. The layers settle first, which takes minutes. GRAINFIELD_LAYER = FILE.h5:GROUP, a
// layer at rest of a run of point-load-3d, is loaded too, by a tenth of a sphere's weight
// (GRAINFIELD_YOUNG: its material.young, default 2e7; GRAINFIELD_COPIES: so many of it beside each
// other along x and as many along y, default 1).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "coupling/studies/point_load/layer_probe.h"
#include "dem/engine/engine.h"
#include "dem/quasistatic/quasistatic.h"
#include "dem/random/random.h"

namespace grainfield::benchmarks {
namespace {

constexpr double kRadius = 0.005, kGravity = 9.81;

dem::EngineSettings hertz_settings(double width) {
  dem::EngineSettings e;
  e.shape = dem::ShapeKind::sphere;
  e.law = dem::HertzLaw{5e6, 0.3, 0.3};
  e.friction = 0.5;
  e.integrator = dem::IntegratorKind::verlet;
  e.time_step = 2e-5;
  e.gravity_y = 0;
  e.gravity_z = -kGravity;
  e.threads = 2;
  e.cell.periodic = {true, true, false};
  e.cell.edges = dem::Vec3(width, width, 1).asDiagonal();
  return e;
}

/// side^3 poly-disperse spheres on a floor, periodic sideways, settled until the mean resultant is
/// 1e-5 of the mean contact force.
dem::Snapshot settled_layer(int side, const dem::EngineSettings& settings, double cell) {
  const auto engine = dem::make_engine(settings);
  engine->add_wall({"floor", {0, 0, 0}, {0, 0, 1}, 0.5});
  dem::Random random(3);
  for (int k = 0; k < side * side * side; ++k) {
    const auto at = [&](int n) { return cell * (n + 0.5 + 0.05 * random.uniform(-1, 1)); };
    dem::NewGrain g;
    g.x = at(k % side);
    g.y = at(k / side % side);
    g.z = at(k / (side * side));
    g.radius = kRadius * random.uniform(0.85, 1.1);
    g.density = 2500;
    engine->add(g);
  }
  constexpr int kMostParts = 400;
  for (int k = 0; k < kMostParts; ++k) {
    engine->set_background_damping(k < 10 ? 5 : k < 30 ? 15 : 40);
    engine->step(500);
    const dem::Diagnostics d = engine->measure();
    if (d.unbalanced_force_ratio < 1e-5 && d.unbalanced_moment_ratio < 1e-5) break;
  }
  return engine->snapshot();
}

void load(benchmark::State& state, const dem::Snapshot& layer, const dem::EngineSettings& settings,
          double ratio) {
  dem::AppliedForce force;
  double top = 0;
  for (const dem::Grain& g : layer.grains) {
    if (g.position.z() <= top) continue;
    top = g.position.z();
    force.id = g.id;
  }
  force.fz = -1e-3;
  dem::QuasistaticSettings how;
  how.unbalanced_force_ratio = ratio;
  const dem::Vec3 gravity(0, 0, -kGravity);
  int iterations = 0;
  for (auto _ : state) {
    const auto out = dem::relax(layer, settings, gravity, force, how);
    iterations = out.iterations;
    benchmark::DoNotOptimize(out.unbalanced_force_ratio);
  }
  state.counters["unknowns"] = 6.0 * static_cast<double>(layer.grains.size());
  state.counters["newton_iterations"] = iterations;
}

void small_load_on_spheres(benchmark::State& state) {
  const auto side = static_cast<int>(state.range(0));
  const double cell = 2.25 * kRadius;
  const dem::EngineSettings settings = hertz_settings(side * cell);
  static std::map<int, dem::Snapshot> layers;
  if (layers.count(side) == 0) layers[side] = settled_layer(side, settings, cell);
  load(state, layers[side], settings, 1e-5);
}
BENCHMARK(small_load_on_spheres)->Arg(12)->Arg(20)->Unit(benchmark::kSecond)->Iterations(1);

// The layer, periodic along x and y, n by n times beside itself: at rest as it was.
dem::Snapshot copied(const dem::Snapshot& layer, int n) {
  dem::Snapshot out = layer;
  out.grains.clear();
  out.contacts.clear();
  const auto count = static_cast<std::int64_t>(layer.grains.size());
  const auto place = [n](int k) { return (k % n + n) % n; };
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const std::int64_t first = (y * n + x) * count;
      for (dem::Grain g : layer.grains) {
        g.id += (y * n + x) * (layer.grains.back().id + 1);
        g.position += layer.cell.edges * dem::Vec3(x, y, 0);
        out.grains.push_back(g);
      }
      for (dem::Contact c : layer.contacts) {
        c.i += first;
        c.point += layer.cell.edges * dem::Vec3(x, y, 0);
        if (c.j >= 0) {
          const int to_x = x + c.image[0], to_y = y + c.image[1];
          c.j += (place(to_y) * n + place(to_x)) * count;
          c.image = {(to_x - place(to_x)) / n, (to_y - place(to_y)) / n, 0};
          if (c.j < c.i) {
            std::swap(c.i, c.j);
            for (int& k : c.image) k = -k;
            for (dem::Vec3* v : {&c.normal, &c.force, &c.spring_vector, &c.rolling_spring})
              *v = -*v;
          }
        }
        out.contacts.push_back(c);
      }
    }
  }
  std::sort(out.contacts.begin(), out.contacts.end(),
            [](const auto& a, const auto& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
  out.cell.edges.leftCols<2>() *= n;
  return out;
}

// The layer of GRAINFIELD_LAYER, FILE:GROUP, and GRAINFIELD_COPIES by as many, with spheres as
// point-load-3d has them; none where it is not set.
struct RunLayer {
  dem::Snapshot layer;
  dem::EngineSettings settings;
};
std::optional<RunLayer> layer_of_a_run(benchmark::State& state) {
  const char* place = std::getenv("GRAINFIELD_LAYER");
  if (place == nullptr) {
    state.SkipWithError("GRAINFIELD_LAYER: not set");
    return std::nullopt;
  }
  const std::string text = place;
  const std::size_t colon = text.rfind(':');
  const char* copies = std::getenv("GRAINFIELD_COPIES");
  RunLayer out{copied(dem::read_snapshot(text.substr(0, colon), text.substr(colon + 1)),
                      copies == nullptr ? 1 : std::stoi(copies)),
               hertz_settings(1)};
  const char* young = std::getenv("GRAINFIELD_YOUNG");
  out.settings.law = dem::HertzLaw{young == nullptr ? 2e7 : std::stod(young), 0.3, 0.3};
  out.settings.cell = out.layer.cell;
  return out;
}

void small_load_on_a_layer_of_a_run(benchmark::State& state) {
  const auto run = layer_of_a_run(state);
  if (run) load(state, run->layer, run->settings, 1e-8);
}
BENCHMARK(small_load_on_a_layer_of_a_run)->Unit(benchmark::kSecond)->Iterations(1);

// The rest before the strains of 1e-6 (settle_s), and four of the twelve (strain_s: the mean). Its
// surface is taken for that of its highest sphere.
void strains_of_a_layer_of_a_run(benchmark::State& state) {
  const auto run = layer_of_a_run(state);
  if (!run) return;
  double height = 0;
  for (const dem::Grain& g : run->layer.grains)
    height = std::max(height, g.position.z() + g.radius);
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto since = [&](auto start) {
    return std::chrono::duration<double>(now() - start).count();
  };
  constexpr int kStrains = 4;
  for (auto _ : state) {
    dem::LayerProber prober(run->layer, run->settings, height, 1e-6);
    const auto start = now();
    prober.settle(nullptr);
    state.counters["settle_s"] = since(start);
    const auto settled = now();
    for (int k = 0; k < kStrains; ++k) benchmark::DoNotOptimize(prober.probe(k, nullptr));
    state.counters["strain_s"] = since(settled) / kStrains;
  }
}
BENCHMARK(strains_of_a_layer_of_a_run)->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
}  // namespace grainfield::benchmarks
