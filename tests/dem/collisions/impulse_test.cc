// The impulse of two round bodies against conservation laws, Liffman's scalars and closed forms of
// the energy lost, for random pairs of unlike mass, size and spin.
#include "dem/collisions/impulse.h"

#include <gtest/gtest.h>

#include "dem/random/random.h"
#include "dem/space/lever.h"

namespace grainfield::dem {
namespace {

constexpr int kPairs = 100000;
// Sums and differences of a dozen numbers of one size.
constexpr double kRoundOff = 2e-14;

template <int D>
VectorOf<D> random_vector(Random& random, double size) {
  VectorOf<D> out;
  for (int a = 0; a < D; ++a) out[a] = random.uniform(-size, size);
  return out;
}

template <int D>
SpinOf<D> random_spin(Random& random, double size) {
  if constexpr (D == 2) {
    return random.uniform(-size, size);
  } else {
    return random_vector<3>(random, size);
  }
}

template <int D>
Body<D> random_body(Random& random) {
  Body<D> out;
  out.radius = std::pow(10, random.uniform(-2, 2));
  const double mass = std::pow(10, random.uniform(-3, 3));
  out.inverse_mass = 1 / mass;
  out.inverse_inertia = 1 / round_inertia<D>(mass, out.radius);
  out.velocity = random_vector<D>(random, 3);
  out.spin = random_spin<D>(random, 3 / out.radius);
  return out;
}

template <int D>
struct Pair {
  Body<D> a, b;
  VectorOf<D> n;
  bool wall = false;
  double touching = 0;

  // The velocity of the first relative to the second where they touch.
  VectorOf<D> contact_velocity() const {
    return a.velocity + velocity_at(a.spin, VectorOf<D>(a.radius * n)) - b.velocity -
           velocity_at(b.spin, VectorOf<D>(-b.radius * n));
  }
  VectorOf<D> momentum() const { return a.velocity / a.inverse_mass + b.velocity / b.inverse_mass; }
  // About the point of contact, at the origin.
  SpinOf<D> angular_momentum() const {
    return a.spin / a.inverse_inertia + b.spin / b.inverse_inertia +
           torque_of(VectorOf<D>(-a.radius * n), VectorOf<D>(a.velocity / a.inverse_mass)) +
           torque_of(VectorOf<D>(b.radius * n), VectorOf<D>(b.velocity / b.inverse_mass));
  }
  double energy() const {
    const auto of = [](const Body<D>& g) {
      if (g.inverse_mass == 0) return 0.0;
      return 0.5 * g.velocity.squaredNorm() / g.inverse_mass +
             0.5 * square_of(g.spin) / g.inverse_inertia;
    };
    return of(a) + of(b);
  }
};

template <int D>
Pair<D> random_pair(Random& random) {
  Pair<D> p;
  p.a = random_body<D>(random);
  p.b = random_body<D>(random);
  p.n = random_vector<D>(random, 1).normalized();
  p.wall = random.uniform() < 0.2;
  if (p.wall) {
    p.b = Body<D>();
    p.b.velocity = random_vector<D>(random, 3);
  }
  if (p.contact_velocity().dot(p.n) < 0) p.n = -p.n;  // spins have no part along n
  return p;
}

template <int D>
void expect_laws() {
  Random random(20 + D);
  int slips = 0, walls = 0;
  for (int k = 0; k < kPairs; ++k) {
    const Pair<D> before = random_pair<D>(random);
    const ImpactLaw law{random.uniform(), random.uniform() < 0.1 ? 0 : random.uniform(0, 1.5)};
    Pair<D> after = before;
    const Impact<D> impact = collide<D>(after.a, after.b, before.n, law);

    const VectorOf<D> g = before.contact_velocity(), g_after = after.contact_velocity();
    const double approach = g.dot(before.n);
    const VectorOf<D> slip = g - approach * before.n;
    const double speeds = g.norm() + before.a.velocity.norm() + before.b.velocity.norm() +
                          before.a.radius * size_of(before.a.spin) +
                          before.b.radius * size_of(before.b.spin);
    EXPECT_NEAR(g_after.dot(before.n), -law.restitution * approach, kRoundOff * speeds) << k;

    const double m = 1 / (before.a.inverse_mass + before.b.inverse_mass);
    const double m_t = 1 / (1 / m + before.a.radius * before.a.radius * before.a.inverse_inertia +
                            before.b.radius * before.b.radius * before.b.inverse_inertia);
    const double push = m * (1 + law.restitution) * approach;
    double lost = 0.5 * m * (1 - law.restitution * law.restitution) * approach * approach;
    const VectorOf<D> slip_after = g_after - g_after.dot(before.n) * before.n;
    if (law.friction == 0) {
      EXPECT_EQ(after.a.spin, before.a.spin);
      EXPECT_LT((slip_after - slip).norm(), kRoundOff * speeds) << k;
    } else if (m_t * slip.norm() > law.friction * push) {
      ++slips;
      EXPECT_TRUE(impact.slips);
      EXPECT_NEAR(size_of(impact.tangential), law.friction * push, 3 * kRoundOff * m * speeds) << k;
      // Slower the same way, never reversed.
      EXPECT_NEAR(slip_after.dot(slip) / slip.norm(), slip.norm() - law.friction * push / m_t,
                  kRoundOff * speeds)
          << k;
      lost += law.friction * push * (slip.norm() - 0.5 * law.friction * push / m_t);
    } else {
      EXPECT_FALSE(impact.slips);
      EXPECT_LT(slip_after.norm(), kRoundOff * speeds) << k;
      lost += 0.5 * m_t * slip.squaredNorm();
    }
    EXPECT_NEAR(impact.lost, lost, kRoundOff * m * speeds * speeds) << k;
    if (before.wall) {
      ++walls;
      EXPECT_EQ(after.b.velocity, before.b.velocity);
      // The wall does work: in its frame the grain loses what the closed form says.
      Pair<D> rest = before, rest_after = after;
      for (Pair<D>* p : {&rest, &rest_after}) p->a.velocity -= before.b.velocity;
      EXPECT_NEAR(rest.energy() - rest_after.energy(), lost, kRoundOff * speeds * speeds * m) << k;
      continue;
    }
    const double momenta = before.a.velocity.norm() / before.a.inverse_mass +
                           before.b.velocity.norm() / before.b.inverse_mass;
    EXPECT_LT((after.momentum() - before.momentum()).norm(), kRoundOff * momenta) << k;
    const double turning = size_of(before.a.spin) / before.a.inverse_inertia +
                           size_of(before.b.spin) / before.b.inverse_inertia +
                           (before.a.radius + before.b.radius) * momenta;
    EXPECT_LT(size_of(SpinOf<D>(after.angular_momentum() - before.angular_momentum())),
              kRoundOff * turning)
        << k;
    EXPECT_NEAR(before.energy() - after.energy(), lost, kRoundOff * before.energy()) << k;
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_GT(slips, kPairs / 5);
  EXPECT_GT(walls, kPairs / 10);
}

TEST(Impulse, KeepsMomentaAndLosesWhatTheLawSaysOfDisks) { expect_laws<2>(); }
TEST(Impulse, KeepsMomentaAndLosesWhatTheLawSaysOfSpheres) { expect_laws<3>(); }

// At the limit of slip both cases have one impulse and one loss.
template <int D>
void expect_continuous() {
  Random random(5);
  constexpr double kStep = 1e-9;
  for (int k = 0; k < 2000; ++k) {
    const Pair<D> pair = random_pair<D>(random);
    const double e = random.uniform();
    const auto with = [&](double friction) {
      Pair<D> p = pair;
      return collide<D>(p.a, p.b, p.n, {e, friction});
    };
    const Impact<D> sticks = with(1e9);
    ASSERT_FALSE(sticks.slips);
    const double limit = size_of(sticks.tangential) / sticks.normal;
    const Impact<D> below = with(limit * (1 - kStep)), above = with(limit * (1 + kStep));
    EXPECT_TRUE(below.slips);
    EXPECT_FALSE(above.slips);
    EXPECT_LT(size_of(TangentialOf<D>(below.tangential - above.tangential)),
              2 * kStep * size_of(above.tangential));
    EXPECT_NEAR(below.lost, above.lost, 2 * kStep * above.lost);
  }
}

TEST(Impulse, SlipAndNoSlipMeet) {
  expect_continuous<2>();
  expect_continuous<3>();
}

// Liffman's scalars in his axes, with the corrected signs.
TEST(Impulse, IsLiffmansInThePlane) {
  Random random(3);
  for (int k = 0; k < 1000; ++k) {
    Pair<2> p = random_pair<2>(random);
    if (p.wall) continue;
    const Pair<2> before = p;
    const double e = random.uniform(), m1 = 1 / p.a.inverse_mass, m = m1 * p.b.inverse_mass;
    collide<2>(p.a, p.b, p.n, {e, 1e9});
    const Eigen::Vector2d n = before.n, t(-n.y(), n.x());
    const double c1n = before.a.velocity.dot(n), c2n = before.b.velocity.dot(n);
    EXPECT_NEAR(p.a.velocity.dot(n), ((m - e) * c1n + (1 + e) * c2n) / (1 + m), 1e-13);  // (11)
    const double r1 = before.a.radius, r2 = before.b.radius;
    const double turn =
        m1 * (r1 * r1 * before.a.inverse_inertia + r2 * r2 * before.b.inverse_inertia);
    const double c1t = before.a.velocity.dot(t), c2t = before.b.velocity.dot(t);
    EXPECT_NEAR(p.a.velocity.dot(t),
                (c2t + (m + turn) * c1t - r2 * before.b.spin - r1 * before.a.spin) / (1 + m + turn),
                1e-13);  // (15), (17), (18)
  }
}

TEST(Impulse, BodiesThatPartStayAsTheyAre) {
  Pair<2> p;
  p.a.inverse_mass = p.b.inverse_mass = 1;
  p.a.velocity = {-1, 0.5};
  p.n = {1, 0};
  Pair<2> after = p;
  EXPECT_EQ(collide<2>(after.a, after.b, p.n, {0.5, 0.5}).normal, 0);
  EXPECT_EQ(after.a.velocity, p.a.velocity);
  Body<2> wall, other;
  other.velocity = {-1, 0};
  EXPECT_EQ(collide<2>(wall, other, p.n, {}).normal, 0);
}

}  // namespace
}  // namespace grainfield::dem
