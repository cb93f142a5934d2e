#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "coupling/averaging/extent.h"
#include "coupling/report/picture.h"

namespace grainfield::coupling {
namespace {

// The middle of the sample along y.
double middle_of(const dem::Snapshot& s) {
  if (s.cell.is_periodic()) return s.cell.low.y() + 0.5 * s.cell.edges(1, 1);
  double least = 0, most = 0;
  bool any = false;
  for (const dem::Grain& g : s.grains) {
    least = any ? std::min(least, g.position.y()) : g.position.y();
    most = any ? std::max(most, g.position.y()) : g.position.y();
    any = true;
  }
  return 0.5 * (least + most);
}

// The disks that the plane cuts out of the spheres, as a packing in the plane of x and z.
dem::Snapshot cut(const dem::Snapshot& s, double y) {
  dem::Snapshot out;
  out.dim = 2;
  out.cell.periodic = {s.cell.periodic[0], s.cell.periodic[2], false};
  out.cell.low << s.cell.low.x(), s.cell.low.z(), 0;
  out.cell.edges(0, 0) = s.cell.edges(0, 0);
  out.cell.edges(0, 1) = s.cell.edges(0, 2);
  out.cell.edges(1, 1) = s.cell.edges(2, 2);
  std::vector<std::int64_t> place(s.grains.size(), -1);
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    dem::Grain g = s.grains[k];
    const double away = g.position.y() - y;
    if (std::fabs(away) >= g.radius) continue;
    g.position = {g.position.x(), g.position.z(), 0};
    g.radius = std::sqrt(g.radius * g.radius - away * away);
    place[k] = static_cast<std::int64_t>(out.grains.size());
    out.grains.push_back(g);
  }
  for (const dem::Contact& c : s.contacts) {
    if (c.j < 0 || c.image[1] != 0) continue;
    const std::int64_t i = place[static_cast<std::size_t>(c.i)];
    const std::int64_t j = place[static_cast<std::size_t>(c.j)];
    if (i < 0 || j < 0) continue;
    dem::Contact flat = c;
    flat.i = i;
    flat.j = j;
    flat.image = {c.image[0], c.image[2], 0};
    out.contacts.push_back(flat);
  }
  return out;
}

}  // namespace

Picture slice(const std::string& title, const dem::Snapshot& snapshot) {
  const double y = middle_of(snapshot);
  Picture picture = packing(title, cut(snapshot, y), nullptr, "z");
  picture.caption = fmt::format(
      "The disks that the plane y = {:.4g} m cuts out of the spheres, and the normal forces "
      "between "
      "spheres that it cuts both. {}",
      y, picture.caption);
  return picture;
}

}  // namespace grainfield::coupling
