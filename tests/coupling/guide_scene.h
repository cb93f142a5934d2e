// The tables of heaps that docs/guide.md and docs/steps.md describe.
#pragma once
#include <numbers>
#include <string>

#include "continuum/closed/osl.h"
#include "import_scene.h"
#include "program.h"
#include "stressed_heap.h"

namespace grainfield::test {

inline const std::string kDocs = std::string(GRAINFIELD_CASES) + "/../docs/";

/// grains1.csv, contacts1.csv ... of heaps that carry the stress of OSL but for noise, and
/// walls.csv.
inline void write_heaps(const coupling::testing::Folder& folder, int count) {
  const auto field =
      continuum::osl_field(28 * std::numbers::pi / 180, {0.74, -0.31}, lattice_rho_g());
  for (int k = 1; k <= count; ++k) {
    StressedHeap setup;
    setup.floor = 0.3;
    setup.apex_x = 1.7;
    setup.noise = 0.2;
    setup.seed = static_cast<std::uint64_t>(k);
    const dem::Snapshot heap =
        stressed_heap(setup, [&](double x, double y) { return field.stress(x, y); });
    folder.write("grains" + std::to_string(k) + ".csv", csv_grains(heap));
    folder.write("contacts" + std::to_string(k) + ".csv", csv_contacts(heap));
    folder.write("walls.csv", csv_walls(heap));
  }
}

}  // namespace grainfield::test
