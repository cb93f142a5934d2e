#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "coupling/studies/sample/simulation/sample.h"
#include "coupling/studies/sample/simulation/state.h"
#include "tests/all_cores.h"

namespace grainfield::dem {
namespace {

SampleSetup disks() {
  SampleSetup s;
  s.plan.grains = 120;
  s.plan.records = 2;
  s.plan.strain = 0.02;
  s.plan.strain_rate = 0.5;
  return s;
}

SampleSetup spheres() {
  SampleSetup s = disks();
  s.plan.dim = 3;
  s.plan.shape = "sphere";
  s.plan.grains = 60;
  s.plan.pressure = 1e5;
  s.material.density = 2500;
  s.material.friction = 0.05;  // with more it is loose enough to lose all of its stress
  return s;
}

SampleSetup box() {
  SampleSetup s = disks();
  s.plan.boundary = "walls";
  s.plan.deformation = "axial";
  s.plan.ramp_time = 0.01;
  s.plan.strain_rate = 0.05;
  return s;
}

RunResult finish(Run& run) {
  while (!run.done()) run.advance(20000);
  return run.result();
}

// Every number of the grains and the contacts' forces, as they are.
std::vector<double> numbers_of(const RunResult& result) {
  std::vector<double> out;
  for (const auto& [name, snapshot] : result.snapshots) {
    for (const Grain& g : snapshot.grains) {
      for (int a = 0; a < 3; ++a) {
        out.push_back(g.position[a]);
        out.push_back(g.velocity[a]);
      }
    }
    for (const Contact& c : snapshot.contacts) {
      out.push_back(c.normal_force);
      out.push_back(c.spring);
    }
  }
  return out;
}

class SampleTest : public testing::TestWithParam<SampleSetup (*)()> {
 protected:
  static constexpr int kSeed = 7;
  /// The setup's run on one thread, made once.
  static const RunResult& whole() {
    static std::map<SampleSetup (*)(), RunResult> made;
    const auto at = made.find(GetParam());
    if (at != made.end()) return at->second;
    const auto run = make_sample_run(GetParam()(), kSeed, 1);
    return made.emplace(GetParam(), finish(*run)).first->second;
  }
};

TEST_P(SampleTest, IsBroughtToItsPressureAndDeformed) {
  const SampleSetup setup = GetParam()();
  const RunResult& result = whole();
  ASSERT_EQ(result.snapshots.size(), 3U);
  EXPECT_EQ(result.snapshots[0].first, "state_000");
  const SampleState start = sample_state(result.snapshots[0].second);
  const int dim = setup.plan.dim;
  double pressure = 0;
  for (int a = 0; a < dim; ++a) pressure -= start.stress(a, a) / dim;
  EXPECT_NEAR(pressure, setup.plan.pressure, 0.01 * setup.plan.pressure);
  EXPECT_GT(start.solid_fraction, dim == 2 ? 0.75 : 0.5);
  EXPECT_LT(start.solid_fraction, dim == 2 ? 0.92 : 0.75);

  const SampleState end = sample_state(result.snapshots[2].second);
  if (setup.plan.deformation == "simple_shear") {
    EXPECT_NEAR(end.edges(0, dim - 1) / end.edges(dim - 1, dim - 1), setup.plan.strain,
                2e-5);  // whole steps
    EXPECT_NEAR(end.volume, start.volume, 1e-9 * start.volume);
    EXPECT_GT(end.stress(0, dim - 1), 0);  // it resists the shear
  } else {
    EXPECT_NEAR(std::log(start.edges(dim - 1, dim - 1) / end.edges(dim - 1, dim - 1)),
                setup.plan.strain, 0.1 * setup.plan.strain);
    EXPECT_LT(end.stress(dim - 1, dim - 1), start.stress(dim - 1, dim - 1));
    EXPECT_LT(result.figures.at("sample.stress_error"), 0.05);
  }
}

TEST_P(SampleTest, HasTheSameBitsOnThreadsAndAfterItWasSaved) {
  const SampleSetup setup = GetParam()();
  const std::string file = std::filesystem::temp_directory_path() /
                           fmt::format("sample_test_{}_{}", setup.plan.dim, setup.plan.boundary);
  const grainfield::test::AllCores cores;
  auto run = make_sample_run(setup, kSeed, 3);
  for (int k = 0; !run->done(); ++k) {
    run->advance(3001);
    if (k % 2 != 0) continue;
    run->save(file);
    run = make_sample_run(setup, kSeed, 1 + k % 4);
    run->restore(file);
  }
  std::filesystem::remove(file);
  EXPECT_EQ(numbers_of(run->result()), numbers_of(whole()));
}

// In a cell that a servo leads, decisions fall on other steps than the servo's.
TEST(SampleRun, RestsAtTheSameStepHoweverItIsCut) {
  const SampleSetup setup = disks();
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto whole = make_sample_run(setup, seed, 1), cut = make_sample_run(setup, seed, 1);
    const std::vector<double> expected = numbers_of(finish(*whole));
    while (!cut->done()) cut->advance(1);
    EXPECT_EQ(numbers_of(cut->result()), expected) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(All, SampleTest, testing::Values(disks, spheres, box));

}  // namespace
}  // namespace grainfield::dem
