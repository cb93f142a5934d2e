// Averaged fields from a file against continuum models.
#pragma once
#include <string>
#include <vector>

#include "coupling/case/case.h"

namespace grainfield::coupling {

struct CompareRequest {
  std::string file;  ///< of write_fields, with attributes F, h, method, kernel, width
  std::vector<std::string> fields;  ///< empty: every line, and rows of the first response map
  std::vector<ModelChoice> models;
  std::string folder;  ///< of the outputs; made where missing
};

/// Writes profiles.*, summary.json and report.html; returns the verdict's sentence. Lines whose
/// name starts with "base" are seen along x, others in the plane. Throws std::invalid_argument for
/// a field without the attributes or with points that are neither a line nor a grid, and what
/// models throw.
std::string compare_field(const CompareRequest& request);

}  // namespace grainfield::coupling
