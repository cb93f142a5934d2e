// Boxes filled by dropping: loaded as they are, and filled once for several materials.
#include <gmock/gmock.h>

#include "coupling/studies/sample/simulation/drop.h"
#include "coupling/studies/sample/simulation/grains.h"
#include "coupling/studies/sample/simulation/path.h"
#include "coupling/studies/sample/simulation/sample.h"
#include "coupling/studies/sample/simulation/state.h"

namespace grainfield::dem {
namespace {

using testing::HasSubstr;

// Spheres, which are cheap: 150 of radius 1 that fall into a box.
SampleSetup dropped() {
  SampleSetup s;
  s.plan.dim = 3;
  s.plan.shape = "sphere";
  s.plan.grains = 150;
  s.plan.radius = 1;
  s.plan.boundary = "walls";
  s.plan.start_fraction = 0.2;
  s.plan.filling = "dropped";
  s.plan.drop_gravity = 5;
  s.plan.drop_damping = 1;
  s.plan.compress_to = "none";
  s.plan.deformation = "uniaxial";
  s.plan.strain = 0.04;
  s.plan.strain_rate = 0.1;
  s.plan.ramp_time = 0.01;
  s.plan.records = 4;
  s.material.law = "hertz";
  s.material.density = 1;
  s.material.young = 3e5;
  s.material.friction = s.material.wall_friction = 0.3;
  s.rest.background_damping = 2;
  s.rest.unbalanced_force_ratio = 0.02;
  s.rest.kinetic_to_elastic_energy = 1e-3;
  return s;
}

RunResult run(const SampleSetup& setup, std::uint64_t seed, const Snapshot* filled = nullptr) {
  const auto run = make_sample_run(setup, seed, 1, filled);
  while (!run->done()) run->advance(100000);
  return run->result();
}

const Snapshot& state(const RunResult& result, std::size_t number) {
  return result.snapshots.at(number).second;
}

double axial(const RunResult& result, std::size_t number) {
  return -sample_state(state(result, number)).contact_stress(2, 2);
}

const RunResult& packing() {
  static const RunResult one = run(dropped(), 5);
  return one;
}

TEST(FilledBoxes, AreLoadedWithoutAPressureBefore) {
  // What the grains' weight has left is far below what a strain of 0.01 brings.
  EXPECT_LT(axial(packing(), 0), 0.02 * axial(packing(), 1));
  EXPECT_LT(axial(packing(), 1), axial(packing(), 2));
  EXPECT_LT(axial(packing(), 2), axial(packing(), 4));
  EXPECT_GT(packing().figures.at("sample.gap_spheres"), 0);
  EXPECT_NEAR(sample_state(state(packing(), 0)).solid_fraction,
              packing().figures.at("sample.dropped_solid_fraction"), 1e-9);
}

// The base is that of grains of mean volume, whatever a seed draws.
TEST(FilledBoxes, HaveOneBase) {
  SamplePlan plan = dropped().plan;
  const auto few = sample_box(plan, 0.9 * mean_volume(plan)),
             many = sample_box(plan, 1.1 * mean_volume(plan));
  EXPECT_EQ(few[0], many[0]);
  EXPECT_NEAR(many[2] / few[2], 1.1 / 0.9, 1e-12);
}

// Fitted spheres touch what stops them, or are as large as they may be; hanging ones do not.
TEST(FilledBoxes, HaveSpheresThatFitBelowTheLid) {
  SamplePlan plan = dropped().plan;
  Snapshot bed = state(packing(), 0);
  bed.grains.resize(150);
  const auto loose = [&](const char* gap) {
    plan.gap = gap;
    Random random(3);
    const FilledBox box = put_lid_on(bed, plan, 1, random);
    EXPECT_GT(box.spheres, 5);
    const auto& grains = box.snapshot.grains;
    const double width = sample_box(plan, 1)[0];
    int out = 0;
    for (std::size_t k = 150; k < grains.size(); ++k) {
      const Grain& sphere = grains[k];
      EXPECT_NEAR(sphere.position.z() + sphere.radius, box.height, 1e-12);
      double room = std::min({sphere.position.x(), width - sphere.position.x(), sphere.position.y(),
                              width - sphere.position.y()}) -
                    sphere.radius;
      for (std::size_t j = 0; j < grains.size(); ++j) {
        if (j == k) continue;
        room = std::min(
            room, (grains[j].position - sphere.position).norm() - grains[j].radius - sphere.radius);
      }
      EXPECT_GT(room, -1e-12);
      out += room > 1e-4 && sphere.radius < sample_radii(plan).most * (1 - 1e-5);
    }
    return out;
  };
  EXPECT_EQ(loose("fitted"), 0);
  EXPECT_GT(loose("hanging"), 5);
}

TEST(FilledBoxes, AreLoadedAgainWithAnotherLaw) {
  SampleSetup other = dropped();
  other.material.law = "linear";
  other.material.normal_stiffness = 1e4;
  other.material.friction = other.material.wall_friction = 0;
  const RunResult again = run(other, 99, &state(packing(), 0));
  const Snapshot &before = state(packing(), 0), &first = state(again, 0);
  ASSERT_EQ(first.grains.size(), before.grains.size());
  for (std::size_t k = 0; k < first.grains.size(); ++k) {
    EXPECT_EQ(first.grains[k].position, before.grains[k].position) << k;
  }
  EXPECT_EQ(again.figures.at("sample.gap_spheres"), packing().figures.at("sample.gap_spheres"));
  for (const Wall& wall : first.walls) EXPECT_EQ(wall.friction, 0) << wall.name;
  // Frictionless, they carry about as much sideways as along the way.
  const auto ratio = [](const RunResult& result) {
    const auto s = sample_state(state(result, 4)).contact_stress;
    return s(0, 0) / s(2, 2);
  };
  EXPECT_GT(ratio(again), ratio(packing()) + 0.1);
}

// A checkpoint in the middle of the loading leads to the same bits.
TEST(FilledBoxes, GoOnFromACheckpoint) {
  const std::string file = testing::TempDir() + "filled_box.checkpoint";
  const Snapshot* filled = &state(packing(), 0);
  const auto half = make_sample_run(dropped(), 5, 1, filled);
  half->advance(400);
  ASSERT_FALSE(half->done());
  half->save(file);
  const auto rest = make_sample_run(dropped(), 5, 1, filled);
  rest->restore(file);
  while (!rest->done()) rest->advance(1000);
  const RunResult whole = run(dropped(), 5, filled), resumed = rest->result();
  for (std::size_t k = 0; k < state(whole, 4).grains.size(); ++k) {
    EXPECT_EQ(state(whole, 4).grains[k].position, state(resumed, 4).grains[k].position) << k;
  }
}

// From a compression that goes on without a rest: the grains move when the shear begins.
TEST(FilledBoxes, AreShearedFromAStateOnTheWay) {
  SampleSetup setup = dropped();
  setup.plan.precompression = 0.02;
  setup.plan.settle = "none";
  setup.plan.deformation = "simple_shear";
  setup.plan.constant = "volume";
  setup.plan.records = 1;
  const RunResult sheared = run(setup, 5, &state(packing(), 0));
  const double height = sample_state(state(packing(), 0)).edges(2, 2);
  EXPECT_NEAR(sample_state(state(sheared, 0)).edges(2, 2) / height, 0.98, 1e-3);
  // Two records of the packing's own compression lead to the same strain.
  EXPECT_NEAR(axial(sheared, 0) / axial(packing(), 2), 1, 0.1);
  double motion = 0;
  for (const Grain& g : state(sheared, 0).grains) motion += g.mass * g.velocity.squaredNorm();
  EXPECT_GT(motion, 0);
}

// What begins without stress is unloaded to a thousandth of the largest one.
TEST(FilledBoxes, AreUnloadedToNearlyNothing) {
  SampleSetup setup = dropped();
  setup.plan.unload = "stress";
  setup.plan.unload_records = 4;
  const RunResult result = run(setup, 5, &state(packing(), 0));
  const auto lid = [&](std::size_t k) { return sample_state(state(result, k)).moved_pressure.z(); };
  EXPECT_LE(lid(8), kLeastUnloaded * lid(4));
  // A quarter of the largest is asked for, every 20 steps.
  EXPECT_GT(lid(7), 10 * kLeastUnloaded * lid(4));
}

TEST(FilledBoxes, MistakesAreNamed) {
  const auto refusal = [](const auto& change, const Snapshot* filled) -> std::string {
    SampleSetup s = dropped();
    change(s);
    try {
      make_sample_run(s, 1, 1, filled);
      return "";
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
  };
  const Snapshot* filled = &state(packing(), 0);
  EXPECT_EQ(refusal([](SampleSetup&) {}, filled), "");
  EXPECT_THAT(refusal([](SampleSetup& s) { s.material.density = 2; }, filled),
              HasSubstr("material.density: found 2, allowed: 1"));
  EXPECT_THAT(refusal([](SampleSetup& s) { s.plan.grains = 1000; }, filled),
              HasSubstr("sample.grains: found 1000, allowed: up to the "));
  EXPECT_THAT(refusal(
                  [](SampleSetup& s) {
                    s.plan.shape = "superellipsoid";
                    s.plan.start_fraction = 0.1;
                    s.material.law = "penalty";
                  },
                  filled),
              HasSubstr("sample.shape: found \"superellipsoid\""));
  EXPECT_THAT(refusal([](SampleSetup& s) { s.plan.filling = "placed"; }, nullptr),
              HasSubstr("sample.compress_to: found \"none\", allowed with sample.filling = "
                        "\"placed\": pressure, solid_fraction, strain"));
}

}  // namespace
}  // namespace grainfield::dem
