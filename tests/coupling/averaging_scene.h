// Packings with known forces for the tests of averaging.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "coupling/averaging/options.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::test {

/// A value everywhere, however few the grains.
coupling::AverageOptions options(const std::string& method, const std::string& kernel,
                                 double width);

dem::Grain disk(std::int64_t id, double x, double y, double radius);

void add_wall(dem::Snapshot& s, const char* name, dem::Vec3 point, dem::Vec3 normal);

/// Gives every contact the forces of least size that balance every free grain in x and y, under
/// gravity, the applied force and the forces of `given` contacts: exact equilibrium of forces (not
/// of moments), forces not along the normals, as with friction.
void balance_forces(dem::Snapshot& s, const std::vector<dem::Contact>& given = {});

/// A layer of disks of random sizes on a floor between two walls, with contacts between all near
/// neighbours and forces in equilibrium. `rough`: the lowest row is fixed and there is no floor.
dem::Snapshot layer(unsigned seed, int columns = 12, int rows = 6, bool rough = false,
                    double load = 0);

double weight(const dem::Snapshot& s);

}  // namespace grainfield::test
