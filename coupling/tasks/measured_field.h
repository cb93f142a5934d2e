// Stresses that were measured in a laboratory as a field like any other.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "coupling/base/field.h"

namespace grainfield::coupling {

struct MeasuredRequest {
  std::string file;               ///< CSV; see measured_field
  std::string geometry = "heap";  ///< heap (plane or cone, apex at 0) | layer (load at 0)
  /// 2: stresses in N/m, where 1 Pa counts as 1 N/m; 3: Pa; 0: as the file says (settle)
  int dim = 0;
  double height = std::numeric_limits<double>::quiet_NaN();  ///< h, m
  // Heaps alone:
  double left_deg = std::numeric_limits<double>::quiet_NaN(), right_deg = left_deg;
  double rho_g = std::numeric_limits<double>::quiet_NaN();  ///< N/m3 (2D: N/m2)
  // Layers alone:
  double load = std::numeric_limits<double>::quiet_NaN();  ///< F, N; nan: at rest
  double width = 0;  ///< radius of the measuring cells, m; 0: a thousandth of h
};

/// Decides the number of dimensions where nobody did: 3 where the file has a column z or r or the
/// unit F/h2, else 2. Returns what is assumed by that, a sentence; empty: nothing. Throws
/// std::invalid_argument naming the option: of options that mean nothing to this geometry, a
/// column of three dimensions in two, and stresses (Pa) under a load (N) that say neither.
std::string settle(MeasuredRequest& request);

/// One row of the file per value: columns x (in space also y, or r for both: the distance from the
/// axis), the height y (in space z; default -h, the base), component, value and error, each
/// number's column with its unit behind its name, "x (mm)", "value (kPa)"; '#' begins a comment.
/// Components: pressure (-sigma_yy; in space -sigma_zz), shear (sigma_xy; in space sigma_xz), or a
/// stress by its name, tension positive. An empty error is none. The field has a column per stress
/// (nan where it was not measured), with errors, and what `compare` and `fit` ask for as
/// attributes. Throws std::invalid_argument, one line naming file and line, what was found and what
/// is allowed: a missing column, an unknown unit or component, no number, a negative error, a value
/// twice, pressures that carry more than five times the weight above them, or less than a
/// twentieth; places that nearly all lie outside the heap or all below its apex; and options that
/// are missing or out of range.
Field measured_field(const MeasuredRequest& request);

/// What is hardly so, a sentence each, of a heap in the plane: places outside it, pressures that
/// pull, and a base that does not carry the weight above it.
std::vector<std::string> measured_doubts(const Field& field);

/// "base" where all of its points are there, else "measured".
std::string name_of_measured(const Field& field);

/// The units of lengths and of stresses that a file may use, for messages and help.
const std::vector<std::string>& length_units();
const std::vector<std::string>& stress_units();

}  // namespace grainfield::coupling
