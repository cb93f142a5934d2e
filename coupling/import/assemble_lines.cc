// Contacts whose rows tell the places of both ends: lines of VTK, tables with x1 y1 z1 x2 y2 z2. An
// end is the centre of a grain, or any point of a wall.
#include <fmt/format.h>

#include <algorithm>

#include "coupling/import/assemble_contacts.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;

// From a grain's centre to the end of its line, radii: a few digits and numbers of four bytes leave
// less, and grains that touch are farther apart.
constexpr double kAtCentre = 0.1;
constexpr double kAtWall = 0.5;  // from a wall to the end of a line, radii

}  // namespace

std::optional<std::int64_t> Assembly::grain_at(const Vec3& place) const {
  const dem::Snapshot& s = out_.snapshot;
  const auto steps = [&](std::size_t axis) { return s.cell.periodic[axis] ? 1 : 0; };
  for (int a = -steps(0); a <= steps(0); ++a)
    for (int b = -steps(1); b <= steps(1); ++b)
      for (int c = -steps(2); c <= steps(2); ++c) {
        const Vec3 near = place + dem::shift_to(s.cell, {a, b, c});
        const double margin = kAtCentre * largest_radius_;
        const auto first = std::partition_point(by_x_.begin(), by_x_.end(), [&](std::int64_t k) {
          return s.grains[static_cast<std::size_t>(k)].position.x() < near.x() - margin;
        });
        for (auto at = first; at != by_x_.end(); ++at) {
          const dem::Grain& g = s.grains[static_cast<std::size_t>(*at)];
          if (g.position.x() > near.x() + margin) break;
          if ((near - g.position).norm() <= kAtCentre * g.radius) return *at;
        }
      }
  return std::nullopt;
}

std::int64_t Assembly::wall_at(const Vec3& place, double radius) const {
  const auto& walls = out_.snapshot.walls;
  std::int64_t found = 0;
  double nearest = kAtWall * radius;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const double away = std::abs((place - walls[w].point).dot(walls[w].normal));
    if (away > nearest) continue;
    nearest = away;
    found = -1 - static_cast<std::int64_t>(w);
  }
  return found;
}

std::array<std::optional<std::int64_t>, 2> Assembly::grains_of_line(const ContactColumns& c,
                                                                    const ForeignRow& row) const {
  std::array<std::optional<std::int64_t>, 2> out;
  for (std::size_t end = 0; end < 2; ++end) {
    Vec3 place = c.line[end].of(row);
    if (out_.snapshot.dim == 2) place.z() = 0;
    out[end] = grain_at(place);
  }
  return out;
}

void Assembly::settle_lines(const ForeignTable& table, ContactColumns& c) {
  if (!c.line[0]) return;
  if (by_x_.empty()) sort_for_copies();
  // A column of the grain and one of the wall tell both, whichever end of the line stands first.
  c.by_line = !c.i || !(c.j || c.wall);
  if (c.by_line) return;
  // Ids of meshes and triangles, as LIGGGHTS writes them, or counted from another number: then most
  // rows contradict their ends. A few that do are mistakes, in the ids or in the places.
  long long all = 0, others = 0, line_of_first = 0;
  std::string first;
  const auto has_ends = [&](const ForeignRow& row) {
    const auto has = [&](const ForeignColumn& column) { return !column || !row.empty(column); };
    return std::all_of(c.line.begin(), c.line.end(), [&](const ColumnTriple& end) {
      return has(end.x) && has(end.y) && has(end.z);
    });
  };
  reader_.read(table, [&](const ForeignRow& row) {
    ++all;
    if (!has_ends(row)) return;
    const auto grains = grains_of_line(c, row);
    if (!grains[0] && !grains[1]) return;
    const std::string told[] = {std::string(row.text(c.i)),
                                c.j ? std::string(row.text(c.j)) : std::string()};
    const auto names = [&](std::int64_t grain) {
      const std::int64_t id = out_.snapshot.grains[static_cast<std::size_t>(grain)].id;
      return std::any_of(std::begin(told), std::end(told), [&](const std::string& text) {
        const auto number = parse_number(text);
        return number && *number == static_cast<double>(id);
      });
    };
    if ((!grains[0] || names(*grains[0])) && (!grains[1] || names(*grains[1]))) return;
    if (others++ > 0) return;
    line_of_first = row.line;
    const auto end = [&](std::size_t k) {
      return grains[k] ? fmt::format("grain {}",
                                     out_.snapshot.grains[static_cast<std::size_t>(*grains[k])].id)
                       : std::string("no grain");
    };
    first = fmt::format("{} {} from {} to {}", told[0], told[1], end(0), end(1));
  });
  if (others == 0) return;
  if (2 * others <= all)
    throw std::invalid_argument(fmt::format(
        "{}:{}: {} and {} name other grains than the ends of the row join: {} ({} of {} rows do "
        "so); "
        "mend these rows, or leave out the columns that are wrong",
        table.file, line_of_first, c.i.name, (c.j ? c.j : c.wall).name, first, others, all));
  c.by_line = c.of_meshes = true;
  out_.warnings.push_back(fmt::format(
      "{}: {} of {} rows join other grains than {} and {} name (the first: {}): the places "
      "of the ends count, and forces at walls act on the grain",
      table.file, others, all, c.i.name, (c.j ? c.j : c.wall).name, first));
}

Assembly::Ends Assembly::ends_of_line(const ContactColumns& c, const ForeignRow& row) const {
  const auto grains = grains_of_line(c, row);
  if (grains[0] && grains[1]) return {*grains[0], *grains[1]};
  const auto text = [](const Vec3& p) {
    return fmt::format("({:g}, {:g}, {:g}) m", p.x(), p.y(), p.z());
  };
  const Vec3 first = c.line[0].of(row), second = c.line[1].of(row);
  if (!grains[0] && !grains[1])
    row.refuse(
        fmt::format("the contact joins {} and {}, and no grain has its centre there: columns i "
                    "and j of the ids tell its grains",
                    text(first), text(second)));
  const bool swapped = !grains[0];
  const std::int64_t grain = swapped ? *grains[1] : *grains[0];
  const std::int64_t wall = wall_at(swapped ? first : second,
                                    out_.snapshot.grains[static_cast<std::size_t>(grain)].radius);
  if (wall == 0)
    row.refuse(fmt::format("the contact joins grain {} and {}, where no grain and no wall is; {}",
                           out_.snapshot.grains[static_cast<std::size_t>(grain)].id,
                           text(swapped ? first : second), known_grains()));
  return {grain, wall, swapped && !c.of_meshes};
}

}  // namespace grainfield::coupling
