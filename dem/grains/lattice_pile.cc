#include "dem/grains/lattice_pile.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "dem/shared/refuse.h"
#include "dem/space/rotation.h"

namespace grainfield::dem {
namespace {

// Disks whose centre is this share of a spacing outside the slope still belong to the pile.
constexpr double kOnSlope = 1e-9;
// Wider gaps: at sqrt 3 the rows would fall into one another.
constexpr double kMostGap = 0.5;

// Spacings by which a row leaves more to either side than the lattice does, over the row's number.
double more_per_row(double slope_deg) {
  const auto [c, sine] = rotation_of(slope_deg * std::numbers::pi / 180);
  return 0.5 * std::numbers::sqrt3 * c / sine - 0.5;
}

}  // namespace

void check_lattice(const LatticeSetup& s) {
  require(s.base_grains >= 1, "lattice.base_grains", s.base_grains, "1 or more");
  require(s.slope_deg > 0 && s.slope_deg <= 60, "lattice.slope_deg", s.slope_deg,
          "above 0, at most 60");
  require(s.top_slope_deg >= 0 && s.top_slope_deg <= 60, "lattice.top_slope_deg", s.top_slope_deg,
          "0 (no bend), or above 0, at most 60");
  require(s.bend >= 0 && s.bend < 0.5, "lattice.bend", s.bend, "0 to below 0.5");
  require(s.radius > 0, "lattice.radius", s.radius, "above 0");
  require(s.gap >= 0 && s.gap <= kMostGap, "lattice.gap", s.gap, "0 to 0.5");
}

std::vector<int> lattice_rows(const LatticeSetup& s) {
  // At row j the slope leaves (sqrt 3/2) j / tan(slope) spacings less to either side, the lattice
  // itself j/2: whole disks make up the difference. All in spacings.
  const double low = more_per_row(s.slope_deg);
  const double high = s.top_slope_deg > 0 ? more_per_row(s.top_slope_deg) : low;
  const double bend = s.bend * (s.base_grains - 1) / (low + 0.5);  // in rows
  std::vector<int> rows;
  for (int j = 0;; ++j) {
    const double more = high == low || j <= bend ? j * low : bend * low + (j - bend) * high;
    const double left_out = std::ceil(more - kOnSlope);
    const double count = s.base_grains - j - 2 * std::max(left_out, 0.0);
    if (count < 1) return rows;
    rows.push_back(static_cast<int>(count));
  }
}

double lattice_spacing(const LatticeSetup& s) { return 2 * s.radius * (1 + s.gap); }

double lattice_rise(const LatticeSetup& s) {
  const double half = 0.5 * (1 + s.gap);
  return 2 * s.radius * std::sqrt(1 - half * half);
}

std::vector<NewGrain> lattice_pile_grains(const LatticeSetup& s, double density) {
  const std::vector<int> rows = lattice_rows(s);
  const double along = lattice_spacing(s), up = lattice_rise(s);
  std::vector<NewGrain> grains;
  for (std::size_t j = 0; j < rows.size(); ++j) {
    for (int k = 0; k < rows[j]; ++k) {
      NewGrain g;
      g.x = (k - 0.5 * (rows[j] - 1)) * along;
      g.y = s.radius + static_cast<double>(j) * up;
      g.radius = s.radius;
      g.density = density;
      g.rotates = j > 0;
      grains.push_back(g);
    }
  }
  return grains;
}

}  // namespace grainfield::dem
