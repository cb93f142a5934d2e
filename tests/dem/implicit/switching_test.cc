// Disks that collide as hard ones and rest as soft ones (Liffman et al. 1992, eq. 22).
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "dem/random/random.h"
#include "dem/switching/switching_disks.h"
#include "tests/dem/implicit_scene.h"

namespace grainfield::dem {
namespace {

using ::testing::HasSubstr;

// Disks of unit diameter and mass, gravity 1; m g/(K d) = 1e-4.
constexpr double kStiffness = 1e4;

SoftLaw damped() {
  SoftLaw law;
  law.stiffness = kStiffness;
  law.damping = 60;
  return law;
}

SwitchScene ground_scene(double restitution) {
  SwitchScene out;
  out.soft.grains = damped();
  out.soft.walls = {testing::ground(damped())};
  out.soft.gravity = {0, -1};
  out.grains = {restitution, 0.3};
  out.walls = {{restitution, 0.3}};
  return out;
}

long soft_grains(const SwitchingDisks& s) {
  return std::accumulate(s.soft().begin(), s.soft().end(), 0L);
}

// A ball that falls: impulses until its speed of parting is below g dt (22), as many as e^n v says,
// and a few more, because it turns up to v dt above the ground and falls that again; then it is
// soft, and rests where K s = m g.
TEST(Switching, ABallBouncesUntilGravityBringsItBackWithinAStep) {
  const double dt = 0.01, height = 1;
  for (const double e : {0.0, 0.3, 0.7}) {
    SwitchingDisks ball(ground_scene(e), {testing::soft_disk(0, 0.5 + height)},
                        testing::steps_of(dt));
    const double start = ball.balance();
    long switched_after = -1;
    double speed = 0;
    for (int k = 0; k < 3000; ++k) {
      ball.step(1);
      EXPECT_NEAR(ball.balance(), start, 1e-10) << e;
      if (ball.soft()[0] == 1 && switched_after < 0) {
        switched_after = ball.tally().collisions;
        speed = std::fabs(ball.bodies()[0].velocity.y());
      }
    }
    // Bounces n with e^n sqrt(2 h g) above g dt, and the last. Falls from v dt give sqrt(2 v g dt):
    // after so few of them that is below 3 g dt.
    const double v = std::sqrt(2 * height);
    const double expected = e == 0 ? 1 : std::ceil(std::log(dt / v) / std::log(e));
    EXPECT_GE(static_cast<double>(switched_after), expected) << e;
    EXPECT_LE(static_cast<double>(switched_after), expected + 10) << e;
    EXPECT_LE(speed, 2 * dt) << e;
    EXPECT_EQ(ball.soft()[0], 1);
    EXPECT_EQ(ball.tally().switched, 0);
    EXPECT_NEAR(ball.bodies()[0].position.y(), 0.5 - 1 / kStiffness, 1e-9) << e;
    EXPECT_LT(ball.energy().kinetic, 1e-15);
  }
}

// Without forces none is ever soft, and every impulse keeps momentum and angular momentum.
TEST(Switching, WithoutForcesAllStayHard) {
  SwitchScene scene;
  scene.soft.grains = damped();
  scene.grains = {0.6, 0.4};
  Random random(3);
  std::vector<Body<2>> disks;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      disks.push_back(
          testing::soft_disk(1.2 * i, 1.2 * j, random.uniform(0.3, 0.55), random.uniform(0.5, 2)));
      // Towards the middle.
      disks.back().velocity = {3 - 1.2 * i + random.uniform(-1, 1),
                               3 - 1.2 * j + random.uniform(-1, 1)};
      disks.back().spin = random.uniform(-2, 2);
    }
  }
  SwitchingDisks all(scene, disks, testing::steps_of(0.01));
  const auto momenta = [&] {
    Eigen::Vector3d out(0, 0, 0);
    for (const Body<2>& b : all.bodies()) {
      const double m = 1 / b.inverse_mass;
      out.x() += m * b.velocity.x();
      out.y() += m * b.velocity.y();
      out.z() += m * (b.position.x() * b.velocity.y() - b.position.y() * b.velocity.x()) +
                 b.spin / b.inverse_inertia;
    }
    return out;
  };
  const Eigen::Vector3d before = momenta();
  const double energy = all.energy().total();
  all.step(500);
  EXPECT_GT(all.tally().collisions, 40);
  EXPECT_EQ(soft_grains(all), 0);
  EXPECT_EQ(all.tally().pressed, 0);
  EXPECT_NEAR((momenta() - before).norm(), 0, 1e-10);
  EXPECT_NEAR(all.balance(), energy, 1e-10 * energy);
  EXPECT_LT(all.energy().total(), 0.8 * energy);
}

std::vector<Body<2>> rain(int columns, int rows) {
  Random random(5);
  std::vector<Body<2>> out;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      out.push_back(testing::soft_disk(0.7 + 1.1 * i + random.uniform(-0.05, 0.05), 1 + 1.3 * j,
                                       random.uniform(0.4, 0.5)));
    }
  }
  return out;
}

SwitchScene box_scene(double width) {
  SwitchScene out = ground_scene(0.5);
  out.soft.grains.friction = SoftFriction::coulomb;
  out.soft.grains.coulomb = 0.3;
  out.soft.grains.tangential_stiffness = 0.3 * kStiffness;
  out.soft.walls[0].law = out.soft.grains;
  out.soft.walls.push_back({{0, 0}, {1, 0}, out.soft.grains});
  out.soft.walls.push_back({{width, 0}, {-1, 0}, out.soft.grains});
  out.walls.assign(3, {0.5, 0.3});
  return out;
}

// Rain into a box: all begin hard, the lowest turn soft first, at the end all are soft and at rest,
// and the balance of energy closes over every switch.
TEST(Switching, RainComesToRestGrainByGrain) {
  const int columns = 5, rows = 6;
  SwitchingDisks box(box_scene(1.1 * columns + 0.3), rain(columns, rows), testing::steps_of(0.005));
  const double start = box.balance();
  long most = 0;
  bool mixed = false;
  for (int k = 0; k < 400; ++k) {
    box.step(20);
    most = std::max(most, soft_grains(box));
    mixed = mixed || (soft_grains(box) > 5 && soft_grains(box) < columns * rows - 5);
    ASSERT_NEAR(box.balance(), start, 1e-8 * std::fabs(start)) << k;
  }
  EXPECT_TRUE(mixed);
  EXPECT_EQ(most, columns * rows);
  EXPECT_GE(soft_grains(box), columns * rows - 2);  // but rattlers
  EXPECT_LT(box.rest().ratio, 1e-2);
  EXPECT_GT(box.tally().to_soft, columns * rows);
  EXPECT_GT(box.tally().to_hard, 0);
  // What overlaps that began with a switch brought is small against what impulses took.
  EXPECT_LT(box.tally().switched, 0.01 * box.tally().lost);
  // The weight stands on the ground.
  double base = 0;
  for (const SoftTouch& t : box.touches()) {
    if (t.j == -1) base += t.repulsion;
    if (t.j == -2 || t.j == -3) base += t.normal.x() * t.tangential;
  }
  EXPECT_NEAR(base, columns * rows, 0.02 * columns * rows);
}

TEST(Switching, GoesOnFromItsCheckpointToTheSameBits) {
  const SwitchScene scene = box_scene(3.6);
  const std::vector<Body<2>> disks = rain(3, 3);
  SwitchingDisks whole(scene, disks, testing::steps_of(0.005));
  whole.step(700);
  const std::string checkpoint = whole.checkpoint();
  EXPECT_GT(soft_grains(whole), 0);
  whole.step(400);
  SwitchingDisks other(scene, disks, testing::steps_of(0.005));
  other.restore(checkpoint);
  other.step(400);
  EXPECT_EQ(whole.checkpoint(), other.checkpoint());
  EXPECT_THROW(other.restore(checkpoint.substr(1)), std::invalid_argument);
}

// The source's own laws: viscous slip between grains, wells on the ground.
SwitchScene source_scene() {
  SwitchScene out = ground_scene(0.3);
  out.soft.grains.friction = SoftFriction::viscous;
  out.soft.grains.slip_damping = 50;
  out.soft.grains.rolling_friction = 0.9;
  SoftLaw& ground = out.soft.walls[0].law;
  ground = out.soft.grains;
  ground.static_friction = 1;
  ground.well = 1e-3;
  ground.renewed = true;
  return out;
}

// Disks dropped one after the other: but for what a new one brings, and what overlaps that began
// with a switch bring, energy never grows; wells give back no more than they took.
TEST(Switching, ADropNeverGainsEnergy) {
  SwitchingDisks pile(source_scene(), {testing::soft_disk(0.1, 1)}, testing::steps_of(0.02));
  Random random(2);
  for (int k = 1; k <= 12; ++k) {
    const auto held = [&] {
      return pile.energy().total() + pile.losses().well - pile.tally().switched;
    };
    double before = held();
    for (int step = 0; step < (k < 12 ? 200 : 1500); ++step) {
      pile.step(1);
      const double now = held();
      ASSERT_LE(now, before + 1e-8) << k << " " << step;
      ASSERT_GE(pile.losses().well, -1e-8) << k << " " << step;
      before = now;
    }
    double top = 0;
    for (const Body<2>& b : pile.bodies()) top = std::max(top, b.position.y() + b.radius);
    if (k < 12) pile.add(testing::soft_disk(random.uniform(-0.2, 0.2), top + 1.5));
  }
  EXPECT_GT(pile.losses().total(), 5);
  EXPECT_LT(pile.energy().kinetic, 0.1);
}

// Three disks carry each other by the closed forms (Liffman 42, 44): N = 3 m g/2 below both base
// disks, H = m g tan(theta)/2 outwards, theta near 30 degrees.
TEST(Switching, ThreeDisksRestOnTheClosedForces) {
  SwitchingDisks pile(source_scene(), {testing::soft_disk(-0.5, 0.5), testing::soft_disk(0.5, 0.5)},
                      testing::steps_of(0.02));
  pile.step(300);
  pile.add(testing::soft_disk(0, 0.501 + 0.5 * std::sqrt(3.0)));
  pile.step(3000);
  const auto& b = pile.bodies();
  const double tangent = 0.5 * (b[1].position.x() - b[0].position.x()) /
                         (b[2].position.y() - 0.5 * (b[0].position.y() + b[1].position.y()));
  EXPECT_NEAR(tangent, 1 / std::sqrt(3.0), 0.01);
  double found = 0;
  for (const SoftTouch& t : pile.touches()) {
    if (t.j != -1) continue;
    ++found;
    EXPECT_NEAR(t.repulsion, 1.5, 1e-3) << t.i;
    EXPECT_NEAR(-t.tangential, (t.i == 0 ? -0.5 : 0.5) * tangent, 1e-3) << t.i;
  }
  EXPECT_EQ(found, 2);
  EXPECT_EQ(soft_grains(pile), 3);
  EXPECT_LT(pile.energy().kinetic, 1e-8);
}

// What slides along the ground is dragged by mu m g where wells form anew; where they do not, it
// slides for ever.
TEST(Switching, RenewedWellsStopWhatSlides) {
  for (const bool renewed : {true, false}) {
    SwitchScene scene = source_scene();
    scene.soft.walls[0].law.slip_damping = 0;
    scene.soft.walls[0].law.renewed = renewed;
    Body<2> disk = testing::soft_disk(0, 0.5 - 1 / kStiffness);
    disk.velocity.x() = 1;
    SwitchingDisks slides(scene, {disk}, testing::steps_of(0.01));
    slides.step(400);
    EXPECT_NEAR(slides.bodies()[0].position.x(), renewed ? 0.5 : 4, renewed ? 0.05 : 1e-9);
    EXPECT_LT(slides.energy().kinetic, renewed ? 1e-3 : 0.6);
  }
}

TEST(Switching, ADiskAddedAtTheStartIsOneOfTheFirst) {
  const SwitchScene scene = box_scene(3.6);
  const std::vector<Body<2>> disks = rain(3, 3);
  SwitchingDisks whole(scene, disks, testing::steps_of(0.005));
  SwitchingDisks grown(scene, {disks.begin(), disks.end() - 1}, testing::steps_of(0.005));
  grown.add(disks.back());
  whole.step(500);
  grown.step(500);
  EXPECT_EQ(whole.checkpoint(), grown.checkpoint());
  // In the middle of a run, too: both go on from its checkpoint to the same bits.
  grown.add(testing::soft_disk(1.8, 12));
  const std::string checkpoint = grown.checkpoint();
  grown.step(300);
  whole.add(testing::soft_disk(1.8, 20));
  whole.restore(checkpoint);
  whole.step(300);
  EXPECT_EQ(whole.checkpoint(), grown.checkpoint());
  EXPECT_THROW(whole.add(testing::soft_disk(1.8, 0.1)), std::invalid_argument);
}

TEST(Switching, RefusesWhatCannotBe) {
  const auto refusal = [](const SwitchScene& scene) -> std::string {
    try {
      SwitchingDisks(scene, {testing::soft_disk(0, 1)}, testing::steps_of(0.01));
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "accepted";
  };
  SwitchScene scene = ground_scene(0.5);
  EXPECT_EQ(refusal(scene), "accepted");
  scene.grains.restitution = 1.2;
  EXPECT_THAT(refusal(scene), HasSubstr("restitution of grains: found 1.2, allowed: 0 to 1"));
  scene = ground_scene(0.5);
  scene.walls[0].friction = -1;
  EXPECT_THAT(refusal(scene), HasSubstr("friction of walls: found -1, allowed: 0 or more"));
  scene = ground_scene(0.5);
  scene.walls.clear();
  EXPECT_THAT(refusal(scene), HasSubstr("impact laws of walls: found 0, allowed: 1"));
}

}  // namespace
}  // namespace grainfield::dem
