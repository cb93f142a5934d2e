// Strains of one packing with the tangent's factors at its start: as one by one, whatever came
// before, and where a contact changes by Newton's method.
#include "dem/quasistatic/strains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "dem/quasistatic/quasistatic.h"
#include "tests/dem/sphere_relaxation_scene.h"

namespace grainfield::dem {
namespace {

constexpr double kSmall = 1e-6;

// Spheres settled in a cell that repeats sideways, at rest between the held ones at the floor and
// at the surface.
struct Held {
  EngineSettings settings = settings_of(HertzLaw{5e6, 0.3, 0.3}, 0.5);
  Snapshot rest;
  QuasistaticSettings how;

  Held() {
    rest = settled(settings, true, 4, 5)->snapshot();
    settings.cell = rest.cell;
    double height = 0;
    for (const Grain& g : rest.grains) height = std::max(height, g.position.z() + g.radius);
    for (Grain& g : rest.grains)
      g.fixed = g.position.z() < 2 * kRadius || g.position.z() > height - 2 * kRadius;
    const auto held = [&](std::int64_t k) {
      return rest.grains[static_cast<std::size_t>(k)].fixed;
    };
    std::erase_if(rest.contacts,
                  [&](const Contact& c) { return held(c.i) && (c.j < 0 || held(c.j)); });
    how.unbalanced_force_ratio = 1e-9;
    rest = relax(rest, settings, rest.gravity, {}, how).state;
  }
};

const Held& held() {
  static const Held one;
  return one;
}

Eigen::Matrix3d along(int a, int b, double strain) {
  Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
  out(a, b) = out(b, a) = strain;
  return out;
}

void expect_same_bits(const QuasistaticResult& a, const QuasistaticResult& b) {
  ASSERT_EQ(a.state.contacts.size(), b.state.contacts.size());
  for (std::size_t k = 0; k < a.state.contacts.size(); ++k)
    ASSERT_EQ(a.state.contacts[k].force, b.state.contacts[k].force) << k;
  for (std::size_t k = 0; k < a.state.grains.size(); ++k)
    ASSERT_EQ(a.state.grains[k].position, b.state.grains[k].position) << k;
}

TEST(Strains, AreAsOneByOne) {
  const Held& p = held();
  Strains strains(p.rest, p.settings, p.how);
  for (const auto& [a, b] : {std::pair(0, 0), std::pair(1, 2)}) {
    for (const double size : {kSmall, -kSmall}) {
      const Eigen::Matrix3d gradient = along(a, b, size);
      const QuasistaticResult quick = strains.strain(gradient, nullptr);
      const QuasistaticResult full = dem::strain(p.rest, p.settings, gradient, p.how);
      EXPECT_EQ(quick.steps, 0);
      EXPECT_LE(quick.unbalanced_force_ratio, 1e-9);
      EXPECT_LE(quick.unbalanced_moment_ratio, 1e-9);
      EXPECT_EQ(quick.state.cell.edges, full.state.cell.edges);
      ASSERT_EQ(quick.state.contacts.size(), p.rest.contacts.size());
      ASSERT_EQ(full.state.contacts.size(), p.rest.contacts.size());
      double off = 0, change = 0;
      for (std::size_t k = 0; k < p.rest.contacts.size(); ++k) {
        const Vec3 force = full.state.contacts[k].force;
        off += (quick.state.contacts[k].force - force).squaredNorm();
        change += (force - p.rest.contacts[k].force).squaredNorm();
      }
      // A balance of 1e-9 compared with changes of about 1e-4.
      EXPECT_LT(std::sqrt(off), 1e-3 * std::sqrt(change));
    }
  }
}

TEST(Strains, DoNotDependOnThoseBefore) {
  const Held& p = held();
  Strains used(p.rest, p.settings, p.how);
  for (const double strain : {kSmall, -kSmall}) used.strain(along(2, 2, strain), nullptr);
  const QuasistaticResult second = used.strain(along(0, 1, kSmall), nullptr);
  const QuasistaticResult third = used.strain(along(0, 1, -kSmall), nullptr);
  const QuasistaticResult again = used.strain(along(0, 1, kSmall), nullptr);
  Strains fresh(p.rest, p.settings, p.how);
  expect_same_bits(fresh.strain(along(0, 1, -kSmall), nullptr), third);
  expect_same_bits(second, again);
}

// Stretched so far that contacts slide.
TEST(Strains, ThatMoveContactsGoByNewtonsMethod) {
  const Held& p = held();
  const Eigen::Matrix3d gradient = along(0, 0, 1e-3);
  Strains strains(p.rest, p.settings, p.how);
  strains.strain(along(0, 0, kSmall), nullptr);
  const QuasistaticResult quick = strains.strain(gradient, nullptr);
  const QuasistaticResult full = dem::strain(p.rest, p.settings, gradient, p.how);
  EXPECT_GT(full.newly_sliding + full.contacts_lost, 0);
  EXPECT_GT(quick.steps, 0);
  expect_same_bits(quick, full);
  // And the start is as it was.
  Strains fresh(p.rest, p.settings, p.how);
  expect_same_bits(strains.strain(along(1, 1, kSmall), nullptr),
                   fresh.strain(along(1, 1, kSmall), nullptr));
}

TEST(Strains, StopWhenToldTo) {
  const Held& p = held();
  Strains strains(p.rest, p.settings, p.how);
  int asked = 0;
  const auto once = [&](double) { return asked++ == 0; };
  EXPECT_THROW(strains.strain(along(0, 0, kSmall), once), RelaxationStopped);
  Strains fresh(p.rest, p.settings, p.how);
  expect_same_bits(strains.strain(along(0, 0, kSmall), nullptr),
                   fresh.strain(along(0, 0, kSmall), nullptr));
}

}  // namespace
}  // namespace grainfield::dem
