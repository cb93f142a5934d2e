// Contacts between grains and with walls: image, point, normal, and whether they are any.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "coupling/averaging/contact_geometry.h"
#include "coupling/import/assemble.h"
#include "dem/snapshot/images.h"
#include "dem/snapshot/limits.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;

// A contact point farther than this many radii from a grain's centre lies across a periodic
// boundary: contacts of stiff grains lie within one radius, of very soft ones slightly beyond.
constexpr double kDistant = 2;
// Cosine of the angle between a wall's normal and the direction from a contact point to its grain's
// centre, least, and of the way from the wall to the centre of a disk or sphere, radii, where no
// point is told: disks and spheres lie on what they touch, corners of polygons may stand out far.
constexpr double kLeastCosine = 0.5, kLeastCosineOfPolygon = 0.1, kLeastHeight = 0.25;
constexpr int kAllDigits = 15;       // of a number that was not rounded in printing
constexpr double kNotUnit = 1e-3;    // of a normal's length from 1
constexpr double kOffSurface = 0.5;  // radii from both surfaces to a contact point, but for overlap
constexpr double kAcrossNormal = 0.5;  // cosine of the angle to the wall's normal
// Radii: a force across a wider gap to a wall, whose place is often told by hand, is in doubt; so
// is a deeper overlap.
constexpr double kOffShape = 0.2;  // radii from a shape to a contact point, but for overlap
constexpr double kWallGap = 0.01, kWallOverlap = 0.2;
constexpr double kOffTwice = 0.05;  // of a distance, from twice the radii
// Share of the Coulomb limit: a contact this near to it slides.
constexpr double kSliding = 1e-6;

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double share = std::clamp((p - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (p - a - share * way).norm();
}

// The distance of a point in the plane from the edges of a grain's outline.
double distance_to_outline(const dem::Grain& g, const Vec3& point) {
  const double cosine = std::cos(g.angle), sine = std::sin(g.angle);
  const auto corner = [&](std::size_t k) -> Vec3 {
    const auto& [x, y] = g.outline[k % g.outline.size()];
    return g.position + Vec3(cosine * x - sine * y, sine * x + cosine * y, 0);
  };
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < g.outline.size(); ++k)
    least = std::min(least, distance_to_segment(point, corner(k), corner(k + 1)));
  return least;
}

}  // namespace

void Assembly::check_point_of_shapes(const dem::Contact& c) {
  const dem::Snapshot& s = out_.snapshot;
  const Vec3 normal = c.normal.normalized();
  const double overlap = std::max(0.0, -gap_of(s, c));
  const auto is_shape = [](const dem::Grain& g) { return !g.outline.empty() || !g.axes.isZero(0); };
  bool any = false, off = false;
  const auto check = [&](const dem::Grain& g, const Vec3& outwards) {
    if (!is_shape(g)) return;
    any = true;
    // Along the normal the body ends at the contact; an outline's edges are near it, too.
    double away = std::abs((farthest_along(g, outwards) - c.point).dot(outwards));
    if (!g.outline.empty()) away = std::max(away, distance_to_outline(g, c.point));
    off = off || away > overlap + kOffShape * g.radius;
  };
  const dem::Grain& first = s.grains[static_cast<std::size_t>(c.i)];
  check(first, normal);
  if (c.j >= 0) {
    dem::Grain second = s.grains[static_cast<std::size_t>(c.j)];
    second.position = dem::second_place(s, c);
    check(second, -normal);
  }
  tally_.shaped += any;
  if (off && tally_.off_shape++ == 0) tally_.first_off_shape = fmt::format("of grain {}", first.id);
}

void Assembly::set_spring(const std::optional<Vec3>& spring, dem::Contact& c) const {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  c.spring = nan;
  if (out_.snapshot.dim == 2) return;
  c.spring_vector = spring.value_or(Vec3(nan, nan, nan));
  if (spring) c.spring = spring->norm();
}

void Assembly::ContactRow::refuse(const std::string& what) const {
  throw std::invalid_argument(source.where() + ": " + what);
}

void Assembly::check_periods(const ContactRow& row) const {
  const dem::Snapshot& s = out_.snapshot;
  const dem::Contact& c = row.contact;
  if (c.i != c.j) return;
  const dem::Grain& grain = s.grains[static_cast<std::size_t>(c.i)];
  std::string cell;
  for (Eigen::Index a = 0; a < 3; ++a)
    if (s.cell.periodic[static_cast<std::size_t>(a)])
      cell += fmt::format("{}{:g} m along {}", cell.empty() ? "" : ", ", s.cell.edges.col(a).norm(),
                          "xyz"[a]);
  if (!cell.empty())
    row.refuse(
        fmt::format("grain {} of diameter {:g} m in contact with itself: the periodic cell is only "
                    "{} wide, allowed: wider than two grains, so that each touches others only",
                    grain.id, 2 * grain.radius, cell));
  row.refuse(fmt::format(
      "grain {} in contact with itself{}", grain.id,
      options_.files.empty() ? "" : ", and no axis is periodic (--periodic AXIS=LOW:HIGH)"));
}

void Assembly::check_wall_distance(const ContactRow& row, bool has_point) const {
  const dem::Snapshot& s = out_.snapshot;
  const dem::Contact& c = row.contact;
  const dem::Grain& a = s.grains[static_cast<std::size_t>(c.i)];
  const dem::Wall& wall = s.walls[static_cast<std::size_t>(-1 - c.j)];
  const double arm = (c.point - a.position).norm();
  if (arm <= kDistant * a.radius) return;
  const double height = std::abs((a.position - wall.point).dot(wall.normal));
  if (has_point && height <= kDistant * a.radius)
    row.refuse(fmt::format(
        "the point ({:g}, {:g}, {:g}) m of the contact with wall {} is {:g} m from "
        "grain {} of radius {:g} m, allowed: up to {:g} radii; are points and places in one unit?",
        c.point.x(), c.point.y(), c.point.z(), wall.name, arm, a.id, a.radius, kDistant));
  row.refuse(fmt::format(
      "grain {} of radius {:g} m in contact with wall {} at a distance of {:g} m: is the wall "
      "where it says?",
      a.id, a.radius, wall.name, arm));
}

bool Assembly::settle_wall_contact(ContactRow& row, bool has_point) {
  const dem::Snapshot& s = out_.snapshot;
  dem::Contact& c = row.contact;
  const dem::Grain& a = s.grains[static_cast<std::size_t>(c.i)];
  const dem::Wall& wall = s.walls[static_cast<std::size_t>(-1 - c.j)];
  c.normal = -wall.normal;
  if (c.force.isZero(0) && gap_of(s, c) > kGap * a.radius) {
    tally_.idle.emplace_back(c.i, c.j);
    return false;
  }
  if (!has_point) {
    if (!a.outline.empty())
      row.refuse(fmt::format("grain {} is a polygon: its contacts need px and py", a.id));
    const Vec3 lowest = farthest_along(a, -wall.normal);
    c.point = lowest - (lowest - wall.point).dot(wall.normal) * wall.normal;
  }
  check_wall_distance(row, has_point);
  check_wall_side(c, has_point);
  check_wall_gap(c);
  if (has_point) check_point_of_shapes(c);
  return true;
}

std::array<int, 3> Assembly::image_towards(const dem::Contact& c, const Vec3& direction) const {
  const dem::Snapshot& s = out_.snapshot;
  const dem::Grain &a = s.grains[static_cast<std::size_t>(c.i)],
                   &b = s.grains[static_cast<std::size_t>(c.j)];
  const double reach = a.radius + b.radius + kGap * std::min(a.radius, b.radius);
  const auto branch = [&](const std::array<int, 3>& image) -> Vec3 {
    return b.position + dem::shift_to(s.cell, image) - a.position;
  };
  std::array<int, 3> best = c.image;
  if (branch(best).dot(direction) > 0) return best;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int step : {-1, 1}) {
      if (!s.cell.periodic[axis]) continue;
      std::array<int, 3> image = c.image;
      image[axis] += step;
      const Vec3 way = branch(image);
      if (way.norm() > reach || way.norm() >= nearest || !(way.dot(direction) > 0)) continue;
      nearest = way.norm();
      best = image;
    }
  return best;
}

void Assembly::set_image(ContactRow& row, bool has_normal, bool has_point) const {
  const dem::Snapshot& s = out_.snapshot;
  dem::Contact& c = row.contact;
  const Vec3 &a = s.grains[static_cast<std::size_t>(c.i)].position,
             &b = s.grains[static_cast<std::size_t>(c.j)].position;
  try {
    c.image = dem::nearest_image(s.cell, b - a);
    if (!s.cell.is_periodic()) return;
    if (!has_point) {
      if (has_normal || !c.force.isZero(0))
        c.image = image_towards(c, has_normal ? c.normal : Vec3(-c.force));
      return;
    }
    // Two grains of a narrow cell touch through several images: the point tells which.
    const auto other = dem::nearest_image(s.cell, b - (a + 2 * (c.point - a)));
    const auto away = [&](const std::array<int, 3>& image) {
      return (b + dem::shift_to(s.cell, image) - c.point).norm();
    };
    if (away(other) < away(c.image)) c.image = other;
  } catch (const std::invalid_argument& e) {
    row.refuse(e.what());
  }
}

bool Assembly::settle_pair(ContactRow& row, bool has_normal, bool has_point) {
  const dem::Snapshot& s = out_.snapshot;
  dem::Contact& c = row.contact;
  const dem::Grain &a = s.grains[static_cast<std::size_t>(c.i)],
                   &b = s.grains[static_cast<std::size_t>(c.j)];
  set_image(row, has_normal, has_point);
  const Vec3 branch = dem::second_place(s, c) - a.position;
  const double d = branch.norm();
  if (!(d > 0))
    row.refuse(fmt::format("grains {} and {} have the same centre, allowed: a place for each", a.id,
                           b.id));
  const double gap = gap_of(s, c), touch = kGap * std::min(a.radius, b.radius);
  if (gap > touch && c.force.isZero(0)) {
    tally_.idle.emplace_back(c.i, c.j);
    return false;
  }
  const bool polygons = !a.outline.empty() || !b.outline.empty();
  if (polygons && !(has_normal && has_point))
    row.refuse(fmt::format("contact of grains {} and {}: those of polygons need px, py, nx and ny",
                           a.id, b.id));
  if (!a.axes.isZero(0) || !b.axes.isZero(0)) {
    const CommonPlane plane = common_plane(a, b, branch);
    if (!has_normal) c.normal = plane.normal;
    if (!has_point) c.point = a.position + plane.point;
  } else {
    if (!has_normal) c.normal = branch / d;
    // The middle of the chord in which two overlapping circles cross.
    const double arm = (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d);
    if (!has_point) c.point = a.position + arm * branch / d;
  }
  if (has_point && !polygons && a.axes.isZero(0) && b.axes.isZero(0)) {
    const Vec3 second = dem::second_place(s, c);
    const double overlap = std::max(0., a.radius + b.radius - d);
    const double off = std::max(std::abs((c.point - a.position).norm() - a.radius),
                                std::abs((c.point - second).norm() - b.radius));
    ++tally_.pointed;
    if (off > overlap + kOffSurface * std::min(a.radius, b.radius) && tally_.off_surface++ == 0)
      tally_.first_off = fmt::format("{} and {}", a.id, b.id);
  }
  if (!check_pair_distance(row, has_point)) return false;
  if (has_point) check_point_of_shapes(c);
  if (gap <= touch) return true;
  if (gap <= touch + rounding_of_gap(a, b)) {
    ++tally_.below_digits;
  } else if (tally_.far++ == 0) {
    tally_.first_far = fmt::format("{} and {}", a.id, b.id);
  }
  return true;
}

double Assembly::rounding_of_gap(const dem::Grain& a, const dem::Grain& b) const {
  if (place_digits_ >= kAllDigits) return 0;
  const auto rounding = [&](double number) {
    if (number == 0) return 0.0;
    return 0.5 * std::pow(10.0, std::floor(std::log10(std::abs(number))) + 1 - place_digits_);
  };
  double out = 0;
  for (const dem::Grain* grain : {&a, &b}) {
    Vec3 of_place;
    for (Eigen::Index axis = 0; axis < 3; ++axis) of_place[axis] = rounding(grain->position[axis]);
    out += of_place.norm() + rounding(grain->radius);
  }
  return out;
}

bool Assembly::check_pair_distance(const ContactRow& row, bool has_point) {
  const dem::Snapshot& s = out_.snapshot;
  const dem::Contact& c = row.contact;
  const dem::Grain &a = s.grains[static_cast<std::size_t>(c.i)],
                   &b = s.grains[static_cast<std::size_t>(c.j)];
  const Vec3 second = dem::second_place(s, c);
  const double d = (second - a.position).norm();
  if ((c.point - a.position).norm() <= kDistant * a.radius &&
      (c.point - second).norm() <= kDistant * b.radius)
    return true;
  if (options_.leave_out_distant) {
    ++tally_.left_out;
    return false;
  }
  if (has_point && d <= kDistant * std::max(a.radius, b.radius) + std::min(a.radius, b.radius))
    row.refuse(fmt::format(
        "the point ({:g}, {:g}, {:g}) m of the contact is {:g} m from grain {} of radius {:g} m "
        "and {:g} m from grain {} of radius {:g} m, allowed: up to {:g} radii from each",
        c.point.x(), c.point.y(), c.point.z(), (c.point - a.position).norm(), a.id, a.radius,
        (c.point - second).norm(), b.id, b.radius, kDistant));
  if (d < a.radius + b.radius)
    row.refuse(fmt::format(
        "grains {} and {} of radius {:g} and {:g} m in contact at a distance of {:g} m, less than "
        "their radii: are radii and places in one unit (--units, \"radius (mm)\")?",
        a.id, b.id, a.radius, b.radius, d));
  const char* remedy = options_.files.empty()
                           ? "periodic={\"x\": (low, high)} says where"
                           : "--periodic AXIS=LOW:HIGH says where, --leave-out-distant imports "
                             "the packing without such contacts; or do the contacts count ids from "
                             "another number than the grains?";
  const bool twice = std::abs(d - 2 * (a.radius + b.radius)) < kOffTwice * d;
  row.refuse(fmt::format(
      "grains {} and {} of radius {:g} and {:g} m in contact at a distance of {:g} m: {}across a "
      "periodic boundary? {}",
      a.id, b.id, a.radius, b.radius, d,
      twice ? "twice their radii, do the diameters hold radii (--column radius=...)? Or " : "",
      remedy));
}

void Assembly::add_contact(ContactRow row, bool has_normal, bool has_point, bool tell_sliding) {
  const dem::Snapshot& s = out_.snapshot;
  dem::Contact& c = row.contact;
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument(row.source.where() + ": " + what);
  };
  const double largest = c.force.cwiseAbs().maxCoeff();
  if (!(largest <= dem::kMostNumber))
    refuse(
        fmt::format("found a force of {:.3g} N, allowed: up to {:g} N", largest, dem::kMostNumber));
  if (std::abs(c.spring) > dem::kMostNumber)
    refuse(fmt::format("found a spring of {:.3g} N, allowed: up to {:g} N", c.spring,
                       dem::kMostNumber));
  // A grain's own image, behind a gap.
  if (c.i == c.j && c.force.isZero(0) && s.cell.is_periodic()) {
    tally_.idle.emplace_back(c.i, c.j);
    return;
  }
  check_periods(row);
  if (c.j >= 0 && c.i > c.j) {
    std::swap(c.i, c.j);
    c.force = -c.force;
    c.normal = -c.normal;
    c.spring_vector = -c.spring_vector;
    row.turned = !row.turned;
  }
  // The file's point is near some image of the grain.
  if (has_point) {
    try {
      const Vec3& place = s.grains[static_cast<std::size_t>(c.i)].position;
      c.point += dem::shift_to(s.cell, dem::nearest_image(s.cell, c.point - place));
    } catch (const std::invalid_argument& e) {
      refuse(e.what());
    }
  }
  if (has_normal) {
    check_given_normal(c);
    // Points and forces are made from it below.
    const double length = c.normal.norm();
    if (!(length > 0 && std::isfinite(length)))
      refuse(fmt::format("the contact's normal has length {:g}", length));
    if (std::abs(length - 1) > 1e-12) c.normal /= length;
  }
  if (c.j < 0 ? !settle_wall_contact(row, has_point) : !settle_pair(row, has_normal, has_point))
    return;
  const double length = c.normal.norm();
  if (!(length > 0 && std::isfinite(length)))
    refuse(fmt::format("the contact's normal has length {:g}", length));
  if (std::abs(length - 1) > 1e-12) c.normal /= length;
  c.normal_force = -c.force.dot(c.normal);
  c.tangential_force = s.dim == 2 ? c.force.y() * c.normal.x() - c.force.x() * c.normal.y()
                                  : (c.force + c.normal_force * c.normal).norm();
  if (!c.point.allFinite() || !c.normal.allFinite() || !std::isfinite(c.normal_force) ||
      !std::isfinite(c.tangential_force))
    refuse("its point, normal or force becomes no finite number");
  // False where the coefficient is unknown (nan).
  if (tell_sliding)
    c.sliding = std::abs(c.tangential_force) >= (1 - kSliding) * c.friction * c.normal_force;
  check_sizes(row);
  contacts_.push_back(std::move(row));
}

void Assembly::check_wall_gap(const dem::Contact& c) {
  const dem::Snapshot& s = out_.snapshot;
  const dem::Grain& grain = s.grains[static_cast<std::size_t>(c.i)];
  const double gap = gap_of(s, c);
  WallSide& side = sides_[static_cast<std::size_t>(-1 - c.j)];
  if (c.force.isZero(0)) return;
  side.lowest = std::min(side.lowest, gap);
  if (gap > kWallGap * grain.radius + rounding_of_gap(grain, grain)) {
    ++side.far;
    side.widest = std::max(side.widest, gap);
  } else if (-gap > kWallOverlap * grain.radius) {
    ++side.sunk;
    side.deepest = std::max(side.deepest, -gap);
  }
}

void Assembly::check_given_normal(const dem::Contact& c) {
  const double length = c.normal.norm();
  if (!(length > 0 && std::isfinite(length))) return;
  const auto names = [&] {
    const auto& s = out_.snapshot;
    const std::int64_t i = s.grains[static_cast<std::size_t>(c.i)].id;
    return c.j < 0 ? fmt::format("{} and {}", i, s.walls[static_cast<std::size_t>(-1 - c.j)].name)
                   : fmt::format("{} and {}", i, s.grains[static_cast<std::size_t>(c.j)].id);
  };
  ++given_.all;
  if (std::abs(length - 1) > kNotUnit && given_.not_unit++ == 0)
    given_.first_not_unit = fmt::format("{}, length {:g}", names(), length);
  if (c.j >= 0) return;
  ++given_.at_walls;
  const Vec3& normal = out_.snapshot.walls[static_cast<std::size_t>(-1 - c.j)].normal;
  if (-c.normal.dot(normal) < kAcrossNormal * length && given_.across++ == 0)
    given_.first_across = names();
}

void Assembly::check_wall_side(const dem::Contact& c, bool has_point) {
  const dem::Snapshot& s = out_.snapshot;
  const dem::Grain& grain = s.grains[static_cast<std::size_t>(c.i)];
  const dem::Wall& wall = s.walls[static_cast<std::size_t>(-1 - c.j)];
  WallSide& side = sides_[static_cast<std::size_t>(-1 - c.j)];
  const Vec3 arm = grain.position - c.point;
  ++side.contacts;
  if (arm.squaredNorm() > 0) side.towards += arm.normalized();
  const bool round = grain.outline.empty() && grain.axes.isZero(0);
  const double cosine = round ? kLeastCosine : kLeastCosineOfPolygon;
  const bool behind = arm.dot(wall.normal) < cosine * arm.norm();
  const double height = (grain.position - wall.point).dot(wall.normal);
  const bool near = !has_point && round && height < kLeastHeight * grain.radius;
  side.wrong += behind || near;
  if (behind || !near || !(height > 0)) return;
  ++side.deep;
  if (side.first_deep.empty())
    side.first_deep = fmt::format("grain {}: radius {:.3g} m, centre {:.3g} m above it", grain.id,
                                  grain.radius, height);
}

}  // namespace grainfield::coupling
