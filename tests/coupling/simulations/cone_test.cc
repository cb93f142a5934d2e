// Cones: what they are made of, what leaves the floor, and what stands in the end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <set>

#include "coupling/studies/cone/cone_grains.h"
#include "coupling/studies/cone/simulation.h"
#include "dem/shared/computation_failed.h"
#include "dem/snapshot/contact_changes.h"

namespace grainfield::dem {
namespace {

using testing::HasSubstr;

// Done in a second or two.
ConeSetup small(const std::string& source = "point") {
  ConeSetup s;
  s.plan.source = source;
  s.plan.grains = 250;
  s.plan.polydispersity = 0.2;
  s.plan.rate = 4000;
  s.plan.drop = 0.008;
  s.plan.speed = 0.3;
  s.plan.mouth = source == "cylinder" ? 0.012 : 0.008;
  s.plan.lift_speed = 0.3;
  s.plan.floor_radius = 0.04;
  s.material.young = 3e5;
  s.material.rolling_friction = 0.3;
  s.material.rolling_stiffness = 10;
  s.material.rolling_damping = 1e-3;
  s.rest.background_damping = 60;
  s.rest.unbalanced_force_ratio = 1e-3;
  s.rest.kinetic_to_elastic_energy = 1e-5;
  return s;
}

Snapshot finish(const ConeSetup& setup, std::map<std::string, double>* figures = nullptr,
                int threads = 1) {
  const auto run = make_cone_run(setup, 3, threads);
  while (!run->done()) run->advance(100000);
  const RunResult result = run->result();
  if (figures != nullptr) *figures = result.figures;
  return result.snapshots.at(0).second;
}

std::string complaint(const ConeSetup& setup) {
  try {
    foresee_cone(setup, {1}, 100000);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

// Balance of every free grain, over the mean weight.
double largest_residual(const Snapshot& s) {
  std::vector<Vec3> sum(s.grains.size(), Vec3::Zero());
  for (const Contact& c : s.contacts) {
    sum[static_cast<std::size_t>(c.i)] += c.force;
    if (c.j >= 0) sum[static_cast<std::size_t>(c.j)] -= c.force;
  }
  double largest = 0, mass = 0;
  int free = 0;
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    if (s.grains[k].fixed) continue;
    largest = std::max(largest, (sum[k] + s.grains[k].mass * s.gravity).norm());
    mass += s.grains[k].mass;
    ++free;
  }
  return largest / (mass / free * s.gravity.norm());
}

TEST(Cone, StandsOnItsFloorInBalance) {
  for (const char* source : {"point", "rain", "cylinder"}) {
    for (const char* floor : {"rough", "smooth"}) {
      SCOPED_TRACE(std::string(source) + " on a " + floor + " floor");
      ConeSetup setup = small(source);
      setup.plan.floor = floor;
      std::map<std::string, double> figures;
      const Snapshot cone = finish(setup, &figures);
      EXPECT_EQ(figures.at("dem.grains") + figures.at("cone.grains_lost"), 250);
      EXPECT_GE(figures.at("dem.grains"), kLeastOfCone);
      EXPECT_GT(figures.at("cone.pour_time"), 0.8 * 250 / 4000);
      double weight = 0;
      int free = 0;
      for (std::size_t k = 0; k < cone.grains.size(); ++k) {
        const Grain& g = cone.grains[k];
        EXPECT_EQ(g.id, static_cast<std::int64_t>(k));
        if (g.fixed) continue;
        ++free;
        weight += g.mass * cone.gravity.norm();
        EXPECT_LE(g.position.head<2>().norm(), setup.plan.floor_radius * 1.001);
        EXPECT_GT(g.position.z(), 0);
      }
      EXPECT_EQ(free, figures.at("dem.grains"));
      EXPECT_NEAR(base_force(cone).z() / weight, 1, 2e-2);
      // Grains that touch nothing fall slowly in the damping of the rest.
      EXPECT_LT(largest_residual(cone), 1.01);
      EXPECT_EQ(cone.walls.size(), 1U) << "the cylinder is gone";
    }
  }
}

TEST(Cone, SuperellipsoidsPileUpToo) {
  ConeSetup setup = small();
  setup.plan.shape = "superellipsoid";
  setup.plan.grains = 120;
  setup.material.rolling_friction = 0;
  setup.material.law = "penalty";
  setup.material.normal_stiffness = 2000;
  setup.material.tangential_stiffness = 1000;
  std::map<std::string, double> figures;
  const Snapshot cone = finish(setup, &figures);
  EXPECT_EQ(figures.at("dem.grains") + figures.at("cone.grains_lost"), 120);
  EXPECT_GT(cone.grains.back().axes.minCoeff(), 0);
}

TEST(Cone, HasTheSameBitsOnThreadsAndAfterAResume) {
  for (const char* source : {"rain", "cylinder"}) {
    SCOPED_TRACE(source);
    ConeSetup setup = small(source);
    setup.plan.floor_radius = 0.025;  // many grains leave
    std::map<std::string, double> once, again;
    const Snapshot alone = finish(setup, &once), threads = finish(setup, &again, 2);
    EXPECT_GE(once.at("cone.grains_lost"), 10);
    EXPECT_EQ(once, again);
    const std::string file = testing::TempDir() + "/cone_checkpoint.h5";
    std::filesystem::remove(file);
    // Stopped at odd moments, also right after grains were taken away and while the cylinder rises.
    auto run = make_cone_run(setup, 3, 1);
    int stops = 0, in_lift = 0;
    while (!run->done()) {
      run->advance(977);
      in_lift += run->progress().phase == "lift" ? 1 : 0;
      run->save(file);
      run = make_cone_run(setup, 3, 2);
      run->restore(file);
      ++stops;
    }
    EXPECT_GT(stops, 5);
    EXPECT_EQ(in_lift > 1, setup.plan.source == "cylinder");
    const Snapshot resumed = run->result().snapshots.at(0).second;
    ASSERT_EQ(resumed.grains.size(), alone.grains.size());
    for (std::size_t k = 0; k < alone.grains.size(); ++k) {
      ASSERT_EQ(alone.grains[k].position, threads.grains[k].position) << k;
      ASSERT_EQ(alone.grains[k].position, resumed.grains[k].position) << k;
      ASSERT_EQ(alone.grains[k].angular_velocity, resumed.grains[k].angular_velocity) << k;
    }
    EXPECT_EQ(run->result().figures, once);
  }
}

TEST(Cone, RefusesWhatDoesNotHold) {
  EXPECT_EQ(complaint(small()), "");
  const auto says = [](auto change, const std::string& what) {
    ConeSetup s = small();
    change(s);
    EXPECT_THAT(complaint(s), HasSubstr(what));
  };
  says([](ConeSetup& s) { s.plan.mouth = 0.001; },
       "cone.mouth: found 0.001, allowed: at least 0.0024 m, the largest radius");
  says(
      [](ConeSetup& s) {
        s.plan.source = "cylinder";
        s.plan.mouth = 0.005;
      },
      "cone.mouth: found 0.005, allowed: at least 0.0072 m, three of the largest radii");
  says([](ConeSetup& s) { s.plan.floor_radius = 0.01; }, "cone.floor_radius: found 0.01");
  says([](ConeSetup& s) { s.plan.drop = 0.001; }, "cone.drop: found 0.001");
  says([](ConeSetup& s) { s.plan.floor_radius = 1e3; }, "cone.floor_radius: found 1000");
  says([](ConeSetup& s) { s.motion.energy_balance = true; }, "motion.energy_balance: found true");
  says(
      [](ConeSetup& s) {
        s.plan.shape = "superellipsoid";
        s.material.law = "hertz_elliptic";
        s.material.rolling_friction = 0;
        s.plan.axis_min = 2;
      },
      "cone.axis_min: found 2, allowed: up to cone.axis_max = 1.2");
  says(
      [](ConeSetup& s) {
        s.plan.shape = "superellipsoid";
        s.material.law = "hertz_elliptic";
      },
      "rolling");
  says(
      [](ConeSetup& s) { s.material.rolling_stiffness = 0; },
      "material.rolling_stiffness: found 0, allowed with material.rolling_friction = 0.3: above 0");
  says([](ConeSetup& s) { s.motion.time_step = 1; }, "motion.time_step: found 1");
}

// What make_cone_run refuses is refused before.
TEST(Cone, IsForeseen) {
  const auto refused = [](const ConeSetup& s) {
    try {
      make_cone_run(s, 1, 1);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const auto both = [&](auto change, const std::string& what) {
    ConeSetup s = small();
    change(s);
    EXPECT_THAT(complaint(s), HasSubstr(what));
    EXPECT_THAT(refused(s), HasSubstr(what));
  };
  both([](ConeSetup& s) { s.motion.integrator = "gear"; }, "motion.integrator: found \"gear\"");
  both([](ConeSetup& s) { s.plan.speed = 1e4; }, "cone.speed: found 10000");
  both([](ConeSetup& s) { s.plan.drop = 1e5; }, "cone.drop: found 100000");
  both(
      [](ConeSetup& s) {
        s.plan.source = "cylinder";
        s.plan.mouth = 0.012;
        s.plan.lift_speed = 1e4;
      },
      "cone.lift_speed: found 10000");
  both(
      [](ConeSetup& s) {
        s.plan.shape = "superellipsoid";
        s.material.rolling_friction = 0;
      },
      "material.law: found \"hertz\", allowed for superellipsoids");
  both(
      [](ConeSetup& s) {
        s.plan.shape = "superellipsoid";
        s.plan.source = "cylinder";
        s.plan.mouth = 0.02;
        s.material.law = "penalty";
        s.material.rolling_friction = 0;
      },
      "cone.source: found cylinder");
  for (const char* source : {"point", "rain", "cylinder"}) {
    const ConeSetup s = small(source);
    EXPECT_EQ(foresee_cone(s, {1}, 1000).grains, 250);
    EXPECT_EQ(refused(s), "");
  }
}

// Small grains in the hollows of a rough floor have not left it.
TEST(Cone, KeepsSmallGrainsInHollows) {
  ConeSetup setup = small();
  setup.plan.polydispersity = 0.7;
  setup.plan.mouth = 0.008;
  setup.plan.floor_radius = 0.06;
  std::map<std::string, double> figures;
  const Snapshot cone = finish(setup, &figures);
  EXPECT_LT(figures.at("cone.grains_lost"), 15) << "that rolled over the edge";
  double lowest = 1;
  for (const Grain& g : cone.grains) {
    if (!g.fixed) lowest = std::min(lowest, g.position.z());
  }
  EXPECT_LT(lowest, 0) << "one lies below the tops of the floor's spheres";
}

TEST(Cone, TooFewThatStayAreAFailure) {
  ConeSetup setup = small("rain");
  setup.plan.floor = "smooth";
  setup.plan.floor_radius = 0.024;
  setup.plan.grains = 60;
  setup.material.friction = setup.material.floor_friction = 0;
  setup.material.rolling_friction = 0;
  const auto run = make_cone_run(setup, 3, 1);
  try {
    while (!run->done()) run->advance(100000);
    FAIL() << "stood";
  } catch (const ComputationFailed& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("stayed on the floor"));
  }
}

// The least grain finds no place between the spheres of the floor: nowhere can its centre sink to
// theirs.
TEST(ConeFloor, LeavesNoGap) {
  for (const double spread : {0.0, 0.2, 0.5, 0.9}) {
    ConePlan plan = small().plan;
    plan.polydispersity = spread;
    const std::vector<NewGrain> floor = cone_floor(plan, 2500);
    EXPECT_NEAR(static_cast<double>(floor.size()), floor_grains_of(plan),
                0.15 * floor_grains_of(plan));
    const double least = plan.radius * (1 - spread);
    std::mt19937 draw(5);
    std::uniform_real_distribution<double> place(-plan.floor_radius, plan.floor_radius);
    for (int k = 0; k < 2000; ++k) {
      const double x = place(draw), y = place(draw);
      if (std::hypot(x, y) > plan.floor_radius) continue;
      const bool touches = std::any_of(floor.begin(), floor.end(), [&](const NewGrain& g) {
        return std::hypot(g.x - x, g.y - y) < g.radius + least;
      });
      EXPECT_TRUE(touches) << x << " " << y;
    }
    for (const NewGrain& g : floor) EXPECT_LE(g.z + g.radius, 1e-12);
  }
}

// Against a look at every ball.
TEST(FreePlaces, AreApartFromAll) {
  std::mt19937 draw(2);
  std::uniform_real_distribution<double> place(-0.03, 0.03), size(0.0005, 0.002);
  Snapshot s;
  for (int k = 0; k < 100; ++k) {
    Grain g;
    g.position = Vec3(place(draw), place(draw), place(draw));
    g.radius = size(draw);
    g.fixed = k % 5 == 0;  // do not count
    s.grains.push_back(g);
  }
  FreePlaces places(s, 0.002);
  std::vector<Grain> all;
  for (const Grain& g : s.grains) {
    if (!g.fixed) all.push_back(g);
  }
  int taken = 0;
  for (int k = 0; k < 4000; ++k) {
    Grain g;
    g.position = Vec3(place(draw), place(draw), place(draw));
    g.radius = size(draw);
    const bool free = std::none_of(all.begin(), all.end(), [&](const Grain& other) {
      return (other.position - g.position).norm() < other.radius + g.radius;
    });
    ASSERT_EQ(places.take(g.position.x(), g.position.y(), g.position.z(), g.radius), free) << k;
    if (free) all.push_back(g);
    taken += free ? 1 : 0;
  }
  EXPECT_GT(taken, 500);
  EXPECT_LT(taken, 3500);
}

// Never below a lying grain that a new one of the cell's half width could touch from above.
TEST(LocalTops, AreAboveWhatLiesThere) {
  std::mt19937 draw(2);
  std::uniform_real_distribution<double> place(-0.03, 0.03), size(0.0005, 0.002), high(0, 0.02);
  Snapshot s;
  s.walls.resize(2);
  for (int k = 0; k < 200; ++k) {
    Grain g;
    g.position = Vec3(place(draw), place(draw), high(draw));
    g.radius = size(draw);
    // Two that touch each other in the air, and one beside that touches the cylinder.
    const bool flies = k % 4 < 2, hangs = k % 4 == 2;
    if (flies || hangs) g.position.z() = 1;
    s.grains.push_back(g);
    Contact c;
    c.i = k;
    c.j = hangs ? -2 : -1;
    if (k % 4 == 1) {
      c.i = k - 1;
      c.j = k;
    }
    if (k % 4 != 0) s.contacts.push_back(c);
  }
  const LocalTops tops(s, 0.03, 0.004);
  for (int k = 0; k < 2000; ++k) {
    const double x = place(draw), y = place(draw);
    EXPECT_LT(tops.at(x, y), 0.022 + 1e-12);
    for (const Grain& g : s.grains) {
      if (g.position.z() == 1 || std::hypot(g.position.x() - x, g.position.y() - y) > 0.004)
        continue;
      EXPECT_GE(tops.at(x, y), g.position.z() + g.radius);
    }
  }
  EXPECT_EQ(LocalTops(Snapshot(), 0.03, 0.004).at(0, 0), 0);
}

// Random packings with walls: contacts of those that stay keep their partners.
TEST(KeepOnFloor, KeepsContactsOfTheOthers) {
  std::mt19937 draw(11);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int round = 0; round < 200; ++round) {
    Snapshot s;
    s.dim = 3;
    s.walls.resize(2);
    const int n = 30;
    for (int k = 0; k < n; ++k) {
      Grain g;
      g.id = k;
      g.position = Vec3(place(draw), place(draw), place(draw) + 0.8);
      g.fixed = k % 7 == 0;
      g.mass = 1 + k;  // its name
      s.grains.push_back(g);
    }
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; j += 5) {
        Contact c;
        c.i = i;
        c.j = j;
        c.normal_force = 100 * i + j;
        s.contacts.push_back(c);
      }
      Contact wall;
      wall.i = i;
      wall.j = -1 - i % 2;
      wall.normal_force = -i - 1;
      s.contacts.push_back(wall);
    }
    const bool with_cylinder = round % 2 == 0;
    Snapshot kept = s;
    ConePlan plan;
    plan.floor_radius = 0.7;
    keep_on_floor(plan, with_cylinder, kept);
    std::set<double> stays;
    for (const Grain& g : s.grains) {
      if (g.fixed || !has_left(g, plan)) stays.insert(g.mass);
    }
    ASSERT_EQ(kept.grains.size(), stays.size());
    for (std::size_t k = 0; k < kept.grains.size(); ++k) {
      EXPECT_EQ(kept.grains[k].id, static_cast<std::int64_t>(k));
      EXPECT_EQ(stays.count(kept.grains[k].mass), 1U);
    }
    std::size_t expected = 0;
    for (const Contact& c : s.contacts) {
      const bool first = stays.count(1.0 + static_cast<double>(c.i)) > 0;
      if (c.j >= 0) {
        expected += first && stays.count(1.0 + static_cast<double>(c.j)) > 0 ? 1 : 0;
      } else {
        expected += first && (with_cylinder || c.j == -1) ? 1 : 0;
      }
    }
    EXPECT_EQ(kept.contacts.size(), expected);
    for (const Contact& c : kept.contacts) {
      const double i = kept.grains[static_cast<std::size_t>(c.i)].mass - 1;
      if (c.j >= 0) {
        EXPECT_EQ(c.normal_force, 100 * i + kept.grains[static_cast<std::size_t>(c.j)].mass - 1);
      } else {
        EXPECT_EQ(c.normal_force, -i - 1);
        EXPECT_EQ(c.j, -1 - static_cast<int>(i) % 2);
      }
    }
  }
}

}  // namespace
}  // namespace grainfield::dem
