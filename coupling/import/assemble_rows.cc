// Rows of grains and of walls as the columns tell them; nothing is settled yet.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>

#include "coupling/import/assemble.h"
#include "coupling/import/outline_text.h"
#include "coupling/import/synonyms.h"
#include "dem/shared/number.h"
#include "dem/snapshot/limits.h"

namespace grainfield::coupling {
namespace {

// Difference of a quaternion's length from 1 that six digits leave.
constexpr double kUnit = 1e-5;
constexpr std::size_t kMostStates = 1000;  // times that are told apart

std::array<double, 4> orientation_of(const ForeignRow& row,
                                     const std::array<ForeignColumn, 4>& columns, std::int64_t id) {
  std::array<double, 4> q{};
  double squared = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    q[k] = row.number(columns[k]);
    squared += q[k] * q[k];
  }
  const double size = std::sqrt(squared);
  if (std::abs(size - 1) > kUnit)
    row.refuse(fmt::format("grain {}: found a quaternion of length {:g}, allowed: 1", id, size));
  // One that is a unit up to rounding keeps its bits.
  if (std::abs(size - 1) > 1e-12)
    for (double& part : q) part /= size;
  return q;
}

// A fix between two planes has one contact per grain, that with the nearer: else each of its walls
// would bear it once more.
bool nearest_of_its_fix(const std::vector<WallChoice>& walls, std::size_t wall,
                        const dem::Vec3& centre) {
  const auto distance = [&](const WallChoice& w) { return std::abs(centre[w.axis] - w.position); };
  for (std::size_t k = 0; k < walls.size(); ++k) {
    if (k == wall || walls[k].fix != walls[wall].fix) continue;
    const double other = distance(walls[k]), own = distance(walls[wall]);
    if (other < own || (other == own && k < wall)) return false;
  }
  return true;
}

}  // namespace

std::string Assembly::Source::where() const { return fmt::format("{}:{}", *file, line); }

void Assembly::remember_unit(const ForeignTable& table, const ForeignColumn& column) {
  if (!column.unit) return;
  bool plane = false;
  for (const char* unit : {"m2", "kg/m2", "kg/m"})
    plane = plane || column.unit->kind == parse_unit(unit)->kind;
  if (column.name == "mass" && !plane) return;  // kg are those of the plane, too
  (plane ? plane_units_ : space_units_)
      .push_back(fmt::format("{}:{}: column {}: found \"{}\"", table.file, table.header_line,
                             column.name,
                             (*table.columns)[static_cast<std::size_t>(column.index)]));
}

void Assembly::require_units_of_options(const ForeignTable& table,
                                        const PlaceColumns& columns) const {
  for (const ForeignColumn& place : columns.place) {
    if (!place.unit || place.unit->ten == 0 || place.index < 0 || table.units.length != 0) continue;
    const auto require = [&](bool bare, const std::string& option) {
      if (!bare) return;
      throw std::invalid_argument(fmt::format(
          "{}: found a length without a unit beside the column \"{}\" of {}, expected one behind a "
          "blank, such as \"5 mm\" or \"0.005 m\"",
          option, (*table.columns)[static_cast<std::size_t>(place.index)], table.file));
    };
    for (const WallChoice& wall : options_.walls) require(wall.bare, "--wall " + wall.name);
    for (const PeriodicAxis& axis : options_.periodic)
      require(axis.bare, fmt::format("--periodic {}", "xyz"[axis.axis]));
  }
}

void Assembly::check_states(const ForeignTable& table, const TableColumns& columns,
                            TableKind kind) {
  if (format_.name != "csv" || table.arrays) return;
  for (const std::string& name : columns.untaken()) {
    const std::string plain = plain_column_name(name);
    const bool time = plain == "time" || plain == "simulationtime" || plain == "t";
    const bool step = plain == "step" || plain == "timestep" || plain == "frame";
    if (!time && !step) continue;
    const ForeignColumn column = columns.peek_theirs(name);
    std::set<std::string> values;
    long long rows = 0;
    reader_.read(table, [&](const ForeignRow& row) {
      ++rows;
      if (!row.empty(column) && values.size() <= kMostStates) values.emplace(row.text(column));
    });
    // A time of each row is its own, such as that of a contact's beginning.
    if (values.empty() || 2 * static_cast<long long>(values.size()) > std::max(rows, 2LL)) continue;
    if (values.size() > 1)
      throw std::invalid_argument(fmt::format(
          "{}:{}: column {}: found rows of several states, {}{}, allowed: those of one; write a "
          "file for each",
          table.file, table.header_line, name,
          fmt::join(values.begin(), std::next(values.begin(), 2), ", "),
          values.size() > 2 ? ", ..." : ""));
    const std::string value = *values.begin();
    if (kind == TableKind::grains) time_columns_.try_emplace(tables_, name);
    columns.need_theirs(name);  // it is used, if only to compare
    for (const State& other : states_)
      if (plain_column_name(other.name) == plain && other.value != value &&
          other.file != table.file)
        out_.warnings.push_back(fmt::format("{}: {} is {}, in {} it is {}: are they of one state?",
                                            table.file, name, value, other.file, other.value));
    states_.push_back({table.file, name, value});
    const std::optional<double> seconds = parse_number(value);
    const Unit unit = column.unit.value_or(*parse_unit("s"));
    if (time && plain != "t" && seconds && std::isfinite(*seconds) &&
        unit.kind == parse_unit("s")->kind && out_.snapshot.time == 0)
      out_.snapshot.time = in_si(value, unit).value_or(0);
  }
}

void Assembly::require_columns_of_grains(const TableColumns& columns) const {
  std::vector<std::vector<std::string>> wanted;
  if (contacts_expected_ && !format_.rows_are_ids) wanted.push_back({"id"});
  for (const std::string axis : {"x", "y", "z"})
    if (axis != "z" || options_.dim == 3)
      wanted.push_back({axis, axis + "u", axis + "s", axis + "su"});
  wanted.push_back({"radius", "diameter", "outline", "axis_x", "diameter_x"});
  if (!(options_.density > 0)) wanted.push_back({"mass", "density"});
  columns.require_all(wanted);
}

void Assembly::add_grains(const ForeignTable& table) {
  const TableColumns columns(table, names_);
  ++tables_;
  const std::size_t rows_before = rows_.size();
  if (first_file_.empty()) first_file_ = table.file;
  require_columns_of_grains(columns);
  const ForeignColumn id = find_id(table, columns);
  const PlaceColumns places = place_columns(table, columns);
  require_units_of_options(table, places);
  has_z_ = has_z_ || places.place[2];
  for (std::size_t a = 0; a < 3; ++a)
    axis_told_[a] = axis_told_[a] && (!places.carried_back[a] || places.image[a]);
  const ShapeColumns shape = shape_columns(columns);
  const ForeignColumn vx = columns.find("vx"), vy = columns.find("vy"), vz = columns.find("vz");
  const ForeignColumn angle = columns.find("angle"), spin = columns.find("spin");
  const ForeignColumn spin_x = columns.find("spin_x"), spin_y = columns.find("spin_y");
  std::array<ForeignColumn, 4> quaternion{columns.find("qw")};
  if (!vx && (vy || vz))
    out_.warnings.push_back(
        fmt::format("{}:{}: velocities along some axes and no vx: read as 0 along x", table.file,
                    table.header_line));
  if (quaternion[0])
    quaternion = {quaternion[0], columns.need("qx"), columns.need("qy"), columns.need("qz")};
  const ForeignColumn material = columns.find("material");
  cell_ = table.box && table.box->is_periodic() ? *table.box : dem::Cell<3>{};
  const ForeignColumn radius = columns.find("radius"), outline = columns.find("outline");
  const ForeignColumn diameter = columns.find("diameter");
  if (!radius && !diameter && !outline && !shape) columns.missing("radius");
  const ForeignColumn mass = columns.find("mass");
  const ForeignColumn density = columns.find("density");
  if (!mass && !density && !(options_.density > 0))
    columns.missing("mass", "or --density",
                    options_.dim == 3 ? "mass (kg) or density (kg/m3) tells it"
                                      : "mass (kg) or density (kg/m2) tells it");
  const ForeignColumn inertia = columns.find("inertia"), volume = columns.find("volume");
  if (options_.density > 0 && (mass || density))
    out_.notes.push_back(fmt::format("{}: --density is not used: the table has {}", table.file,
                                     mass ? "masses" : "densities"));
  if (!mass) remember_unit(table, density);
  for (const ForeignColumn& column : {mass, volume}) remember_unit(table, column);
  const ForeignColumn fixed = columns.find("fixed");
  const ForeignColumn mark =
      options_.fixed_column.empty() ? ForeignColumn{} : columns.need_theirs(options_.fixed_column);
  std::vector<std::array<ForeignColumn, 7>> wall_columns;
  for (const WallChoice& wall : options_.walls) {
    wall_columns.emplace_back();
    for (std::size_t k = 0; !wall.fix.empty() && k < 7; ++k)
      wall_columns.back()[k] =
          columns.need_theirs(fmt::format("{}[{}]", wall.fix, k + 1), k < 4 ? "fx" : "px");
  }
  Bodies bodies{find_bodies(table, columns), {}, false};
  warn_of_shapes(table, columns, bool(shape));
  check_states(table, columns, TableKind::grains);
  tell_columns(table, columns, TableKind::grains);
  const double kWholeTurn = 2 * std::numbers::pi;
  long long turns = 0;
  reader_.read(table, [&](const ForeignRow& row) {
    const auto value = [&](const ForeignColumn& c) { return row.empty(c) ? 0 : row.number(c); };
    GrainRow r;
    r.source = {row.file, row.line, tables_};
    dem::Grain& g = r.grain;
    // Without a column the rows are counted: of each table from 0 where the format says so, else of
    // all from 1.
    g.id = id                     ? row.told_id(id).id
           : format_.rows_are_ids ? static_cast<std::int64_t>(rows_.size() - rows_before)
                                  : static_cast<std::int64_t>(rows_.size()) + 1;
    if (id) r.digits = row.told_id(id).digits;
    bodies.add(row);
    read_place(places, row, r);
    g.velocity = {value(vx), value(vy), value(vz)};
    g.angle = value(angle);
    turns += !row.empty(outline) && std::abs(g.angle) > kWholeTurn;
    g.spin = value(spin);
    g.angular_velocity = {value(spin_x), value(spin_y), g.spin};
    if (quaternion[0]) g.orientation = orientation_of(row, quaternion, g.id);
    g.material = row.text(material);
    if (!row.empty(outline)) {
      try {
        g.outline = parse_outline(row.text(outline), outline.unit ? outline.unit->ten : 0);
      } catch (const std::invalid_argument& e) {
        row.refuse(fmt::format("grain {}: {}", g.id, e.what()));
      }
    } else if (shape) {
      read_shape(shape, row, g);
    } else {
      if (row.empty(radius) && row.empty(diameter))
        row.refuse(fmt::format("grain {} has neither a radius nor an outline", g.id));
      g.radius = row.empty(radius) ? row.number(diameter) / 2 : row.number(radius);
      if (!row.empty(radius) && !row.empty(diameter) &&
          contradict(2 * g.radius, row.number(diameter)))
        row.refuse(
            fmt::format("grain {}: found radius {} m and diameter {} m, allowed: twice the "
                        "radius, or one of the columns",
                        g.id, g.radius, row.number(diameter)));
      if (!(g.radius > 0))
        row.refuse(
            fmt::format("grain {}: found radius {} m, allowed: above 0; leave out rows that are no "
                        "grains (walls, markers, facets)",
                        g.id, g.radius));
    }
    g.fixed = row.flag(fixed);
    if (mark) {
      const auto& values = options_.fixed_values;
      const std::string_view text = row.text(mark);
      const bool marked = std::find(values.begin(), values.end(), text) != values.end();
      some_marked_ = some_marked_ || marked;
      g.fixed = g.fixed || marked;
      if (marks_.size() <= kMostMarks &&
          std::find(marks_.begin(), marks_.end(), text) == marks_.end())
        marks_.emplace_back(text);
    }
    const bool has_mass = !row.empty(mass);
    g.mass = value(mass);
    r.density = has_mass ? 0 : !row.empty(density) ? row.number(density) : options_.density;
    r.sphere_density =
        !has_mass && format_.densities_of_spheres && (places.place[2] || !format_.rows_are_ids);
    if (has_mass && !row.empty(density)) r.told_density = row.number(density);
    const double given = has_mass ? g.mass : r.density;
    if (!(given > 0) && !(g.fixed && given == 0))
      row.refuse(fmt::format("grain {}: found {} {}, allowed: above 0", g.id,
                             has_mass ? "mass" : "density", given));
    r.has_inertia = !row.empty(inertia);
    g.inertia = value(inertia);
    g.volume = value(volume);
    if (volume.index >= 0 && !volume.unit) r.volume_ten = table.units.length;
    if (g.volume < 0 || g.inertia < 0)
      row.refuse(fmt::format("grain {}: found {} {}, allowed: above 0", g.id,
                             g.volume < 0 ? "volume" : "inertia", std::min(g.volume, g.inertia)));
    for (std::size_t w = 0; w < wall_columns.size(); ++w) {
      const auto& c = wall_columns[w];
      if (!c[0] || row.number(c[0]) == 0) continue;
      if (!nearest_of_its_fix(options_.walls, w, g.position)) continue;
      wall_forces_.push_back(
          {g.id, w, dem::Vec3(row.number(c[1]), row.number(c[2]), row.number(c[3])),
           dem::Vec3(row.number(c[4]), row.number(c[5]), row.number(c[6])), r.source});
    }
    rows_.push_back(std::move(r));
  });
  if (!reader_.doubt_of_end().empty()) out_.warnings.push_back(reader_.doubt_of_end());
  if (turns > 0 && !angle.unit)
    out_.warnings.push_back(fmt::format(
        "{}:{}: {} angles of outlines are beyond a whole turn in rad: are they degrees, \"angle "
        "(deg)\"?",
        table.file, table.header_line, turns));
  const auto elongated = [](const GrainRow& row) {
    const dem::Vec3& axes = row.grain.axes;
    return axes.maxCoeff() - axes.minCoeff() > 1e-6 * axes.maxCoeff();
  };
  if (shape && !quaternion[0] &&
      std::any_of(rows_.begin() + static_cast<std::ptrdiff_t>(rows_before), rows_.end(), elongated))
    out_.warnings.push_back(fmt::format(
        "{}:{}: superellipsoids of unlike axes and no column tells how they are turned: all are "
        "unturned (--column qw,qx,qy,qz=... names a quaternion)",
        table.file, table.header_line));
  if (bodies.any())
    out_.warnings.push_back(fmt::format(
        "{}:{}: rows share numbers in the column {}: grains of one rigid body are read as "
        "grains of their own, and the forces within the body are not in the file",
        table.file, table.header_line, bodies.column.name));
}

void Assembly::add_walls(const ForeignTable& table) {
  const TableColumns columns(table, names_);
  const ForeignColumn name = columns.need("name"), x = columns.need("x"), y = columns.need("y"),
                      nx = columns.need("nx"), ny = columns.need("ny"), z = columns.find("z"),
                      nz = columns.find("nz"), friction = columns.find("friction"),
                      material = columns.find("material");
  tell_columns(table, columns, TableKind::walls);
  reader_.read(table, [&](const ForeignRow& row) {
    dem::Wall wall;
    wall.name = std::string(row.text(name));
    if (wall.name.empty()) row.refuse("the wall has no name");
    for (std::size_t w = 0; w < wall_sources_.size(); ++w)
      if (out_.snapshot.walls[w].name == wall.name)
        row.refuse(fmt::format("wall {} is there already, at {}, allowed: every name once",
                               wall.name, wall_sources_[w].where()));
    for (const WallChoice& choice : options_.walls)
      if (choice.name == wall.name)
        row.refuse(fmt::format("wall {} is there already, by --wall, allowed: every name once",
                               wall.name));
    wall.point = {row.number(x), row.number(y), z ? row.number(z) : 0};
    wall.normal = {row.number(nx), row.number(ny), nz ? row.number(nz) : 0};
    wall.friction = row.empty(friction) ? options_.friction : row.coefficient(friction);
    wall.material = row.text(material);
    if (!(wall.point.cwiseAbs().maxCoeff() <= dem::kMostNumber))
      row.refuse(fmt::format("wall {}: found a point beyond {:g} m, allowed: up to that", wall.name,
                             dem::kMostNumber));
    const double length = wall.normal.norm();
    if (!(length > 0 && std::isfinite(length)))
      row.refuse(
          fmt::format("wall {}: its normal has length {:g}, allowed: above 0", wall.name, length));
    // A normal that is a unit vector up to rounding keeps its bits.
    if (std::abs(length - 1) > 1e-12) wall.normal /= length;
    out_.snapshot.walls.push_back(wall);
    wall_sources_.push_back({row.file, row.line});
  });
}

}  // namespace grainfield::coupling
