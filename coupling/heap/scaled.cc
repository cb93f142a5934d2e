#include "coupling/heap/scaled.h"

namespace grainfield::coupling {

Field scaled_field(const Field& field, const Eigen::MatrixXd& points, double pressure, int nx,
                   int ny, int nz) {
  Field out;
  out.points = points;
  out.nx = nx;
  out.ny = ny;
  out.nz = nz;
  for (const Column& column : field.columns) {
    const bool stress = column.name.starts_with("sigma_");
    if (!stress && column.name != "volume_fraction") continue;
    out.add(column.name, "1").value =
        stress ? Eigen::VectorXd(column.value / pressure) : column.value;
  }
  return out;
}

}  // namespace grainfield::coupling
