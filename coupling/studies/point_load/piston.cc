#include "coupling/studies/point_load/piston.h"

#include <fmt/format.h>

#include <algorithm>

#include "dem/shared/computation_failed.h"

namespace grainfield::dem {

Piston::Piston(const Stroke& stroke, double speed, double stiffness, double force)
    : AddedForce("piston", 1),
      stroke_(stroke),
      speed_(speed),
      stiffness_(stiffness),
      whole_(force) {}

double Piston::stiffness(const MaterialSetup& material) {
  return material.law == "linear" ? material.normal_stiffness : material.young;
}

AddedForce::Loads Piston::loads(const std::shared_ptr<const GrainsNow>& grains,
                                const std::shared_ptr<const ContactsNow>&) {
  const Eigen::Index up = grains->positions.cols() - 1;
  const double face = stroke_.height - speed_ * (grains->time - stroke_.start);
  force_ = std::clamp(stiffness_ * (grains->positions(stroke_.id, up) - face), 0.0, whole_);
  Loads out;
  out.forces = RowMatrix::Zero(grains->positions.rows(), grains->positions.cols());
  out.forces(stroke_.id, up) = -force_;
  return out;
}

void Piston::fail(double time) const {
  throw ComputationFailed(
      fmt::format("the piston meets {:.3g} N instead of load.force = {:g} N after rest.max_time = "
                  "{:g} s; lower load.force, or raise load.speed or rest.max_time",
                  force_, whole_, time));
}

}  // namespace grainfield::dem
