#include "coupling/studies/hard_disks/keys.h"

namespace grainfield::coupling {

std::vector<SummaryKey> gas_figures() {
  return {
      {"gas.pressure_largest_difference", "-",
       "largest of |Z over theory - 1| of all fractions, means over the realizations"},
      {"gas.haff_largest_difference", "-",
       "largest of |T over Haff's law - 1| of all fractions and times, likewise"},
      {"gas.energy_drift_per_collision", "-",
       "largest drift of a fraction's energy over its collisions"},
      {"gas.overlap", "-", "deepest overlap at any collision, over the distance of the centres"},
      {"gas.events", "-", "of a realization: collisions, crossings of cells and meetings in vain"},
      {"gas.*.compressibility", "-", "Z = p V/(n k T) by the virial of the collisions"},
      {"gas.*.theory", "-", "Z of Henderson 1975 (disks), Carnahan and Starling 1969 (spheres)"},
      {"gas.*.compressibility_over_theory", "-", "the one over the other"},
      {"gas.*.compressibility_over_virial_series", "-",
       "over the series of ten virial coefficients (Clisby and McCoy 2006), continued"},
      {"gas.*.collision_rate", "1/s", "collisions of a grain per second"},
      {"gas.*.collision_rate_over_enskog", "-", "over Enskog's, with the theory's Z"},
      {"gas.*.energy_drift", "-",
       "change of the energy over it; cooling: of the energy with what the collisions took"},
      {"gas.*.overlap", "-", "deepest overlap at a collision, over the distance of the centres"},
      {"gas.*.collisions", "-", "of pairs, since the lattice or since cooling began"},
      {"gas.*.elastic_share", "-", "of the collisions, without loss by the contact time"},
      {"gas.*.temperature", "-", "at the end of cooling, over that at its start"},
      {"gas.*.temperature_over_haff", "-", "at the end of cooling; without friction"},
  };
}

}  // namespace grainfield::coupling
