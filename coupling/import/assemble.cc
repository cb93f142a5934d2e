// A packing of the rows of grains and walls: its dimension, cell, places and masses. Rows are read
// in assemble_rows.cc, contacts in assemble_contacts.cc.
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

#include "dem/shapes/polygon.h"
#include "dem/shared/number.h"
#include "dem/snapshot/cell_places.h"
#include "dem/snapshot/check_snapshot.h"
#include "dem/snapshot/images.h"
#include "dem/snapshot/limits.h"

namespace grainfield::coupling {

namespace {

// Median radii from the middle of the packing: a warning, and a refusal.
constexpr double kFar = 1e6, kTooFar = 1e9;
// Radii along an axis that are rounding, also of numbers with four bytes.
constexpr double kFlat = 1e-6;
constexpr double kWide = 30;  // packings that fit into a periodic cell: one in another unit
// Between a volume that is told and that of the radius: what three digits leave.
constexpr double kSameVolume = 1e-2;

}  // namespace

void Assembly::settle_dimension() {
  dem::Snapshot& s = out_.snapshot;
  const double z = rows_.front().grain.position.z();
  // Rounding leaves a plane packing some digits along an axis.
  const auto off_plane = [&](Eigen::Index axis, double size) {
    const double first = rows_.front().grain.position[axis];
    return std::find_if(rows_.begin(), rows_.end(), [&, axis, size](const GrainRow& row) {
      const double radius = std::max(row.grain.radius, row.grain.axes.maxCoeff());
      return std::abs(row.grain.position[axis] - first) > size * radius;
    });
  };
  const auto other = off_plane(2, kFlat);
  const bool across =
      rows_.size() > 2 && other != rows_.end() && off_plane(1, kFlat) == rows_.end();
  const std::string swap =
      " (every y is the same: --dim 2 --column y=z --column z=y --column fy=fz --column fz=fy ... "
      "import a packing in the xz-plane)";
  s.dim = options_.dim != 0 ? options_.dim : has_z_ && other != rows_.end() ? 3 : 2;
  if (const auto& told = s.dim == 2 ? space_units_ : plane_units_; !told.empty())
    throw std::invalid_argument(fmt::format(
        "{} in a packing in {}D, allowed: {}{}", told.front(), s.dim,
        s.dim == 2 ? "density in kg/m2, volume in m2, mass in kg or kg/m"
                   : "density in kg/m3, volume in m3, mass in kg",
        // Without a z the grains can be of the plane alone.
        s.dim == 2 && has_z_ && options_.dim == 0 ? "; --dim 3 for spheres whose centres have one z"
                                                  : ""));
  if (s.dim == 2 && other != rows_.end())
    throw std::invalid_argument(fmt::format(
        "{}: grain {} has z = {}, grain {} has z = {}; 2D needs one z: --dim 3 for grains "
        "in space{}",
        other->source.where(), other->grain.id, other->grain.position.z(), rows_.front().grain.id,
        z, across ? swap : ""));
  if (across && options_.dim == 0)
    out_.notes.push_back(
        fmt::format("{}: the centres lie in a plane, and are read in 3D{}", first_file_, swap));
  if (s.dim == 2 && has_z_ && off_plane(2, 0) != rows_.end())
    out_.notes.push_back(fmt::format(
        "{}: the places differ along z by less than a millionth of a radius: read as a plane",
        first_file_));
  const GrainRow& first = rows_.front();
  if (s.dim == 2 && first.density > 0 && first.sphere_density)
    out_.notes.push_back(
        fmt::format("{}: the density is that of spheres, {:g} kg/m3, in the plane, too",
                    first_file_, first.density));
  else if (s.dim == 2 && options_.dim == 0 && has_z_ && first.density > 0)
    out_.notes.push_back(fmt::format(
        "{}: every z is the same: read as disks, whose density is {:g} kg/m2 (--dim 3: spheres)",
        first_file_, first.density));
  const auto polygon = std::find_if(rows_.begin(), rows_.end(),
                                    [](const GrainRow& row) { return !row.grain.outline.empty(); });
  const auto solid = std::find_if(rows_.begin(), rows_.end(),
                                  [](const GrainRow& row) { return !row.grain.axes.isZero(0); });
  if (options_.dim == 0 && solid != rows_.end()) s.dim = 3;
  if (s.dim == 2 && solid != rows_.end())
    throw std::invalid_argument(fmt::format("{}: grain {} is a superellipsoid, allowed: --dim 3",
                                            solid->source.where(), solid->grain.id));
  if (s.dim == 3 && polygon != rows_.end())
    throw std::invalid_argument(
        fmt::format("{}: grain {} is a polygon; 3D takes spheres and superellipsoids, "
                    "--dim 2 a plane packing",
                    polygon->source.where(), polygon->grain.id));
}

// The axes that repeat, of the packing's dimension.
void Assembly::settle_cell() {
  dem::Snapshot& s = out_.snapshot;
  if (options_.leave_out_distant) return;
  s.cell = cell_;
  if (!options_.periodic.empty()) s.cell = {};
  for (const PeriodicAxis& p : options_.periodic) {
    if (p.axis >= s.dim)
      throw std::invalid_argument(
          "--periodic z: the packing is in 2D, allowed: x, y (--dim 3 for grains in space)");
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
      if (std::hypot(c[0], c[1]) > dem::circumradius_of(g.outline))
        throw std::invalid_argument(fmt::format(
            "its corners lie about ({:g}, {:g}), allowed: about (0, 0), relative to x and y", c[0],
            c[1]));
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
  const bool round = g.outline.empty() && g.axes.isZero(0);
  if (g.volume > 0 && std::abs(g.volume - volume) > kSameVolume * volume)
    throw std::invalid_argument(fmt::format(
        "{}: grain {}: found volume {:g} and {}, which makes {:g}, allowed: those that "
        "agree; --column volume=0 leaves the column out (the cell of a tessellation is no grain's)",
        row.source.where(), g.id, g.volume,
        round ? fmt::format("radius {:g} m", g.radius)
              : fmt::format("a shape that reaches {:g} m from its centre", g.radius),
        volume));
  if (g.volume == 0) g.volume = volume;
  // In 2D a density may be one of spheres; that of a dump is.
  const double as_spheres = 4.0 / 3 * std::numbers::pi * g.radius * g.radius * g.radius;
  const bool sphere = row.sphere_density && round && out_.snapshot.dim == 2;
  if (row.density > 0) g.mass = row.density * (sphere ? as_spheres : g.volume);
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
      throw std::invalid_argument(
          fmt::format("{}: grain {} is {:.3g} median radii from the middle of the packing, "
                      "allowed: up to {:g}; "
                      "correct its place or leave it out of the file",
                      rows_[k].source.where(), grains[k].id, radii, kTooFar));
    if (far++ == 0) first = grains[k].id;
  }
  if (far > 0)
    out_.warnings.push_back(fmt::format(
        "{} of {} grains are more than {:g} median radii from the middle of the packing "
        "(the first: {}): gone astray, or in other units?",
        far, grains.size(), kFar, first));
}

void Assembly::check_widths() {
  const dem::Snapshot& s = out_.snapshot;
  for (Eigen::Index a = 0; a < s.dim; ++a) {
    if (!s.cell.periodic[static_cast<std::size_t>(a)]) continue;
    double low = s.grains.front().position[a], high = low, radius = 0;
    for (const dem::Grain& g : s.grains) {
      low = std::min(low, g.position[a]);
      high = std::max(high, g.position[a]);
      radius = std::max(radius, g.radius);
    }
    const double packing = high - low + 2 * radius, width = s.cell.edges.col(a).norm();
    if (width > kWide * packing)
      out_.warnings.push_back(fmt::format(
          "the periodic cell is {:.3g} m wide along {}, {:.3g} times as wide as the packing in it: "
          "is it in the unit of the places (--periodic x=0:\"5 mm\")?",
          width, "xyz"[a], width / packing));
  }
}

void Assembly::settle_walls() {
  dem::Snapshot& s = out_.snapshot;
  dem::Vec3 middle(0, 0, 0);
  for (const dem::Grain& g : s.grains) middle += g.position / static_cast<double>(s.grains.size());
  for (const WallChoice& choice : options_.walls) {
    if (choice.axis >= s.dim)
      throw std::invalid_argument(
          fmt::format("--wall {}: a wall across z in a packing in 2D, allowed: x, y (--dim 3 for "
                      "grains in space)",
                      choice.name));
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
    throw std::invalid_argument(fmt::format(
        "{}: the tables of grains hold no row, expected one of each grain", first_file_));
  settle_dimension();
  settle_cell();
  check_vectors();
  check_fixed();
  std::stable_sort(rows_.begin(), rows_.end(),
                   [](const GrainRow& a, const GrainRow& b) { return a.grain.id < b.grain.id; });
  for (GrainRow& row : rows_) {
    if (s.dim == 2) row.grain.position.z() = row.grain.velocity.z() = 0;
    complete(row);
  }
  if (s.cell.is_periodic()) s.attributes["images"] = images_of_files();
  for (GrainRow& row : rows_) place(row);
  join_repeated_grains();
  for (GrainRow& row : rows_) s.grains.push_back(std::move(row.grain));
  check_places();
  check_widths();
  if (format_.copies_have_numbers) sort_for_copies();
  rows_ = {};
  const std::size_t tables = s.walls.size();
  settle_walls();
  for (const WallForce& force : wall_forces_) {
    ContactRow row{{}, force.source};
    row.contact.i = index_of(force.grain);
    row.contact.j = -1 - static_cast<std::int64_t>(tables + force.choice);
    row.contact.force = options_.sign_of(true) * force.force;
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

int Assembly::facet_of(std::int64_t wall, std::string_view text) const {
  const std::size_t tables = out_.snapshot.walls.size() - options_.walls.size();
  const auto w = static_cast<std::size_t>(-1 - wall);
  if (w < tables) return 0;
  const std::vector<std::string>& ids = options_.walls[w - tables].ids;
  auto at = std::find(ids.begin(), ids.end(), text);
  const std::optional<double> number = parse_number(text);  // "3.0" is the wall 3, too
  if (at == ids.end() && number) at = std::find(ids.begin(), ids.end(), fmt::format("{}", *number));
  return at == ids.end() ? 0 : 1 + static_cast<int>(at - ids.begin());
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
