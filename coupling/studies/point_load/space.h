// A point load on a layer of spheres: what it adds, by radius about the load, against the models.
#pragma once
#include <string>
#include <vector>

#include "coupling/case/case.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// As analyse_point_load, of packing.dim = 3. Profiles are means over the angle about the load at
/// radius |x|, drawn to both sides; stresses in Pa, in units of F/h^2.
StudyResult analyse_space_load(const Case& value, const std::vector<std::string>& realizations,
                               int threads);

}  // namespace grainfield::coupling
