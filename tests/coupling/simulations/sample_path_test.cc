// Samples that are prepared with another friction, shortened before they are deformed, and
// unloaded.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "coupling/studies/sample/simulation/path.h"
#include "coupling/studies/sample/simulation/sample.h"
#include "coupling/studies/sample/simulation/state.h"
#include "dem/shared/number.h"

namespace grainfield::dem {
namespace {

using testing::HasSubstr;

SampleSetup disks(const char* boundary, const char* deformation) {
  SampleSetup s;
  s.plan.grains = 80;
  s.plan.boundary = boundary;
  s.plan.deformation = deformation;
  s.plan.records = 3;
  s.plan.strain = 0.01;
  s.plan.strain_rate = 0.5;
  s.plan.ramp_time = 0.002;
  s.rest.kinetic_to_elastic_energy = 1e-4;
  s.plan.unload_records = 4;
  return s;
}

RunResult finish(const SampleSetup& setup, int threads = 1) {
  const auto run = make_sample_run(setup, 5, threads);
  while (!run->done()) run->advance(20000);
  return run->result();
}

double attribute(const Snapshot& s, const char* name) {
  return parse_number(s.attributes.at(name)).value();
}

double axial(const Snapshot& s) {
  const SampleState state = sample_state(s);
  return s.walls.empty() ? -state.stress(1, 1) : state.moved_pressure[1];
}

TEST(SamplePath, ComesBackByTheStrainThatItWent) {
  for (const char* boundary : {"periodic", "walls"}) {
    for (const char* deformation : {"uniaxial", "simple_shear"}) {
      SampleSetup setup = disks(boundary, deformation);
      setup.plan.unload = "strain";
      setup.plan.unload_strain = 0.5;
      const RunResult result = finish(setup);
      ASSERT_EQ(result.snapshots.size(), 8U);
      const SampleState first = sample_state(result.snapshots[0].second);
      for (std::size_t k = 0; k < 8; ++k) {
        const Snapshot& s = result.snapshots[k].second;
        const SampleState now = sample_state(s);
        const double expected = k <= 3 ? 0.01 * k / 3.0 : 0.01 * (1 - 0.5 * (k - 3.0) / 4);
        const double strain = attribute(s, "strain");
        EXPECT_NEAR(strain, expected, 5e-5) << boundary << deformation << k;  // whole steps
        const double ratio = now.edges(1, 1) / first.edges(1, 1);
        // A shear between walls follows a tilt that is corrected every 100 steps.
        if (setup.plan.deformation == "simple_shear") {
          EXPECT_NEAR(now.edges(0, 1) / now.edges(1, 1), strain, 3e-4) << boundary << k;
        } else {
          EXPECT_NEAR(s.walls.empty() ? -std::log(ratio) : 1 - ratio, strain, 1e-6)
              << boundary << k;
        }
      }
    }
  }
}

TEST(SamplePath, ComesBackToTheStressThatItHad) {
  for (const char* boundary : {"periodic", "walls"}) {
    SampleSetup setup = disks(boundary, "uniaxial");
    setup.plan.unload = "stress";
    setup.plan.strain_rate = 0.1;
    const RunResult result = finish(setup);
    ASSERT_EQ(result.snapshots.size(), 8U);
    const double start = axial(result.snapshots[0].second);
    const double most = axial(result.snapshots[3].second);
    ASSERT_GT(most, 2 * start);
    for (std::size_t k = 4; k < 8; ++k) {
      const double level = most + (k - 3.0) / 4 * (start - most);
      const double found = axial(result.snapshots[k].second);
      EXPECT_LE(found, level) << boundary << k;
      EXPECT_NEAR(found, level, 0.03 * most) << boundary << k;  // looked at every 20 steps
    }
    const double left = attribute(result.snapshots[7].second, "strain");
    EXPECT_GT(left, 0) << boundary;
    EXPECT_LT(left, 0.01) << boundary;
  }
}

TEST(SamplePath, OfADenserPreparationStartsWithTheFrictionOfTheMaterial) {
  SampleSetup setup = disks("periodic", "uniaxial");
  setup.plan.grains = 150;
  setup.plan.records = 1;
  const double loose = sample_state(finish(setup).snapshots[0].second).solid_fraction;
  setup.plan.prepared_with = "other_friction";
  const RunResult result = finish(setup);
  const SampleState first = sample_state(result.snapshots[0].second);
  EXPECT_GT(first.solid_fraction, loose + 0.01);
  EXPECT_NEAR(-first.stress.trace() / 2, setup.plan.pressure, 0.01 * setup.plan.pressure);
  double along_first = 0, along = 0;
  for (const Contact& c : result.snapshots[0].second.contacts) {
    along_first += std::fabs(c.tangential_force);
    EXPECT_EQ(c.friction, setup.material.friction);
  }
  for (const Contact& c : result.snapshots[1].second.contacts)
    along += std::fabs(c.tangential_force);
  EXPECT_LT(along_first, 1e-3 * along);  // none yet, but for dashpots
}

TEST(SamplePath, IsShortenedBeforeTheFirstState) {
  for (const char* boundary : {"periodic", "walls"}) {
    SampleSetup setup = disks(boundary, "simple_shear");
    setup.plan.records = 1;
    const SampleState plain = sample_state(finish(setup).snapshots[0].second);
    setup.plan.precompression = 0.02;
    const Snapshot first = finish(setup).snapshots[0].second;
    const SampleState state = sample_state(first);
    EXPECT_NEAR(state.edges(0, 0), plain.edges(0, 0), 1e-12) << boundary;
    const double ratio = state.edges(1, 1) / plain.edges(1, 1);
    EXPECT_NEAR(first.walls.empty() ? -std::log(ratio) : 1 - ratio, 0.02, 5e-5) << boundary;
    EXPECT_GT(-state.stress(1, 1), 2 * setup.plan.pressure) << boundary;
    EXPECT_LT(attribute(first, "unbalanced_force_ratio"), setup.rest.unbalanced_force_ratio);
  }
}

TEST(SamplePath, HasTheSameBitsOnThreadsAndAfterItWasSaved) {
  SampleSetup setup = disks("walls", "uniaxial");
  setup.plan.prepared_with = "other_friction";
  setup.plan.precompression = 0.005;
  setup.plan.unload = "stress";
  const RunResult whole = finish(setup);
  const std::string file =
      std::filesystem::temp_directory_path() / fmt::format("sample_path_test_{}", ::getpid());
  auto run = make_sample_run(setup, 5, 2);
  for (int k = 0; !run->done(); ++k) {
    run->advance(1501);
    run->save(file);
    run = make_sample_run(setup, 5, 1 + k % 3);
    run->restore(file);
  }
  std::filesystem::remove(file);
  const RunResult result = run->result();
  ASSERT_EQ(result.snapshots.size(), whole.snapshots.size());
  for (std::size_t k = 0; k < result.snapshots.size(); ++k) {
    const Snapshot &a = result.snapshots[k].second, &b = whole.snapshots[k].second;
    EXPECT_EQ(a.attributes, b.attributes);
    ASSERT_EQ(a.contacts.size(), b.contacts.size());
    for (std::size_t g = 0; g < a.grains.size(); ++g) {
      EXPECT_EQ(a.grains[g].position, b.grains[g].position);
    }
  }
}

TEST(SamplePath, ThatCannotBeGoneIsRefused) {
  const auto refusal = [](const auto& change) {
    SampleSetup s = disks("periodic", "uniaxial");
    change(s.plan);
    try {
      foresee_sample(s, {1}, 10);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal([](SamplePlan& p) { p.unload = "stress"; }), "accepted");
  EXPECT_EQ(refusal([](SamplePlan& p) {
              p.unload = "stress";
              p.deformation = "simple_shear";
            }),
            "sample.unload: found \"stress\", allowed with sample.deformation = "
            "\"simple_shear\": none, strain, because its axial stress drives nothing");
  EXPECT_EQ(refusal([](SamplePlan& p) {
              p.precompression = 0.1;
              p.deformation = "axial";
            }),
            "sample.precompression: found 0.1, allowed with sample.deformation = \"axial\": 0, "
            "because servos hold the pressure");
  EXPECT_THAT(refusal([](SamplePlan& p) {
                p.precompression = 0.1;
                p.deformation = "simple_shear";
                p.constant = "stress";
              }),
              HasSubstr("allowed with sample.constant = \"stress\": 0"));
}

}  // namespace
}  // namespace grainfield::dem
