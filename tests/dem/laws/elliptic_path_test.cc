// The force of Hertz' and Mindlin's law along random ways of two superellipsoids that slide and
// roll on each other: it leaps nowhere, neither by its curvatures nor by its friction.
#include <gmock/gmock.h>

#include "dem/engine/interaction.h"
#include "dem/laws/hertz_elliptic.h"
#include "dem/shapes/superellipsoid_store.h"
#include "tests/dem/superellipsoid_scene.h"

namespace grainfield::dem {
namespace {

using Eigen::Vector3d;
using Acting = Interaction<SuperellipsoidStore, HertzEllipticLaw>;

constexpr double kDepth = 5e-3;  // at the start; semi-axes are 0.5 to 1.5
constexpr int kSteps = 2000;     // of a way

/// Two bodies in touch that turn, the second of which moves beside the first.
struct Way {
  SuperellipsoidStore store;
  std::array<Body<3>, 2> bodies;
  std::array<RotationOf<3>, 2> turns;
  Vector3d start = Vector3d::Zero();

  explicit Way(Random& random, double slide, double roll) {
    for (int k = 0; k < 2; ++k) {
      const Superellipsoid shape = random_superellipsoid(random, 0.7, 1.3);
      const Solid<3> solid =
          store.add({0, {}, {shape.axes.x(), shape.axes.y(), shape.axes.z()}, shape.exponents});
      bodies[k].radius = solid.radius;
      bodies[k].inverse_mass = bodies[k].inverse_inertia = 1;
      bodies[k].spin = roll * random_direction(random);
      turns[k] = random_rotation(random);
    }
    const Vector3d way = random_direction(random);
    start = in_touch(way);
    bodies[1].velocity = slide * start.cross(random_direction(random)).normalized();
  }

  bool overlap(const Vector3d& across, double t, PairNormal& memory, Overlap3& o) {
    bodies[1].position = across;
    for (int k = 0; k < 2; ++k) {
      store.place(k, bodies[k], quaternion_of(t * bodies[k].spin) * turns[k]);
    }
    return store.overlap<Measures::curvatures>(0, bodies[0], 1, bodies[1], memory, o);
  }
  bool at(double t, PairNormal& memory, Overlap3& o) {
    return overlap(start + t * bodies[1].velocity, t, memory, o);
  }

 private:
  Vector3d in_touch(const Vector3d& way) {
    double low = 0, high = bodies[0].radius + bodies[1].radius;
    for (int n = 0; n < 40; ++n) {
      const double middle = 0.5 * (low + high);
      PairNormal memory;
      Overlap3 o;
      (overlap(middle * way, 0, memory, o) && o.depth > kDepth ? low : high) = middle;
    }
    return low * way;
  }
};

/// A pair on its way, with all that it remembers.
struct State {
  PairNormal normal;
  HertzMemory<3> memory;
  Vector3d force = Vector3d::Zero();
  double gamma = 0;  ///< 0: apart
  bool slides = false;
};

void advance(Way& way, double t, double dt, State& state) {
  Acting::Rule rule;
  rule.law = HertzEllipticLaw{1e6, 0.3, 0.3};
  rule.friction = 0.4;
  Overlap3 o;
  if (!way.at(t, state.normal, o)) {
    state.memory = {};
    state.force.setZero();
    state.gamma = 0;
    return;
  }
  state.force = Acting::force(rule, way.bodies[0], way.bodies[1], o, dt, state.memory).force;
  state.gamma = rule.law.ellipse(o).gamma;
  const double along = std::fabs(state.force.dot(o.normal));
  state.slides = (state.force - state.force.dot(o.normal) * o.normal).norm() > 0.399 * along;
}

/// The step of a way in which a quantity changes most.
struct Steepest {
  double change = 0;
  int step = 0;
  State before;

  void look(double found, int at, const State& from) {
    if (found <= change) return;
    *this = {found, at, from};
  }
};

/// The largest change of `of` in a part of that step, taken in kParts.
template <typename Change>
double steepest_part(Way& way, const Steepest& found, const Change& change) {
  constexpr int kParts = 256;
  State now = found.before;
  double most = 0;
  for (int p = 1; p <= kParts; ++p) {
    const State before = now;
    const double part = 1.0 / (kSteps * kParts);
    advance(way, (found.step - 1.0) / kSteps + p * part, part, now);
    most = std::max(most, change(before, now));
  }
  return most;
}

double force_change(const State& a, const State& b) { return (b.force - a.force).norm(); }
double gamma_change(const State& a, const State& b) {
  return a.gamma > 0 && b.gamma > 0 ? std::fabs(b.gamma - a.gamma) : 0;
}

// The steepest step of each way, taken in 256 parts: none of them changes the force or gamma by
// more than half a percent of itself, where a leap would be whole. What changes most there are
// curvatures that go as |x|^(2/e - 2), which for e next to 1 is nearly a leap, and those that come
// to their bound.
TEST(EllipticPath, ForceLeapsNowhereAsPairsSlideAndRoll) {
  Random random(9);
  int touching = 0, sliding = 0;
  double force_part = 0, gamma_part = 0;
  for (const auto& [slide, roll] : {std::pair(0.2, 0.0), {0.0, 0.3}, {0.1, 0.2}}) {
    for (int k = 0; k < 60; ++k) {
      Way way(random, slide, roll);
      Steepest force, gamma;
      State now;
      advance(way, 0, 1.0 / kSteps, now);
      for (int s = 1; s <= kSteps; ++s) {
        const State before = now;
        advance(way, 1.0 * s / kSteps, 1.0 / kSteps, now);
        force.look(force_change(before, now), s, before);
        gamma.look(gamma_change(before, now), s, before);
        touching += now.gamma > 0 ? 1 : 0;
        sliding += now.gamma > 0 && now.slides ? 1 : 0;
      }
      force_part =
          std::max(force_part, steepest_part(way, force, force_change) / force.before.force.norm());
      gamma_part =
          std::max(gamma_part, steepest_part(way, gamma, gamma_change) / gamma.before.gamma);
    }
  }
  EXPECT_GT(touching, 180 * kSteps / 10);
  EXPECT_GT(sliding, touching / 10);
  EXPECT_LT(force_part, 1e-2);
  EXPECT_LT(gamma_part, 1e-2);
}

}  // namespace
}  // namespace grainfield::dem
