// Lines of averaged fields: what models as they are given are compared with.
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coupling/observe/observations.h"
#include "coupling/store/field_io.h"

namespace grainfield::coupling {

/// The kernel of a field's averaging, through which models are seen. Throws std::invalid_argument
/// beginning with `where` for missing attributes.
std::shared_ptr<const Kernel> kernel_of(const Field& field, const std::string& where);

struct LineOptions {
  std::vector<std::string> components;  ///< empty: sigma_yy, in space sigma_zz
  std::vector<double> heights;          ///< of a grid's rows: shares of the height; empty: three
  std::vector<double> origin;  ///< x, y of the models' origin in the field's frame; empty: (0, 0)
};

/// Lines of the fields, which are of one specimen: every horizontal row of lines and cuts; of a
/// grid the rows nearest to options.heights, and itself as the map in the plane. Rings (rings.h)
/// lie in the half plane y = 0, with r, t and z for x, y and z. In space rows run along x, at each
/// height those nearest to y = 0. Rows with fewer than 3 values are left out. `file`: for messages.
/// Throws std::invalid_argument for fields of different specimens, loads or sizes, missing
/// attributes or components, frame "packing" without an origin, and when no row is left.
Observations observe_fields(const NamedFields& fields, const LineOptions& options,
                            const std::string& file);

}  // namespace grainfield::coupling
