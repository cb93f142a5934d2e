// The columns of grains, contacts and walls under our names.
#include "coupling/import/table.h"

namespace grainfield::coupling {

const std::vector<OurColumn>& our_columns(TableKind kind) {
  static const std::vector<OurColumn> grains{
      {"id", "1", "whole number, each once"},
      {"x", "m", "centroid"},
      {"y", "m", "centroid"},
      {"z", "m", "centroid; 2D: may be missing"},
      {"xu", "m",
       "instead of x: unwrapped, not carried back into a periodic cell. Without ix, x far outside "
       "the "
       "cell counts as unwrapped"},
      {"yu", "m", "instead of y"},
      {"zu", "m", "instead of z"},
      {"xs", "1", "instead of x: over the box of a dump, from its low side"},
      {"ys", "1", "instead of y"},
      {"zs", "1", "instead of z"},
      {"xsu", "1", "instead of x: over the box, not carried back into a periodic cell"},
      {"ysu", "1", "instead of y"},
      {"zsu", "1", "instead of z"},
      {"ix", "1", "beside x: edges of the periodic cell by which it was carried back"},
      {"iy", "1", "beside y"},
      {"iz", "1", "beside z"},
      {"vx", "m/s", "velocity, default 0"},
      {"vy", "m/s", "velocity, default 0"},
      {"vz", "m/s", "velocity, default 0"},
      {"angle", "rad", "rotation about z, default 0"},
      {"spin", "rad/s", "about z, default 0"},
      {"spin_x", "rad/s", "3D: about x, default 0"},
      {"spin_y", "rad/s", "3D: about y, default 0"},
      {"qw", "1", "3D: orientation, a unit quaternion; default 1, 0, 0, 0"},
      {"qx", "1", "3D: orientation"},
      {"qy", "1", "3D: orientation"},
      {"qz", "1", "3D: orientation"},
      {"radius", "m", "of a disk or sphere; a diameter beside it must agree to 1e-4"},
      {"diameter", "m", "instead of radius"},
      {"axis_x", "m", "3D: semi-axis of a superellipsoid"},
      {"axis_y", "m", "3D: semi-axis"},
      {"axis_z", "m", "3D: semi-axis"},
      {"exponent_1", "1", "3D: of the first two axes; default 1, an ellipsoid"},
      {"exponent_2", "1", "3D: with the third axis; default 1"},
      {"diameter_x", "m", "3D: instead of axis_x, twice as long"},
      {"diameter_y", "m", "3D: instead of axis_y"},
      {"diameter_z", "m", "3D: instead of axis_z"},
      {"blockiness_1", "1", "3D: instead of exponent_2, 2 over it (LIGGGHTS)"},
      {"blockiness_2", "1", "3D: instead of exponent_1, 2 over it"},
      {"mass", "kg",
       "or density, or --density; if both are given, they must agree to 1e-4 and the mass counts",
       "kg/m"},
      {"density", "kg/m3", "instead of mass; 2D: kg/m2", "kg/m2"},
      {"inertia", "kg m2", "about the centroid; default: of a disk, sphere or polygon"},
      {"volume", "m3", "2D: m2; default: of a disk, sphere or polygon", "m2"},
      {"fixed", "1", "1: part of the apparatus, default 0"},
      {"material", "", "name; default: the only one, without a name. Dumps: material=type"},
      {"outline", "m",
       "CSV: x1 y1;x2 y2;... of a convex polygon about (x, y), turned by angle; empty: a disk"},
  };
  static const std::vector<OurColumn> contacts{
      {"i", "1", "id of a grain"},
      {"j", "1", "id of the other grain, or name of a wall"},
      {"wall", "1", "instead of j: name or id of a wall, needed if walls and grains share ids"},
      {"px", "m",
       "contact point; default: on the line of centres, in the middle of the overlap; at a wall "
       "the centre's foot on it"},
      {"py", "m", "contact point"},
      {"pz", "m", "contact point"},
      {"nx", "1", "normal from i to j; default: along the line of centres, at a wall its own"},
      {"ny", "1", "normal"},
      {"nz", "1", "normal"},
      {"fx", "N", "force on i", "N/m"},
      {"fy", "N", "force on i", "N/m"},
      {"fz", "N", "force on i", "N/m"},
      {"fnx", "N", "normal part of the force on i, instead of fx", "N/m"},
      {"fny", "N", "normal part", "N/m"},
      {"fnz", "N", "normal part", "N/m"},
      {"ftx", "N", "tangential part of the force on i", "N/m"},
      {"fty", "N", "tangential part", "N/m"},
      {"ftz", "N", "tangential part", "N/m"},
      {"fn", "N", "normal force, repulsion positive, instead of fx", "N/m"},
      {"ft", "N", "beside fn: tangential force on i along tx, ty, tz (2D: or along -ny, nx)",
       "N/m"},
      {"tx", "1", "direction of the tangential force on i"},
      {"ty", "1", "direction"},
      {"tz", "1", "direction"},
      {"friction", "1", "Coulomb coefficient of the contact; default nan (unknown)"},
      {"spring", "N", "elastic part of the tangential force; default nan (unknown)", "N/m"},
      {"sx", "N", "3D: elastic part of the tangential force on i; default nan (unknown)", "N/m"},
      {"sy", "N", "3D: elastic part", "N/m"},
      {"sz", "N", "3D: elastic part", "N/m"},
      {"sliding", "1",
       "1: at the Coulomb limit; default: from force and friction, where the friction is given"},
  };
  static const std::vector<OurColumn> walls{
      {"name", "", "floor, left, right or any other"},
      {"x", "m", "a point of the wall"},
      {"y", "m", "a point of the wall"},
      {"z", "m", "a point of the wall"},
      {"nx", "1", "normal into the grains"},
      {"ny", "1", "normal"},
      {"nz", "1", "normal"},
      {"friction", "1", "grain against wall; default nan (unknown)"},
      {"material", "", "name; default: that of each grain, with the friction"},
  };
  static const std::vector<OurColumn> none;
  switch (kind) {
    case TableKind::grains:
      return grains;
    case TableKind::contacts:
      return contacts;
    case TableKind::walls:
      return walls;
    case TableKind::unknown:
      break;
  }
  return none;
}

}  // namespace grainfield::coupling
