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

constexpr double kManyOblique = 0.1;  // of the forces that are told in parts

using dem::Vec3;

// Cosine, see assemble_pairs.cc.
constexpr double kLeastTowards = 0.5;
constexpr long long kManyOfOneSign = 5;  // values of ft: by chance one time in 32

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

void Assembly::warn_of_wall_gaps() {
  const dem::Snapshot& s = out_.snapshot;
  for (std::size_t w = 0; w < sides_.size(); ++w) {
    const WallSide& side = sides_[w];
    if (side.far == 0 && side.sunk == 0) continue;
    const dem::Wall& wall = s.walls[w];
    std::string where;
    Eigen::Index axis = 0;
    if (wall.normal.cwiseAbs().maxCoeff(&axis) == 1)
      where = fmt::format(" The grains on it end at {} = {:.4g} m", "xyz"[axis],
                          wall.point[axis] + wall.normal[axis] * side.lowest);
    const std::string found =
        side.far > 0 ? fmt::format("bear a force across a gap of up to {:.3g} m to", side.widest)
                     : fmt::format("lie up to {:.3g} m deep in", side.deepest);
    out_.warnings.push_back(
        fmt::format("{} of {} contacts with wall {} {} it: is its plane where it says?{}",
                    side.far > 0 ? side.far : side.sunk, side.contacts, wall.name, found, where));
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

// What was left out and kept, as numbers and sentences.
void Assembly::tell_tally() {
  auto& idle = tally_.idle;
  std::sort(idle.begin(), idle.end());
  out_.idle = std::unique(idle.begin(), idle.end()) - idle.begin();
  out_.left_out = tally_.left_out;
  out_.forceless = std::count_if(contacts_.begin(), contacts_.end(),
                                 [](const ContactRow& row) { return row.contact.force.isZero(0); });
  tell_sizes();
  if (tally_.fn_below > 1 && kManyOfOneSign * tally_.fn_above < tally_.fn_below)
    out_.warnings.push_back(fmt::format(
        "fn is below 0 in {} of {} contacts, which pulls: where compression is "
        "negative, change the sign of this column in the file; --flip-forces would turn "
        "ftx ... too",
        tally_.fn_below, tally_.fn_above + tally_.fn_below));
  if (tally_.oblique > 1 &&
      kManyOblique * static_cast<double>(tally_.parts) < static_cast<double>(tally_.oblique))
    out_.warnings.push_back(fmt::format(
        "{} of {} tangential parts are not across the normal part of their force: are fnx ... and "
        "ftx ... its parts, with the signs of their components?",
        tally_.oblique, tally_.parts));
  if (tally_.off_surface > 0)
    out_.warnings.push_back(fmt::format(
        "{} of {} contact points lie farther than half a radius off the surfaces of their grains "
        "(the first: {}): are they the centres of grains, or in another unit?",
        tally_.off_surface, tally_.pointed, tally_.first_off));
  if (tally_.off_shape > 0)
    out_.warnings.push_back(fmt::format(
        "{} of {} contact points lie farther than a fifth of the radius off the outlines or "
        "surfaces of their grains (the first: {}): do places, angles, shapes and points fit each "
        "other?",
        tally_.off_shape, tally_.shaped, tally_.first_off_shape));
  if (tally_.ft_above > 1 && tally_.ft_below == 0)
    (tally_.ft_above >= kManyOfOneSign ? out_.warnings : out_.notes)
        .push_back(fmt::format(
            "none of {} values of ft is below 0, and no tx, ty tell directions: where ft is a "
            "size, "
            "all "
            "tangential forces are turned one way (its sign is that along the normal turned to the "
            "left)",
            tally_.ft_above));
  if (tally_.below_digits > 0)
    out_.notes.push_back(fmt::format(
        "{} contacts bear a force across gaps that the {} digits of the places leave open: they "
        "touch (LAMMPS: dump_modify ID format float %.17g writes all digits)",
        tally_.below_digits, place_digits_));
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
  warn_of_wall_gaps();
  warn_of_normals();
  if (const std::string text = deep_overlaps(s); !text.empty()) out_.warnings.push_back(text);
  std::stable_sort(contacts_.begin(), contacts_.end(),
                   [](const ContactRow& a, const ContactRow& b) {
                     return std::tuple(a.contact.i, a.contact.j, a.contact.image, a.source.table) <
                            std::tuple(b.contact.i, b.contact.j, b.contact.image, b.source.table);
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
