// Quasi-static relaxation against closed forms.
#include "dem/quasistatic/quasistatic.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/grains/packing.h"
#include "dem/quasistatic/plane_network.h"
#include "dem/quasistatic/sparse_newton.h"
#include "dem/random/random.h"
#include "dem/shapes/polygon.h"
#include "dem/snapshot/contact_changes.h"
#include "tests/dem/imbalance.h"
#include "tests/dem/quasistatic_scene.h"

namespace grainfield::dem {
namespace {

TEST(Quasistatic, TwoDisksUnderWeightOverlapAsTheLawsSay) {
  const double r = 0.01, m = 1000 * std::numbers::pi * r * r;
  const Snapshot start = put({disk(0, r), disk(0, 3 * r)}, {wall("floor", 0, 0, 0, 1, 0.3)});
  EngineSettings linear;
  const double k = 1e6;
  linear.law = LinearLaw{k, 3e5, 0, 0};
  const QuasistaticResult a = relax(start, linear, {0, -kG, 0}, {}, {});
  expect_balanced(a.state, 1e-8);
  EXPECT_NEAR(a.state.grains[0].position.y(), r - 2 * m * kG / k, 1e-12 * r);
  EXPECT_NEAR(a.state.grains[1].position.y(), 3 * r - 3 * m * kG / k, 1e-12 * r);
  EXPECT_EQ(a.contacts_gained, 2);
  const QuasistaticResult b = relax(start, area_law(0.3), {0, -kG, 0}, {}, {});
  Overlap o;
  ASSERT_TRUE(overlap_with_plane<true>(b.state.grains[0].position.y(), r, 0, 1, o));
  EXPECT_NEAR(1e7 * o.area / o.length, 2 * m * kG, 1e-8 * m * kG);
  const double apart = (b.state.grains[1].position - b.state.grains[0].position).y();
  ASSERT_TRUE(overlap_of_disks<true>(0, apart, r, r, o));
  EXPECT_NEAR(1e7 * o.area / o.length, m * kG, 1e-8 * m * kG);
  ASSERT_EQ(b.state.contacts.size(), 2u);
  EXPECT_EQ(b.state.contacts[0].j, -1);
  EXPECT_NEAR(b.state.contacts[0].force.y(), 2 * m * kG, 1e-8 * m * kG);
  EXPECT_EQ(b.state.contacts[1].j, 1);
  EXPECT_NEAR(b.state.contacts[1].force.y(), -m * kG, 1e-8 * m * kG);
}

TEST(Quasistatic, ALooseGrainFallsUntilItTouches) {
  const double r = 0.01;
  const Snapshot start = put({disk(0, r), disk(2.1 * r, r), disk(1.0 * r, 5 * r)},
                             {wall("floor", 0, 0, 0, 1, 0.5), wall("left", -r, 0, 1, 0, 0.5),
                              wall("right", 3.1 * r, 0, -1, 0, 0.5)});
  const QuasistaticResult out = relax(start, area_law(0.5), {0, -kG, 0}, {}, {});
  expect_balanced(out.state, 1e-8);
  EXPECT_EQ(out.contacts_gained, 4);  // friction on the floor keeps the lower two off the walls
  EXPECT_LT(out.state.grains[2].position.y(), 3 * r);
  EXPECT_GT(out.state.grains[2].position.y(), 2.5 * r);
  EXPECT_NEAR(base_force(out.state).y() / weight(out.state), 1, 1e-7);
}

TEST(Quasistatic, SquaresStackWithTheOverlapsOfTheirWeight) {
  const double a = 0.01, m = 1000 * a * a;
  const Outline square = {{0, 0}, {a, 0}, {a, a}, {0, a}};
  const Snapshot start = put({polygon(0, 0.5 * a, square), polygon(0.1 * a, 1.5 * a, square)},
                             {wall("floor", 0, 0, 0, 1, 0.5)});
  EngineSettings e = area_law(0.5);
  const QuasistaticResult out = relax(start, e, {0, -kG, 0}, {}, {});
  expect_balanced(out.state, 1e-8);
  ASSERT_EQ(out.state.contacts.size(), 2u);
  EXPECT_NEAR(out.state.contacts[0].normal_force, 2 * m * kG, 1e-7 * m * kG);
  EXPECT_NEAR(out.state.contacts[1].normal_force, m * kG, 1e-7 * m * kG);
  // The weight's line of action: the upper square stands off centre by a tenth of its side, so the
  // floor's force passes halfway between the two centres.
  EXPECT_NEAR(out.state.contacts[0].point.x(), 0.05 * a, 1e-3 * a);
}

TEST(Quasistatic, LatticeBlockIsMirroredAndItsBaseCarriesTheWeight) {
  // Without friction, so that the state does not depend on how it was reached.
  const Snapshot start = block(8, 5, 0);
  const QuasistaticResult out = relax(start, area_law(0), {0, -kG, 0}, {}, {});
  expect_balanced(out.state, 1e-8);
  EXPECT_NEAR(base_force(out.state).y() / weight(out.state), 1, 1e-7);
  for (const Grain& g : out.state.grains) {
    double nearest = 1;
    for (const Grain& h : out.state.grains) {
      nearest = std::min(
          nearest, std::hypot(g.position.x() + h.position.x(), g.position.y() - h.position.y()));
    }
    EXPECT_LT(nearest, 1e-8 * g.radius);
    EXPECT_EQ(g.velocity.norm(), 0);
  }
}

TEST(Quasistatic, RelaxingARelaxedStateChangesNothing) {
  const Snapshot once = relax(block(6, 4, 0.2), area_law(0.5), {0, -kG, 0}, {}, {}).state;
  const QuasistaticResult again = relax(once, area_law(0.5), {0, -kG, 0}, {}, {});
  EXPECT_EQ(again.contacts_gained + again.contacts_lost + again.newly_sliding, 0);
  ASSERT_EQ(again.state.contacts.size(), once.contacts.size());
  for (std::size_t k = 0; k < once.grains.size(); ++k) {
    EXPECT_LT((again.state.grains[k].position - once.grains[k].position).norm(), 1e-11);
  }
  for (std::size_t k = 0; k < once.contacts.size(); ++k) {
    EXPECT_NEAR(again.state.contacts[k].spring, once.contacts[k].spring, 1e-6);
    EXPECT_EQ(again.state.contacts[k].sliding, once.contacts[k].sliding);
  }
}

TEST(Quasistatic, NewtonConvergesQuadraticallyOnAFixedNetwork) {
  const Snapshot rest = relax(block(8, 5, 5), area_law(5), {0, -kG, 0}, {}, {}).state;
  PlaneNetwork network(rest, area_law(5));
  network.set_load({0, -0.8 * kG, 0});
  network.set_scale(network.balance().mean_contact_force);
  SparseProblem problem;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(network.size());
  problem.residual = [&](const Eigen::VectorXd& z, Eigen::VectorXd& r) {
    return network.residual(z, r);
  };
  problem.tangent = [&](const Eigen::VectorXd& z, const Eigen::VectorXd& r,
                        Eigen::SparseMatrix<double>& m) { network.tangent(z, r, none, m); };
  Eigen::VectorXd z = none;
  const NewtonReport report = newton(problem, {1e-11, 20, 0.25}, *make_direct_solver(), z);
  EXPECT_TRUE(report.converged) << report.why;
  EXPECT_LE(report.iterations, 7);
  // Order of the iterations that are past the start and above round-off: log r_{k+1} / log r_k.
  double order = 0;
  std::string history;
  for (const double r : report.history) history += testing::PrintToString(r) + " ";
  for (std::size_t k = 1; k + 1 < report.history.size(); ++k) {
    const double before = report.history[k - 1], now = report.history[k],
                 after = report.history[k + 1];
    if (before < 0.1 && after > 1e-12) {
      order = std::max(order, std::log(after / now) / std::log(now / before));
    }
  }
  EXPECT_GT(order, 1.7) << history;
  RecordProperty("residuals", history);
}

TEST(Quasistatic, SmallForcesAreLinearAndReciprocal) {
  EngineSettings e;
  e.law = LinearLaw{1e6, 4e5, 0, 0};
  e.friction = 50;  // nothing slides
  const Snapshot rest = relax(block(7, 4, 50), e, {0, -kG, 0}, {}, {}).state;
  const double f = 1e-4 * weight(rest);
  QuasistaticSettings fine;
  fine.unbalanced_force_ratio = 1e-10;
  const auto displacement = [&](std::int64_t loaded, const Vec3& force, std::int64_t of) {
    AppliedForce a;
    a.id = loaded;
    a.fx = force.x();
    a.fy = force.y();
    const QuasistaticResult out = relax(rest, e, rest.gravity, a, fine);
    EXPECT_EQ(out.contacts_gained + out.contacts_lost + out.newly_sliding, 0);
    EXPECT_EQ(out.state.loaded_grain, loaded);
    return Vec3(out.state.grains[of].position - rest.grains[of].position);
  };
  const std::int64_t top = 23, side = 9;
  const Vec3 once = displacement(top, {0, -f, 0}, top);
  const Vec3 twice = displacement(top, {0, -2 * f, 0}, top);
  EXPECT_LT(once.y(), 0);
  EXPECT_NEAR(twice.y() / once.y(), 2, 0.01);  // second order: f over the contact forces
  // Maxwell and Betti: work of one force on the other's displacement. The springs' torque about a
  // lever that shrinks with the overlap leaves an asymmetry of the order of the overlap ratio.
  const double forth = displacement(top, {0, -f, 0}, side).x();
  const double back = displacement(side, {-f, 0, 0}, top).y();
  EXPECT_NEAR(-back / forth, -1, 0.02) << forth << " " << back;
}

TEST(Quasistatic, ReportsARearrangement) {
  const Snapshot rest = relax(block(6, 3, 0.2), area_law(0.3), {0, -kG, 0}, {}, {}).state;
  AppliedForce push;
  push.id = 14;  // in the top row
  push.fx = 3 * rest.grains[14].mass * kG;
  push.fy = 0.5 * rest.grains[14].mass * kG;
  const QuasistaticResult out = relax(rest, area_law(0.3), rest.gravity, push, {});
  expect_balanced(out.state, 1e-8);
  EXPECT_GT(out.contacts_lost, 0);
  const ContactChanges c = compare_contacts(rest, out.state);
  EXPECT_EQ(c.lost, out.contacts_lost);
  EXPECT_EQ(c.gained, out.contacts_gained);
}

// The one who watches sees how far it is and can end it.
TEST(Quasistatic, StopsWhenToldTo) {
  const Snapshot rest = relax(block(8, 5, 0.5), area_law(0.3), {0, -kG, 0}, {}, {}).state;
  QuasistaticSettings q;
  q.first_steps = 4;
  std::vector<double> shares;
  q.go_on = [&](double share) {
    shares.push_back(share);
    return true;
  };
  relax(rest, area_law(0.3), {0, -0.5 * kG, 0}, {}, q);
  ASSERT_GE(shares.size(), 3U);
  EXPECT_EQ(shares.front(), 0);
  EXPECT_GT(shares.back(), 0.25);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  q.go_on = [](double share) { return share == 0; };
  EXPECT_THROW(relax(rest, area_law(0.3), {0, -0.5 * kG, 0}, {}, q), RelaxationStopped);
}

std::string refusal(const Snapshot& s, const EngineSettings& e, const AppliedForce& force,
                    const QuasistaticSettings& q) {
  try {
    relax(s, e, {0, -kG, 0}, force, q);
  } catch (const std::invalid_argument& error) {
    return error.what();
  } catch (const ComputationFailed& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Quasistatic, SaysHowFarItCame) {
  // Three times its weight upwards: beyond a third, nothing can hold the grain.
  const Snapshot rest = relax(put({disk(0, 0.01)}, {wall("floor", 0, 0, 0, 1, 0.5)}), area_law(0.5),
                              {0, -kG, 0}, {}, {})
                            .state;
  AppliedForce lift;
  lift.id = 0;
  lift.fy = 3 * rest.grains[0].mass * kG;
  const std::string text = refusal(rest, area_law(0.5), lift, {});
  EXPECT_THAT(text, testing::HasSubstr("came to 0.33"));
  EXPECT_THAT(text, testing::HasSubstr("unbalanced force ratio"));
  EXPECT_THAT(text, testing::HasSubstr("lower least_step (now 0.001)"));
}

TEST(Quasistatic, RefusesWhatDoesNotFit) {
  const Snapshot s = put({disk(0, 0.01)}, {wall("floor", 0, 0, 0, 1, 0.5)});
  QuasistaticSettings q;
  q.unbalanced_force_ratio = 0;
  EXPECT_THAT(refusal(s, area_law(0.5), {}, q),
              testing::HasSubstr("unbalanced_force_ratio: found 0, allowed: 1e-12 to 0.1"));
  q = {};
  q.first_steps = 0;
  EXPECT_THAT(refusal(s, area_law(0.5), {}, q), testing::HasSubstr("first_steps: found 0"));
  q = {};
  q.least_step = 2;
  EXPECT_THAT(refusal(s, area_law(0.5), {}, q), testing::HasSubstr("least_step: found 2"));
  q = {};
  q.max_iterations = 0;
  EXPECT_THAT(refusal(s, area_law(0.5), {}, q), testing::HasSubstr("max_iterations: found 0"));
  AppliedForce force;
  force.id = 7;
  EXPECT_THAT(refusal(s, area_law(0.5), force, {}), testing::HasSubstr("force on grain 7"));
  Snapshot bad = s;
  bad.dim = 3;
  EXPECT_THAT(refusal(bad, area_law(0.5), {}, {}),
              testing::HasSubstr("relaxation of spheres: linear"));
  bad = s;
  bad.cell.periodic[0] = true;
  EXPECT_THAT(refusal(bad, area_law(0.5), {}, {}), testing::HasSubstr("found a periodic cell"));
  bad = s;
  bad.grains[0].fixed = true;
  EXPECT_THAT(refusal(bad, area_law(0.5), {}, {}), testing::HasSubstr("no grain that is free"));
  bad = s;
  bad.grains[0].mass = 0;
  EXPECT_THAT(refusal(bad, area_law(0.5), {}, {}), testing::HasSubstr("grain 0"));
  bad = s;
  bad.contacts.emplace_back();
  bad.contacts.back().j = -3;
  EXPECT_THAT(refusal(bad, area_law(0.5), {}, {}), testing::HasSubstr("contact of 0 with -3"));
  bad = s;
  bad.walls[0].velocity = Vec3(0, 0.1, 0);
  EXPECT_THAT(refusal(bad, area_law(0.5), {}, {}),
              testing::HasSubstr("wall floor: found one that"));
  bad = s;
  bad.walls[0].material = "steel";
  EXPECT_THAT(refusal(bad, area_law(0.5), {}, {}),
              testing::HasSubstr("wall floor: found one that"));
  bad = s;
  bad.walls[0].shape = "cylinder";
  EXPECT_THAT(refusal(bad, area_law(0.5), {}, {}),
              testing::HasSubstr("wall floor: shape: found \"cylinder\", allowed: plane"));
  bad = s;
  bad.grains[0].rotates = false;
  EXPECT_THAT(refusal(bad, area_law(0.5), {}, {}), testing::HasSubstr("grain 0 does not turn"));
  EngineSettings rolls = area_law(0.5);
  rolls.rolling.friction = 0.1;
  EXPECT_THAT(refusal(s, rolls, {}, {}), testing::HasSubstr("choose method = \"damped\""));
}

}  // namespace
}  // namespace grainfield::dem
