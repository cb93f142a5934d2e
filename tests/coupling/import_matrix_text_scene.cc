// Texts of YADE and MercuryDPM.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dem/snapshot/images.h"
#include "import_matrix_rows.h"
#include "import_scene.h"

namespace grainfield::test {
namespace {

using dem::Contact;
using dem::Grain;
using dem::Vec3;

class Yade : public MatrixRows {
 public:
  using MatrixRows::MatrixRows;
  Written write() {
    yade();
    return std::move(out_);
  }

 private:
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
};

class Mercury : public MatrixRows {
 public:
  using MatrixRows::MatrixRows;
  Written write() {
    mercury();
    return std::move(out_);
  }

 private:
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
    std::size_t copies = s_.grains.size();
    std::string fstat = "# 0.5 1\n# 0 0 0 1 1 1\n# 0 0 0 0 0 0\n";
    for (const Pair& p : pairs(true)) {
      // The force of a pair is fn n + ft t and n points to i; of a wall both are turned.
      const double turned = p.j < 0 ? -1 : 1;
      const Vec3 normal = -p.normal;
      const double fn = p.force.dot(normal);
      const Vec3 across = p.force - fn * normal;
      const double ft = across.norm();
      const Vec3 tangent = ft > 0 ? Vec3(across / ft) : Vec3::Zero();
      double overlap = 1e-6;
      std::string second = fmt::format("{}", p.j);
      // A grain across a side has a copy with a number of its own; the overlap tells its centre.
      if (h_ == Habit::copies && p.j >= 0) {
        const Grain &a = s_.grains[static_cast<std::size_t>(p.i)],
                    &b = s_.grains[static_cast<std::size_t>(p.j)];
        const Vec3 &there = places_[static_cast<std::size_t>(p.j)],
                   from = there - places_[static_cast<std::size_t>(p.i)];
        if (from.norm() > a.radius + b.radius) {
          const Vec3 way = there - p.point;
          const Vec3 near = way + dem::shift_to(s_.cell, dem::nearest_image(s_.cell, way));
          overlap = 2 * (b.radius - near.norm());
          second = fmt::format("{}", copies++);
        }
      }
      std::vector<std::string> row{"0.5", fmt::format("{}", p.i), second};
      const auto three = [&](const Vec3& v, double factor) {
        for (Eigen::Index a = 0; a < 3; ++a) row.push_back(num(factor * v[a]));
      };
      three(p.point, 1);
      row.push_back(num(overlap));
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
};

}  // namespace

Written write_yade(Dialect d, Habit h, const Motion& m, bool after) {
  return Yade(d, h, m, after).write();
}

Written write_mercury(Dialect d, Habit h, const Motion& m, bool after) {
  return Mercury(d, h, m, after).write();
}

}  // namespace grainfield::test
