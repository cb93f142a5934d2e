// LIGGGHTS: dumps like those of LAMMPS; compute pair/gran/local and wall/gran/local give the whole
// force on the first grain, or on the grain at a wall. Their columns have numbers only: --column.
#include "coupling/import/format.h"

namespace grainfield::coupling {

ImportFormat liggghts_format() {
  ImportFormat format;
  format.name = "liggghts";
  format.summary = "dump custom of the atoms, dump local of pair/gran/local and wall/gran/local";
  format.scan = scan_dump;
  format.columns = dump_columns({
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
