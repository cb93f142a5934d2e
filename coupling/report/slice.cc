#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "coupling/averaging/extent.h"
#include "coupling/report/picture.h"
#include "dem/shapes/superellipsoid.h"

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

// What the plane `away` above a superellipsoid's centre cuts out of it, as a polygon in x and z
// about a point of it; false: nothing. The point lies towards the one where the surface is highest,
// the corners on rays from it where the body's equation says.
bool cut_superellipsoid(const dem::Grain& g, double away, dem::Grain& flat) {
  const dem::RotationOf<3> turn(g.orientation[0], g.orientation[1], g.orientation[2],
                                g.orientation[3]);
  const dem::Superellipsoid body =
      dem::superellipsoid({g.axes.x(), g.axes.y(), g.axes.z()}, g.exponents);
  const dem::Vec3 up(0, away < 0 ? -1 : 1, 0);
  const dem::Support top = dem::support_of(body, turn.conjugate() * up);
  if (std::fabs(away) >= top.height) return false;
  const dem::Vec3 inside = std::fabs(away) / top.height * (turn * top.point);
  const auto is_inside = [&](const dem::Vec3& at) {
    const dem::Vec3 x = (turn.conjugate() * at).cwiseQuotient(g.axes).cwiseAbs();
    const double p = 2 / g.exponents[0], q = 2 / g.exponents[1];
    return std::pow(std::pow(x[0], p) + std::pow(x[1], p), q / p) + std::pow(x[2], q) < 1;
  };
  flat.position = {g.position.x() + inside.x(), g.position.z() + inside.z(), 0};
  flat.radius = 0;
  constexpr int kCorners = 40;
  for (int k = 0; k < kCorners; ++k) {
    const double angle = 2 * std::numbers::pi * k / kCorners;
    const dem::Vec3 way(std::cos(angle), 0, std::sin(angle));
    double low = 0, high = 2 * g.radius;
    for (int n = 0; n < 40; ++n) {
      const double middle = 0.5 * (low + high);
      (is_inside(inside + middle * way) ? low : high) = middle;
    }
    flat.outline.push_back({low * way.x(), low * way.z()});
    flat.radius = std::max(flat.radius, low);
  }
  return flat.radius > 0;
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
    if (!g.axes.isZero(0)) {
      if (!cut_superellipsoid(s.grains[k], -away, g)) continue;
    } else {
      g.position = {g.position.x(), g.position.z(), 0};
      g.radius = std::sqrt(g.radius * g.radius - away * away);
    }
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
  const bool spheres = std::all_of(snapshot.grains.begin(), snapshot.grains.end(),
                                   [](const dem::Grain& g) { return g.axes.isZero(0); });
  picture.caption = fmt::format(
      "The {0} that the plane y = {1:.4g} m cuts out of the {2}, and the normal forces between {2} "
      "that it cuts both. {3}",
      spheres ? "disks" : "sections", y, spheres ? "spheres" : "superellipsoids", picture.caption);
  return picture;
}

}  // namespace grainfield::coupling
