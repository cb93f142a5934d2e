// Rows that are there more than once: contacts in both directions, and tables that two files have.
//
// A continued run dumps its first step as the last of the run before, into another file. Both
// tables then have the same rows, in any order, and one of them counts. Tables with some rows in
// common contradict each other and are refused; those without are parts of one (a file for each
// processor).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <utility>

#include "coupling/import/assemble.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

// Two rows of one contact say the same force up to this share: what six digits leave.
constexpr double kSameForce = 2e-5;
constexpr double kSamePoint = 1e-3;  // radii
// Two rows of one grain say the same: what carrying it back into a cell may round.
constexpr double kSameNumber = 1e-12;

constexpr const char* kOneOrEqual =
    "allowed: one table of a step, or two that are equal; import the files of each run by itself "
    "(--add, --group) or leave one out";

}  // namespace

std::string Assembly::difference_of(const GrainRow& a, const GrainRow& b) const {
  const dem::Grain &g = a.grain, &h = b.grain;
  const double radius = std::max(g.radius, h.radius);
  const dem::Vec3 way = h.position - g.position;
  const dem::Vec3 apart =
      way + dem::shift_to(out_.snapshot.cell, dem::nearest_image(out_.snapshot.cell, way));
  constexpr std::array<const char*, 3> axes{"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto e = static_cast<Eigen::Index>(k);
    const double rounding = kSameNumber * (std::abs(g.position[e]) + std::abs(h.position[e]));
    if (std::abs(apart[e]) > kSameNumber * radius + rounding)
      return fmt::format("{} = {} and {}", axes[k], g.position[e], h.position[e]);
    if (axis_told_[k] && g.image[k] != h.image[k])
      return fmt::format("image {} = {} and {}", axes[k], g.image[k], h.image[k]);
  }
  for (const auto& [name, one, other] : {std::tuple{"radius", g.radius, h.radius},
                                         {"mass", g.mass, h.mass},
                                         {"vx", g.velocity.x(), h.velocity.x()},
                                         {"vy", g.velocity.y(), h.velocity.y()},
                                         {"vz", g.velocity.z(), h.velocity.z()},
                                         {"angle", g.angle, h.angle},
                                         {"spin", g.spin, h.spin}})
    if (std::abs(one - other) > kSameNumber * std::abs(one))
      return fmt::format("{} = {} and {}", name, one, other);
  if (g.material != h.material) return fmt::format("material = {} and {}", g.material, h.material);
  if (g.fixed != h.fixed) return "fixed = 0 and 1";
  if (g.outline != h.outline || g.axes != h.axes || g.exponents != h.exponents ||
      g.orientation != h.orientation)
    return "another shape";
  return "";
}

void Assembly::require_repeated(const TwoTables& tables, const Repeats& repeats,
                                long long rows_of_first, long long rows_of_second,
                                const char* kind) const {
  if (repeats.rows == rows_of_first && repeats.rows == rows_of_second) return;
  throw std::invalid_argument(fmt::format("{}: {} of its {} {} are those of {}, which has {}; {}",
                                          *repeats.second, repeats.rows, rows_of_second, kind,
                                          *repeats.first, rows_of_first,
                                          tables.first == tables.second ? "" : kOneOrEqual));
}

void Assembly::tell_repeated(const Repeats& repeats, const char* kind) {
  out_.notes.push_back(
      fmt::format("{}: its {} {} of this step are those of {} (a continued run begins with the "
                  "last step of the "
                  "run before): they count once",
                  *repeats.second, repeats.rows, kind, *repeats.first));
}

std::string Assembly::several_times(int table) const {
  const auto at = time_columns_.find(table);
  return at == time_columns_.end()
             ? "; of several times or steps import one at a time"
             : fmt::format(
                   "; the column {} tells that the table has several times: write the rows of "
                   "one of them to a table of its own",
                   at->second);
}

void Assembly::join_repeated_grains() {
  std::map<TwoTables, Repeats> repeats;
  std::map<int, long long> rows;
  std::size_t first = 0;  // of the rows with this id
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const GrainRow& row = rows_[k];
    ++rows[row.source.table];
    if (row.grain.id != rows_[first].grain.id) first = k;
    if (k == first) continue;
    for (std::size_t n = first; n < k; ++n)
      if (rows_[n].source.table == row.source.table)
        throw std::invalid_argument(fmt::format(
            "{}: grain {} is there already, at {}{}", row.source.where(), row.grain.id,
            rows_[n].source.where(),
            row.digits == 0
                ? several_times(row.source.table)
                : fmt::format("; ids are printed with {} digits only, print them as whole numbers "
                              "(LAMMPS: dump_modify ID format float %.17g)",
                              row.digits)));
    const GrainRow& other = rows_[first];
    if (const std::string text = difference_of(other, row); !text.empty())
      throw std::invalid_argument(fmt::format("{}: grain {} is there already, at {}, found {}; {}",
                                              row.source.where(), row.grain.id,
                                              other.source.where(), text, kOneOrEqual));
    Repeats& pair = repeats[{other.source.table, row.source.table}];
    ++pair.rows;
    pair.first = other.source.file;
    pair.second = row.source.file;
  }
  for (const auto& [tables, pair] : repeats) {
    require_repeated(tables, pair, rows[tables.first], rows[tables.second], "grains");
    tell_repeated(pair, "grains");
    const auto of_second = [&](const auto& row) { return row.source.table == tables.second; };
    std::erase_if(rows_, of_second);
    std::erase_if(wall_forces_, of_second);
  }
}

bool Assembly::of_polygons(const dem::Contact& c) const {
  const auto& grains = out_.snapshot.grains;
  return c.j >= 0 && !grains[static_cast<std::size_t>(c.i)].outline.empty() &&
         !grains[static_cast<std::size_t>(c.j)].outline.empty();
}

void Assembly::join_directions() {
  const auto same_pair = [](const ContactRow& a, const ContactRow& b) {
    return a.contact.i == b.contact.i && a.contact.j == b.contact.j &&
           a.contact.image == b.contact.image;
  };
  std::map<TwoTables, Repeats> repeats;
  std::vector<ContactRow> kept;
  kept.reserve(contacts_.size());
  std::size_t group = 0;  // where the rows of the pair begin
  for (ContactRow& row : contacts_) {
    if (kept.empty() || !same_pair(kept.back(), row)) group = kept.size();
    const dem::Contact& c = row.contact;
    const double radius = out_.snapshot.grains[static_cast<std::size_t>(c.i)].radius;
    bool joined = false;
    for (std::size_t k = group; k < kept.size() && !joined; ++k) {
      ContactRow& other = kept[k];
      const dem::Contact& d = other.contact;
      // The image of a pair is known here, and its point may be given at either grain.
      const bool at_points = c.j < 0 || of_polygons(c);
      const bool same_point = !at_points || (c.point - d.point).norm() <= kSamePoint * radius;
      const bool same_force =
          (c.force - d.force).norm() <= kSameForce * std::max(c.force.norm(), d.force.norm());
      // A grain above the edge of two facets of a wall touches both, with the same force (YADE).
      if (other.facet != row.facet) continue;
      const bool in_two_tables = other.source.table != row.source.table;
      // A wall's contact without a force may be one of another of its facets.
      if (in_two_tables && same_point && same_force && !row.again &&
          !(c.j < 0 && c.force.isZero(0))) {
        row.again = true;
        Repeats& pair = repeats[{other.source.table, row.source.table}];
        ++pair.rows;
        pair.turned += other.turned != row.turned;
        pair.first = other.source.file;
        pair.second = row.source.file;
        continue;
      }
      if (in_two_tables && row.again) continue;
      // A contact with a copy may be seen from both of its sides, each in both directions.
      const bool directions = other.turned != row.turned && !other.joined;
      if (!in_two_tables && (directions || (row.copied && other.copied)) && same_point &&
          same_force) {
        joined = other.joined = true;
        ++out_.twice;
        continue;
      }
      // Two facets of one wall may touch a grain, two polygons at two points.
      if (c.j < 0 && !(c.force == d.force && c.point == d.point && c.force.squaredNorm() > 0))
        continue;
      if (of_polygons(c) && c.point != d.point) continue;
      // One of the two is of another image, behind a gap: a narrow cell's pair within the cutoff.
      if (out_.snapshot.cell.is_periodic() && c.j >= 0 && c.force.isZero(0) != d.force.isZero(0)) {
        tally_.idle.emplace_back(c.i, c.j);
        if (d.force.isZero(0)) std::swap(other, row);
        joined = true;
        continue;
      }
      refuse_twice(row, other, same_force);
    }
    if (!joined) kept.push_back(std::move(row));
  }
  join_repeated_contacts(kept, repeats);
  contacts_ = std::move(kept);
}

void Assembly::join_repeated_contacts(std::vector<ContactRow>& kept,
                                      const std::map<TwoTables, Repeats>& repeats) {
  std::map<int, long long> rows;
  for (const ContactRow& row : kept)
    rows[row.source.table] += !(row.contact.j < 0 && row.contact.force.isZero(0));
  for (const auto& [tables, pair] : repeats) {
    const bool all = pair.rows == rows[tables.first] && pair.rows == rows[tables.second];
    const auto of_second = [&](const ContactRow& row) { return row.source.table == tables.second; };
    if (!all && pair.turned == pair.rows) {
      // Two files that name some pairs in both directions.
      out_.twice += pair.rows;
      std::erase_if(kept, [&](const ContactRow& row) { return of_second(row) && row.again; });
      continue;
    }
    require_repeated(tables, pair, rows[tables.first], rows[tables.second], "contacts");
    tell_repeated(pair, "contacts");
    std::erase_if(kept, of_second);
  }
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
  if (other.source.table != row.source.table && !same_force)
    row.refuse(fmt::format(
        "the contact of grains {} and {} is there already, at {}, found the forces {:g} N and {:g} "
        "N; {}",
        i, j, other.source.where(), c.force.norm(), other.contact.force.norm(), kOneOrEqual));
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
  if (why.empty())
    why = same_force ? ", with the same force: leave one of them out"
                     : ", with another force: of two parts of one force write the sum";
  row.refuse(fmt::format("the contact of grains {} and {} is there already, at {}{}", i, j,
                         other.source.where(), why));
}

}  // namespace grainfield::coupling
