// The stable time step of grains that lie edge on edge, the stiffest contacts there are: chains of
// light regular polygons, hemmed in between fixed ones and kicked, come to rest at the limit and
// run wild well above it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/engine/engine.h"
#include "dem/random/random.h"
#include "dem/shapes/polygon.h"

namespace grainfield::dem {
namespace {

struct Chain {
  int corners = 4;  ///< even: the opposite edges are parallel
  int length = 6;
  double radius = 0.01;    ///< of the inscribed circle, m
  double overlap = 0.005;  ///< that the kick leads to, in inscribed radii
  double density = 5000, young = 1e7, damping = 0.75, friction = 0.5;
  double turn = 0;  ///< direction of the chain, rad
  IntegratorKind integrator = IntegratorKind::verlet;
  std::uint64_t seed = 1;
};

// With an edge across the x axis on either side.
Outline regular(int corners, double inscribed) {
  Outline out;
  const double half = std::numbers::pi / corners, r = inscribed / std::cos(half);
  for (int k = 0; k < corners; ++k) {
    out.push_back({r * std::cos((2 * k + 1) * half), r * std::sin((2 * k + 1) * half)});
  }
  return centred_outline(out);
}

// Kicks the chain, whose grains touch without overlap, and runs `steps` steps of `share` times the
// limit: the largest kinetic energy seen over that of the kick. Diverging counts as infinite.
double highest_energy(const Chain& c, double share, long steps) {
  const Outline outline = regular(c.corners, c.radius);
  EngineSettings s;
  s.law = OverlapAreaLaw{c.young, c.damping};
  s.integrator = c.integrator;
  s.friction = c.friction;
  s.gravity_y = 0;
  s.shape = ShapeKind::polygon;
  const double mass = c.density * area_of(outline);
  s.time_step = share * stable_time_step(s, GrainExtremes{mass, edge_steepness(outline), mass});
  const auto engine = make_engine(s);
  Random random(c.seed);
  // In the time of a swing a grain moves `overlap` radii.
  const double speed = c.overlap * c.radius * std::sqrt(c.young / mass);
  const double cosine = std::cos(c.turn), sine = std::sin(c.turn);
  double kick = 0;
  for (int k = 0; k <= c.length + 1; ++k) {
    NewGrain g;
    const double along = k * c.radius * 2;
    g.x = cosine * along;
    g.y = sine * along;
    g.angle = c.turn;
    g.density = c.density;
    g.outline = outline;
    g.fixed = k == 0 || k == c.length + 1;
    if (!g.fixed) {
      g.vx = random.uniform(-speed, speed);
      g.vy = random.uniform(-speed, speed);
      g.spin = random.uniform(-speed, speed) / c.radius;
      kick += 0.5 * mass * (g.vx * g.vx + g.vy * g.vy) +
              0.5 * c.density * polar_moment_of(outline) * g.spin * g.spin;
    }
    engine->add(g);
  }
  double highest = 0;
  try {
    for (long k = 0; k < steps; k += 100) {
      engine->step(100);
      highest = std::max(highest, engine->measure().kinetic_energy / kick);
    }
  } catch (const ComputationFailed&) {
    return std::numeric_limits<double>::infinity();
  }
  return highest;
}

Chain random_chain(Random& random) {
  Chain c;
  c.corners = 4 + 2 * static_cast<int>(4 * random.uniform());
  c.length = 1 + static_cast<int>(8 * random.uniform());
  c.radius = std::pow(10, random.uniform(-3, -1));
  c.overlap = std::pow(10, random.uniform(-4, -1.5));
  c.density = std::pow(10, random.uniform(1, 4));
  c.young = std::pow(10, random.uniform(5, 9));
  c.damping = random.uniform(0.1, 2);
  c.friction = random.uniform() < 0.5 ? 0 : random.uniform(0, 1);
  c.turn = random.uniform(0, 6.28);
  c.seed = static_cast<std::uint64_t>(1e9 * random.uniform());
  return c;
}

// All energy is kinetic at first, grains part and meet again, and every contact dissipates: what is
// kinetic later is at most the kick. (Without damping the law itself is not conservative, at any
// step: E A/l along the normal is the force of a potential only while l and the chord stay.)
TEST(EdgeOnEdge, KickedChainsGainNoEnergyAtTheTimeStepLimit) {
  Random random(20);
  for (int k = 0; k < 400; ++k) {
    Chain c = random_chain(random);
    c.integrator = k % 4 == 3 ? IntegratorKind::gear : IntegratorKind::verlet;
    const double energy = highest_energy(c, 1, 1500);
    EXPECT_LE(energy, 1 + 1e-3) << k << ": " << c.corners << " corners, length " << c.length
                                << ", damping " << c.damping << ", friction " << c.friction
                                << ", overlap " << c.overlap << ", seed " << c.seed;
  }
}

// The worst case that the limit is made for, a long chain of squares: wild at four times the limit
// whatever the damping, tame at it.
TEST(EdgeOnEdge, LongChainsOfSquaresRunWildWellAboveTheLimit) {
  Chain c;
  c.length = 8;
  for (const double damping : {0.0, 0.1, 0.75, 2.0}) {
    c.damping = damping;
    c.integrator = IntegratorKind::verlet;
    EXPECT_LE(highest_energy(c, 1, 1500), 1 + 1e-3) << damping;
    EXPECT_GT(highest_energy(c, 4, 1500), 10) << damping;
    // Gear's limit is set by the dashpots.
    c.integrator = IntegratorKind::gear;
    EXPECT_LE(highest_energy(c, 1, 1500), 1 + 1e-3) << damping;
    if (damping > 0.5) {
      EXPECT_GT(highest_energy(c, 5, 1500), 10) << damping;
    }
  }
}

// Pressed together, a chain of damped squares between fixed ones on all sides comes to rest.
TEST(EdgeOnEdge, HemmedInSquaresComeToRestAtTheLimit) {
  const double side = 0.02;
  const Outline outline = regular(4, 0.5 * side);
  for (const double damping : {0.3, 0.75, 1.5}) {
    for (const double friction : {0.1, 0.5}) {
      EngineSettings s;
      s.law = OverlapAreaLaw{1e7, damping};
      s.friction = friction;
      s.gravity_y = 0;
      s.shape = ShapeKind::polygon;
      s.time_step = stable_time_step(
          s,
          GrainExtremes{5000 * area_of(outline), edge_steepness(outline), 5000 * area_of(outline)});
      const auto engine = make_engine(s);
      for (int i = 0; i <= 4; ++i) {
        for (int j = -1; j <= 1; ++j) {
          NewGrain g;
          g.x = i * 0.995 * side;
          g.y = j * 0.995 * side;
          g.density = 5000;
          g.outline = outline;
          g.fixed = i == 0 || i == 4 || j != 0;
          if (!g.fixed) g.vx = 1e-3 * (i - 1);
          engine->add(g);
        }
      }
      engine->step(6000);
      EXPECT_LT(engine->measure().kinetic_energy, 1e-20) << damping << " " << friction;
    }
  }
}

}  // namespace
}  // namespace grainfield::dem
