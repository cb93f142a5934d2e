#include "dem/snapshot/check_snapshot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grainfield::dem {
namespace {

// A quaternion is this near to length 1; what other programs write has six digits or more.
constexpr double kUnit = 1e-5;
// Area or volume of the periodic edges over the product of their lengths: less is flat.
constexpr double kFlat = 1e-9;

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw std::invalid_argument(fmt::format("{}: {}", where, what));
}

void check_grains(const Snapshot& s, const std::string& where) {
  if (s.dim != 3) return;
  for (const Grain& g : s.grains) {
    const auto& q = g.orientation;
    const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(std::fabs(size - 1) <= kUnit))
      refuse(where, fmt::format("orientation of grain {} has length {:g}; it must be a unit "
                                "quaternion (w, x, y, z)",
                                g.id, size));
    if (!g.fixed && !(g.moments.minCoeff() > 0))
      refuse(where, fmt::format("moments of grain {} are {:g}, {:g}, {:g}; those of a free grain "
                                "must be above 0",
                                g.id, g.moments.x(), g.moments.y(), g.moments.z()));
    if (g.axes.isZero(0)) continue;
    if (!(g.axes.minCoeff() > 0))
      refuse(where,
             fmt::format("axes of grain {} are {:g}, {:g}, {:g} m; those of a superellipsoid "
                         "must be above 0",
                         g.id, g.axes.x(), g.axes.y(), g.axes.z()));
    if (!(g.exponents[0] > 0 && g.exponents[0] < 2 && g.exponents[1] > 0 && g.exponents[1] < 2))
      refuse(where, fmt::format("exponents of grain {} are {:g}, {:g}; those of a superellipsoid "
                                "must be between 0 and 2",
                                g.id, g.exponents[0], g.exponents[1]));
  }
}

void check_wall(const Wall& w, const std::string& where) {
  const auto& shapes = wall_shapes();
  if (std::find(shapes.begin(), shapes.end(), w.shape) == shapes.end())
    refuse(where, fmt::format("shape of wall {} is \"{}\"; allowed: {}", w.name, w.shape,
                              fmt::join(shapes, ", ")));
  if (w.shape == "mesh" ? w.triangles.empty() : !w.triangles.empty())
    refuse(where,
           fmt::format("wall {} is a {} with {} triangles", w.name, w.shape, w.triangles.size()));
  if (w.shape == "cylinder" && !(w.radius > 0))
    refuse(where, fmt::format("radius of wall {} is {:g} m; it must be above 0", w.name, w.radius));
  if (w.shape == "cone" &&
      !(w.radius >= 0 && w.end_radius >= 0 && w.length > 0 && w.radius + w.end_radius > 0))
    refuse(where,
           fmt::format("wall {} is a cone of radii {:g} and {:g} m and length {:g} m; allowed: "
                       "radii of 0 or more, one of them and the length above 0",
                       w.name, w.radius, w.end_radius, w.length));
  if (w.length < 0)
    refuse(where,
           fmt::format("length of wall {} is {:g} m; it must be 0 or more", w.name, w.length));
}

void check_cell(const Snapshot& s, const std::string& where) {
  const Cell<3>& cell = s.cell;
  if (!cell.low.allFinite() || !cell.edges.allFinite() || !cell.velocity_gradient.allFinite())
    refuse(where, "the cell holds a number that is not finite");
  if (s.dim == 2 && cell.periodic[2]) refuse(where, "a cell in 2D is periodic along z");
  // What the periodic edges span, one after another (Gram and Schmidt).
  std::vector<Vec3> across;
  for (int k = 0; k < 3; ++k) {
    if (!cell.periodic[static_cast<std::size_t>(k)]) continue;
    const Vec3 edge = cell.edges.col(k);
    Vec3 rest = edge;
    for (const Vec3& a : across) rest -= rest.dot(a) * a;
    if (!(rest.norm() > kFlat * edge.norm()))
      refuse(where, fmt::format("edge {} of the cell is ({:g}, {:g}, {:g}) m; periodic edges must "
                                "span a space",
                                "xyz"[k], edge.x(), edge.y(), edge.z()));
    if (s.dim == 2 && edge.z() != 0)
      refuse(where, fmt::format("edge {} of the cell leaves the plane in 2D", "xyz"[k]));
    across.push_back(rest.normalized());
  }
}

void check_images(const Snapshot& s, const std::string& where) {
  for (const Grain& g : s.grains) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (g.image[a] == 0 || s.cell.periodic[a]) continue;
      refuse(where,
             fmt::format("image of grain {} is {}, {}, {}; the cell is not periodic along {}", g.id,
                         g.image[0], g.image[1], g.image[2], "xyz"[a]));
    }
  }
}

void check_contacts(const Snapshot& s, const std::string& where) {
  const auto grains = static_cast<std::int64_t>(s.grains.size());
  const auto walls = static_cast<std::int64_t>(s.walls.size());
  for (std::size_t k = 0; k < s.contacts.size(); ++k) {
    const Contact& c = s.contacts[k];
    if (c.i < 0 || c.i >= grains || c.j >= grains || c.j < -walls)
      refuse(where,
             fmt::format("contact {} names the unknown grain or wall ({}, {})", k, c.i, c.j));
    for (std::size_t a = 0; a < 3; ++a) {
      if (c.image[a] == 0 || (s.cell.periodic[a] && c.j >= 0)) continue;
      refuse(where,
             fmt::format("image of contact {} is {}, {}, {}; {}", k, c.image[0], c.image[1],
                         c.image[2],
                         c.j < 0 ? "walls have no images"
                                 : fmt::format("the cell is not periodic along {}", "xyz"[a])));
    }
  }
}

}  // namespace

const std::vector<std::string>& wall_shapes() {
  static const std::vector<std::string> shapes{"plane", "cylinder", "cone", "mesh"};
  return shapes;
}

void check_snapshot(const Snapshot& s, const std::string& where) {
  check_grains(s, where);
  for (const Wall& wall : s.walls) check_wall(wall, where);
  check_cell(s, where);
  check_images(s, where);
  check_contacts(s, where);
}

}  // namespace grainfield::dem
