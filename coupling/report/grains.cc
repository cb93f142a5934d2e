#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "coupling/averaging/extent.h"
#include "coupling/report/picture.h"
#include "coupling/report/style.h"

namespace grainfield::coupling {
namespace {

// Forces above this quantile are drawn as wide as it: else the one under the load dwarfs the rest.
constexpr double width_quantile = 0.99;
constexpr double widest = 9;              // pixels
constexpr double least_share = 0.02;      // of the widest: thinner lines are not drawn
constexpr std::size_t most_in_svg = 200;  // grains; beyond, a bitmap is smaller
constexpr int bins = 36;                  // of the polar histogram, 10 degrees each

struct Line {
  Eigen::Vector2d from, to;
  double force;
};

std::vector<Line> force_lines(const dem::Snapshot& snapshot, const dem::Snapshot* reference) {
  std::map<std::pair<std::int64_t, std::int64_t>, double> before;
  if (reference)
    for (const dem::Contact& c : reference->contacts) before[{c.i, c.j}] = c.normal_force;
  std::vector<Line> lines;
  const auto at = [](const dem::Snapshot& s, std::int64_t g) -> Eigen::Vector2d {
    return s.grains[static_cast<std::size_t>(g)].position.head<2>();
  };
  const auto end = [&](const dem::Snapshot& s, const dem::Contact& c) -> Eigen::Vector2d {
    return c.j >= 0 ? at(s, c.j) : Eigen::Vector2d(c.point.head<2>());
  };
  for (const dem::Contact& c : snapshot.contacts) {
    double force = c.normal_force;
    const auto old = before.find({c.i, c.j});
    if (old != before.end()) {
      force -= old->second;
      before.erase(old);
    }
    lines.push_back({at(snapshot, c.i), end(snapshot, c), force});
  }
  if (reference)  // contacts that were lost
    for (const dem::Contact& c : reference->contacts)
      if (before.count({c.i, c.j}))
        lines.push_back({at(*reference, c.i), end(*reference, c), -c.normal_force});
  return lines;
}

double force_scale(const std::vector<Line>& lines) {
  std::vector<double> sizes;
  for (const Line& line : lines)
    if (line.force != 0) sizes.push_back(std::abs(line.force));
  if (sizes.empty()) return 1;
  const auto k =
      static_cast<std::ptrdiff_t>(width_quantile * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), sizes.begin() + k, sizes.end());
  return sizes[static_cast<std::size_t>(k)];
}

}  // namespace

Picture packing(const std::string& title, const dem::Snapshot& snapshot,
                const dem::Snapshot* reference) {
  Picture picture;
  picture.title = title;
  picture.bitmap = snapshot.grains.size() > most_in_svg;
  std::string& p = picture.program;
  double left = 0, right = 1, bottom = 0, top = 1;
  bool first = true;
  p += "$grains << EOD\n";
  for (const dem::Grain& g : snapshot.grains) {
    left = first ? left_of(g) : std::min(left, left_of(g));
    right = first ? right_of(g) : std::max(right, right_of(g));
    bottom = first ? bottom_of(g) : std::min(bottom, bottom_of(g));
    top = first ? top_of(g) : std::max(top, top_of(g));
    first = false;
    p += fmt::format("{:.6g} {:.6g} {:.6g} {}\n", g.position.x(), g.position.y(), g.radius,
                     g.fixed ? "0x9a9a9a" : "0xe9e4d8");
  }
  p += "EOD\n";
  const std::vector<Line> lines = force_lines(snapshot, reference);
  const double scale = force_scale(lines);
  p += "$lines << EOD\n";
  for (const Line& line : lines) {
    const double share = std::min(1.0, std::abs(line.force) / scale);
    if (share < least_share) continue;
    const char* colour = !reference ? "0x7a1f1f" : line.force > 0 ? "0xb2182b" : "0x2166ac";
    // A vector of width share; one line per vector, its width a column.
    p += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} {:.3f} {}\n", line.from.x(), line.from.y(),
                     line.to.x() - line.from.x(), line.to.y() - line.from.y(), share, colour);
  }
  p += "EOD\n";
  const double margin = 0.01 * (right - left);
  picture.width = 980;
  const double aspect = (top - bottom + 2 * margin) / (right - left + 2 * margin);
  const bool arrow = snapshot.loaded_grain >= 0;
  const int above = arrow ? 66 : 24, below = 80, side = 96;
  const int plot_width = picture.width - side - 20;
  picture.height = static_cast<int>(plot_width * aspect) + above + below;
  p += fmt::format(
      "set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\nset bmargin at screen {:.4f}\n"
      "set tmargin at screen {:.4f}\nset xrange [{}:{}]\nset yrange [{}:{}]\n"
      "set border 3 lw 1 lc rgb '#444444'\nset tics out nomirror\nunset key\n"
      "set xlabel 'x (m)'\nset ylabel 'y (m)' offset 1,0\nset style fill solid 1 border rgb "
      "'#b9b2a0'\n",
      static_cast<double>(side) / picture.width, 1 - 20.0 / picture.width,
      static_cast<double>(below) / picture.height, 1 - static_cast<double>(above) / picture.height,
      left - margin, right + margin, bottom - margin, top + margin);
  if (arrow)
    for (const dem::Grain& g : snapshot.grains)
      if (g.id == snapshot.loaded_grain) {
        p += fmt::format(
            "set arrow 1 from first {0:.6g}, graph {1:.4f} to first {0:.6g}, first {2:.6g} lw 3 lc "
            "rgb '#000000' head size screen 0.012,22 filled front\n",
            g.position.x(), 1 + 46.0 / (picture.height - above - below), top_of(g));
        p += fmt::format("set label 1 {} at first {:.6g}, graph {:.4f} left offset 1,0 front\n",
                         style::quoted(fmt::format("F = {:.4g} N", snapshot.applied_force.norm())),
                         g.position.x(), 1 + 34.0 / (picture.height - above - below));
      }
  p += "plot $grains using 1:2:3:4 with circles fc rgb variable lw 0.5";
  // gnuplot takes one width per plot: forces go into classes of equal width.
  constexpr int classes = 12;
  for (int k = 0; k < classes; ++k)
    p += fmt::format(
        ", $lines using ($5>{0:.4f}&&$5<={1:.4f}?$1:NaN):2:3:4:6 with vectors nohead lw {2:.2f} lc "
        "rgb variable",
        static_cast<double>(k) / classes, (k + 1.0) / classes, widest * (k + 0.5) / classes);
  p += "\n";
  picture.caption =
      reference ? fmt::format(
                      "Change of the normal forces by the load: red grows, blue shrinks; the "
                      "widest lines stand for {:.3g} N and more.",
                      scale)
                : fmt::format(
                      "Normal forces as lines between centres; the widest stand for {:.3g} N and "
                      "more.",
                      scale);
  return picture;
}

Picture contact_angles(const std::string& title, const dem::Snapshot& snapshot) {
  Picture picture;
  picture.title = title;
  picture.width = 820;
  picture.height = 430;
  std::vector<double> count(bins, 0), force(bins, 0);
  double contacts = 0, forces = 0;
  const auto fixed = [&](std::int64_t g) {
    return snapshot.grains[static_cast<std::size_t>(g)].fixed;
  };
  for (const dem::Contact& c : snapshot.contacts) {
    if (c.j < 0 || fixed(c.i) || fixed(c.j)) continue;
    const double angle = std::atan2(c.normal.y(), c.normal.x());
    for (int side = 0; side < 2; ++side) {  // a contact points both ways
      const double turned = std::fmod(angle + (side + 2) * std::numbers::pi, 2 * std::numbers::pi);
      const auto bin = static_cast<std::size_t>(
          std::min<double>(bins - 1, std::floor(turned / (2 * std::numbers::pi) * bins)));
      count[bin] += 1;
      force[bin] += c.normal_force;
    }
    contacts += 2;
    forces += 2 * c.normal_force;
  }
  std::string& p = picture.program;
  double largest = 0;
  // Densities over the angle, relative to the isotropic one: 1 everywhere means no direction.
  for (int b = 0; b < bins; ++b) {
    const auto k = static_cast<std::size_t>(b);
    count[k] *= contacts > 0 ? bins / contacts : 0;
    force[k] *= forces > 0 ? bins / forces : 0;
    largest = std::max({largest, count[k], force[k]});
  }
  const double edge = largest > 0 ? 1.08 * largest : 1;
  for (const auto& [name, values] : {std::pair{"count", count}, std::pair{"force", force}}) {
    p += fmt::format("${} << EOD\n", name);
    for (int b = 0; b < bins; ++b) {
      const double r = values[static_cast<std::size_t>(b)];
      // A sector, as a polygon: centre, arc, centre.
      p += "0 0\n";
      for (int s = 0; s <= 4; ++s) {
        const double a = 2 * std::numbers::pi * (b + s / 4.0) / bins;
        p += fmt::format("{:.5g} {:.5g}\n", r * std::cos(a), r * std::sin(a));
      }
      p += "0 0\n\n";
    }
    p += "EOD\n";
  }
  p += fmt::format(
      "set parametric\nset trange [0:2*pi]\nset samples 181\nset xrange [{0}:{1}]\nset yrange "
      "[{0}:{1}]\nset size ratio -1\nunset border\nunset tics\nunset key\nset multiplot layout "
      "1,2\n",
      -1.25 * edge, 1.25 * edge);
  std::string labels;
  for (int degrees = 0; degrees < 360; degrees += 45) {
    const double a = degrees * std::numbers::pi / 180;
    labels += fmt::format("set label {} '{}°' at {:.5g},{:.5g} center tc rgb '#555555'\n",
                          degrees / 45 + 1, degrees, 1.14 * edge * std::cos(a),
                          1.14 * edge * std::sin(a));
  }
  p += labels;
  const auto frame = [&](const char* name, const char* heading, const char* colour) {
    p += fmt::format(
        "set title '{0}' offset 0,-0.5\n"
        "plot ${1} using 1:2 with filledcurves closed fc rgb '{2}' fs solid 0.75 border "
        "lc rgb '#ffffff', cos(t),sin(t) with lines dt 2 lw 1.4 lc rgb '#222222', "
        "{3}*cos(t),{3}*sin(t) with lines lw 0.6 lc rgb '#bbbbbb'\n",
        heading, name, colour, edge);
  };
  frame("count", "number of contacts", "#0072b2");
  frame("force", "normal force", "#b2182b");
  p += "unset multiplot\n";
  picture.caption =
      "Distribution over the direction of the contact normal, relative to an isotropic packing "
      "(the "
      "dashed circle); contacts between free grains.";
  return picture;
}

}  // namespace grainfield::coupling
