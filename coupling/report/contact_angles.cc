#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/report/picture.h"
#include "coupling/report/style.h"

namespace grainfield::coupling {
namespace {

constexpr int bins = 36;  // of the polar histogram, 10 degrees each

}  // namespace

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
