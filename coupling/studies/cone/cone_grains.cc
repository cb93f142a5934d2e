#include "coupling/studies/cone/cone_grains.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "coupling/studies/sample/simulation/grains.h"
#include "dem/grains/reach.h"
#include "dem/run/common.h"
#include "dem/run/softness.h"
#include "dem/shared/refuse.h"

namespace grainfield::dem {
namespace {

// Solid fraction of grains poured into a cylinder at least.
constexpr double kLoosest = 0.5;
// Solid fraction and slope of the heap that is expected.
constexpr double kHeapFraction = 0.6, kHeapSlope = 0.7;
// Radii above a heap from which nobody needs to pour.
constexpr double kHighFall = 40;
// Cells of the surface along a side, at most.
constexpr double kMostCells = 1000;
// A grain or a wall passes less than this share of the least radius in a step.
constexpr double kMostWay = 0.25;

bool is_sphere(const ConePlan& plan) { return plan.shape == "sphere"; }

// The same grains as those of a sample.
SamplePlan as_sample(const ConePlan& p) {
  SamplePlan out;
  out.dim = 3;
  out.shape = p.shape;
  out.grains = p.grains;
  out.sizes = "uniform";
  out.radius = p.radius;
  out.polydispersity = p.polydispersity;
  out.axis_min = p.axis_min;
  out.axis_max = p.axis_max;
  out.exponent_min = p.exponent_min;
  out.exponent_max = p.exponent_max;
  return out;
}

// Rows of the floor's spheres: no grain passes between three of them while s / sqrt(3), to the
// middle of a triangle of spacing s, is below the sum of the radii.
double floor_spacing(const ConePlan& p) {
  return std::min(2 * p.radius, 1.6 * (p.radius + sample_radii(as_sample(p)).least));
}
double floor_reach(const ConePlan& p) { return p.floor_radius + 2 * p.radius; }

// Free grains that a chain of contacts ties to the floor, which is the first wall, or to fixed
// grains.
std::vector<const Grain*> lying_grains(const Snapshot& s) {
  std::vector<std::vector<std::size_t>> touched(s.grains.size());
  std::vector<bool> lies(s.grains.size(), false);
  std::vector<std::size_t> open;
  const auto add = [&](std::size_t k) {
    if (lies[k]) return;
    lies[k] = true;
    open.push_back(k);
  };
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    if (s.grains[k].fixed) add(k);
  }
  for (const Contact& c : s.contacts) {
    const auto i = static_cast<std::size_t>(c.i);
    if (c.j == -1) add(i);
    if (c.j < 0) continue;
    touched[i].push_back(static_cast<std::size_t>(c.j));
    touched[static_cast<std::size_t>(c.j)].push_back(i);
  }
  while (!open.empty()) {
    const std::size_t k = open.back();
    open.pop_back();
    for (const std::size_t other : touched[k]) add(other);
  }
  std::vector<const Grain*> out;
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    if (lies[k] && !s.grains[k].fixed) out.push_back(&s.grains[k]);
  }
  return out;
}

// Height of the cone of all grains; of the cylinder that they fill.
double expected_height(const ConePlan& p) {
  if (p.source == "cylinder") return filled_height(p);
  const double volume = mean_volume(as_sample(p)) / kHeapFraction;
  return std::cbrt(3 * kHeapSlope * kHeapSlope * volume / std::numbers::pi);
}

// The speed of a grain that falls onto the heap, m/s.
double meeting_speed(const ConeSetup& s) {
  const double fall = s.plan.drop + kColumn * sample_radii(as_sample(s.plan)).most;
  return std::sqrt(s.plan.speed * s.plan.speed + 2 * s.material.gravity * fall);
}

void check_order(const char* less, double least, const char* more, double most) {
  if (least <= most) return;
  refuse(std::string("cone.") + less,
         fmt::format("found {:g}, allowed: up to cone.{} = {:g}", least, more, most));
}

}  // namespace

void ConeGroundwork::check(const Setup& s) {
  const ConePlan& p = s.plan;
  if (s.motion.integrator != "verlet") {
    throw std::invalid_argument(
        fmt::format("motion.integrator: found \"{}\", allowed with study = \"cone\": verlet",
                    s.motion.integrator));
  }
  if (s.motion.energy_balance) {
    throw std::invalid_argument(
        "motion.energy_balance: found true, allowed with study = \"cone\": false (grains that "
        "leave the floor are taken away)");
  }
  if (!is_sphere(p)) {
    if (p.source == "cylinder") {
      refuse("cone.source",
             "found cylinder, allowed with cone.shape = superellipsoid: point | rain (walls of "
             "superellipsoids are planes)");
    }
    check_superellipsoid_material(s.material);
    check_order("axis_min", p.axis_min, "axis_max", p.axis_max);
    check_order("exponent_min", p.exponent_min, "exponent_max", p.exponent_max);
  }
  // The speed itself is to blame where grains start higher or faster than any need to.
  const double height = expected_height(p), fall = height + kHighFall * p.radius;
  const double usual = std::sqrt(2 * s.material.gravity * fall);
  check_stiff_enough(s.material, {p.radius, height, std::min(usual, meeting_speed(s))});
  const double most = sample_radii(as_sample(p)).most;
  const auto at_least = [&](const char* key, double found, double least, const char* why) {
    if (found >= least) return;
    refuse(std::string("cone.") + key,
           fmt::format("found {:g}, allowed: at least {:.4g} m, {}", found, least, why));
  };
  const bool cylinder = p.source == "cylinder";
  if (p.source != "rain") {
    at_least("mouth", p.mouth, (cylinder ? 3 : 1) * most,
             cylinder ? "three of the largest radii" : "the largest radius");
  }
  at_least("floor_radius", p.floor_radius, std::max(10 * most, p.source == "rain" ? 0 : p.mouth),
           "ten of the largest radii and as wide as cone.mouth");
  at_least("drop", p.drop, 2 * most, "twice the largest radius");
  const double fixed = floor_grains_of(p);
  if (fixed > kMostGrains) {
    refuse("cone.floor_radius",
           fmt::format("found {:g}, allowed: up to {:.3g} m with grains of this "
                       "size on a rough floor: ten million grains",
                       p.floor_radius, p.floor_radius * std::sqrt(kMostGrains / fixed)));
  }
}

void check_cylinder(const ConeSetup& s, double start) {
  const double rim = cone_walls(s, true).back().length;
  if (start <= rim) return;
  throw ComputationFailed(fmt::format(
      "the grains stand higher in the cylinder than expected: the next would start at {:.3g} m, "
      "above its rim at {:.3g} m; raise cone.mouth",
      start, rim));
}

std::vector<ShapedGrain> ConeGroundwork::draw(const Setup& s, Random& random,
                                              Allowance& allowance) {
  return draw_sample(as_sample(s.plan), random, allowance);
}

EngineSettings ConeGroundwork::settings(const Setup& s, const std::vector<ShapedGrain>& grains,
                                        double reserve) {
  const ConePlan& p = s.plan;
  std::vector<ShapedGrain> all = grains;
  if (!is_sphere(p)) all.emplace_back().axes.fill(p.radius);  // the floor's
  const GrainExtremes extremes = sample_extremes(as_sample(p), s.material.density, all);
  EngineSettings out =
      engine_settings(s.material, s.motion, extremes, 1, false, reserve,
                      is_sphere(p) ? ShapeKind::sphere : ShapeKind::superellipsoid);
  out.gravity_y = 0;
  out.gravity_z = -s.material.gravity;
  out.sleep = s.sleep;
  check_background_damping(s.rest, out.time_step);
  check_countable("cone.rate", p.grains / p.rate, out.time_step);
  const double most = kMostWay * sample_radii(as_sample(p)).least / out.time_step;
  const auto check_speed = [&](const char* key, double found, double speed) {
    if (speed <= most) return;
    refuse(std::string("cone.") + key,
           fmt::format("found {:g}, allowed: so that nothing moves at more than {:.3g} m/s, a "
                       "quarter of the least radius in a step of {:.3g} s",
                       found, most, out.time_step));
  };
  if (p.source == "cylinder") check_speed("lift_speed", p.lift_speed, p.lift_speed);
  check_speed("speed", p.speed, p.speed);
  check_speed("drop", p.drop, meeting_speed(s));
  if (p.source == "cylinder") {
    check_countable("cone.lift_speed", filled_height(p) / p.lift_speed, out.time_step);
  }
  return out;
}

Outlook ConeGroundwork::outlook(const Setup& s, const EngineSettings& settings) {
  const ConePlan& p = s.plan;
  // What only an engine refuses.
  const std::unique_ptr<Engine> engine = make_engine(settings);
  for (const Wall& wall : cone_walls(s, p.source == "cylinder")) engine->add_wall(wall);
  Outlook out;
  out.take_step(settings);
  out.grains = p.grains;
  out.fixed = floor_grains_of(p);
  out.bytes = (out.grains + out.fixed) * kBytesOfSphere;
  out.bytes_key = "cone.grains";
  Times times;
  times.add("cone.rate", p.grains / p.rate);
  if (p.source == "cylinder") times.add("cone.lift_speed", filled_height(p) / p.lift_speed);
  times.put_into(out);
  return out;
}

std::vector<NewGrain> cone_floor(const ConePlan& p, double density) {
  std::vector<NewGrain> out;
  if (p.floor != "rough") return out;
  const double spacing = floor_spacing(p), reach = floor_reach(p);
  const double row = spacing * std::numbers::sqrt3 / 2;
  const int rows = static_cast<int>(reach / row), along = static_cast<int>(reach / spacing) + 1;
  for (int j = -rows; j <= rows; ++j) {
    for (int i = -along; i <= along; ++i) {
      NewGrain g;
      g.x = spacing * (i + 0.5 * (j & 1));
      g.y = row * j;
      if (std::hypot(g.x, g.y) > reach) continue;
      g.z = -p.radius;
      g.radius = p.radius;
      g.density = density;
      g.fixed = true;
      if (!is_sphere(p)) g.axes.fill(p.radius);
      out.push_back(g);
    }
  }
  return out;
}

double floor_grains_of(const ConePlan& p) {
  if (p.floor != "rough") return 0;
  const double over = floor_reach(p) / floor_spacing(p);
  return 2 * std::numbers::pi / std::numbers::sqrt3 * over * over;
}

std::vector<Wall> cone_walls(const ConeSetup& s, bool with_cylinder) {
  const ConePlan& p = s.plan;
  Wall floor;
  floor.name = "floor";
  floor.point = Vec3(0, 0, p.floor == "rough" ? -4 * p.radius : 0);
  floor.normal = Vec3::UnitZ();
  floor.friction = s.material.floor_friction;
  std::vector<Wall> out{floor};
  if (!with_cylinder) return out;
  Wall cylinder;
  cylinder.name = "cylinder";
  cylinder.shape = "cylinder";
  cylinder.normal = Vec3::UnitZ();
  cylinder.radius = p.mouth;
  cylinder.length = filled_height(p) + p.drop + 12 * sample_radii(as_sample(p)).most;
  cylinder.friction = s.material.wall_friction;
  out.push_back(cylinder);
  return out;
}

double source_radius(const ConePlan& p) { return p.source == "rain" ? p.floor_radius : p.mouth; }

double filled_height(const ConePlan& p) {
  return mean_volume(as_sample(p)) / (kLoosest * std::numbers::pi * p.mouth * p.mouth);
}

NewGrain placed_grain(const ShapedGrain& grain, double x, double y, double z, double density) {
  NewGrain out = grain.at(x, y, density);
  out.z = z;
  return out;
}

double resting_height(const Snapshot& s) {
  double top = 0;
  for (const Grain* g : lying_grains(s)) top = std::max(top, top_3d(*g));
  return top;
}

double top_within(const Snapshot& s, double radius) {
  double top = 0;
  for (const Grain& g : s.grains) {
    if (!g.fixed && g.position.head<2>().norm() < radius) {
      top = std::max(top, top_3d(g));
    }
  }
  return top;
}

LocalTops::LocalTops(const Snapshot& s, double half, double cell)
    : half_(half),
      count_(static_cast<int>(std::clamp(std::floor(2 * half / cell), 1.0, kMostCells))) {
  cell_ = 2 * half / count_;
  top_.assign(static_cast<std::size_t>(count_) * static_cast<std::size_t>(count_), 0.0);
  for (const Grain* g : lying_grains(s)) {
    double& top = top_[static_cast<std::size_t>(cell_of(g->position.y()) * count_ +
                                                cell_of(g->position.x()))];
    top = std::max(top, top_3d(*g));
  }
}

int LocalTops::cell_of(double x) const {
  return std::clamp(static_cast<int>((x + half_) / cell_), 0, count_ - 1);
}

double LocalTops::at(double x, double y) const {
  double top = 0;
  for (int j = std::max(0, cell_of(y) - 1); j <= std::min(count_ - 1, cell_of(y) + 1); ++j) {
    for (int i = std::max(0, cell_of(x) - 1); i <= std::min(count_ - 1, cell_of(x) + 1); ++i) {
      top = std::max(top, top_[static_cast<std::size_t>(j * count_ + i)]);
    }
  }
  return top;
}

FreePlaces::FreePlaces(const Snapshot& s, double largest) : cell_(2 * largest) {
  for (const Grain& g : s.grains) {
    if (!g.fixed) put({g.position.x(), g.position.y(), g.position.z(), g.radius});
  }
}

std::array<std::int64_t, 3> FreePlaces::cell_of(double x, double y, double z) const {
  const auto along = [this](double at) {
    return static_cast<std::int64_t>(std::floor(at / cell_));
  };
  return {along(x), along(y), along(z)};
}

void FreePlaces::put(const Ball& ball) { balls_[cell_of(ball.x, ball.y, ball.z)].push_back(ball); }

bool FreePlaces::take(double x, double y, double z, double radius) {
  const auto [i, j, k] = cell_of(x, y, z);
  for (std::int64_t a = i - 1; a <= i + 1; ++a) {
    for (std::int64_t b = j - 1; b <= j + 1; ++b) {
      for (std::int64_t c = k - 1; c <= k + 1; ++c) {
        const auto there = balls_.find({a, b, c});
        if (there == balls_.end()) continue;
        for (const Ball& ball : there->second) {
          if (std::hypot(ball.x - x, ball.y - y, ball.z - z) < ball.radius + radius) return false;
        }
      }
    }
  }
  put({x, y, z, radius});
  return true;
}

bool has_left(const Grain& g, const ConePlan& p) {
  return g.position.head<2>().norm() > p.floor_radius || g.position.z() < -2 * p.radius;
}

void keep_on_floor(const ConePlan& plan, bool with_cylinder, Snapshot& s) {
  std::vector<std::int64_t> now(s.grains.size(), -1);
  std::vector<Grain> kept;
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    Grain& g = s.grains[k];
    if (!g.fixed && has_left(g, plan)) continue;
    g.id = now[k] = static_cast<std::int64_t>(kept.size());
    kept.push_back(g);
  }
  s.grains = std::move(kept);
  if (!with_cylinder) s.walls.resize(1);
  const auto walls = static_cast<std::int64_t>(s.walls.size());
  std::vector<Contact> contacts;
  for (Contact c : s.contacts) {
    const bool wall = c.j < 0;
    c.i = now[static_cast<std::size_t>(c.i)];
    if (!wall) c.j = now[static_cast<std::size_t>(c.j)];
    const bool stays = c.i >= 0 && (wall ? -1 - c.j < walls : c.j >= 0);
    if (stays) contacts.push_back(c);
  }
  s.contacts = std::move(contacts);
}

}  // namespace grainfield::dem
