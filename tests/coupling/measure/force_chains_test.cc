// Force chains in packings with known answers, and the command that writes them.
#include "coupling/structure/force_chains.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/averaging/grain_facts.h"
#include "coupling/structure/coordination_counts.h"
#include "coupling/structure/tensor_axes.h"
#include "tests/coupling/program.h"
#include "tests/coupling/structure_scene.h"

namespace grainfield::coupling {
namespace {

using test::columns;
using test::press;
using test::turned;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
constexpr double kDegree = std::numbers::pi / 180;

TEST(ForceChains, LoadedColumns) {
  const dem::Snapshot s = columns({1, 3, 1, 2.5, 1.2}, 6);
  const ForceChains found = force_chains(s);
  EXPECT_EQ(found.bearing, 30);
  EXPECT_EQ(found.stressed, 12);
  EXPECT_EQ(found.in_chains, 12);
  ASSERT_EQ(found.chains.size(), 2u);
  EXPECT_THAT(found.chains[0].grains, ElementsAre(6, 7, 8, 9, 10, 11));
  EXPECT_THAT(found.chains[1].grains, ElementsAre(18, 19, 20, 21, 22, 23));
  EXPECT_EQ(found.chains[0].contacts.size(), 5u);
  EXPECT_EQ(found.mean_length, 6);
  // Each grain: force times diameter over its area.
  EXPECT_NEAR(found.mean_load, (1 + 3 + 1 + 2.5 + 1.2) / 5 / (std::numbers::pi / 4), 1e-12);
  EXPECT_EQ(found.chain_of[20], 1);
  EXPECT_EQ(found.chain_of[0], -1);
  ChainOptions options;
  options.least_load = 0.5;
  EXPECT_EQ(force_chains(s, options).chains.size(), 5u);
  options.least_grains = 7;
  EXPECT_EQ(force_chains(s, options).chains.size(), 0u);
  EXPECT_TRUE(std::isnan(force_chains(s, options).mean_length));
  options.largest_turn_deg = 0;
  EXPECT_THAT(refusal_of([&] { force_chains(s, options); }),
              HasSubstr("found a largest turn of 0 degrees"));
  EXPECT_EQ(force_chains(dem::Snapshot()).chains.size(), 0u);
}

TEST(ForceChains, TurnALittleButNotARightAngle) {
  // A line of eight disks that turns by the same angle at each: the grains' axes turn along.
  const auto arc = [](double turn_deg) {
    dem::Snapshot s;
    dem::Vec3 at(0, 0, 0);
    for (int k = 0; k < 8; ++k) {
      s.grains.push_back(test::disk(k, at.x(), at.y(), 0.5));
      at += dem::Vec3(std::cos(k * turn_deg * kDegree), std::sin(k * turn_deg * kDegree), 0);
      if (k > 0) press(s, k - 1, k, 1);
    }
    s.grains.front().fixed = s.grains.back().fixed = true;  // or all would be rattlers
    // A little loaded line lowers the mean.
    for (int n = 0; n < 20; ++n) {
      s.grains.push_back(test::disk(100 + n, 100, n, 0.5));
      s.grains.back().fixed = n == 0 || n == 19;
      if (n > 0) press(s, n + 7, n + 8, 0.01);
    }
    return s;
  };
  const ForceChains gentle = force_chains(arc(20));
  ASSERT_EQ(gentle.chains.size(), 1u);
  EXPECT_EQ(gentle.chains[0].grains.size(), 6u);  // without the fixed ends
  ChainOptions straight;
  straight.largest_turn_deg = 5;
  EXPECT_EQ(force_chains(arc(20), straight).chains.size(), 0u);
  // Half of 100 degrees lies outside 45.
  EXPECT_EQ(force_chains(arc(100)).chains.size(), 0u);
}

TEST(ForceChains, PropertiesInRandomLayers) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const dem::Snapshot s = test::layer(seed, 12, 8);
    const ForceChains found = force_chains(s);
    const ForceChains again = force_chains(turned(s, 0.7 * seed));
    const std::vector<GrainFacts> facts = grain_facts(s);
    std::vector<int> times(s.grains.size(), 0);
    for (std::size_t c = 0; c < found.chains.size(); ++c) {
      const ForceChain& chain = found.chains[c];
      ASSERT_GE(chain.grains.size(), 3u);
      for (std::size_t k = 0; k < chain.contacts.size(); ++k) {
        const dem::Contact& contact = s.contacts[static_cast<std::size_t>(chain.contacts[k])];
        const std::int64_t a = chain.grains[k], b = chain.grains[(k + 1) % chain.grains.size()];
        ASSERT_EQ(std::min(a, b), contact.i);
        ASSERT_EQ(std::max(a, b), contact.j);
        for (const std::int64_t g : {a, b}) {
          const TensorAxes axes = tensor_axes(facts[static_cast<std::size_t>(g)].virial, 2);
          EXPECT_GT(std::abs(axes.axes.col(1).dot(contact.normal)), std::cos(45 * kDegree));
          EXPECT_GT(-axes.values[1] / s.grains[static_cast<std::size_t>(g)].volume,
                    found.mean_load);
        }
      }
      for (const std::int64_t g : chain.grains) {
        ++times[static_cast<std::size_t>(g)];
        EXPECT_EQ(found.chain_of[static_cast<std::size_t>(g)], static_cast<int>(c));
      }
    }
    EXPECT_LE(*std::max_element(times.begin(), times.end()), 1);
    EXPECT_EQ(std::count(times.begin(), times.end(), 1), found.in_chains);
    EXPECT_GT(found.in_chains, 0);
    EXPECT_LE(found.in_chains, found.stressed);
    ASSERT_EQ(again.chains.size(), found.chains.size());
    for (std::size_t c = 0; c < found.chains.size(); ++c)
      EXPECT_THAT(again.chains[c].grains,
                  ::testing::UnorderedElementsAreArray(found.chains[c].grains));
  }
}

TEST(ForceChains, NothingThatBearsIsNan) {
  dem::Snapshot s;
  s.grains.push_back(test::disk(0, 0, 0, 1));
  const CoordinationCounts counts = coordination_counts(s);
  const ForceChains chains = force_chains(s);
  for (const double undefined : {counts.mean_bearing, chains.mean_load, chains.mean_length}) {
    EXPECT_TRUE(std::isnan(undefined));
    EXPECT_FALSE(std::signbit(undefined));  // printed as "nan", not as "-nan"
  }
}

TEST(StructureCommand, PrintsAndWrites) {
  const testing::Folder folder;
  const std::string file = folder / "s.h5";
  dem::write_snapshot(file, "/a", columns({1, 3, 1, 2.5, 1.2}, 6));
  dem::write_snapshot(file, "/b", test::layer(2));
  const testing::Output one = testing::program("structure " + file + ":/a -o " + (folder / "out"));
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_THAT(one.out, HasSubstr("30 free grains, 0 rattlers"));
  EXPECT_THAT(one.out, HasSubstr("force chains: 2 of 6 grains, 12 of 30 bearing"));
  EXPECT_THAT(one.out, HasSubstr("base: 5 grains, mean vertical force 1.74 N"));
  EXPECT_THAT(testing::read_text(folder / "out/base_forces.csv"), HasSubstr("\n6,1,3,"));
  EXPECT_THAT(testing::read_text(folder / "out/coordination.csv"), HasSubstr("\n2,30,30\n"));
  EXPECT_THAT(testing::read_text(folder / "out/grains.csv"), HasSubstr("\n6,1,0,0,0,2,0,"));
  EXPECT_EQ(testing::program("structure " + file + " -o " + (folder / "both")).code, 0);
  EXPECT_TRUE(testing::fs::exists(folder / "both/snapshot_001/grains.csv"));
  const testing::Output taken = testing::program("structure " + file + " -o " + file);
  EXPECT_EQ(taken.code, 2);
  EXPECT_THAT(taken.err, HasSubstr("s.h5: cannot write there: "));
}

}  // namespace
}  // namespace grainfield::coupling
