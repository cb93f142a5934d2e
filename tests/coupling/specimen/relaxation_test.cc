// What the last relaxation of a pile changes: columns whose forces are known, and a pile.
#include "coupling/specimen/relaxation.h"

#include <gmock/gmock.h>

#include <cmath>

#include "coupling/studies/pile/simulation.h"
#include "tests/coupling/pile_scene.h"

namespace grainfield::coupling {
namespace {

using namespace dem;

// Grains of 1 kg one above the other on a floor, the lowest at 0.5 m; each carries what is above it
// but for `hidden` of a weight that the grain `missing` does not hand on. g = 10.
Snapshot column(int grains, double hidden, int missing) {
  Snapshot s;
  s.gravity = Vec3(0, -10, 0);
  s.walls.push_back({"floor", Vec3(0, 0, 0), Vec3(0, 1, 0), 0.5});
  for (int k = 0; k < grains; ++k) {
    Grain g;
    g.id = k;
    g.position = Vec3(0, 0.5 + k, 0);
    g.radius = 0.5;
    g.mass = 1;
    s.grains.push_back(g);
  }
  for (int k = 0; k < grains; ++k) {
    Contact c;
    const double carried = 10 * (grains - k - (k <= missing ? hidden : 0));
    if (k == 0) {
      c.i = 0;
      c.j = -1;
      c.force = Vec3(0, carried, 0);
    } else {
      c.i = k - 1;
      c.j = k;
      c.force = Vec3(0, -carried, 0);
    }
    s.contacts.push_back(c);
  }
  return s;
}

TEST(Relaxation, ColumnsWithAndWithoutWhatIsMissing) {
  const int n = 20;
  const Snapshot whole = column(n, 0, 0);
  for (const double level : {0.0, 0.7, 5.2, 18.6}) {
    EXPECT_NEAR(weight_carried_error(whole, level), 0, 1e-12) << level;
  }
  EXPECT_TRUE(std::isnan(weight_carried_error(whole, 19.6)));

  // Grain 12 keeps 0.4 of its weight for itself: seven grains above are in balance.
  const Snapshot asleep = column(n, 0.4, 12);
  EXPECT_NEAR(weight_carried_error(asleep, 0), -0.4 / 20, 1e-12);
  EXPECT_NEAR(weight_carried_error(asleep, 12.1), -0.4 / 8, 1e-12);
  EXPECT_NEAR(weight_carried_error(asleep, 12.7), 0, 1e-12);

  const Relaxation r = measure_relaxation(asleep, whole, 1);
  EXPECT_NEAR(r.base_before, 1 - 0.4 / 20, 1e-12);
  // Levels at tenths of 19.5 m: 11.7 m is the highest below grain 12 (at 12.5 m).
  EXPECT_NEAR(r.levels_before, 0.4 / 8, 1e-12);
  EXPECT_NEAR(r.levels_after, 0, 1e-12);
  EXPECT_NEAR(r.forces, 13 * 0.4 / (210 - 13 * 0.4), 1e-12);
  EXPECT_EQ(r.largest_displacement, 0);
}

TEST(Relaxation, WaysAndContactsThatOpen) {
  const Snapshot before = column(4, 0, 0);
  Snapshot after = before;
  after.grains[3].position += Vec3(0.3, 0.4, 0);
  after.contacts.pop_back();  // of 10 N
  const Relaxation r = measure_relaxation(before, after, 2);
  EXPECT_NEAR(r.largest_displacement, 0.25, 1e-12);
  EXPECT_NEAR(r.mean_displacement, 0.0625, 1e-12);
  EXPECT_NEAR(r.forces, 10.0 / 100, 1e-12);
}

TEST(Relaxation, OtherGrainsAreRefused) {
  Snapshot other = column(4, 0, 0);
  other.grains[2].id = 7;
  EXPECT_THROW(measure_relaxation(column(4, 0, 0), other, 1), std::invalid_argument);
  EXPECT_THROW(measure_relaxation(column(4, 0, 0), column(5, 0, 0), 1), std::invalid_argument);
}

TEST(Relaxation, OfAPileThatSlept) {
  PileSetup s = small_pile("point", "rand1");
  s.sleep.on = true;
  const auto run = make_pile_run(s, 3, 1);
  finish(*run);
  const auto figures = run->result().figures;
  EXPECT_NEAR(figures.at("relaxation.level_error_after"), 0, 2e-3);
  EXPECT_LT(std::fabs(figures.at("relaxation.base_weight_ratio_before") - 1),
            figures.at("relaxation.level_error_before") + 1e-12);
  EXPECT_GT(figures.at("relaxation.force_change"), 0);
  EXPECT_LT(figures.at("relaxation.mean_displacement"),
            figures.at("relaxation.largest_displacement"));
}

}  // namespace
}  // namespace grainfield::coupling
