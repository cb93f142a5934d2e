// Quasi-static relaxation of spheres against slow damped dynamics.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "dem/quasistatic/quasistatic.h"
#include "dem/snapshot/contact_changes.h"
#include "tests/dem/imbalance.h"
#include "tests/dem/sphere_relaxation_scene.h"

namespace grainfield::dem {
namespace {

/// Of the contacts' forces, rms over the rms of their change from the start.
double difference_of_forces(const Snapshot& start, const Snapshot& a, const Snapshot& b) {
  double sum = 0, square = 0;
  for (std::size_t k = 0; k < start.contacts.size(); ++k) {
    square += (a.contacts[k].force - start.contacts[k].force).squaredNorm();
    sum += (a.contacts[k].force - b.contacts[k].force).squaredNorm();
  }
  return std::sqrt(sum / square);
}

/// Of the displacements, over their rms; the share of the grains beyond `limit`. A sphere that lies
/// on another without holding anything rolls for nothing, and is wherever it came to rest.
double share_apart(const Snapshot& start, const Snapshot& a, const Snapshot& b, double limit) {
  std::vector<double> apart;
  double square = 0;
  for (std::size_t k = 0; k < start.grains.size(); ++k) {
    const Vec3 u = a.grains[k].position - start.grains[k].position;
    const Vec3 v = b.grains[k].position - start.grains[k].position;
    apart.push_back((u - v).norm());
    square += u.squaredNorm();
  }
  const double scale = std::sqrt(square / static_cast<double>(apart.size()));
  const auto beyond =
      std::count_if(apart.begin(), apart.end(), [&](double d) { return d > limit * scale; });
  return static_cast<double>(beyond) / static_cast<double>(apart.size());
}

TEST(SphereRelaxationSlow, AgreesWithSlowDampedDynamics) {
  struct Run {
    AnyLaw law;
    bool periodic, rolls;
  };
  for (const Run& run :
       {Run{HertzLaw{5e6, 0.3, 0.3}, false, false}, Run{HertzLaw{5e6, 0.3, 0.3, true}, true, false},
        Run{LinearLaw{2e4, 1e4, 200, 100}, false, true}}) {
    EngineSettings e = settings_of(run.law, 0.5);
    if (run.rolls) e.rolling = {5e3, 0.5, 0.1, 0, 0, 0};
    const auto engine = settled(e, run.periodic, 4, 4);
    const Snapshot start = engine->snapshot();
    // A smooth ramp: where it has corners the grains ring.
    const double to = 0.995 * kG;
    constexpr int kParts = 500;
    for (int k = 1; k <= kParts; ++k) {
      const double share = static_cast<double>(k) / kParts;
      engine->set_gravity(0, 0, -(kG + (to - kG) * share * share * (3 - 2 * share)));
      engine->step(40);
    }
    come_to_rest(*engine, 1e-8);
    const Snapshot damped = engine->snapshot();
    const QuasistaticResult newton = relax(start, e, {0, 0, -to}, {}, {});
    const ContactChanges changes = compare_contacts(start, damped);
    EXPECT_EQ(changes.gained + changes.lost, 0);
    ASSERT_EQ(newton.contacts_gained + newton.contacts_lost, 0);
    if (!run.rolls) expect_balanced(newton.state, 1e-8);
    const double forces = difference_of_forces(start, damped, newton.state);
    const double apart = share_apart(start, damped, newton.state, 1e-2);
    std::printf("forces differ by %.1e of their change, %.3f of the spheres are apart\n", forces,
                apart);
    EXPECT_LT(forces, 1e-3);
    EXPECT_LT(apart, 0.05);
    EXPECT_NEAR(base_force(newton.state).z() / weight_of(newton.state), 1, 1e-6);
  }
}

}  // namespace
}  // namespace grainfield::dem
