// Work of walls, energy stored and lost: what goes in is there or has been measured where it went.
#include "dem/engine/energy_balance.h"

#include <gmock/gmock.h>

#include <cmath>

#include "dem/engine/engine.h"
#include "dem/random/random.h"
#include "dem/walls/box.h"
#include "tests/dem/damaged_checkpoint.h"

namespace grainfield::dem {
namespace {

EngineSettings settings_of(const AnyLaw& law, double step, bool space = false) {
  EngineSettings s;
  s.law = law;
  s.time_step = step;
  s.gravity_y = 0;
  s.energy_balance = true;
  if (space) s.shape = ShapeKind::sphere;
  return s;
}
NewGrain grain(double x, double y, double radius, double z = 0) {
  NewGrain g;
  g.x = x;
  g.y = y;
  g.z = z;
  g.radius = radius;
  g.density = 2500;
  return g;
}

struct Books {
  double error, work, lost, gained;  // J; error of the balance, from 2 ms to 10 ms
};

/// A bent column of three grains that stays pressed between a floor and a lid; the lid comes down
/// with a smooth start.
Books pressed_column(bool space, double friction, double damping, double step) {
  EngineSettings s = settings_of(LinearLaw{1e6, 3e5, damping, 0.5 * damping}, step, space);
  if (space && friction == 0) s.law = HertzLaw{2e8, 0.3, 0};
  s.friction = friction;
  (space ? s.gravity_z : s.gravity_y) = -9.81;
  const auto engine = make_engine(s);
  const Vec3 high(0.0301, space ? 0.0199 : 0.0532, 0.0532);
  for (const Wall& w : box_walls({0, 0, 0}, high, friction, space ? 3 : 2)) engine->add_wall(w);
  const double zig[3] = {0.0099, 0.0202, 0.0099};  // all walls are touched
  for (int k = 0; k < 3; ++k) {
    const double height = 0.0098 + 0.0168 * k;
    engine->add(space ? grain(zig[k], 0.00995, 0.01, height) : grain(zig[k], height, 0.01));
  }
  engine->set_background_damping(1000);
  engine->step(std::lround(0.04 / step));
  engine->set_background_damping(0);
  const Vec3 down = space ? Vec3(0, 0, -1) : Vec3(0, -1, 0);
  engine->set_wall_motion("lid", {0.5 * down, {0, 0, 0}, {}, 0.02});
  engine->step(std::lround(2e-3 / step));
  const Diagnostics before = engine->measure();
  engine->step(std::lround(8e-3 / step));
  const Diagnostics after = engine->measure();
  const auto held = [](const Diagnostics& d) {
    return d.kinetic_energy + d.elastic_energy + d.potential_energy;
  };
  return {after.energy_balance() - before.energy_balance(), after.wall_work - before.wall_work,
          after.dissipated_energy() - before.dissipated_energy(), held(after) - held(before)};
}

TEST(EnergyBalance, ALidsWorkIsTheEnergyGainedAndLost) {
  for (const bool space : {false, true}) {
    for (const bool dissipative : {false, true}) {
      const double friction = dissipative ? 0.5 : 0, damping = dissipative ? 200 : 0;
      Books previous = pressed_column(space, friction, damping, 1.6e-5);
      for (const double step : {8e-6, 4e-6, 2e-6}) {
        const Books books = pressed_column(space, friction, damping, step);
        EXPECT_NEAR(std::log2(std::fabs(previous.error / books.error)), 2, 0.2)
            << space << dissipative << ' ' << step << ' ' << books.error;
        previous = books;
      }
      EXPECT_GT(previous.work, 1e-3);
      EXPECT_LT(std::fabs(previous.error), 1e-5 * previous.work);
      EXPECT_NEAR(previous.gained + previous.lost, previous.work, 1e-5 * previous.work);
      if (dissipative) {
        EXPECT_GT(previous.lost, 1e-3 * previous.work);
      } else {
        EXPECT_LT(std::fabs(previous.lost), 1e-5 * previous.work);  // a spring loses nothing
      }
    }
  }
}

// What a collision with a dashpot loses, in closed form: the force is never attractive, so the
// contact ends where k d + c v = 0 (Schwager and Poeschel 2007).
TEST(EnergyBalance, ACollisionLosesWhatTheDashpotTakes) {
  const double k = 1e6, rate = 600, mass = 2500 * 3.14159265358979 * 1e-4, v = 0.5;
  EngineSettings s = settings_of(LinearLaw{k, 0, rate, 0}, 1e-6);
  s.friction = 0;
  const auto engine = make_engine(s);
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0});
  NewGrain g = grain(0, 0.010001, 0.01);
  g.vy = -v;
  engine->add(g);
  double last = 0;
  for (int n = 0; n < 3000; ++n) {
    engine->step(1);
    const double lost = engine->measure().dissipated_energy();
    EXPECT_GE(lost, last - 1e-9 * mass);
    last = lost;
  }
  const double beta = 0.5 * rate, omega = std::sqrt(k / mass - beta * beta);
  const double end =
      (3.14159265358979 - std::atan2(2 * beta * omega, omega * omega - beta * beta)) / omega;
  // Depth and speed of the free swing at that time: k d + c v = 0.
  const double decay = std::exp(-beta * end);
  const double speed = v * decay * (std::cos(omega * end) - beta / omega * std::sin(omega * end));
  const double depth = v * decay * std::sin(omega * end) / omega;
  EXPECT_NEAR(k * depth + mass * rate * speed, 0, 1e-6 * k * depth);
  const double loss = 0.5 * mass * (v * v - speed * speed);  // with what the spring still held
  EXPECT_NEAR(engine->measure().kinetic_energy, 0.5 * mass * speed * speed, 1e-3 * loss);
  EXPECT_NEAR(last, loss, 1e-3 * loss);
  EXPECT_EQ(engine->measure().wall_work, 0);
}

// Many grains, sliding, bouncing, opening and closing, with all that does work: a lid, a turning
// drum, damping, a force.
TEST(EnergyBalance, ClosesForACrowd) {
  for (const bool space : {false, true}) {
    EngineSettings s = settings_of(OverlapAreaLaw{1e6, 0.75}, 1e-5, space);
    if (space) s.law = LinearLaw{1e5, 3e4, 500, 300};
    s.friction = 0.3;
    (space ? s.gravity_z : s.gravity_y) = -9.81;
    const auto engine = make_engine(s);
    const Vec3 up = space ? Vec3::UnitZ() : Vec3::UnitY();
    Wall drum{"drum", {0, 0, 0}, space ? Vec3::UnitY() : Vec3::UnitZ(), 0.5, "cylinder"};
    drum.radius = 0.1;
    engine->add_wall(drum);
    engine->add_wall({"lid", 0.1 * up, -up, 0.3});
    if (space) {
      engine->add_wall({"front", {0, -0.02, 0}, {0, 1, 0}, 0.1});
      engine->add_wall({"back", {0, 0.02, 0}, {0, -1, 0}, 0.1});
    }
    Random random(2);
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < 6; ++column) {
        const double x = 0.022 * (column - 2.5), h = 0.022 * (row - 2.5);
        const double r = random.uniform(0.008, 0.01);
        NewGrain g = space ? grain(x, 0, r, h) : grain(x, h, r);
        g.vx = random.uniform(-0.5, 0.5);
        engine->add(g);
      }
    }
    engine->set_wall_motion("drum", {{0, 0, 0}, drum.normal * 8, {}, 0.05});
    engine->set_wall_motion("lid", {-0.2 * up, {0, 0, 0}, {}, 0.05});
    engine->set_background_damping(2);
    AppliedForce force;
    force.id = 17;
    force.fx = 3;
    force.ramp = 0.1;
    engine->apply(force);
    engine->step(1);
    const double before = engine->measure().energy_balance();
    engine->step(40000);
    const Diagnostics d = engine->measure();
    EXPECT_GT(d.wall_work, 0.1 * std::fabs(before));
    EXPECT_GT(d.dissipated_energy(), 0.1 * d.wall_work);
    EXPECT_GT(d.damped_energy, 0);
    EXPECT_NE(d.applied_work, 0);
    // Contacts that open and close are kinks: of first order each, in random directions.
    EXPECT_NEAR(d.energy_balance(), before, 2e-3 * d.dissipated_energy()) << space;
    // Contacts lose energy, they make none, also while it is carried through searches.
    double last = d.dissipated_energy();
    for (int n = 0; n < 50; ++n) {
      engine->step(20);
      const double lost = engine->measure().dissipated_energy();
      EXPECT_GT(lost, last - 1e-4 * d.dissipated_energy());
      last = lost;
    }
  }
}

// Damping and the applied force work from a grain's first step on, also of one that comes later.
TEST(EnergyBalance, HoldsTheFirstStepOfEachGrain) {
  for (const bool space : {false, true}) {
    const double step = 1e-4, rate = 20, alpha = 0.2, push = space ? 0.3 : 30;
    EngineSettings s = settings_of(LinearLaw{1e6, 3e5, 0, 0}, step, space);
    s.local_damping = alpha;
    const auto engine = make_engine(s);
    engine->set_background_damping(rate);
    for (int k = 0; k < 3; ++k) {
      NewGrain g = grain(0.1 * k, 0, 0.01);
      g.vx = 1 + k;
      (space ? g.vz : g.vy) = -2;
      g.spin = 5;
      const std::int64_t id = engine->add(g);
      AppliedForce force;
      force.id = id;
      force.fx = push;
      engine->apply(force);
      const Diagnostics before = engine->measure();
      engine->step(1);
      const Diagnostics after = engine->measure();
      const Grain now = engine->snapshot().grains[id];
      // This grain alone: those before it move on under their own damping.
      const double speed = g.vx * g.vx + 4, spin = g.spin * g.spin;
      const double drag = rate * (now.mass * speed + now.inertia * spin) + alpha * push * g.vx;
      if (k == 0) {
        EXPECT_NEAR(after.applied_work, push * g.vx * step, 1e-2 * push * g.vx * step) << space;
        EXPECT_NEAR(after.damped_energy, drag * step, 1e-2 * drag * step) << space;
      }
      EXPECT_NEAR(after.energy_balance(), before.energy_balance(), 1e-3 * drag * step) << space;
      engine->step(10);
    }
  }
}

// The books of a contact go on when the other grain comes to be the first.
TEST(EnergyBalance, AnAccountIsTheSameFromEitherGrain) {
  Random random(9);
  const auto number = [&] { return random.uniform(-1, 1); };
  const auto force = [&] {
    ContactForce<2> f;
    f.force = {number(), number()};
    f.torque_i = number();
    f.torque_j = number();
    return f;
  };
  Body<2> a, b;
  for (Body<2>* body : {&a, &b}) {
    body->velocity = {number(), number()};
    body->spin = number();
  }
  const auto parts = [&](double stored) {
    ContactParts<2> p;
    p.all = force();
    p.dashpot = force();
    p.along = force();
    p.moment = number();
    p.stored = {stored, 0.5 * stored};
    return p;
  };
  Account<2> one{parts(0.3), {}}, next{parts(0.7), {}};
  Account<2> other = turned(one, true);
  EXPECT_EQ(turned(one, false).before.all.torque_i, one.before.all.torque_i);
  one.add(next.before, a, b, 0.1);
  other.add(turned(next, true).before, b, a, 0.1);
  for (const auto part : {&ContactLosses::dashpot, &ContactLosses::friction,
                          &ContactLosses::rolling, &ContactLosses::law}) {
    EXPECT_NE(one.gone.*part, 0);
    EXPECT_NEAR(other.gone.*part, one.gone.*part, 1e-15);
  }
}

// Damping takes from the angular momentum, which lies aside of the spin where the moments differ.
TEST(EnergyBalance, ClosesForADampedGrainOfThreeMoments) {
  double previous = 0;
  for (const double step : {4e-4, 2e-4, 1e-4}) {
    const auto engine = make_engine(settings_of(LinearLaw{}, step, true));
    NewGrain g = grain(0, 0, 0.01);
    g.moments = {1e-7, 2e-7, 5e-7};
    g.spin = 30;
    g.spin_x = 20;
    g.spin_y = -15;
    engine->add(g);
    engine->set_background_damping(5);
    const Diagnostics before = engine->measure();
    engine->step(std::lround(0.2 / step));
    const Diagnostics after = engine->measure();
    EXPECT_NEAR(after.damped_energy, (1 - std::exp(-2.0)) * before.kinetic_energy,
                0.05 * before.kinetic_energy);
    const double error = std::fabs(after.energy_balance() - before.energy_balance());
    EXPECT_LT(error, 1e-4 * after.damped_energy) << step;
    if (previous > 0) {
      EXPECT_NEAR(std::log2(previous / error), 2, 0.3) << step;
    }
    previous = error;
  }
}

// The motion of a wall told about another centre is the same motion: the change takes nothing.
TEST(EnergyBalance, GoesOnWhenAWallTurnsAboutAnotherCentre) {
  for (const bool space : {false, true}) {
    const double step = 1e-5, turning = 2;
    EngineSettings s = settings_of(LinearLaw{1e5, 0, 0, 0}, step, space);
    const auto engine = make_engine(s);
    const Vec3 up = space ? Vec3::UnitZ() : Vec3::UnitY(), axis = Vec3::UnitX().cross(up);
    engine->add_wall({"paddle", {0, 0, 0}, up, 0.5});
    engine->set_wall_motion("paddle", {{0, 0, 0}, turning * axis, {}});
    engine->add(space ? grain(0.5, 0, 0.01, 0.01) : grain(0.5, 0.01, 0.01));
    engine->step(space ? 50 : 300);  // about half of a collision
    const double force = engine->walls()[0].force.norm();
    const Diagnostics before = engine->measure();
    const Vec3 centre(0.4, 0, 0);
    engine->set_wall_motion("paddle", {turning * axis.cross(centre), turning * axis, centre});
    engine->step(1);
    const double work = step * force * turning * centre.norm();  // by the way of the new centre
    EXPECT_GT(work, 1e-3 * before.kinetic_energy);
    EXPECT_NEAR(engine->measure().energy_balance(), before.energy_balance(), 1e-2 * work) << space;
    // What the wall does about its new centre is done on the grain: the contact takes nothing.
    engine->step(space ? 10 : 100);
    const Diagnostics after = engine->measure();
    EXPECT_GT(after.wall_work, before.wall_work + 5 * work);
    const auto taken = [](const Diagnostics& d) {
      return d.dissipated_energy() - d.contact_losses.law;
    };
    EXPECT_NEAR(taken(after), taken(before), 0.1 * work) << space;
    // ... by every part of its force.
    EXPECT_NEAR(after.contact_losses.dashpot, before.contact_losses.dashpot, 0.1 * work) << space;
    EXPECT_NEAR(after.contact_losses.friction, before.contact_losses.friction, 0.1 * work) << space;
  }
}

// A checkpoint with fewer accounts than grains would be written behind their end.
TEST(EnergyBalance, CheckpointsWithoutAllAccountsAreRefused) {
  const EngineSettings s = settings_of(LinearLaw{}, 1e-5);
  const auto engine = make_engine(s);
  for (const double x : {0.0, 1.0}) engine->add(grain(x, 0, 0.01));
  AppliedForce force;
  force.id = 0;
  force.fx = 3.25;
  engine->apply(force);
  engine->step(1);
  const std::string checkpoint = engine->checkpoint();
  using Account = OuterAccount<2>;
  Account first;
  first.applied.x() = force.fx;
  const std::size_t before = bytes_of(first).find(bytes_of(force.fx));
  const std::size_t at =
      checkpoint.rfind(bytes_of(force.fx)) - before;  // of the list's first account
  std::string shorter = checkpoint;
  shorter.erase(at + sizeof(Account), sizeof(Account));
  const std::size_t count = at - sizeof(std::uint64_t);
  EXPECT_EQ(refusal_with(*make_engine(s), checkpoint, count, std::uint64_t{2}), "accepted");
  EXPECT_EQ(refusal_with(*make_engine(s), shorter, count, std::uint64_t{1}), kBrokenCheckpoint);
}

TEST(EnergyBalance, IsRefusedWhereItWouldNotHold) {
  const auto refusal = [](auto change) {
    EngineSettings s = settings_of(LinearLaw{}, 1e-5);
    change(s);
    try {
      make_engine(s)->set_sleep(true);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal([](EngineSettings& s) { s.integrator = IntegratorKind::gear; }),
            "energy_balance: found motion.integrator \"gear\", allowed: verlet | runge_kutta");
  EXPECT_EQ(refusal([](EngineSettings& s) { s.sleep.on = true; }), "accepted");
}

}  // namespace
}  // namespace grainfield::dem
