// Maps E(x, y), nu(x, y) of the plane as text, as a finite-element solve takes them
// (continuum/elastic_field.h reads them).
#pragma once
#include <string>

#include "coupling/base/field.h"

namespace grainfield::coupling {

/// CSV of a grid's columns young (N/m) and poisson (1) with their errors: comment lines (#), header
/// x,y,young,poisson,young_error,poisson_error, one line per node, x fastest, in SI units; numbers
/// come back to the same bits. A node is nan where Poisson's ratio is not inside (-1, 0.5).
std::string elastic_map_text(const Field& constants);

}  // namespace grainfield::coupling
