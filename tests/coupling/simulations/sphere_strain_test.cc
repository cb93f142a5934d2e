// Small uniform strains by the quasi-static solver: closed form of a lattice, balance and symmetry
// of a settled layer, refusals.
#include <gmock/gmock.h>

#include <cmath>

#include "coupling/studies/point_load/layer_probe.h"
#include "dem/quasistatic/quasistatic.h"
#include "dem/quasistatic/sphere_law.h"
#include "dem/snapshot/cell_stress.h"
#include "tests/dem/sphere_relaxation_scene.h"

namespace grainfield::dem {
namespace {

using ::testing::HasSubstr;

constexpr double kStrain = 1e-6;

// Simple cubic, repeated along every axis, pressed by `overlap` at every contact.
Snapshot cubic_lattice(const EngineSettings& settings, double overlap) {
  EngineSettings e = settings;
  const double spacing = 2 * kRadius - overlap;
  constexpr int kSide = 3;
  e.gravity_z = 0;
  e.cell.periodic = {true, true, true};
  e.cell.edges = Vec3::Constant(kSide * spacing).asDiagonal();
  const auto engine = make_engine(e);
  for (int k = 0; k < kSide * kSide * kSide; ++k) {
    engine->add(sphere(
        spacing * (Vec3(k % kSide, k / kSide % kSide, k / kSide / kSide) + Vec3::Constant(0.5))));
  }
  return relax(engine->snapshot(), e, {0, 0, 0}, {}, {}).state;
}

// The affine motion of a Bravais lattice is the relaxed one. With the force N of a contact, its
// stiffnesses k_n, k_t and the spacing a, an extension e along x changes sigma_xx by e k_n/a and
// sigma_yy by e N/a^2 (the area grows), a shear e changes sigma_xy by e (k_t/a - 2 N/a^2).
TEST(SphereStrain, ACubicLatticeHasTheStiffnessOfItsContacts) {
  const HertzLaw law{5e6, 0.3, 0};
  const EngineSettings e = settings_of(law, 0.5);
  const double overlap = 0.002 * kRadius;
  const Snapshot lattice = cubic_lattice(e, overlap);
  ASSERT_EQ(lattice.contacts.size(), 81U);
  const double a = 2 * kRadius - overlap;
  const SphereLaw sphere_law{AnyLaw(law)};
  const double k_n = sphere_law.repulsion(overlap, kRadius / 2).slope;
  const double force = sphere_law.repulsion(overlap, kRadius / 2).value;
  const double k_t = sphere_law.spring(overlap, kRadius / 2).value;
  const Eigen::Matrix3d before = cell_stress(lattice).contacts;
  EXPECT_NEAR(before(0, 0), -force / (a * a), 1e-6 * force / (a * a));

  Eigen::Matrix3d extension = Eigen::Matrix3d::Zero(), shear = extension;
  extension(0, 0) = kStrain;
  shear(0, 1) = shear(1, 0) = kStrain;
  const QuasistaticResult longer = strain(lattice, e, extension, {});
  const double edge = 3 * a;
  EXPECT_NEAR(longer.state.cell.edges(0, 0) / edge - 1, kStrain, 1e-4 * kStrain);
  Eigen::Matrix3d change = cell_stress(longer.state).contacts - before;
  EXPECT_NEAR(change(0, 0), kStrain * k_n / a, 2e-3 * kStrain * k_n / a);
  // Across, the same forces on an area that has grown.
  EXPECT_NEAR(change(1, 1), kStrain * force / (a * a), 1e-3 * kStrain * force / (a * a) + 1e-9);

  change = cell_stress(strain(lattice, e, shear, {}).state).contacts - before;
  // Both kinds of contacts slip by strain * a; their pressure turns with them, and so do branches.
  const double slope = k_t / a - 2 * force / (a * a);
  EXPECT_NEAR(change(0, 1), kStrain * slope, 2e-3 * kStrain * slope);
  EXPECT_NEAR(change(0, 1), change(1, 0), 1e-3 * std::fabs(change(0, 1)));
}

// Disordered spheres pressed together in a cell: slow damped dynamics of the cell's flow come to
// the same stress.
TEST(SphereStrain, SlowDampedDynamicsComeToTheSameStress) {
  EngineSettings e = settings_of(LinearLaw{1e4, 5e3, 200, 100}, 0.5);
  e.gravity_z = 0;
  e.time_step = 1e-5;
  constexpr int kSide = 4;
  const double cell = 2.02 * kRadius;
  e.cell.periodic = {true, true, true};
  e.cell.edges = Vec3::Constant(kSide * cell).asDiagonal();
  const auto loose = make_engine(e);
  Random random(11);
  for (int k = 0; k < kSide * kSide * kSide; ++k) {
    const auto at = [&](int n) { return cell * (n + 0.5 + 0.1 * random.uniform(-1, 1)); };
    loose->add(sphere({at(k % kSide), at(k / kSide % kSide), at(k / kSide / kSide)},
                      kRadius * random.uniform(0.95, 1.05)));
  }
  // Pressed to a solid fraction above that of random packings.
  constexpr long kPress = 20000;
  loose->set_background_damping(40);
  loose->set_velocity_gradient(-0.09 / (kPress * e.time_step) * Eigen::Matrix3d::Identity());
  loose->step(kPress);
  loose->set_velocity_gradient(Eigen::Matrix3d::Zero());
  come_to_rest(*loose, 1e-9);
  e.cell = loose->snapshot().cell;
  const Snapshot rest = relax(loose->snapshot(), e, {0, 0, 0}, {}, {}).state;
  const Eigen::Matrix3d before = cell_stress(rest).contacts;
  ASSERT_LT(before.trace(), 0);
  constexpr double kSmall = 1e-5;
  for (const auto& [a, b] : {std::pair(0, 0), std::pair(2, 2), std::pair(0, 1)}) {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    gradient(a, b) = gradient(b, a) = kSmall;
    const Eigen::Matrix3d newton =
        cell_stress(strain(rest, e, gradient, {}).state).contacts - before;
    const auto slow = make_engine(e, rest);
    constexpr long kSteps = 2000;
    slow->set_background_damping(40);
    slow->set_velocity_gradient(gradient / (kSteps * e.time_step));
    slow->step(kSteps);
    slow->set_velocity_gradient(Eigen::Matrix3d::Zero());
    come_to_rest(*slow, 1e-9);
    const Eigen::Matrix3d damped = cell_stress(slow->snapshot()).contacts - before;
    EXPECT_LT((newton - damped).norm(), 0.02 * damped.norm()) << a << b;
  }
}

struct Layer {
  EngineSettings settings = settings_of(HertzLaw{5e6, 0.3, 0.3}, 0.5);
  Snapshot rest;
  double height = 0;

  Layer() {
    const auto engine = settled(settings, true, 5, 6);
    settings.cell = engine->snapshot().cell;
    rest = relax(engine->snapshot(), settings, {0, 0, -kG}, {}, {}).state;
    for (const Grain& g : rest.grains) height = std::max(height, g.position.z() + g.radius);
  }
};

const Layer& layer() {
  static const Layer one;
  return one;
}

TEST(SphereStrain, ALayerIsStrainedAsItsCellAndHasAPotential) {
  const Layer& l = layer();
  LayerProber prober(l.rest, l.settings, l.height, kStrain);
  ASSERT_TRUE(prober.settle(nullptr));
  ASSERT_EQ(LayerProber::count(), 12);
  const double stiff = 5e6 * 0.1;
  Eigen::Matrix3d modulus = Eigen::Matrix3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const auto forth = prober.probe(2 * axis, nullptr), back = prober.probe(2 * axis + 1, nullptr);
    ASSERT_TRUE(forth && back);
    if (axis < 2) {
      EXPECT_DOUBLE_EQ(forth->gradient(axis, axis), kStrain);
    }
    EXPECT_EQ(forth->gained + forth->lost, 0);
    const Eigen::Matrix3d strain = (forth->gradient - back->gradient) / (2 * kStrain);
    EXPECT_NEAR(strain(axis, axis), 1, 0.5) << axis;
    modulus.col(axis) = (forth->stress - back->stress).diagonal() / (2 * kStrain);
    EXPECT_GT(modulus(axis, axis), 0.01 * stiff) << axis;
    // Forth and back do the opposite: no contact slides anew.
    EXPECT_LT((forth->stress + back->stress - 2 * prober.stress_before()).norm(),
              0.1 * (forth->stress - back->stress).norm());
  }
  // The stress has a potential, but for friction.
  EXPECT_NEAR(modulus(0, 1) / modulus(1, 0), 1, 0.1);
}

// Twice the strain, twice the stress.
TEST(SphereStrain, SmallStrainsAreLinear) {
  const Layer& l = layer();
  const auto change = [&](double strain) {
    LayerProber prober(l.rest, l.settings, l.height, strain);
    EXPECT_TRUE(prober.settle(nullptr));
    const auto forth = prober.probe(4, nullptr), back = prober.probe(5, nullptr);
    return Eigen::Matrix3d((forth->stress - back->stress) / strain);
  };
  const Eigen::Matrix3d one = change(kStrain), two = change(2 * kStrain);
  EXPECT_LT((one - two).norm(), 0.02 * one.norm());
}

TEST(SphereStrain, IsToldToStopAndRefusesWhatItDoesNotKnow) {
  const Layer& l = layer();
  LayerProber prober(l.rest, l.settings, l.height, kStrain);
  const auto stop = [](double) { return false; };
  EXPECT_FALSE(prober.settle(stop));
  ASSERT_TRUE(prober.settle(nullptr));
  EXPECT_FALSE(prober.probe(0, stop).has_value());
  const auto complaint = [&](const Snapshot& s, const Eigen::Matrix3d& gradient) {
    try {
      strain(s, l.settings, gradient, {});
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const Eigen::Matrix3d small = kStrain * Eigen::Matrix3d::Identity();
  EXPECT_THAT(complaint(l.rest, small), HasSubstr("touches wall floor, allowed: free grains"));
  EXPECT_THAT(complaint(l.rest, 0.1 * Eigen::Matrix3d::Identity()),
              HasSubstr("allowed: below 0.01"));
}

}  // namespace
}  // namespace grainfield::dem
