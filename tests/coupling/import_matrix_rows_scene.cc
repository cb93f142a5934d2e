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

#include "dem/snapshot/cell_places.h"
#include "dem/snapshot/images.h"
#include "import_matrix_rows.h"
#include "import_scene.h"

namespace grainfield::test {

using dem::Contact;
using dem::Grain;
using dem::Vec3;

MatrixRows::MatrixRows(Dialect d, Habit h, const Motion& m, bool after)
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
  auto& o = out_.options;
  o.dim = s_.dim;
  o.gravity = s_.gravity;
  if (h_ == Habit::flipped) o.flip_forces = true;
  if (h_ == Habit::units && !is_dump(d_) && d_ != Dialect::csv) o.units = "mm";
  if (periodic_ && !is_dump(d_))
    for (int a = 0; a < s_.dim; ++a)
      o.periodic.push_back({a, s_.cell.low[a], s_.cell.low[a] + s_.cell.edges(a, a), false});
}

std::string MatrixRows::num(double value) const {
  if (h_ == Habit::six_digits) return fmt::format("{:.6g}", value);
  std::string text = fmt::format("{:.17g}", value);
  if (d_ == Dialect::semicolons) std::replace(text.begin(), text.end(), '.', ',');
  return text;
}

std::string MatrixRows::id(std::size_t g) const { return fmt::format("{}", id_of(g)); }
std::int64_t MatrixRows::id_of(std::size_t g) const {
  // Seven digits of which six tell them apart.
  return s_.grains[g].id * (h_ == Habit::rounded_ids ? 10 : 1) + shift_;
}

std::string MatrixRows::told_id(std::int64_t g) const {
  const std::int64_t value = id_of(static_cast<std::size_t>(g));
  if (h_ == Habit::rounded_ids) return fmt::format("{:g}", static_cast<double>(value));
  if (d_ == Dialect::numpy && h_ != Habit::ids_beyond_40_bits)
    return fmt::format("{:.18e}", static_cast<double>(value));
  return fmt::format("{}", value);
}

std::vector<MatrixRows::Pair> MatrixRows::pairs(bool both) const {
  std::vector<Pair> out;
  const double sign = h_ == Habit::flipped ? -1 : 1;
  int n = 0;
  for (const Contact& c : s_.contacts) {
    // The point beside the place of i that stands in the file.
    const auto i = static_cast<std::size_t>(c.i);
    const Vec3 moved = places_[i] - s_.grains[i].position;
    const Pair one{c.i, c.j, sign * c.force, c.normal, c.point + moved};
    Pair other{c.j, c.i, -one.force, -one.normal, one.point};
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

void MatrixRows::add_distant(std::vector<Pair>& out) const {
  for (std::size_t i = 0; i < s_.grains.size(); ++i)
    for (std::size_t j = i + 1; j < s_.grains.size(); ++j) {
      const Grain &a = s_.grains[i], &b = s_.grains[j];
      const Vec3 branch = b.position - a.position;
      const Vec3 way = branch + dem::shift_to(s_.cell, dem::nearest_image(s_.cell, branch));
      const double gap = way.norm() - a.radius - b.radius;
      if (!(gap > 1e-5 && gap < 0.5 * a.radius)) continue;
      out.push_back({static_cast<std::int64_t>(i), static_cast<std::int64_t>(j), Vec3::Zero(),
                     way.normalized(), places_[i] + 0.5 * way});
    }
}

std::string MatrixRows::wall_name(std::int64_t j) const {
  return s_.walls[static_cast<std::size_t>(-1 - j)].name;
}

void MatrixRows::options_of_walls(long first_id, int step, const std::string& fix) {
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

std::vector<std::string> MatrixRows::axes(const std::string& stem) const {
  std::vector<std::string> out{stem + "x", stem + "y"};
  if (space_ || is_dump(d_)) out.push_back(stem + "z");
  return out;
}

void MatrixRows::put(Table& t, const std::vector<std::string>& names) const {
  t.names.insert(t.names.end(), names.begin(), names.end());
}

void MatrixRows::put(std::vector<std::string>& row, const Vec3& v, double factor) const {
  for (Eigen::Index a = 0; a < (space_ || is_dump(d_) ? 3 : 2); ++a)
    row.push_back(num(factor * v[a]));
}

Table MatrixRows::grains() const {
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

Table MatrixRows::contacts(bool points) const {
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

std::string MatrixRows::wall_body(std::int64_t k) const {
  if (is_table(d_)) return wall_name(k);
  if (is_vtk(d_)) return fmt::format("{}", k);
  return fmt::format("{}", 900'000'000 - 1 - k);
}

void MatrixRows::shuffle(Table& t) const {
  if (h_ != Habit::shuffled) return;
  const auto turn = [](std::vector<std::string>& row) {
    std::rotate(row.begin(), row.begin() + 2, row.end());
  };
  turn(t.names);
  for (auto& row : t.rows) turn(row);
}

dem::Cell<3> MatrixRows::box() const {
  dem::Cell<3> out = s_.cell;
  for (int a = 0; a < 3; ++a)
    if (!periodic_ || !s_.cell.periodic[static_cast<std::size_t>(a)]) {
      out.low[a] = -0.5;
      out.edges.col(a) = Vec3::Unit(a);
    }
  return out;
}

void MatrixRows::add(const std::string& name, std::string text) {
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

std::string MatrixRows::packed(const std::string& text) const {
  std::stringstream out;
  // Two streams one after the other, as tools that pack in parts leave them.
  for (const std::string& part : {text.substr(0, text.size() / 2), text.substr(text.size() / 2)}) {
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

}  // namespace grainfield::test
