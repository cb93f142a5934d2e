#include "coupling/structure/base_forces.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace grainfield::coupling {

BaseForces base_forces(const dem::Snapshot& s) {
  dem::Vec3 up(0, 0, 0);
  up[s.dim - 1] = 1;
  if (s.gravity.norm() > 0) up = -s.gravity.normalized();
  std::vector<double> force(s.grains.size(), 0);
  std::vector<bool> lowest(s.grains.size(), false);
  for (const dem::Contact& c : s.contacts) {
    const auto i = static_cast<std::size_t>(c.i);
    const auto add = [&](std::size_t grain, const dem::Vec3& f) {
      force[grain] += f.dot(up);
      lowest[grain] = true;
    };
    if (c.j < 0) {
      if (!s.grains[i].fixed && s.walls[static_cast<std::size_t>(-1 - c.j)].name == "floor")
        add(i, c.force);
      continue;
    }
    const auto j = static_cast<std::size_t>(c.j);
    if (s.grains[i].fixed == s.grains[j].fixed) continue;
    if (s.grains[j].fixed)
      add(i, c.force);
    else
      add(j, -c.force);
  }
  std::vector<std::size_t> order;
  for (std::size_t g = 0; g < lowest.size(); ++g)
    if (lowest[g]) order.push_back(g);
  if (order.empty())
    throw std::invalid_argument(
        "no free grain touches the base (a wall named \"floor\" or a fixed grain)");
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return s.grains[a].position.x() < s.grains[b].position.x();
  });
  BaseForces out;
  const auto n = static_cast<Eigen::Index>(order.size());
  out.x.resize(n);
  out.force.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::size_t g = order[static_cast<std::size_t>(k)];
    out.ids.push_back(s.grains[g].id);
    out.x[k] = s.grains[g].position.x();
    out.force[k] = force[g];
  }
  out.mean = out.force.mean();
  out.normalised = out.mean == 0
                       ? Eigen::VectorXd::Constant(n, std::numeric_limits<double>::quiet_NaN())
                       : Eigen::VectorXd(out.force / out.mean);
  return out;
}

}  // namespace grainfield::coupling
