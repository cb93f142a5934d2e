#include "dem/snapshot/columns.h"

namespace grainfield::dem {

std::vector<Column<Grain>> grain_columns(int dim) {
  return {
      {"id", "1", "whole number, the same in all snapshots of a run", &Grain::id},
      {"position", "m", "centroid", &Grain::position},
      {"velocity", "m/s", "of the centroid", &Grain::velocity},
      {"angle", "rad", "rotation about z; 3D: not used", &Grain::angle},
      {"spin", "rad/s", "about z; 3D: the z component of angular_velocity", &Grain::spin},
      {"radius", "m", "of a polygon or superellipsoid to the farthest point", &Grain::radius},
      {"mass", "kg", "2D: from an areal density", &Grain::mass},
      {"inertia", "kg m2", "about the centroid; 3D: mean principal moment", &Grain::inertia},
      {"volume", dim == 2 ? "m2" : "m3", "2D: area", &Grain::volume},
      {"fixed", "1", "1: part of the apparatus (rough floor, funnel)", &Grain::fixed},
      {"orientation", "1", "unit quaternion w x y z, body to space", &Grain::orientation,
       Presence::in_3d},
      {"angular_velocity", "rad/s", "in space", &Grain::angular_velocity, Presence::in_3d},
      {"moments", "kg m2", "principal moments of inertia", &Grain::moments, Presence::in_3d},
      {"material", "1", "index in the attribute material_names; absent or -1: the only one",
       &Grain::material, Presence::where_used},
      {"rotates", "1", "0: slides but never spins; absent: all 1", &Grain::rotates,
       Presence::where_used},
      {"image", "1",
       "periods: unwrapped position = position + sum of image times edge; absent: all 0",
       &Grain::image, Presence::where_used},
      {"axes", "m", "semi-axes of a superellipsoid", &Grain::axes, Presence::where_used},
      {"exponents", "1", "of a superellipsoid: of the first two axes, and with the third",
       &Grain::exponents, Presence::where_used},
  };
}

const std::vector<Column<Contact>>& contact_columns() {
  static const std::vector<Column<Contact>> columns{
      {"i", "1", "row of a grain", &Contact::i},
      {"j", "1", "row of the other grain, i < j; -1 - w: wall w", &Contact::j},
      {"point", "m", "contact point", &Contact::point},
      {"normal", "1", "unit vector from i to j", &Contact::normal},
      {"force", "N", "on i", &Contact::force},
      {"normal_force", "N", "repulsion is positive", &Contact::normal_force},
      {"tangential_force", "N", "on i along (-n_y, n_x); 3D: size", &Contact::tangential_force},
      {"spring", "N", "elastic part of the tangential force; 3D: size", &Contact::spring,
       Presence::always, true},
      {"friction", "1", "Coulomb coefficient", &Contact::friction, Presence::always, true},
      {"sliding", "1", "1: at the Coulomb limit", &Contact::sliding},
      {"spring_vector", "N", "the spring as a force on i", &Contact::spring_vector, Presence::in_3d,
       true},
      {"image", "1", "i touches j at its position + sum of image times edge; absent: all 0",
       &Contact::image, Presence::where_used},
      {"rolling_spring", "N", "pseudo-force on i (2D: along the tangent); absent: all 0",
       &Contact::rolling_spring, Presence::where_used},
      {"twisting_spring", "N m", "moment on i along the normal; absent: all 0",
       &Contact::twisting_spring, Presence::where_used},
  };
  return columns;
}

const std::vector<Column<Wall>>& wall_columns() {
  static const std::vector<Column<Wall>> columns{
      {"point", "m", "of the plane; of a round wall: of its axis", &Wall::point},
      {"normal", "1", "into the grains; of a round wall: along its axis", &Wall::normal},
      {"friction", "1", "grain against wall", &Wall::friction, Presence::always, true},
      {"shape", "1",
       "index in the attribute shape_names: plane (also absent), cylinder, cone, mesh",
       &Wall::shape, Presence::where_used},
      {"radius", "m", "of a cylinder; of a cone at the first end of the axis; absent: 0",
       &Wall::radius, Presence::where_used},
      {"end_radius", "m", "of a cone at the other end; absent: 0", &Wall::end_radius,
       Presence::where_used},
      {"length", "m", "of the axis; absent: 0", &Wall::length, Presence::where_used},
      {"inside", "1", "1: the grains are inside; absent: 1", &Wall::inside, Presence::where_used},
      {"material", "1",
       "index in the attribute material_names; absent or -1: the law of each grain with its like, "
       "and friction",
       &Wall::material, Presence::where_used},
      {"velocity", "m/s", "of point; absent: 0", &Wall::velocity, Presence::where_used},
      {"angular_velocity", "rad/s", "about point; absent: 0", &Wall::angular_velocity,
       Presence::where_used},
      {"force", "N", "of the grains on the wall; absent: from the contacts", &Wall::force,
       Presence::derived},
      {"torque", "N m", "of the grains, about point; absent: from the contacts", &Wall::torque,
       Presence::derived},
  };
  return columns;
}

}  // namespace grainfield::dem
