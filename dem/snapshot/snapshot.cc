#include "dem/snapshot/snapshot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "dem/hdf5/crc.h"
#include "dem/hdf5/file.h"
#include "dem/shared/number.h"
#include "dem/snapshot/check_snapshot.h"
#include "dem/snapshot/limits.h"
#include "dem/snapshot/number_tables.h"
#include "dem/snapshot/table_file.h"
#include "dem/snapshot/wall_forces.h"

namespace grainfield::dem {

std::string joined_names(const std::vector<std::string>& names, const std::string& what) {
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k].find(',') != std::string::npos)
      throw std::invalid_argument(
          fmt::format("{}: found the name \"{}\", allowed: names without commas", what, names[k]));
    text += (k > 0 ? "," : "") + names[k];
  }
  return text;
}

std::vector<std::string> split_names(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t at = 0;;) {
    const std::size_t comma = text.find(',', at);
    names.push_back(text.substr(at, comma - at));
    if (comma == std::string::npos) return names;
    at = comma + 1;
  }
}

void require_rows(const TableSource& source, const std::string& what, std::size_t found,
                  std::size_t wanted) {
  if (found == wanted) return;
  throw std::invalid_argument(
      fmt::format("{}: {} has {} rows where {} are expected", source.where, what, found, wanted));
}

namespace {

const char* what_is_allowed(double found) {
  return std::isfinite(found) ? "of size 1e+100 at most" : "a finite number";
}

// The size of an attribute's number.
void require_size(double found, const std::string& name, const std::string& where) {
  if (std::fabs(found) <= kMostNumber) return;
  throw std::invalid_argument(fmt::format("{}: attribute '{}' is {}; it must be {}", where, name,
                                          found, what_is_allowed(found)));
}

// Ids in ascending order, separated by spaces.
std::vector<std::int64_t> ids_of(const std::string& text, const std::string& where) {
  std::istringstream in(text);
  std::vector<std::int64_t> out;
  bool good = true;
  for (std::string word; in >> word;) {
    const std::optional<long long> id = parse_integer(word);
    good = good && id && *id >= 0 && (out.empty() || *id > out.back());
    out.push_back(id.value_or(-1));
  }
  if (out.empty() || !good)
    throw std::invalid_argument(
        fmt::format("{}: also_loaded: found \"{}\", allowed: ids in ascending order", where, text));
  return out;
}

// Groups in groups that are searched for snapshots.
constexpr int kDeepest = 64;
// Bytes of names of snapshots in a message.
constexpr std::size_t kMostListed = 1000;

std::string format_name(int format) { return fmt::format("grainfield-snapshot-{}", format); }

// Which layout the group has; 0: it is no snapshot.
int format_of(hid_t group) {
  for (int format = 1; format <= kSnapshotFormat; ++format) {
    if (hdf5::attribute_is(group, "format", format_name(format))) return format;
  }
  return 0;
}

// Every group is looked into once: hard links may lead in circles.
void collect(hid_t object, const std::string& path, int depth, std::set<haddr_t>& seen,
             std::vector<std::string>& found) {
  if (depth > kDeepest || !seen.insert(hdf5::address(object)).second) return;
  for (const std::string& name : hdf5::groups(object)) {
    const hdf5::Handle child = hdf5::open_group(object, name);
    const std::string full = path + "/" + name;
    if (format_of(child) > 0) {
      found.push_back(full);
    } else {
      collect(child, full, depth + 1, seen, found);
    }
  }
}

std::vector<std::string> snapshots_in(const hdf5::Handle& file) {
  const hdf5::Handle root = hdf5::open_group(file, "/");
  std::set<haddr_t> seen;
  std::vector<std::string> found;
  collect(root, "", 0, seen, found);
  return found;
}

// Points of the rows' lists one after another as NAME: row k has those from NAME_start[k] up to
// NAME_start[k + 1]. Nothing where all lists are empty.
template <class Row, class List>
void write_lists(hid_t group, const std::string& name, int columns, const std::vector<Row>& rows,
                 List Row::*list) {
  std::vector<long long> start{0};
  std::vector<double> numbers;
  for (const Row& row : rows) {
    for (const auto& item : row.*list)
      for (const auto& part : item) {
        if constexpr (std::is_same_v<std::decay_t<decltype(part)>, double>)
          numbers.push_back(part);
        else
          numbers.insert(numbers.end(), part.begin(), part.end());
      }
    start.push_back(static_cast<long long>(numbers.size()) / columns);
  }
  if (numbers.empty()) return;
  hdf5::write(group, name + "_start", start, 1, "1");
  hdf5::write(group, name, numbers, columns, "m");
}

// take(row, the numbers of a point) for all that write_lists has written.
template <class Row, class Take>
void read_lists(hid_t group, const std::string& name, int columns, const std::string& at,
                const TableSource& source, std::vector<Row>& rows, Take take) {
  if (!hdf5::has_link(group, name + "_start")) return;
  const auto start = hdf5::read_integers(group, name + "_start", 1, at);
  const auto numbers = hdf5::read_doubles(group, name, columns, at);
  const auto bad = std::find_if(numbers.begin(), numbers.end(),
                                [](double v) { return !(std::fabs(v) <= kMostNumber); });
  if (bad != numbers.end())
    throw std::invalid_argument(fmt::format("{}: row {} of {} is {}; it must be {}", source.where,
                                            (bad - numbers.begin()) / columns, name, *bad,
                                            what_is_allowed(*bad)));
  require_rows(source, name + "_start", start.size(), rows.size() + 1);
  const auto total = static_cast<long long>(numbers.size()) / columns;
  if (start.front() != 0 || start.back() != total || !std::is_sorted(start.begin(), start.end()))
    throw std::invalid_argument(fmt::format("{}: {}_start does not fit {}", at, name, name));
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (long long v = start[k]; v < start[k + 1]; ++v) take(rows[k], &numbers[v * columns]);
}

// Row k of `edges` is the k-th edge.
void write_cell(hid_t parent, const Cell<3>& cell) {
  const hdf5::Handle group = hdf5::create_group(parent, "cell");
  std::vector<long long> periodic;
  std::vector<double> low, edges, gradient;
  for (int a = 0; a < 3; ++a) {
    periodic.push_back(cell.periodic[static_cast<std::size_t>(a)] ? 1 : 0);
    low.push_back(cell.low[a]);
    for (int b = 0; b < 3; ++b) {
      edges.push_back(cell.edges(b, a));
      gradient.push_back(cell.velocity_gradient(a, b));
    }
  }
  hdf5::write(group, "periodic", periodic, 1, "1");
  hdf5::write(group, "low", low, 1, "m");
  hdf5::write(group, "edges", edges, 3, "m");
  hdf5::write(group, "velocity_gradient", gradient, 3, "1/s");
}

Cell<3> read_cell(hid_t parent, const TableSource& source) {
  Cell<3> cell;
  if (!hdf5::has_link(parent, "cell")) return cell;
  const hdf5::Handle group = hdf5::open_group(parent, "cell");
  const std::string at = source.where + "/cell";
  const auto periodic = hdf5::read_integers(group, "periodic", 1, at);
  const auto low = hdf5::read_doubles(group, "low", 1, at);
  const auto edges = hdf5::read_doubles(group, "edges", 3, at);
  const auto gradient = hdf5::read_doubles(group, "velocity_gradient", 3, at);
  require_rows(source, "cell/periodic", periodic.size(), 3);
  require_rows(source, "cell/low", low.size(), 3);
  require_rows(source, "cell/edges", edges.size() / 3, 3);
  require_rows(source, "cell/velocity_gradient", gradient.size() / 3, 3);
  for (int a = 0; a < 3; ++a) {
    const auto row = static_cast<std::size_t>(a);
    cell.periodic[row] = periodic[row] != 0;
    cell.low[a] = low[row];
    for (int b = 0; b < 3; ++b) {
      cell.edges(b, a) = edges[3 * row + static_cast<std::size_t>(b)];
      cell.velocity_gradient(a, b) = gradient[3 * row + static_cast<std::size_t>(b)];
    }
  }
  return cell;
}

bool has_triangles(const Snapshot& s) {
  return std::any_of(s.walls.begin(), s.walls.end(),
                     [](const Wall& wall) { return !wall.triangles.empty(); });
}

// The oldest layout that holds all of it.
int format_for(const Snapshot& s) {
  const bool plain = is_plain(grain_columns(s.dim), s.grains, s.dim) &&
                     is_plain(contact_columns(), s.contacts, s.dim) &&
                     is_plain(wall_columns(), s.walls, s.dim) && !has_triangles(s) &&
                     !s.cell.is_periodic() && s.dim == 2;
  return plain ? 1 : kSnapshotFormat;
}

void add_snapshot(hid_t file, const std::string& group_name, const Snapshot& s) {
  const int format = format_for(s);
  const hdf5::Handle group = hdf5::create_group(file, group_name);
  hdf5::write_attribute(group, "format", format_name(format));
  hdf5::write_attribute(group, "dim", static_cast<double>(s.dim));
  hdf5::write_attribute(group, "time", s.time);
  hdf5::write_attribute(group, "loaded_grain", static_cast<double>(s.loaded_grain));
  for (int k = 0; k < 3; ++k) {
    const char axis = "xyz"[k];
    hdf5::write_attribute(group, fmt::format("gravity_{}", axis), s.gravity[k]);
    hdf5::write_attribute(group, fmt::format("applied_force_{}", axis), s.applied_force[k]);
  }
  if (!s.also_loaded.empty()) {
    hdf5::write_attribute(group, "also_loaded", fmt::format("{}", fmt::join(s.also_loaded, " ")));
  }
  hdf5::write_attribute(group, "units", "SI; 2D: areal density kg/m2, stiffness N/m, volume m2");
  for (const auto& [name, value] : s.attributes) {
    hdf5::write_attribute(group, "run_" + name, value);
  }

  const hdf5::Handle g = hdf5::create_group(group, "grains");
  write_table(g, grain_columns(s.dim), s.grains, s.dim, format);
  write_lists(g, "outline", 2, s.grains, &Grain::outline);

  const hdf5::Handle c = hdf5::create_group(group, "contacts");
  write_table(c, contact_columns(), s.contacts, s.dim, format);

  const hdf5::Handle w = hdf5::create_group(group, "walls");
  write_table(w, wall_columns(), s.walls, s.dim, format);
  std::vector<std::string> names;
  for (const Wall& wall : s.walls) names.push_back(wall.name);
  hdf5::write_attribute(w, "names", joined_names(names, "walls"));
  write_lists(w, "triangles", 9, s.walls, &Wall::triangles);

  if (s.cell.is_periodic()) write_cell(group, s.cell);
  write_number_tables(group, s);
}

// Throws with the names of those there are.
hdf5::Handle open_snapshot(const hdf5::Handle& file, const std::string& name,
                           const std::string& where) {
  if (hdf5::has_group(file, name)) {
    hdf5::Handle group = hdf5::open_group(file, name);
    if (format_of(group) > 0) return group;
  }
  std::string known;
  for (const std::string& found : snapshots_in(file)) {
    if (known.size() > kMostListed) {
      known += ", ...";
      break;
    }
    known += (known.empty() ? "" : ", ") + hdf5::shown(found);
  }
  throw std::invalid_argument(fmt::format("{}: no snapshot there; the file has: {}",
                                          hdf5::shown(where), known.empty() ? "none" : known));
}

void read_grains(hid_t group, const TableSource& source, Snapshot& s) {
  s.grains =
      read_table<Grain>(group, grain_columns(s.dim), source, "grains",
                        [](const Grain& g, std::size_t) { return fmt::format("grain {}", g.id); });
  read_lists(group, "outline", 2, source.where + "/grains", source, s.grains,
             [](Grain& g, const double* at) {
               g.outline.push_back({at[0], at[1]});
             });
  if (s.dim == 2 || source.format > 1) return;
  for (Grain& g : s.grains) {
    g.angular_velocity = Vec3(0, 0, g.spin);
    g.moments = Vec3::Constant(g.inertia);
  }
}

void read_walls(hid_t group, const TableSource& source, Snapshot& s) {
  s.walls =
      read_table<Wall>(group, wall_columns(), source, "walls",
                       [](const Wall&, std::size_t row) { return fmt::format("wall {}", row); });
  const auto names = split_names(hdf5::read_text_attribute(group, "names"));
  if (!s.walls.empty()) require_rows(source, "walls/names", names.size(), s.walls.size());
  for (std::size_t k = 0; k < s.walls.size(); ++k) s.walls[k].name = names[k];
  read_lists(group, "triangles", 9, source.where + "/walls", source, s.walls,
             [](Wall& wall, const double* at) {
               std::array<Vec3, 3> triangle;
               for (std::size_t v = 0; v < 3; ++v) triangle[v] = Vec3(at + 3 * v);
               wall.triangles.push_back(triangle);
             });
}

void read_contacts(hid_t group, const TableSource& source, Snapshot& s) {
  s.contacts = read_table<Contact>(
      group, contact_columns(), source, "contacts",
      [](const Contact&, std::size_t row) { return fmt::format("contact {}", row); });
  if (source.format > 1) return;
  set_wall_forces(s);
  if (s.dim == 2) return;
  // Their directions were not told.
  for (Contact& c : s.contacts)
    if (c.spring != 0) c.spring_vector.setConstant(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

bool is_loaded(const Snapshot& s, std::int64_t id) {
  return id == s.loaded_grain || std::binary_search(s.also_loaded.begin(), s.also_loaded.end(), id);
}

Vec3 total_applied_force(const Snapshot& s) {
  return static_cast<double>(1 + s.also_loaded.size()) * s.applied_force;
}

void check_group_name(const std::string& name) {
  bool good = std::none_of(name.begin(), name.end(), [](char c) {
    return c == ':' || std::iscntrl(static_cast<unsigned char>(c)) != 0;
  });
  int parts = 0;
  for (std::size_t at = name.starts_with('/') ? 1 : 0; good;) {
    const std::size_t slash = name.find('/', at);
    const std::string part = name.substr(at, slash - at);
    good = !part.empty() && part != "." && part != ".." && ++parts < kDeepest;
    if (slash == std::string::npos) break;
    at = slash + 1;
  }
  if (good) return;
  throw std::invalid_argument(
      fmt::format("found the name \"{}\" of a snapshot, allowed: names such as packing or "
                  "heap_1/loaded, without \":\", control characters and parts that are empty, "
                  "\".\" or \"..\"",
                  hdf5::shown(name)));
}

void write_snapshot(const std::string& file, const std::string& group_name, const Snapshot& s) {
  check_group_name(group_name);
  hdf5::Handle handle = hdf5::open_for_adding(file);
  add_snapshot(handle, group_name, s);
  hdf5::finish(std::move(handle), file);
}

Snapshot read_snapshot(const std::string& file, const std::string& group_name) {
  const hdf5::Handle handle = hdf5::open_for_reading(file);
  const std::string where = file + ":" + group_name;
  const hdf5::Handle group = open_snapshot(handle, group_name, where);
  Snapshot s;
  const long long dim = hdf5::read_integer_attribute(group, "dim");
  if (dim != 2 && dim != 3)
    throw std::invalid_argument(fmt::format("{}: found dim {}, allowed: 2, 3", where, dim));
  s.dim = static_cast<int>(dim);
  s.time = hdf5::read_number_attribute(group, "time");
  s.loaded_grain = hdf5::read_integer_attribute(group, "loaded_grain");
  for (int k = 0; k < 3; ++k) {
    const char axis = "xyz"[k];
    s.gravity[k] = hdf5::read_number_attribute(group, fmt::format("gravity_{}", axis));
    s.applied_force[k] = hdf5::read_number_attribute(group, fmt::format("applied_force_{}", axis));
  }
  for (const std::string& name : hdf5::text_attributes(group)) {
    if (name == "also_loaded")
      s.also_loaded = ids_of(hdf5::read_text_attribute(group, name), where);
    if (name.starts_with("run_"))
      s.attributes[name.substr(4)] = hdf5::read_text_attribute(group, name);
  }
  require_size(s.time, "time", where);
  for (int k = 0; k < 3; ++k) {
    require_size(s.gravity[k], fmt::format("gravity_{}", "xyz"[k]), where);
    require_size(s.applied_force[k], fmt::format("applied_force_{}", "xyz"[k]), where);
  }
  const TableSource source{where, s.dim, format_of(group)};
  read_grains(hdf5::open_group(group, "grains"), source, s);
  read_walls(hdf5::open_group(group, "walls"), source, s);
  read_contacts(hdf5::open_group(group, "contacts"), source, s);
  s.cell = read_cell(group, source);
  read_number_tables(group, where, s);
  check_snapshot(s, where);
  return s;
}

std::vector<std::string> list_snapshots(const std::string& file) {
  return snapshots_in(hdf5::open_for_reading(file));
}

std::vector<std::string> places_checksums(const std::string& file,
                                          const std::vector<std::string>& groups) {
  const hdf5::Handle opened = hdf5::open_for_reading(file);
  std::vector<std::string> out(groups.size());
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const std::string grains = groups[k] + "/grains";
    if (!hdf5::has_group(opened, grains)) continue;
    const hdf5::Handle group = hdf5::open_group(opened, grains);
    if (!hdf5::has_link(group, "position")) continue;
    const hdf5::Handle places(H5Dopen2(group, "position", H5P_DEFAULT), H5Dclose);
    if (places.valid() && hdf5::has_attribute(places, hdf5::kCrc)) {
      out[k] = hdf5::read_text_attribute(places, hdf5::kCrc);
    }
  }
  return out;
}

}  // namespace grainfield::dem
