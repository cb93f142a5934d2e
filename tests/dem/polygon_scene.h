// Convex polygons where a test wants them, and an overlap in long double by all edges.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "dem/random/random.h"
#include "dem/shapes/polygon.h"

namespace grainfield::dem {

/// An outline with its place; owns the corners that `shape` points to.
class Placed {
 public:
  Placed(const Outline& outline, double cx, double cy, double angle = 0) : n_(outline.size()) {
    const double c = std::cos(angle), s = std::sin(angle);
    for (const auto& [x, y] : outline) {
      x_.push_back(cx + c * x - s * y);
      y_.push_back(cy + s * x + c * y);
    }
    x_.push_back(x_[0]);
    y_.push_back(y_[0]);
    cx_ = cx;
    cy_ = cy;
    radius_ = circumradius_of(outline);
  }
  static Placed disk(double radius, double cx, double cy) {
    Placed p;
    p.cx_ = cx;
    p.cy_ = cy;
    p.radius_ = radius;
    return p;
  }
  /// Moved by (dx, dy) and turned by `angle` about (px, py).
  Placed moved(double dx, double dy, double angle = 0, double px = 0, double py = 0) const {
    Placed p = *this;
    const double c = std::cos(angle), s = std::sin(angle);
    const auto move = [&](double& x, double& y) {
      const double rx = x - px, ry = y - py;
      x = px + dx + (angle == 0 ? rx : c * rx - s * ry);
      y = py + dy + (angle == 0 ? ry : s * rx + c * ry);
    };
    for (std::size_t k = 0; k < x_.size(); ++k) move(p.x_[k], p.y_[k]);
    move(p.cx_, p.cy_);
    return p;
  }
  PlacedShape shape() const {
    return {x_.data(), y_.data(), static_cast<int>(n_), cx_, cy_, radius_};
  }
  Outline corners() const {
    Outline outline;
    for (std::size_t k = 0; k < n_; ++k) outline.push_back({x_[k], y_[k]});
    return outline;
  }
  double cx() const { return cx_; }
  double cy() const { return cy_; }
  double radius() const { return radius_; }
  double area() const {
    return n_ == 0 ? std::numbers::pi * radius_ * radius_ : area_of(corners());
  }

 private:
  Placed() = default;
  std::size_t n_ = 0;
  std::vector<double> x_, y_;
  double cx_ = 0, cy_ = 0, radius_ = 0;
};

inline Outline regular(int corners, double radius, double phase = 0) {
  Outline outline;
  for (int k = 0; k < corners; ++k) {
    const double angle = phase + 2 * std::numbers::pi * k / corners;
    outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return outline;
}

inline Outline box(double width, double height) {
  return {{-width / 2, -height / 2},
          {width / 2, -height / 2},
          {width / 2, height / 2},
          {-width / 2, height / 2}};
}

/// Corners at random angles on an ellipse of semi-axes `radius` and radius / `ratio`.
inline Outline random_outline(Random& random, int corners, double radius, double ratio) {
  for (;;) {
    std::vector<double> angles;
    for (int k = 0; k < corners; ++k) {
      // Mixed from even and free spacing, so that corners neither coincide nor sit evenly.
      angles.push_back(2 * std::numbers::pi * (k + 0.9 * random.uniform()) / corners);
    }
    Outline outline;
    for (double angle : angles) {
      outline.push_back({radius * std::cos(angle), radius / ratio * std::sin(angle)});
    }
    try {
      return centred_outline(outline);
    } catch (const std::invalid_argument&) {  // a sliver: draw again
    }
  }
}

using LongLoop = std::vector<std::array<long double, 2>>;

/// The overlap in long double: A clipped by every edge of B, no short cuts.
inline LongLoop overlap_in_long_double(const Outline& a, const Outline& b) {
  using Point = std::array<long double, 2>;
  LongLoop loop;
  for (const auto& p : a) loop.push_back({p[0], p[1]});
  for (std::size_t k = 0; k < b.size(); ++k) {
    const Point q = {b[k][0], b[k][1]}, r = {b[(k + 1) % b.size()][0], b[(k + 1) % b.size()][1]};
    std::vector<Point> next;
    const auto side = [&](const Point& p) {
      return (r[0] - q[0]) * (p[1] - q[1]) - (r[1] - q[1]) * (p[0] - q[0]);
    };
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point &p = loop[i], &e = loop[(i + 1) % loop.size()];
      const long double s0 = side(p), s1 = side(e);
      if (s0 >= 0) next.push_back(p);
      if ((s0 >= 0) != (s1 >= 0)) {
        const long double t = s0 / (s0 - s1);
        next.push_back({p[0] + t * (e[0] - p[0]), p[1] + t * (e[1] - p[1])});
      }
    }
    loop = next;
  }
  return loop;
}

inline double area_in_long_double(const Outline& a, const Outline& b) {
  const LongLoop loop = overlap_in_long_double(a, b);
  long double twice = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const auto &o = loop[0], &p = loop[i], &e = loop[(i + 1) % loop.size()];
    twice += (p[0] - o[0]) * (e[1] - o[1]) - (e[0] - o[0]) * (p[1] - o[1]);
  }
  return static_cast<double>(twice / 2);
}

/// The overlap of two placed shapes with an empty memory. Area 0: none.
inline Overlap overlap_of(const Placed& a, const Placed& b) {
  Overlap o;
  PairFeature feature;
  if (!overlap_of_shapes(a.shape(), b.shape(), feature, o)) return Overlap{};
  return o;
}

/// The contact point, from a's side.
inline std::array<double, 2> contact_point(const Placed& a, const Overlap& o) {
  return {a.cx() + o.lever_i * o.nx - o.shift_i * o.ny,
          a.cy() + o.lever_i * o.ny + o.shift_i * o.nx};
}

/// True where normal and contact point are on their way to least penetration (polygon.h).
inline bool handed_over(const Placed& a, const Placed& b, double area, double chord) {
  return area > 0.98 * std::min(a.area(), b.area()) || chord * chord < 0.02 * area;
}

/// Two random polygons so near that most pairs overlap, of every kind in turn: general ones, light
/// contacts, ratio up to 1:100, slivers, many corners, one inside the other.
inline std::pair<Placed, Placed> random_pair(Random& random, int kind) {
  const auto corners = [&](int low, int high) {
    return low + static_cast<int>(random.uniform() * (high - low + 1));
  };
  const auto outline = [&](double radius) {
    switch (kind % 6) {
      case 2:
        return random_outline(random, corners(3, 9), radius, random.uniform(1, 9));
      case 3:
        return random_outline(random, corners(10, 64), radius, random.uniform(1, 2));
      default:
        return random_outline(random, corners(3, 9), radius, random.uniform(1, 2));
    }
  };
  const double ratio = kind % 6 == 4 ? std::pow(10, random.uniform(-2, 0)) : random.uniform(0.5, 1);
  const Outline first = outline(1), second = outline(ratio);
  const double place = random.uniform(0, 2 * std::numbers::pi);
  const auto placed = [&](double distance) {
    return Placed(second, distance * std::cos(place), distance * std::sin(place), 0);
  };
  const Placed a(first, 0, 0, 0);
  const double reach = a.radius() + circumradius_of(second);
  double distance = random.uniform(0, 1) * reach;
  if (kind % 6 == 5) distance = random.uniform(0, 0.3) * reach;
  if (kind % 6 == 1) {
    // Light contact: bisection for the distance of first touch, then a little nearer.
    double touching = 0, apart = reach;
    for (int k = 0; k < 60; ++k) {
      const double middle = (touching + apart) / 2;
      (overlap_of(a, placed(middle)).area > 0 ? touching : apart) = middle;
    }
    distance = touching - std::pow(10, random.uniform(-9, -2));
  }
  return {a, placed(distance)};
}

// Polygons with corners on an integer lattice: boxes, diamonds, triangles, octagons.
inline Outline lattice_outline(Random& random) {
  const double m = 1 + static_cast<int>(random.uniform(0, 3));
  switch (static_cast<int>(random.uniform(0, 4))) {
    case 0:
      return box(2 * m, 2 + 2 * static_cast<int>(random.uniform(0, 2)));
    case 1:
      return {{m, 0}, {0, m}, {-m, 0}, {0, -m}};
    case 2:
      return {{-m, -m}, {2 * m, -m}, {-m, 2 * m}};
    default:
      return {{2, -1}, {2, 1}, {1, 2}, {-1, 2}, {-2, 1}, {-2, -1}, {-1, -2}, {1, -2}};
  }
}

/// Pairs that random numbers never draw: corner on corner, edge along edge, shapes that coincide.
inline std::pair<Placed, Placed> degenerate_pair(Random& random, int kind) {
  const auto shift = [&] { return std::floor(random.uniform(-5, 6)); };
  const auto turned = [](Outline outline, double angle) {
    for (auto& [x, y] : outline) {
      const double c = std::cos(angle), s = std::sin(angle), px = x;
      x = c * px - s * y;
      y = s * px + c * y;
    }
    return outline;
  };
  const int corners = 3 + static_cast<int>(random.uniform() * 8);
  const Outline any = random_outline(random, corners, 1, random.uniform(1, 3));
  switch (kind % 5) {
    case 0:
      return {Placed(lattice_outline(random), 0, 0),
              Placed(lattice_outline(random), shift(), shift())};
    case 1:
      return {Placed(any, 0, 0), Placed(any, 0, 0)};
    case 2: {  // mirrored: its corners in the opposite order, to turn the right way round
      Outline mirrored(any.rbegin(), any.rend());
      for (auto& corner : mirrored) corner[0] = -corner[0];
      return {Placed(any, 0, 0), Placed(mirrored, 0, 0)};
    }
    case 3: {  // turned onto itself by its own symmetry
      const Outline even = regular(corners, 1);
      return {Placed(even, 0, 0), Placed(turned(even, 2 * std::numbers::pi / corners), 0, 0)};
    }
    default: {  // turned half round about a side's middle: the sides lie on each other
      const auto &p = any[0], &q = any[1];
      return {Placed(any, 0, 0), Placed(turned(any, std::numbers::pi), p[0] + q[0], p[1] + q[1])};
    }
  }
}

}  // namespace grainfield::dem
