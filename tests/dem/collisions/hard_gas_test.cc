// How a gas of hard grains starts, and what theory says of it.
#include <gtest/gtest.h>

#include "dem/collisions/gas.h"
#include "dem/collisions/hard_engine.h"

namespace grainfield::dem {
namespace {

template <int D>
void expect_start() {
  GasSetup gas;
  gas.grains = 1234;
  gas.radius = 0.02;
  gas.mass = 3;
  gas.speed = 0.7;
  for (const double share : {0.1, 0.7, 1.0}) {
    gas.fraction = share * largest_fraction<D>(gas.grains, gas.radius);
    Random random(9);
    const auto grains = start_gas<D>(gas, random);
    HardScene<D> scene;
    scene.box = gas_box<D>(gas);
    EXPECT_NO_THROW(check_scene(scene, grains)) << share;
    double volume = 1;
    VectorOf<D> momentum = VectorOf<D>::Zero();
    for (int a = 0; a < D; ++a) volume *= scene.box.size[a];
    for (const Body<D>& g : grains) momentum += g.velocity / g.inverse_mass;
    EXPECT_NEAR(1234 * round_volume<D>(0.02) / volume, gas.fraction, 1e-12);
    EXPECT_LT(momentum.norm(), 1e-10);
    EXPECT_NEAR(temperature_of(grains), 3 * 0.7 * 0.7, 1e-12);
    EXPECT_EQ(spin_temperature_of(grains), 0);
    // The fourth moment of a normal distribution is 3 times the square of the second: 1234 D
    // numbers.
    double second = 0, fourth = 0;
    for (const Body<D>& g : grains) {
      second += g.velocity.squaredNorm() / (1234 * D);
      fourth += g.velocity.array().pow(4).sum() / (1234 * D);
    }
    EXPECT_NEAR(fourth / (second * second), 3, 0.3);
  }
}

TEST(HardGasStart, FillsTheBoxWithoutOverlap) {
  expect_start<2>();
  expect_start<3>();
}

TEST(HardGasStart, LatticesAreDense) {
  // pi/sqrt(12) and pi/sqrt(18) where the lattice fits; a square never fits it quite.
  EXPECT_GT(largest_fraction<2>(10000, 1), 0.88);
  EXPECT_LT(largest_fraction<2>(10000, 1), 0.9069);
  EXPECT_NEAR(largest_fraction<3>(4000, 1), 0.74048, 1e-5);
  EXPECT_LT(largest_fraction<3>(3990, 1), 0.74048);
}

// Dilute: rates of the kinetic theory of gases, m, s.
TEST(HardGasTheory, HasTheDiluteLimits) {
  const double f = 1e-6, d = 0.2, speed = 3, pi = std::numbers::pi;
  const double disks = f / (pi * 0.01), spheres = f / (4.0 / 3 * pi * 1e-3);  // a number density
  EXPECT_NEAR(enskog_rate<2>(f, 0.1, speed, gas_compressibility<2>(f)),
              2 * disks * d * std::sqrt(pi) * speed, 1e-5 * speed * f / d * 10);
  EXPECT_NEAR(enskog_rate<3>(f, 0.1, speed, gas_compressibility<3>(f)),
              4 * spheres * d * d * std::sqrt(pi) * speed, 1e-5 * speed * f / d * 10);
  // Second virial coefficients: 2 of disks, 4 of spheres.
  EXPECT_NEAR((gas_compressibility<2>(f) - 1) / f, 2, 1e-5);
  EXPECT_NEAR((gas_compressibility<3>(f) - 1) / f, 4, 2e-5);
  // Both forms are one within 1/2 %.
  for (const double part : {0.1, 0.3, 0.5}) {
    EXPECT_NEAR(gas_virial_series<2>(part) / gas_compressibility<2>(part), 1, 5e-3) << part;
    EXPECT_NEAR(gas_virial_series<3>(0.8 * part) / gas_compressibility<3>(0.8 * part), 1, 5e-3);
  }
  EXPECT_NEAR(gas_compressibility<2>(0.5), 4.125, 1e-12);
  EXPECT_NEAR(gas_compressibility<3>(0.3), 1.363 / 0.343, 1e-12);
}

// Collisions of a gas that is mixed, and its cooling where correlations are still small.
template <int D>
void expect_kinetics(std::int64_t grains, double fraction) {
  GasSetup gas;
  gas.grains = grains;
  gas.fraction = fraction;
  gas.radius = 0.5;
  Random random(3);
  HardScene<D> scene;
  scene.box = gas_box<D>(gas);
  HardEngine<D> mixing(scene, start_gas<D>(gas, random));
  const auto collide = [&](HardEngine<D>& engine, long pairs) {
    while (engine.tally().pairs < pairs) engine.advance(pairs - engine.tally().pairs);
  };
  collide(mixing, 10 * grains);
  const double begin = mixing.time();
  collide(mixing, 40 * grains);
  const double rate = 60 / (mixing.time() - begin);
  EXPECT_NEAR(rate / enskog_rate<D>(fraction, 0.5, 1, gas_compressibility<D>(fraction)), 1, 0.02);

  std::vector<Body<D>> now;
  for (std::size_t k = 0; k < mixing.grains(); ++k) now.push_back(mixing.body(k));
  scene.grains.restitution = 0.95;
  HardEngine<D> cooling(scene, now);
  const double tau =
      haff_time<D>(enskog_rate<D>(fraction, 0.5, 1, gas_compressibility<D>(fraction)), 0.95);
  cooling.advance(1L << 40, tau);
  for (std::size_t k = 0; k < now.size(); ++k) now[k] = cooling.body(k);
  EXPECT_NEAR(temperature_of(now), 0.25, 0.01);
}

TEST(HardGasTheory, EnskogsRateAndHaffsLawHold) {
  expect_kinetics<2>(2500, 0.2);
  expect_kinetics<3>(2048, 0.15);
}

}  // namespace
}  // namespace grainfield::dem
