#include "coupling/studies/sample/rve.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "continuum/constants.h"
#include "coupling/averaging/average.h"
#include "coupling/averaging/cluster.h"
#include "coupling/averaging/points.h"
#include "coupling/run/realization_file.h"
#include "coupling/statistics/spread.h"
#include "coupling/studies/sample/simulation/checks.h"
#include "coupling/studies/sample/simulation/path.h"
#include "coupling/studies/sample/simulation/state.h"
#include "dem/run/common.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

// Samples whose grains come out larger than the mean have edges up to so much longer.
constexpr double kEdgeReserve = 1.05;

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Snapshots = std::vector<std::pair<std::string, dem::Snapshot>>;

// The corner of the sample from which its edges lead.
Vector3d corner_of(const dem::Snapshot& s) {
  if (s.cell.is_periodic()) return s.cell.low;
  Vector3d low = Vector3d::Zero();
  for (const dem::Wall& wall : s.walls) {
    if (wall.name == "left") low.x() = wall.point.x();
    if (wall.name == "front") low.y() = wall.point.y();
    if (wall.name == "floor") low.z() = wall.point.z();
  }
  return low;
}

// Points of a grid, as far from each other as spheres of this radius (m) within walls allow.
MatrixXd centres(const dem::Snapshot& first, int along, double radius) {
  const Vector3d edges = dem::sample_state(first).edges.diagonal();
  const Vector3d low = corner_of(first);
  Vector3d margin = edges / (2 * along);
  if (!first.cell.is_periodic()) margin = margin.cwiseMax(Vector3d::Constant(radius));
  if (along == 1) margin = edges / 2;
  return box_points(low + margin, low + edges - margin, along, along, along);
}

bool fits(const dem::Snapshot& first, double radius) {
  return dem::sample_state(first).edges.diagonal().minCoeff() > 2 * radius;
}

Matrix3d gradient_between(const dem::SampleState& first, const dem::SampleState& now) {
  return now.edges * first.edges.inverse() - Matrix3d::Identity();
}

// The clusters of one radius with the surfaces that they had in the first state.
struct Elements {
  std::vector<Cluster> clusters;
  std::vector<MatrixXd> places;
  std::vector<Hull> hulls;
  MatrixXd centres;
  int left_out = 0;  // of fewer than four grains
};

Elements elements_of(const dem::Snapshot& first, int along, double radius) {
  Elements out;
  const MatrixXd all = centres(first, along, radius);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < all.rows(); ++k) {
    Cluster cluster(first, all.row(k).transpose(), radius);
    if (cluster.size() < 4) continue;  // no hull
    kept.push_back(k);
    MatrixXd places = cluster.places(first);
    out.hulls.push_back(convex_hull(places));
    out.places.push_back(std::move(places));
    out.clusters.push_back(std::move(cluster));
  }
  out.left_out = static_cast<int>(all.rows()) - static_cast<int>(kept.size());
  out.centres = all(kept, Eigen::all);
  return out;
}

RveValue value_of(const Elements& elements, std::size_t k, const dem::Snapshot& state,
                  const ContactsOfGrains& contacts, double radius) {
  const Cluster& cluster = elements.clusters[k];
  const MatrixXd &before = elements.places[k], now = cluster.places(state);
  const Hull& hull = elements.hulls[k];
  const double volume = hull_volume(hull, now), volume_before = hull_volume(hull, before);
  const ClusterForces forces = contacts.of(cluster, now);
  RveValue out;
  out.hull = hull_gradient(hull, before, now - before);
  out.fit = fitted_gradient(before, now - before);
  out.boundary = forces.boundary / volume;
  out.inside = forces.inside / volume;
  const double sphere = 4.0 / 3 * std::numbers::pi * radius * radius * radius;
  out.grains = forces.grains / (sphere * volume / volume_before);
  out.field_zz = kNan;
  out.count = static_cast<double>(cluster.size());
  return out;
}

void add_field(const dem::Snapshot& state, const MatrixXd& points, double radius,
               std::vector<RveValue>& values) {
  if (static_cast<Eigen::Index>(values.size()) != points.rows()) return;
  AverageOptions options;
  options.kernel = "lucy";  // ends at twice its width
  options.width = radius / 2;
  options.least_grains = 1;
  const Field field = average(state, points, options);
  const Column& column = *field.find("sigma_zz");
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k].field_zz = column.value[static_cast<Eigen::Index>(k)];
  }
}

RveStates states_of(const Snapshots& states, int along, double radius, std::size_t loading,
                    int& left_out) {
  const dem::Snapshot& first = states.front().second;
  const dem::SampleState start = dem::sample_state(first);
  const Elements elements = elements_of(first, along, radius);
  left_out += elements.left_out;
  RveStates out;
  for (std::size_t s = 0; s < states.size(); ++s) {
    const dem::Snapshot& state = states[s].second;
    const ContactsOfGrains contacts(state);
    auto& values = out.emplace_back();
    for (std::size_t k = 0; k < elements.clusters.size(); ++k) {
      values.push_back(value_of(elements, k, state, contacts, radius));
    }
    if (s != 0 && s != loading) continue;
    const Matrix3d deformation =
        Matrix3d::Identity() + gradient_between(start, dem::sample_state(state));
    const Eigen::RowVector3d low = corner_of(first).transpose();
    const MatrixXd moved =
        ((elements.centres.rowwise() - low) * deformation.transpose()).rowwise() +
        corner_of(state).transpose();
    add_field(state, moved, radius, values);
  }
  return out;
}

}  // namespace

void check_rves(const RveSetup& setup, const dem::SamplePlan& plan) {
  if (setup.along == 0) return;
  const double most = kEdgeReserve * dem::widest_first_edge(plan) / (2 * plan.radius);
  for (const double radius : setup.radii) {
    if (radius <= most) continue;
    throw std::invalid_argument(
        fmt::format("rve.radii: found {:g}, allowed for {} grains: up to {:g}, half of the least "
                    "edge that the sample can have in its first state, over sample.radius",
                    radius, plan.grains, dem::round_down(most)));
  }
}

RveMean mean_over(const std::vector<RveValue>& values, double (*of)(const RveValue&)) {
  std::vector<double> all;
  for (const RveValue& v : values) all.push_back(of(v));
  const Spread spread = spread_of(all);
  return {spread.mean, spread.standard_error};
}

RveTable rve_table(const std::vector<std::string>& files, const RveSetup& setup,
                   const dem::SamplePlan& plan) {
  RveTable out;
  out.loading = plan.records;
  std::vector<double> radii = setup.radii;
  std::sort(radii.begin(), radii.end());
  for (const double radius : radii) {
    const bool fit = std::all_of(files.begin(), files.end(), [&](const std::string& file) {
      return fits(read_realization(file).snapshots.front().second, radius * plan.radius);
    });
    (fit ? out.radii : out.too_large).push_back(radius);
  }
  out.values.resize(out.radii.size());
  out.left_out.resize(out.radii.size());
  const auto loading = static_cast<std::size_t>(plan.records);
  for (const std::string& file : files) {
    const Snapshots states = read_realization(file).snapshots;
    const dem::SampleState start = dem::sample_state(states.front().second);
    auto& gradients = out.gradients.emplace_back();
    auto& stresses = out.stresses.emplace_back();
    const bool is_first = out.strain.empty();
    for (const auto& [name, state] : states) {
      const dem::SampleState now = dem::sample_state(state);
      gradients.push_back(gradient_between(start, now));
      stresses.push_back(now.contact_stress);
      if (is_first) {
        out.strain.push_back(parse_number(state.attributes.at("strain")).value_or(kNan));
      }
    }
    for (std::size_t r = 0; r < out.radii.size(); ++r) {
      out.values[r].push_back(
          states_of(states, setup.along, out.radii[r] * plan.radius, loading, out.left_out[r]));
    }
    if (!is_first || out.radii.empty()) continue;
    const Elements largest =
        elements_of(states.front().second, setup.along, out.radii.back() * plan.radius);
    if (largest.clusters.empty()) continue;
    out.surface = {largest.places[0],
                   largest.clusters[0].places(states[loading].second) - largest.places[0],
                   largest.hulls[0]};
  }
  return out;
}

}  // namespace grainfield::coupling
