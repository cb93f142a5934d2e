#include "coupling/averaging/region.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "coupling/averaging/clip.h"
#include "coupling/averaging/columns.h"
#include "coupling/averaging/extent.h"
#include "coupling/averaging/layer.h"

namespace grainfield::coupling {
namespace {

using boost::math::quadrature::gauss;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double pi = std::numbers::pi;

// A lid that no grain touches says nothing about where the packing ends.
bool touched(const dem::Snapshot& snapshot, std::size_t wall) {
  const auto j = -1 - static_cast<std::int64_t>(wall);
  return std::any_of(snapshot.contacts.begin(), snapshot.contacts.end(),
                     [j](const dem::Contact& contact) { return contact.j == j; });
}

// Part of a ball beyond a plane at x from its centre.
double cap_beyond(double w, double x) {
  const double h = w - std::clamp(x, -w, w);
  return pi * h * h * (3 * w - h) / 3;
}

// The ball in the box where its sides cut no more than caps that do not meet; nan otherwise.
double ball_less_caps(double w, const Vector3d& low, const Vector3d& high) {
  const double sides[6] = {-low.x(), high.x(), -low.y(), high.y(), -low.z(), high.z()};
  double left = 4 * pi / 3 * w * w * w;
  int cutting = 0;
  bool centre_inside = true;
  for (int a = 0; a < 6; ++a) {
    if (sides[a] <= -w) return 0;
    if (sides[a] >= w) continue;
    ++cutting;
    centre_inside = centre_inside && sides[a] >= 0;
    left -= cap_beyond(w, sides[a]);
    for (int b = 0; b < a / 2 * 2; ++b)
      if (sides[b] < w && sides[a] * sides[a] + sides[b] * sides[b] < w * w)
        return std::numeric_limits<double>::quiet_NaN();
  }
  return cutting <= 1 || centre_inside ? left : std::numeric_limits<double>::quiet_NaN();
}

double circle_in_box(double w, const Vector3d& low, const Vector3d& high, int dim) {
  if (dim == 2) return disk_in_box(w, low.head<2>(), high.head<2>());
  const double simple = ball_less_caps(w, low, high);
  if (!std::isnan(simple)) return simple;
  // Slices of the sphere, z = w sin(t): the area of a slice ends with the square of the distance
  // from the pole, and kinks where a side of the box first cuts a slice.
  std::vector<double> ends{std::max(-w, low.z()), std::min(w, high.z())};
  if (ends[0] >= ends[1]) return 0;
  std::vector<double> kinks;
  const auto kink = [&](double squared) {
    if (squared >= w * w || squared < 0) return;
    for (double sign : {-1.0, 1.0}) kinks.push_back(sign * std::sqrt(w * w - squared));
  };
  for (double x : {low.x(), high.x()}) {
    kink(x * x);
    for (double y : {low.y(), high.y()}) kink(x * x + y * y);
  }
  for (double y : {low.y(), high.y()}) kink(y * y);
  for (double z : kinks)
    if (z > ends[0] && z < ends[1]) ends.push_back(z);
  std::sort(ends.begin(), ends.end());
  double volume = 0;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    const auto slice = [&](double t) {
      const double z = w * std::sin(t), r = std::sqrt(std::max(0.0, w * w - z * z));
      return disk_in_box(r, low.head<2>(), high.head<2>()) * w * std::cos(t);
    };
    volume +=
        gauss<double, 30>::integrate(slice, std::asin(ends[k] / w), std::asin(ends[k + 1] / w));
  }
  return volume;
}

double square_in_box(double w, const Vector3d& low, const Vector3d& high, int dim) {
  double product = 1;
  for (int a = 0; a < dim; ++a)
    product *= std::max(0.0, std::min(w, high[a]) - std::max(-w, low[a]));
  return product;
}

// Two spheres whose centres are `distance` apart share two caps on either side of a common plane.
double ball_in_ball(double distance, double r1, double r2) {
  const double small = std::min(r1, r2);
  if (distance >= r1 + r2) return 0;
  if (distance <= std::abs(r1 - r2)) return 4 * pi / 3 * small * small * small;
  const double x = (distance * distance + r1 * r1 - r2 * r2) / (2 * distance);
  const auto cap = [](double r, double h) { return pi * h * h * (3 * r - h) / 3; };
  return cap(r1, r1 - x) + cap(r2, r2 - (distance - x));
}

const Support supports[]{
    {"circle", [](const Vector3d& d) { return d.norm(); },
     [](double w, int dim) { return dim == 2 ? pi * w * w : 4 * pi / 3 * w * w * w; },
     circle_in_box, [](double w, const Corners& corners) { return area_in_circle(corners, w); },
     [](double w, const Vector2d& c, double r) { return disk_in_disk(c.norm(), w, r); },
     [](double w, const Vector3d& c, double r) { return ball_in_ball(c.norm(), w, r); },
     [](double w, double x) { return std::sqrt(std::max(0.0, w * w - x * x)); },
     [](double w, double x, double y) { return std::sqrt(std::max(0.0, w * w - x * x - y * y)); }},
    {"square", [](const Vector3d& d) { return d.cwiseAbs().maxCoeff(); },
     [](double w, int dim) { return std::pow(2 * w, dim); }, square_in_box,
     [](double w, const Corners& corners) {
       return area_in_box(corners, Vector2d::Constant(-w), Vector2d::Constant(w));
     },
     [](double w, const Vector2d& c, double r) {
       return disk_in_box(r, Vector2d::Constant(-w) - c, Vector2d::Constant(w) - c);
     },
     [](double w, const Vector3d& c, double r) {
       return circle_in_box(r, Vector3d::Constant(-w) - c, Vector3d::Constant(w) - c, 3);
     },
     [](double w, double /*x*/) { return w; },
     [](double w, double /*x*/, double /*y*/) { return w; }},
};

}  // namespace

const Support* find_support(const std::string& name) {
  for (const Support& support : supports)
    if (name == support.name) return &support;
  return nullptr;
}

Region::Region(const dem::Snapshot& snapshot)
    : dim_(snapshot.dim), low_(Vector3d::Constant(infinity)), high_(Vector3d::Constant(-infinity)) {
  if (dim_ == 2) {
    const LayerFrame frame = layer_frame(snapshot);
    low_ << frame.left, frame.floor, 0;
    high_ << frame.right, frame.surface, 0;
    find_surface(snapshot);
    return;
  }
  find_roof(snapshot);
}

void Region::find_roof(const dem::Snapshot& snapshot) {
  const LayerFrame frame = layer_frame(snapshot);
  low_ << frame.left, frame.front, frame.floor;
  high_ << frame.right, frame.back, 0;
  roof_ = Roof(snapshot, low_, high_, 2 * mean_diameter(snapshot));
  for (std::size_t w = 0; w < snapshot.walls.size(); ++w) {
    const dem::Wall& wall = snapshot.walls[w];
    if (wall.shape == "plane" && wall.normal.z() < -1 + 1e-9 && touched(snapshot, w))
      roof_ = Roof(wall.point.z());
  }
  high_.z() = roof_.highest();
}

void Region::find_surface(const dem::Snapshot& snapshot) {
  const double column = 2 * mean_diameter(snapshot), width = right() - left();
  const std::size_t columns = count_columns(snapshot, 0, left(), right(), column);
  std::vector<const dem::Grain*> top(columns, nullptr);
  for (const dem::Grain& grain : snapshot.grains) {
    if (grain.fixed) continue;
    const double at = (grain.position.x() - left()) / width * static_cast<double>(columns);
    const auto k =
        static_cast<std::size_t>(std::clamp(std::floor(at), 0.0, static_cast<double>(columns - 1)));
    if (!top[k] || top_of(grain) > top_of(*top[k])) top[k] = &grain;
  }
  bool left_wall = false, right_wall = false;
  for (const dem::Wall& wall : snapshot.walls) {
    left_wall = left_wall || wall.name == "left";
    right_wall = right_wall || wall.name == "right";
  }
  const auto add = [&](double x, double y) {
    if (surface_.empty() || x > surface_.back().x()) surface_.emplace_back(x, std::max(y, floor()));
  };
  // A side without a wall that is steeper than any heap (63 degrees over its first column) is a
  // vertical edge.
  const auto end_height = [&](const dem::Grain* grain, bool wall) {
    const double height = grain ? top_of(*grain) - floor() : 0;
    return wall || height > 2 * column ? floor() + height : floor();
  };
  add(left(), end_height(top.front(), left_wall));
  for (std::size_t k = 0; k < columns; ++k) {
    const double middle =
        left() + (static_cast<double>(k) + 0.5) / static_cast<double>(columns) * width;
    if (top[k])
      add(top[k]->position.x(), top_of(*top[k]));
    else
      add(middle, floor());
  }
  add(right(), end_height(top.back(), right_wall));
  for (std::size_t w = 0; w < snapshot.walls.size(); ++w) {
    const dem::Wall& wall = snapshot.walls[w];
    if (wall.normal.y() < -1 + 1e-9 && touched(snapshot, w))  // a lid or piston
      surface_ = {{left(), wall.point.y()}, {right(), wall.point.y()}};
  }
  high_.y() = -infinity;
  for (const Vector2d& corner : surface_) high_.y() = std::max(high_.y(), corner.y());
}

double Region::surface(double x) const {
  if (x <= surface_.front().x()) return surface_.front().y();
  if (x >= surface_.back().x()) return surface_.back().y();
  const auto next = std::upper_bound(surface_.begin(), surface_.end(), x,
                                     [](double value, const Vector2d& c) { return value < c.x(); });
  const Vector2d &a = *(next - 1), &b = *next;
  return a.y() + (x - a.x()) / (b.x() - a.x()) * (b.y() - a.y());
}

double Region::measure(const Support& support, double width, const Eigen::VectorXd& at) const {
  Vector3d centre = Vector3d::Zero();
  centre.head(dim_) = at;
  if (dim_ == 3) return below_roof(support, width, centre);
  const Vector3d low = low_ - centre;
  double area = 0;
  for (std::size_t k = 0; k + 1 < surface_.size(); ++k) {
    const Vector2d a = surface_[k] - at, b = surface_[k + 1] - at;
    if (b.x() <= -width || a.x() >= width) continue;
    // A column whose top is out of reach is a box.
    if (std::min(a.y(), b.y()) >= width)
      area += support.in_box(width, {a.x(), low.y(), 0}, {b.x(), width, 0}, 2);
    else
      area += support.in_polygon(width, {{a.x(), low.y()}, {b.x(), low.y()}, b, a});
  }
  return area;
}

double Region::below_roof(const Support& support, double width, const Vector3d& at) const {
  const Vector3d low = low_ - at;
  Vector3d high = high_ - at;
  const double least =
      roof_.lowest(at.x() - width, at.x() + width, at.y() - width, at.y() + width) - at.z();
  if (least >= width || roof_.heights().size() == 1) {  // a box
    high.z() = std::min(width, least);
    return support.in_box(width, low, high, 3);
  }
  const double x0 = std::max(-width, low.x()), x1 = std::min(width, high.x());
  if (!(x0 < x1)) return 0;
  return gauss<double, 20>::integrate(
      [&](double x) {
        const double half = support.half_y(width, x), y0 = std::max(-half, low.y()),
                     y1 = std::min(half, high.y());
        if (!(y0 < y1)) return 0.0;
        return gauss<double, 20>::integrate(
            [&](double y) {
              const double reach = support.half_z(width, x, y);
              const double top = std::min(reach, roof_.height(at.x() + x, at.y() + y) - at.z());
              return std::max(0.0, top - std::max(-reach, low.z()));
            },
            y0, y1);
      },
      x0, x1);
}

double Region::share(const Kernel& kernel, const Vector3d& at, bool above_only) const {
  const double range = kernel.range();
  const Vector3d low = low_ - at, high = high_ - at;
  const double least =
      roof_.lowest(at.x() - range, at.x() + range, at.y() - range, at.y() + range) - at.z();
  const bool walls_far = low.maxCoeff() <= -range && high.head<2>().minCoeff() >= range;
  if (least >= range && (above_only || walls_far)) return 1;
  const double x0 = above_only ? -range : std::max(-range, low.x()),
               x1 = above_only ? range : std::min(range, high.x());
  const double bottom = above_only ? -range : low.z();
  if (!(x0 < x1)) return 0;
  return gauss<double, 20>::integrate(
      [&](double x) {
        const double half = std::sqrt(std::max(0.0, range * range - x * x));
        const double y0 = above_only ? -half : std::max(-half, low.y()),
                     y1 = above_only ? half : std::min(half, high.y());
        if (!(y0 < y1)) return 0.0;
        return gauss<double, 20>::integrate(
            [&](double y) {
              const double d2 = x * x + y * y;
              const double reach = std::sqrt(std::max(0.0, range * range - d2));
              const double s0 = std::max(-reach, bottom),
                           s1 = std::min(reach, roof_.height(at.x() + x, at.y() + y) - at.z());
              return s1 > s0 ? kernel.along_line(std::sqrt(d2), s0, s1) : 0.0;
            },
            y0, y1);
      },
      x0, x1);
}

double Region::share(const Kernel& kernel, const Vector2d& at, bool above_only) const {
  const double range = kernel.range();
  const double from = above_only ? -range : std::max(-range, left() - at.x());
  const double to = above_only ? range : std::min(range, right() - at.x());
  const double bottom = above_only ? -infinity : floor() - at.y();
  std::vector<double> ends{from};
  for (const Vector2d& corner : surface_)
    if (corner.x() - at.x() > from && corner.x() - at.x() < to) ends.push_back(corner.x() - at.x());
  ends.push_back(to);
  double share = 0;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    if (ends[k + 1] <= ends[k]) continue;
    const auto chord = [&](double x) {
      const double half = std::sqrt(std::max(0.0, range * range - x * x));
      const double s0 = std::max(-half, bottom), s1 = std::min(half, surface(at.x() + x) - at.y());
      return s1 > s0 ? kernel.along_line(std::abs(x), s0, s1) : 0.0;
    };
    share += gauss<double, 15>::integrate(chord, ends[k], ends[k + 1]);
  }
  return share;
}

}  // namespace grainfield::coupling
