// Disks of a lattice pile at the start: touching their supports, without overlap, on y = 0.
#pragma once
#include <tuple>
#include <vector>

#include "dem/engine/engine.h"

namespace grainfield::dem {

/// A pile of equal disks on the triangular lattice (Liffman et al. 1992): rows that shrink upwards
/// so that the outline follows the slope, on a floor whose friction holds the lowest row.
struct LatticeSetup {
  int base_grains = 45;      ///< disks in the lowest row; at 60 degrees also the number of rows
  double slope_deg = 60;     ///< of the outline, up to 60
  double top_slope_deg = 0;  ///< of the outline above its bend ("tent"), up to 60; 0: no bend
  double bend = 0.25;        ///< of the way from either corner along the base to the bend, over the
                             ///< base; below a half
  double radius = 0.0045;    ///< m
  double gap = 5e-4;  ///< between neighbours of a row / diameter; 0: they may touch, and carry
                      ///< force where the pile's own weight pushes them together

  auto members() const {
    return std::tie(base_grains, slope_deg, top_slope_deg, bend, radius, gap);
  }
};

/// Throws std::invalid_argument naming the key ("lattice.slope_deg"), the value and what is
/// allowed.
void check_lattice(const LatticeSetup& lattice);

/// Number of disks in each row from the base up: those of the triangular lattice on and under the
/// slopes that rise from the centres of the outermost base disks. 45 base disks give 45, 44, ..., 1
/// (1035) at 60 degrees and 45, 42, ..., 3 (360) at 30, as Liffman's piles. With `top_slope_deg`
/// the slopes are those of his figure 18 above the bend.
std::vector<int> lattice_rows(const LatticeSetup& lattice);

/// Distance of neighbours in a row and of neighbouring rows, m: disks of successive rows touch.
double lattice_spacing(const LatticeSetup& lattice);
double lattice_rise(const LatticeSetup& lattice);

/// The disks row by row from the base, each row from left to right, the middle at x = 0. Those of
/// the lowest row do not spin.
std::vector<NewGrain> lattice_pile_grains(const LatticeSetup& lattice, double density);

}  // namespace grainfield::dem
