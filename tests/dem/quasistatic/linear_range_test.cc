// Where linear response ends: two contacts by hand, and what Newton's method finds just before and
// just behind the factor, for disks and for spheres.
#include "dem/quasistatic/linear_range.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "dem/quasistatic/quasistatic.h"
#include "dem/quasistatic/small_loads.h"
#include "dem/snapshot/contact_changes.h"
#include "tests/dem/sphere_relaxation_scene.h"

namespace grainfield::dem {
namespace {

// Normal along x; tangential force along y and z.
Contact contact(double normal, const Vec3& along, double friction) {
  Contact c;
  c.normal = Vec3(1, 0, 0);
  c.normal_force = normal;
  c.force = -normal * c.normal + along;
  c.friction = friction;
  return c;
}

LinearRange of(const Contact& rest, const Contact& change) {
  Snapshot a, b;
  a.contacts = {rest};
  b.contacts = {change};
  return linear_range(a, b);
}

TEST(LinearRange, SlidesAtCoulombsLimit) {
  // |0.1 + 2 s| = 0.5 (1 + s).
  EXPECT_NEAR(of(contact(1, {0, 0.1, 0}, 0.5), contact(1, {0, 2, 0}, 0.5)).slides, 0.4 / 1.5,
              1e-14);
  // The other way |0.1 - 2 s| = 0.5 (1 + s), beyond 0.
  EXPECT_NEAR(of(contact(1, {0, 0.1, 0}, 0.5), contact(1, {0, -2, 0}, 0.5)).slides, 0.4, 1e-14);
  // Across: 0.09 + s^2 = 0.25.
  EXPECT_NEAR(of(contact(1, {0, 0.3, 0}, 0.5), contact(0, {0, 0, 1}, 0.5)).slides, 0.4, 1e-14);
  // Pressed together faster than it is sheared: never.
  const LinearRange never = of(contact(1, {0, 0.1, 0}, 0.5), contact(10, {0, 2, 0}, 0.5));
  EXPECT_TRUE(std::isinf(never.slides) && std::isinf(never.opens));
  // Unloaded: at Coulomb's limit before it is open.
  const LinearRange unloaded = of(contact(1, {0, 0.1, 0}, 0.5), contact(-1, {0, 0, 0}, 0.5));
  EXPECT_NEAR(unloaded.slides, 0.8, 1e-14);
  EXPECT_NEAR(unloaded.opens, 1, 1e-14);
  EXPECT_NEAR(unloaded.changed(0.01), 0.8, 1e-14);
}

TEST(LinearRange, OfContactsThatDoNotStick) {
  const LinearRange smooth = of(contact(3, {0, 0, 0}, 0), contact(-2, {0, 0, 0}, 0));
  EXPECT_TRUE(std::isinf(smooth.slides));
  EXPECT_NEAR(smooth.changed(0), 1.5, 1e-14);
  Contact slides = contact(3, {0, 1.5, 0}, 0.5);
  slides.sliding = true;
  const LinearRange one = of(slides, contact(-2, {0, 1, 0}, 0.5));
  EXPECT_TRUE(std::isinf(one.slides));
  EXPECT_NEAR(one.changed(1), 1.5, 1e-14);
}

TEST(LinearRange, CountsTheContactsThatAreLoaded) {
  Snapshot a, b;
  for (int k = 1; k <= 200; ++k) {
    a.contacts.push_back(contact(201 - k, {0, 0, 0}, 0));
    b.contacts.push_back(contact(k <= 100 ? -1 : 1, {0, 0, 0}, 0));
  }
  a.contacts.push_back(contact(0, {0, 0, 0}, 0));
  b.contacts.push_back(contact(-1, {0, 0, 0}, 0));
  const LinearRange range = linear_range(a, b);
  ASSERT_EQ(range.changes.size(), 200U);
  EXPECT_EQ(range.changed(0), 101);
  EXPECT_EQ(range.changed(0.01), 102);
  EXPECT_EQ(range.changed(0.011), 103);
  EXPECT_TRUE(std::isinf(range.changed(0.6)));
  b.contacts.pop_back();
  EXPECT_THROW(linear_range(a, b), std::invalid_argument);
}

struct Found {
  int changed = 0, gained = 0;
};

// Contacts that Newton's method opens or brings to slide.
Found by_newton(const Snapshot& rest, const EngineSettings& settings, std::int64_t id,
                const Vec3& force) {
  AppliedForce on;
  on.id = id;
  on.fx = force.x();
  on.fy = force.y();
  on.fz = force.z();
  QuasistaticSettings how;
  how.unbalanced_force_ratio = 1e-11;
  const QuasistaticResult r = relax(rest, settings, rest.gravity, on, how);
  return {r.contacts_lost + r.newly_sliding, r.contacts_gained};
}

enum class End { sharp, bound };

// Every free grain is loaded. Where the factor is so small that the response is linear up to it,
// nothing changes below it, and one contact or more does above where it is sharp. `within`: by
// which factor either side is apart from it.
void expect_as_newton(const EngineSettings& settings, Snapshot rest, int up, double within,
                      End kind = End::sharp) {
  QuasistaticSettings how;
  how.unbalanced_force_ratio = 1e-11;
  rest = relax(rest, settings, rest.gravity, {}, how).state;
  SmallLoads loads(rest, settings);
  rest = loads.start();
  int looked_at = 0;
  for (const Grain& g : rest.grains) {
    if (g.fixed) continue;
    const Vec3 force = -g.mass * rest.gravity.norm() * Vec3::Unit(up);
    const LinearRange range = linear_range(rest, loads.response({g.id}, force).change);
    const double end = range.changed(0);
    EXPECT_EQ(end, std::min(range.opens, range.slides));
    if (!(end < 2)) continue;  // beyond, forces turn with their normals
    const Found below = by_newton(rest, settings, g.id, end / within * force);
    if (below.gained > 0) continue;  // no end that this looks for
    EXPECT_EQ(below.changed, 0) << g.id << " at " << end;
    ++looked_at;
    if (kind == End::bound) continue;
    EXPECT_GE(by_newton(rest, settings, g.id, within * end * force).changed, 1)
        << g.id << " at " << end;
  }
  EXPECT_GT(looked_at, 10);
}

TEST(LinearRange, OfSpheresIsNewtons) {
  EngineSettings settings = settings_of(LinearLaw{500, 250, 200, 100}, 0.6);
  const Snapshot rest = settled(settings, true, 4, 4)->snapshot();
  settings.cell = rest.cell;
  expect_as_newton(settings, rest, 2, 1.03);
}

void expect_disks_as_newton(const AnyLaw& law, double within, End kind = End::sharp) {
  EngineSettings settings;
  settings.law = law;
  settings.friction = 0.6;
  settings.integrator = IntegratorKind::verlet;
  settings.time_step = 2e-5;
  const auto engine = settled_disks(settings, 10, 6, 3);
  expect_as_newton(settings, engine->snapshot(), 1, within, kind);
}

TEST(LinearRange, OfDisksIsNewtons) { expect_disks_as_newton(LinearLaw{1e6, 5e5, 200, 100}, 1.03); }
// The stiffness of overlapping areas goes to 0 with the force, so that contacts open later: the
// factor is a bound.
TEST(LinearRange, OfOverlappingAreasIsBelowNewtons) {
  expect_disks_as_newton(OverlapAreaLaw{1e5, 0.75}, 1.6, End::bound);
}

}  // namespace
}  // namespace grainfield::dem
