#include "import_matrix_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filter/zstd.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <cmath>
#include <sstream>

#include "dem/random/random.h"
#include "dem/snapshot/cell_places.h"
#include "dem/snapshot/images.h"
#include "import_scene.h"
#include "periodic_scene.h"

namespace grainfield::test {

namespace {

using dem::Contact;
using dem::Grain;
using dem::Snapshot;
using dem::Vec3;

// Normals along the lines of centres, points in the middle of the chords and at the feet on walls.
void complete(Snapshot& s) {
  for (Contact& c : s.contacts) {
    const Grain& a = s.grains[static_cast<std::size_t>(c.i)];
    if (c.j < 0) {
      const dem::Wall& wall = s.walls[static_cast<std::size_t>(-1 - c.j)];
      c.normal = -wall.normal;
      c.point = a.position - (a.position - wall.point).dot(wall.normal) * wall.normal;
      continue;
    }
    const Grain& b = s.grains[static_cast<std::size_t>(c.j)];
    const Vec3 branch = dem::second_place(s, c) - a.position;
    const double d = branch.norm();
    c.normal = branch / d;
    c.point = a.position + (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d) * c.normal;
  }
}

Snapshot box_of_spheres(unsigned seed) {
  dem::Random random(seed);
  Snapshot s;
  s.dim = 3;
  constexpr int n = 4;
  for (int k = 0; k < n * n * n; ++k) {
    Grain g;
    g.id = k;
    g.radius = 0.0055 + 0.0004 * random.uniform();
    const auto at = [&](int m) { return 0.01 * m + 0.005 + 2e-4 * random.uniform(); };
    g.position = {at(k % n), at(k / n % n), at(k / (n * n))};
    g.volume = 4.0 / 3 * M_PI * std::pow(g.radius, 3);
    g.mass = 2500 * g.volume;
    s.grains.push_back(g);
  }
  add_wall(s, "floor", {0, 0, 0}, {0, 0, 1});
  add_wall(s, "left", {0, 0, 0}, {1, 0, 0});
  add_wall(s, "right", {0.04, 0, 0}, {-1, 0, 0});
  for (std::int64_t i = 0; i < n * n * n; ++i) {
    const Grain& a = s.grains[static_cast<std::size_t>(i)];
    const auto add = [&](std::int64_t j, const Vec3& from_j) {
      Contact c;
      c.i = i;
      c.j = j;
      c.force = (1 + random.uniform()) * from_j +
                0.2 * Vec3(random.uniform(), random.uniform(), random.uniform());
      s.contacts.push_back(c);
    };
    for (std::int64_t w = 0; w < 3; ++w) {
      const dem::Wall& wall = s.walls[static_cast<std::size_t>(w)];
      if ((a.position - wall.point).dot(wall.normal) < a.radius) add(-1 - w, wall.normal);
    }
    for (std::int64_t j = i + 1; j < n * n * n; ++j) {
      const Grain& b = s.grains[static_cast<std::size_t>(j)];
      const Vec3 branch = b.position - a.position;
      if (branch.norm() < a.radius + b.radius) add(j, -branch.normalized());
    }
  }
  std::sort(s.contacts.begin(), s.contacts.end(), [](const Contact& a, const Contact& b) {
    return std::pair(a.i, a.j) < std::pair(b.i, b.j);
  });
  return s;
}

Motion motion_of(const std::string& name, Snapshot s) {
  s.gravity = {0, s.dim == 2 ? -9.81 : 0, s.dim == 2 ? 0 : -9.81};
  for (Contact& c : s.contacts)  // all push
    if (c.j >= 0) {
      complete(s);
      break;
    }
  Motion out{name, s, s};
  dem::Random random(11);
  const bool periodic = s.cell.is_periodic();
  for (Grain& g : out.after.grains) {
    if (periodic) g.position += s.cell.edges * Vec3(0.7, 0.6, s.cell.periodic[2] ? -1.2 : 0);
    for (Eigen::Index a = 0; a < s.dim; ++a)
      g.position[a] += 1e-5 * (random.uniform() - (a + 1 == s.dim ? 0.5 : 0.5));
  }
  complete(out.before);
  complete(out.after);
  return out;
}

bool has_polygons(const Snapshot& s) {
  return std::any_of(s.grains.begin(), s.grains.end(),
                     [](const Grain& g) { return !g.outline.empty(); });
}

}  // namespace

std::vector<Motion> motions() {
  std::vector<Motion> out;
  out.push_back(motion_of("disks", overlapping_layer(1)));
  Snapshot polygons = overlapping_layer(2);
  for (std::size_t k = 0; k < polygons.grains.size(); k += 3) {
    Grain& g = polygons.grains[k];
    for (int corner = 0; corner < 6; ++corner)
      g.outline.push_back(
          {g.radius * std::cos(corner * M_PI / 3), g.radius * std::sin(corner * M_PI / 3)});
  }
  out.push_back(motion_of("polygons", polygons));
  out.push_back(motion_of("spheres", box_of_spheres(3)));
  out.push_back(motion_of("tilted disks", periodic_packing(2, 4)));
  out.push_back(motion_of("tilted spheres", periodic_packing(3, 5)));
  Snapshot straight = periodic_packing(2, 6);
  straight.contacts.clear();
  straight.cell.edges(0, 1) = 0;
  dem::Random random(7);
  for (std::size_t i = 0; i < straight.grains.size(); ++i) {
    Grain& g = straight.grains[i];
    g.position = dem::wrapped(straight.cell, g.position);
  }
  for (std::size_t i = 0; i < straight.grains.size(); ++i)
    for (std::size_t j = i + 1; j < straight.grains.size(); ++j) {
      Contact c;
      c.i = static_cast<std::int64_t>(i);
      c.j = static_cast<std::int64_t>(j);
      c.image = dem::nearest_image(straight.cell,
                                   straight.grains[j].position - straight.grains[i].position);
      const Vec3 branch = dem::second_place(straight, c) - straight.grains[i].position;
      if (branch.norm() > straight.grains[i].radius + straight.grains[j].radius) continue;
      c.force = -(1 + random.uniform()) * branch.normalized();
      straight.contacts.push_back(c);
    }
  out.push_back(motion_of("straight disks", straight));
  return out;
}

const std::vector<Dialect>& dialects() {
  static const std::vector<Dialect> all{
      Dialect::csv,      Dialect::semicolons, Dialect::tabs,    Dialect::numpy, Dialect::lammps,
      Dialect::liggghts, Dialect::yade,       Dialect::mercury, Dialect::vtk,   Dialect::vtp};
  return all;
}

std::string name_of(Dialect dialect) {
  static const char* const names[] = {"csv",      "semicolons", "tabs",    "numpy", "lammps",
                                      "liggghts", "yade",       "mercury", "vtk",   "vtp"};
  return names[static_cast<int>(dialect)];
}

const std::vector<Habit>& habits() {
  static const std::vector<Habit> all = [] {
    std::vector<Habit> out;
    for (int k = 0; k <= static_cast<int>(Habit::flipped); ++k) out.push_back(Habit(k));
    return out;
  }();
  return all;
}

std::string name_of(Habit habit) {
  static const char* const names[] = {"plain",
                                      "crlf",
                                      "carriage returns",
                                      "byte order mark",
                                      "utf16",
                                      "blank lines",
                                      "shuffled",
                                      "quoted",
                                      "titled",
                                      "unit row",
                                      "trailing",
                                      "comments",
                                      "ids beyond million",
                                      "ids beyond 40 bits",
                                      "step twice",
                                      "both directions",
                                      "no force pairs",
                                      "unwrapped",
                                      "scaled",
                                      "image flags",
                                      "units",
                                      "gzip",
                                      "bzip2",
                                      "xz",
                                      "zstd",
                                      "six digits",
                                      "rounded ids",
                                      "wall first",
                                      "other names",
                                      "flipped"};
  return names[static_cast<int>(habit)];
}

namespace {

bool is_dump(Dialect d) { return d == Dialect::lammps || d == Dialect::liggghts; }
bool is_table(Dialect d) { return d <= Dialect::numpy; }
bool is_vtk(Dialect d) { return d == Dialect::vtk || d == Dialect::vtp; }

}  // namespace

bool exists(Dialect d, Habit h, const Motion& m) {
  const bool periodic = m.before.cell.is_periodic();
  const bool tilted = periodic && !m.before.cell.edges.isDiagonal(0);
  const bool polygons = has_polygons(m.before);
  if (polygons && !(d == Dialect::csv || d == Dialect::tabs || d == Dialect::semicolons))
    return false;
  // A cell that is tilted stands in dumps alone.
  if (tilted && !is_dump(d)) return false;
  if (d == Dialect::liggghts && tilted) return false;
  switch (h) {
    case Habit::utf16:
    case Habit::carriage_returns:
    case Habit::gzip:
    case Habit::bzip2:
    case Habit::xz:
    case Habit::zstd:
    case Habit::byte_order_mark:
      return !is_vtk(d);
    case Habit::blank_lines:
    case Habit::crlf:
      return d != Dialect::vtp;
    case Habit::shuffled:
      return d != Dialect::mercury;
    case Habit::quoted:
      return d == Dialect::csv || d == Dialect::semicolons || d == Dialect::tabs;
    case Habit::titled:
    case Habit::trailing:
    case Habit::unit_row:
      return d == Dialect::csv || d == Dialect::semicolons || d == Dialect::tabs;
    case Habit::comments:
      return is_table(d) || d == Dialect::yade;
    case Habit::ids_beyond_million:
    case Habit::ids_beyond_40_bits:
      return d != Dialect::mercury;
    case Habit::rounded_ids:
      return is_dump(d) || d == Dialect::csv;
    case Habit::step_twice:
      return is_dump(d);
    case Habit::unwrapped:
      return periodic && d != Dialect::mercury;
    case Habit::image_flags:
      return periodic && d != Dialect::mercury;
    case Habit::scaled:
      return is_dump(d);
    case Habit::wall_first:
      return !m.before.walls.empty() && !is_dump(d) && d != Dialect::mercury;
    case Habit::other_names:
      return is_table(d) || is_vtk(d);
    case Habit::units:
      return d != Dialect::mercury && !polygons;
    case Habit::six_digits:
      return !polygons;
    case Habit::both_directions:
      return d != Dialect::mercury;  // always so there
    default:
      return true;
  }
}

namespace {

struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;

  void rename(const std::string& from, const std::string& to) {
    for (std::string& name : names)
      if (name == from) name = to;
  }
};

class Writer {
 public:
  Writer(Dialect d, Habit h, const Motion& m, bool after)
      : d_(d), h_(h), s_(after ? m.after : m.before), space_(s_.dim == 3) {
    if (h == Habit::ids_beyond_million) shift_ = 3'000'000;
    if (h == Habit::ids_beyond_40_bits) shift_ = 1LL << 40;
    if (h == Habit::rounded_ids) shift_ = 3'000'000;
    periodic_ = s_.cell.is_periodic();
    keeps_images_ = h == Habit::unwrapped;
    flags_ = h == Habit::image_flags;
    // Without either the places are in the cell, and nobody knows the images.
    for (const Grain& g : s_.grains) {
      const bool carried = !keeps_images_ && periodic_;
      places_.push_back(carried ? dem::wrapped(s_.cell, g.position) : g.position);
    }
    if (h == Habit::units) {
      length_ = is_dump(d) ? 100 : 1000;
      if (is_dump(d)) {
        mass_ = 1000;
        force_ = 1e5;
      }
    }
  }

  Written write() {
    auto& o = out_.options;
    o.dim = s_.dim;
    o.gravity = s_.gravity;
    if (h_ == Habit::flipped) o.flip_forces = true;
    if (h_ == Habit::units && !is_dump(d_) && d_ != Dialect::csv) o.units = "mm";
    if (periodic_ && !is_dump(d_))
      for (int a = 0; a < s_.dim; ++a)
        o.periodic.push_back({a, s_.cell.low[a], s_.cell.low[a] + s_.cell.edges(a, a), false});
    if (is_table(d_)) tables();
    if (is_dump(d_)) dumps();
    if (d_ == Dialect::yade) yade();
    if (d_ == Dialect::mercury) mercury();
    if (is_vtk(d_)) vtk();
    return std::move(out_);
  }

 private:
  std::string num(double value) const {
    if (h_ == Habit::six_digits) return fmt::format("{:.6g}", value);
    std::string text = fmt::format("{:.17g}", value);
    if (d_ == Dialect::semicolons) std::replace(text.begin(), text.end(), '.', ',');
    return text;
  }
  std::string id(std::size_t g) const { return fmt::format("{}", id_of(g)); }
  std::int64_t id_of(std::size_t g) const {
    // Seven digits of which six tell them apart.
    return s_.grains[g].id * (h_ == Habit::rounded_ids ? 10 : 1) + shift_;
  }
  // In contacts.
  std::string told_id(std::int64_t g) const {
    const std::int64_t value = id_of(static_cast<std::size_t>(g));
    if (h_ == Habit::rounded_ids) return fmt::format("{:g}", static_cast<double>(value));
    if (d_ == Dialect::numpy && h_ != Habit::ids_beyond_40_bits)
      return fmt::format("{:.18e}", static_cast<double>(value));
    return fmt::format("{}", value);
  }

  // Rows of contacts: grain or wall, and what acts on the first; every other pair the other way
  // round, or both ways, and those of no force.
  struct Pair {
    std::int64_t i = 0, j = 0;
    Vec3 force, normal, point;
    double overlap = 0;
  };
  std::vector<Pair> pairs(bool both) const {
    std::vector<Pair> out;
    const double sign = h_ == Habit::flipped ? -1 : 1;
    int n = 0;
    for (const Contact& c : s_.contacts) {
      // The point beside the place of i that stands in the file.
      const auto i = static_cast<std::size_t>(c.i);
      const Vec3 moved = places_[i] - s_.grains[i].position;
      const Pair one{c.i, c.j, sign * c.force, c.normal, c.point + moved, 0};
      Pair other{c.j, c.i, -one.force, -one.normal, one.point, 0};
      if (c.j >= 0) {
        const auto j = static_cast<std::size_t>(c.j);
        other.point = c.point + places_[j] - dem::second_place(s_, c);
      }
      const bool turn = c.j >= 0 ? n++ % 2 == 1 : h_ == Habit::wall_first;
      out.push_back(turn ? other : one);
      if (both && c.j >= 0) out.push_back(turn ? one : other);
    }
    if (h_ == Habit::no_force_pairs && !has_polygons(s_)) add_distant(out);
    return out;
  }
  // Pairs within a cutoff, of no force.
  void add_distant(std::vector<Pair>& out) const {
    for (std::size_t i = 0; i < s_.grains.size(); ++i)
      for (std::size_t j = i + 1; j < s_.grains.size(); ++j) {
        const Grain &a = s_.grains[i], &b = s_.grains[j];
        const Vec3 branch = b.position - a.position;
        const Vec3 way = branch + dem::shift_to(s_.cell, dem::nearest_image(s_.cell, branch));
        const double gap = way.norm() - a.radius - b.radius;
        if (!(gap > 1e-5 && gap < 0.5 * a.radius)) continue;
        out.push_back({static_cast<std::int64_t>(i), static_cast<std::int64_t>(j), Vec3::Zero(),
                       way.normalized(), places_[i] + 0.5 * way, 0});
      }
  }
  bool both() const { return h_ == Habit::both_directions; }

  std::string wall_name(std::int64_t j) const {
    return s_.walls[static_cast<std::size_t>(-1 - j)].name;
  }
  // --wall for planes across an axis.
  void options_of_walls(long first_id, int step, const std::string& fix = "") {
    for (std::size_t w = 0; w < s_.walls.size(); ++w) {
      const dem::Wall& wall = s_.walls[w];
      coupling::WallChoice choice;
      choice.name = wall.name;
      wall.normal.cwiseAbs().maxCoeff(&choice.axis);
      choice.position = wall.point[choice.axis];
      choice.ids = {fmt::format("{}", first_id + step * static_cast<long>(w))};
      if (!fix.empty()) choice.fix = fix + wall.name;
      out_.options.walls.push_back(choice);
    }
  }

  std::vector<std::string> axes(const std::string& stem) const {
    std::vector<std::string> out{stem + "x", stem + "y"};
    if (space_ || is_dump(d_)) out.push_back(stem + "z");
    return out;
  }
  void put(Table& t, const std::vector<std::string>& names) const {
    t.names.insert(t.names.end(), names.begin(), names.end());
  }
  void put(std::vector<std::string>& row, const Vec3& v, double factor) const {
    for (Eigen::Index a = 0; a < (space_ || is_dump(d_) ? 3 : 2); ++a)
      row.push_back(num(factor * v[a]));
  }

  Table grains() const {
    Table t;
    put(t, {"id"});
    const bool scaled = h_ == Habit::scaled;
    for (const std::string& axis : axes(""))
      t.names.push_back(axis + (scaled ? "s" : keeps_images_ ? "u" : ""));
    if (flags_) put(t, axes("i"));
    put(t, {"radius", "mass"});
    const bool outlines = has_polygons(s_);
    if (outlines) put(t, {"outline"});
    for (std::size_t g = 0; g < s_.grains.size(); ++g) {
      std::vector<std::string> row{id(g)};
      Vec3 place = places_[g];
      if (scaled) place = box().edges.inverse() * (place - box().low);
      put(row, place, scaled ? 1 : length_);
      if (flags_) {
        const auto away = dem::edges_away(s_.cell, s_.grains[g].position);
        for (std::size_t a = 0; a < (space_ || is_dump(d_) ? 3u : 2u); ++a)
          row.push_back(fmt::format("{}", s_.cell.periodic[a] ? away[a] : 0));
      }
      const Grain& grain = s_.grains[g];
      row.push_back(outlines && !grain.outline.empty() ? "" : num(length_ * grain.radius));
      row.push_back(num(mass_ * grain.mass));
      if (outlines) {
        std::string text = outline_text(grain.outline);
        if (d_ == Dialect::semicolons && !text.empty()) text = "\"" + text + "\"";
        row.push_back(text);
      }
      t.rows.push_back(row);
    }
    return t;
  }

  Table contacts(bool points) const {
    Table t;
    put(t, {"i", "j"});
    put(t, axes("f"));
    if (points) {
      put(t, axes("p"));
      put(t, axes("n"));
    }
    for (const Pair& p : pairs(both())) {
      const auto body = [&](std::int64_t k) { return k < 0 ? wall_body(k) : told_id(k); };
      std::vector<std::string> row{body(p.i), body(p.j)};
      put(row, p.force, force_);
      if (points) {
        put(row, p.point, length_);
        put(row, p.normal, 1);
      }
      t.rows.push_back(row);
    }
    return t;
  }
  std::string wall_body(std::int64_t k) const {
    if (is_table(d_)) return wall_name(k);
    if (is_vtk(d_)) return fmt::format("{}", k);
    return fmt::format("{}", 900'000'000 - 1 - k);
  }

  // Columns in another order.
  void shuffle(Table& t) const {
    if (h_ != Habit::shuffled) return;
    const auto turn = [](std::vector<std::string>& row) {
      std::rotate(row.begin(), row.begin() + 2, row.end());
    };
    turn(t.names);
    for (auto& row : t.rows) turn(row);
  }

  std::string text_of(Table t, const std::string& first) const {
    shuffle(t);
    if (h_ == Habit::other_names)
      for (const auto& [from, to] :
           std::vector<std::pair<std::string, std::string>>{{"id", "Particle ID"},
                                                            {"x", "Pos-X"},
                                                            {"y", "pos_y"},
                                                            {"z", "PosZ"},
                                                            {"radius", "Rad"},
                                                            {"mass", "Mass"},
                                                            {"i", "end1"},
                                                            {"j", "end2"},
                                                            {"fx", "force_x"},
                                                            {"fy", "force_y"},
                                                            {"fz", "force_z"}})
        if (d_ != Dialect::numpy || to.find(' ') == std::string::npos) t.rename(from, to);
    const char separator = d_ == Dialect::semicolons ? ';'
                           : d_ == Dialect::tabs     ? '\t'
                           : d_ == Dialect::csv      ? ','
                                                     : ' ';
    const auto joined = [&](const std::vector<std::string>& row) {
      std::string line;
      for (std::size_t k = 0; k < row.size(); ++k) {
        if (k > 0) line += separator;
        line += h_ == Habit::quoted && row[k].find('"') == std::string::npos ? "\"" + row[k] + "\""
                                                                             : row[k];
      }
      return line;
    };
    std::string out = first;
    if (h_ == Habit::titled) out += fmt::format("sep={}\nParticle data at t = 2 s\n\n", separator);
    if (h_ == Habit::comments) out += "# made by a test, 2 s\n#\n";
    if (h_ == Habit::units && d_ == Dialect::csv)
      for (std::string& name : t.names) name += unit_of(name);
    if (h_ == Habit::quoted) {
      t.names.push_back("note");
      for (auto& row : t.rows)
        row.push_back("\"sand, \"\"fine\"\"" + std::string(1, separator) + "\"");
    }
    const std::string end = h_ == Habit::trailing ? std::string(2, separator) : "";
    out += (d_ == Dialect::numpy ? "# " : "") + joined(t.names) + end + "\n";
    if (h_ == Habit::unit_row) {
      std::vector<std::string> units;
      for (const std::string& name : t.names) {
        const std::string unit = unit_of(name);
        units.push_back(unit.empty() ? "-" : name == "outline" ? "m" : in_si(unit));
      }
      out += joined(units) + "\n";
    }
    for (std::size_t k = 0; k < t.rows.size(); ++k) {
      out += joined(t.rows[k]) + (k % 2 == 0 ? end : "") + "\n";
      if (h_ == Habit::blank_lines && k % 5 == 0) out += "\n";
      if (h_ == Habit::comments && k % 7 == 0) out += "# half\n";
    }
    if (h_ == Habit::blank_lines) out += "\n\n";
    return out;
  }
  static std::string unit_of(const std::string& name) {
    if (name == "x" || name == "y" || name == "z" || name == "radius" || name.front() == 'p' ||
        name == "xu" || name == "yu" || name == "zu")
      return " (mm)";
    return name == "mass" ? " (kg)" : name == "fx" || name == "fy" || name == "fz" ? " [N]" : "";
  }
  static std::string in_si(const std::string& unit) {
    return unit == " (mm)" ? "m" : unit == " (kg)" ? "kg" : "N";
  }

  void add(const std::string& name, std::string text) {
    if (h_ == Habit::crlf || h_ == Habit::carriage_returns) {
      std::string turned;
      for (const char ch : text)
        turned += ch == '\n' ? (h_ == Habit::crlf ? "\r\n" : "\r") : std::string(1, ch);
      text = turned;
    }
    if (h_ == Habit::byte_order_mark) text = "\xEF\xBB\xBF" + text;
    if (h_ == Habit::utf16) {
      std::string wide = "\xFF\xFE";
      for (const char ch : text) wide += std::string{ch, '\0'};
      text = wide;
    }
    if (h_ >= Habit::gzip && h_ <= Habit::zstd) text = packed(text);
    out_.files.emplace_back(name, text);
  }
  std::string packed(const std::string& text) const {
    std::stringstream out;
    // Two streams one after the other, as tools that pack in parts leave them.
    for (const std::string& part :
         {text.substr(0, text.size() / 2), text.substr(text.size() / 2)}) {
      boost::iostreams::filtering_ostream in;
      if (h_ == Habit::gzip) in.push(boost::iostreams::gzip_compressor());
      if (h_ == Habit::bzip2) in.push(boost::iostreams::bzip2_compressor());
      if (h_ == Habit::xz) in.push(boost::iostreams::lzma_compressor());
      if (h_ == Habit::zstd) in.push(boost::iostreams::zstd_compressor());
      in.push(out);
      in << part;
      in.reset();
    }
    return out.str();
  }

  void tables() {
    out_.options.format = "csv";
    add("grains.csv", text_of(grains(), ""));
    add("contacts.csv", text_of(contacts(h_ != Habit::other_names || has_polygons(s_)), ""));
    if (s_.walls.empty()) return;
    Table t;
    put(t, {"name"});
    put(t, axes(""));
    put(t, axes("n"));
    for (const dem::Wall& wall : s_.walls) {
      std::vector<std::string> row{wall.name};
      put(row, wall.point, length_);
      put(row, wall.normal, 1);
      t.rows.push_back(row);
    }
    if (h_ == Habit::other_names) {
      // The places of a wall have no names of other programs.
    }
    add("walls.csv", text_of(t, ""));
  }

  dem::Cell<3> box() const {
    dem::Cell<3> out = s_.cell;
    for (int a = 0; a < 3; ++a)
      if (!periodic_ || !s_.cell.periodic[static_cast<std::size_t>(a)]) {
        out.low[a] = -0.5;
        out.edges.col(a) = Vec3::Unit(a);
      }
    return out;
  }

  std::string dump(Table t, const std::string& kind, const std::string& item) const {
    shuffle(t);
    const dem::Cell<3> cell = box();
    const double xy = cell.edges(0, 1), xz = cell.edges(0, 2), yz = cell.edges(1, 2);
    const bool tilted = !cell.edges.isDiagonal(0);
    std::string bounds = "ITEM: BOX BOUNDS";
    if (tilted) bounds += " xy xz yz";
    for (std::size_t a = 0; a < 3; ++a)
      bounds += s_.cell.periodic[a] ? " pp" : a == 2 && !space_ ? " pp" : " ff";
    bounds += "\n";
    const double low[] = {std::min({0.0, xy, xz, xy + xz}), std::min(0.0, yz), 0};
    const double high[] = {std::max({0.0, xy, xz, xy + xz}), std::max(0.0, yz), 0};
    const double tilt[] = {xy, xz, yz};
    for (int a = 0; a < 3; ++a) {
      bounds += fmt::format("{:.17g} {:.17g}", length_ * (cell.low[a] + low[a]),
                            length_ * (cell.low[a] + cell.edges(a, a) + high[a]));
      bounds += tilted ? fmt::format(" {:.17g}\n", length_ * tilt[a]) : "\n";
    }
    std::string out;
    if (h_ == Habit::units) out += "ITEM: UNITS\ncgs\n";
    const std::string step = "ITEM: TIMESTEP\n2000\n", time = "ITEM: TIME\n0.5\n";
    // LAMMPS writes the time first.
    out += h_ == Habit::plain ? step : h_ == Habit::shuffled ? step + time : time + step;
    out += fmt::format("ITEM: NUMBER OF {}\n{}\n", kind, t.rows.size()) + bounds;
    out += fmt::format("ITEM: {} {} \n", item, fmt::join(t.names, " "));
    for (std::size_t k = 0; k < t.rows.size(); ++k) {
      out += fmt::format("{} \n", fmt::join(t.rows[k], " "));
      if (h_ == Habit::blank_lines && k % 9 == 0) out += "\n";
    }
    if (h_ == Habit::blank_lines) out += "\n";
    return h_ == Habit::step_twice ? out + out : out;
  }

  void dumps() {
    const bool lammps = d_ == Dialect::lammps;
    out_.options.format = name_of(d_);
    Table g = grains(), c, w;
    if (lammps) {
      for (std::size_t k = 0; k < s_.walls.size(); ++k)
        for (int n = 1; n <= 7; ++n)
          g.names.push_back(fmt::format("f_{}[{}]", s_.walls[k].name, n));
      for (std::size_t k = 0; k < s_.grains.size(); ++k)
        for (std::size_t wall = 0; wall < s_.walls.size(); ++wall)
          add_wall_columns(k, wall, g.rows[k]);
      for (int n = 1; n <= 2; ++n) c.names.push_back(fmt::format("c_ids[{}]", n));
      for (int n = 1; n <= 6; ++n) c.names.push_back(fmt::format("c_p[{}]", n));
      out_.options.columns = {"i,j=c_ids[1..2]", "fnx,fny,fnz,ftx,fty,ftz=c_p[1..6]"};
      options_of_walls(0, 1, "f_");
    } else {
      for (int n = 1; n <= 6; ++n) c.names.push_back(fmt::format("c_fc[{}]", n));
      for (int n = 1; n <= 12; ++n) w.names.push_back(fmt::format("c_fw[{}]", n));
      out_.options.columns = {"i,j=c_fc[1..2]", "fx,fy,fz=c_fc[4..6]"};
      if (!s_.walls.empty())
        for (const char* more :
             {"px,py,pz=c_fw[1..3]", "wall=c_fw[7]", "i=c_fw[9]", "fx,fy,fz=c_fw[10..12]"})
          out_.options.columns.emplace_back(more);
      options_of_walls(0, 1);
    }
    for (const Pair& p : pairs(both())) {
      std::vector<std::string> row;
      if (p.j < 0) {
        put(row, p.point, length_);
        for (const char* none : {"0", "0", "0"}) row.emplace_back(none);
        row.push_back(fmt::format("{}", -1 - p.j));
        row.emplace_back("5");
        row.push_back(told_id(p.i));
        put(row, p.force, force_);
        w.rows.push_back(row);
        continue;
      }
      row = {told_id(p.i), told_id(p.j)};
      if (lammps) {
        const Vec3 normal = p.force.dot(p.normal) * p.normal;
        put(row, normal, force_);
        put(row, p.force - normal, force_);
      } else {
        row.emplace_back("0");
        put(row, p.force, force_);
      }
      c.rows.push_back(row);
    }
    add("grains.dump", dump(g, "ATOMS", "ATOMS"));
    add("contacts.dump", dump(c, "ENTRIES", "ENTRIES"));
    if (!lammps && !s_.walls.empty()) add("walls.dump", dump(w, "ENTRIES", "ENTRIES"));
  }
  void add_wall_columns(std::size_t grain, std::size_t wall, std::vector<std::string>& row) const {
    for (const Contact& c : s_.contacts) {
      if (c.i != static_cast<std::int64_t>(grain) || c.j != -1 - static_cast<std::int64_t>(wall))
        continue;
      row.emplace_back("1");
      put(row, (h_ == Habit::flipped ? -1 : 1) * c.force, force_);
      put(row, c.point, length_);
      return;
    }
    for (int n = 0; n < 7; ++n) row.emplace_back("0");
  }

  void yade() {
    out_.options.format = "yade";
    options_of_walls(900'000'000, 1);
    Table g = grains();
    g.rename("radius", "r");
    Table c = contacts(true);
    c.rename("i", "id1");
    c.rename("j", "id2");
    // Forces act on the second.
    for (auto& row : c.rows)
      for (std::size_t k = 2; k < 2 + static_cast<std::size_t>(s_.dim); ++k)
        row[k] = row[k].front() == '-' ? row[k].substr(1) : "-" + row[k];
    const auto text = [&](Table t, bool format) {
      shuffle(t);
      std::string out = format
                            ? fmt::format("#format {}\n# settled, t=2 s\n", fmt::join(t.names, "_"))
                            : fmt::format("# {}\n", fmt::join(t.names, " "));
      if (h_ == Habit::comments) out = "# made by a test\n" + out;
      for (std::size_t k = 0; k < t.rows.size(); ++k) {
        out += fmt::format("{}\n", fmt::join(t.rows[k], "\t"));
        if (h_ == Habit::blank_lines && k % 5 == 0) out += "\n";
      }
      return out;
    };
    add("bodies.txt", text(g, true));
    add("interactions.txt", text(c, false));
  }

  void mercury() {
    out_.options.format = "mercury";
    options_of_walls(-1, -1);
    out_.options.density = s_.grains[0].mass / s_.grains[0].volume;
    std::string data = space_ ? fmt::format("{} 0.5 0 0 0 1 1 1\n", s_.grains.size())
                              : fmt::format("{} 0.5 0 0 1 1\n", s_.grains.size());
    for (std::size_t g = 0; g < s_.grains.size(); ++g) {
      std::vector<std::string> row;
      put(row, places_[g], 1);
      for (int k = 0; k < s_.dim; ++k) row.emplace_back("0");
      row.push_back(num(s_.grains[g].radius));
      for (int k = 0; k < (space_ ? 7 : 3); ++k) row.emplace_back("0");
      data += fmt::format("{}\n", fmt::join(row, " "));
    }
    std::string fstat = "# 0.5 1\n# 0 0 0 1 1 1\n# 0 0 0 0 0 0\n";
    for (const Pair& p : pairs(true)) {
      // Of a pair the force is fn n + ft t and n points to i; of a wall both are turned.
      const double turned = p.j < 0 ? -1 : 1;
      const Vec3 normal = -p.normal;
      const double fn = p.force.dot(normal);
      const Vec3 across = p.force - fn * normal;
      const double ft = across.norm();
      const Vec3 tangent = ft > 0 ? Vec3(across / ft) : Vec3::Zero();
      std::vector<std::string> row{"0.5", fmt::format("{}", p.i), fmt::format("{}", p.j)};
      const auto three = [&](const Vec3& v, double factor) {
        for (Eigen::Index a = 0; a < 3; ++a) row.push_back(num(factor * v[a]));
      };
      three(p.point, 1);
      row.emplace_back("1e-6");
      row.emplace_back("0");
      row.push_back(num(fn));
      row.push_back(num(ft));
      three(normal, turned);
      three(tangent, turned);
      fstat += fmt::format("{}\n", fmt::join(row, " "));
    }
    if (h_ == Habit::blank_lines) data += "\n";
    add("box.data", data);
    add("box.fstat", fstat);
  }

  void vtk() {
    out_.options.format = "vtk";
    options_of_walls(-1, -1);
    add(d_ == Dialect::vtk ? "grains.vtk" : "grains.vtp", vtk_text(grains(), true));
    add(d_ == Dialect::vtk ? "forces.vtk" : "forces.vtp", vtk_text(contacts(true), false));
  }
  // Grains as points, contacts as lines from nowhere to nowhere with cell data.
  std::string vtk_text(Table t, bool grains) const {
    if (h_ == Habit::shuffled) std::reverse(t.names.begin(), t.names.end());
    for (auto& row : t.rows)
      if (h_ == Habit::shuffled) std::reverse(row.begin(), row.end());
    if (h_ == Habit::other_names) {
      t.rename("radius", "Radius");
      t.rename("id", "Particle_ID");
      t.rename("i", "id1");
      t.rename("j", "id2");
      t.rename("fx", "force_x");
      t.rename("fy", "force_y");
      t.rename("fz", "force_z");
    }
    const auto column = [&](const std::string& name) {
      return std::find(t.names.begin(), t.names.end(), name) - t.names.begin();
    };
    const bool placed = grains && column("x") < static_cast<std::ptrdiff_t>(t.names.size());
    std::string points, lines;
    const std::size_t n = t.rows.size(), count = grains ? n : 2 * n;
    for (std::size_t k = 0; k < count; ++k) {
      if (!placed) {
        points += "0 0 0\n";
        continue;
      }
      const auto& row = t.rows[k];
      points += row[static_cast<std::size_t>(column("x"))] + " " +
                row[static_cast<std::size_t>(column("y"))] + " " +
                (space_ ? row[static_cast<std::size_t>(column("z"))] : "0") + "\n";
    }
    const auto whole = [](const std::string& name) {
      return name == "id" || name == "i" || name == "j" || name == "id1" || name == "id2" ||
             name == "Particle_ID" || name == "ix" || name == "iy" || name == "iz";
    };
    const auto skipped = [&](const std::string& name) {
      return placed && (name == "x" || name == "y" || name == "z");
    };
    std::string arrays;
    int number = 0;
    for (std::size_t k = 0; k < t.names.size(); ++k) {
      if (skipped(t.names[k])) continue;
      ++number;
      std::string values;
      for (const auto& row : t.rows) values += row[k] + "\n";
      if (h_ == Habit::blank_lines) values += "\n";
      arrays += d_ == Dialect::vtk
                    ? fmt::format("{} 1 {} {}\n{}", t.names[k], n,
                                  whole(t.names[k]) ? "long" : "double", values)
                    : fmt::format(
                          "<DataArray type=\"{}\" Name=\"{}\" format=\"ascii\">\n{}"
                          "</DataArray>\n",
                          whole(t.names[k]) ? "Int64" : "Float64", t.names[k], values);
    }
    const char* data = grains ? "Point" : "Cell";
    if (d_ == Dialect::vtk) {
      std::string out = fmt::format(
          "# vtk DataFile Version 2.0\nGenerated by a test\nASCII\nDATASET POLYDATA\nPOINTS {} "
          "double\n{}",
          count, points);
      if (!grains) {
        out += fmt::format("LINES {} {}\n", n, 3 * n);
        for (std::size_t k = 0; k < n; ++k) out += fmt::format("2 {} {}\n", 2 * k, 2 * k + 1);
      }
      return out + fmt::format("{}_DATA {}\nFIELD FieldData {}\n{}", grains ? "POINT" : "CELL", n,
                               number, arrays);
    }
    std::string out = fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
        "byte_order=\"LittleEndian\">\n<PolyData>\n<Piece NumberOfPoints=\"{}\" "
        "NumberOfLines=\"{}\">\n"
        "<Points><DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" "
        "format=\"ascii\">\n{}</DataArray></Points>\n",
        count, grains ? 0 : n, points);
    return out +
           fmt::format("<{0}Data>\n{1}</{0}Data>\n</Piece></PolyData></VTKFile>\n", data, arrays);
  }

  Dialect d_;
  Habit h_;
  const Snapshot& s_;
  bool space_, periodic_ = false, keeps_images_ = false, flags_ = false;
  std::int64_t shift_ = 0;
  double length_ = 1, mass_ = 1, force_ = 1;
  std::vector<Vec3> places_;
  Written out_;
};

}  // namespace

Written write_as(Dialect dialect, Habit habit, const Motion& motion, bool after) {
  return Writer(dialect, habit, motion, after).write();
}

}  // namespace grainfield::test
