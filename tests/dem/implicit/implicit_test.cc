// Implicit motion of soft disks: what it keeps, its order, its well, what it refuses.
#include <gmock/gmock.h>

#include <array>
#include <functional>
#include <string>

#include "dem/random/random.h"
#include "dem/shared/computation_failed.h"
#include "tests/dem/implicit_scene.h"

namespace grainfield::dem::testing {
namespace {

using ::testing::HasSubstr;

// A dozen disks of several sizes in a box, under gravity or not.
std::vector<Body<2>> boxed_gas(SoftScene& scene, double side) {
  Random random(3);
  const SoftLaw law = scene.grains;
  scene.walls = {{{0, 0}, {0, 1}, law},
                 {{0, side}, {0, -1}, law},
                 {{0, 0}, {1, 0}, law},
                 {{side, 0}, {-1, 0}, law}};
  std::vector<Body<2>> out;
  const int across = 3;
  for (int k = 0; k < across * across; ++k) {
    const double radius = random.uniform(0.3, 0.5);
    Body<2> b = soft_disk((k % across + 0.5) * side / across, (k / across + 0.5) * side / across,
                          radius, 4 * radius * radius);
    b.velocity = {random.uniform(-1, 1), random.uniform(-1, 1)};
    b.spin = random.uniform(-1, 1);
    out.push_back(b);
  }
  return out;
}

struct Momentum {
  VectorOf<2> linear{0, 0};
  double angular = 0;
};
Momentum momentum_of(const std::vector<Body<2>>& disks) {
  Momentum out;
  for (const Body<2>& b : disks) {
    const VectorOf<2> p = b.velocity / b.inverse_mass;
    out.linear += p;
    out.angular += b.position.x() * p.y() - b.position.y() * p.x() + b.spin / b.inverse_inertia;
  }
  return out;
}

// Ten times the explicit step, 1e5 of them.
TEST(Implicit, KeepsTheEnergyOfAGas) {
  SoftScene scene;
  scene.grains.stiffness = 1e4;
  scene.gravity = {0.1, -0.3};
  const std::vector<Body<2>> start = boxed_gas(scene, 4);
  SoftDisks disks(scene, start, steps_of(10 * explicit_step(1, scene.grains.stiffness)));
  const double before = disks.energy().total();
  double most = 0, elastic = 0;
  for (int k = 0; k < 1000; ++k) {
    disks.step(100);
    const SoftEnergy now = disks.energy();
    most = std::max(most, std::fabs(now.total() - before));
    elastic = std::max(elastic, now.elastic);
  }
  EXPECT_LT(most, 1e-10 * std::fabs(before));
  EXPECT_GT(elastic, 0.1 * start.size() * 0.1);  // they do collide
  EXPECT_EQ(disks.tally().halved, 0);
  EXPECT_GT(disks.tally().iterations, disks.tally().solves / 4);
  std::printf("gas: drift %.2e of the energy, %.2f iterations a step, at most %d\n",
              most / std::fabs(before),
              static_cast<double>(disks.tally().iterations) / disks.tally().solves,
              disks.tally().most_iterations);
}

// A touching disk swings as the midpoint rule does, in closed form: by 2 atan(w dt/2) a step.
TEST(Implicit, SwingsOnItsContactByTheMidpointRule) {
  const double stiffness = 400, sag = 1 / stiffness, swing = 0.9 * sag;
  const SoftScene scene = smooth_ground(stiffness);
  for (const double dt : {0.01, 0.1, 1.0}) {
    Body<2> ball = soft_disk(0.3, 0.5 - sag + swing);
    SoftDisks disks(scene, {ball}, steps_of(dt));
    for (int k = 1; k <= 50; ++k) {
      disks.step(1);
      const double y = 0.5 - sag + swing * std::cos(2 * k * std::atan(0.5 * dt * 20));
      EXPECT_NEAR(disks.bodies()[0].position.y(), y, 1e-11) << dt;
      EXPECT_EQ(disks.bodies()[0].position.x(), 0.3);
    }
  }
}

SoftLaw rough(double stiffness, SoftFriction friction) {
  SoftLaw law;
  law.stiffness = stiffness;
  law.damping = 1.5;
  law.friction = friction;
  law.slip_damping = 0.7;
  law.rolling_friction = 0.4;
  law.coulomb = 0.4;
  law.tangential_stiffness = 0.3 * stiffness;
  return law;
}

// Two on the ground between walls and one on top, that never part.
SoftDisks rocking(SoftFriction friction, ImplicitScheme scheme, double dt) {
  SoftScene scene;
  scene.grains = rough(100, friction);
  // Friction far from its limits: smooth in time.
  scene.grains.rolling_friction = scene.grains.coulomb = 100;
  SoftLaw floor = scene.grains;
  floor.static_friction = 1;
  floor.well = 0.5;
  scene.walls = {
      ground(floor), {{-0.9775, 0}, {1, 0}, scene.grains}, {{0.9775, 0}, {-1, 0}, scene.grains}};
  scene.gravity = {0, -1};
  std::vector<Body<2>> start{soft_disk(-0.4925, 0.485), soft_disk(0.4925, 0.485),
                             soft_disk(0.001, 1.3486)};
  start[2].velocity = {0.02, 0};
  start[0].spin = 0.03;
  return SoftDisks(scene, start, steps_of(dt, scheme));
}

TEST(Implicit, IsOfSecondOrderInTime) {
  for (const auto& [friction, scheme] :
       {std::pair{SoftFriction::viscous, ImplicitScheme::conserving},
        {SoftFriction::coulomb, ImplicitScheme::conserving},
        {SoftFriction::viscous, ImplicitScheme::bdf2},
        {SoftFriction::coulomb, ImplicitScheme::bdf2}}) {
    std::vector<Eigen::VectorXd> ends;
    for (int n = 40; n <= 640; n *= 2) {
      SoftDisks disks = rocking(friction, scheme, 1.0 / n);
      for (int k = 0; k < n; ++k) {
        disks.step(1);
        // All contacts last: four with walls, three of pairs.
        ASSERT_EQ(disks.touches().size(), 7U) << n << " " << k;
      }
      Eigen::VectorXd end(9);
      for (int k = 0; k < 3; ++k) {
        end.segment<2>(3 * k) = disks.bodies()[k].position;
        end[3 * k + 2] = disks.angles()[k];
      }
      ends.push_back(end);
    }
    for (std::size_t k = 2; k < ends.size(); ++k) {
      const double order =
          std::log2((ends[k - 1] - ends[k - 2]).norm() / (ends[k] - ends[k - 1]).norm());
      EXPECT_NEAR(order, 2, 0.2);
    }
  }
}

// A touching disk under BDF2 follows the recurrence of its oscillator, whose roots die out where
// the step is long, and lasts where it is short.
TEST(Implicit, Bdf2LetsDieOutWhatIsTooFast) {
  const double stiffness = 400, sag = 1 / stiffness, swing = 0.9 * sag, frequency = 20;
  const SoftScene scene = smooth_ground(stiffness);
  for (const double dt : {0.001, 0.1, 1.0}) {
    SoftDisks disks(scene, {soft_disk(0.3, 0.5 - sag + swing)}, steps_of(dt, ImplicitScheme::bdf2));
    double y = swing, v = 0, y_before = 0, v_before = 0;
    for (int k = 0; k < 50; ++k) {
      disks.step(1);
      // z = from z_0, z_-1 with y' = v, v' = -w^2 y: solved by hand; the first step is Euler's.
      const double by = k == 0 ? dt : 2 * dt / 3;
      const double known_y = k == 0 ? y : (4 * y - y_before) / 3;
      const double known_v = k == 0 ? v : (4 * v - v_before) / 3;
      y_before = y;
      v_before = v;
      v = (known_v - by * frequency * frequency * known_y) / (1 + by * by * frequency * frequency);
      y = known_y + by * v;
      EXPECT_NEAR(disks.bodies()[0].position.y(), 0.5 - sag + y, 1e-12) << dt << " " << k;
      EXPECT_NEAR(disks.bodies()[0].velocity.y(), v, 1e-11) << dt << " " << k;
    }
    const double energy = 0.5 * (v * v + frequency * frequency * y * y);
    const double lost = 0.5 * frequency * frequency * swing * swing - energy;
    EXPECT_NEAR(disks.losses().scheme, lost, 1e-12);
    EXPECT_EQ(disks.losses().normal, 0);
    if (dt == 0.001) {
      EXPECT_NEAR(y, swing * std::cos(frequency * 50 * dt), 2e-2 * swing);
    } else {
      EXPECT_LT(std::fabs(y), 1e-6 * swing);
    }
  }
}

// Linear momentum, whatever it loses; free flight at any step, halved ones among them.
TEST(Implicit, Bdf2KeepsMomentumAndFliesFreely) {
  SoftScene scene;
  scene.grains = rough(1e3, SoftFriction::coulomb);
  std::vector<Body<2>> start = boxed_gas(scene, 4);
  scene.walls.clear();
  for (Body<2>& b : start) b.velocity -= 0.5 * (b.position - VectorOf<2>(2.3, 1.8));
  SoftDisks disks(scene, start, steps_of(0.3, ImplicitScheme::bdf2));
  const double before = disks.energy().total();
  disks.step(30);
  EXPECT_GT(disks.tally().halved, 0);
  EXPECT_LT((momentum_of(disks.bodies()).linear - momentum_of(start).linear).norm(), 1e-11);
  EXPECT_LT(disks.energy().total(), before);
  EXPECT_NEAR(disks.energy().total() + disks.losses().total(), before, 1e-9);

  SoftScene air;
  air.gravity = {0, -1};
  ImplicitSettings steps = steps_of(0.01, ImplicitScheme::bdf2);
  SoftDisks flying(air, {soft_disk(0, 0)}, steps);
  flying.step(100);
  EXPECT_NEAR(flying.bodies()[0].velocity.y(), -1, 1e-12);
  EXPECT_NEAR(flying.bodies()[0].position.y(), -0.5, 2e-4);  // Euler's first step: dt^2
}

// All laws lose what they say they lose.
TEST(Implicit, BalancesEnergyWithItsLosses) {
  for (const SoftFriction friction : {SoftFriction::viscous, SoftFriction::coulomb}) {
    SoftScene scene;
    scene.grains = rough(1e3, friction);
    scene.background_damping = 0.02;
    scene.gravity = {0.2, -1};
    std::vector<Body<2>> start = boxed_gas(scene, 4);
    scene.walls[0].law.static_friction = 0.8;
    scene.walls[0].law.well = 0.02;
    SoftDisks disks(scene, start, steps_of(0.03));
    const double before = disks.energy().total();
    double last_normal = 0, last_tangential = 0;
    for (int k = 0; k < 1000; ++k) {
      disks.step(1);
      const SoftLosses& lost = disks.losses();
      ASSERT_NEAR(disks.energy().total() + lost.total(), before, 1e-9) << k;
      EXPECT_GE(lost.normal, last_normal - 1e-15);
      if (friction == SoftFriction::viscous) {
        EXPECT_GE(lost.tangential, last_tangential - 1e-15);
      }
      last_normal = lost.normal;
      last_tangential = lost.tangential;
    }
    EXPECT_GT(last_normal, 0.1);
    EXPECT_GT(last_tangential, 0.1);
    EXPECT_GT(disks.losses().background, 0.01);
  }
}

// A heap of disks that meet without walls.
TEST(Implicit, KeepsMomenta) {
  for (const SoftFriction friction : {SoftFriction::viscous, SoftFriction::coulomb}) {
    SoftScene scene;
    scene.grains = rough(1e3, friction);
    std::vector<Body<2>> start = boxed_gas(scene, 4);
    scene.walls.clear();
    for (Body<2>& b : start) b.velocity -= 0.5 * (b.position - VectorOf<2>(2.3, 1.8));
    SoftDisks disks(scene, start, steps_of(0.03));
    const Momentum before = momentum_of(start);
    disks.step(300);
    const Momentum after = momentum_of(disks.bodies());
    EXPECT_LT((after.linear - before.linear).norm(), 1e-11);
    EXPECT_NEAR(after.angular, before.angular, 1e-11);
    EXPECT_GT(disks.losses().tangential, 0.01);
  }
}

// In its well a disk swings with sqrt(mu_static g/a) and does not turn; it rests where the slope
// says, and leaves where the ground is steeper than mu_static. One that comes in flight has none.
TEST(Implicit, WellHoldsADisk) {
  SoftScene scene = smooth_ground(1e3);
  SoftLaw& floor = scene.walls[0].law;
  floor.static_friction = 0.6;
  floor.well = 0.01;
  Body<2> ball = soft_disk(0, 0.5 - 1e-3);  // in balance: N = 1
  const auto x = [](const SoftDisks& d) { return d.bodies()[0].position.x(); };
  const double dt = 2e-2, rate = std::sqrt(floor.static_friction / floor.well);

  // The midpoint rule turns (w (x - x_s), v) by 2 atan(w dt/2) a step; the well begins after the
  // first one, in free fall along the slope.
  const double slope = 0.2, sits = floor.well * slope / 0.6, begin = 0.5 * slope * dt * dt;
  scene.gravity = {slope, -1};
  SoftDisks swinging(scene, {ball}, steps_of(dt));
  for (int k = 0; k < 300; ++k) {
    swinging.step(1);
    const double turn = 2 * k * std::atan(0.5 * rate * dt);
    const double away = -sits * std::cos(turn) + slope * dt / rate * std::sin(turn);
    ASSERT_NEAR(x(swinging), begin + sits + away, 1e-11) << k;
  }
  EXPECT_EQ(swinging.angles()[0], 0);

  scene.background_damping = 2;
  for (const double gentle : {0.1, 0.25}) {
    scene.gravity = {gentle, -1};
    SoftDisks held(scene, {ball}, steps_of(dt));
    held.step(2000);
    const double from = 0.5 * gentle * dt * dt / (1 + dt);
    EXPECT_NEAR(x(held), from + floor.well * gentle / 0.6, 1e-9) << gentle;
    EXPECT_LT(held.rest().ratio, 1e-9);
    ASSERT_EQ(held.touches().size(), 1U);
    EXPECT_NEAR(held.touches()[0].tangential, -gentle, 1e-9);
    EXPECT_NEAR(held.touches()[0].repulsion, 1, 1e-9);
  }
  scene.gravity = {0.65, -1};
  SoftDisks gone(scene, {ball}, steps_of(dt));
  gone.step(1000);
  EXPECT_GT(x(gone), 1);
  EXPECT_NEAR(gone.bodies()[0].velocity.x(), 0.325, 1e-9);  // slope over drag

  scene.gravity = {0, -1};
  scene.background_damping = 0;
  ball.velocity = {0.03, 0};
  SoftDisks gliding(scene, {ball}, steps_of(dt));
  gliding.step(500);
  EXPECT_NEAR(x(gliding), 0.03 * 500 * dt, 1e-12);
}

// A disk of infinite mass goes on as it does; a light one that it hits leaves twice as fast.
TEST(Implicit, FixedDisksGoOnAtTheirVelocity) {
  SoftScene scene;
  scene.grains.stiffness = 1e3;
  Body<2> heavy = soft_disk(0, 0);
  heavy.inverse_mass = heavy.inverse_inertia = 0;
  heavy.velocity = {0.5, 0};
  heavy.spin = 0.1;
  SoftDisks disks(scene, {heavy, soft_disk(1.2, 0)}, steps_of(0.02));
  disks.step(200);
  EXPECT_EQ(disks.touches().size(), 0U);
  EXPECT_NEAR(disks.bodies()[0].position.x(), 2, 1e-12);
  EXPECT_NEAR(disks.angles()[0], 0.4, 1e-12);
  EXPECT_EQ(disks.bodies()[0].velocity.x(), 0.5);
  // The work of the heavy one is its way in each step: the energy is kept in its frame.
  EXPECT_NEAR(disks.bodies()[1].velocity.x(), 1, 1e-9);
}

std::string bits_of(const SoftDisks& disks) {
  std::string out;
  for (const Body<2>& b : disks.bodies()) {
    out.append(reinterpret_cast<const char*>(&b), sizeof b);
  }
  return out;
}

TEST(Implicit, SameBitsAgain) {
  for (const ImplicitScheme scheme : {ImplicitScheme::conserving, ImplicitScheme::bdf2}) {
    SoftScene scene;
    scene.grains = rough(1e3, SoftFriction::coulomb);
    scene.gravity = {0, -1};
    const std::vector<Body<2>> start = boxed_gas(scene, 4);
    const ImplicitSettings steps = steps_of(0.03, scheme);
    SoftDisks one(scene, start, steps), other(scene, start, steps);
    one.step(300);
    for (int k = 0; k < 300; ++k) other.step(1);
    EXPECT_EQ(bits_of(one), bits_of(other));

    // Stopped and resumed.
    SoftDisks half(scene, start, steps), rest(scene, start, steps);
    half.step(143);
    rest.restore(half.checkpoint());
    rest.step(157);
    EXPECT_EQ(rest.checkpoint(), one.checkpoint());
    SoftDisks less(scene, {start[0]}, steps);
    EXPECT_THROW(less.restore(half.checkpoint()), std::invalid_argument);
    EXPECT_THROW(rest.restore(half.checkpoint() + "x"), std::invalid_argument);
  }
}

// Steps so long that they are halved: part by part, and resumed between two parts of one step.
TEST(Implicit, PartsOfAStepAreTheStep) {
  for (const ImplicitScheme scheme : {ImplicitScheme::conserving, ImplicitScheme::bdf2}) {
    SoftScene scene;
    scene.grains = rough(1e3, SoftFriction::viscous);
    scene.gravity = {0, -1};
    const std::vector<Body<2>> start = boxed_gas(scene, 4);
    const ImplicitSettings steps = steps_of(1, scheme);
    SoftDisks whole(scene, start, steps), parts(scene, start, steps);
    whole.step(10);
    ASSERT_GT(whole.tally().halved, 5);
    long calls = 0, resumed = 0;
    for (int ended = 0; ended < 10; ++calls) {
      const bool ends = parts.try_part();
      ended += ends;
      EXPECT_EQ(parts.tally().steps, ended);
      if (ends || calls % 3 != 0) continue;
      SoftDisks next(scene, start, steps);
      next.restore(parts.checkpoint());
      ASSERT_EQ(next.checkpoint(), parts.checkpoint());
      EXPECT_EQ(next.time(), parts.time());
      parts = std::move(next);
      ++resumed;
    }
    EXPECT_EQ(calls, whole.tally().halved + whole.tally().solves);
    EXPECT_GT(resumed, 3);
    EXPECT_EQ(parts.checkpoint(), whole.checkpoint());
  }
}

// Relaxation changes the way of Newton's method, not where it ends.
TEST(Implicit, RelaxationTakesMoreIterationsToTheSamePlace) {
  SoftScene scene;
  scene.grains = rough(1e3, SoftFriction::viscous);
  scene.gravity = {0, -1};
  const std::vector<Body<2>> start = boxed_gas(scene, 4);
  std::vector<double> iterations;
  std::vector<std::vector<Body<2>>> ends;
  for (const double relaxation : {1.0, 0.9, 0.5}) {
    ImplicitSettings settings = steps_of(0.03);
    settings.relaxation = relaxation;
    SoftDisks disks(scene, start, settings);
    disks.step(50);
    EXPECT_EQ(disks.tally().halved, 0);
    iterations.push_back(static_cast<double>(disks.tally().iterations) / 50);
    ends.push_back(disks.bodies());
  }
  EXPECT_GT(iterations[1], 1.5 * iterations[0]);
  EXPECT_GT(iterations[2], 1.5 * iterations[1]);
  for (std::size_t k = 0; k < start.size(); ++k) {
    EXPECT_LT((ends[1][k].position - ends[0][k].position).norm(), 1e-8);
    EXPECT_LT((ends[2][k].position - ends[0][k].position).norm(), 1e-8);
  }
}

// A step's move is measured against what forces do in it, not against the radius: friction that
// sticks is solved at any step.
TEST(Implicit, SolvesStickingFrictionInTheShortestSteps) {
  LatticeSetup lattice;
  lattice.base_grains = 12;
  lattice.radius = 0.5;
  const double stiffness = 1e4, dashpot = std::sqrt(stiffness);
  SoftScene scene;
  scene.gravity = {0, -1};
  scene.grains.stiffness = stiffness;
  scene.grains.damping = 0.5 * dashpot;
  scene.grains.slip_damping = 50 * dashpot;
  scene.grains.rolling_friction = 0.9;
  scene.walls = {ground(scene.grains)};
  for (const double shorter : {1e4, 1e6}) {
    ImplicitSettings steps = steps_of(explicit_step(1, stiffness) / shorter);
    steps.most_halvings = 0;
    SoftDisks disks(scene, pile_bodies(lattice, 4 / std::numbers::pi), steps);
    EXPECT_NO_THROW(disks.step(10)) << shorter;
    EXPECT_EQ(disks.tally().steps, 10);
  }
}

// Steps are halved where Newton's method has too few iterations, and where a disk would fly past
// others.
TEST(Implicit, HalvesStepsThatAreTooLong) {
  SoftScene scene;
  scene.grains.stiffness = 1e4;
  Body<2> left = soft_disk(-2, 0.1), right = soft_disk(2, 0);
  left.velocity = {30, 0};
  ImplicitSettings settings = steps_of(0.1);
  SoftDisks disks(scene, {left, right}, settings);
  const double before = disks.energy().total();
  disks.step(2);
  EXPECT_GT(disks.tally().halved, 0);
  EXPECT_EQ(disks.tally().steps, 2);
  EXPECT_LE(30 * disks.tally().least_step, 0.25);
  EXPECT_NEAR(disks.time(), 0.2, 1e-15);
  EXPECT_GT(disks.bodies()[1].velocity.x(), 10);  // hit, not passed
  EXPECT_NEAR(disks.energy().total(), before, 1e-9 * before);

  scene = smooth_ground(1e4);
  settings = steps_of(0.1);
  settings.max_iterations = 2;
  settings.tolerance = 1e-8;
  SoftDisks few(scene, {soft_disk(0, 0.6)}, settings);
  few.step(20);
  EXPECT_GT(few.tally().halved, 0);
  EXPECT_LE(few.tally().most_iterations, 2);

  settings.max_iterations = 1;
  settings.tolerance = 1e-14;
  settings.most_halvings = 3;
  try {
    SoftDisks never(scene, {soft_disk(0, 0.6), soft_disk(0.3, 1.55)}, settings);
    never.step(100);
    ADD_FAILURE();
  } catch (const ComputationFailed& e) {
    EXPECT_THAT(e.what(), HasSubstr("implicit motion: no step at t = "));
    EXPECT_THAT(e.what(), HasSubstr("3 halvings of time_step = 0.1 s: Newton's method did not "
                                    "converge: too many iterations; take a smaller time_step"));
  }
}

TEST(Implicit, RefusesWhatItCannotBeginWith) {
  const auto refusal =
      [](const std::function<void(SoftScene&, std::vector<Body<2>>&, ImplicitSettings&)>& spoil) {
        SoftScene scene = smooth_ground(1e3);
        std::vector<Body<2>> disks{soft_disk(0, 0.5), soft_disk(1, 0.5)};
        ImplicitSettings settings = steps_of(0.01);
        spoil(scene, disks, settings);
        try {
          SoftDisks(scene, disks, settings);
        } catch (const std::invalid_argument& e) {
          return std::string(e.what());
        }
        return std::string("accepted");
      };
  EXPECT_EQ(refusal([](auto&, auto&, auto&) {}), "accepted");
  EXPECT_EQ(refusal([](auto&, auto&, auto& s) { s.relaxation = 0; }),
            "relaxation: found 0, allowed: above 0, at most 1");
  EXPECT_EQ(refusal([](auto&, auto&, auto& s) { s.relaxation = 1.1; }),
            "relaxation: found 1.1, allowed: above 0, at most 1");
  EXPECT_EQ(refusal([](auto&, auto&, auto& s) { s.time_step = 0; }),
            "time_step: found 0, allowed: above 0");
  EXPECT_EQ(refusal([](auto&, auto&, auto& s) { s.time_step = -1; }),
            "time_step: found -1, allowed: above 0");
  EXPECT_EQ(refusal([](auto&, auto& d, auto&) { d[1].position = d[0].position; }),
            "disks 0 and 1: distance over the sum of their radii: found 0, allowed: 0.5 or more, "
            "so that Newton's method knows the way out");
  EXPECT_EQ(refusal([](auto&, auto& d, auto&) {
              d[0].position = {0, -1};
            }),
            "disk 0: height of the centre above wall 0 over its radius: found -2, allowed: 0.5 or "
            "more, so that Newton's method knows the way out");
  EXPECT_EQ(refusal([](auto&, auto& d, auto&) { d[1].velocity.x() = std::nan(""); }),
            "disk 1: place or velocity: found nan, allowed: finite");
  EXPECT_EQ(refusal([](auto& s, auto&, auto&) { s.grains.stiffness = 0; }),
            "grains: stiffness: found 0, allowed: above 0");
  EXPECT_EQ(refusal([](auto& s, auto&, auto&) { s.walls[0].law.static_friction = 1; }),
            "wall 0: well: found 0, allowed: above 0");
  EXPECT_EQ(refusal([](auto& s, auto&, auto&) { s.grains.static_friction = 1; }),
            "grains: static_friction: found 1, allowed: 0: walls alone have wells");
  EXPECT_THAT(refusal([](auto& s, auto&, auto&) {
                s.walls[0].normal = {0, 2};
              }),
              HasSubstr("wall 0: length of the normal: found 2"));
}

}  // namespace
}  // namespace grainfield::dem::testing
