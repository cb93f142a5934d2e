// Contacts under our conventions: force on i, normal from i to j, i < j.
#include "coupling/import/assemble_contacts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coupling/import/synonyms.h"
#include "dem/snapshot/limits.h"

namespace grainfield::coupling {

namespace {

using dem::Vec3;

// Share of a force along z that is rounding in 2D.
constexpr double kFlatForce = 1e-9;

// Thrown where an id is met that was printed without its last digits.
struct RoundedId {};

// Most digits of the ids of a column that were printed without their last ones: as many as it was
// printed with, but for zeros at the end.
int printed_digits(TableReader& reader, const ForeignTable& table,
                   const std::vector<ForeignColumn>& columns) {
  int most = 0;
  reader.read(table, [&](const ForeignRow& row) {
    for (const ForeignColumn& column : columns) {
      const std::string_view text = row.text(column);
      if (text.find_first_not_of("0123456789+-.eE") == std::string_view::npos && !text.empty())
        most = std::max(most, row.told_id(column).digits);
    }
  });
  return most;
}

// Columns absForceT of YADE's VTKRecorder, the sizes of the components of the shear force. Empty
// where no column is so called.
std::string lost_signs(const TableColumns& columns) {
  const std::vector<std::string> names = columns.untaken();
  const auto at = std::find_if(names.begin(), names.end(), [](const std::string& name) {
    return plain_column_name(name).starts_with("absforce");
  });
  if (at == names.end()) return "";
  return fmt::format(
      "{} ... are sizes of components, without their signs: no force can be made of them; YADE's "
      "i.phys.shearForce has them (export.VTKExporter, or the script of docs/import-programs.md), "
      "--column ft=0 leaves the tangential part out",
      *at);
}

// A text in a column of walls that is no name of one: a flag.
bool is_flag(std::string_view text) {
  for (const std::string_view word :
       {"0", "1", "True", "False", "true", "false", "TRUE", "FALSE", "yes", "no"})
    if (text == word) return true;
  return false;
}

}  // namespace

Assembly::ContactColumns Assembly::contact_columns(const ForeignTable& table,
                                                   const TableColumns& columns) {
  const int dim = out_.snapshot.dim;
  ContactColumns c;
  bool line = true;
  for (const char* end : {"x1", "y1", "x2", "y2"}) line = line && columns.has(end);
  if (dim == 3) line = line && columns.has("z1") && columns.has("z2");
  std::vector<std::vector<std::string>> wanted{{"fx", "fnx", "fn"}};
  if (!line) wanted.insert(wanted.begin(), {{"i"}, {"j", "wall"}});
  for (const std::string stem : {"f", "fn", "ft"})
    if (columns.has(stem + "x")) wanted.push_back({stem + "y"});
  if (dim == 3 && columns.has("fx")) wanted.push_back({"fz"});
  columns.require_all(wanted);
  c.i = line ? columns.find("i") : columns.need("i");
  c.wall = columns.find("wall");
  c.j = c.wall || line ? columns.find("j") : columns.need("j");
  if (line)
    for (const char end : {'1', '2'}) {
      const auto place = [&](char axis) { return columns.find(std::string{axis, end}); };
      c.line[end == '1' ? 0 : 1] = {place('x'), place('y'), place('z')};
    }
  // A force beside its tangential part is told apart by the user.
  const bool in_parts = names_.chose("fnx") && columns.has("fnx");
  if (!in_parts) c.force = find_triple(columns, "f", dim);
  if (!c.force && columns.has("fnx")) {
    c.normal_part = need_triple(columns, "fn", dim);
    if (!columns.has("ftx"))
      columns.missing("ftx", "without friction: --column ftx,fty,ftz=0,0,0",
                      "without friction: ftx = 0 and its like");
    c.tangential_part = need_triple(columns, "ft", dim);
  } else if (!c.force) {
    c.fn = columns.find("fn");
    if (!c.fn) {
      const bool size = !same_meaning("fn", columns.untaken()).empty();
      const bool parts = !same_meaning("fnx", columns.untaken()).empty();
      columns.missing(size                          ? "fn"
                      : parts || columns.has("ftx") ? "fnx"
                                                    : "fx",
                      lost_signs(columns), "forces (n, dim) tells it");
    }
    c.ft = columns.find("ft");
    // A size along the normal, and the tangential part as a vector.
    if (!c.ft) c.tangential_part = find_triple(columns, "ft", dim);
    if (!c.ft && !c.tangential_part) c.ft = no_friction(table, columns);
    c.tangent = find_triple(columns, "t", dim);
  }
  c.point = find_triple(columns, "p", dim);
  c.normal = find_triple(columns, "n", dim);
  c.friction = columns.find("friction");
  c.spring = columns.find("spring");
  c.sliding = columns.find("sliding");
  c.springs = find_triple(columns, "s", dim);
  if (c.force) find_parts_beside(table, columns, c);
  if (format_.copies_have_numbers)
    c.copies = {{c.point.x, c.point.y, c.point.z},
                {c.normal.x, c.normal.y, c.normal.z},
                columns.need_theirs("overlap", "px")};
  if (dim == 3)
    for (const ForeignColumn* column :
         {&c.force.x, &c.force.y, &c.force.z, &c.normal_part.x, &c.tangential_part.x, &c.fn, &c.ft})
      if (column->unit && column->unit->kind == parse_unit("N/m")->kind)
        throw std::invalid_argument(
            fmt::format("{}:{}: column {}: found \"{}\" in a packing in 3D, allowed: forces in N",
                        table.file, table.header_line, column->name,
                        (*table.columns)[static_cast<std::size_t>(column->index)]));
  return c;
}

ForeignColumn Assembly::no_friction(const ForeignTable& table, const TableColumns& columns) {
  const bool only = table.any_names && columns.untaken().empty();
  const std::string lost = lost_signs(columns);
  if (!only)
    columns.missing("ft", lost.empty() ? "without friction: --column ft=0" : lost,
                    "without friction: ft = 0");
  out_.warnings.push_back(fmt::format(
      "{}:{}: no column tells a tangential force: the contacts are read without friction",
      table.file, table.header_line));
  return {"ft", -1, 0.0, std::nullopt};
}

void Assembly::check_time(const ForeignTable& grains, const ForeignTable& contacts) {
  constexpr double kPrinted = 1e-4;  // what few digits leave, of the time
  if (!grains.time || !contacts.time ||
      std::abs(*grains.time - *contacts.time) <= kPrinted * std::abs(*grains.time))
    return;
  out_.warnings.push_back(
      fmt::format("{}: its time is {:g} s, that of {} is {:g} s: are they of "
                  "one state?",
                  contacts.file, *contacts.time, grains.file, *grains.time));
}

void Assembly::add_contacts(const ForeignTable& table) {
  const TableColumns named(table, names_);
  ContactColumns columns = contact_columns(table, named);
  check_states(table, named, TableKind::contacts);
  tell_columns(table, named, TableKind::contacts);
  if (columns.friction && std::isfinite(options_.friction))
    out_.notes.push_back(fmt::format("{}: --friction counts where the column {} is empty, no more",
                                     table.file, columns.friction.name));
  settle_lines(table, columns);
  find_vectors_beside(table, named, columns);
  ++tables_;
  const std::size_t before = contacts_.size();
  const auto sides = sides_;
  const auto given = given_;
  const Tally tally = tally_;
  const auto beside = beside_;
  try {
    reader_.read(table, [&](const ForeignRow& row) { read_contact(columns, row, 0); });
    if (!reader_.doubt_of_end().empty()) out_.warnings.push_back(reader_.doubt_of_end());
  } catch (const RoundedId&) {
    contacts_.resize(before);
    sides_ = sides;
    given_ = given;
    tally_ = tally;
    beside_ = beside;
    std::vector<ForeignColumn> ids{columns.i};
    if (columns.j) ids.push_back(columns.j);
    const int digits = printed_digits(reader_, table, ids);
    reader_.read(table, [&](const ForeignRow& row) { read_contact(columns, row, digits); });
    out_.notes.push_back(
        fmt::format("{}: ids are printed with {} digits; of all grains only one fits each of them",
                    table.file, digits));
  }
  tell_vectors_beside(table, columns);
}

std::optional<std::int64_t> Assembly::grain_of(const ForeignRow& row, const ForeignColumn& column,
                                               int digits) const {
  const ToldId told = row.told_id(column);
  if (told.digits == 0) {
    const std::int64_t index = index_of(told.id);
    return index < 0 ? std::nullopt : std::optional(index);
  }
  if (digits == 0) throw RoundedId{};
  // All ids that are printed alike.
  const double size = std::abs(static_cast<double>(told.id));
  const double half = 0.5 * std::pow(10.0, std::floor(std::log10(size) + 1e-12) + 1 - digits);
  const auto& grains = out_.snapshot.grains;
  const auto low = std::partition_point(grains.begin(), grains.end(), [&](const dem::Grain& g) {
    return static_cast<double>(g.id - told.id) < -half;
  });
  const auto high = std::partition_point(low, grains.end(), [&](const dem::Grain& g) {
    return static_cast<double>(g.id - told.id) <= half;
  });
  if (high - low > 1)
    row.refuse(fmt::format(
        "column {}: found \"{}\", which was printed without its last digits: it may be any of {} "
        "grains, {} to {}; print ids as whole numbers (LAMMPS: dump_modify ID format float %.17g)",
        column.name, row.text(column), high - low, low->id, (high - 1)->id));
  return high == low ? std::nullopt : std::optional(low - grains.begin());
}

std::optional<std::int64_t> Assembly::body_of(const ForeignRow& row, const ForeignColumn& column,
                                              int digits) const {
  const std::string_view text = row.text(column);
  const bool number =
      column.constant ||
      (!text.empty() && text.find_first_not_of("0123456789+-.eE") == std::string_view::npos);
  // A number is a grain's id before it is a wall's.
  if (number)
    if (const auto grain = grain_of(row, column, digits)) return grain;
  if (const std::int64_t wall = wall_of(text); wall < 0) return wall;
  if (!number) return std::nullopt;
  // "3.0" is the wall 3, too.
  const std::int64_t told = wall_of(fmt::format("{}", row.told_id(column).id));
  return told < 0 ? std::optional(told) : std::nullopt;
}

void Assembly::refuse_unknown(const ForeignRow& row, const ForeignColumn& column) const {
  const std::string_view text = row.text(column);
  const bool number =
      text.find_first_not_of("0123456789+-.eE") == std::string_view::npos && !text.empty();
  if (text.empty())
    row.refuse(fmt::format("column {}: found nothing, expected an id; a row of sums is no contact",
                           column.name));
  if (!number)
    row.refuse(fmt::format(
        "contact with the unknown wall \"{}\"; {}{}", text, known_grains(),
        options_.files.empty() ? "" : fmt::format("; --wall {}:AXIS=POSITION describes it", text)));
  const std::int64_t id = row.told_id(column).id;
  const std::string hint =
      options_.files.empty()
          ? ""
          : fmt::format(
                "; a wall or facet of that number: --wall NAME:AXIS=POSITION:ids={}; a grain "
                "that the table of grains lacks: write all of them; ids that count from another "
                "number: write those of the grains; another column: --column i=... or j=...",
                id);
  row.refuse(fmt::format("contact of the unknown grain {}; {}{}", id, known_grains(), hint));
}

void Assembly::refuse_two_meanings(const ForeignRow& row, const ForeignColumn& column) const {
  const std::string_view text = row.text(column);
  const std::int64_t wall = wall_of(text);
  if (wall == 0 || text.find_first_not_of("0123456789+-.eE") != std::string_view::npos ||
      index_of(row.told_id(column).id) < 0)
    return;
  const std::size_t tables = out_.snapshot.walls.size() - options_.walls.size();
  const auto w = static_cast<std::size_t>(-1 - wall);
  const bool in_table = w < tables;
  if (!in_table && !options_.walls[w - tables].fix.empty()) return;
  row.refuse(fmt::format(
      "{} is a grain and {} wall {}, allowed: one meaning; a column wall with its name "
      "tells contacts with the wall{}{}",
      row.text(column), in_table ? "the name of" : "one of the ids of", out_.snapshot.walls[w].name,
      options_.files.empty() ? "" : " (--column wall=THEIRS)",
      in_table ? ", or name the wall by a word" : ", or leave it out of ids="));
}

Assembly::Ends Assembly::ends_of(const ContactColumns& c, const ForeignRow& row, int digits) const {
  if (c.by_line) return ends_of_line(c, row);
  const std::string_view told = c.wall ? row.text(c.wall) : std::string_view();
  if (!row.empty(c.wall) && told != "nan" && told != "NaN") {
    const std::int64_t wall = wall_of(row.text(c.wall));
    // "0" and "1" beside the ids of both bodies.
    if (is_flag(told) && c.j && !row.empty(c.j) && (wall == 0 || names_other_grain(c, row, digits)))
      row.refuse(fmt::format(
          "column {}: found \"{}\" beside {} in the column of j: a flag, where the name or the id "
          "of a wall is expected; --column wall= takes another column, and without it j is a grain "
          "or a wall",
          c.wall.name, told, row.text(c.j)));
    if (wall == 0) refuse_unknown(row, c.wall);
    const auto grain = grain_of(row, c.i, digits);
    if (!grain) refuse_unknown(row, c.i);
    return {*grain, wall, false, facet_of(wall, row.text(c.wall))};
  }
  if (!c.j)
    row.refuse("the contact names no wall, expected the name or an id of one, or a column j");
  auto first = body_of(row, c.i, digits), second = body_of(row, c.j, digits);
  bool copied = false;
  if (format_.copies_have_numbers && bool(first) != bool(second) && first.value_or(0) >= 0 &&
      second.value_or(0) >= 0) {
    const std::int64_t copy = row.told_id(first ? c.j : c.i).id;
    if ((copied = copy >= 0)) (first ? second : first) = original_of(row, c.copies, copy, !first);
  }
  if (!first) refuse_unknown(row, c.i);
  if (!second) refuse_unknown(row, c.j);
  // Where no other column or table tells contacts with walls, an id that is both is in doubt.
  if (!c.wall && !names_.chose("wall"))
    for (const ForeignColumn* column : {&c.i, &c.j}) refuse_two_meanings(row, *column);
  if (*first < 0 && *second < 0)
    row.refuse(
        fmt::format("contact of two walls, {} and {}, allowed: of a grain and a wall; leave it out",
                    row.text(c.i), row.text(c.j)));
  if (*first < 0) return {*second, *first, true, facet_of(*first, row.text(c.i))};
  return {*first, *second, false, *second < 0 ? facet_of(*second, row.text(c.j)) : 0, copied};
}

bool Assembly::names_other_grain(const ContactColumns& c, const ForeignRow& row, int digits) const {
  const auto first = body_of(row, c.i, digits), second = body_of(row, c.j, digits);
  return first && second && *second >= 0 && *first != *second;
}

void Assembly::read_contact(const ContactColumns& columns, const ForeignRow& row, int digits) {
  const dem::Snapshot& s = out_.snapshot;
  const Ends ends = ends_of(columns, row, digits);
  ContactRow r{{}, {row.file, row.line, tables_}, ends.swapped};
  dem::Contact& c = r.contact;
  r.facet = ends.facet;
  r.copied = ends.copied;
  c.i = ends.i;
  c.j = ends.j;
  const bool pointed = columns.point && !row.empty(columns.point.x);
  if (pointed) c.point = columns.point.of(row);
  if (s.dim == 2) c.point.z() = 0;
  const bool has_normal = columns.normal && !row.empty(columns.normal.x);
  // A wall that stands first: the row is seen from the other side.
  const double side = ends.swapped ? -1 : 1;
  if (has_normal) c.normal = side * columns.normal.of(row);
  if (s.dim == 2) c.normal.z() = 0;
  const double flip = options_.sign_of(c.j < 0), sign = side * format_.force_sign * flip;
  count_parts(columns, row);
  if (columns.fn) {
    c.force = flip * force_of_sizes(columns, row, c, side);
  } else {
    c.force = sign * (columns.force
                          ? columns.force.of(row)
                          : Vec3(columns.normal_part.of(row) + columns.tangential_part.of(row)));
  }
  for (VectorBeside& vector : beside_) vector.add(row, c.force);
  if (columns.ft && !columns.tangent && s.dim == 2) {
    const double ft = row.number(columns.ft);
    tally_.ft_above += ft > 0;
    tally_.ft_below += ft < 0;
  }
  if (columns.told_normal) check_parts(columns, row);
  if (!row.empty(columns.told_fn)) r.told_fn = row.number(columns.told_fn);
  if (!row.empty(columns.told_ft)) r.told_ft = row.number(columns.told_ft);
  // Rounding leaves some digits along z, of a force or of what belongs to the grain's weight.
  const dem::Grain& grain = s.grains[static_cast<std::size_t>(c.i)];
  if (s.dim == 2 && std::abs(c.force.z()) <= kFlatForce * (c.force.norm() + 10 * grain.mass))
    c.force.z() = 0;
  if (s.dim == 2 && c.force.z() != 0)
    row.refuse(fmt::format("found a force of {} N along z in 2D; --dim 3 for grains in space",
                           c.force.z()));
  c.friction = row.empty(columns.friction) ? options_.friction : row.coefficient(columns.friction);
  set_spring(columns.springs ? std::optional<Vec3>(sign * columns.springs.of(row)) : std::nullopt,
             c);
  if (!row.empty(columns.spring) && s.dim == 2) c.spring = row.number(columns.spring);
  c.sliding = row.flag(columns.sliding);
  add_contact(std::move(r), has_normal && !format_.directions_turn_together, pointed,
              row.empty(columns.sliding));
}

}  // namespace grainfield::coupling
