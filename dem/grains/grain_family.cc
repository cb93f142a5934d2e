#include "dem/grains/grain_family.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/shapes/polygon.h"
#include "dem/shared/refuse.h"
#include "dem/space/elementary.h"

namespace grainfield::dem {
namespace {

// Neighbouring corners of a RAND1 polygon lie between these shares of the mean gap apart: no two
// corners at one place, no side that cuts half the grain away.
constexpr double kLeastGap = 0.6, kMostGap = 1.6;
// Corners of an irregular pentagon are turned by up to this share of the mean gap.
constexpr double kTurn = 0.25;
constexpr int kPentagon = 5;
// Triangles with gaps at their bounds are 3.5 times as long as wide; on an ellipse of this ratio
// none is a sliver for centred_outline, which refuses 20.
constexpr double kMostAxisRatio = 5;
constexpr double kMostPolydispersity = 0.99;
// The bound of an outline's farthest corner over the radius, and of its inverse.
constexpr double kMostStretch = 5;

// n gaps (radians, sum 2 pi) between independent uniform angles, given that each lies between
// kLeastGap and kMostGap mean gaps. Given the lower bound alone they are the least gap plus shares
// of the rest at uniform spacings (normalised exponentials); the upper bound is by rejection.
std::vector<double> draw_gaps(int n, Random& random) {
  std::vector<double> gaps(n);
  const double mean = 2 * std::numbers::pi / n;
  while (true) {
    double sum = 0;
    for (double& g : gaps) sum += g = -natural_log(1 - random.uniform());
    if (!(sum > 0)) continue;
    bool fits = true;
    for (double& g : gaps) {
      g = mean * (kLeastGap + (1 - kLeastGap) * n * g / sum);
      fits &= g <= kMostGap * mean;
    }
    if (fits) return gaps;
  }
}

// Random numbers that draw_gaps takes, about. It rejects until none of n uniform spacings is above
// (kMostGap - kLeastGap) / (1 - kLeastGap) = 2.5 of their mean. Exponential spacings cut off there
// keep their mean only when tilted, to exp(-x/2): the chance of it is exp(-0.1445) for each.
double gap_draws(double n) { return n * std::exp(0.1445 * n); }

Outline on_ellipse(const std::vector<double>& angles, double a, double b) {
  Outline out;
  out.reserve(angles.size());
  for (const double t : angles) {
    const auto [c, s] = rotation_of(t);
    out.push_back({a * c, b * s});
  }
  return out;
}

int draw_corners(const ShapeSetup& s, Random& random) {
  const int kinds = s.corners_max - s.corners_min + 1;
  return s.corners_min + std::min(kinds - 1, static_cast<int>(kinds * random.uniform()));
}

Outline rand1(const ShapeSetup& s, double radius, Random& random) {
  const std::vector<double> gaps = draw_gaps(draw_corners(s, random), random);
  std::vector<double> angles;
  double t = random.uniform(0, 2 * std::numbers::pi);
  for (const double gap : gaps) {
    angles.push_back(t);
    t += gap;
  }
  const double stretch = std::sqrt(s.axis_ratio);
  return on_ellipse(angles, radius * stretch, radius / stretch);
}

Outline regular(int corners, double radius) {
  std::vector<double> angles;
  for (int k = 0; k < corners; ++k) angles.push_back(2 * std::numbers::pi * k / corners);
  return on_ellipse(angles, radius, radius);
}

Outline irregular_pentagon(double side, Random& random) {
  const double gap = 2 * std::numbers::pi / kPentagon;
  std::vector<double> angles;
  for (int k = 0; k < kPentagon; ++k) {
    angles.push_back(gap * (k + kTurn * random.uniform(-1, 1)));
  }
  Outline unit = on_ellipse(angles, 1, 1);
  double around = 0;
  for (int k = 0; k < kPentagon; ++k) {
    const auto& p = unit[k];
    const auto& q = unit[(k + 1) % kPentagon];
    around += std::hypot(q[0] - p[0], q[1] - p[1]);
  }
  for (auto& p : unit) {
    p[0] *= kPentagon * side / around;
    p[1] *= kPentagon * side / around;
  }
  return unit;
}

Outline given(const ShapeSetup& s, double radius) {
  Outline out;
  for (std::size_t k = 0; k + 1 < s.outline.size(); k += 2) {
    out.push_back({radius * s.outline[k], radius * s.outline[k + 1]});
  }
  return out;
}

double side_of(const ShapeSetup& s) {
  return s.side > 0 ? s.side : 2 * s.radius * rotation_of(std::numbers::pi / kPentagon).sine;
}

}  // namespace

NewGrain ShapedGrain::at(double x, double y, double density) const {
  NewGrain g;
  g.x = x;
  g.y = y;
  g.angle = angle;
  g.radius = radius;
  g.density = density;
  g.outline = outline;
  g.axes = axes;
  g.exponents = exponents;
  g.orientation = orientation;
  return g;
}

void check_shape(const ShapeSetup& s) {
  require(s.radius > 0 && std::isfinite(s.radius), "shape.radius", s.radius, "above 0");
  require(s.polydispersity >= 0 && s.polydispersity <= kMostPolydispersity, "shape.polydispersity",
          s.polydispersity,
          fmt::format("0 to {:g} (radii are uniform in radius (1 -+ polydispersity))",
                      kMostPolydispersity));
  if (s.kind == "rand1" || s.kind == "regular") {
    require(s.corners_min >= 3, "shape.corners_min", s.corners_min, "3 or more");
    require(s.corners_max >= s.corners_min, "shape.corners_max", s.corners_max,
            fmt::format("at least shape.corners_min = {}", s.corners_min));
    require(s.corners_max <= kMostCorners, "shape.corners_max", s.corners_max,
            fmt::format("at most {}", kMostCorners));
  }
  if (s.kind == "rand1") {
    require(s.axis_ratio >= 1 && s.axis_ratio <= kMostAxisRatio, "shape.axis_ratio", s.axis_ratio,
            fmt::format("1 to {:g} (major over minor axis)", kMostAxisRatio));
  } else {
    require(s.axis_ratio == 1, "shape.axis_ratio", s.axis_ratio,
            "1, because only grains of shape.kind \"rand1\" are stretched");
  }
  if (s.kind != "outline" && !s.outline.empty()) {
    throw std::invalid_argument(fmt::format(
        "shape.outline: found {} numbers, allowed: none with shape.kind \"{}\"; set shape.kind = "
        "\"outline\"",
        s.outline.size(), s.kind));
  }
  if (s.kind != "irregular") {
    require(s.side == 0, "shape.side", s.side,
            "0, because only grains of shape.kind \"irregular\" have it; set shape.radius");
  }
  if (s.kind == "irregular") {
    require(s.side >= 0 && std::isfinite(s.side), "shape.side", s.side,
            "above 0, or 0 to take it from shape.radius");
  } else if (s.kind == "outline") {
    if (s.outline.size() % 2 != 0) {
      throw std::invalid_argument(fmt::format(
          "shape.outline: found {} numbers, allowed: pairs x1, y1, x2, y2, ... of three or more "
          "corners",
          s.outline.size()));
    }
    double farthest = 0;
    try {
      farthest = circumradius_of(centred_outline(given(s, 1)));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("shape.outline: {}", error.what()));
    }
    // Typed in metres, it would make dust or boulders of the grains.
    if (!(farthest >= 1 / kMostStretch && farthest <= kMostStretch)) {
      throw std::invalid_argument(fmt::format(
          "shape.outline: its farthest corner lies {:g} shape.radius from the "
          "centroid, allowed: {:g} to {:g}; corners are in units of shape.radius: divide "
          "metres by {:g}",
          farthest, 1 / kMostStretch, kMostStretch, s.radius));
    }
  }
}

ShapedGrain disk_grain(double radius) {
  ShapedGrain g;
  g.radius = radius;
  g.area = std::numbers::pi * radius * radius;
  return g;
}

double draw_work(const ShapeSetup& s) {
  constexpr double kOctagon = 8;
  return s.kind == "rand1" ? std::max(1.0, gap_draws(s.corners_max) / gap_draws(kOctagon)) : 1;
}

ShapedGrain draw_grain(const ShapeSetup& s, Random& random) {
  const double size = 1 + s.polydispersity * random.uniform(-1, 1);
  const double radius = s.radius * size;
  if (s.kind == "disk") return disk_grain(radius);
  Outline corners;
  if (s.kind == "rand1") {
    corners = rand1(s, radius, random);
  } else if (s.kind == "regular") {
    corners = regular(draw_corners(s, random), radius);
  } else if (s.kind == "irregular") {
    corners = irregular_pentagon(side_of(s) * size, random);
  } else {
    corners = given(s, radius);
  }
  ShapedGrain g;
  g.outline = centred_outline(corners);
  g.radius = circumradius_of(g.outline);
  g.area = area_of(g.outline);
  g.angle = random.uniform(-std::numbers::pi, std::numbers::pi);
  return g;
}

GrainExtremes extremes_of(const std::vector<ShapedGrain>& grains, double density) {
  GrainExtremes out;
  out.least_mass = std::numeric_limits<double>::infinity();
  double steepest = 0, widest = 0;  // over the square root of the mass
  for (const ShapedGrain& g : grains) {
    const double mass = density * g.area;
    out.least_mass = std::min(out.least_mass, mass);
    if (g.outline.empty()) continue;
    const auto keep_quickest = [mass](double edge, double& quickest, double& most,
                                      double& its_mass) {
      const double quick = edge / std::sqrt(mass);
      if (quick <= quickest) return;
      quickest = quick;
      most = edge;
      its_mass = mass;
    };
    keep_quickest(edge_steepness(g.outline), steepest, out.steepest_edge, out.steep_mass);
    keep_quickest(edge_width(g.outline), widest, out.widest_edge, out.wide_mass);
  }
  return out;
}

double largest_radius(const std::vector<ShapedGrain>& grains) {
  double r = 0;
  for (const ShapedGrain& g : grains) r = std::max(r, g.radius);
  return r;
}

double mean_radius(const std::vector<ShapedGrain>& grains) {
  double sum = 0;
  for (const ShapedGrain& g : grains) sum += g.radius;
  return sum / static_cast<double>(grains.size());
}

double total_area(const std::vector<ShapedGrain>& grains) {
  double sum = 0;
  for (const ShapedGrain& g : grains) sum += g.area;
  return sum;
}

std::vector<NewGrain> side_by_side(const std::vector<ShapedGrain>& grains, double left,
                                   double right, double bottom, double density, Random& random) {
  double slack = right - left;
  for (const ShapedGrain& g : grains) slack -= 2 * g.radius;
  slack = std::max(slack, 0.0);
  // Gaps: shares of the slack by uniform weights.
  std::vector<double> weights(grains.size() + 1);
  double total = 0;
  for (double& w : weights) total += w = random.uniform();
  std::vector<NewGrain> out;
  double x = left;
  for (std::size_t k = 0; k < grains.size(); ++k) {
    x += slack * weights[k] / total;
    out.push_back(grains[k].at(x + grains[k].radius, bottom + grains[k].radius, density));
    x += 2 * grains[k].radius;
  }
  return out;
}

}  // namespace grainfield::dem
