// Lattice piles at rest, and their base against the closed form of hard close-packed disks.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "coupling/studies/lattice_pile/simulation.h"
#include "dem/grains/lattice_pile.h"
#include "dem/run/run.h"

namespace grainfield::dem {

/// `softness`: m g/(K d), of the overlap-area law m g/(E d).
inline LatticePileSetup pile_of(int base, double slope, double softness, const std::string& law) {
  LatticePileSetup s;
  s.lattice.base_grains = base;
  s.lattice.slope_deg = slope;
  const double r = s.lattice.radius;
  const double weight = s.material.density * std::numbers::pi * r * r * s.material.gravity;
  const double stiffness = weight / (softness * 2 * r);
  s.material.law = law;
  s.material.normal_stiffness = s.material.young = stiffness;
  s.material.tangential_stiffness = stiffness * 2 / 7;
  // The slowest swings of such a pile are slower than those of a contact by about its height.
  s.rest.background_damping = 3 * std::sqrt(stiffness / (weight / s.material.gravity)) / base;
  return s;
}

inline RunResult at_rest(const LatticePileSetup& setup) {
  const auto run = make_lattice_pile_run(setup, 1, 1);
  while (!run->done()) run->advance(100000);
  return run->result();
}

struct BaseErrors {
  double normal = 0, horizontal = 0;  ///< largest differences over the largest |N| and |H|
  double asymmetry = 0;               ///< of N left and right, over the largest N
  int row_contacts = 0;               ///< contacts between neighbours of one row
  double weight_ratio = 0;
};

/// N = m g (n1 + n2)/2, H = m g tan 30 (n1 - n2)/2, n1, n2 the grains on the lattice lines that
/// meet at a base grain, itself included; counted here from the grains' places.
inline BaseErrors base_errors(const LatticePileSetup& setup, const RunResult& result) {
  const Snapshot& s = result.snapshots.front().second;
  const double along = lattice_spacing(setup.lattice), up = lattice_rise(setup.lattice);
  const double weight = s.grains.front().mass * setup.material.gravity;
  const int base = setup.lattice.base_grains;
  std::vector<double> normal(base, 0), horizontal(base, 0);
  BaseErrors out;
  for (const Contact& c : s.contacts) {
    if (c.j < 0) {
      normal[c.i] = c.force.y();
      horizontal[c.i] = -c.force.x();
    } else if (std::fabs(c.normal.y()) < 0.5) {
      ++out.row_contacts;
    }
  }
  double most_n = 0, most_h = 0;
  for (int i = 0; i < base; ++i) {
    const Vec3 foot = s.grains[i].position;
    int n1 = 0, n2 = 0;
    for (const Grain& g : s.grains) {
      const double row = std::round((g.position.y() - foot.y()) / up);
      const double side = (g.position.x() - foot.x()) / (0.5 * along);
      if (std::fabs(side + row) < 0.5) ++n1;
      if (std::fabs(side - row) < 0.5) ++n2;
    }
    const double n = weight * (n1 + n2) / 2;
    const double h = weight / std::numbers::sqrt3 * (n1 - n2) / 2;
    most_n = std::max(most_n, n);
    most_h = std::max(most_h, std::fabs(h));
    out.normal = std::max(out.normal, std::fabs(normal[i] - n));
    out.horizontal = std::max(out.horizontal, std::fabs(horizontal[i] - h));
    out.asymmetry = std::max(out.asymmetry, std::fabs(normal[i] - normal[base - 1 - i]));
  }
  out.normal /= most_n;
  out.asymmetry /= most_n;
  if (most_h > 0) out.horizontal /= most_h;
  out.weight_ratio = result.figures.at("base.weight_ratio");
  return out;
}

}  // namespace grainfield::dem
