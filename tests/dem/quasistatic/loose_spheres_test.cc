// A large packing in which a few spheres hang loose comes to rest by Newton's method all the same.
#include <gtest/gtest.h>

#include <cmath>

#include "dem/quasistatic/quasistatic.h"
#include "tests/dem/sphere_relaxation_scene.h"

namespace grainfield::dem {
namespace {

// More unknowns than are factorized: steps of Newton's method are found by iteration.
constexpr int kSide = 12, kLayers = 10;
constexpr double kOverlap = 1e-3 * kRadius, kSpacing = 2 * kRadius - kOverlap;

Vec3 site(int i, int j, int k) { return kSpacing * Vec3(i, j, k) + Vec3::Constant(0.5 * kSpacing); }

struct Scene {
  EngineSettings settings = settings_of(HertzLaw{5e6, 0.3, 0}, 0.5);
  Snapshot bare;  ///< at rest
  Snapshot start;
  std::vector<std::size_t> loose;  ///< indices of grains
};

// A simple cubic lattice at rest on held spheres, pressed together along x and y, and small spheres
// in six of its holes, each of which begins as it touches one sphere below it alone.
Scene make_scene() {
  Scene out;
  EngineSettings& e = out.settings;
  e.cell.periodic = {true, true, false};
  e.cell.edges = Vec3(kSide * kSpacing, kSide * kSpacing, 1).asDiagonal();
  const auto engine = make_engine(e);
  for (int k = 0; k < kLayers; ++k) {
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        NewGrain g = sphere(site(i, j, k));
        g.fixed = k == 0;
        engine->add(g);
      }
    }
  }
  engine->step(1);
  out.bare = relax(engine->snapshot(), e, {0, 0, -kG}, {}, {}).state;
  const auto full = make_engine(e, out.bare);
  const double small = 0.6 * kRadius, reach = kRadius + small - 1e-4 * small;
  for (int n = 0; n < 6; ++n) {
    const int below = (5 * kSide + 2 + 3 * (n / 3)) * kSide + 2 + 3 * (n % 3);
    out.loose.push_back(out.bare.grains.size() + static_cast<std::size_t>(n));
    Vec3 way(0.55 * kSpacing - 0.2 * small, 0.45 * kSpacing - 0.2 * small, 0);
    way.z() = std::sqrt(reach * reach - way.squaredNorm());
    full->add(sphere(out.bare.grains[static_cast<std::size_t>(below)].position + way, small));
  }
  full->step(1);
  out.start = full->snapshot();
  return out;
}

const Scene& scene() {
  static const Scene one = make_scene();
  return one;
}

int contacts_of(const Snapshot& s, std::size_t grain) {
  int count = 0;
  for (const Contact& c : s.contacts) {
    const auto g = static_cast<std::int64_t>(grain);
    count += c.normal_force > 0 && (c.i == g || c.j == g);
  }
  return count;
}

TEST(LooseSpheres, AreSettledApartAndRestWithTheOthers) {
  const Scene& l = scene();
  const QuasistaticResult r = relax(l.start, l.settings, {0, 0, -kG}, {}, {});
  EXPECT_GE(r.times_apart, 1);
  EXPECT_LE(r.times_apart, 10);
  EXPECT_LE(r.unbalanced_force_ratio, 1e-8);
  EXPECT_LE(r.unbalanced_moment_ratio, 1e-8);
  const double weight = mass_of(0.6 * kRadius) * kG;
  for (const std::size_t k : l.loose) {
    EXPECT_GE(contacts_of(r.state, k), 2) << k;
    Vec3 force(0, 0, 0);
    for (const Contact& c : r.state.contacts) {
      if (c.i == static_cast<std::int64_t>(k)) force += c.force;
      if (c.j == static_cast<std::int64_t>(k)) force -= c.force;
    }
    EXPECT_NEAR(force.z() / weight, 1, 1e-3) << k;
    EXPECT_LT(force.head<2>().norm() / weight, 1e-3) << k;
    const Vec3 moved = r.state.grains[k].position - l.start.grains[k].position;
    EXPECT_GT(moved.norm(), 0.01 * kRadius) << k;
  }
  // The others hardly feel them.
  for (std::size_t k = 0; k < l.bare.grains.size(); ++k)
    EXPECT_LT((r.state.grains[k].position - l.bare.grains[k].position).norm(), 0.5 * kOverlap) << k;
}

// With the loose ones on their way the packing is strained once, and comes to rest.
TEST(LooseSpheres, DoNotKeepAStrainFromItsRest) {
  const Scene& l = scene();
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  gradient(0, 0) = 1e-5;
  const QuasistaticResult r = strain(l.start, l.settings, gradient, {});
  EXPECT_GE(r.times_apart, 1);
  EXPECT_LE(r.unbalanced_force_ratio, 1e-8);
  EXPECT_LE(r.unbalanced_moment_ratio, 1e-8);
  const double edge = l.start.cell.edges(0, 0);
  EXPECT_NEAR(r.state.cell.edges(0, 0) / edge - 1, 1e-5, 1e-11);
  const Vec3 held = l.start.grains[7].position;
  EXPECT_NEAR((r.state.grains[7].position - held).x(), 1e-5 * held.x(), 1e-12 * edge);
}

TEST(LooseSpheres, AreToldToStopAnywhere) {
  const Scene& l = scene();
  for (const int most : {0, 1, 2, 3, 5, 8}) {
    int asked = 0;
    QuasistaticSettings how;
    how.go_on = [&](double) { return asked++ < most; };
    EXPECT_THROW(relax(l.start, l.settings, {0, 0, -kG}, {}, how), RelaxationStopped) << most;
    EXPECT_EQ(asked, most + 1);
  }
}

}  // namespace
}  // namespace grainfield::dem
