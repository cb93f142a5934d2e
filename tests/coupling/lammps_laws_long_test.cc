// Ten thousand spheres from LAMMPS: the first step, and the stress 10,000 steps later against the
// spread of LAMMPS' own runs from places shaken by 1e-8 m, a hundredth of a usual depth. By hand:
// ctest --preset long.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "lammps_scene.h"

namespace grainfield::coupling::lammps {
namespace {

void compare(const char* name, const Law& law) {
  const Scene scene(law, 0.226, 25);
  std::vector<long long> ids;
  const End first = scene.go_on(1e-12, 1);
  const dem::Snapshot start = scene.start(ids);
  double largest = 0, worst = 0;
  for (const dem::Contact& c : start.contacts) largest = std::max(largest, c.force.norm());
  auto engine = scene.engine(start, 1e-12);
  engine->step(1);
  const std::vector<Vec3> forces = forces_of(engine->snapshot());
  for (std::size_t g = 0; g < ids.size(); ++g)
    worst = std::max(worst, (forces[g] - first.loads.at(ids[g]).first).norm());
  std::printf(
      "%s: %zu spheres, %zu contacts; first step: largest difference %.2g of the largest "
      "force\n",
      name, ids.size(), start.contacts.size(), worst / largest);
  EXPECT_GT(ids.size(), 9500U);
  EXPECT_LT(worst / largest, 1e-10);

  const End theirs = scene.go_on(1e-5, 10000);
  engine = scene.engine(start, 1e-5);
  engine->step(10000);
  const Vec3 ours = stress_of(engine->snapshot());
  Vec3 spread(0, 0, 0);
  for (int seed = 1; seed <= 4; ++seed) {
    const End shaken = scene.go_on(1e-5, 10000, 1e-8, seed);
    spread = spread.cwiseMax((shaken.stress - theirs.stress).cwiseAbs());
  }
  const Vec3 off = (ours - theirs.stress).cwiseAbs();
  for (int a = 0; a < 3; ++a) {
    std::printf(
        "  after 10,000 steps, stress %c%c: theirs %.9g N m, difference %.3g, spread of four "
        "shaken runs %.3g\n",
        "xyz"[a], "xyz"[a], theirs.stress[a], off[a], spread[a]);
    EXPECT_LE(off[a], spread[a]);
  }
}

TEST(LammpsTenThousand, HertzHistory) {
  if (!is_there()) GTEST_SKIP() << "lmp not found: the Debian package lammps has it";
  compare("gran/hertz/history", hertz_history());
}
TEST(LammpsTenThousand, GranularWithRolling) {
  if (!is_there()) GTEST_SKIP() << "lmp not found: the Debian package lammps has it";
  compare("granular, mindlin_rescale/force, rolling sds", granular("mindlin_rescale/force"));
}

}  // namespace
}  // namespace grainfield::coupling::lammps
