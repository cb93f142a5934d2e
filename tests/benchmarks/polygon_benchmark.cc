// Cost of one pair in the narrow phase, over many different pairs so that branches are as hard to
// predict as in a packing: heptagons in contact, near (within a tenth of their radius, separated)
// with and without memory, beyond each other's circumcircle; a disk on a heptagon; a floor.
#include <benchmark/benchmark.h>

#include "tests/dem/polygon_scene.h"

namespace grainfield::dem {
namespace {

constexpr int kPairs = 4096;

struct Pairs {
  std::vector<Placed> owners;
  std::vector<std::pair<PlacedShape, PlacedShape>> shapes;
};

// Pairs whose distance is `gap` (in radii, random between low and high) from first touch; negative
// gaps overlap.
Pairs pairs_at(double low, double high, bool with_disk = false) {
  Random random(5);
  Pairs pairs;
  pairs.owners.reserve(2 * kPairs);
  for (int k = 0; k < kPairs; ++k) {
    const Placed a(random_outline(random, 7, 1, 1), 0, 0, random.uniform(0, 6));
    const Outline other = random_outline(random, 7, random.uniform(0.7, 1.3), 1);
    const double angle = random.uniform(0, 6), place = random.uniform(0, 2 * std::numbers::pi);
    const auto placed = [&](double distance) {
      const double x = distance * std::cos(place), y = distance * std::sin(place);
      return with_disk ? Placed::disk(1, x, y) : Placed(other, x, y, angle);
    };
    double touching = 0, apart = 5;
    for (int i = 0; i < 50; ++i) {
      const double middle = (touching + apart) / 2;
      (overlap_of(a, placed(middle)).area > 0 ? touching : apart) = middle;
    }
    pairs.owners.push_back(a);
    pairs.owners.push_back(placed(apart + random.uniform(low, high)));
  }
  for (int k = 0; k < kPairs; ++k) {
    pairs.shapes.emplace_back(pairs.owners[2 * k].shape(), pairs.owners[2 * k + 1].shape());
  }
  return pairs;
}

void run(benchmark::State& state, const Pairs& pairs, bool remember) {
  std::vector<PairFeature> features(kPairs);
  Overlap overlap;
  for (int k = 0; k < kPairs; ++k) {
    overlap_of_shapes(pairs.shapes[k].first, pairs.shapes[k].second, features[k], overlap);
  }
  int k = 0, found = 0;
  for (auto _ : state) {
    if (!remember) features[k].hint = 0;
    found += overlap_of_shapes(pairs.shapes[k].first, pairs.shapes[k].second, features[k], overlap);
    benchmark::DoNotOptimize(overlap);
    k = (k + 1) % kPairs;
  }
  state.counters["in_contact"] = found / static_cast<double>(state.iterations());
}

void heptagons_touching(benchmark::State& s) { run(s, pairs_at(-0.02, -0.001), true); }
void heptagons_near(benchmark::State& s) { run(s, pairs_at(0.001, 0.1), true); }
void heptagons_near_no_memory(benchmark::State& s) { run(s, pairs_at(0.001, 0.1), false); }
void heptagons_far(benchmark::State& s) { run(s, pairs_at(1, 2), true); }
void disk_on_heptagon(benchmark::State& s) { run(s, pairs_at(-0.02, -0.001, true), true); }
void disk_near_heptagon(benchmark::State& s) { run(s, pairs_at(0.001, 0.1, true), true); }

void heptagon_on_half_plane(benchmark::State& state) {
  const Pairs pairs = pairs_at(0, 1);
  Overlap overlap;
  int k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        overlap_with_half_plane(pairs.shapes[k].first, 0, -0.9, 0, 1, overlap));
    benchmark::DoNotOptimize(overlap);
    k = (k + 1) % kPairs;
  }
}

BENCHMARK(heptagons_touching);
BENCHMARK(heptagons_near);
BENCHMARK(heptagons_near_no_memory);
BENCHMARK(heptagons_far);
BENCHMARK(disk_on_heptagon);
BENCHMARK(disk_near_heptagon);
BENCHMARK(heptagon_on_half_plane);

}  // namespace
}  // namespace grainfield::dem
