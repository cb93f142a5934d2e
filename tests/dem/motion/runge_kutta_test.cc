// Leapfrog with a fourth-order Runge-Kutta turning: orders, conservation, beside the splitting.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "dem/engine/engine.h"
#include "dem/motion/runge_kutta3.h"
#include "tests/dem/bits_scene.h"
#include "tests/dem/gas_scene.h"
#include "tests/dem/top_scene.h"

namespace grainfield::dem {
namespace {

using Eigen::Vector3d;
using RungeKutta3 = RungeKuttaIntegrator<3>;
using Verlet3 = VerletIntegrator<3>;

struct TopErrors {
  double spin = 0, energy = 0, momentum = 0;
};
TopErrors errors_of_top(int steps) {
  const double time = 4;
  const top::Ended end = top::turned<RungeKutta3>(time, steps);
  EXPECT_LT(end.unit_error, 1e-14);
  return {(end.spin - top::exact_spin(time)).norm(),
          std::fabs(top::energy_of(end.spin) / top::energy_of(top::kStart) - 1),
          (end.momentum - top::kMoments.cwiseProduct(top::kStart)).norm()};
}

// Spin in the body frame against Jacobi's elliptic functions; the rotation through the angular
// momentum, which must point where it did.
TEST(RungeKutta, AFreeTopConvergesWithTheFourthOrder) {
  TopErrors previous = errors_of_top(100);
  for (const int steps : {200, 400, 800}) {
    const TopErrors now = errors_of_top(steps);
    EXPECT_NEAR(std::log2(previous.spin / now.spin), 4, 0.2) << steps;
    EXPECT_NEAR(std::log2(previous.momentum / now.momentum), 4, 0.2) << steps;
    // A term of the next order is still seen at first, round-off (1e-13) at last.
    EXPECT_NEAR(std::log2(previous.energy / now.energy), 4, 0.3) << steps;
    previous = now;
  }
  EXPECT_LT(previous.spin, 1e-9);
}

// A top tied to a direction of space: torque -k a x e, a the body's third axis, potential energy
// -k a.e. Returns where it stands at the end.
struct Tied {
  Vector3d axis, momentum;
  double energy = 0, drift = 0;
};
template <class Integrator>
Tied tied(double time, long steps) {
  const double k = 3;
  const Vector3d e = Vector3d(1, 2, 3).normalized();
  const Integrator integrator(time / static_cast<double>(steps));
  Inertia<3> inertia;
  inertia.mass = 1;
  inertia.moments = top::kMoments;
  Body<3> b;
  b.inverse_mass = 1;
  b.inverse_inertia = 0.5;
  b.spin = top::kStart;
  typename Integrator::Memory m;
  const auto axis = [&] { return Vector3d(m.rotation * Vector3d::UnitZ()); };
  const auto load = [&] {
    Load<3> out;
    out.torque = k * axis().cross(e);
    return out;
  };
  const auto energy = [&] {
    return top::energy_of(m.rotation.conjugate() * b.spin) - k * axis().dot(e);
  };
  integrator.start(b, m, inertia, load());
  const double before = energy();
  Tied out;
  for (long s = 0; s < steps; ++s) {
    integrator.begin(b, m, inertia);
    integrator.end(b, m, inertia, load());
    out.drift = std::max(out.drift, std::fabs(energy() - before));
  }
  out.axis = axis();
  out.momentum = angular_momentum_of(b, m.rotation, inertia);
  out.energy = energy() - before;
  return out;
}

// Torques that change with place: second order, as for places.
TEST(RungeKutta, ATopThatIsTiedConvergesWithTheSecondOrder) {
  const Tied exact = tied<RungeKutta3>(4, 64000);
  double previous = 0;
  for (const int steps : {250, 500, 1000, 2000}) {
    const Tied now = tied<RungeKutta3>(4, steps);
    const double error = (now.axis - exact.axis).norm() + (now.momentum - exact.momentum).norm();
    if (previous > 0) {
      EXPECT_NEAR(std::log2(previous / error), 2, 0.2) << steps;
    }
    previous = error;
  }
  // The other integrator ends at the same place.
  const Tied other = tied<Verlet3>(4, 64000);
  EXPECT_LT((other.axis - exact.axis).norm() + (other.momentum - exact.momentum).norm(), 1e-6);
}

// A torque held inside the four evaluations would gain energy at the third order of the step,
// without bound (1.4e-3 at t = 400); leapfrog's error stays where it is.
TEST(RungeKutta, ATiedTopKeepsItsEnergyForLong) {
  const double few = tied<RungeKutta3>(40, 2000).drift, many = tied<RungeKutta3>(400, 20000).drift;
  EXPECT_LT(many, 1.2 * few);
  EXPECT_LT(tied<RungeKutta3>(40, 4000).drift, 0.3 * few);
}

// In space a torque gives the angular momentum M dt, whatever the body does meanwhile.
TEST(RungeKutta, AConstantTorqueGivesItsMomentum) {
  for (const int steps : {50, 100}) {
    const double time = 2;
    const RungeKutta3 integrator(time / steps);
    Inertia<3> inertia;
    inertia.mass = 1;
    inertia.moments = top::kMoments;
    Body<3> b;
    b.inverse_mass = 1;
    b.inverse_inertia = 0.5;
    b.spin = top::kStart;
    RungeKutta3::Memory m;
    Load<3> load;
    load.torque = {0.3, -0.2, 0.5};
    integrator.start(b, m, inertia, load);
    for (int s = 0; s < steps; ++s) {
      integrator.begin(b, m, inertia);
      integrator.end(b, m, inertia, load);
    }
    const Vector3d gained =
        angular_momentum_of(b, m.rotation, inertia) - top::kMoments.cwiseProduct(top::kStart);
    EXPECT_LT((gained - time * load.torque).norm(), steps == 50 ? 1e-5 : 1e-6) << steps;
  }
}

// The penalty law is a gradient: without damping and friction a gas keeps its energy, by either
// integrator to the same order: what differs is which of its collisions are amiss.
TEST(RungeKutta, APenaltyGasKeepsItsEnergyAsWellAsWithTheSplitting) {
  const auto drift = [](IntegratorKind kind, double step) {
    EngineSettings s = gas::settings_of(PenaltyLaw{2e3, 0, 0}, step);
    s.integrator = kind;
    const auto engine = make_engine(s);
    gas::add_box(*engine, 3 * 2.6);
    gas::add_gas(*engine, 3, 2.6, 0.7, 1.3, 2);
    return gas::drift_of(*engine, 25, std::lround(0.25 / step));
  };
  const gas::Drift verlet = drift(IntegratorKind::verlet, 5e-4),
                   other = drift(IntegratorKind::runge_kutta, 5e-4);
  RecordProperty("verlet", fmt::format("{:.2e}", verlet.worst));
  RecordProperty("runge_kutta", fmt::format("{:.2e}", other.worst));
  EXPECT_GT(other.contacts, 50);
  EXPECT_LT(other.worst, 1e-3);
  EXPECT_LT(other.worst, 10 * verlet.worst);
  EXPECT_LT(verlet.worst, 10 * other.worst);
}

// The books close as they do with the splitting, for damped grains with friction, too.
TEST(RungeKutta, EnergyBalanceCloses) {
  const auto balance = [](IntegratorKind kind, double step) {
    EngineSettings s = gas::settings_of(PenaltyLaw{2e3, 1e3, 0.1}, step);
    s.friction = 0.4;
    s.integrator = kind;
    s.energy_balance = true;
    const auto engine = make_engine(s);
    gas::add_box(*engine, 2 * 2.6, 0.4);
    gas::add_gas(*engine, 2, 2.6, 0.7, 1.3, 2);
    engine->step(std::lround(2 / step));
    const Diagnostics d = engine->measure();
    EXPECT_GT(d.dissipated_energy(), 0.3 * d.size_of_work());
    return std::fabs(d.energy_balance()) / d.size_of_work();
  };
  EXPECT_LT(balance(IntegratorKind::runge_kutta, 2e-4), 1e-3);
  EXPECT_LT(balance(IntegratorKind::verlet, 2e-4), 1e-3);
}

TEST(RungeKutta, SameBitsOnThreadsAndAfterARestart) {
  const auto run = [](int threads, long cut) {
    EngineSettings s = gas::settings_of(HertzEllipticLaw{1e4, 0.3, 0.2}, 5e-4);
    s.friction = 0.4;
    s.threads = threads;
    s.integrator = IntegratorKind::runge_kutta;
    auto engine = make_engine(s);
    gas::add_box(*engine, 3 * 2.6, 0.2);
    gas::add_gas(*engine, 3, 2.6, 0.7, 1.3, 2);
    if (cut > 0) {
      engine->step(cut);
      const std::string checkpoint = engine->checkpoint();
      engine = make_engine(s);
      gas::add_box(*engine, 3 * 2.6, 0.2);
      engine->restore(checkpoint);
    }
    engine->step(600 - engine->steps());
    EXPECT_EQ(engine->snapshot().attributes.at("integrator"), "runge_kutta");
    return bits::hash_of(engine->snapshot());
  };
  const std::uint64_t one = run(1, 0);
  EXPECT_TRUE(run(2, 0) == one);
  EXPECT_TRUE(run(2, 333) == one);
}

TEST(RungeKutta, IsForGrainsThatAreNoSpheres) {
  const auto refusal = [](ShapeKind shape) {
    EngineSettings s = gas::settings_of(LinearLaw{}, 1e-5);
    s.shape = shape;
    s.integrator = IntegratorKind::runge_kutta;
    try {
      make_engine(s);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal(ShapeKind::superellipsoid), "accepted");
  EXPECT_EQ(refusal(ShapeKind::sphere),
            "motion.integrator: found \"runge_kutta\", allowed for grains of this shape (sphere): "
            "verlet");
  for (const auto& [shape, word] :
       {std::pair(ShapeKind::disk, "disk"), std::pair(ShapeKind::polygon, "polygon")}) {
    EXPECT_EQ(refusal(shape),
              fmt::format("motion.integrator: found \"runge_kutta\", allowed for grains of this "
                          "shape ({}): verlet, gear",
                          word));
  }
}

}  // namespace
}  // namespace grainfield::dem
