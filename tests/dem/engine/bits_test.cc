// The engine's end states, to the bit: what was computed yesterday is computed today, on any number
// of threads and with a restart on the way. A change that rounds otherwise on purpose records its
// hashes anew, in a commit of its own.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/dem/bits_scene.h"

namespace grainfield::dem::bits {

// In the names of parameterized tests.
void PrintTo(const Scene& scene, std::ostream* out) { *out << scene.name; }

namespace {

constexpr double kCell = 0.02;

Scene falling(std::string name, std::uint64_t hash, Kind kind, bool linear, IntegratorKind how) {
  Scene s;
  s.name = std::move(name);
  s.hash = hash;
  s.settings = settings_of(linear, how);
  s.settings.shape = kind != Kind::disks ? ShapeKind::polygon : ShapeKind::disk;
  s.steps = how == IntegratorKind::gear ? 6000 : 3000;
  s.walls = walls_of_box(8.2 * kCell);
  s.grains = block(kind, 8, 7, kCell, 3);
  return s;
}

// Layers that fall asleep, are hit by later ones and wake.
Scene sleeping_pour(std::string name, std::uint64_t hash, Kind kind, IntegratorKind how) {
  Scene s;
  s.name = std::move(name);
  s.hash = hash;
  s.settings = settings_of(false, how);
  s.settings.shape = kind != Kind::disks ? ShapeKind::polygon : ShapeKind::disk;
  s.settings.sleep.on = true;
  s.settings.sleep.quiet_time = 5e-3;
  s.settings.sleep.quiet_move = 1e-2;
  s.settings.sleep.quiet_creep = 0.02;
  s.settings.sleep.wake_time = 0.02;
  s.steps = how == IntegratorKind::gear ? 24000 : 16000;
  s.walls = walls_of_box(6.2 * kCell);
  s.grains = block(kind, 6, 2, kCell, 5);
  for (int layer = 1; layer < 3; ++layer) {
    const long at = layer * s.steps / 2 - 2000 * layer;
    s.events.emplace_back(at, [kind, layer](Engine& engine) {
      for (NewGrain g : block(kind, 3, 1, kCell, 7 + layer)) {
        g.y += 0.09;
        g.vy -= 0.5;
        engine.add(g);
      }
    });
  }
  return s;
}

// Fixed grains of the floor, one that does not turn, a force, damping, and a change of gravity.
Scene rough_floor(std::string name, std::uint64_t hash, Kind kind, bool sleep) {
  Scene s = falling(std::move(name), hash, kind, false, IntegratorKind::verlet);
  s.settings.sleep.on = sleep;
  s.settings.sleep.quiet_time = 5e-3;
  s.settings.sleep.quiet_move = 1e-2;
  s.settings.sleep.quiet_creep = 1;
  s.settings.sleep.quiet_force = 0.2;
  s.settings.sleep.wake_force = 0.3;
  s.settings.sleep.wake_levels = 1e3;
  s.settings.sleep.wake_time = 0.02;
  s.grains[3].rotates = false;
  for (int k = 0; k < 8; ++k) {
    NewGrain g = s.grains[static_cast<std::size_t>(k)];
    g.y = -0.2 * kCell;
    g.vx = 1;  // of no effect
    g.fixed = true;
    s.grains.push_back(g);
  }
  const long part = sleep ? 3000 : 1000;
  s.steps = 4 * part;
  s.events.emplace_back(0, [](Engine& engine) { engine.set_background_damping(60); });
  s.events.emplace_back(part, [](Engine& engine) {
    AppliedForce force;
    force.id = 51;
    force.fx = 5;
    force.fy = -40;
    force.start = engine.time();
    force.ramp = 0.02;
    engine.apply(force);
    engine.set_background_damping(30);
  });
  s.events.emplace_back(5 * part / 2, [](Engine& engine) { engine.set_gravity(0.7, -8); });
  return s;
}

std::vector<Scene> scenes() {
  const auto verlet = IntegratorKind::verlet, gear = IntegratorKind::gear;
  return {
      falling("DisksAreaVerlet", 0x927a4491fcd75068, Kind::disks, false, verlet),
      falling("DisksAreaGear", 0x09d3e6b750b22118, Kind::disks, false, gear),
      falling("DisksLinearVerlet", 0x58d400726ee0bbfb, Kind::disks, true, verlet),
      falling("DisksLinearGear", 0x3c04f35044a78aa9, Kind::disks, true, gear),
      falling("PolygonsAreaVerlet", 0x61a231df5e5e20d0, Kind::polygons, false, verlet),
      falling("PolygonsAreaGear", 0x05483260270290b8, Kind::polygons, false, gear),
      falling("PolygonsLinearVerlet", 0xcd76f356f2db47e8, Kind::polygons, true, verlet),
      falling("PolygonsLinearGear", 0x467c22f0ddb588d5, Kind::polygons, true, gear),
      falling("SlenderAreaVerlet", 0x845090abc92e2737, Kind::slender, false, verlet),
      sleeping_pour("SleepingDisks", 0x446c3a6a6712cea6, Kind::disks, verlet),
      sleeping_pour("SleepingPolygons", 0xcbbb791be3505a60, Kind::polygons, verlet),
      sleeping_pour("SleepingSlender", 0xce16d2f9b27e0ab2, Kind::slender, verlet),
      sleeping_pour("SleepingPolygonsGear", 0xfbd40d34e881ccfb, Kind::polygons, gear),
      rough_floor("RoughFloorDisks", 0x418b2b8a0738b733, Kind::disks, false),
      rough_floor("RoughFloorPolygons", 0x6c8ceb4054570a88, Kind::polygons, false),
      rough_floor("RoughFloorAsleep", 0x2731c45c2b08d29c, Kind::polygons, true),
  };
}

class Bits : public testing::TestWithParam<Scene> {};

// On one thread; and on three to the middle, on four from a checkpoint there.
TEST_P(Bits, AreThoseRecorded) {
  const Scene& scene = GetParam();
  const auto expect = [&](const Snapshot& end, const std::string& how) {
    const std::uint64_t found = hash_of(end);
    EXPECT_EQ(found, scene.hash) << scene.name << how << fmt::format(": 0x{:016x}", found);
  };
  // A scene without contacts, or where all sleep or nobody does, would pin less than it says.
  int least = 1000, most = 0, sliding = 0, contacts = 0;
  const Snapshot end = end_of(scene, [&](const Engine& engine) {
    const Diagnostics d = engine.measure();
    least = std::min(least, d.awake);
    most = std::max(most, d.awake);
    sliding = std::max(sliding, d.sliding);
    contacts = std::max(contacts, d.contacts);
  });
  expect(end, "");
  const auto grains = static_cast<double>(end.grains.size());
  EXPECT_GT(contacts, 0.7 * grains);
  EXPECT_GT(sliding, 0);
  EXPECT_GT(most, 10);
  if (scene.settings.sleep.on) {
    EXPECT_LT(least, 0.7 * grains);
  }
  expect(end_of(scene, 3, scene.steps / 2 - 123, 4), ", restarted on other threads");
}

INSTANTIATE_TEST_SUITE_P(Pinned, Bits, testing::ValuesIn(scenes()),
                         [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace grainfield::dem::bits
