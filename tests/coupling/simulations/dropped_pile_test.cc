// Piles whose source rises with them (source.above), and lattice piles with a bend.
#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

#include "coupling/studies/pile/simulation.h"
#include "dem/grains/lattice_pile.h"
#include "tests/coupling/finished_run.h"

namespace grainfield::dem {
namespace {

using testing::HasSubstr;

// The source's pile in small: frictionless on each other, held by the floor.
PileSetup dropped(int grains) {
  PileSetup s = small_pile("point", "disk");
  s.shape.polydispersity = 0;
  s.floor.kind = "smooth";
  s.source.grains = grains;
  s.source.above = 2;
  s.source.speed = 0;
  s.source.interval = 0.3;
  s.source.height = 0.01;  // has no say
  s.material.law = "linear";
  s.material.normal_stiffness = 2e7;
  s.material.tangential_stiffness = 5e6;
  s.material.normal_damping = 1000;
  s.material.friction = 0;
  s.material.floor_friction = 1;
  s.material.rolling_friction = 1;
  s.material.rolling_stiffness = 1e6;
  s.material.rolling_damping = 50;
  return s;
}

// The first grain falls two diameters, whatever source.height says.
TEST(DroppedPile, GrainsFallFromSoManyDiametersAboveTheTop) {
  const PileSetup s = dropped(3);
  const auto run = make_pile_run(s, 1, 1);
  const double d = 2 * s.shape.radius, g = s.material.gravity;
  const double weight = s.material.density * std::acos(-1.0) * s.shape.radius * s.shape.radius * g;
  double most = 0;
  while (run->progress().simulated_time < 0.9 * s.source.interval) {
    run->advance(1);
    most = std::max(most, run->progress().kinetic_energy);
  }
  EXPECT_NEAR(most, weight * s.source.above * d, 0.01 * weight * d);
  // The second one from as much above the first: three diameters above the floor, less than that
  // down to it.
  most = 0;
  while (run->progress().simulated_time < 1.9 * s.source.interval) {
    run->advance(1);
    most = std::max(most, run->progress().kinetic_energy);
  }
  EXPECT_GT(most, 0.98 * weight * s.source.above * d);
  EXPECT_LT(most, weight * (s.source.above + 1) * d);
}

TEST(DroppedPile, RestsOnTheFloorsFrictionAlone) {
  const PileSetup s = dropped(40);
  const RunResult r = finished(make_pile_run(s, 3, 1));
  EXPECT_EQ(r.figures.at("dem.grains"), 40);
  EXPECT_NEAR(r.figures.at("base.weight_ratio"), 1, 1e-3);
  EXPECT_GT(r.figures.at("pile.height"), 4 * s.shape.radius);
  const Snapshot& pile = r.snapshots[0].second;
  double held = 0;
  for (const Contact& c : pile.contacts) {
    if (c.j >= 0) {
      EXPECT_NEAR(c.tangential_force, 0, 1e-9 * c.normal_force);
    } else {
      held = std::max(held, std::fabs(c.tangential_force) / c.normal_force);
    }
  }
  EXPECT_GT(held, 0.1);
  EXPECT_LE(held, 1 + 1e-9);
}

TEST(DroppedPile, ResumesToTheSameBitsOnAnyNumberOfThreads) {
  const PileSetup s = dropped(12);
  const FileOfRun file("dropped");
  const auto whole = make_pile_run(s, 9, 1);
  long total = 0;
  for (; !whole->done(); total += 500) whole->advance(500);
  for (const double share : {0.23, 0.41, 0.77}) {
    {
      const auto first = make_pile_run(s, 9, 2);
      first->advance(static_cast<long>(share * static_cast<double>(total)));
      first->save(file.path());
    }
    const auto second = make_pile_run(s, 9, 3);
    second->restore(file.path());
    expect_same(finished(second), whole->result(), std::to_string(share));
  }
}

TEST(DroppedPile, RefusesAFunnelThatWouldRise) {
  const auto refusal = [](const PileSetup& setup) -> std::string {
    try {
      make_pile_run(setup, 1, 1);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "accepted";
  };
  PileSetup s = dropped(12);
  s.source.above = 2;
  s.material.rolling_friction = 0;
  s.source.opening = 0.3;
  EXPECT_THAT(refusal(s), HasSubstr("source.above: found 2, allowed: 0 with a funnel of plates"));
}

// A bend in the outline: below it the rows are the triangle's of the lower slope; above it they
// shrink by the upper one's; the areas follow.
TEST(LatticePile, TentsBendWhereTheyAreToldTo) {
  LatticeSetup s;
  s.base_grains = 201;
  s.slope_deg = 30;
  const std::vector<int> plain = lattice_rows(s);
  s.top_slope_deg = 45;
  s.bend = 0.38;
  const std::vector<int> tent = lattice_rows(s);
  const double row = std::sqrt(3.0) / 2, bend = 0.38 * 200 * std::tan(std::acos(-1.0) / 6);
  const auto below = static_cast<std::size_t>(bend / row);
  for (std::size_t j = 0; j <= below; ++j) EXPECT_EQ(tent[j], plain[j]) << j;
  const double height = bend + 0.12 * 200;  // at 45 degrees
  EXPECT_NEAR(static_cast<double>(tent.size() - 1) * row, height, 2 * row);
  // Area under the outline over that of a disk's cell; half the lowest row lies below it.
  const double area = 0.38 * 200 * bend + 0.24 * 200 * bend + 0.12 * 200 * (height - bend);
  EXPECT_NEAR(std::accumulate(tent.begin(), tent.end(), 0.0), area / row + 100, 0.01 * area / row);
  s.top_slope_deg = 30;
  EXPECT_EQ(lattice_rows(s), plain);
  s.top_slope_deg = 61;
  EXPECT_THROW(check_lattice(s), std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::dem
