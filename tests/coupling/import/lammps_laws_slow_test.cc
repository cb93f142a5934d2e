// The laws that LAMMPS has too, against it: packings settled there go on here with the same forces,
// and two spheres that collide, roll and twist feel the same. Optional: skipped without `lmp`.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>

#include "tests/coupling/lammps_scene.h"

namespace grainfield::coupling::lammps {
namespace {

// So short that neither spins nor normals change: depths, springs and dashpots remain. What is left
// of the difference are lever arms: at walls whole radii there, to the plane here, so that the slip
// of a spin differs by spin times depth.
constexpr double kBriefly = 1e-12;

void compare_first_step(const char* name, const Law& law, const Scene& scene) {
  const End theirs = scene.go_on(kBriefly, 1);
  std::vector<long long> ids;
  const dem::Snapshot start = scene.start(ids);
  double largest = 0, largest_rolling = 0;
  for (const dem::Contact& c : start.contacts) {
    largest = std::max(largest, c.force.norm());
    largest_rolling = std::max(largest_rolling, c.rolling_spring.norm());
  }
  const auto difference = [&](const dem::Snapshot& from) {
    const auto engine = scene.engine(from, kBriefly);
    engine->step(1);
    const std::vector<Vec3> ours = forces_of(engine->snapshot());
    double worst = 0;
    for (std::size_t g = 0; g < ids.size(); ++g)
      worst = std::max(worst, (ours[g] - theirs.loads.at(ids[g]).first).norm());
    return worst / largest;
  };
  const double found = difference(start);
  std::printf("%s: %zu spheres, %zu contacts: largest difference %.2g of the largest force\n", name,
              ids.size(), start.contacts.size(), found);
  ASSERT_GT(ids.size(), 100U);
  EXPECT_LT(found, 1e-10) << name;
  EXPECT_EQ(largest_rolling > 0, law.rolls);
  dem::Snapshot other = start;
  for (dem::Contact& c : other.contacts) c.spring_vector *= 1 + 1e-8;
  EXPECT_GT(difference(other), 1e-9);
  other = start;
  for (dem::Grain& g : other.grains) g.velocity *= 1 + 1e-4;
  EXPECT_GT(difference(other), 1e-9);
  other = start;
  for (dem::Grain& g : other.grains) g.angular_velocity *= -1;
  EXPECT_GT(difference(other), 1e-9);
}

// With the moments, to the depths over the radii (4e-3 at walls), as the levers are: what the
// rolling springs do shows in the spins after a step. Without a twisting spring, which LAMMPS shows
// nowhere.
void compare_first_spins(const Scene& scene) {
  const End theirs = scene.go_on(kBriefly, 1);
  std::vector<long long> ids;
  dem::Snapshot start = scene.start(ids);
  const auto difference = [&] {
    double largest = 0, worst = 0;
    const auto engine = scene.engine(start, kBriefly);
    engine->step(1);
    const dem::Snapshot now = engine->snapshot();
    for (const dem::Contact& c : now.contacts)
      largest = std::max(largest, start.grains[0].radius * c.tangential_force);
    engine->step(1);
    const dem::Snapshot next = engine->snapshot();
    for (std::size_t g = 0; g < ids.size(); ++g) {
      const Vec3 moment = start.grains[g].inertia / (1.5 * kBriefly) *
                          (next.grains[g].angular_velocity - start.grains[g].angular_velocity);
      worst = std::max(worst, (moment - theirs.loads.at(ids[g]).second).norm());
    }
    return worst / largest;
  };
  const double found = difference();
  for (dem::Contact& c : start.contacts) c.rolling_spring.setZero();
  const double without = difference();
  std::printf(
      "moments: largest difference %.2g of the largest of friction; without the rolling "
      "springs %.2g\n",
      found, without);
  EXPECT_LT(found, 5e-3);
  EXPECT_GT(without, 4 * found);
}

TEST(LammpsLaws, FirstStepOfHertzHistory) {
  if (!is_there()) GTEST_SKIP() << "lmp not found: the Debian package lammps has it";
  const Law law = hertz_history();
  compare_first_step("gran/hertz/history", law, Scene(law, 0.04, 16));
}
TEST(LammpsLaws, FirstStepOfGranularWithRolling) {
  if (!is_there()) GTEST_SKIP() << "lmp not found: the Debian package lammps has it";
  const Law law = granular("mindlin_rescale/force");
  const Scene scene(law, 0.04, 16);
  compare_first_step("granular, mindlin_rescale/force, rolling sds", law, scene);
  compare_first_spins(scene);
}

// A hundred steps later: what differs between the two programs is mostly the arm of friction at
// walls, which ends at the plane here and is the whole radius there (4e-3 longer). Where walls are
// smooth less than a tenth of the difference is left: the slip of a spin (whole radii there), the
// arms of pairs of unlike radii, and the turning of springs about the normal, which LAMMPS leaves
// out.
TEST(LammpsLaws, WallsWithFrictionMakeTheDifference) {
  if (!is_there()) GTEST_SKIP() << "lmp not found: the Debian package lammps has it";
  const int steps = 100;  // the dump is written at multiples of it
  double with_friction = 0;
  for (const double wall_friction : {0.5, 0.0}) {
    const Scene scene(granular("mindlin", wall_friction), 0.04, 16);
    const End theirs = scene.go_on(1e-5, steps);
    std::vector<long long> ids;
    const dem::Snapshot start = scene.start(ids);
    const auto engine = scene.engine(start, 1e-5);
    engine->step(steps);
    const dem::Snapshot now = engine->snapshot();
    const std::vector<Vec3> ours = forces_of(now);
    double largest = 0, worst = 0;
    for (const dem::Contact& c : now.contacts) largest = std::max(largest, c.force.norm());
    for (std::size_t g = 0; g < ids.size(); ++g)
      worst = std::max(worst, (ours[g] - theirs.loads.at(ids[g]).first).norm() / largest);
    const double stress = (stress_of(now) - theirs.stress).norm() / theirs.stress.norm();
    std::printf(
        "granular, mindlin, rolling sds, walls with friction %g, %d steps on: forces within %.2g "
        "of the largest, stress within %.2g\n",
        wall_friction, steps, worst, stress);
    ASSERT_GT(ids.size(), 100U);
    if (wall_friction > 0) {
      with_friction = stress;
      EXPECT_GT(stress, 1e-6);
      EXPECT_LT(stress, 1e-4);
    } else {
      EXPECT_LT(stress, 0.1 * with_friction);
    }
  }
}

constexpr const char* kTwo = R"(units si
atom_style sphere
atom_modify map array
boundary f f f
newton off
comm_modify vel yes
region box block -0.05 0.05 -0.05 0.05 -0.05 0.05 units box
create_box 1 box
create_atoms 1 single 0 0 0 units box
create_atoms 1 single 0.009998 0 0 units box
set group all diameter 0.01
set group all density 2500
include pair.in
neighbor 0.001 bin
neigh_modify delay 0 every 1 check yes
timestep 1e-7
fix move all nve/sphere
velocity all set 0 0 0
include spins.in
dump after all custom ${steps} after.dump id fx fy fz tqx tqy tqz
dump_modify after format float %.17g
run ${steps}
)";

struct Spins {
  const char* name;
  Vec3 first, second;
};

// Two equal spheres that start to spin while they overlap: no history, so springs, dashpots and
// caps of rolling and of twisting are all that their moments show beside friction's. What remains:
// they fly apart, and their steps are the same to the integrators' order.
TEST(LammpsLaws, TwoSpheresRollAndTwistAlike) {
  if (!is_there()) GTEST_SKIP() << "lmp not found: the Debian package lammps has it";
  const double mu_r[] = {0.01, 10}, mu_tw[] = {1e-5, 10};
  const Spins all[] = {{"rolling", {0, 3, 0}, {0, -3, 0}},
                       {"twisting", {5, 0, 0}, {-5, 0, 0}},
                       {"all", {4, 3, -2}, {-5, -2, 3}}};
  for (const Spins& spins : all) {
    for (int held = 0; held < 2; ++held) {
      const dem::RollingLaw rolling{2e3, 0.05, mu_r[held], 5e-2, 1e-6, mu_tw[held]};
      const testing::Folder folder;
      folder.write("two.in", kTwo);
      folder.write("pair.in",
                   fmt::format("pair_style granular\npair_coeff * * hertz/material {} 2e6 {} "
                               "tangential mindlin NULL 0.5 0.5 rolling sds {} {} {} twisting sds "
                               "{} {} {} damping viscoelastic\n",
                               kYoung, kPoisson, rolling.stiffness, rolling.damping,
                               rolling.friction, rolling.twisting_stiffness,
                               rolling.twisting_damping, rolling.twisting_friction));
      const auto set = [](int atom, const Vec3& w) {
        return fmt::format("set atom {} omega {} {} {}\n", atom, w.x(), w.y(), w.z());
      };
      folder.write("spins.in", set(1, spins.first) + set(2, spins.second));
      const int steps = 100;
      run_lammps(folder.path(), "two.in", fmt::format("-var steps {}", steps));
      std::map<int, std::pair<Vec3, Vec3>> theirs;
      for (const auto& row : last_rows(folder / "after.dump"))
        theirs[static_cast<int>(row[0])] = {{row[1], row[2], row[3]}, {row[4], row[5], row[6]}};
      dem::EngineSettings s;
      s.shape = dem::ShapeKind::sphere;
      s.law = dem::HertzLaw{kYoung, kPoisson, 0, true, true, 2e6, 1e6};
      s.rolling = rolling;
      s.gravity_y = 0;
      s.time_step = 1e-7;
      const auto engine = dem::make_engine(s);
      for (int k = 0; k < 2; ++k) {
        dem::NewGrain g;
        g.x = 0.009998 * k;
        g.radius = 0.005;
        g.density = 2500;
        const Vec3& w = k == 0 ? spins.first : spins.second;
        g.spin_x = w.x();
        g.spin_y = w.y();
        g.spin = w.z();
        engine->add(g);
      }
      engine->step(steps - 1);
      // The moments of a step from the change of spin: half of this step's and half of the next.
      const dem::Snapshot before = engine->snapshot();
      engine->step(1);
      const dem::Snapshot now = engine->snapshot();
      engine->step(1);
      const dem::Snapshot after = engine->snapshot();
      double largest = 0;
      for (int k = 0; k < 2; ++k) largest = std::max(largest, theirs[k + 1].second.norm());
      double worst = 0;
      for (int k = 0; k < 2; ++k) {
        const Vec3 moment = now.grains[k].inertia *
                            (after.grains[k].angular_velocity - before.grains[k].angular_velocity) /
                            2e-7;
        worst = std::max(worst, (moment - theirs[k + 1].second).norm() / largest);
        const Vec3 force = forces_of(now)[static_cast<std::size_t>(k)];
        EXPECT_LT((force - theirs[k + 1].first).norm(), 1e-3 * force.norm());
      }
      const dem::Contact& c = now.contacts.at(0);
      std::printf(
          "two spheres, %s, %s: moments within %.2g; rolling %.3g, twisting %.3g of the cap\n",
          spins.name, held != 0 ? "held" : "capped", worst,
          c.rolling_spring.norm() / (rolling.friction * c.normal_force),
          std::fabs(c.twisting_spring) / (rolling.twisting_friction * c.normal_force));
      EXPECT_LT(worst, 1e-3) << spins.name << held;
    }
  }
}

}  // namespace
}  // namespace grainfield::coupling::lammps
