// A point load on layers of spheres: where they start, balance, linearity, restart to the same
// bits, and what is refused.
#include <gmock/gmock.h>

#include <cmath>

#include "coupling/studies/point_load/layer.h"
#include "coupling/studies/point_load/layer_probe.h"
#include "coupling/studies/point_load/simulation.h"
#include "dem/grains/layer_3d.h"
#include "dem/run/outlook.h"
#include "dem/snapshot/contact_changes.h"
#include "tests/coupling/finished_run.h"
#include "tests/dem/imbalance.h"
#include "tests/refusal.h"

namespace grainfield::dem {
namespace {

PointLoadSetup spheres(const std::string& kind) {
  PointLoadSetup s;
  s.packing.dim = 3;
  s.packing.kind = kind;
  s.packing.sizes = kind == "random" ? "uniform" : "mono";
  s.packing.radius = 0.005;
  s.packing.radius_min = 0.0045;
  s.packing.radius_max = 0.0055;
  s.packing.columns = 6;
  s.packing.rows = 3;
  s.packing.width = 0.06;
  s.packing.depth = 0.03;
  s.material.law = "hertz";
  s.material.density = 2500;
  s.material.young = 1e7;
  s.material.damping = 0.3;
  s.rest.background_damping = 60;
  s.load.ramp_time = 0.02;
  s.load.weights = 1;
  return s;
}

RunResult result_of(const PointLoadSetup& s, std::uint64_t seed = 3, int threads = 1) {
  return finished(make_point_load_run(s, seed, threads));
}

TEST(SpaceLoad, BaseCarriesWeightAndLoad) {
  for (const std::string kind : {"close_packed", "random"}) {
    for (const char* floor : {"smooth", "rough"}) {
      for (const char* sides : {"periodic", "walls"}) {
        // Where a close packing ends at a wall some spheres are held by nothing and creep.
        const bool walled = std::string(sides) == "walls", rough = std::string(floor) == "rough";
        if (kind == "close_packed" && walled) continue;
        if (kind == "random" && walled != rough) continue;  // half of the four: they take long
        PointLoadSetup s = spheres(kind);
        s.packing.floor = floor;
        s.packing.sides = sides;
        const RunResult r = result_of(s);
        const std::string what = kind + " " + floor + " " + sides;
        EXPECT_NEAR(r.figures.at("base.weight_ratio"), 1, 1e-4) << what;
        EXPECT_NEAR(r.figures.at("base.response_over_load"), 1, 1e-2) << what;
        EXPECT_DOUBLE_EQ(r.figures.at("load.force_over_weight"), 1) << what;
        ASSERT_EQ(r.snapshots.size(), 2U);
        for (const auto& [name, state] : r.snapshots) {
          EXPECT_EQ(state.dim, 3);
          expect_balanced(state, 1e-6, what + name);
        }
        EXPECT_NEAR(r.snapshots[1].second.applied_force.z(), -force_of_load(s), 1e-15);
        EXPECT_EQ(r.snapshots[0].second.cell.is_periodic(), std::string(sides) == "periodic");
      }
    }
  }
}

TEST(SpaceLoad, LinearLawToo) {
  PointLoadSetup s = spheres("random");
  s.material.law = "linear";
  s.material.normal_stiffness = 1e4;
  s.material.tangential_stiffness = 3e3;
  s.material.normal_damping = 300;
  s.material.tangential_damping = 150;
  const RunResult r = result_of(s);
  EXPECT_NEAR(r.figures.at("base.weight_ratio"), 1, 1e-4);
  EXPECT_NEAR(r.figures.at("base.response_over_load"), 1, 1e-2);
}

PointLoadSetup superellipsoids() {
  PointLoadSetup s = spheres("random");
  s.packing.shape = "superellipsoid";
  s.packing.width = 0.07;
  s.packing.depth = 0.02;
  s.material.law = "hertz_elliptic";
  s.material.young = 3e6;
  return s;
}

TEST(SpaceLoad, SuperellipsoidsToo) {
  for (const char* floor : {"smooth", "rough"}) {
    PointLoadSetup s = superellipsoids();
    s.packing.floor = floor;
    const Outlook seen = foresee_point_load(s, {3}, 100000);
    const RunResult r = result_of(s), again = result_of(s, 3, 2);
    EXPECT_EQ(seen.time_step, r.figures.at("dem.time_step"));
    EXPECT_NEAR(seen.grains, r.figures.at("dem.grains"), 0.1 * seen.grains);
    EXPECT_NEAR(r.figures.at("base.weight_ratio"), 1, 1e-4) << floor;
    EXPECT_NEAR(r.figures.at("base.response_over_load"), 1, 1e-2) << floor;
    EXPECT_EQ(r.figures, again.figures) << "two threads";
    double volume = 0, top = 0;
    for (const Grain& g : r.snapshots[0].second.grains) {
      EXPECT_GT(g.axes.minCoeff(), 0);
      if (g.fixed) continue;
      volume += g.volume;
      top = std::max(top, g.position.z() + g.radius);
    }
    EXPECT_NEAR(volume / (0.07 * 0.07 * 0.02), kSettledFraction, 0.05);
    EXPECT_LT(top, 0.04);
    for (const auto& [name, state] : r.snapshots) expect_balanced(state, 1e-6, floor + name);
  }
}

// By Newton's method as by slow damped dynamics, on one grain and on several.
TEST(SpaceLoad, BothMethodsAgree) {
  for (const double radius : {0.0, 0.012}) {
    PointLoadSetup s = spheres("random");
    s.load.weights = 0.05;
    s.load.radius = radius;
    s.load.ramp_time = 0.1;
    s.rest.unbalanced_force_ratio = 1e-7;
    const RunResult damped = result_of(s);
    s.load.method = "newton";
    s.load.unbalanced_force_ratio = 1e-7;
    const RunResult newton = result_of(s);
    const Snapshot &a = damped.snapshots[1].second, &b = newton.snapshots[1].second;
    EXPECT_EQ(a.loaded_grain, b.loaded_grain);
    EXPECT_EQ(a.also_loaded, b.also_loaded);
    EXPECT_EQ(a.also_loaded.empty(), radius == 0);
    EXPECT_NEAR(newton.figures.at("base.response_over_load"), 1, 1e-3);
    EXPECT_GT(newton.figures.at("load.iterations"), 0);
    const auto sunk = [](const RunResult& r) {
      const Snapshot &from = r.snapshots[0].second, &to = r.snapshots[1].second;
      const auto k = static_cast<std::size_t>(to.loaded_grain);
      return from.grains[k].position.z() - to.grains[k].position.z();
    };
    EXPECT_NEAR(sunk(newton) / sunk(damped), 1, 0.02) << radius;
    expect_balanced(b, 1e-6);
  }
}

// Rest and load of superellipsoids by Newton's method are those of slow damped dynamics, and twice
// the load sinks a grain twice as deep, as the contacts stay. Small strains work on the layer.
TEST(SpaceLoad, SuperellipsoidsByNewtonsMethod) {
  PointLoadSetup s = superellipsoids();
  s.packing.depth = 0.05;  // five grains or more can be strained
  s.motion.local_damping = 0.2;
  s.rest = {1e-7, 1e-7, 10, 20};
  s.load.weights = 0.002;
  s.load.ramp_time = 0.1;
  const RunResult damped = result_of(s);
  s.load.rest = "newton";
  s.load.probe_strain = 1e-6;
  const RunResult rested = result_of(s);
  s.load.method = "newton";
  const RunResult newton = result_of(s), again = result_of(s, 3, 2);
  EXPECT_EQ(newton.figures, again.figures) << "two threads";
  const auto sunk = [](const RunResult& r) {
    const Snapshot &from = r.snapshots[0].second, &to = r.snapshots[1].second;
    const auto k = static_cast<std::size_t>(to.loaded_grain);
    return from.grains[k].position.z() - to.grains[k].position.z();
  };
  for (const RunResult* r : {&rested, &newton}) {
    ASSERT_EQ(r->figures.at("rest.by_newton"), 1);
    EXPECT_NEAR(r->figures.at("base.weight_ratio"), 1, 1e-6);
    EXPECT_NEAR(r->figures.at("base.response_over_load"), 1, r == &newton ? 1e-3 : 1e-2);
    EXPECT_NEAR(r->figures.at("dem.contacts") / damped.figures.at("dem.contacts"), 1, 5e-3);
    EXPECT_EQ(r->snapshots[1].second.loaded_grain, damped.snapshots[1].second.loaded_grain);
    EXPECT_NEAR(sunk(*r) / sunk(damped), 1, 0.02);
  }
  for (const auto& [name, state] : newton.snapshots) expect_balanced(state, 1e-7, name);
  const StateProbes strained = probes_of(newton.snapshots[0].second, kProbedLayer);
  ASSERT_EQ(strained.probes.size(), 6U);
  for (std::size_t a = 0; a < 3; ++a) {
    const Eigen::Matrix3d more = strained.probes[a].outcomes[0].stress - strained.stress;
    const auto k = static_cast<Eigen::Index>(a);
    EXPECT_GT(more(k, k), 0) << a;  // tension positive: stretched
    EXPECT_LT((more - more.transpose()).norm(), 0.02 * more.norm()) << a;
  }
  s.load.weights = 0.004;
  const RunResult twice = result_of(s);
  EXPECT_EQ(twice.figures.at("load.no_rearrangement"), 1);
  EXPECT_NEAR(sunk(twice) / sunk(newton), 2, 0.02);
}

// Finished by Newton's method the rest is that of damped dynamics, of a large packing too.
TEST(SpaceLoad, ComesToRestByNewtonsMethod) {
  for (const double width : {0.06, 0.12}) {
    PointLoadSetup s = spheres("random");
    s.packing.width = width;
    s.motion.local_damping = 0.2;
    // A layer of 600 spheres is nearer to rest before Newton's method finds it.
    s.rest = {1e-7, width < 0.1 ? 1e-5 : 1e-8, 10, 20};
    s.load.weights = 0.1;
    const RunResult damped = result_of(s);
    s.load.rest = "newton";
    const RunResult newton = result_of(s), again = result_of(s, 3, 2);
    ASSERT_EQ(newton.figures.at("rest.by_newton"), 1) << width;
    EXPECT_EQ(newton.figures, again.figures) << "two threads";
    EXPECT_LT(newton.figures.at("dem.steps"),
              (width < 0.1 ? 0.9 : 1) * damped.figures.at("dem.steps"));
    for (const auto& [name, state] : newton.snapshots) expect_balanced(state, 1e-7, name);
    EXPECT_NEAR(newton.figures.at("base.weight_ratio"), 1, 1e-6);
    EXPECT_NEAR(newton.figures.at("base.response_over_load"), 1, 1e-2);
    EXPECT_NEAR(newton.figures.at("dem.contacts") / damped.figures.at("dem.contacts"), 1, 5e-3);
  }
}

// The grains seen from above within the radius share the force.
TEST(SpaceLoad, ADiskOfGrainsSharesTheForce) {
  PointLoadSetup s = spheres("random");
  s.load.weights = 2;
  s.load.radius = 0.015;
  const RunResult r = result_of(s);
  const Snapshot& loaded = r.snapshots[1].second;
  ASSERT_GT(loaded.also_loaded.size(), 2U);
  EXPECT_EQ(r.figures.at("load.grains"), 1.0 + static_cast<double>(loaded.also_loaded.size()));
  EXPECT_NEAR(total_applied_force(loaded).z(), -force_of_load(s), 1e-12 * force_of_load(s));
  EXPECT_NEAR(r.figures.at("base.response_over_load"), 1, 1e-2);
  expect_balanced(loaded, 1e-6);
  const Grain& middle = loaded.grains[static_cast<std::size_t>(loaded.loaded_grain)];
  for (const std::int64_t id : loaded.also_loaded) {
    const Vec3 way = loaded.grains[static_cast<std::size_t>(id)].position - middle.position;
    EXPECT_LE(way.head<2>().norm(), s.load.radius * 1.01);
    EXPECT_LT(way.z(), 0);
  }
  // Written and read again, and an engine goes on from it.
  const FileOfRun file("disk");
  write_snapshot(file.path(), "/loaded", loaded);
  EXPECT_EQ(read_snapshot(file.path(), "/loaded").also_loaded, loaded.also_loaded);
  const auto engine = make_engine(Layer<3>::settings(s, {}, 1), loaded);
  engine->step(1);
  EXPECT_LT(engine->measure().unbalanced_force_ratio, 1e-5);
}

// Half the force moves every grain half as far, as long as no contact changes.
TEST(SpaceLoad, ResponseIsLinearWithoutRearrangement) {
  PointLoadSetup s = spheres("random");
  s.rest.unbalanced_force_ratio = 1e-9;
  s.rest.kinetic_to_elastic_energy = 1e-16;
  s.load.weights = 0.002;
  const RunResult whole = result_of(s);
  s.load.weights = 0.001;
  const RunResult half = result_of(s);
  ASSERT_EQ(whole.figures.at("load.no_rearrangement"), 1);
  ASSERT_EQ(half.figures.at("load.no_rearrangement"), 1);
  const Snapshot& from = whole.snapshots[0].second;
  ASSERT_TRUE(same(from, half.snapshots[0].second));
  double moved = 0, off = 0;
  for (std::size_t k = 0; k < from.grains.size(); ++k) {
    const Vec3 a = whole.snapshots[1].second.grains[k].position - from.grains[k].position;
    const Vec3 b = half.snapshots[1].second.grains[k].position - from.grains[k].position;
    moved += a.squaredNorm();
    off += (a - 2 * b).squaredNorm();
  }
  ASSERT_GT(moved, 0);
  EXPECT_LT(std::sqrt(off / moved), 0.02);
}

TEST(SpaceLoad, ResumesToTheSameBitsOnAnyThreads) {
  const FileOfRun file("space_load");
  PointLoadSetup s = spheres("random");
  s.packing.floor = "rough";
  s.rest.unbalanced_force_ratio = 1e-4;
  const auto make = [&](int threads) { return make_point_load_run(s, 9, threads); };
  const RunResult expected = finished(make(1));
  Random random(1);
  expect_same_after_stops(make, expected, expected.figures.at("dem.steps"), 4, file, random);
  const auto other = make_point_load_run(s, 10, 1);
  EXPECT_THROW(other->restore(file.path()), std::invalid_argument);
}

std::string refusal(const PointLoadSetup& s) {
  return refusal_of([&] { make_point_load_run(s, 1, 1); });
}

TEST(SpaceLoad, RefusesWhatCannotBe) {
  using ::testing::HasSubstr;
  PointLoadSetup s = spheres("random");
  s.packing.kind = "layered";
  EXPECT_THAT(refusal(s), HasSubstr("packing.kind: found layered, allowed: close_packed, random"));
  s = spheres("random");
  s.packing.width = 0.02;
  EXPECT_THAT(refusal(s), HasSubstr("packing.width: found 0.02"));
  s = spheres("random");
  s.packing.depth = 0.001;
  EXPECT_THAT(refusal(s), HasSubstr("packing.depth: found 0.001"));
  s = spheres("random");
  s.packing.radius_max = 0.001;
  EXPECT_THAT(refusal(s), HasSubstr("packing.radius_max: found 0.001"));
  s = spheres("close_packed");
  s.packing.sizes = "uniform";
  EXPECT_THAT(refusal(s), HasSubstr("packing.sizes: found uniform, allowed: mono"));
  s = spheres("close_packed");
  s.packing.columns = 2;
  EXPECT_THAT(refusal(s), HasSubstr("packing.columns: found 2, allowed: 4 or more"));
  s = spheres("close_packed");
  s.packing.spacing = 0.8;
  EXPECT_THAT(refusal(s), HasSubstr("packing.spacing: found 0.8, allowed: 0.9 to 1 with"));
  s.packing.spacing = 0.95;
  s.packing.sides = "walls";
  EXPECT_THAT(refusal(s), HasSubstr("packing.spacing: found 0.95, allowed: 1 between walls"));
  s = spheres("random");
  s.load.method = "newton";
  s.material.law = "hertz_elliptic";
  EXPECT_THAT(refusal(s),
              HasSubstr("material.law: found hertz_elliptic, allowed for quasi-static"));
  s.material.law = "hertz";
  s.load.method = "damped";
  s.load.probe_strain = 1e-6;
  s.packing.sides = "walls";
  EXPECT_THAT(refusal(s),
              HasSubstr("load.probe_strain: found 1e-06 with packing.sides = \"walls\""));
  s = superellipsoids();
  s.load.probe_strain = 1e-6;
  s.motion.energy_balance = true;
  EXPECT_THAT(refusal(s), HasSubstr("load.probe_strain: found 1e-06 with motion.energy_balance = "
                                    "true, allowed: 0 (the quasi-static solver"));
  s = superellipsoids();
  s.packing.axis_min = 2;
  EXPECT_THAT(refusal(s), HasSubstr("packing.axis_min: found 2, allowed: up to packing.axis_max"));
  s = superellipsoids();
  s.material.rolling_friction = 0.1;
  s.material.rolling_stiffness = 10;
  EXPECT_THAT(refusal(s), HasSubstr("rolling"));
  s = spheres("close_packed");
  s.packing.shape = "superellipsoid";
  EXPECT_THAT(refusal(s), HasSubstr("packing.shape: found superellipsoid, allowed: disk"));
  s = spheres("random");
  s.motion.time_step = 1;
  EXPECT_THAT(refusal(s), HasSubstr("motion.time_step: found 1 s, allowed: at most "));
}

TEST(SpaceLoad, IsForeseen) {
  for (const char* kind : {"random", "close_packed"}) {
    PointLoadSetup s = spheres(kind);
    s.packing.floor = "rough";
    const Outlook seen = foresee_point_load(s, {1}, 1000);
    const RunResult r = result_of(s, 1);
    EXPECT_NEAR(seen.grains, r.figures.at("dem.grains"), 0.03 * seen.grains) << kind;
    double fixed = 0;
    for (const Grain& g : r.snapshots[0].second.grains) fixed += g.fixed ? 1 : 0;
    EXPECT_EQ(seen.fixed, fixed) << kind;
    EXPECT_EQ(seen.time_step, r.figures.at("dem.time_step")) << kind;
    EXPECT_LT(seen.time, r.figures.at("dem.steps") * seen.time_step) << kind;
  }
  PointLoadSetup wide = spheres("random");
  wide.packing.width = 10;
  wide.packing.depth = 1;
  try {
    foresee_point_load(wide, {1}, 1000);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("packing.width: found 10 m, allowed: up to "));
  }
}

// Twelve neighbours inside, nine on the outer layers, as fcc and hcp have them; seen in the cell.
TEST(SpaceLayer, ClosePackingsTouchWithoutOverlap) {
  for (const char* stacking : {"fcc", "hcp"}) {
    for (const char* floor : {"smooth", "rough"}) {
      PackingSetup p = spheres("close_packed").packing;
      p.stacking = stacking;
      p.floor = floor;
      Random random(1);
      std::vector<NewGrain> all = floor_3d(p, 1, random);
      const std::size_t fixed = all.size();
      for (const NewGrain& g : grains_3d(p, 1, random)) all.push_back(g);
      ASSERT_EQ(all.size() - fixed, static_cast<std::size_t>(layer_spheres(p)));
      ASSERT_EQ(static_cast<double>(fixed), floor_spheres(p));
      const auto sides = layer_sides(p);
      const double d = 2 * p.radius;
      std::size_t touching = 0;
      for (std::size_t i = 0; i < all.size(); ++i) {
        for (std::size_t j = i + 1; j < all.size(); ++j) {
          double x = all[i].x - all[j].x, y = all[i].y - all[j].y;
          x -= sides[0] * std::round(x / sides[0]);
          y -= sides[1] * std::round(y / sides[1]);
          const double gap = std::sqrt(x * x + y * y + std::pow(all[i].z - all[j].z, 2)) - d;
          EXPECT_GT(gap, -1e-9 * d) << stacking << " " << floor;
          if (gap < 1e-9 * d) ++touching;
        }
      }
      // In a layer three bonds a sphere, from layer to layer three more.
      const std::size_t layer = all.size() / (fixed > 0 ? 4 : 3);
      EXPECT_EQ(touching, 3 * all.size() + 3 * (all.size() - layer)) << stacking << " " << floor;
    }
  }
}

// Pressed together along the layers: six neighbours overlap by what was asked, those of the layers
// above and below touch as before.
TEST(SpaceLayer, CloserLayersStandHigher) {
  PackingSetup p = spheres("close_packed").packing;
  p.spacing = 0.98;
  Random random(1);
  const std::vector<NewGrain> all = grains_3d(p, 1, random);
  const auto sides = layer_sides(p);
  const double d = 2 * p.radius;
  EXPECT_DOUBLE_EQ(sides[0], p.columns * 0.98 * d);
  std::size_t touching = 0, pressed = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      double x = all[i].x - all[j].x, y = all[i].y - all[j].y;
      x -= sides[0] * std::round(x / sides[0]);
      y -= sides[1] * std::round(y / sides[1]);
      const double apart = std::sqrt(x * x + y * y + std::pow(all[i].z - all[j].z, 2)) / d;
      if (std::fabs(apart - 0.98) < 1e-9) ++pressed;
      if (std::fabs(apart - 1) < 1e-9) ++touching;
      EXPECT_GT(apart, 0.98 - 1e-9);
    }
  }
  EXPECT_EQ(pressed, 3 * all.size());
  EXPECT_EQ(touching, 3 * (all.size() - all.size() / 3));
}

TEST(SpaceLayer, FccAndHcpDifferInTheThirdLayer) {
  PackingSetup p = spheres("close_packed").packing;
  Random random(1);
  const auto offset = [&](const char* stacking) {
    p.stacking = stacking;
    const auto grains = grains_3d(p, 1, random);
    const std::size_t layer = grains.size() / 3;
    const auto sides = layer_sides(p);
    double least = 1;
    for (std::size_t k = 0; k < layer; ++k) {
      double x = grains[2 * layer].x - grains[k].x, y = grains[2 * layer].y - grains[k].y;
      x -= sides[0] * std::round(x / sides[0]);
      y -= sides[1] * std::round(y / sides[1]);
      least = std::min(least, std::hypot(x, y));
    }
    return least;
  };
  EXPECT_NEAR(offset("hcp"), 0, 1e-12);
  EXPECT_NEAR(offset("fcc"), 2 * p.radius / std::sqrt(3.0), 1e-12);
}

// A free grain of the least size nowhere sinks to the centres of a rough floor.
TEST(SpaceLayer, FloorsLeaveNoGap) {
  for (const double least : {0.0045, 0.003, 0.0015}) {
    PackingSetup p = spheres("random").packing;
    p.floor = "rough";
    p.radius_min = least;
    p.width = 0.1;
    check_packing(p);
    Random random(5), places(6);
    const std::vector<NewGrain> floor = floor_3d(p, 2500, random);
    for (int k = 0; k < 3000; ++k) {
      const double x = places.uniform(-0.5, 0.5) * p.width, y = places.uniform(-0.5, 0.5) * p.width;
      bool touches = false;
      for (const NewGrain& g : floor) {
        const double dx = std::remainder(g.x - x, p.width), dy = std::remainder(g.y - y, p.width);
        touches = touches || std::hypot(dx, dy) < g.radius + least;
      }
      EXPECT_TRUE(touches) << least << " at " << x << " " << y;
    }
  }
  PointLoadSetup s = spheres("random");
  s.packing.floor = "rough";
  s.packing.radius_min = 0.0005;
  EXPECT_THAT(refusal(s), ::testing::HasSubstr("packing.floor: found rough, allowed: smooth"));
}

TEST(SpaceLayer, MeanVolumeIsThatOfTheDraws) {
  for (const char* sizes : {"mono", "bidisperse", "uniform"}) {
    PackingSetup p = spheres("random").packing;
    p.sizes = sizes;
    p.radius_small = 0.003;
    p.fraction_small = 0.4;
    p.radius_min = 0.002;
    Random random(5);
    double volume = 0, radius = 0;
    constexpr int kDraws = 40000;
    for (int k = 0; k < kDraws; ++k) {
      const double r = draw_radius(p, random);
      volume += 4.0 / 3 * M_PI * r * r * r / kDraws;
      radius += r / kDraws;
    }
    EXPECT_NEAR(mean_sphere_volume(p), volume, 0.02 * volume) << sizes;
    EXPECT_NEAR(mean_sphere_radius(p), radius, 0.01 * radius) << sizes;
    p.shape = "superellipsoid";
    p.width = 0.3;
    const std::vector<ShapedGrain> drawn =
        draw_layer(p, random, [left = 20000]() mutable { return left-- > 0; });
    double mean = 0, reach = 0;
    for (const ShapedGrain& g : drawn) {
      mean += g.area / static_cast<double>(drawn.size());
      reach = std::max(reach, g.radius);
    }
    EXPECT_GT(drawn.size(), 2500U);
    EXPECT_NEAR(mean_sphere_volume(p), mean, 0.03 * mean) << sizes;
    EXPECT_LE(reach, farthest_reach(p));
    EXPECT_GT(reach, 0.6 * farthest_reach(p));
  }
}

// A sphere carried over the end of the cell has hardly moved.
TEST(ContactChanges, KnowTheCell) {
  Snapshot a;
  a.dim = 3;
  a.cell.periodic = {true, true, false};
  a.cell.edges = Eigen::Vector3d(1, 1, 0).asDiagonal();
  a.grains.resize(1);
  a.grains[0].radius = 0.1;
  a.grains[0].position = Vec3(0.999, 0.5, 0);
  Snapshot b = a;
  b.grains[0].position.x() = 0.001;
  b.grains[0].image = {1, 0, 0};
  EXPECT_NEAR(compare_contacts(a, b).max_displacement_over_radius, 0.02, 1e-12);
}

}  // namespace
}  // namespace grainfield::dem
