#include "dem/snapshot/snapshot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string_view>

#include "dem/snapshot/hdf5_file.h"

namespace grainfield::dem {
namespace {

constexpr const char* kFormat = "grainfield-snapshot-1";
// Groups in groups that are searched for snapshots.
constexpr int kDeepest = 64;
// Bytes of names of snapshots in a message.
constexpr std::size_t kMostListed = 1000;

template <class Items, class Get>
std::vector<double> gather(const Items& items, Get get) {
  std::vector<double> values;
  values.reserve(items.size());
  for (const auto& item : items) values.push_back(get(item));
  return values;
}
template <class Items, class Get>
std::vector<long long> gather_integers(const Items& items, Get get) {
  std::vector<long long> values;
  values.reserve(items.size());
  for (const auto& item : items) values.push_back(get(item));
  return values;
}
template <class Items, class Get>
std::vector<double> gather_vectors(const Items& items, Get get) {
  std::vector<double> values;
  values.reserve(3 * items.size());
  for (const auto& item : items) {
    const Vec3 v = get(item);
    values.insert(values.end(), {v.x(), v.y(), v.z()});
  }
  return values;
}

Vec3 vector_at(const std::vector<double>& values, std::size_t row) {
  return Vec3(values[3 * row], values[3 * row + 1], values[3 * row + 2]);
}

bool is_snapshot(hid_t group) { return hdf5::attribute_is(group, "format", kFormat); }

// Every group is looked into once: hard links may lead in circles.
void collect(hid_t object, const std::string& path, int depth, std::set<haddr_t>& seen,
             std::vector<std::string>& found) {
  if (depth > kDeepest || !seen.insert(hdf5::address(object)).second) return;
  for (const std::string& name : hdf5::groups(object)) {
    const hdf5::Handle child = hdf5::open_group(object, name);
    const std::string full = path + "/" + name;
    if (is_snapshot(child)) {
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

void add_snapshot(hid_t file, const std::string& group_name, const Snapshot& s) {
  const hdf5::Handle group = hdf5::create_group(file, group_name);
  hdf5::write_attribute(group, "format", kFormat);
  hdf5::write_attribute(group, "dim", static_cast<double>(s.dim));
  hdf5::write_attribute(group, "time", s.time);
  hdf5::write_attribute(group, "loaded_grain", static_cast<double>(s.loaded_grain));
  for (int k = 0; k < 3; ++k) {
    const char axis = "xyz"[k];
    hdf5::write_attribute(group, fmt::format("gravity_{}", axis), s.gravity[k]);
    hdf5::write_attribute(group, fmt::format("applied_force_{}", axis), s.applied_force[k]);
  }
  hdf5::write_attribute(group, "units", "SI; 2D: areal density kg/m2, stiffness N/m, volume m2");
  for (const auto& [name, value] : s.attributes) {
    hdf5::write_attribute(group, "run_" + name, value);
  }

  const hdf5::Handle g = hdf5::create_group(group, "grains");
  hdf5::write(g, "id", gather_integers(s.grains, [](const Grain& a) { return a.id; }), 1, "1");
  hdf5::write(g, "position", gather_vectors(s.grains, [](const Grain& a) { return a.position; }), 3,
              "m");
  hdf5::write(g, "velocity", gather_vectors(s.grains, [](const Grain& a) { return a.velocity; }), 3,
              "m/s");
  hdf5::write(g, "angle", gather(s.grains, [](const Grain& a) { return a.angle; }), 1, "rad");
  hdf5::write(g, "spin", gather(s.grains, [](const Grain& a) { return a.spin; }), 1, "rad/s");
  hdf5::write(g, "radius", gather(s.grains, [](const Grain& a) { return a.radius; }), 1, "m");
  hdf5::write(g, "mass", gather(s.grains, [](const Grain& a) { return a.mass; }), 1, "kg");
  hdf5::write(g, "inertia", gather(s.grains, [](const Grain& a) { return a.inertia; }), 1, "kg m2");
  hdf5::write(g, "volume", gather(s.grains, [](const Grain& a) { return a.volume; }), 1,
              s.dim == 2 ? "m2" : "m3");
  hdf5::write(g, "fixed", gather_integers(s.grains, [](const Grain& a) { return a.fixed ? 1 : 0; }),
              1, "1");
  // Outlines one after another: grain k has corners start[k] .. start[k+1].
  std::vector<long long> start{0};
  std::vector<double> corners;
  for (const Grain& a : s.grains) {
    for (const auto& corner : a.outline)
      corners.insert(corners.end(), corner.begin(), corner.end());
    start.push_back(static_cast<long long>(corners.size() / 2));
  }
  if (!corners.empty()) {
    hdf5::write(g, "outline_start", start, 1, "1");
    hdf5::write(g, "outline", corners, 2, "m");
  }

  const hdf5::Handle c = hdf5::create_group(group, "contacts");
  hdf5::write(c, "i", gather_integers(s.contacts, [](const Contact& a) { return a.i; }), 1, "1");
  hdf5::write(c, "j", gather_integers(s.contacts, [](const Contact& a) { return a.j; }), 1, "1");
  hdf5::write(c, "point", gather_vectors(s.contacts, [](const Contact& a) { return a.point; }), 3,
              "m");
  hdf5::write(c, "normal", gather_vectors(s.contacts, [](const Contact& a) { return a.normal; }), 3,
              "1");
  hdf5::write(c, "force", gather_vectors(s.contacts, [](const Contact& a) { return a.force; }), 3,
              "N");
  hdf5::write(c, "normal_force",
              gather(s.contacts, [](const Contact& a) { return a.normal_force; }), 1, "N");
  hdf5::write(c, "tangential_force",
              gather(s.contacts, [](const Contact& a) { return a.tangential_force; }), 1, "N");
  hdf5::write(c, "spring", gather(s.contacts, [](const Contact& a) { return a.spring; }), 1, "N");
  hdf5::write(c, "friction", gather(s.contacts, [](const Contact& a) { return a.friction; }), 1,
              "1");
  hdf5::write(c, "sliding",
              gather_integers(s.contacts, [](const Contact& a) { return a.sliding ? 1 : 0; }), 1,
              "1");

  const hdf5::Handle w = hdf5::create_group(group, "walls");
  hdf5::write(w, "point", gather_vectors(s.walls, [](const Wall& a) { return a.point; }), 3, "m");
  hdf5::write(w, "normal", gather_vectors(s.walls, [](const Wall& a) { return a.normal; }), 3, "1");
  hdf5::write(w, "friction", gather(s.walls, [](const Wall& a) { return a.friction; }), 1, "1");
  std::string names;
  for (const Wall& wall : s.walls) names += (names.empty() ? "" : ",") + wall.name;
  hdf5::write_attribute(w, "names", names);
}

// Throws with the names of those there are.
hdf5::Handle open_snapshot(const hdf5::Handle& file, const std::string& name,
                           const std::string& where) {
  if (hdf5::has_group(file, name)) {
    hdf5::Handle group = hdf5::open_group(file, name);
    if (is_snapshot(group)) return group;
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

}  // namespace

void write_snapshot(const std::string& file, const std::string& group_name, const Snapshot& s) {
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
    if (name.starts_with("run_"))
      s.attributes[name.substr(4)] = hdf5::read_text_attribute(group, name);
  }
  const auto open = [&](const char* name) { return hdf5::open_group(group, name); };
  // nan is for coefficients that other programs do not tell; what moves, weighs or pushes is known.
  const auto finite = [&](const std::vector<double>& values, int columns, const char* what,
                          const auto& name_of) {
    const auto bad =
        std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
    if (bad == values.end()) return;
    throw std::invalid_argument(
        fmt::format("{}: {} of {} is {}; it must be a finite number", where, what,
                    name_of(static_cast<std::size_t>(bad - values.begin()) / columns), *bad));
  };
  for (int k = 0; k < 3; ++k)
    if (!std::isfinite(s.gravity[k]) || !std::isfinite(s.applied_force[k]))
      throw std::invalid_argument(
          fmt::format("{}: gravity or the applied force is not a finite number", where));
  const auto same_length = [&](std::size_t found, std::size_t wanted, const char* what) {
    if (found != wanted) {
      throw std::invalid_argument(
          fmt::format("{}: {} has {} rows where {} are expected", where, what, found, wanted));
    }
  };
  {
    const hdf5::Handle g = open("grains");
    const std::string at = where + "/grains";
    const auto id = hdf5::read_integers(g, "id", 1, at);
    const std::size_t n = id.size();
    const auto doubles = [&](const char* name, int columns) {
      auto values = hdf5::read_doubles(g, name, columns, at);
      same_length(values.size() / columns, n, name);
      finite(values, columns, name, [&](std::size_t k) { return fmt::format("grain {}", id[k]); });
      return values;
    };
    const auto position = doubles("position", 3), velocity = doubles("velocity", 3);
    const auto angle = doubles("angle", 1), spin = doubles("spin", 1),
               radius = doubles("radius", 1);
    const auto mass = doubles("mass", 1), inertia = doubles("inertia", 1);
    const auto volume = doubles("volume", 1);
    const auto fixed = hdf5::read_integers(g, "fixed", 1, at);
    same_length(fixed.size(), n, "fixed");
    s.grains.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
      s.grains[k] = {id[k],
                     vector_at(position, k),
                     vector_at(velocity, k),
                     angle[k],
                     spin[k],
                     radius[k],
                     mass[k],
                     inertia[k],
                     volume[k],
                     fixed[k] != 0,
                     {}};
    }
    if (hdf5::has_link(g, "outline_start")) {
      const auto start = hdf5::read_integers(g, "outline_start", 1, at);
      const auto corners = hdf5::read_doubles(g, "outline", 2, at);
      finite(corners, 2, "outline", [](std::size_t k) { return fmt::format("corner {}", k); });
      same_length(start.size(), n + 1, "outline_start");
      const auto total = static_cast<long long>(corners.size() / 2);
      if (start.front() != 0 || start.back() != total ||
          !std::is_sorted(start.begin(), start.end())) {
        throw std::invalid_argument(fmt::format("{}: outline_start does not fit outline", at));
      }
      for (std::size_t k = 0; k < n; ++k) {
        for (long long v = start[k]; v < start[k + 1]; ++v) {
          s.grains[k].outline.push_back({corners[2 * v], corners[2 * v + 1]});
        }
      }
    }
  }
  {
    const hdf5::Handle w = open("walls");
    const std::string at = where + "/walls";
    const auto point = hdf5::read_doubles(w, "point", 3, at);
    const auto normal = hdf5::read_doubles(w, "normal", 3, at);
    const auto friction = hdf5::read_doubles(w, "friction", 1, at);
    same_length(point.size() / 3, friction.size(), "walls/point");
    same_length(normal.size() / 3, friction.size(), "walls/normal");
    const auto wall = [](std::size_t k) { return fmt::format("wall {}", k); };
    finite(point, 3, "point", wall);
    finite(normal, 3, "normal", wall);
    std::string names = hdf5::read_text_attribute(w, "names");
    for (std::size_t k = 0; k < friction.size(); ++k) {
      const std::size_t comma = names.find(',');
      s.walls.push_back(
          {names.substr(0, comma), vector_at(point, k), vector_at(normal, k), friction[k]});
      names = comma == std::string::npos ? "" : names.substr(comma + 1);
    }
  }
  {
    const hdf5::Handle c = open("contacts");
    const std::string at = where + "/contacts";
    const auto i = hdf5::read_integers(c, "i", 1, at), j = hdf5::read_integers(c, "j", 1, at);
    const std::size_t n = i.size();
    same_length(j.size(), n, "contacts/j");
    const auto doubles = [&](const char* name, int columns) {
      auto values = hdf5::read_doubles(c, name, columns, at);
      same_length(values.size() / columns, n, name);
      const std::string_view coefficient = name;
      if (coefficient != "spring" && coefficient != "friction")
        finite(values, columns, name, [](std::size_t k) { return fmt::format("contact {}", k); });
      return values;
    };
    const auto point = doubles("point", 3), normal = doubles("normal", 3),
               force = doubles("force", 3);
    const auto normal_force = doubles("normal_force", 1), spring = doubles("spring", 1);
    const auto tangential_force = doubles("tangential_force", 1), friction = doubles("friction", 1);
    const auto sliding = hdf5::read_integers(c, "sliding", 1, at);
    same_length(sliding.size(), n, "contacts/sliding");
    const auto grains = static_cast<long long>(s.grains.size());
    const auto walls = static_cast<long long>(s.walls.size());
    s.contacts.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
      if (i[k] < 0 || i[k] >= grains || j[k] >= grains || j[k] < -walls) {
        throw std::invalid_argument(fmt::format(
            "{}: contact {} names the unknown grain or wall ({}, {})", where, k, i[k], j[k]));
      }
      s.contacts[k] = {i[k],
                       j[k],
                       vector_at(point, k),
                       vector_at(normal, k),
                       vector_at(force, k),
                       normal_force[k],
                       tangential_force[k],
                       spring[k],
                       friction[k],
                       sliding[k] != 0};
    }
  }
  return s;
}

std::vector<std::string> list_snapshots(const std::string& file) {
  return snapshots_in(hdf5::open_for_reading(file));
}

}  // namespace grainfield::dem
