#include "coupling/averaging/upright.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "coupling/averaging/extent.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;
using Eigen::Matrix3d;

// Sine of the angle by which gravity may miss an axis and still be along it: dumps with six digits.
constexpr double kAlong = 1e-5;

std::string axes_in(int dim) { return dim == 2 ? "x, -x, y or -y" : "x, -x, y, -y, z or -z"; }

// The axis along a vector, as a unit vector; zero: along none.
Vec3 axis_along(const Vec3& v) {
  int a = 0;
  v.cwiseAbs().maxCoeff(&a);
  Vec3 axis = Vec3::Unit(a);
  if (v[a] < 0) axis = -axis;
  return (v / v.norm() - axis).norm() <= kAlong ? axis : Vec3(0, 0, 0);
}

std::string shown(const Vec3& v, int dim) {
  return dim == 2 ? fmt::format("({:g}, {:g})", v.x(), v.y())
                  : fmt::format("({:g}, {:g}, {:g})", v.x(), v.y(), v.z());
}

// Rows: the new axes in the old ones. x stays where it can.
Matrix3d turn_to(const Vec3& up, int dim) {
  Matrix3d turn;
  if (dim == 2) {
    turn.row(0) = Vec3(up.y(), -up.x(), 0);
    turn.row(1) = up;
    turn.row(2) = Vec3::UnitZ();
    return turn;
  }
  const Vec3 x = std::abs(up.x()) > 0.5 ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
  turn.row(0) = x;
  turn.row(1) = up.cross(x);
  turn.row(2) = up;
  return turn;
}

// Axes change places and senses: of a cell that is not tilted its edges do, too.
void turn_cell(const Matrix3d& turn, dem::Snapshot& s) {
  if (!s.cell.is_periodic()) return;
  const dem::Cell<3> old = s.cell;
  const Matrix3d edges = old.edges;
  if (!edges.isDiagonal(1e-12)) {
    throw std::invalid_argument(
        "the packing's periodic cell is tilted and its height is not along the last axis: import "
        "it with the axes changed, as --column y=z --column z=y");
  }
  std::array<int, 3> from{}, sense{};
  for (int b = 0; b < 3; ++b) {
    turn.row(b).cwiseAbs().maxCoeff(&from[b]);
    sense[b] = turn(b, from[b]) < 0 ? -1 : 1;
    const double edge = old.edges(from[b], from[b]), low = old.low[from[b]];
    s.cell.periodic[b] = old.periodic[from[b]];
    s.cell.low[b] = sense[b] > 0 ? low : -(low + edge);
    s.cell.edges(b, b) = edge;
  }
  s.cell.velocity_gradient = turn * Matrix3d(old.velocity_gradient) * turn.transpose();
  const auto turn_image = [&](std::array<int, 3>& image) {
    const std::array<int, 3> before = image;
    for (int b = 0; b < 3; ++b) image[b] = sense[b] * before[from[b]];
  };
  for (dem::Grain& g : s.grains) turn_image(g.image);
  for (dem::Contact& c : s.contacts) turn_image(c.image);
}

dem::Snapshot turned(const dem::Snapshot& snapshot, const Matrix3d& turn) {
  dem::Snapshot s = snapshot;
  const auto apply = [&](Vec3& v) { v = turn * v; };
  const Eigen::Quaterniond rotation(turn);
  const double angle = std::atan2(turn(1, 0), turn(0, 0));
  apply(s.gravity);
  apply(s.applied_force);
  for (dem::Grain& g : s.grains) {
    apply(g.position);
    apply(g.velocity);
    apply(g.angular_velocity);
    if (s.dim == 2) {
      g.angle += angle;
      continue;
    }
    const auto& q = g.orientation;
    const Eigen::Quaterniond now = rotation * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    g.orientation = {now.w(), now.x(), now.y(), now.z()};
    g.spin = g.angular_velocity.z();
  }
  for (dem::Contact& c : s.contacts) {
    for (Vec3* v : {&c.point, &c.normal, &c.force, &c.spring_vector, &c.rolling_spring}) apply(*v);
  }
  for (dem::Wall& w : s.walls) {
    for (Vec3* v : {&w.point, &w.normal, &w.velocity, &w.angular_velocity, &w.force, &w.torque}) {
      apply(*v);
    }
    for (auto& triangle : w.triangles) {
      for (Vec3& corner : triangle) apply(corner);
    }
  }
  turn_cell(turn, s);
  return s;
}

}  // namespace

bool is_up(const std::string& word) {
  const std::size_t at = word.starts_with('-') ? 1 : 0;
  return word.empty() || (word.size() == at + 1 && word[at] >= 'x' && word[at] <= 'z');
}

Vec3 up_of(const dem::Snapshot& s, const std::string& asked) {
  if (!is_up(asked) || (s.dim == 2 && asked.ends_with('z'))) {
    throw std::invalid_argument(
        fmt::format("--up: found \"{}\", allowed: {}", asked, axes_in(s.dim)));
  }
  if (!asked.empty()) {
    const Vec3 axis = Vec3::Unit(asked.back() - 'x');
    return asked.size() == 2 ? Vec3(-axis) : axis;
  }
  const Vec3 load = dem::total_applied_force(s);
  const bool weighs = s.gravity.norm() > 0;
  if (!weighs && !(load.norm() > 0)) return {0, 0, 0};
  const Vec3 up = axis_along(weighs ? Vec3(-s.gravity) : Vec3(-load));
  if (up.isZero()) {
    throw std::invalid_argument(fmt::format(
        "--up: the packing's {} is {}, along no axis; say which way is up: {}",
        weighs ? "gravity" : "load", shown(weighs ? s.gravity : load, s.dim), axes_in(s.dim)));
  }
  return up;
}

std::shared_ptr<const dem::Snapshot> upright(std::shared_ptr<const dem::Snapshot> snapshot,
                                             const Vec3& up) {
  if (up == Vec3::Unit(up_axis(snapshot->dim))) return snapshot;
  return std::make_shared<const dem::Snapshot>(turned(*snapshot, turn_to(up, snapshot->dim)));
}

}  // namespace grainfield::coupling
