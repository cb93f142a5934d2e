// The energy law: its force is the gradient of what it stores, whatever the outlines do.
#include <gmock/gmock.h>

#include <cstdio>
#include <numbers>

#include "dem/laws/energy.h"
#include "dem/laws/overlap_area.h"
#include "dem/random/random.h"
#include "tests/dem/polygon_scene.h"

namespace grainfield::dem {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

struct Outlines {
  Outline a, b;
  double equal_a = 0, equal_b = 0;
};

Outline ngon(Random& random, int corners, double stretch) {
  Outline out;
  for (int k = 0; k < corners; ++k) {
    const double t = kTwoPi * (k + random.uniform(-0.3, 0.3)) / corners;
    out.push_back({stretch * std::cos(t), std::sin(t) / stretch});
  }
  return centred_outline(out);
}

/// A closed path of B against A: an ellipse about a place, and an angle that swings or goes round.
struct Path {
  double x = 0, y = 0, along = 0, across = 0, angle = 0, swing = 0, phase = 0;
  int rounds = 0;

  struct Pose {
    double x, y, angle;
  };
  Pose at(double t) const {
    return {x + along * std::cos(t), y + across * std::sin(t),
            angle + rounds * t + swing * std::sin(t + phase)};
  }
};

int crossings_of(const Outline& a, const Outline& b) {
  const auto side = [](const auto& p, const auto& q, const auto& r) {
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) > 0;
  };
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < b.size(); ++k) {
      const auto &p = a[i], &q = a[(i + 1) % a.size()], &r = b[k], &s = b[(k + 1) % b.size()];
      count += side(p, q, r) != side(p, q, s) && side(r, s, p) != side(r, s, q);
    }
  }
  return count;
}

struct Loop {
  double work = 0;    ///< on B, J
  double stored = 0;  ///< largest, J
  int crossings = 0;  ///< most
};

/// The work of the law's force and torque on B round the path, by the midpoint rule.
template <class Law>
Loop round(const Law& law, const Outlines& shapes, const Path& path, int steps) {
  Loop out;
  const Placed a(shapes.a, 0, 0);
  ContactMotion<2> at_rest;
  at_rest.inverse_mass = 1;
  for (int k = 0; k < steps; ++k) {
    const auto begin = path.at(kTwoPi * k / steps), end = path.at(kTwoPi * (k + 1) / steps),
               middle = path.at(kTwoPi * (k + 0.5) / steps);
    const Placed b(shapes.b, middle.x, middle.y, middle.angle);
    Overlap o;
    PairFeature feature;
    if (!overlap_of_shapes(a.shape(), b.shape(), feature, o, Law::measures)) continue;
    if constexpr (Law::measures == Measures::gradient) {
      set_constant_length(shapes.equal_a, shapes.equal_b, o);
    }
    SpringMemory<2> memory;
    const ContactForce<2> f = forces_at<false>(o, law(o, at_rest, 0, 0, memory).normal, 0);
    out.work += -f.force.x() * (end.x - begin.x) - f.force.y() * (end.y - begin.y) +
                f.torque_j * (end.angle - begin.angle);
    out.stored = std::max(out.stored, law.energy(o, memory).total());
    if (k % 50 == 0)
      out.crossings = std::max(out.crossings, crossings_of(a.corners(), b.corners()));
  }
  return out;
}

// Issue of the law: random outlines, slender ones and bars that cross among them. Roul's law is
// shown beside.
TEST(EnergyLaw, ClosedLoopsDoNoWork) {
  EnergyLaw square, power;
  power.power = true;
  const OverlapAreaLaw roul;
  Random random(7);
  double worst_square = 0, worst_power = 0, worst_roul = 0, sum_roul = 0;
  int loops = 0, many = 0;
  while (loops < 1000) {
    const bool bars = loops % 4 == 3;
    const auto corners = [&] { return 3 + static_cast<int>(6 * random.uniform()); };
    const auto stretch = [&] { return bars ? 2.2 : random.uniform(1, 1.6); };
    Outlines s;
    s.a = ngon(random, bars ? 4 : corners(), stretch());
    s.b = ngon(random, bars ? 4 : corners(), stretch());
    s.equal_a = equal_radius(area_of(s.a));
    s.equal_b = equal_radius(area_of(s.b));
    Path path;
    const double away = bars ? random.uniform(0, 1) : random.uniform(1.2, 1.8);
    const double where = random.uniform(0, kTwoPi);
    path.x = away * std::cos(where);
    path.y = away * std::sin(where);
    path.along = random.uniform(0.05, 0.4);
    path.across = random.uniform(0.05, 0.4);
    path.angle = random.uniform(0, kTwoPi);
    path.swing = random.uniform(0, 1);
    path.phase = random.uniform(0, kTwoPi);
    path.rounds = loops % 5 == 0 ? 1 : 0;
    const Loop coarse = round(square, s, path, 500);
    if (coarse.stored < 1e-4 * square.young) continue;  // they hardly met
    ++loops;
    // Where sides pass each other in parallel the force leaps: the rule's error halves with its
    // step.
    const auto worst_of = [&](const auto& law) {
      Loop found = round(law, s, path, 8000);
      if (std::fabs(found.work) > 1e-5 * found.stored) found = round(law, s, path, 200000);
      EXPECT_LT(std::fabs(found.work), 1e-5 * found.stored) << law.name << " " << loops;
      return std::fabs(found.work) / found.stored;
    };
    many += coarse.crossings > 2;
    const Loop r = round(roul, s, path, 1000);
    worst_square = std::max(worst_square, worst_of(square));
    worst_power = std::max(worst_power, worst_of(power));
    worst_roul = std::max(worst_roul, std::fabs(r.work) / r.stored);
    sum_roul += std::fabs(r.work) / r.stored / 1000;
  }
  EXPECT_GT(many, 100);
  EXPECT_GT(worst_roul, 0.1);  // what it is for
  std::printf(
      "work over largest stored energy, 1000 loops (%d with more than two crossings): "
      "square %.1e, power %.1e at most; overlap_area %.2g at most, %.2g in the mean\n",
      many, worst_square, worst_power, worst_roul, sum_roul);
}

// R = -dU/dx, by differences, through both branches of the power.
TEST(EnergyLaw, SlopeIsTheDerivativeOfWhatIsStored) {
  for (const bool power : {false, true}) {
    EnergyLaw law;
    law.power = power;
    for (double a = 1e-5; a < 1; a *= 1.3) {
      const double h = 1e-5 * a;
      EXPECT_NEAR((law.stored(a + h) - law.stored(a - h)) / (2 * h) / law.slope(a), 1, 1e-8) << a;
    }
    EXPECT_EQ(law.slope(0), 0);
    const double limit = law.linear_share;
    EXPECT_NEAR(law.slope(limit * (1 - 1e-12)) / law.slope(limit), 1, 1e-11);
  }
}

// physics.md section 2: ratios to Roul's law for two equal disks, with l0 for l and with his l.
TEST(EnergyLaw, ThePowerIsRoulsLawForDisks) {
  EnergyLaw law;
  law.power = true;
  law.linear_share = 1e-6;
  for (const auto& [overlap, fixed, moving] :
       {std::array{0.001, 0.9999, 0.9994}, std::array{0.05, 0.995, 0.970}}) {
    Overlap o;
    ASSERT_TRUE(overlap_of_disks<true>(2 - overlap, 0, 1, 1, o));
    const double roul = law.young * o.area / o.length;
    o.length = 0.5;
    ContactMotion<2> at_rest;
    at_rest.inverse_mass = 1;
    SpringMemory<2> memory;
    const double force = law(o, at_rest, 0, 0, memory).normal;
    EXPECT_NEAR(force / (law.young * o.area / o.length), fixed, 6e-4) << overlap;
    EXPECT_NEAR(force / roul, moving, 6e-4) << overlap;
  }
}

// Two squares edge on edge over their whole sides: k = E c^2/l0^2.
TEST(EnergyLaw, StiffnessEdgeOnEdge) {
  const Outline square = box(1, 1);
  const double equal = equal_radius(1), width = edge_width(square);
  EXPECT_DOUBLE_EQ(width, 2 / equal);
  for (const bool power : {false, true}) {
    EnergyLaw law;
    law.power = power;
    const auto force = [&](double depth) {
      Overlap o;
      PairFeature feature;
      const Placed a(square, 0, 0), b(square, 1 - depth, 0);
      EXPECT_TRUE(overlap_of_shapes(a.shape(), b.shape(), feature, o, Measures::gradient));
      set_constant_length(equal, equal, o);
      ContactMotion<2> at_rest;
      at_rest.inverse_mass = 1;
      SpringMemory<2> memory;
      EXPECT_NEAR(o.chord, 1, 1e-9);
      return law(o, at_rest, 0, 0, memory).normal;
    };
    const double depth = 1e-5, slope = (force(2 * depth) - force(depth)) / depth;
    EXPECT_NEAR(4 * slope / law.edge_stiffness(width), 1, 1e-6);
  }
}

}  // namespace
}  // namespace grainfield::dem
