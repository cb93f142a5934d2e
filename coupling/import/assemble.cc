// Grains and walls. Contacts are in assemble_contacts.cc.
#include "coupling/import/assemble.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "coupling/import/outline_text.h"
#include "dem/shapes/polygon.h"
#include "dem/snapshot/cell_places.h"
#include "dem/snapshot/check_snapshot.h"
#include "dem/snapshot/images.h"
#include "dem/snapshot/limits.h"

namespace grainfield::coupling {

namespace {

// Of a quaternion's length from 1: what is written with six digits.
constexpr double kUnit = 1e-5;
// Values of the column of fixed grains in a message.
constexpr std::size_t kMostMarks = 6;
// Median radii from the middle of the packing: a warning, and a refusal.
constexpr double kFar = 1e6, kTooFar = 1e9;

// Two that should be equal and are written with five digits or more.
bool contradict(double a, double b) { return std::abs(a - b) > 1e-4 * std::abs(a); }

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
  const bool plane =
      column.unit->kind == parse_unit(column.name == "volume" ? "m2" : "kg/m2")->kind;
  (plane ? plane_units_ : space_units_)
      .push_back(fmt::format("{}:{}: column {}: found \"{}\"", table.file, table.header_line,
                             column.name,
                             (*table.columns)[static_cast<std::size_t>(column.index)]));
}

void Assembly::add_grains(const ForeignTable& table) {
  const TableColumns columns(table, names_);
  if (first_file_.empty()) first_file_ = table.file;
  const ForeignColumn id = find_id(table, columns);
  const PlaceColumns places = place_columns(table, columns);
  has_z_ = has_z_ || places.place[2];
  for (std::size_t a = 0; a < 3; ++a)
    axis_told_[a] = axis_told_[a] && (!places.carried_back[a] || places.image[a]);
  const ShapeColumns shape = shape_columns(columns);
  warn_of_shapes(table, columns, shape);
  const ForeignColumn vx = columns.find("vx"), vy = columns.find("vy"), vz = columns.find("vz");
  const ForeignColumn angle = columns.find("angle"), spin = columns.find("spin");
  const ForeignColumn spin_x = columns.find("spin_x"), spin_y = columns.find("spin_y");
  std::array<ForeignColumn, 4> quaternion{columns.find("qw")};
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
  if (!mass) remember_unit(table, density);
  remember_unit(table, volume);
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
  reader_.read(table, [&](const ForeignRow& row) {
    const auto value = [&](const ForeignColumn& c) { return row.empty(c) ? 0 : row.number(c); };
    GrainRow r;
    r.source = {row.file, row.line};
    dem::Grain& g = r.grain;
    // Without a column the rows are counted: from 0 where the format says so, else from 1.
    g.id = id ? row.told_id(id).id
              : static_cast<std::int64_t>(rows_.size()) + (format_.rows_are_ids ? 0 : 1);
    read_place(places, row, r);
    g.velocity = {value(vx), value(vy), value(vz)};
    g.angle = value(angle);
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
        row.refuse(fmt::format("grain {}: found radius {} m, allowed: above 0", g.id, g.radius));
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
    g.mass = value(mass);
    r.density = mass ? 0 : density ? row.number(density) : options_.density;
    if (mass && !row.empty(density)) r.told_density = row.number(density);
    const double given = mass ? g.mass : r.density;
    if (!(given > 0) && !(g.fixed && given == 0))
      row.refuse(fmt::format("grain {}: found {} {}, allowed: above 0", g.id,
                             mass ? "mass" : "density", given));
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
}

void Assembly::add_walls(const ForeignTable& table) {
  const TableColumns columns(table, names_);
  const ForeignColumn name = columns.need("name"), x = columns.need("x"), y = columns.need("y"),
                      nx = columns.need("nx"), ny = columns.need("ny"), z = columns.find("z"),
                      nz = columns.find("nz"), friction = columns.find("friction"),
                      material = columns.find("material");
  reader_.read(table, [&](const ForeignRow& row) {
    dem::Wall wall;
    wall.name = std::string(row.text(name));
    if (wall.name.empty()) row.refuse("the wall has no name");
    for (std::size_t w = 0; w < wall_sources_.size(); ++w)
      if (out_.snapshot.walls[w].name == wall.name)
        row.refuse(
            fmt::format("wall {} is there already, at {}", wall.name, wall_sources_[w].where()));
    for (const WallChoice& choice : options_.walls)
      if (choice.name == wall.name)
        row.refuse(fmt::format("wall {} is there already, by --wall", wall.name));
    wall.point = {row.number(x), row.number(y), z ? row.number(z) : 0};
    wall.normal = {row.number(nx), row.number(ny), nz ? row.number(nz) : 0};
    wall.friction = row.empty(friction) ? options_.friction : row.coefficient(friction);
    wall.material = row.text(material);
    if (!(wall.point.cwiseAbs().maxCoeff() <= dem::kMostNumber))
      row.refuse(fmt::format("wall {}: found a point beyond {:g} m, allowed: up to that", wall.name,
                             dem::kMostNumber));
    const double length = wall.normal.norm();
    if (!(length > 0 && std::isfinite(length)))
      row.refuse(fmt::format("wall {}: its normal has length {:g}", wall.name, length));
    // A normal that is a unit vector up to rounding keeps its bits.
    if (std::abs(length - 1) > 1e-12) wall.normal /= length;
    out_.snapshot.walls.push_back(wall);
    wall_sources_.push_back({row.file, row.line});
  });
}

void Assembly::settle_dimension() {
  dem::Snapshot& s = out_.snapshot;
  const double z = rows_.front().grain.position.z();
  const auto other = std::find_if(rows_.begin(), rows_.end(),
                                  [&](const GrainRow& row) { return row.grain.position.z() != z; });
  s.dim = options_.dim != 0 ? options_.dim : has_z_ && other != rows_.end() ? 3 : 2;
  if (const auto& told = s.dim == 2 ? space_units_ : plane_units_; !told.empty())
    throw std::invalid_argument(
        fmt::format("{0} in a packing in {1}D, allowed: density in kg/m{1}, volume in m{1}",
                    told.front(), s.dim));
  if (s.dim == 2 && other != rows_.end())
    throw std::invalid_argument(fmt::format(
        "{}: grain {} has z = {}, grain {} has z = {}; 2D needs one z: --dim 3 for grains "
        "in space",
        other->source.where(), other->grain.id, other->grain.position.z(), rows_.front().grain.id,
        z));
  const auto polygon = std::find_if(rows_.begin(), rows_.end(),
                                    [](const GrainRow& row) { return !row.grain.outline.empty(); });
  const auto solid = std::find_if(rows_.begin(), rows_.end(),
                                  [](const GrainRow& row) { return !row.grain.axes.isZero(0); });
  if (options_.dim == 0 && solid != rows_.end()) s.dim = 3;
  if (s.dim == 2 && solid != rows_.end())
    throw std::invalid_argument(fmt::format("{}: grain {} is a superellipsoid, allowed: --dim 3",
                                            solid->source.where(), solid->grain.id));
  if (s.dim == 3 && polygon != rows_.end())
    throw std::invalid_argument(fmt::format("{}: grain {} is a polygon; 3D takes spheres",
                                            polygon->source.where(), polygon->grain.id));
}

// The axes that repeat, of the packing's dimension.
void Assembly::settle_cell() {
  dem::Snapshot& s = out_.snapshot;
  if (options_.leave_out_distant) return;
  s.cell = cell_;
  if (!options_.periodic.empty()) s.cell = {};
  for (const PeriodicAxis& p : options_.periodic) {
    if (p.axis >= s.dim) throw std::invalid_argument("--periodic z: the packing is in 2D");
    s.cell.periodic[static_cast<std::size_t>(p.axis)] = true;
    s.cell.low[p.axis] = p.low;
    s.cell.edges(p.axis, p.axis) = p.high - p.low;
  }
  if (s.dim == 2) s.cell.periodic[2] = false;
  for (int a = 0; a < 3; ++a)
    if (!s.cell.periodic[static_cast<std::size_t>(a)]) s.cell.edges.col(a).setZero();
  if (s.dim == 2) s.cell.low.z() = 0;
  if (!s.cell.is_periodic()) s.cell = {};
  dem::check_snapshot(s, *rows_.front().source.file);  // holds the cell and walls so far
}

// Outline to the body frame, then volume, mass and inertia that the file does not give.
void Assembly::complete(GrainRow& row) const {
  dem::Grain& g = row.grain;
  double gyration = 0;  // inertia over mass, m2
  double volume = 0;
  if (!g.outline.empty()) {
    try {
      const std::array<double, 2> c = dem::centroid_of(g.outline);
      g.outline = dem::centred_outline(g.outline);
      const double cosine = std::cos(g.angle), sine = std::sin(g.angle);
      g.position.x() += cosine * c[0] - sine * c[1];
      g.position.y() += sine * c[0] + cosine * c[1];
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(
          fmt::format("{}: grain {}: {}", row.source.where(), g.id, e.what()));
    }
    g.radius = dem::circumradius_of(g.outline);
    volume = dem::area_of(g.outline);
    gyration = dem::polar_moment_of(g.outline) / volume;
  } else if (!g.axes.isZero(0)) {
    volume = complete_superellipsoid(g);
    gyration = g.moments.mean() / volume;
  } else {
    const bool plane = out_.snapshot.dim == 2;
    volume = std::numbers::pi * g.radius * g.radius * (plane ? 1 : 4.0 / 3 * g.radius);
    gyration = (plane ? 0.5 : 0.4) * g.radius * g.radius;
  }
  if (row.volume_ten != 0) g.volume *= std::pow(10.0, out_.snapshot.dim * row.volume_ten);
  if (g.volume == 0) g.volume = volume;
  if (row.density > 0) g.mass = row.density * g.volume;
  // In 2D a density may be one of spheres.
  const double as_spheres = 4.0 / 3 * std::numbers::pi * g.radius * g.radius * g.radius;
  if (row.told_density > 0 && g.mass > 0 && contradict(g.mass, row.told_density * g.volume) &&
      (!g.outline.empty() || contradict(g.mass, row.told_density * as_spheres)))
    throw std::invalid_argument(fmt::format(
        "{}: grain {}: found mass {:g} kg and density {:g}, which makes {:g} kg, allowed: "
        "those that agree, or one of the columns",
        row.source.where(), g.id, g.mass, row.told_density, row.told_density * g.volume));
  if (!row.has_inertia) g.inertia = g.mass * gyration;
  if (out_.snapshot.dim == 2) {
    g.angular_velocity.setZero();
    g.orientation = {1, 0, 0, 0};
  } else if (g.axes.isZero(0)) {
    g.moments = dem::Vec3::Constant(g.inertia);
  } else {
    g.moments *= g.mass / volume;
  }
}

// Into the cell; all that was computed must be numbers that can be read again.
void Assembly::place(GrainRow& row) const {
  dem::Grain& g = row.grain;
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument(fmt::format("{}: grain {}: {}", row.source.where(), g.id, what));
  };
  const dem::Cell<3>& cell = out_.snapshot.cell;
  try {
    const std::array<int, 3> away = dem::edges_away(cell, g.position);
    g.position = dem::wrapped(cell, g.position);
    for (std::size_t a = 0; a < 3; ++a) {
      if (row.image[a] != 0 && !cell.periodic[a] && !options_.leave_out_distant &&
          !(a == 2 && out_.snapshot.dim == 2))
        refuse(
            fmt::format("found the image flag {} along {}, where nothing repeats; --periodic "
                        "{}=LOW:HIGH says where",
                        row.image[a], "xyz"[a], "xyz"[a]));
      // Without flags they are those of the place: displacements.h decides on their use.
      if (cell.periodic[a]) g.image[a] = (axis_told_[a] ? row.image[a] : 0) + away[a];
    }
  } catch (const dem::TooFarAway& e) {
    refuse(e.what());
  }
  for (const auto& [name, value] : {std::pair{"x", g.position.x()},
                                    {"y", g.position.y()},
                                    {"z", g.position.z()},
                                    {"radius", g.radius},
                                    {"volume", g.volume},
                                    {"mass", g.mass},
                                    {"inertia", g.inertia},
                                    {"vx", g.velocity.x()},
                                    {"vy", g.velocity.y()},
                                    {"vz", g.velocity.z()},
                                    {"angle", g.angle},
                                    {"spin_x", g.angular_velocity.x()},
                                    {"spin_y", g.angular_velocity.y()},
                                    {"spin", g.spin}})
    if (!(std::abs(value) <= dem::kMostNumber))
      refuse(fmt::format("its {} becomes {}, allowed: a finite number, up to {:g}", name, value,
                         dem::kMostNumber));
}

void Assembly::check_vectors() const {
  if (out_.snapshot.dim == 3) return;
  if (options_.gravity && options_.gravity->z() != 0)
    throw std::invalid_argument(
        fmt::format("--gravity: found {:g} m/s2 along z in 2D, allowed: X,Y (--dim 3 for grains in "
                    "space)",
                    options_.gravity->z()));
  if (options_.applied_force.z() != 0)
    throw std::invalid_argument(fmt::format("--load: found {:g} N along z in 2D, allowed: ID=FX,FY",
                                            options_.applied_force.z()));
}

void Assembly::check_fixed() const {
  if (options_.fixed_column.empty() || some_marked_) return;
  std::vector<std::string> some = marks_;
  if (some.size() > kMostMarks) some.back() = "...";
  throw std::invalid_argument(fmt::format(
      "--fixed {}={}: no grain has that; column {} holds {}", options_.fixed_column,
      fmt::join(options_.fixed_values, ","), options_.fixed_column, fmt::join(some, ", ")));
}

void Assembly::check_places() {
  const auto& grains = out_.snapshot.grains;
  std::vector<std::size_t> order(grains.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t k) {
    const dem::Vec3& p = grains[k].position;
    return std::tuple(p.x(), p.y(), p.z(), k);
  };
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
  for (std::size_t k = 1; k < order.size(); ++k) {
    const dem::Grain &a = grains[order[k - 1]], &b = grains[order[k]];
    if (a.position != b.position) continue;
    throw std::invalid_argument(fmt::format(
        "{}: grains {} and {} have the same centre, ({:g}, {:g}, {:g}) m{}, allowed: a place for "
        "each",
        rows_[order[k]].source.where(), a.id, b.id, a.position.x(), a.position.y(), a.position.z(),
        out_.snapshot.cell.is_periodic() ? " in the periodic cell" : ""));
  }
  const auto median = [&](auto value) {
    std::vector<double> all;
    all.reserve(grains.size());
    for (const dem::Grain& g : grains) all.push_back(value(g));
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    return *middle;
  };
  dem::Vec3 middle;
  for (Eigen::Index a = 0; a < 3; ++a)
    middle[a] = median([a](const dem::Grain& g) { return g.position[a]; });
  const double radius = median([](const dem::Grain& g) { return g.radius; });
  long long far = 0;
  std::int64_t first = 0;
  for (std::size_t k = 0; k < grains.size(); ++k) {
    const double radii = (grains[k].position - middle).norm() / radius;
    if (radii <= kFar) continue;
    if (!(radii <= kTooFar))
      throw std::invalid_argument(fmt::format(
          "{}: grain {} is {:.3g} median radii from the middle of the packing, allowed: up to {:g}",
          rows_[k].source.where(), grains[k].id, radii, kTooFar));
    if (far++ == 0) first = grains[k].id;
  }
  if (far > 0)
    out_.warnings.push_back(fmt::format(
        "{} of {} grains are more than {:g} median radii from the middle of the packing "
        "(the first: {}): gone astray, or in other units?",
        far, grains.size(), kFar, first));
}

void Assembly::settle_walls() {
  dem::Snapshot& s = out_.snapshot;
  dem::Vec3 middle(0, 0, 0);
  for (const dem::Grain& g : s.grains) middle += g.position / static_cast<double>(s.grains.size());
  for (const WallChoice& choice : options_.walls) {
    if (choice.axis >= s.dim)
      throw std::invalid_argument(
          fmt::format("--wall {}: a wall across z in a packing in 2D", choice.name));
    dem::Wall wall;
    wall.name = choice.name;
    wall.point.setZero();
    wall.normal.setZero();
    wall.point[choice.axis] = choice.position;
    wall.normal[choice.axis] = middle[choice.axis] < choice.position ? -1 : 1;
    wall.friction = options_.friction;
    wall.material = choice.material;
    s.walls.push_back(wall);
  }
  sides_.resize(s.walls.size());
}

void Assembly::settle() {
  dem::Snapshot& s = out_.snapshot;
  if (rows_.empty())
    throw std::invalid_argument(fmt::format("{}: the tables of grains hold no row", first_file_));
  settle_dimension();
  settle_cell();
  check_vectors();
  check_fixed();
  std::stable_sort(rows_.begin(), rows_.end(),
                   [](const GrainRow& a, const GrainRow& b) { return a.grain.id < b.grain.id; });
  for (std::size_t k = 1; k < rows_.size(); ++k)
    if (rows_[k].grain.id == rows_[k - 1].grain.id)
      throw std::invalid_argument(fmt::format("{}: grain {} is there already, at {}",
                                              rows_[k].source.where(), rows_[k].grain.id,
                                              rows_[k - 1].source.where()));
  for (GrainRow& row : rows_) {
    if (s.dim == 2) row.grain.position.z() = row.grain.velocity.z() = 0;
    complete(row);
  }
  if (s.cell.is_periodic()) s.attributes["images"] = images_of_files();
  for (GrainRow& row : rows_) {
    place(row);
    s.grains.push_back(std::move(row.grain));
  }
  check_places();
  rows_ = {};
  const std::size_t tables = s.walls.size();
  settle_walls();
  for (const WallForce& force : wall_forces_) {
    ContactRow row{{}, force.source};
    row.contact.i = index_of(force.grain);
    row.contact.j = -1 - static_cast<std::int64_t>(tables + force.choice);
    row.contact.force = (options_.flip_forces ? -1 : 1) * force.force;
    row.contact.point = force.point;
    row.contact.friction = options_.friction;
    set_spring(std::nullopt, row.contact);
    add_contact(std::move(row), false, true, true);
  }
  wall_forces_ = {};
}

std::int64_t Assembly::index_of(std::int64_t id) const {
  const auto& grains = out_.snapshot.grains;
  const auto at = std::lower_bound(grains.begin(), grains.end(), id,
                                   [](const dem::Grain& g, std::int64_t v) { return g.id < v; });
  return at == grains.end() || at->id != id ? -1 : at - grains.begin();
}

std::int64_t Assembly::wall_of(std::string_view text) const {
  const auto& walls = out_.snapshot.walls;
  const std::size_t tables = walls.size() - options_.walls.size();
  for (std::size_t w = 0; w < walls.size(); ++w) {
    bool same = walls[w].name == text;
    if (w >= tables)
      for (const std::string& id : options_.walls[w - tables].ids) same = same || id == text;
    if (same) return -1 - static_cast<std::int64_t>(w);
  }
  return 0;
}

std::string Assembly::known_grains() const {
  const auto& s = out_.snapshot;
  std::vector<std::string> walls;
  for (const dem::Wall& wall : s.walls) walls.push_back(wall.name);
  return fmt::format(
      "known: {} grains with ids from {} to {}{}", s.grains.size(), s.grains.front().id,
      s.grains.back().id,
      walls.empty() ? ", no walls (--wall)" : fmt::format(", walls {}", fmt::join(walls, ", ")));
}

}  // namespace grainfield::coupling
