// A packing of spheres as LAMMPS reads it, with an input deck that has the same law, walls, gravity
// and load: to go on on many processors, and to come back by `grainfield import`.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "dem/laws/material_setup.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// What a snapshot does not tell.
struct LammpsSetup {
  /// Whether material, damping and time step are: of an imported packing they may not be, and the
  /// deck then asks for them (`lmp -var law "..." -var step ...`).
  bool known = true;
  dem::MaterialSetup material;
  double background_damping = 0;             ///< 1/s, of velocities
  double local_damping = 0;                  ///< Cundall's; LAMMPS has none: a note says so
  double kinetic_to_elastic_energy = 1e-10;  ///< at rest: the sphere's over the contacts'
  double time_step = 1e-5;                   ///< s
  std::vector<std::int64_t> loaded;          ///< ids of the grains that share the load; empty: none
  dem::Vec3 force{0, 0, 0};                  ///< on each of them, N
  /// The packing that many times beside itself along x and y, where space repeats.
  std::array<int, 2> copies{1, 1};
};

struct LammpsDeck {
  std::string data;   ///< packing.data, for read_data
  std::string input;  ///< in.lammps
  /// ids.csv, LAMMPS' ids and ours, for import --ids; empty: LAMMPS has ours, 1 to 2^31 - 1.
  std::string ids;
  /// What LAMMPS does differently, one line each.
  std::vector<std::string> notes;
};

/// Where the law is not known, what LAMMPS has not of walls and gravity is left out with a note.
/// Throws std::invalid_argument naming what LAMMPS has not: packings in the plane, other shapes
/// than spheres, other laws than linear and hertz, walls that are no planes across an axis, cells
/// that are sheared, several materials; copies along a side that does not repeat.
LammpsDeck lammps_deck(const dem::Snapshot& packing, const LammpsSetup& setup);

/// The restitution coefficient that LAMMPS' `damping tsuji` turns into the prefactor alpha
/// (Tsuji, Tanaka and Ishida 1992; its polynomial), for 0 <= alpha <= 1.2728; 0 beyond.
double tsuji_restitution(double alpha);

}  // namespace grainfield::coupling
