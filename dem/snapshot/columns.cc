#include "dem/snapshot/columns.h"

namespace grainfield::dem {

std::vector<Column<Grain>> grain_columns(int dim) {
  return {
      {"id", "1", &Grain::id},
      {"position", "m", &Grain::position},
      {"velocity", "m/s", &Grain::velocity},
      {"angle", "rad", &Grain::angle},
      {"spin", "rad/s", &Grain::spin},
      {"radius", "m", &Grain::radius},
      {"mass", "kg", &Grain::mass},
      {"inertia", "kg m2", &Grain::inertia},
      {"volume", dim == 2 ? "m2" : "m3", &Grain::volume},
      {"fixed", "1", &Grain::fixed},
      {"orientation", "1", &Grain::orientation, Presence::in_3d},
      {"angular_velocity", "rad/s", &Grain::angular_velocity, Presence::in_3d},
      {"moments", "kg m2", &Grain::moments, Presence::in_3d},
      {"material", "1", &Grain::material, Presence::where_used},
      {"rotates", "1", &Grain::rotates, Presence::where_used},
      {"image", "1", &Grain::image, Presence::where_used},
      {"axes", "m", &Grain::axes, Presence::where_used},
      {"exponents", "1", &Grain::exponents, Presence::where_used},
  };
}

const std::vector<Column<Contact>>& contact_columns() {
  static const std::vector<Column<Contact>> columns{
      {"i", "1", &Contact::i},
      {"j", "1", &Contact::j},
      {"point", "m", &Contact::point},
      {"normal", "1", &Contact::normal},
      {"force", "N", &Contact::force},
      {"normal_force", "N", &Contact::normal_force},
      {"tangential_force", "N", &Contact::tangential_force},
      {"spring", "N", &Contact::spring, Presence::always, true},
      {"friction", "1", &Contact::friction, Presence::always, true},
      {"sliding", "1", &Contact::sliding},
      {"spring_vector", "N", &Contact::spring_vector, Presence::in_3d, true},
      {"image", "1", &Contact::image, Presence::where_used},
      {"rolling_spring", "N", &Contact::rolling_spring, Presence::where_used},
      {"twisting_spring", "N m", &Contact::twisting_spring, Presence::where_used},
  };
  return columns;
}

const std::vector<Column<Wall>>& wall_columns() {
  static const std::vector<Column<Wall>> columns{
      {"point", "m", &Wall::point},
      {"normal", "1", &Wall::normal},
      {"friction", "1", &Wall::friction, Presence::always, true},
      {"shape", "1", &Wall::shape, Presence::where_used},
      {"radius", "m", &Wall::radius, Presence::where_used},
      {"end_radius", "m", &Wall::end_radius, Presence::where_used},
      {"length", "m", &Wall::length, Presence::where_used},
      {"inside", "1", &Wall::inside, Presence::where_used},
      {"material", "1", &Wall::material, Presence::where_used},
      {"velocity", "m/s", &Wall::velocity, Presence::where_used},
      {"angular_velocity", "rad/s", &Wall::angular_velocity, Presence::where_used},
      {"force", "N", &Wall::force, Presence::derived},
      {"torque", "N m", &Wall::torque, Presence::derived},
  };
  return columns;
}

}  // namespace grainfield::dem
