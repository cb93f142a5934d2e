#include "dem/engine/added_forces.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grainfield::dem {
namespace {

void check_shape(const AddedForce& force, const char* what, const RowMatrix& values,
                 Eigen::Index rows, Eigen::Index columns) {
  if (values.rows() == rows && values.cols() == columns) return;
  throw std::invalid_argument(fmt::format("{}: {}: found shape ({}, {}), allowed: ({}, {})",
                                          force.name(), what, values.rows(), values.cols(), rows,
                                          columns));
}

void check_finite(const AddedForce& force, const char* what, const RowMatrix& values, double time,
                  const std::vector<std::int64_t>* ids) {
  for (Eigen::Index r = 0; r < values.rows(); ++r) {
    for (Eigen::Index c = 0; c < values.cols(); ++c) {
      if (std::isfinite(values(r, c))) continue;
      throw std::invalid_argument(
          fmt::format("{}: {}: found {} on grain {} at t = {:.6g} s, allowed: finite numbers",
                      force.name(), what, values(r, c), ids == nullptr ? r : (*ids)[r], time));
    }
  }
}

}  // namespace

AddedForce::AddedForce(std::string name, long every) : name_(std::move(name)), every_(every) {
  const auto is_forbidden = [](unsigned char c) { return c < ' ' || c == ',' || c == 0x7f; };
  if (name_.empty() || std::any_of(name_.begin(), name_.end(), is_forbidden)) {
    throw std::invalid_argument(
        fmt::format("name of an added force: found \"{}\", allowed: text without commas", name_));
  }
  if (every_ < 1) {
    throw std::invalid_argument(
        fmt::format("{}: every: found {}, allowed: 1 or more steps", name_, every_));
  }
}

TakesAddedForces& added_forces(Engine& engine) { return dynamic_cast<TakesAddedForces&>(engine); }

void check_loads(const AddedForce& force, const AddedForce::Loads& loads, Eigen::Index rows,
                 int dim, double time, const std::vector<std::int64_t>* ids) {
  check_shape(force, "forces", loads.forces, rows, dim);
  check_finite(force, "forces", loads.forces, time, ids);
  if (loads.torques.size() == 0) return;
  check_shape(force, "torques", loads.torques, rows, dim == 2 ? 1 : 3);
  check_finite(force, "torques", loads.torques, time, ids);
}

void refuse_sleep_with_added_forces() {
  throw std::invalid_argument(
      "sleep.on: found true with added forces, allowed: false (a sleeper would not feel them)");
}

void refuse_flow_with_added_forces() {
  throw std::invalid_argument(
      "cell: found one that flows, allowed with added forces: a cell at rest");
}

std::string every_text(const std::string& name, long every) {
  return fmt::format("{} every {} steps", name, every);
}

void refuse_without_forces(const std::string& needed, const std::string& found) {
  throw std::invalid_argument(fmt::format(
      "the checkpoint is of a run with added forces: found {}, allowed: {}; add the same forces "
      "before you restore it",
      found.empty() ? "none" : found, needed));
}

}  // namespace grainfield::dem
