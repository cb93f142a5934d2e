// Liffman's piles in full size: 45 disks on the base, both laws.
#include <gtest/gtest.h>

#include "coupling/studies/lattice_pile/simulation.h"
#include "tests/coupling/lattice_pile_scene.h"

namespace grainfield::dem {
namespace {

// "Base forces N and H within 1 % of the closed forms", from disks as hard as m g/(K d) = 1e-6
// (overlaps of 5e-5 radii) with the linear law. The gap in the rows is 5e-4 diameters and raises H
// by 4/3 of that. Overlaps by the overlap-area law are larger (8e-4 radii at m g/(E d) = 1e-6): so
// is the gap.
TEST(LatticePileFullSize, BaseForcesWithinOnePercent) {
  for (const double slope : {60.0, 55.0, 50.0, 45.0, 32.6, 30.0}) {
    const LatticePileSetup linear = pile_of(45, slope, 1e-6, "linear");
    const BaseErrors a = base_errors(linear, at_rest(linear));
    EXPECT_LT(a.normal, 0.01) << slope;
    EXPECT_LT(a.horizontal, 0.01) << slope;
    EXPECT_EQ(a.row_contacts, 0) << slope;
    EXPECT_NEAR(a.weight_ratio, 1, 1e-6);
  }
  LatticePileSetup area = pile_of(45, 60, 1e-6, "overlap_area");
  area.lattice.gap = 2e-3;
  const BaseErrors b = base_errors(area, at_rest(area));
  EXPECT_LT(b.normal, 0.01);
  EXPECT_LT(b.horizontal, 0.01);
  EXPECT_EQ(b.row_contacts, 0);
}

// Where neighbours of a row touch, slopes below 60 degrees press them together, and the base forces
// leave the lattice lines by far (Liffman figs 13 to 16); the equilateral pile's rows part.
TEST(LatticePileFullSize, TouchingRowsCarryForceBelowSixtyDegrees) {
  LatticePileSetup s = pile_of(45, 45, 1e-6, "linear");
  s.lattice.gap = 0;
  const BaseErrors touching = base_errors(s, at_rest(s));
  EXPECT_GT(touching.row_contacts, 50);
  EXPECT_GT(touching.horizontal, 0.1);
  s.lattice.slope_deg = 60;
  const BaseErrors equilateral = base_errors(s, at_rest(s));
  EXPECT_EQ(equilateral.row_contacts, 0);
  EXPECT_LT(equilateral.horizontal, 1e-3);
}

// The source's own softness, at the slopes of its figures 13 to 16.
TEST(LatticePileFullSize, SoRowsDoAtTheSourcesSoftness) {
  for (const double slope : {30.0, 50.0, 55.0}) {
    LatticePileSetup s = pile_of(45, slope, 1e-4, "linear");
    s.lattice.gap = 0;
    const BaseErrors touching = base_errors(s, at_rest(s));
    EXPECT_GT(touching.row_contacts, 100) << slope;
    EXPECT_GT(touching.horizontal, 0.2) << slope;
    EXPECT_NEAR(touching.weight_ratio, 1, 1e-6) << slope;
  }
}

}  // namespace
}  // namespace grainfield::dem
