#include "dem/snapshot/check_snapshot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "dem/shared/refuse.h"
#include "dem/snapshot/images.h"
#include "dem/snapshot/limits.h"

namespace grainfield::dem {
namespace {

// Area or volume of the periodic edges over the product of their lengths: less is flat.
constexpr double kFlat = 1e-9;

// Written by another program they need not be in ascending order.
void check_ids(const Snapshot& s, const std::string& where) {
  const auto& grains = s.grains;
  const auto ascends = [](const Grain& a, const Grain& b) { return a.id < b.id; };
  if (std::adjacent_find(grains.begin(), grains.end(), [&](const Grain& a, const Grain& b) {
        return !ascends(a, b);
      }) == grains.end())
    return;
  std::vector<std::size_t> order(grains.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return ascends(grains[a], grains[b]); });
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (ascends(grains[order[k - 1]], grains[order[k]])) continue;
    refuse(where, fmt::format("id of the grains in rows {} and {} is {}; it must be another one "
                              "for every grain",
                              order[k - 1], order[k], grains[order[k]].id));
  }
}

void check_load(const Snapshot& s, const std::string& where) {
  if (s.loaded_grain == -1 && s.also_loaded.empty()) return;
  const auto require = [&](std::int64_t id, const char* name) {
    if (std::any_of(s.grains.begin(), s.grains.end(), [&](const Grain& g) { return g.id == id; }))
      return;
    refuse(where, fmt::format("{} is {}; it must be the id of a grain{}", name, id,
                              id == s.loaded_grain ? ", or -1 for none" : ""));
  };
  if (s.loaded_grain != -1) require(s.loaded_grain, "loaded_grain");
  if (s.also_loaded.empty()) return;
  std::vector<std::int64_t> ids;
  ids.reserve(s.grains.size());
  for (const Grain& g : s.grains) ids.push_back(g.id);
  std::sort(ids.begin(), ids.end());
  for (const std::int64_t id : s.also_loaded)
    if (!std::binary_search(ids.begin(), ids.end(), id)) require(id, "also_loaded");
}

void check_sizes(const Snapshot& s, const std::string& where) {
  for (const Grain& g : s.grains) {
    if (!(g.radius > 0))
      refuse(where,
             fmt::format("radius of grain {} is {:g} m; it must be above 0", g.id, g.radius));
    for (const auto& [name, value] : {std::pair{"mass", g.mass}, {"volume", g.volume}}) {
      if (value > 0 || (g.fixed && value == 0)) continue;
      refuse(where, fmt::format("{} of grain {} is {:g}; it must be {}", name, g.id, value,
                                g.fixed ? "0 or more for a fixed grain" : "above 0"));
    }
  }
}

void check_grains(const Snapshot& s, const std::string& where) {
  check_ids(s, where);
  check_load(s, where);
  check_sizes(s, where);
  if (s.dim != 3) return;
  for (const Grain& g : s.grains) {
    const auto& q = g.orientation;
    const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(std::fabs(size - 1) <= kUnitTolerance))
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

bool is_unit(const Vec3& normal) { return std::fabs(normal.norm() - 1) <= kUnitTolerance; }

void check_wall(const Wall& w, const std::string& where) {
  const auto& shapes = wall_shapes();
  if (std::find(shapes.begin(), shapes.end(), w.shape) == shapes.end())
    refuse(where, fmt::format("shape of wall {} is \"{}\"; allowed: {}", w.name, w.shape,
                              fmt::join(shapes, ", ")));
  if (w.shape == "mesh" ? w.triangles.empty() : !w.triangles.empty())
    refuse(where,
           fmt::format("wall {} is a {} with {} triangles", w.name, w.shape, w.triangles.size()));
  if (w.shape != "mesh" && !is_unit(w.normal))
    refuse(where, fmt::format("normal of wall {} has length {:g}; it must be a unit vector", w.name,
                              w.normal.norm()));
  if (w.friction < 0)
    refuse(where,
           fmt::format("friction of wall {} is {:g}; it must be 0 or more", w.name, w.friction));
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

// Contact k, whose grains and image there are.
void check_contact(const Snapshot& s, std::size_t k, const std::string& where) {
  const Contact& c = s.contacts[k];
  if (!is_unit(c.normal))
    refuse(where, fmt::format("normal of contact {} has length {:g}; it must be a unit vector", k,
                              c.normal.norm()));
  const double along = -c.force.dot(c.normal);
  // Below the smallest numbers of full precision rounding is all there is.
  if (!(std::fabs(c.normal_force - along) <=
        kUnitTolerance * c.force.norm() + std::numeric_limits<double>::min()))
    refuse(where, fmt::format("normal_force of contact {} is {:g} N; it must be what force and "
                              "normal say, {:g} N",
                              k, c.normal_force, along));
  if (c.friction < 0)
    refuse(where,
           fmt::format("friction of contact {} is {:g}; it must be 0 or more", k, c.friction));
  const Grain& i = s.grains[static_cast<std::size_t>(c.i)];
  double radius = i.radius, away = (c.point - i.position).norm();
  if (c.j >= 0) {
    radius = std::max(radius, s.grains[static_cast<std::size_t>(c.j)].radius);
    away = std::max(away, (c.point - second_place(s, c)).norm());
  }
  if (!(away <= kMostRadii * radius))
    refuse(where,
           fmt::format("point of contact {} is {:g} m from a grain of its; it must be within "
                       "{:g} radii, {:g} m",
                       k, away, kMostRadii, kMostRadii * radius));
}

void check_contacts(const Snapshot& s, const std::string& where) {
  const auto grains = static_cast<std::int64_t>(s.grains.size());
  const auto walls = static_cast<std::int64_t>(s.walls.size());
  for (std::size_t k = 0; k < s.contacts.size(); ++k) {
    const Contact& c = s.contacts[k];
    if (c.i < 0 || c.i >= grains || c.j >= grains || c.j < -walls)
      refuse(where,
             fmt::format("contact {} names the unknown grain or wall ({}, {})", k, c.i, c.j));
    if (c.i == c.j && c.image == std::array<int, 3>{0, 0, 0})
      refuse(where, fmt::format("j of contact {} is {} as its i is; a grain does not touch itself",
                                k, c.j));
    for (std::size_t a = 0; a < 3; ++a) {
      if (c.image[a] == 0 || (s.cell.periodic[a] && c.j >= 0)) continue;
      refuse(where,
             fmt::format("image of contact {} is {}, {}, {}; {}", k, c.image[0], c.image[1],
                         c.image[2],
                         c.j < 0 ? "walls have no images"
                                 : fmt::format("the cell is not periodic along {}", "xyz"[a])));
    }
    check_contact(s, k, where);
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
