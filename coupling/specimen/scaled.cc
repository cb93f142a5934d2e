#include "coupling/specimen/scaled.h"

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

Field of_mean_heap(const Ensemble& scaled, double height, double pressure) {
  Field out = scaled.with_samples();
  out.points *= height;
  for (Column& column : out.columns) {
    if (!column.name.starts_with("sigma_")) continue;
    column.unit = out.points.cols() == 3 ? "Pa" : "N/m";
    column.value *= pressure;
    column.error *= pressure;
    column.samples *= pressure;
  }
  out.attributes["frame"] = "heap";
  out.attributes["lengths"] = "m";
  out.attributes["what"] = "every heap scaled by its own height and rho g h";
  out.attributes["h"] = height;
  out.attributes["rho_g_h"] = pressure;
  return out;
}

}  // namespace grainfield::coupling
