// What is checked once all contacts of a step are there, and the snapshot.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "coupling/import/assemble.h"
#include "coupling/import/deep_overlaps.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;

// Cosine, see assemble_pairs.cc.
constexpr double kLeastTowards = 0.5;
// Two rows of one contact say the same force up to this share: what six digits leave.
constexpr double kSameForce = 2e-5;
constexpr double kSamePoint = 1e-3;  // radii

}  // namespace

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
    const bool told = length > kLeastTowards * static_cast<double>(side.contacts) &&
                      side.towards.dot(wall.normal) < kLeastTowards * length;
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

void Assembly::join_directions() {
  const dem::Snapshot& s = out_.snapshot;
  const auto same_pair = [](const ContactRow& a, const ContactRow& b) {
    return a.contact.i == b.contact.i && a.contact.j == b.contact.j &&
           a.contact.image == b.contact.image;
  };
  const auto polygons = [&](const dem::Contact& c) {
    const auto has_outline = [&](std::int64_t k) {
      return !s.grains[static_cast<std::size_t>(k)].outline.empty();
    };
    return c.j >= 0 && has_outline(c.i) && has_outline(c.j);
  };
  std::vector<ContactRow> kept;
  kept.reserve(contacts_.size());
  std::size_t group = 0;  // where the rows of the pair begin
  for (ContactRow& row : contacts_) {
    if (kept.empty() || !same_pair(kept.back(), row)) group = kept.size();
    const dem::Contact& c = row.contact;
    const double radius = s.grains[static_cast<std::size_t>(c.i)].radius;
    bool joined = false;
    for (std::size_t k = group; k < kept.size() && !joined; ++k) {
      ContactRow& other = kept[k];
      const dem::Contact& d = other.contact;
      // Of a pair the image is told apart already, and the point may stand at either grain.
      const bool at_points = c.j < 0 || polygons(c);
      const bool same_point = !at_points || (c.point - d.point).norm() <= kSamePoint * radius;
      const bool same_force =
          (c.force - d.force).norm() <= kSameForce * std::max(c.force.norm(), d.force.norm());
      if (other.turned != row.turned && !other.joined && same_point && same_force) {
        joined = other.joined = true;
        ++out_.twice;
        continue;
      }
      // Two facets of one wall may touch a grain, two polygons at two points.
      if (c.j < 0 && !(c.force == d.force && c.point == d.point && c.force.squaredNorm() > 0))
        continue;
      if (polygons(c) && c.point != d.point) continue;
      refuse_twice(row, other, same_force);
    }
    if (!joined) kept.push_back(std::move(row));
  }
  contacts_ = std::move(kept);
}

void Assembly::refuse_twice(const ContactRow& row, const ContactRow& other, bool same_force) const {
  const dem::Snapshot& s = out_.snapshot;
  const dem::Contact& c = row.contact;
  const std::int64_t i = s.grains[static_cast<std::size_t>(c.i)].id;
  if (c.j < 0)
    row.refuse(fmt::format("the contact of grain {} and wall {} is there already, at {}", i,
                           s.walls[static_cast<std::size_t>(-1 - c.j)].name, other.source.where()));
  const std::int64_t j = s.grains[static_cast<std::size_t>(c.j)].id;
  std::string why;
  if (other.turned != row.turned && !same_force)
    why = "; the two rows name the grains in both orders, allowed: opposite forces";
  if (s.cell.is_periodic()) {
    double width = std::numeric_limits<double>::infinity();
    for (Eigen::Index a = 0; a < 3; ++a)
      if (s.cell.periodic[static_cast<std::size_t>(a)])
        width = std::min(width, s.cell.edges.col(a).norm());
    why += fmt::format(
        "; grains that touch through two images of a cell (its least width is {:g} m) "
        "need contact points",
        width);
  }
  row.refuse(fmt::format("the contact of grains {} and {} is there already, at {}{}", i, j,
                         other.source.where(), why));
}

// What was left out and kept, as numbers and sentences.
void Assembly::tell_tally() {
  auto& idle = tally_.idle;
  std::sort(idle.begin(), idle.end());
  out_.idle = std::unique(idle.begin(), idle.end()) - idle.begin();
  out_.left_out = tally_.left_out;
  out_.forceless = std::count_if(contacts_.begin(), contacts_.end(),
                                 [](const ContactRow& row) { return row.contact.force.isZero(0); });
  if (tally_.far > 0)
    out_.warnings.push_back(
        fmt::format("{} contacts bear a force across a gap between their grains (the first: {}): "
                    "liquid bridges, "
                    "or radii that are too small?",
                    tally_.far, tally_.first_far));
}

ImportedSnapshot Assembly::finish() {
  dem::Snapshot& s = out_.snapshot;
  check_sides();
  warn_of_normals();
  if (const std::string text = deep_overlaps(s); !text.empty()) out_.warnings.push_back(text);
  std::stable_sort(contacts_.begin(), contacts_.end(),
                   [](const ContactRow& a, const ContactRow& b) {
                     return std::tuple(a.contact.i, a.contact.j, a.contact.image) <
                            std::tuple(b.contact.i, b.contact.j, b.contact.image);
                   });
  join_directions();
  tell_tally();
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
