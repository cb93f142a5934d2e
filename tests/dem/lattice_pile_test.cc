// Lattice piles: their rows, and the forces on the base against Liffman's closed forms.
#include "dem/packing/lattice_pile.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

namespace grainfield::dem {
namespace {

using testing::HasSubstr;

LatticeSetup lattice(int base, double slope, double gap = 5e-4) {
  LatticeSetup s;
  s.base_grains = base;
  s.slope_deg = slope;
  s.gap = gap;
  return s;
}

int total(const std::vector<int>& rows) { return std::accumulate(rows.begin(), rows.end(), 0); }

// Liffman's piles: 1035 disks in 45 layers, 360 and 5490 at 30 degrees.
TEST(LatticePile, HasLiffmansNumbersOfDisks) {
  EXPECT_EQ(lattice_rows(lattice(45, 60)).size(), 45U);
  EXPECT_EQ(total(lattice_rows(lattice(45, 60))), 1035);
  EXPECT_EQ(total(lattice_rows(lattice(45, 30))), 360);
  EXPECT_EQ(total(lattice_rows(lattice(180, 30))), 5490);
  EXPECT_THAT(lattice_rows(lattice(1, 17)), testing::ElementsAre(1));
}

// Every disk stands on two of the row below, touches both and no other, and lies under the slope;
// one more disk at either end of a row would not.
TEST(LatticePile, DisksStandOnTwoAndFollowTheSlope) {
  for (const double slope : {12.0, 30.0, 32.6, 45.0, 50.0, 55.0, 59.9, 60.0}) {
    for (const double gap : {0.0, 1e-3, 0.1}) {
      const LatticeSetup s = lattice(31, slope, gap);
      const auto rows = lattice_rows(s);
      const auto grains = lattice_pile_grains(s, 5000);
      ASSERT_EQ(static_cast<int>(grains.size()), total(rows));
      const double d = 2 * s.radius, cotangent = 1 / std::tan(slope * std::acos(-1.0) / 180);
      std::size_t first = 0;
      for (std::size_t j = 0; j < rows.size(); ++j) {
        const double room = 15 - 0.5 * std::sqrt(3.0) * static_cast<double>(j) * cotangent;
        EXPECT_LE(0.5 * (rows[j] - 1), room + 1e-6) << slope << " row " << j;
        if (j > 0 && rows[j] < rows[j - 1] - 1) {
          EXPECT_GT(0.5 * (rows[j] + 1), room - 1e-6);
        }
        for (int k = 0; k < rows[j]; ++k) {
          const NewGrain& g = grains[first + k];
          EXPECT_EQ(g.rotates, j > 0);
          if (j == 0) {
            EXPECT_EQ(g.y, s.radius);
            continue;
          }
          int touching = 0;
          for (std::size_t b = first - rows[j - 1]; b < first; ++b) {
            const double away = std::hypot(g.x - grains[b].x, g.y - grains[b].y) / d;
            if (std::fabs(away - 1) < 1e-12) {
              ++touching;
            } else {
              EXPECT_GT(away, 1.2);
            }
          }
          EXPECT_EQ(touching, 2) << slope << " row " << j << " disk " << k;
        }
        first += static_cast<std::size_t>(rows[j]);
      }
    }
  }
}

TEST(LatticePile, RefusesWhatCannotBe) {
  const auto refusal = [](LatticeSetup s) {
    try {
      check_lattice(s);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal(lattice(45, 61)), "lattice.slope_deg: found 61, allowed: above 0, at most 60");
  EXPECT_EQ(refusal(lattice(0, 60)), "lattice.base_grains: found 0, allowed: 1 or more");
  EXPECT_THAT(refusal(lattice(4, 60, -0.1)), HasSubstr("lattice.gap: found -0.1"));
  EXPECT_THAT(refusal(lattice(4, 60, 0.6)), HasSubstr("allowed: 0 to 0.5"));
  LatticeSetup s;
  s.radius = 0;
  EXPECT_THAT(refusal(s), HasSubstr("lattice.radius: found 0, allowed: above 0"));
}

}  // namespace
}  // namespace grainfield::dem
