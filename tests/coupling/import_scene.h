// Writes packings of ours in the formats that the import reads.
#pragma once
#include <string>
#include <utility>

#include "averaging_scene.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::test {

/// layer() with radii so large that grains in contact overlap, and contact points where the import
/// puts them when a file does not give any: in the middle of the chord.
dem::Snapshot overlapping_layer(unsigned seed, int columns = 12, int rows = 6, bool rough = false,
                                double load = 0);

std::string wall_or_id(const dem::Snapshot& s, std::int64_t j);

/// "x1 y1;x2 y2;...", with all digits.
std::string outline_text(const dem::Outline& outline);

std::string csv_grains(const dem::Snapshot& s);

std::string csv_contacts(const dem::Snapshot& s);

std::string csv_walls(const dem::Snapshot& s);

/// Force of a contact on its grain i, split along the normal and across.
std::pair<dem::Vec3, dem::Vec3> parts(const dem::Contact& c);

/// One step of a grains' dump; walls as the columns f_NAME[1..7] of "fix wall/gran ... contacts".
std::string dump_grains(const dem::Snapshot& s, long step, bool wall_columns);

std::string dump_header(long step, long rows, const std::string& columns);

/// One step of a contacts' dump as LAMMPS writes it (pairs only): index, ids, normal and
/// tangential part.
std::string lammps_contacts(const dem::Snapshot& s, long step);
inline const char* lammps_columns =
    " --column 'i,j=c_ids[1..2]' --column 'fnx,fny,fnz,ftx,fty,ftz=c_p[1..6]'";

/// The same as LIGGGHTS writes it: pairs, and contacts with meshes numbered like our walls.
std::string liggghts_contacts(const dem::Snapshot& s, long step);
std::string liggghts_walls(const dem::Snapshot& s, long step);
inline const char* liggghts_columns =
    " --column 'i,j=c_fc[1..2]' --column 'fx,fy,fz=c_fc[4..6]'"
    " --column 'px,py,pz=c_fw[1..3]' --column 'wall=c_fw[7]' --column 'i=c_fw[9]'"
    " --column 'fx,fy,fz=c_fw[10..12]'";

std::string yade_bodies(const dem::Snapshot& s);
/// Forces act on id2; walls are the bodies 9000, 9001, ...
std::string yade_interactions(const dem::Snapshot& s);

}  // namespace grainfield::test
