// Ten thousand spheres from LAMMPS: the first step, and the stress 10,000 steps later among LAMMPS'
// own runs from places shaken by 1e-8 m, a hundredth of a usual depth. By hand: ctest --preset
// long.
//
// Is ours one more of the shaken runs? Of n numbers from one normal distribution with mean m and
// standard deviation s, the next lies within t s sqrt(1 + 1/n) of m, t Student's of n - 1 degrees
// of freedom. (The largest deviation of n runs is no bound: one more run passes it once in n + 1.)
#include <gmock/gmock.h>

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstdio>
#include <vector>

#include "tests/coupling/lammps_scene.h"

namespace grainfield::coupling::lammps {
namespace {

constexpr int kShaken = 12;
// A run of theirs would be refused with this probability, for each law and component.
constexpr double kAlarm = 0.01;

/// `beyond`: a difference that is known to be there, of the stress; 0: ours is one of theirs.
void compare(const char* name, const Law& law, double beyond = 0) {
  const Scene scene(law, 0.226, 25);
  std::vector<long long> ids;
  const End first = scene.go_on(1e-12, 1);
  const dem::Snapshot start = scene.start(ids);
  double largest = 0, worst = 0;
  for (const dem::Contact& c : start.contacts) largest = std::max(largest, c.force.norm());
  auto engine = scene.engine(start, 1e-12);
  engine->step(1);
  const std::vector<Vec3> forces = forces_of(engine->snapshot());
  for (std::size_t g = 0; g < ids.size(); ++g)
    worst = std::max(worst, (forces[g] - first.loads.at(ids[g]).first).norm());
  std::printf(
      "%s: %zu spheres, %zu contacts; first step: largest difference %.2g of the largest "
      "force\n",
      name, ids.size(), start.contacts.size(), worst / largest);
  EXPECT_GT(ids.size(), 9500U);
  EXPECT_LT(worst / largest, 1e-10);

  const End theirs = scene.go_on(1e-5, 10000);
  engine = scene.engine(start, 1e-5);
  engine->step(10000);
  const Vec3 ours = stress_of(engine->snapshot());
  std::vector<Vec3> shaken;
  Vec3 mean(0, 0, 0), squares(0, 0, 0), widest(0, 0, 0);
  for (int seed = 1; seed <= kShaken; ++seed) {
    shaken.push_back(scene.go_on(1e-5, 10000, 1e-8, seed).stress);
    mean += shaken.back() / kShaken;
    widest = widest.cwiseMax((shaken.back() - theirs.stress).cwiseAbs());
  }
  for (const Vec3& s : shaken) squares += (s - mean).cwiseAbs2();
  const double t = quantile(boost::math::students_t(kShaken - 1), 1 - 0.5 * kAlarm);
  for (int a = 0; a < 3; ++a) {
    const double off = std::abs(ours[a] - mean[a]);
    const double deviation = std::sqrt(squares[a] / (kShaken - 1) * (1 + 1.0 / kShaken));
    std::printf(
        "  after 10,000 steps, stress %c%c: theirs %.9g N m; ours less theirs %.3g, the widest of "
        "%d "
        "shaken runs %.3g; ours less their mean %.3g = %.2f standard deviations of one more run "
        "(allowed %.2f)\n",
        "xyz"[a], "xyz"[a], theirs.stress[a], std::abs(ours[a] - theirs.stress[a]), kShaken,
        widest[a], off, off / deviation, t);
    EXPECT_LE(off, beyond > 0 ? beyond * std::abs(theirs.stress[a]) : t * deviation);
  }
}

TEST(LammpsTenThousand, HertzHistory) {
  if (!is_there()) GTEST_SKIP() << "lmp not found: the Debian package lammps has it";
  compare("gran/hertz/history", hertz_history());
}
// The law of gran/hertz/history in the style whose levers between spheres are radii less half the
// depth, as ours, with rolling. It differs by 1.2e-5 of the stress, up to 4.5 standard deviations
// of theirs: at walls its levers are whole radii, ours end at the plane
// (LammpsLaws.WallsWithFrictionMakeTheDifference).
TEST(LammpsTenThousand, GranularMindlin) {
  if (!is_there()) GTEST_SKIP() << "lmp not found: the Debian package lammps has it";
  compare("granular, mindlin, rolling sds", granular("mindlin"), 3e-5);
}
TEST(LammpsTenThousand, GranularWithRolling) {
  if (!is_there()) GTEST_SKIP() << "lmp not found: the Debian package lammps has it";
  compare("granular, mindlin_rescale/force, rolling sds", granular("mindlin_rescale/force"));
}

}  // namespace
}  // namespace grainfield::coupling::lammps
