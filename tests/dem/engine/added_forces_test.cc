// Forces of the caller's own: closed forms, what is conserved, bits, and what is refused.
#include "dem/engine/added_forces.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "dem/space/lever.h"
#include "tests/dem/bits_scene.h"
#include "tests/refusal.h"

namespace grainfield::dem {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Function = std::function<AddedForce::Loads(const GrainsNow&, const ContactsNow*)>;

class OfFunction final : public AddedForce {
 public:
  OfFunction(Function function, const std::string& name, long every, bool contacts)
      : AddedForce(name, every), function_(std::move(function)), contacts_(contacts) {}
  bool in_contacts() const override { return contacts_; }
  Loads loads(const std::shared_ptr<const GrainsNow>& grains,
              const std::shared_ptr<const ContactsNow>& contacts) override {
    return function_(*grains, contacts.get());
  }

 private:
  Function function_;
  bool contacts_;
};

void add(Engine& engine, Function function, long every = 1, bool contacts = false,
         const std::string& name = "mine") {
  added_forces(engine).add_force(
      std::make_shared<OfFunction>(std::move(function), name, every, contacts));
}

EngineSettings settings_of(int dim, double time_step, IntegratorKind how = {}) {
  EngineSettings s;
  s.shape = dim == 2 ? ShapeKind::disk : ShapeKind::sphere;
  s.law = LinearLaw{1e5, 3e4, 0, 0};
  s.friction = 0.4;
  s.integrator = how;
  s.time_step = time_step;
  s.gravity_y = 0;
  return s;
}

NewGrain grain_at(double x, double y, double radius = 0.01) {
  NewGrain g;
  g.x = x;
  g.y = y;
  g.radius = radius;
  g.density = 1000;
  return g;
}

AddedForce::Loads spring(const GrainsNow& grains, double k) { return {-k * grains.positions, {}}; }

/// Of errors at time steps that fall by halves.
void expect_second_order(const std::vector<double>& errors) {
  for (std::size_t k = 1; k < errors.size(); ++k) {
    EXPECT_NEAR(std::log2(errors[k - 1] / errors[k]), 2, 0.2);
  }
}

// On a spring from the origin: x = x0 cos(w t), to second order; Gear's error is far smaller.
TEST(AddedForces, AGrainOnASpringSwings) {
  for (const auto& [dim, how] :
       {std::pair(2, IntegratorKind::verlet), std::pair(3, IntegratorKind::verlet),
        std::pair(2, IntegratorKind::gear)}) {
    std::vector<double> errors;
    for (const int steps : {50, 100, 200}) {
      const double period = 0.1, t = 0.7 * period;
      auto engine = make_engine(settings_of(dim, t / steps, how));
      engine->add(grain_at(0.003, 0.001));
      const double m = engine->snapshot().grains[0].mass, w = 2 * std::numbers::pi / period;
      add(*engine, [&](const GrainsNow& grains, auto*) { return spring(grains, m * w * w); });
      engine->step(steps);
      const Vec3 at = engine->snapshot().grains[0].position;
      errors.push_back((at - std::cos(w * t) * Vec3(0.003, 0.001, 0)).norm());
    }
    if (how == IntegratorKind::verlet) expect_second_order(errors);
    EXPECT_LT(errors.back(), how == IntegratorKind::verlet ? 2e-6 : 2e-8);
  }
}

// From the middle of a flight on: also the first step is made with it, from its beginning.
TEST(AddedForces, AForceThatComesLaterIsAsExact) {
  std::vector<double> errors;
  for (const int steps : {100, 200, 400}) {
    const double t = 0.05;
    auto engine = make_engine(settings_of(2, t / steps));
    NewGrain g = grain_at(0, 0);
    g.vx = 0.2;
    engine->add(g);
    engine->step(steps / 2);
    const double m = engine->snapshot().grains[0].mass, w = 90, x0 = 0.2 * t / 2;
    add(*engine, [&](const GrainsNow& grains, auto*) { return spring(grains, m * w * w); });
    engine->step(steps / 2);
    const double exact = x0 * std::cos(w * t / 2) + 0.2 / w * std::sin(w * t / 2);
    errors.push_back(std::fabs(engine->snapshot().grains[0].position.x() - exact));
    added_forces(*engine).remove_force("mine");
    const double before = engine->snapshot().grains[0].velocity.x();
    engine->step(10);
    EXPECT_EQ(engine->snapshot().grains[0].velocity.x(), before);
    EXPECT_EQ(engine->snapshot().attributes.at("former_added_forces"), "mine");
  }
  expect_second_order(errors);
}

TEST(AddedForces, TorquesTurn) {
  for (const int dim : {2, 3}) {
    auto engine = make_engine(settings_of(dim, 1e-4));
    engine->add(grain_at(0, 0));
    add(*engine, [&](const GrainsNow& grains, auto*) {
      AddedForce::Loads out{RowMatrix::Zero(1, dim), RowMatrix::Zero(1, dim == 2 ? 1 : 3)};
      out.torques(0, out.torques.cols() - 1) = 1e-4;
      EXPECT_EQ(grains.spins.cols(), out.torques.cols());
      return out;
    });
    engine->step(100);
    const Grain g = engine->snapshot().grains[0];
    const double moment = dim == 2 ? g.inertia : g.moments.z();
    EXPECT_NEAR(dim == 2 ? g.spin : g.angular_velocity.z(), 1e-4 / moment * 0.01,
                1e-12 * 1e-4 / moment);
  }
}

// A force that counts its calls: kept for three steps each.
TEST(AddedForces, EveryFewStepsItIsAskedAnew) {
  auto engine = make_engine(settings_of(2, 1e-4));
  engine->add(grain_at(0, 0));
  std::vector<double> times;
  add(
      *engine,
      [&](const GrainsNow& grains, auto*) {
        times.push_back(grains.time);
        AddedForce::Loads out{RowMatrix::Zero(1, 2), {}};
        out.forces(0, 0) = static_cast<double>(times.size());
        return out;
      },
      3);
  for (int k = 0; k < 4; ++k) engine->step(k + 1);
  ASSERT_EQ(times.size(), 4U);  // at the start and after 3, 6 and 9 of 10 steps
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(times[static_cast<std::size_t>(k)], 3e-4 * k, 1e-15);
  // Half a kick before and after each step: forces 1 1 1 2 2 2 3 3 3 4 4.
  const Grain g = engine->snapshot().grains[0];
  EXPECT_NEAR(g.velocity.x() * g.mass, (3 + 6 + 9 + 8 - 0.5 * (1 + 4)) * 1e-4, 1e-15);
}

// A cohesion that does not change with the overlap d: d = F/k + (d0 - F/k) cos(w t), w^2 = 2 k/m.
TEST(AddedForces, CohesionPullsTwoGrainsTogether) {
  for (const int dim : {2, 3}) {
    std::vector<double> errors;
    const double k = 1e5, pull = 2, d0 = 0.25 * pull / k;
    for (const int steps : {20, 40, 80}) {
      const double mass = 1000 * std::numbers::pi * (dim == 2 ? 1e-4 : 4e-6 / 3);
      const double w = std::sqrt(2 * k / mass), t = 0.8 / w;
      auto engine = make_engine(settings_of(dim, t / steps));
      engine->add(grain_at(0.02 - d0, 0.001));
      engine->add(grain_at(0, 0.001));
      double seen = 0;
      add(
          *engine,
          [&](const GrainsNow&, const ContactsNow* contacts) -> AddedForce::Loads {
            EXPECT_THAT(contacts->i, ElementsAre(0));
            EXPECT_THAT(contacts->j, ElementsAre(1));
            EXPECT_DOUBLE_EQ(contacts->normals(0, 0), -1);
            EXPECT_DOUBLE_EQ(contacts->radii[0], 0.005);
            seen = contacts->velocities(0, 0);
            return {pull * contacts->normals, {}};
          },
          1, true);
      engine->step(steps);
      const Snapshot s = engine->snapshot();
      const double exact = pull / k + (d0 - pull / k) * std::cos(w * t);
      const double d = 0.02 - (s.grains[0].position.x() - s.grains[1].position.x());
      errors.push_back(std::fabs(d - exact));
      // What the function saw is of the half step before.
      EXPECT_NEAR(seen, s.grains[0].velocity.x() - s.grains[1].velocity.x(), 5e-3);
      EXPECT_LT(seen, 0);
      ASSERT_EQ(s.contacts.size(), 1U);
      EXPECT_NEAR(s.contacts[0].force.x(), k * d - pull, 1e-9);
      EXPECT_NEAR(s.contacts[0].normal_force, k * d - pull, 1e-9);
      EXPECT_FALSE(s.contacts[0].sliding);
      EXPECT_NEAR(engine->measure().max_unbalanced_force, std::fabs(k * d - pull), 1e-9);
    }
    expect_second_order(errors);
  }
}

// At a wall, too: a grain hangs from the ceiling, which says so.
TEST(AddedForces, CohesionHoldsAGrainAtACeiling) {
  for (const bool moves : {false, true}) {
    auto settings = settings_of(2, 1e-5);
    settings.law = LinearLaw{1e5, 3e4, 100, 100};
    settings.gravity_y = -10;
    auto engine = make_engine(settings);
    engine->add_wall({"ceiling", {0, 0, 0}, {0, -1, 0}, 0.5});
    engine->add(grain_at(0, -0.01 + 1e-5));
    if (moves) engine->set_wall_motion("ceiling", {Vec3(1e-9, 0, 0), Vec3(0, 0, 0)});
    add(
        *engine,
        [](const GrainsNow&, const ContactsNow* contacts) -> AddedForce::Loads {
          EXPECT_THAT(contacts->j, ElementsAre(-1));
          return {5 * contacts->normals, {}};
        },
        1, true);
    engine->step(100000);
    const Snapshot s = engine->snapshot();
    const double weight = 10 * s.grains[0].mass;
    EXPECT_NEAR(s.walls[0].force.y(), -weight, 1e-6 * weight);
    EXPECT_NEAR(s.grains[0].position.y(), -0.01 + (5 - weight) / 1e5, 1e-12);
    EXPECT_LT(engine->measure().max_unbalanced_force, 1e-6 * weight);
  }
}

/// Disks or spheres on a line across, spinning, that touch each other and are pushed about.
std::unique_ptr<Engine> cloud(int dim, int threads) {
  EngineSettings s = settings_of(dim, 2e-5);
  s.threads = threads;
  auto engine = make_engine(s);
  Random random(7);
  for (int k = 0; k < 40; ++k) {
    NewGrain g = grain_at(0.0196 * (k % 5), 0.0196 * (k / 5 % (dim == 3 ? 2 : 8)));
    if (dim == 3) g.z = 0.0196 * (k / 10);
    g.x += random.uniform(-2e-4, 2e-4);
    g.vx = random.uniform(-0.2, 0.2);
    g.vy = random.uniform(-0.2, 0.2);
    g.spin = random.uniform(-20, 20);
    engine->add(g);
  }
  return engine;
}

AddedForce::Loads sticky(const GrainsNow&, const ContactsNow* contacts) {
  RowMatrix across = contacts->velocities;  // with a part along the contact, which turns
  return {3 * contacts->normals - 2 * across, {}};
}

TEST(AddedForces, PairForcesKeepMomentum) {
  for (const int dim : {2, 3}) {
    auto engine = cloud(dim, 2);
    long pushed = 0;  // contacts, over all steps
    const auto counted = [&](const GrainsNow& grains, const ContactsNow* contacts) {
      pushed += contacts->normals.rows();
      return sticky(grains, contacts);
    };
    add(*engine, counted, 1, true);
    const auto momenta = [&] {
      Vec3 p(0, 0, 0), l(0, 0, 0);
      for (const Grain& g : engine->snapshot().grains) {
        p += g.mass * g.velocity;
        l += g.mass * g.position.cross(g.velocity);
        l += dim == 2 ? Vec3(0, 0, g.inertia * g.spin) : Vec3(g.moments.x() * g.angular_velocity);
      }
      return std::pair(p, l);
    };
    const auto [p0, l0] = momenta();
    engine->step(300);
    const auto [p, l] = momenta();
    EXPECT_LT((p - p0).norm(), 1e-14);
    EXPECT_LT((l - l0).norm(), 1e-14);
    EXPECT_GT(pushed, 2000);  // seven a step
  }
}

TEST(AddedForces, ThreadsAndRestartsEndInTheSameBits) {
  const auto drag = [](const GrainsNow& grains, auto*) -> AddedForce::Loads {
    return {-0.5 * grains.velocities, 1e-5 * grains.spins};
  };
  for (const int dim : {2, 3}) {
    std::vector<std::uint64_t> ends;
    for (const int threads : {1, 2, 3}) {
      auto engine = cloud(dim, threads);
      add(*engine, drag, 1, false, "drag");
      add(*engine, sticky, 3, true, "glue");
      if (threads == 3) {
        engine->step(101);
        const std::string checkpoint = engine->checkpoint();
        EngineSettings s = settings_of(dim, 2e-5);
        auto bare = make_engine(s);
        EXPECT_THAT(refusal_of([&] { bare->restore(checkpoint); }),
                    HasSubstr("found none, allowed: drag, glue; add the same forces"));
        engine = make_engine(s);
        add(*engine, drag, 1, false, "drag");
        add(*engine, sticky, 2, true, "glue");
        EXPECT_THAT(refusal_of([&] { engine->restore(checkpoint); }),
                    HasSubstr("found glue every 2 steps, allowed: glue every 3 steps"));
        engine = make_engine(s);
        add(*engine, drag, 1, false, "drag");
        add(*engine, sticky, 3, true, "glue");
        engine->restore(checkpoint);
        engine->step(99);
      } else {
        for (int k = 0; k < 20; ++k) engine->step(10);
      }
      ends.push_back(bits::hash_of(engine->snapshot()));
    }
    EXPECT_EQ(ends[0], ends[1]);
    EXPECT_EQ(ends[0], ends[2]);
  }
}

TEST(AddedForces, AForceOfZeroChangesNoBit) {
  for (const bool polygons : {false, true}) {
    std::vector<std::uint64_t> ends;
    for (const bool added : {false, true}) {
      EngineSettings s = bits::settings_of(!polygons, IntegratorKind::verlet);
      s.shape = polygons ? ShapeKind::polygon : ShapeKind::disk;
      s.threads = 2;
      auto engine = make_engine(s);
      for (const Wall& wall : bits::walls_of_box(0.16)) engine->add_wall(wall);
      const auto kind = polygons ? bits::Kind::polygons : bits::Kind::disks;
      for (const NewGrain& g : bits::block(kind, 8, 7, 0.02, 3)) engine->add(g);
      if (added) {
        add(*engine, [](const GrainsNow& grains, auto*) -> AddedForce::Loads {
          return {0 * grains.positions, {}};
        });
      }
      engine->step(500);
      ends.push_back(bits::hash_of(engine->snapshot()));
    }
    EXPECT_EQ(ends[0], ends[1]);
  }
}

// Drag on speed and spin: what it takes is in the account, to second order.
TEST(AddedForces, TheirWorkIsInTheEnergyBalance) {
  std::vector<double> errors;
  for (const int steps : {400, 800, 1600}) {
    EngineSettings s = settings_of(2, 4e-3 / steps);
    s.energy_balance = true;
    auto engine = make_engine(s);
    NewGrain g = grain_at(0, 0);
    g.vx = 0.5;
    g.spin = 60;
    engine->add(g);
    engine->add(grain_at(0.0201, 0.002));
    add(*engine, [](const GrainsNow& grains, auto*) -> AddedForce::Loads {
      return {-30 * grains.velocities, -3e-4 * grains.spins};
    });
    engine->step(steps);
    const Diagnostics d = engine->measure();
    EXPECT_LT(d.applied_work, -0.2 * d.brought_energy);
    EXPECT_GT(d.dissipated_energy(), 0);
    errors.push_back(std::fabs(d.energy_balance()) / d.size_of_work());
  }
  EXPECT_LT(errors[0], 2e-3);
  EXPECT_LT(errors[2], errors[0] / 8);
}

TEST(AddedForces, AStepThatThrowsIsWhole) {
  auto engine = cloud(2, 2);
  long calls = 0;
  add(*engine, [&](const GrainsNow& grains, auto*) -> AddedForce::Loads {
    if (++calls == 7) throw std::domain_error("no more");
    return {-0.5 * grains.velocities, {}};
  });
  EXPECT_THROW(engine->step(100), std::domain_error);
  EXPECT_EQ(engine->steps(), 6);  // the first call was before the first step
  const Snapshot s = engine->snapshot();
  EXPECT_GT(s.contacts.size(), 0U);
  engine->step(94);
  EXPECT_EQ(engine->steps(), 100);
  EXPECT_EQ(calls, 7 + 94);
}

TEST(AddedForces, WhatDoesNotFitIsRefused) {
  auto engine = cloud(2, 1);
  const auto step_with = [&](Function function, bool contacts = false) {
    add(*engine, std::move(function), 1, contacts);
    return refusal_of([&] { engine->step(1); });
  };
  EXPECT_EQ(step_with([](auto&, auto*) -> AddedForce::Loads {
              return {RowMatrix::Zero(3, 2), {}};
            }),
            "mine: forces: found shape (3, 2), allowed: (40, 2)");
  EXPECT_EQ(step_with([](auto& g, auto*) -> AddedForce::Loads {
              return {0 * g.positions, RowMatrix::Zero(40, 3)};
            }),
            "mine: torques: found shape (40, 3), allowed: (40, 1)");
  EXPECT_EQ(step_with([](auto& g, auto*) -> AddedForce::Loads {
              RowMatrix f = 0 * g.positions;
              f(5, 1) = std::nan("");
              return {f, {}};
            }),
            "mine: forces: found nan on grain 5 at t = 0 s, allowed: finite numbers");
  EXPECT_THAT(step_with(
                  [](auto&, const ContactsNow* c) -> AddedForce::Loads {
                    return {INFINITY * c->normals.cwiseAbs(), {}};
                  },
                  true),
              HasSubstr("found inf on grain"));
  EXPECT_EQ(engine->steps(), 0);
  EXPECT_EQ(refusal_of([&] { engine->set_sleep(true); }),
            "sleep.on: found true with added forces, allowed: false (a sleeper would not feel "
            "them)");
  EXPECT_THAT(refusal_of([&] { add(*engine, nullptr, 0); }), HasSubstr("every: found 0"));
  EXPECT_THAT(refusal_of([&] { add(*engine, nullptr, 1, false, "a,b"); }),
              HasSubstr("found \"a,b\""));
  EXPECT_EQ(refusal_of([&] { added_forces(*engine).remove_force("other"); }),
            "found no added force \"other\", allowed: mine");
  EngineSettings s = settings_of(2, 1e-5);
  s.sleep.on = true;
  EXPECT_THAT(refusal_of([&] { add(*make_engine(s), nullptr); }), HasSubstr("sleep.on"));
  s.sleep.on = false;
  s.cell.periodic = {true, true, false};
  s.cell.edges = Eigen::Vector3d(1, 1, 0).asDiagonal();
  auto cell = make_engine(s);
  add(*cell, nullptr);
  Eigen::Matrix3d shear = Eigen::Matrix3d::Zero();
  shear(0, 1) = 1;
  EXPECT_EQ(refusal_of([&] { cell->set_velocity_gradient(shear); }),
            "cell: found one that flows, allowed with added forces: a cell at rest");
}

TEST(AddedForces, SnapshotsSaySoAndNoneGoesOnWithout) {
  auto engine = cloud(2, 1);
  EXPECT_EQ(engine->snapshot().attributes.count("added_forces"), 0U);
  add(
      *engine, [](const GrainsNow& g, auto*) { return spring(g, 1); }, 1, false, "well");
  add(*engine, sticky, 1, true, "glue");
  engine->step(5);
  const Snapshot s = engine->snapshot();
  EXPECT_EQ(s.attributes.at("added_forces"), "well, glue");
  EXPECT_EQ(refusal_of([&] { make_engine(settings_of(2, 1e-5), s); }),
            "the snapshot: forces of a Python function act on these grains: found \"well, glue\", "
            "allowed: none; go on in Python with gf.Engine and add_force");
}

// Across the faces of a cell: the image's side.
TEST(AddedForces, PairsAcrossAFacePullEachOther) {
  EngineSettings s = settings_of(2, 1e-5);
  s.cell.periodic = {true, true, false};
  s.cell.edges = Eigen::Vector3d(0.1, 0.1, 0).asDiagonal();
  auto engine = make_engine(s);
  engine->add(grain_at(0.009, 0.05));
  engine->add(grain_at(0.08901, 0.05));
  Vec3 normal(0, 0, 0);
  add(
      *engine,
      [&](const GrainsNow&, const ContactsNow* contacts) -> AddedForce::Loads {
        EXPECT_EQ(contacts->normals.rows(), 1);
        normal.x() = contacts->normals(0, 0);
        return {4 * contacts->normals, {}};
      },
      1, true);
  engine->step(1);
  EXPECT_DOUBLE_EQ(normal.x(), -1);  // from grain 0 to the left, where the image of grain 1 is
  const Snapshot end = engine->snapshot();
  EXPECT_LT(end.grains[0].velocity.x(), 0);
  EXPECT_EQ(end.grains[0].velocity.x(), -end.grains[1].velocity.x());
  const double stress = engine->cell_stress().contacts(0, 0);
  ASSERT_EQ(end.contacts.size(), 1U);
  // f_x b_x over the cell's area; the branch goes from grain 0 to the image of grain 1.
  EXPECT_NEAR(stress, end.contacts[0].force.x() * -0.02 / 0.01, 1e-3 * std::fabs(stress));
  EXPECT_NEAR(end.contacts[0].force.x(), 1 - 4, 0.01);
}

}  // namespace
}  // namespace grainfield::dem
