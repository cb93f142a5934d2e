// Contacts under our conventions: force on i, normal from i to j, i < j.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "coupling/import/assemble.h"
#include "coupling/import/deep_overlaps.h"
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
constexpr double kNotUnit = 1e-3;      // of a normal's length from 1
constexpr double kAcrossNormal = 0.5;  // cosine of the angle to the wall's normal
// Of the Coulomb limit: a contact this near to it slides.
constexpr double kSliding = 1e-6;

// Three columns of a vector; the third is needed in 3D only.
struct Triple {
  ForeignColumn x, y, z;
  explicit operator bool() const { return bool(x); }
  Vec3 of(const ForeignRow& row) const {
    return {row.number(x), row.number(y), z ? row.number(z) : 0};
  }
};

Triple need_triple(const TableColumns& columns, const std::string& stem, int dim) {
  return {columns.need(stem + "x"), columns.need(stem + "y"),
          dim == 3 ? columns.need(stem + "z") : columns.find(stem + "z")};
}
Triple find_triple(const TableColumns& columns, const std::string& stem, int dim) {
  return columns.find(stem + "x") ? need_triple(columns, stem, dim) : Triple{};
}

}  // namespace

void Assembly::add_contacts(const ForeignTable& table) {
  const dem::Snapshot& s = out_.snapshot;
  const TableColumns columns(table, names_);
  const ForeignColumn i = columns.need("i"), wall = columns.find("wall");
  const ForeignColumn j = wall ? columns.find("j") : columns.need("j");
  const Triple force = find_triple(columns, "f", s.dim);
  Triple normal_part, tangential_part;
  if (!force) {
    if (!columns.find("fnx"))
      columns.missing(columns.find("ftx") ? "fnx" : "fx", "", "forces (n, dim) tells it");
    normal_part = need_triple(columns, "fn", s.dim);
    if (!columns.find("ftx"))
      columns.missing("ftx", "without friction: --column ftx,fty,ftz=0,0,0",
                      "without friction: ftx = 0 and its like");
    tangential_part = need_triple(columns, "ft", s.dim);
  }
  const Triple point = find_triple(columns, "p", s.dim), normal = find_triple(columns, "n", s.dim);
  const ForeignColumn friction = columns.find("friction"), spring = columns.find("spring"),
                      sliding = columns.find("sliding");
  const Triple springs = find_triple(columns, "s", s.dim);
  reader_.read(table, [&](const ForeignRow& row) {
    ContactRow r{{}, {row.file, row.line}};
    dem::Contact& c = r.contact;
    const auto grain = [&](const ForeignColumn& column) {
      const std::int64_t id = row.whole(column), index = index_of(id);
      if (index < 0)
        row.refuse(fmt::format("contact of the unknown grain {}; {}", id, known_grains()));
      return index;
    };
    // A number is a grain's id before it is a wall's.
    const auto grain_or_wall = [&](const ForeignColumn& column) {
      const std::string_view text = row.text(column);
      if (!column.constant && text.find_first_not_of("0123456789+-.eE") == std::string_view::npos) {
        const std::int64_t index = index_of(row.whole(column)), known = wall_of(text);
        return index < 0 && known < 0 ? known : grain(column);
      }
      if (wall_of(text) == 0)
        row.refuse(fmt::format("contact with the unknown wall \"{}\"; {}", text, known_grains()));
      return wall_of(text);
    };
    c.i = grain(i);
    if (!row.empty(wall)) {
      c.j = wall_of(row.text(wall));
      if (c.j == 0)
        row.refuse(fmt::format("contact with the unknown wall \"{}\"; {}", row.text(wall),
                               known_grains()));
    } else if (!j) {
      row.refuse("the contact names no wall");
    } else {
      c.j = grain_or_wall(j);
    }
    const double sign = format_.force_sign * (options_.flip_forces ? -1 : 1);
    c.force = sign * (force ? force.of(row) : Vec3(normal_part.of(row) + tangential_part.of(row)));
    if (s.dim == 2 && c.force.z() != 0)
      row.refuse(fmt::format("found a force of {} N along z in 2D; --dim 3 for grains in space",
                             c.force.z()));
    // An empty cell is what a missing column is.
    const bool pointed = point && !row.empty(point.x);
    if (pointed) c.point = point.of(row);
    if (s.dim == 2) c.point.z() = 0;
    if (normal) c.normal = normal.of(row);
    if (s.dim == 2) c.normal.z() = 0;
    c.friction = row.empty(friction) ? options_.friction : row.coefficient(friction);
    set_spring(springs ? std::optional<Vec3>(sign * springs.of(row)) : std::nullopt, c);
    if (!row.empty(spring) && s.dim == 2) c.spring = row.number(spring);
    c.sliding = row.flag(sliding);
    add_contact(std::move(r), bool(normal), pointed, row.empty(sliding));
  });
}

void Assembly::set_spring(const std::optional<Vec3>& spring, dem::Contact& c) const {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  c.spring = nan;
  if (out_.snapshot.dim == 2) return;
  c.spring_vector = spring.value_or(Vec3(nan, nan, nan));
  if (spring) c.spring = spring->norm();
}

void Assembly::add_contact(ContactRow row, bool has_normal, bool has_point, bool tell_sliding) {
  const dem::Snapshot& s = out_.snapshot;
  dem::Contact& c = row.contact;
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument(row.source.where() + ": " + what);
  };
  const auto at = [&](std::int64_t k) -> const dem::Grain& {
    return s.grains[static_cast<std::size_t>(k)];
  };
  const auto nearest = [&](const Vec3& branch) {
    try {
      return dem::nearest_image(s.cell, branch);
    } catch (const std::invalid_argument& e) {
      refuse(e.what());
      throw;
    }
  };
  const double largest = c.force.cwiseAbs().maxCoeff();
  if (!(largest <= dem::kMostNumber))
    refuse(
        fmt::format("found a force of {:.3g} N, allowed: up to {:g} N", largest, dem::kMostNumber));
  if (std::abs(c.spring) > dem::kMostNumber)
    refuse(fmt::format("found a spring of {:.3g} N, allowed: up to {:g} N", c.spring,
                       dem::kMostNumber));
  if (c.i == c.j) refuse(fmt::format("grain {} in contact with itself", at(c.i).id));
  if (c.j >= 0 && c.i > c.j) {
    std::swap(c.i, c.j);
    c.force = -c.force;
    c.normal = -c.normal;
    c.spring_vector = -c.spring_vector;
  }
  // The file's point is near some image of the grain.
  if (has_point) c.point += dem::shift_to(s.cell, nearest(c.point - at(c.i).position));
  const dem::Grain& a = at(c.i);
  if (has_normal) check_given_normal(c);
  if (c.j < 0) {
    const dem::Wall& wall = s.walls[static_cast<std::size_t>(-1 - c.j)];
    c.normal = -wall.normal;
    if (!has_point) {
      if (!a.outline.empty())
        refuse(fmt::format("grain {} is a polygon: its contacts need px and py", a.id));
      c.point = a.position - (a.position - wall.point).dot(wall.normal) * wall.normal;
    }
    const double arm = (c.point - a.position).norm();
    const double height = std::abs((a.position - wall.point).dot(wall.normal));
    if (arm > kDistant * a.radius && has_point && height <= kDistant * a.radius)
      refuse(fmt::format(
          "the point ({:g}, {:g}, {:g}) m of the contact with wall {} is {:g} m from "
          "grain {} of radius {:g} m, allowed: up to {:g} radii",
          c.point.x(), c.point.y(), c.point.z(), wall.name, arm, a.id, a.radius, kDistant));
    if (arm > kDistant * a.radius)
      refuse(fmt::format(
          "grain {} of radius {:g} m in contact with wall {} at a distance of {:g} m: is the wall "
          "where it says?",
          a.id, a.radius, wall.name, arm));
    check_wall_side(c, has_point);
  } else {
    const dem::Grain& b = at(c.j);
    c.image = nearest(b.position - a.position);
    const Vec3 second = dem::second_place(s, c), branch = second - a.position;
    const double d = branch.norm();
    const bool polygons = !a.outline.empty() || !b.outline.empty();
    if (polygons && !(has_normal && has_point))
      refuse(fmt::format("contact of grains {} and {}: those of polygons need px, py, nx and ny",
                         a.id, b.id));
    if (!(d > 0)) refuse(fmt::format("grains {} and {} have the same centre", a.id, b.id));
    if (!has_normal) c.normal = branch / d;
    // The middle of the chord in which two overlapping circles cross.
    const double arm = (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d);
    if (!has_point) c.point = a.position + arm * c.normal;
    if ((c.point - a.position).norm() > kDistant * a.radius ||
        (c.point - second).norm() > kDistant * b.radius) {
      if (options_.leave_out_distant) {
        ++out_.left_out;
        return;
      }
      if (has_point && d <= kDistant * std::max(a.radius, b.radius) + std::min(a.radius, b.radius))
        refuse(fmt::format(
            "the point ({:g}, {:g}, {:g}) m of the contact is {:g} m from grain {} of radius {:g} "
            "m "
            "and {:g} m from grain {} of radius {:g} m, allowed: up to {:g} radii from each",
            c.point.x(), c.point.y(), c.point.z(), (c.point - a.position).norm(), a.id, a.radius,
            (c.point - second).norm(), b.id, b.radius, kDistant));
      const char* remedy = options_.files.empty()
                               ? "periodic={\"x\": (low, high)} says where"
                               : "--periodic AXIS=LOW:HIGH says where, --leave-out-distant imports "
                                 "the packing without such contacts";
      refuse(fmt::format(
          "grains {} and {} of radius {:g} and {:g} m in contact at a distance of {:g} m: across a "
          "periodic boundary? {}",
          a.id, b.id, a.radius, b.radius, d, remedy));
    }
  }
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
  contacts_.push_back(std::move(row));
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
  const bool round = grain.outline.empty();
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

void Assembly::check_sides() {
  const dem::Snapshot& s = out_.snapshot;
  for (std::size_t w = 0; w < sides_.size(); ++w) {
    const WallSide& side = sides_[w];
    if (side.wrong == 0) continue;
    const dem::Wall& wall = s.walls[w];
    const auto text = [&](const Vec3& v) {
      return s.dim == 2
                 ? fmt::format("({:.3g}, {:.3g})", v.x() + 0.0, v.y() + 0.0)
                 : fmt::format("({:.3g}, {:.3g}, {:.3g})", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
    };
    const std::string found = fmt::format(
        "{} of {} grains in contact with wall {} are not on the side to which its normal "
        "{} points",
        side.wrong, side.contacts, wall.name, text(wall.normal));
    if (2 * side.deep >= side.contacts)
      throw std::invalid_argument(fmt::format(
          "{} of {} grains in contact with wall {} reach through it by three quarters of their "
          "radius and more ({}); allowed: radii, places and walls in m that fit each other",
          side.deep, side.contacts, wall.name, side.first_deep));
    if (2 * side.wrong < side.contacts) {
      out_.warnings.push_back(found);
      continue;
    }
    const bool table = w < wall_sources_.size();
    const double length = side.towards.norm();
    // Without contact points the direction is that of the normal.
    const bool told = length > kLeastCosine * static_cast<double>(side.contacts) &&
                      side.towards.dot(wall.normal) < kLeastCosine * length;
    const std::string where =
        told ? fmt::format("; they lie towards {}", text(side.towards / length)) : "";
    throw std::invalid_argument(fmt::format(
        "{}: {}, allowed: a normal into the grains{}{}",
        table ? wall_sources_[w].where() : "--wall " + wall.name, found, where,
        table ? "" : "; --wall points to the middle of all grains, a table of walls says it"));
  }
}

void Assembly::warn_of_normals() {
  if (given_.not_unit > 0)
    out_.warnings.push_back(fmt::format(
        "{} of {} normals in the files are not of unit length (the first: {}); they were made so",
        given_.not_unit, given_.all, given_.first_not_unit));
  if (given_.across > 0)
    out_.warnings.push_back(fmt::format(
        "{} of {} normals in the files at walls are more than 60 degrees off their wall's "
        "(the first: {}); they point from the grain to the wall, and the wall's is taken",
        given_.across, given_.at_walls, given_.first_across));
}

ImportedSnapshot Assembly::finish() {
  dem::Snapshot& s = out_.snapshot;
  check_sides();
  warn_of_normals();
  if (const std::string text = deep_overlaps(s); !text.empty()) out_.warnings.push_back(text);
  std::stable_sort(
      contacts_.begin(), contacts_.end(), [](const ContactRow& a, const ContactRow& b) {
        return std::pair(a.contact.i, a.contact.j) < std::pair(b.contact.i, b.contact.j);
      });
  for (std::size_t k = 1; k < contacts_.size(); ++k) {
    const dem::Contact &a = contacts_[k - 1].contact, &b = contacts_[k].contact;
    if (a.i != b.i || a.j != b.j) continue;
    const dem::Grain& i = s.grains[static_cast<std::size_t>(a.i)];
    if (a.j < 0) {
      // Two facets of one wall may touch a grain, but not with the same force at the same point.
      if (a.force == b.force && a.point == b.point && a.force.squaredNorm() > 0)
        throw std::invalid_argument(fmt::format(
            "{}: the contact of grain {} and wall {} is there already, at {}",
            contacts_[k].source.where(), i.id, s.walls[static_cast<std::size_t>(-1 - a.j)].name,
            contacts_[k - 1].source.where()));
      continue;
    }
    // Two polygons may touch at two points.
    const dem::Grain& j = s.grains[static_cast<std::size_t>(a.j)];
    if (!i.outline.empty() && !j.outline.empty() && a.point != b.point) continue;
    throw std::invalid_argument(
        fmt::format("{}: the contact of grains {} and {} is there already, at {}",
                    contacts_[k].source.where(), i.id, j.id, contacts_[k - 1].source.where()));
  }
  s.contacts.reserve(contacts_.size());
  for (ContactRow& row : contacts_) s.contacts.push_back(std::move(row.contact));
  contacts_ = {};
  s.gravity = options_.gravity ? *options_.gravity
              : s.dim == 2     ? Vec3(0, -9.81, 0)
                               : Vec3(0, 0, -9.81);
  s.loaded_grain = options_.loaded_grain;
  s.applied_force = options_.applied_force;
  if (s.loaded_grain >= 0 && index_of(s.loaded_grain) < 0)
    throw std::invalid_argument(
        fmt::format("--load: unknown grain {}; {}", s.loaded_grain, known_grains()));
  return std::move(out_);
}

}  // namespace grainfield::coupling
