#include "coupling/averaging/grain_facts.h"

#include <cmath>
#include <numbers>

#include "dem/shapes/polygon.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

bool bears(const dem::Contact& contact) { return contact.force.squaredNorm() > 0; }

}  // namespace

Matrix3d inertia_of(const dem::Grain& grain, int dim) {
  Matrix3d second = Matrix3d::Zero();
  if (dim == 2) {
    if (grain.outline.empty()) {
      second(0, 0) = second(1, 1) = grain.volume * grain.radius * grain.radius / 4;
    } else {
      const auto m = dem::second_moments_of(grain.outline);
      const double c = std::cos(grain.angle), s = std::sin(grain.angle);
      second(0, 0) = c * c * m[0] + s * s * m[1] - 2 * s * c * m[2];
      second(1, 1) = s * s * m[0] + c * c * m[1] + 2 * s * c * m[2];
      second(0, 1) = second(1, 0) = s * c * (m[0] - m[1]) + (c * c - s * s) * m[2];
    }
    Matrix3d theta = Matrix3d::Zero();
    theta(0, 0) = second(1, 1);
    theta(1, 1) = second(0, 0);
    theta(0, 1) = theta(1, 0) = -second(0, 1);
    return theta;
  }
  const double radius = std::cbrt(3 * grain.volume / (4 * std::numbers::pi));
  return 0.4 * grain.volume * radius * radius * Matrix3d::Identity();
}

std::vector<bool> rattlers(const dem::Snapshot& snapshot) {
  const std::size_t n = snapshot.grains.size();
  std::vector<int> supports(n, 0);
  std::vector<std::size_t> start(n + 1, 0);
  const auto pair = [&](const dem::Contact& c, auto&& act) {
    if (!bears(c)) return;
    act(static_cast<std::size_t>(c.i), c.j);
    if (c.j >= 0) act(static_cast<std::size_t>(c.j), c.i);
  };
  for (const dem::Contact& c : snapshot.contacts)
    pair(c, [&](std::size_t g, std::int64_t other) {
      ++supports[g];
      if (other >= 0) ++start[g + 1];
    });
  for (std::size_t g = 0; g < n; ++g) start[g + 1] += start[g];
  std::vector<std::size_t> neighbours(start[n]), next(start.begin(), start.end() - 1);
  for (const dem::Contact& c : snapshot.contacts)
    pair(c, [&](std::size_t g, std::int64_t other) {
      if (other >= 0) neighbours[next[g]++] = static_cast<std::size_t>(other);
    });
  const bool loaded = snapshot.applied_force.squaredNorm() > 0;
  std::vector<bool> out(n, false);
  std::vector<std::size_t> loose;
  const auto look = [&](std::size_t g) {
    const dem::Grain& grain = snapshot.grains[g];
    const int load = loaded && dem::is_loaded(snapshot, grain.id) ? 1 : 0;
    if (out[g] || grain.fixed || supports[g] + load >= 2) return;
    out[g] = true;
    loose.push_back(g);
  };
  for (std::size_t g = 0; g < n; ++g) look(g);
  while (!loose.empty()) {
    const std::size_t g = loose.back();
    loose.pop_back();
    for (std::size_t k = start[g]; k < start[g + 1]; ++k) {
      --supports[neighbours[k]];
      look(neighbours[k]);
    }
  }
  return out;
}

std::vector<GrainFacts> grain_facts(const dem::Snapshot& snapshot) {
  const std::vector<bool> loose = rattlers(snapshot);
  std::vector<GrainFacts> facts(snapshot.grains.size());
  for (std::size_t g = 0; g < facts.size(); ++g) {
    facts[g].grain = &snapshot.grains[g];
    facts[g].bearing = !loose[g];
    facts[g].inertia = inertia_of(snapshot.grains[g], snapshot.dim);
    if (dem::is_loaded(snapshot, snapshot.grains[g].id)) facts[g].load = snapshot.applied_force;
  }
  for (const dem::Contact& contact : snapshot.contacts) {
    const auto i = static_cast<std::size_t>(contact.i);
    const auto add = [&](std::size_t grain, const Vector3d& place, double sign, bool bearing) {
      GrainFacts& fact = facts[grain];
      const Vector3d x = contact.point - place;
      fact.virial += sign * contact.force * x.transpose();
      const double length = x.norm();
      const Vector3d n = length > 0 ? Vector3d(x / length) : Vector3d(sign * contact.normal);
      fact.fabric += n * n.transpose();
      ++fact.contacts;
      if (bearing) ++fact.bearing_contacts;
    };
    bool bearing = bears(contact) && !loose[i];
    if (contact.j >= 0) {
      const auto j = static_cast<std::size_t>(contact.j);
      bearing = bearing && !loose[j];
      add(j, dem::second_place(snapshot, contact), -1, bearing);
    }
    add(i, facts[i].grain->position, 1, bearing);
  }
  return facts;
}

}  // namespace grainfield::coupling
