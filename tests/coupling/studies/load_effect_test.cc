// Whether a load rearranges grains: by the loaded grain, and by all contacts.
#include "coupling/studies/point_load/load_effect.h"

#include <gmock/gmock.h>

#include <stdexcept>

namespace grainfield::coupling {
namespace {

using ::testing::HasSubstr;

dem::Snapshot row_of_disks() {
  dem::Snapshot out;
  out.grains.resize(3);
  for (int k = 0; k < 3; ++k) {
    out.grains[k].id = 10 + k;
    out.grains[k].radius = 0.01 * (1 + k);
    out.grains[k].position.x() = 0.1 * k;
  }
  return out;
}

TEST(LoadEffect, OnlyGrainsThatCarryTheLoadCount) {
  const dem::Snapshot before = row_of_disks();
  dem::Snapshot after = before;
  after.loaded_grain = 11;
  after.grains[0].position.y() = -1;
  after.grains[1].position.y() = -0.03;
  after.grains[2].position.y() = -0.06;
  EXPECT_DOUBLE_EQ(pushed_over_radius(before, after), 1.5);
  after.also_loaded = {12};
  EXPECT_DOUBLE_EQ(pushed_over_radius(before, after), 2);
  after.grains.pop_back();
  EXPECT_THROW(pushed_over_radius(before, after), std::invalid_argument);
}

// In a layer of 30,000 spheres 40 of 90,000 contacts change, and the loaded sphere of one layer
// falls through it.
TEST(LoadEffect, ASpherePushedThroughALargeLayerIsADoubt) {
  LoadEffect effect{0.25, 0.6, 40, 90000, {0.02, 0.03, 2.34, 0.02}};
  EXPECT_EQ(
      rearrangement_doubt(effect, "load.weights"),
      "The load of 0.25 N moves a loaded grain by more than 0.5 radii in 1 of 4 layers, by up "
      "to 2.3: grains rearrange, so the models do not apply. Lower load.weights.");
  // What moves is a loose grain somewhere.
  effect.pushed[2] = 0.03;
  EXPECT_EQ(rearrangement_doubt(effect, "load.weights"), "");
  // Grains beside the loaded one move, with many contacts.
  effect.changed = 5000;
  EXPECT_THAT(rearrangement_doubt(effect, "load.force"),
              HasSubstr("moves a grain by 0.6 radii, and changes 5000 contacts of 90000: grains "
                        "rearrange, so the models do not apply. Lower load.force."));
  effect.moved = 0.1;
  EXPECT_EQ(rearrangement_doubt(effect, "load.force"), "");
}

}  // namespace
}  // namespace grainfield::coupling
