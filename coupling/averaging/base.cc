#include "coupling/averaging/base.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "dem/snapshot/contact_changes.h"

namespace grainfield::coupling {
bool has_base(const dem::Snapshot& snapshot) {
  return std::any_of(snapshot.walls.begin(), snapshot.walls.end(),
                     [](const dem::Wall& wall) { return wall.name == "floor"; }) ||
         std::any_of(snapshot.grains.begin(), snapshot.grains.end(),
                     [](const dem::Grain& grain) { return grain.fixed; });
}

std::vector<BaseSupport> base_supports(const dem::Snapshot& snapshot) {
  std::vector<BaseSupport> out;
  for (const dem::Contact& contact : snapshot.contacts) {
    const dem::Grain& gi = snapshot.grains[static_cast<std::size_t>(contact.i)];
    if (contact.j < 0) {
      const dem::Wall& wall = snapshot.walls[static_cast<std::size_t>(-1 - contact.j)];
      if (!gi.fixed && wall.name == "floor") out.push_back({contact.point, contact.force});
      continue;
    }
    const bool fixed_j = snapshot.grains[static_cast<std::size_t>(contact.j)].fixed;
    if (gi.fixed != fixed_j) {
      out.push_back({contact.point, fixed_j ? contact.force : Eigen::Vector3d(-contact.force)});
    }
  }
  return out;
}

Field base_profile(const dem::Snapshot& snapshot, const Eigen::VectorXd& x, const Kernel& kernel) {
  if (snapshot.dim != 2)
    throw std::invalid_argument("stress on the base along a line: found a packing in space");
  if (!has_base(snapshot)) {
    std::string walls;
    for (const dem::Wall& wall : snapshot.walls) walls += (walls.empty() ? "" : ", ") + wall.name;
    throw std::invalid_argument(
        "stress on the base: the packing has neither fixed grains nor a wall named \"floor\"; its "
        "walls: " +
        (walls.empty() ? std::string("none") : walls));
  }
  Field field;
  field.points.resize(x.size(), 2);
  field.points.col(0) = x;
  field.points.col(1).setConstant(layer_frame(snapshot).floor);
  Eigen::VectorXd yy = Eigen::VectorXd::Zero(x.size()), xy = yy, count = yy;
  for (const BaseSupport& s : base_supports(snapshot)) {
    for (Eigen::Index p = 0; p < x.size(); ++p) {
      const double distance = x[p] - s.point.x();
      if (std::abs(distance) >= kernel.range()) continue;
      const double weight = kernel.marginal(distance);
      yy[p] -= weight * s.force.y();
      xy[p] -= weight * s.force.x();
      count[p] += 1;
    }
  }
  field.add("sigma_yy", "N/m").value = yy;
  field.add("sigma_xy", "N/m").value = xy;
  field.add("contacts", "1").value = count;
  field.attributes = {
      {"what", "stress on the base"}, {"kernel", kernel.name()}, {"sign", "tension positive"}};
  return field;
}

Field base_response(const dem::Snapshot& unloaded, const dem::Snapshot& loaded,
                    const Eigen::VectorXd& x, const Kernel& kernel) {
  require_same_grains(unloaded, loaded);
  Field change = change_between(base_profile(unloaded, x, kernel), base_profile(loaded, x, kernel),
                                "contacts");
  change.attributes["what"] = "stress on the base, loaded - unloaded";
  return change;
}

double total_over_load(const dem::Snapshot& unloaded, const dem::Snapshot& loaded) {
  require_same_grains(unloaded, loaded);
  const int up = loaded.dim - 1;
  const double load = dem::total_applied_force(unloaded)[up] - dem::total_applied_force(loaded)[up];
  if (load == 0) return std::numeric_limits<double>::quiet_NaN();
  return (dem::base_force(loaded) - dem::base_force(unloaded))[up] / load;
}

}  // namespace grainfield::coupling
