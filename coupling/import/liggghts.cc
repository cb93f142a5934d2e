// LIGGGHTS: dumps like those of LAMMPS; compute pair/gran/local and wall/gran/local give the whole
// force on the first grain, or on the grain at a wall. Their columns have numbers only: --column.
#include "coupling/import/format.h"

namespace grainfield::coupling {

ImportFormat liggghts_format() {
  ImportFormat format;
  format.name = "liggghts";
  format.summary = "dump custom of the atoms, dump local of pair/gran/local and wall/gran/local";
  format.scan = scan_dump;
  format.densities_of_spheres = true;
  format.columns = dump_columns({
      // Superquadrics: half axes, blockiness, quaternion w x y z.
      {"axis_x", "shapex"},
      {"axis_y", "shapey"},
      {"axis_z", "shapez"},
      {"blockiness_1", "blockiness1"},
      {"blockiness_2", "blockiness2"},
      {"qw", "quat1"},
      {"qx", "quat2"},
      {"qy", "quat3"},
      {"qz", "quat4"},
      {"i", "id1"},
      {"j", "id2"},
      {"fx", "fx"},
      {"fy", "fy"},
      {"fz", "fz"},
      {"px", "px"},
      {"py", "py"},
      {"pz", "pz"},
  });
  return format;
}

}  // namespace grainfield::coupling
