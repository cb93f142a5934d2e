// Quasi-static changes of superellipsoids: closed forms, Newton's method and damped dynamics beside
// the linear response.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dem/engine/engine.h"
#include "dem/quasistatic/linear_range.h"
#include "dem/quasistatic/quasistatic.h"
#include "dem/quasistatic/small_loads.h"
#include "dem/quasistatic/strains.h"
#include "dem/snapshot/contact_changes.h"
#include "tests/dem/imbalance.h"
#include "tests/dem/sphere_relaxation_scene.h"
#include "tests/dem/superellipsoid_scene.h"

namespace grainfield::dem {
namespace {

EngineSettings shaped(const AnyLaw& law, double friction) {
  EngineSettings e = settings_of(law, friction);
  e.shape = ShapeKind::superellipsoid;
  return e;
}

NewGrain body(const Vec3& at, const std::array<double, 3>& axes,
              const std::array<double, 2>& exponents = {1, 1}) {
  NewGrain g;
  g.x = at.x();
  g.y = at.y();
  g.z = at.z();
  g.axes = axes;
  g.exponents = exponents;
  g.density = kDensity;
  return g;
}

// An ellipsoid on its shortest axis sinks as the law says of a plane's contact.
TEST(SuperellipsoidRelaxation, ABodyUnderItsWeightSinksAsTheLawSays) {
  const std::array<double, 3> axes{1.5 * kRadius, 1.2 * kRadius, 0.8 * kRadius};
  for (const AnyLaw& law :
       {AnyLaw(PenaltyLaw{1e4, 1e4, 0}), AnyLaw(HertzEllipticLaw{5e6, 0.3, 0})}) {
    const EngineSettings e = shaped(law, 0.3);
    const auto engine = make_engine(e);
    engine->add_wall({"floor", {0, 0, 0}, {0, 0, 1}, 0.3});
    engine->add(body({0, 0, axes[2]}, axes));
    const QuasistaticResult out = relax(engine->snapshot(), e, {0, 0, -kG}, {}, {});
    expect_balanced(out.state, 1e-8);
    const double weight = out.state.grains[0].mass * kG;
    const double depth = axes[2] - out.state.grains[0].position.z();
    if (const auto* penalty = std::get_if<PenaltyLaw>(&law)) {
      EXPECT_NEAR(depth, weight / penalty->normal_stiffness, 1e-6 * depth);
    } else {
      // Curvatures of the pole, c/a^2 and c/b^2, half of them relative to the plane.
      const auto& hertz = std::get<HertzEllipticLaw>(law);
      const EllipticContact contact = elliptic_contact(0.5 * axes[2] / (axes[0] * axes[0]),
                                                       0.5 * axes[2] / (axes[1] * axes[1]));
      const double force = contact.gamma * hertz.effective_young() * std::pow(depth, 1.5);
      EXPECT_NEAR(force, weight, 1e-6 * weight);
    }
  }
}

// Ellipsoids side by side along their axes are springs in line, whatever their curvatures.
TEST(SuperellipsoidRelaxation, ALatticeOfEllipsoidsHasItsModuli) {
  const double k = 1e4, share = 1 - 1e-3;
  const std::array<double, 3> axes{1.2 * kRadius, kRadius, 0.8 * kRadius};
  EngineSettings e = shaped(PenaltyLaw{k, k, 0}, 0.5);
  e.gravity_z = 0;
  constexpr int kSide = 4;
  const Vec3 edge = 2 * share * Vec3(axes[0], axes[1], axes[2]);
  e.cell.periodic = {true, true, true};
  e.cell.edges = (kSide * edge).asDiagonal();
  const auto engine = make_engine(e);
  for (int n = 0; n < kSide * kSide * kSide; ++n) {
    const Vec3 at(n % kSide, n / kSide % kSide, n / (kSide * kSide));
    engine->add(body(edge.cwiseProduct(at + Vec3::Constant(0.5)), axes));
  }
  Snapshot start = engine->snapshot();
  start.gravity.setZero();
  start = relax(start, e, start.gravity, {}, {}).state;
  ASSERT_EQ(start.contacts.size(), 3u * kSide * kSide * kSide);
  QuasistaticSettings how;
  Strains strains(start, e, how);
  const double strain = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    gradient(axis, axis) = -strain;
    const Snapshot pressed = strains.strain(gradient, {}).state;
    ASSERT_EQ(pressed.contacts.size(), start.contacts.size());
    for (std::size_t c = 0; c < start.contacts.size(); ++c) {
      const bool along = std::fabs(start.contacts[c].normal[axis]) > 0.9;
      const double change = pressed.contacts[c].normal_force - start.contacts[c].normal_force;
      EXPECT_NEAR(change, along ? k * strain * edge[axis] : 0, 1e-5 * k * strain * edge[axis]);
    }
  }
}

struct Packing {
  EngineSettings settings;
  std::string checkpoint;
  Snapshot rest;  ///< by Newton's method
  std::int64_t top = 0;

  std::unique_ptr<Engine> empty_engine() const {
    auto engine = make_engine(settings);
    engine->add_wall({"floor", {0, 0, 0}, {0, 0, 1}, settings.friction});
    return engine;
  }
  double mean_weight() const {
    double sum = 0;
    for (const Grain& g : rest.grains) sum += g.mass * kG;
    return sum / static_cast<double>(rest.grains.size());
  }
};

/// 48 of them dropped onto a floor between sides that repeat, held by strong friction.
Packing dropped(const AnyLaw& law) {
  Packing p;
  p.settings = shaped(law, 3);
  constexpr int kColumns = 4, kLayers = 3;
  const double cell = 2.5 * kRadius;
  p.settings.cell.periodic = {true, true, false};
  p.settings.cell.edges = Vec3(kColumns * cell, kColumns * cell, 1).asDiagonal();
  const auto engine = p.empty_engine();
  Random random(2);
  for (int k = 0; k < kColumns * kColumns * kLayers; ++k) {
    std::array<double, 3> axes{};
    for (double& r : axes) r = kRadius * random.uniform(0.85, 1.15);
    NewGrain g = body(cell * Vec3(k % kColumns + 0.5, k / kColumns % kColumns + 0.5,
                                  k / (kColumns * kColumns) + 0.5) +
                          0.1 * kRadius * random_direction(random),
                      axes, {random.uniform(0.8, 1.2), random.uniform(0.8, 1.2)});
    const auto turn = random_rotation(random);
    g.orientation = {turn.w(), turn.x(), turn.y(), turn.z()};
    engine->add(g);
  }
  come_to_rest(*engine, 1e-10);
  p.checkpoint = engine->checkpoint();
  const Snapshot settled = engine->snapshot();
  QuasistaticSettings how;
  how.unbalanced_force_ratio = 1e-11;
  const QuasistaticResult rest = relax(settled, p.settings, {0, 0, -kG}, {}, how);
  EXPECT_EQ(rest.contacts_gained + rest.contacts_lost, 0);
  expect_balanced(rest.state, 1e-11);
  p.rest = rest.state;
  for (std::size_t k = 0; k < p.rest.grains.size(); ++k) {
    // What the engine called rest is rest.
    EXPECT_LT((p.rest.grains[k].position - settled.grains[k].position).norm(), 1e-5 * kRadius);
    if (p.rest.grains[k].position.z() > p.rest.grains[p.top].position.z())
      p.top = p.rest.grains[k].id;
  }
  return p;
}

AppliedForce on(std::int64_t id, const Vec3& force) {
  AppliedForce out;
  out.id = id;
  out.fx = force.x();
  out.fy = force.y();
  out.fz = force.z();
  return out;
}

/// Half the difference of two states, from the linear response: root mean squares, over that.
double apart_from(const SmallResponse& linear, const Snapshot& with, const Snapshot& against) {
  double all = 0, apart = 0;
  for (std::size_t k = 0; k < linear.moved.size(); ++k) {
    const Vec3 moved = 0.5 * (with.grains[k].position - against.grains[k].position);
    all += linear.moved[k].squaredNorm();
    apart += (moved - linear.moved[k]).squaredNorm();
  }
  return std::sqrt(apart / all);
}

class LinearResponseOfSuperellipsoids : public ::testing::TestWithParam<bool> {
 public:
  // Laws whose springs know no branch between loading and unloading.
  static const Packing& packing(bool hertz) {
    static const Packing linear = dropped(PenaltyLaw{500, 250, 0.5});
    static const Packing elliptic = dropped(HertzEllipticLaw{1e6, 0.3, 0.5, true});
    return hertz ? elliptic : linear;
  }
};

TEST_P(LinearResponseOfSuperellipsoids, IsThatOfNewtonsMethod) {
  const Packing& p = packing(GetParam());
  const double size = 1e-4 * p.mean_weight();
  const Vec3 force(0.3 * size, 0, -size);
  SmallLoads loads(p.rest, p.settings);
  const SmallResponse linear = loads.response({p.top}, force);
  EXPECT_NEAR(base_force(linear.change).z(), size, 1e-6 * size);
  QuasistaticSettings how;
  how.unbalanced_force_ratio = 1e-11;
  const Snapshot with = relax(p.rest, p.settings, p.rest.gravity, on(p.top, force), how).state;
  const Snapshot against = relax(p.rest, p.settings, p.rest.gravity, on(p.top, -force), how).state;
  EXPECT_LT(apart_from(linear, with, against), 1e-4);
}

// A small load applied in the step loop, slowly, and damped until it rests.
TEST_P(LinearResponseOfSuperellipsoids, IsThatOfDampedDynamics) {
  const Packing& p = packing(GetParam());
  SmallLoads loads(p.rest, p.settings);
  // A tenth of what changes the first contact.
  const Vec3 some(0, 0, -0.01 * p.mean_weight());
  const SmallResponse of_some = loads.response({p.top}, some);
  Snapshot upwards = of_some.change;
  for (Contact& c : upwards.contacts) {
    c.force *= -1;
    c.normal_force *= -1;
  }
  const double first = std::min(linear_range(loads.start(), of_some.change).changed(0),
                                linear_range(loads.start(), upwards).changed(0));
  const Vec3 force = std::min(1.0, 0.1 * first) * some;
  const SmallResponse linear = loads.response({p.top}, force);
  Snapshot states[2];
  for (int side = 0; side < 2; ++side) {
    const auto engine = p.empty_engine();
    engine->restore(p.checkpoint);
    constexpr int kParts = 200;
    for (int k = 1; k <= kParts; ++k) {
      const double share = static_cast<double>(k) / kParts;
      engine->apply(on(p.top, (side == 0 ? 1 : -1) * share * share * (3 - 2 * share) * force));
      engine->step(40);
    }
    come_to_rest(*engine, 1e-10);
    states[side] = engine->snapshot();
    const ContactChanges changes = compare_contacts(p.rest, states[side]);
    EXPECT_EQ(changes.gained + changes.lost + changes.newly_sliding, 0);
  }
  const double apart = apart_from(linear, states[0], states[1]);
  std::printf("a load of %.1e weights: damped dynamics is apart from the linear response by %.1e\n",
              -force.z() / p.mean_weight(), apart);
  EXPECT_LT(apart, 1e-3);
}

// What one grain settles under a load on another, and the other under the same load on the one:
// equal but for what springs take of symmetry, and that Hertz' force of curvatures is no gradient.
TEST_P(LinearResponseOfSuperellipsoids, IsReciprocalButForFriction) {
  const Packing& p = packing(GetParam());
  SmallLoads loads(p.rest, p.settings);
  const Vec3 force(0, 0, -0.01 * p.mean_weight());
  double worst = 0;
  for (std::size_t other = 0; other < p.rest.grains.size(); other += 7) {
    const auto id = static_cast<std::int64_t>(other);
    if (id == p.top) continue;
    const SmallResponse first = loads.response({p.top}, force),
                        second = loads.response({id}, force);
    const double one = first.moved[other].z(),
                 two = second.moved[static_cast<std::size_t>(p.top)].z();
    const double own =
        std::sqrt(first.moved[static_cast<std::size_t>(p.top)].z() * second.moved[other].z());
    worst = std::max(worst, std::fabs(one - two) / own);
  }
  std::printf("reciprocal to %.1e\n", worst);
  EXPECT_LT(worst, GetParam() ? 0.05 : 0.005);
}

INSTANTIATE_TEST_SUITE_P(, LinearResponseOfSuperellipsoids, ::testing::Bool(),
                         [](const auto& one) { return one.param ? "Hertz" : "Penalty"; });

TEST(SuperellipsoidRelaxation, RefusesWhatItDoesNotKnow) {
  EngineSettings e = shaped(PenaltyLaw{}, 0.3);
  const auto engine = make_engine(e);
  engine->add_wall({"floor", {0, 0, 0}, {0, 0, 1}, 0.3});
  engine->add(body({0, 0, kRadius}, {kRadius, kRadius, kRadius}));
  engine->add(body({0, 0, 3 * kRadius}, {kRadius, kRadius, kRadius}));
  Snapshot start = engine->snapshot();
  const auto complaint = [&](const Snapshot& s, const EngineSettings& settings) {
    try {
      relax(s, settings, {0, 0, -kG}, {}, {});
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_NE(complaint(start, shaped(HertzLaw{}, 0.3)).find("hertz_elliptic"), std::string::npos);
  EngineSettings rolls = e;
  rolls.rolling = {1e3, 0.1, 0.1, 0, 0, 0};
  EXPECT_NE(complaint(start, rolls).find("roll"), std::string::npos) << complaint(start, rolls);
  start.grains[1].axes.setZero();
  EXPECT_NE(complaint(start, e).find("all or none"), std::string::npos) << complaint(start, e);
}

}  // namespace
}  // namespace grainfield::dem
