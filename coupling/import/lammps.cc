// LAMMPS: "dump custom" of the grains and "dump local" of pair/local with the pair's ids.
// compute pair/local gives the normal part of a granular pair's force on the first atom as fx, fy,
// fz, and the tangential part as p1, p2, p3 (pair styles gran/*, granular).
#include "coupling/import/format.h"

namespace grainfield::coupling {

ImportFormat lammps_format() {
  ImportFormat format;
  format.name = "lammps";
  format.summary = "dump custom of the atoms, dump local of their pairs";
  format.scan = scan_dump;
  format.densities_of_spheres = true;
  format.columns = dump_columns({
      // Ellipsoids: compute property/atom shapex is a diameter.
      {"diameter_x", "shapex"},
      {"diameter_y", "shapey"},
      {"diameter_z", "shapez"},
      {"i", "patom1"},
      {"i", "id1"},
      {"i", "natom1"},
      {"j", "natom2"},
      {"j", "patom2"},
      {"j", "id2"},
      {"fnx", "fx"},
      {"fny", "fy"},
      {"fnz", "fz"},
      {"ftx", "p1"},
      {"fty", "p2"},
      {"ftz", "p3"},
  });
  return format;
}

}  // namespace grainfield::coupling
