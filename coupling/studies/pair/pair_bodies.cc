#include "coupling/studies/pair/pair_bodies.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "dem/grains/grain_family.h"
#include "dem/motion/motion_setup.h"
#include "dem/run/common.h"
#include "dem/shared/refuse.h"
#include "dem/space/rotation.h"

namespace grainfield::dem {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kLookAt = 400;    // places along the way at which a first contact is looked for
constexpr int kHalvings = 200;  // of the bracket: down to neighbouring numbers

ShapeSetup shape_of(const PairSetup& s, double radius) {
  ShapeSetup out;
  out.kind = s.is_3d() ? "disk" : s.shape;
  out.radius = radius;
  out.polydispersity = 0;
  out.corners_min = out.corners_max = s.corners;
  out.axis_ratio = s.shape == "rand1" ? s.axis_ratio : 1;
  if (s.shape == "outline") out.outline = s.outline;
  return out;
}

ShapedGrain draw(const PairSetup& s, double radius, double turned, Random& random) {
  ShapedGrain g = draw_grain(shape_of(s, radius), random);
  g.angle = (s.shape == "rand1" ? g.angle : 0) + turned * kDegree;
  return g;
}

void set_spin(const std::vector<double>& spin, bool in_space, NewGrain& g) {
  if (spin.empty()) return;
  g.spin = spin.back();
  if (!in_space) return;
  g.spin_x = spin[0];
  g.spin_y = spin[1];
}

double mass_of(const PairSetup& s, const ShapedGrain& g) {
  const double r = g.radius;
  return s.material.density * (s.is_3d() ? 4.0 / 3 * std::numbers::pi * r * r * r : g.area);
}

void check_spin(const char* key, const std::vector<double>& spin, bool in_space) {
  const std::size_t wanted = in_space ? 3 : 1;
  if (spin.empty() || spin.size() == wanted) return;
  refuse(key, fmt::format("{} numbers", spin.size()),
         in_space ? "3 (x, y, z) for spheres, or none" : "1 (about z) in the plane, or none");
}

// As engine_settings of the studies with gravity judges it, without gravity.
double step_of(const PairSetup& s, double limit) {
  const MotionSetup& m = s.motion;
  const double step = m.time_step > 0 ? m.time_step : m.time_step_fraction * limit;
  const double most = (s.shape == "rand1" && m.integrator == "verlet" ? kMostOfLimit : 1) * limit;
  if (step <= most * (1 + 1e-12)) return step;
  if (m.time_step > 0) {
    refuse("motion.time_step", fmt::format("{:.4g} s", step),
           fmt::format("at most {:.4g} s for this pair", round_down(most)));
  }
  refuse("motion.time_step_fraction", fmt::format("{:g}", m.time_step_fraction),
         fmt::format("at most {:g} for this pair", most / limit));
}

using Point = std::array<double, 2>;

std::vector<Point> placed(const Outline& outline, const PairState& at) {
  std::vector<Point> out;
  const auto [c, s] = rotation_of(at.angle);
  for (const auto& p : outline) {
    out.push_back({at.position.x() + c * p[0] - s * p[1], at.position.y() + s * p[0] + c * p[1]});
  }
  return out;
}

}  // namespace

void check_pair(const PairSetup& s) {
  if (s.kind == "collision" && !(s.speed > 0)) {
    refuse("pair.speed", fmt::format("{:g} with pair.kind \"collision\"", s.speed), "above 0");
  }
  check_spin("pair.spin_first", s.spin_first, s.is_3d());
  check_spin("pair.spin_second", s.spin_second, s.is_3d());
  if (s.partner == "wall" && !s.spin_second.empty()) {
    refuse("pair.spin_second", "a spin", "none for a wall");
  }
  if (!s.is_3d()) {
    const auto plane = laws_in<2>();
    if (std::find(plane.begin(), plane.end(), s.material.law) == plane.end()) {
      refuse("material.law", fmt::format("\"{}\"", s.material.law),
             fmt::format("{} for pair.shape = \"{}\"; \"{}\" is a law of spheres (3D)",
                         fmt::join(plane, " | "), s.shape, s.material.law));
    }
  }
  if (s.kind == "path" && s.path == "waypoints" &&
      (s.waypoints.size() < 6 || s.waypoints.size() % 3 != 0)) {
    refuse("pair.waypoints", fmt::format("{} numbers", s.waypoints.size()),
           "x, y, angle of two waypoints or more");
  }
  if (s.kind == "path" && s.motion.local_damping > 0) {
    refuse("motion.local_damping", fmt::format("{:g}", s.motion.local_damping),
           "0 on a path (nothing moves freely)");
  }
  if (s.shape == "outline" && s.outline.empty()) {
    refuse("pair.outline", "no corner", "x1, y1, x2, y2, ... of three corners or more");
  }
  try {
    check_shape(shape_of(s, s.radius));
  } catch (const std::invalid_argument& e) {
    const std::string what = e.what(), section = "shape.";
    throw std::invalid_argument("pair." + what.substr(section.size()));
  }
}

PairBodies make_pair(const PairSetup& s, Random& random, int threads) {
  PairBodies out;
  const double other = s.radius_second > 0 ? s.radius_second : s.radius;
  const ShapedGrain a = draw(s, s.radius, s.turned_first, random);
  const ShapedGrain b = draw(s, other, s.turned_second, random);
  out.first = a.at(0, 0, s.material.density);
  out.second = b.at(0, 0, s.material.density);
  set_spin(s.spin_first, s.is_3d(), out.first);
  set_spin(s.spin_second, s.is_3d(), out.second);
  out.has_wall = s.partner == "wall";
  out.wall = {"wall", Vec3(0, 0, 0), Vec3(-1, 0, 0), s.material.friction};
  const double mass = mass_of(s, a), mass_b = mass_of(s, b);
  out.pair_mass = out.has_wall ? mass : mass * mass_b / (mass + mass_b);

  EngineSettings& e = out.settings;
  e.law = law_of(s.material);
  e.friction = s.material.friction;
  e.rolling = RollingLaw::of(s.material);
  e.local_damping = s.motion.local_damping;
  if (s.kind == "collision") e.integrator = IntegratorKind::named(s.motion.integrator);
  e.shape = s.is_3d()           ? ShapeKind::sphere
            : s.shape == "disk" ? ShapeKind::disk
                                : ShapeKind::polygon;
  check_integrator(e);
  e.gravity_y = 0;
  e.threads = threads;
  std::vector<ShapedGrain> grains{a};
  if (!out.has_wall) grains.push_back(b);
  GrainExtremes extremes = extremes_of(grains, s.material.density);
  extremes.least_mass = out.has_wall ? mass : std::min(mass, mass_b);
  extremes.least_radius = out.has_wall ? a.radius : std::min(a.radius, b.radius);
  out.stable_step = stable_time_step(e, extremes);
  // On a path nothing moves by itself.
  e.time_step = s.kind == "collision" ? step_of(s, out.stable_step) : out.stable_step;
  return out;
}

std::unique_ptr<PairContact> PairBodies::contact() const {
  return has_wall ? make_pair_contact(settings, first, wall)
                  : make_pair_contact(settings, first, second);
}

std::unique_ptr<Engine> PairBodies::empty_engine() const {
  std::unique_ptr<Engine> out = make_engine(settings);
  if (has_wall) out->add_wall(wall);
  return out;
}

std::unique_ptr<Engine> PairBodies::engine(const PairState& state) const {
  std::unique_ptr<Engine> out = empty_engine();
  NewGrain moving = first;
  moving.x = state.position.x();
  moving.y = state.position.y();
  moving.vx = state.velocity.x();
  moving.vy = state.velocity.y();
  out->add(moving);
  if (!has_wall) out->add(second);
  return out;
}

PairState PairBodies::state_of_first(const PairPose& pose) const {
  PairState out;
  out.position = {pose.x, pose.y, 0};
  out.angle = first.angle + pose.angle;
  const auto [c, s] = rotation_of(0.5 * pose.angle);
  out.orientation = {c, 0, 0, s};
  out.spin = {first.spin_x, first.spin_y, first.spin};
  return out;
}

PairState PairBodies::state_of_second() const {
  PairState out;
  if (has_wall) return out;
  out.angle = second.angle;
  out.spin = {second.spin_x, second.spin_y, second.spin};
  return out;
}

PairPose touching_pose(const PairBodies& bodies, double offset) {
  const std::unique_ptr<PairContact> contact = bodies.contact();
  const PairState second = bodies.state_of_second();
  const auto touch = [&](double x) {
    contact->forget();
    return contact->at(bodies.state_of_first({x, offset, 0}), second, 0).touching;
  };
  const double reach = bodies.first.radius + (bodies.has_wall ? 0 : bodies.second.radius);
  double apart = -1.001 * reach, inside = apart;
  for (int k = 1; k <= kLookAt; ++k) {
    inside = reach * (2.0 * k / kLookAt - 1.001);
    if (touch(inside)) break;
    apart = inside;
    if (k == kLookAt) {
      refuse("pair.offset", fmt::format("{:g} m", offset), "one at which the bodies meet");
    }
  }
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (apart + inside);
    if (middle <= apart || middle >= inside) break;
    (touch(middle) ? inside : apart) = middle;
  }
  return {inside, offset, 0};
}

int crossings(const PairBodies& bodies, const PairState& first, const PairState& second) {
  if (bodies.has_wall) return 0;
  const auto a = placed(bodies.first.outline, first), b = placed(bodies.second.outline, second);
  const auto side = [](const Point& p, const Point& q, const Point& r) {
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) > 0;
  };
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < b.size(); ++k) {
      const Point &p = a[i], &q = a[(i + 1) % a.size()], &r = b[k], &t = b[(k + 1) % b.size()];
      count += side(p, q, r) != side(p, q, t) && side(r, t, p) != side(r, t, q);
    }
  }
  return count;
}

bool outlines_cross(const PairBodies& bodies, const PairState& first, const PairState& second) {
  const bool round = bodies.first.outline.empty();
  const double a = bodies.first.radius, b = bodies.second.radius;
  if (bodies.has_wall) {
    if (round) return std::fabs(first.position.x()) < a;
    const auto corners = placed(bodies.first.outline, first);
    const auto inside = [](const Point& p) { return p[0] > 0; };
    return std::any_of(corners.begin(), corners.end(), inside) &&
           !std::all_of(corners.begin(), corners.end(), inside);
  }
  if (!round) return crossings(bodies, first, second) > 0;
  const double distance = (first.position - second.position).norm();
  return distance > std::fabs(a - b) && distance < a + b;
}

}  // namespace grainfield::dem
