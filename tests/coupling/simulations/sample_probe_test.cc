// Small strains: a crystal's moduli in closed form; samples whose path does not know that they were
// probed; a run that goes on from any moment of a probe.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "coupling/elastic_constants/probed.h"
#include "coupling/studies/sample/simulation/probe.h"
#include "coupling/studies/sample/simulation/sample.h"
#include "coupling/studies/sample/simulation/state.h"
#include "tests/paths.h"

namespace grainfield::dem {
namespace {

using Eigen::Matrix3d;

// Spheres of radius 1 on the places of a face-centred cubic crystal, three cubes along each edge.
constexpr double kOverlap = 1e-3, kSpring = 1;

EngineSettings crystal_settings() {
  EngineSettings s;
  s.shape = ShapeKind::sphere;
  s.law = LinearLaw{kSpring, 0, 1, 0};
  s.friction = 0;
  s.gravity_y = 0;
  s.time_step = 0.2;
  const double edge = 3 * std::numbers::sqrt2 * (2 - kOverlap);
  for (int a = 0; a < 3; ++a) {
    s.cell.periodic[static_cast<std::size_t>(a)] = true;
    s.cell.edges(a, a) = edge;
  }
  return s;
}

std::unique_ptr<Engine> crystal() {
  auto engine = make_engine(crystal_settings());
  const double a = std::numbers::sqrt2 * (2 - kOverlap);
  const double in[4][3] = {{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}};
  for (int k = 0; k < 27; ++k) {
    for (const auto& at : in) {
      NewGrain grain;
      grain.radius = 1;
      grain.density = 1;
      grain.x = a * (k % 3 + at[0] + 0.25);
      grain.y = a * (k / 3 % 3 + at[1] + 0.25);
      grain.z = a * (k / 9 + at[2] + 0.25);
      engine->add(grain);
    }
  }
  engine->step(1);
  return engine;
}

// Springs k between neighbours d apart: C11 = sqrt(2) k/d, C12 = C44 = C11/2 (Born and Huang 1954),
// less terms of the order of the pressure, here a thousandth.
TEST(SampleProber, FindsTheModuliOfACrystal) {
  SampleSetup setup;
  setup.plan.dim = 3;
  setup.plan.shape = "sphere";
  setup.plan.probe = "first";
  setup.plan.probe_strain = 1e-6;
  setup.rest.background_damping = 0.05;
  setup.rest.max_time = 1e5;
  SampleProber prober(setup);
  std::unique_ptr<Engine> engine = crystal();
  const std::string before = engine->checkpoint();
  const auto make = [] { return make_engine(crystal_settings()); };
  prober.begin(*engine, "first", false);
  for (bool done = false; !done;) {
    const long steps = prober.until_due();
    engine->step(steps);
    done = prober.decide(engine, steps, make);
  }
  EXPECT_EQ(engine->checkpoint(), before);
  ASSERT_EQ(prober.found().size(), 1U);
  const StateProbes& found = prober.found().front();
  ASSERT_EQ(found.probes.size(), 6U);
  const double c11 = std::numbers::sqrt2 * kSpring / (2 - kOverlap);
  for (const Probe& probe : found.probes) {
    const int a = probe.direction[0] - 'x', b = probe.direction[1] - 'x';
    const auto& [forth, back] = probe.outcomes;
    EXPECT_NEAR(forth.gradient(a, b), 1e-6, 1e-10);
    EXPECT_NEAR(back.gradient(b, a), -1e-6, 1e-10);
    const Matrix3d c = (forth.stress - back.stress) / 2e-6;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        double wanted = 0;
        if (a == b && i == j) wanted = i == a ? c11 : c11 / 2;
        // Both components of the strain: 2 C44.
        if (a != b && ((i == a && j == b) || (i == b && j == a))) wanted = c11;
        EXPECT_NEAR(c(i, j), wanted, 4e-3 * c11) << probe.direction << i << j;
      }
    }
    for (const ProbeOutcome& o : probe.outcomes) EXPECT_EQ(o.gained + o.lost + o.sliding, 0);
  }
}

SampleSetup spheres(const char* boundary, const char* probe) {
  SampleSetup s;
  s.plan.dim = 3;
  s.plan.shape = "sphere";
  s.plan.grains = 60;
  s.plan.radius = 1;
  s.plan.boundary = boundary;
  s.plan.start_fraction = 0.3;
  s.plan.pressure = 20;
  s.plan.compression_rate = 1;
  s.plan.prepared_with = "other_friction";
  s.plan.prepared_friction = 0.1;
  s.plan.precompression = 0.005;
  s.plan.probe = probe;
  s.plan.probe_strain = 1e-4;
  s.plan.deformation = "uniaxial";
  s.plan.strain = 0.01;
  s.plan.strain_rate = 0.1;
  s.plan.ramp_time = 0.01;
  s.plan.records = 1;
  s.material.law = "linear";
  s.material.density = 1;
  s.material.normal_stiffness = 1e4;
  s.material.tangential_stiffness = 5e3;
  s.material.normal_damping = s.material.tangential_damping = 20;
  s.material.wall_friction = 0.3;
  s.rest.background_damping = 5;
  s.rest.unbalanced_force_ratio = 0.01;
  s.rest.kinetic_to_elastic_energy = 1e-3;
  return s;
}

RunResult finish(const SampleSetup& setup, int threads) {
  const auto run = make_sample_run(setup, 5, threads);
  while (!run->done()) run->advance(20000);
  return run->result();
}

bool same_places(const Snapshot& a, const Snapshot& b) {
  for (std::size_t k = 0; k < a.grains.size(); ++k) {
    if (a.grains[k].position != b.grains[k].position) return false;
    if (a.grains[k].velocity != b.grains[k].velocity) return false;
  }
  return a.grains.size() == b.grains.size() && a.contacts.size() == b.contacts.size();
}

// Grains that part as they come to rest show no moduli, and waiting does not bring them back.
TEST(SampleProber, SaysThatNothingBearsLoad) {
  SampleSetup setup;
  setup.plan.dim = 3;
  setup.plan.shape = "sphere";
  setup.plan.probe = "first";
  setup.rest.background_damping = 0.05;
  setup.rest.max_time = 1e5;
  SampleProber prober(setup);
  std::unique_ptr<Engine> engine = crystal();
  const std::string before = engine->checkpoint();
  prober.begin(*engine, "first", false);
  const long steps = prober.until_due();
  const double time = static_cast<double>(steps) * engine->time_step();
  engine->set_velocity_gradient(kOverlap / time * Eigen::Matrix3d::Identity());
  engine->step(steps);
  EXPECT_TRUE(prober.decide(engine, steps, [] { return make_engine(crystal_settings()); }));
  ASSERT_EQ(prober.found().size(), 1U);
  const StateProbes& found = prober.found().front();
  EXPECT_THAT(found.lacking, ::testing::StartsWith("it bears no load"));
  EXPECT_TRUE(found.probes.empty());
  EXPECT_EQ(engine->checkpoint(), before);
}

// A grain that something pulls at does not come to rest: there are no moduli, and it is said why.
TEST(SampleProber, SaysThatGrainsDoNotRest) {
  SampleSetup setup;
  setup.plan.dim = 3;
  setup.plan.shape = "sphere";
  setup.plan.probe = "first";
  setup.rest.background_damping = 0.05;
  setup.rest.max_time = 100;
  SampleProber prober(setup);
  std::unique_ptr<Engine> engine = crystal();
  const std::string before = engine->checkpoint();
  prober.begin(*engine, "first", false);
  AppliedForce force;
  force.id = 7;
  force.fx = 0.1 * kSpring * kOverlap;
  engine->apply(force);
  bool done = false;
  int looks = 0;
  for (; !done && looks < 100; ++looks) {
    const long steps = prober.until_due();
    engine->step(steps);
    done = prober.decide(engine, steps, [] { return make_engine(crystal_settings()); });
  }
  EXPECT_EQ(looks, 3);  // 40 s each
  ASSERT_EQ(prober.found().size(), 1U);
  const StateProbes& found = prober.found().front();
  EXPECT_THAT(found.lacking,
              ::testing::StartsWith("its grains do not come to rest for a strain of 1e-05"));
  EXPECT_TRUE(found.probes.empty());
  EXPECT_EQ(engine->checkpoint(), before);
}

TEST(SampleProber, LeavesThePathAsItWas) {
  for (const char* boundary : {"periodic", "walls"}) {
    const RunResult plain = finish(spheres(boundary, "none"), 1);
    const RunResult probed = finish(spheres(boundary, "both"), 2);
    ASSERT_EQ(probed.snapshots.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_TRUE(same_places(plain.snapshots[k].second, probed.snapshots[k].second)) << boundary;
    }
    EXPECT_EQ(plain.figures, probed.figures);
    for (const std::string& state : probed_states()) {
      const StateProbes found = probes_of(probed.snapshots[0].second, state);
      ASSERT_EQ(found.probes.size(), boundary == std::string("walls") ? 4U : 6U);
      for (const Probe& probe : found.probes) {
        const int a = probe.direction[0] - 'x', b = probe.direction[1] - 'x';
        const Matrix3d e = probe.outcomes[0].gradient + probe.outcomes[0].gradient.transpose();
        EXPECT_NEAR(e(a, b), 2e-4, 1e-6) << probe.direction;
        EXPECT_NEAR(e.norm(), 2e-4 * (a == b ? 1 : std::numbers::sqrt2), 1e-6);
        // It resists: the work of both ways is above 0.
        const Matrix3d s = probe.outcomes[0].stress - probe.outcomes[1].stress;
        EXPECT_GT(s.cwiseProduct(e).sum(), 0);
        EXPECT_LT(probe.outcomes[0].lost, 0.05);
      }
    }
    EXPECT_TRUE(probes_of(plain.snapshots[0].second, "first").probes.empty());
  }
}

TEST(SampleProber, GoesOnFromAnyMoment) {
  const std::string file =
      fmt::format("{}/probe_{}.h5", std::filesystem::temp_directory_path().string(), ::getpid());
  const SampleSetup setup = spheres("walls", "both");
  const RunResult whole = finish(setup, 1);
  auto run = make_sample_run(setup, 5, 1);
  int taken = 0, in_probes = 0;
  while (!run->done()) {
    run->advance(777);
    if (run->done()) break;
    const bool probing = run->progress().phase == "probe";
    // Every second time in the probes, every twentieth in the rest.
    if (++taken % (probing ? 2 : 20) != 0) continue;
    in_probes += probing;
    run->save(file);
    run = make_sample_run(setup, 5, 2);
    run->restore(file);
  }
  std::filesystem::remove(file);
  EXPECT_GT(in_probes, 2);
  const RunResult parts = run->result();
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_TRUE(same_places(whole.snapshots[k].second, parts.snapshots[k].second));
    EXPECT_EQ(whole.snapshots[k].second.attributes, parts.snapshots[k].second.attributes);
    for (const auto& [name, table] : whole.snapshots[k].second.tables) {
      const NumberTable& other = parts.snapshots[k].second.tables.at(name);
      for (std::size_t c = 0; c < table.size(); ++c) EXPECT_EQ(table[c].values, other[c].values);
    }
  }
}

TEST(SampleProber, RefusesWhatItCannotDo) {
  const auto refusal = [](const SampleSetup& s) -> std::string {
    try {
      foresee_sample(s, {1}, 10);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "none";
  };
  SampleSetup s = spheres("periodic", "both");
  EXPECT_EQ(refusal(s), "none");
  s.rest.background_damping = 0;
  EXPECT_THAT(refusal(s), ::testing::HasSubstr("rest.background_damping: found 0"));
  s = {};
  s.plan.probe = "first";
  EXPECT_THAT(refusal(s),
              ::testing::HasSubstr("sample.probe: found \"first\", allowed with sample.dim = 2"));
}

TEST(ProbeRecord, ComesBack) {
  StateProbes all;
  all.state = "first";
  all.stress << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  for (const char* direction : {"xx", "xz"}) {
    Probe& probe = all.probes.emplace_back();
    probe.direction = direction;
    probe.outcomes[0].gradient = Matrix3d::Constant(0.1);
    probe.outcomes[1].stress = all.stress / 3;
    probe.outcomes[1].lost = 0.25;
  }
  const std::string file =
      fmt::format("{}/probes_{}.h5", std::filesystem::temp_directory_path().string(), ::getpid());
  Snapshot state;
  put_probes(all, state);
  write_snapshot(file, "/state_000", state);
  const Snapshot read = read_snapshot(file, "/state_000");
  std::filesystem::remove(file);
  const StateProbes back = probes_of(read, "first");
  EXPECT_EQ(back.stress, all.stress);
  ASSERT_EQ(back.probes.size(), 2U);
  EXPECT_EQ(back.probes[1].direction, "xz");
  EXPECT_EQ(back.probes[0].outcomes[0].gradient, all.probes[0].outcomes[0].gradient);
  EXPECT_EQ(back.probes[1].outcomes[1].stress, all.probes[1].outcomes[1].stress);
  EXPECT_EQ(back.probes[1].outcomes[1].lost, 0.25);
  EXPECT_TRUE(probes_of(read, "prepared").probes.empty());
  EXPECT_TRUE(read.attributes.empty());
  // A state that could not be probed.
  StateProbes none;
  none.state = "first";
  none.lacking = "it bears no load";
  put_probes(none, state);
  EXPECT_TRUE(state.tables.empty());
  EXPECT_EQ(probes_of(state, "first").lacking, none.lacking);
  EXPECT_TRUE(probes_of(state, "first").probes.empty());
}

// A file that version 0.9.0 wrote, with the numbers as text in attributes: thirty spheres in a
// cell. The moduli are those of its summary.
TEST(ProbeRecord, OfAFileOfVersion090HasItsNumbers) {
  const std::string file =
      std::string(GRAINFIELD_SOURCES) + "/tests/coupling/simulations/probes_0_9_0.h5";
  const Snapshot state = read_snapshot(file, "/realization_000/state_000");
  ASSERT_TRUE(state.tables.empty());
  const StateProbes old = probes_of(state, "first");
  const auto known = [](const StateProbes& probes) {
    EXPECT_EQ(probes.probes.size(), 6U);
    const coupling::ProbedPacking packing = coupling::probed_packing(probes);
    EXPECT_NEAR(packing.moduli.young / 14100102.15067388, 1, 1e-9);
    EXPECT_NEAR(packing.moduli.g_vh / 5067839.818800869, 1, 1e-9);
    EXPECT_NEAR(packing.nonlinear / 0.008515313859257346, 1, 1e-6);
  };
  known(old);
  Snapshot fresh;
  put_probes(old, fresh);
  known(probes_of(fresh, "first"));
}

TEST(ProbeRecord, IsRefusedWhereItIsBroken) {
  const auto refusal = [](const Snapshot& state) -> std::string {
    try {
      probes_of(state, "first");
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "none";
  };
  StateProbes all;
  all.state = "first";
  add_outcome(all, "xx", 0, {});
  Snapshot state;
  put_probes(all, state);
  EXPECT_EQ(refusal(state), "none");
  NumberTable& table = state.tables.at("probes_first");
  table[1].values[1] = 4;
  EXPECT_EQ(refusal(state), "table \"probes_first\": found axis 4, allowed: 1, 2, 3");
  table[1].name = "x";
  EXPECT_EQ(refusal(state), "table \"probes_first\": column across is missing");
  Snapshot old;
  old.attributes["probe.first.xz.back"] = "1 2 three";
  EXPECT_EQ(refusal(old), "attribute \"probe.first.xz.back\": found 2 numbers, allowed: 21");
}

}  // namespace
}  // namespace grainfield::dem
