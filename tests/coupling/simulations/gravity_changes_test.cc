// A packing goes on from its snapshot, and a pile that stands already is brought to rest under
// another gravity as the run that poured it would have done.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "coupling/studies/pile/simulation.h"
#include "dem/engine/engine.h"
#include "dem/run/run.h"
#include "dem/shapes/polygon.h"
#include "tests/coupling/finished_run.h"

namespace grainfield::dem {
namespace {

PileSetup poured(const std::string& shape) {
  PileSetup s;
  s.shape.kind = shape;
  s.shape.radius = 0.0275;
  s.source.grains = 40;
  s.source.height = 0.8;
  s.source.interval = 0.12;
  s.floor.length = 4;
  s.floor.kind = shape == "disk" ? "rough" : "smooth";
  s.rest.unbalanced_force_ratio = 1e-3;
  s.rest.kinetic_to_elastic_energy = 1e-4;
  s.change.method = "damped";
  s.change.gravity = {5, 8.829};
  s.change.ramp_time = 0.05;
  return s;
}

/// Largest difference of places over the radius, and of forces over the largest.
std::pair<double, double> difference(const Snapshot& a, const Snapshot& b) {
  double place = 0, force = 0, largest = 0;
  for (std::size_t k = 0; k < a.grains.size(); ++k) {
    place =
        std::max(place, (a.grains[k].position - b.grains[k].position).norm() / a.grains[k].radius);
  }
  for (std::size_t k = 0; k < a.contacts.size(); ++k) {
    force = std::max(force, (a.contacts[k].force - b.contacts[k].force).norm());
    largest = std::max(largest, a.contacts[k].force.norm());
  }
  return {place, force / largest};
}

// In motion and half settled: the worst case for what a snapshot may have left out.
TEST(GravityChanges, AnEngineGoesOnFromASnapshot) {
  for (const bool polygons : {false, true}) {
    EngineSettings settings;
    settings.law = OverlapAreaLaw{1e6, 0.75};
    settings.time_step = 1e-5;
    settings.shape = polygons ? ShapeKind::polygon : ShapeKind::disk;
    const auto engine = make_engine(settings);
    engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.5});
    engine->add_wall({"left", {-0.015, 0, 0}, {1, 0, 0}, 0.5});
    engine->add_wall({"right", {0.14, 0, 0}, {-1, 0, 0}, 0.5});
    for (int k = 0; k < 30; ++k) {
      NewGrain g;
      g.x = 0.021 * (k % 6) + 0.004 * (k % 5);
      g.y = 0.012 + 0.024 * (k / 6);
      g.vx = k % 2 == 0 ? 0.1 : -0.1;
      g.radius = 0.01;
      g.density = 5000;
      if (polygons) {
        const int corners = 5 + k % 4;
        Outline o;
        for (int c = 0; c < corners; ++c) {
          const double angle = 6.283185307179586 * c / corners + 0.1 * (k % 3);
          o.push_back({0.01 * std::cos(angle), 0.01 * std::sin(angle)});
        }
        g.outline = centred_outline(o);
      }
      engine->add(g);
    }
    engine->step(15000);
    const Snapshot half = engine->snapshot();
    ASSERT_GT(half.contacts.size(), 20u);
    ASSERT_TRUE(std::any_of(half.contacts.begin(), half.contacts.end(),
                            [](const Contact& c) { return std::fabs(c.spring) > 1e-3; }));
    const auto again = make_engine(settings, half);
    again->step(50);
    engine->step(50);
    const Snapshot a = engine->snapshot(), b = again->snapshot();
    ASSERT_EQ(a.contacts.size(), b.contacts.size());
    // The first step after the snapshot takes its accelerations from springs that are one step
    // older or younger: not the same bits.
    EXPECT_LT(difference(a, b).first, 1e-6) << polygons;
    EXPECT_LT(difference(a, b).second, 1e-3) << polygons;
    // Without the springs it is another motion.
    Snapshot forgotten = half;
    for (Contact& c : forgotten.contacts) c.spring = 0;
    const auto other = make_engine(settings, forgotten);
    other->step(50);
    EXPECT_GT(difference(a, other->snapshot()).first, 1e-5) << polygons;
  }
}

TEST(GravityChanges, SnapshotsThatCannotGoOnAreRefused) {
  Snapshot s;
  s.dim = 3;
  EXPECT_THROW(make_engine(EngineSettings{}, s), std::invalid_argument);
  s.dim = 2;
  s.grains.resize(1);
  s.grains[0].id = 4;
  s.grains[0].radius = s.grains[0].mass = s.grains[0].volume = 1;
  EXPECT_THROW(make_engine(EngineSettings{}, s), std::invalid_argument);
}

// Stops anywhere, also between the ramp's end and the next setting of gravity.
TEST(GravityChanges, TheSameBitsWhereverARunStops) {
  const FileOfRun file("changes");
  PileSetup s = poured("disk");
  s.change.gravity = {5};
  const auto whole = make_pile_run(s, 5, 1);
  finish(*whole);
  write_snapshot(file.path(), "/r/pile", whole->result().snapshots[0].second);
  const auto changed = [&](long first) {
    const auto run = make_pile_change_run(s, file.path(), "/r", 1);
    run->advance(first);
    finish(*run);
    return run->result().snapshots[1].second;
  };
  const Snapshot once = changed(1000000);
  const double step =
      once.time / std::round(once.time / whole->result().figures.at("dem.time_step"));
  const long end = static_cast<long>(std::ceil(s.change.ramp_time / step));
  ASSERT_NE(end % 20, 0);
  for (const long first : {end - 1, end, end + 1, end + 20}) {
    EXPECT_EQ(difference(changed(first), once), std::pair(0.0, 0.0)) << first - end;
  }
}

TEST(GravityChanges, AFinishedPileGivesWhatThePouredOneGave) {
  const FileOfRun file("changes");
  for (const char* shape : {"rand1", "disk"}) {
    const PileSetup s = poured(shape);
    const RunResult expected = finished(make_pile_run(s, 5, 1));
    std::filesystem::remove(file.path());
    write_snapshot(file.path(), "/r/pile", expected.snapshots[0].second);
    const auto run = make_pile_change_run(s, file.path(), "/r", 1);
    EXPECT_EQ(run->progress().phase, "gravity_5");
    run->advance(400);
    EXPECT_LT(run->progress().fraction, 0.5);
    finish(*run);
    const RunResult got = run->result();
    ASSERT_EQ(got.snapshots.size(), 3u);
    for (std::size_t k = 1; k < 3; ++k) {
      EXPECT_EQ(got.snapshots[k].first, expected.snapshots[k].first);
      EXPECT_EQ(difference(got.snapshots[k].second, expected.snapshots[k].second),
                std::pair(0.0, 0.0))
          << shape;
      EXPECT_EQ(got.snapshots[k].second.attributes.at("state"), got.snapshots[k].first);
    }
    EXPECT_EQ(got.figures.at("change.gravity_5.contacts_lost"),
              expected.figures.at("change.gravity_5.contacts_lost"));
  }
}

TEST(GravityChanges, AFinishedPileResumesToTheSameBits) {
  const FileOfRun file("changes");
  const PileSetup s = poured("rand1");
  write_snapshot(file.path(), "/pile", finished(make_pile_run(s, 5, 1)).snapshots[0].second);
  const RunResult whole = finished(make_pile_change_run(s, file.path(), "", 1));
  const std::string checkpoint = file.path() + ".checkpoint";
  for (const long stop : {0L, 333L, 5000L, 20000L}) {
    {
      const auto first = make_pile_change_run(s, file.path(), "", 1);
      first->advance(stop);
      first->save(checkpoint);
    }
    const auto second = make_pile_change_run(s, file.path(), "", 2);
    second->restore(checkpoint);
    expect_same(finished(second), whole, std::to_string(stop));
  }
  PileSetup other = s;
  other.change.ramp_time = 0.06;
  EXPECT_THROW(make_pile_change_run(other, file.path(), "", 1)->restore(checkpoint),
               std::invalid_argument);
  std::filesystem::remove(checkpoint);
}

}  // namespace
}  // namespace grainfield::dem
