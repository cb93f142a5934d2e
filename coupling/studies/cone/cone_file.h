// Whether a cone out of a file is the one that a setup asks for.
#pragma once
#include <string>

#include "coupling/studies/cone/simulation.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// Compares what the snapshot knows of it, `where` being its name: the words cone.source, .shape,
/// .floor and material.law where it has them; gravity, density and friction of the grains; of
/// spheres with a law that the quasi-static solver knows the stiffness, by the forces at the depths
/// of its contacts. Throws std::invalid_argument naming the key, what was found and what the file
/// has.
void check_same_cone(const ConeSetup& setup, const Snapshot& cone, const std::string& where);

}  // namespace grainfield::dem
