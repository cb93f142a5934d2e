#include "coupling/studies/sample/simulation/servo.h"

#include <cmath>
#include <numbers>

#include "coupling/studies/sample/simulation/grains.h"
#include "dem/engine/pair_contact.h"

namespace grainfield::dem {
namespace {

// Mean force of a contact over p r (2D) and p r^2 (3D): p = (1/(dim V)) sum f l, with solid
// fractions of 0.8 and 0.6 and four and five contacts a grain.
constexpr double kForce2 = 2, kForce3 = 4;
// Three edges of a cell that are held at once are answered by the bulk stiffness of all contacts,
// nu Z/pi times k/2r for round grains of solid fraction nu with Z contacts each. Of spheres it is
// at most 0.64 * 6/pi = 1.2, which the servo bears (it overshoots above 1, and swings above 2
// without end); of superellipsoids prepared with little friction 0.7 * 8.7/pi = 1.9, and their
// contacts are flatter, hence stiffer, than those of two spheres.
constexpr double kBulkOfSuperellipsoids = 2.5;
// The share by which the depth is changed to see what the force answers.
constexpr double kNudge = 1e-3;

struct ContactAnswer {
  double stiffness = 0;  ///< N/m
  double dashpot = 0;    ///< N s/m
};

// A side faces +x, so that two such grains, one turned round, meet edge on edge.
Outline regular(double radius, int corners) {
  Outline out;
  for (int k = 0; k < corners; ++k) {
    const double angle = (2 * k + 1) * std::numbers::pi / corners;
    out.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return out;
}

// The answer of two mean grains pushed together until they push back with this force.
ContactAnswer answer_of(const SamplePlan& plan, const EngineSettings& settings, double density,
                        double force) {
  const double r = sample_radii(plan).mean;
  double touching = 2 * r;
  EngineSettings bare = settings;
  bare.rolling = {};
  if (bare.shape == ShapeKind::superellipsoid) bare.shape = ShapeKind::sphere;
  NewGrain grain;
  grain.radius = r;
  grain.density = density;
  if (settings.shape == ShapeKind::polygon) {
    const int corners = (plan.corners_min + plan.corners_max) / 2;
    grain.outline = regular(r, corners);
    touching *= std::cos(std::numbers::pi / corners);
  }
  const auto contact = make_pair_contact(bare, grain, grain);
  const auto push = [&](double depth, double speed) {
    PairState first, second;
    first.velocity.x() = speed;
    second.position.x() = touching - depth;
    second.angle = std::numbers::pi;
    contact->forget();
    return contact->at(first, second, 0).normal_force;
  };
  double low = 0, high = r;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (push(middle, 0) < force ? low : high) = middle;
  }
  const double here = push(high, 0), nudge = kNudge * high;
  // A speed whose dashpot force is small beside the elastic one stays within its linear range.
  double speed = 1;
  while (push(high, speed) > here * (1 + kNudge)) speed *= 0.5;
  return {(push(high + nudge, 0) - here) / nudge, (push(high, speed) - here) / speed};
}

}  // namespace

CellServo cell_servo_for(const SampleSetup& setup, const EngineSettings& settings) {
  const SamplePlan& plan = setup.plan;
  const double r = sample_radii(plan).mean;
  const double force = (plan.dim == 2 ? kForce2 * r : kForce3 * r * r) * plan.pressure;
  const ContactAnswer contact = answer_of(plan, settings, setup.material.density, force);
  CellServo servo;
  servo.modulus = contact.stiffness / (plan.dim == 2 ? 1 : 2 * r);
  if (plan.shape == "superellipsoid") servo.modulus *= kBulkOfSuperellipsoids;
  servo.slowness = contact.dashpot / contact.stiffness;
  servo.most = plan.compression_rate;
  return servo;
}

}  // namespace grainfield::dem
