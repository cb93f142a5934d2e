// The tangential spring of superellipsoids: it turns with the material, exactly; its increments are
// along the axes of the contact ellipse as it is.
#include <gmock/gmock.h>

#include <numbers>

#include "dem/engine/interaction.h"
#include "dem/laws/hertz_elliptic.h"
#include "dem/shapes/superellipsoid_store.h"
#include "dem/space/kinematics3.h"
#include "tests/dem/superellipsoid_scene.h"

namespace grainfield::dem {
namespace {

using Eigen::Vector3d;
using Acting = Interaction<SuperellipsoidStore, HertzEllipticLaw>;

const HertzEllipticLaw kLaw{1e6, 0.3, 1};

Overlap3 overlap_at(double depth, double ratio) {
  Overlap3 o;
  o.normal = Vector3d(1, 2, 2) / 3;
  o.major = Vector3d(2, 1, -2) / 3;
  o.depth = depth;
  o.radius = 0.5;
  o.lesser_curvature = 1;
  o.greater_curvature = ratio;
  return o;
}
Body<3> body_with(const Vector3d& velocity, const Vector3d& spin) {
  Body<3> b;
  b.velocity = velocity;
  b.spin = spin;
  b.inverse_mass = 1;
  b.inverse_inertia = 1;
  return b;
}

TEST(EllipticSpring, TurnsAreExact) {
  Random random(1);
  for (const double angle : {1e-9, 1e-4, 0.0999, 0.1001, 1.0, 3.0}) {
    for (int k = 0; k < 100; ++k) {
      const Vector3d turn = angle * random_direction(random), v = random_direction(random);
      EXPECT_NEAR((turned_by(turn, v) - quaternion_of(turn) * v).norm(), 0, 2e-15) << angle;
    }
  }
}

// The same history of depth, slip and of the ellipse, at rest and seen by one who tumbles: both
// bodies spin alike, and the force is the same one turned, whatever the ellipse does.
TEST(EllipticSpring, IsTheSameForOneWhoTumbles) {
  for (const double friction : {0.2, 50.0}) {
    Random random(2);
    Acting::Rule rule;
    rule.law = kLaw;
    rule.friction = friction;
    const double dt = 1e-3;
    HertzMemory<3> still, tumbles;
    RotationOf<3> turn = RotationOf<3>::Identity();
    double most = 0;
    int slid = 0;
    for (int step = 0; step < 2000; ++step) {
      Overlap3 o = overlap_at(1e-3 * (1.5 + std::sin(0.01 * step)), 3 + std::cos(0.003 * step));
      const Vector3d minor = o.normal.cross(o.major);
      const double way = 0.002 * step;
      o.major = std::cos(way) * o.major + std::sin(way) * minor;
      const Vector3d velocity = 0.02 * random_direction(random);
      const auto force = Acting::force(rule, body_with(velocity, Vector3d::Zero()),
                                       body_with(Vector3d::Zero(), Vector3d::Zero()), o, dt, still);
      const Vector3d spin = random.uniform(0, 30) * random_direction(random);
      turn = quaternion_of(dt * spin) * turn;
      turn.normalize();
      Overlap3 seen = o;
      seen.normal = turn * o.normal;
      seen.major = turn * o.major;
      const auto again = Acting::force(rule, body_with(turn * velocity, spin),
                                       body_with(Vector3d::Zero(), spin), seen, dt, tumbles);
      most = std::max(most, (again.force - turn * force.force).norm() / force.force.norm());
      const double along = tangential_of(force.force, o).norm();
      slid += along > 0.999 * friction * repulsion_of(force.force, o) ? 1 : 0;
    }
    EXPECT_LT(most, 1e-12);
    EXPECT_EQ(slid > 100, friction < 1);
    EXPECT_GT(still.spring.norm(), 1e-3);
  }
}

// An ellipse that turns against the material: the force stays where it is, and what is added goes
// by the compliances along the axes as they are now.
TEST(EllipticSpring, IncrementsAreAlongThePresentAxes) {
  Acting::Rule rule;
  rule.law = kLaw;
  rule.friction = 1e6;
  const double dt = 1e-4;
  Overlap3 o = overlap_at(1e-3, 8);
  const Body<3> rest = body_with(Vector3d::Zero(), Vector3d::Zero());
  HertzMemory<3> memory;
  const Vector3d first = 0.01 * o.major;
  Acting::force(rule, body_with(first, Vector3d::Zero()), rest, o, dt, memory);
  const Vector3d before = memory.spring;
  o.major = turned_by(0.7 * o.normal, o.major);
  Acting::force(rule, rest, rest, o, dt, memory);
  EXPECT_NEAR((memory.spring - before).norm(), 0, 1e-15 * before.norm());
  const EllipticContact ellipse = kLaw.ellipse(o);
  const auto c = kLaw.compliances(ellipse.shape.integrals, ellipse.axis * std::sqrt(o.depth));
  const Vector3d minor = o.normal.cross(o.major), slip = 0.02 * o.major + 0.03 * minor;
  Acting::force(rule, body_with(slip, Vector3d::Zero()), rest, o, dt, memory);
  const Vector3d added = memory.spring - before;
  EXPECT_NEAR(added.dot(o.major), -0.02 * dt / c.major, 1e-12 * before.norm());
  EXPECT_NEAR(added.dot(minor), -0.03 * dt / c.minor, 1e-12 * before.norm());
  EXPECT_GT(c.major, 1.05 * c.minor);
}

// Next to round the axes may point anywhere, and turn by a right angle from step to step: the force
// is that of a round one within what the ellipse is not round by.
TEST(EllipticSpring, LeapsNowhereWhereTheEllipseIsNextToRound) {
  Acting::Rule rule;
  rule.law = kLaw;
  rule.friction = 1e6;
  for (const double off : {1e-3, 1e-6, 1e-9}) {
    Random random(4);
    HertzMemory<3> round, next;
    double most = 0;
    for (int step = 0; step < 500; ++step) {
      const Overlap3 o = overlap_at(1e-3, 1);
      Overlap3 other = overlap_at(1e-3, 1 + off);
      other.major = turned_by(random.uniform(0, 2 * std::numbers::pi) * o.normal, o.major);
      const Vector3d spin = random_direction(random);
      const Body<3> a = body_with(random_direction(random), spin), b = body_with({0, 0, 0}, spin);
      // In the frame that turns with them the normal stays.
      Acting::force(rule, a, b, o, 1e-4, round);
      Acting::force(rule, a, b, other, 1e-4, next);
      most = std::max(most, (round.spring - next.spring).norm() / round.spring.norm());
    }
    EXPECT_LT(most, 2 * off);
  }
}

}  // namespace
}  // namespace grainfield::dem
