// Pairs of polygons side by side (shapes/crossing_lanes.h, laws/area_lanes.h): overlaps and forces
// have the bits of those of one pair, at every width.
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "dem/contacts/contact_list.h"
#include "dem/engine/interaction.h"
#include "dem/laws/overlap_area.h"
#include "dem/random/random.h"
#include "dem/shapes/polygon_store.h"
#include "tests/dem/at_lane_width.h"
#include "tests/dem/polygon_engine_scene.h"

namespace grainfield::dem {
namespace {

using Acting = Interaction<PolygonStore, OverlapAreaLaw>;
using Pair = NearPair<SpringMemory<2>, PairFeature>;

/// kBatch pairs about where they touch, of which each remembers what it was a little before, or
/// any number.
struct Pairs {
  PolygonStore shapes;
  std::vector<Body<2>> bodies{2 * kBatch};
  std::vector<Pair> pairs{kBatch};
  std::vector<int> first = std::vector<int>(kBatch + kPairsBehind), second = first, order = first;
  RowBatch batch;

  Pairs(Random& random, int least, int most) {
    const auto any = [&](double limit) { return random.uniform(-limit, limit); };
    for (int k = 0; k < 2 * kBatch; ++k) {
      const int corners = least + static_cast<int>(random.uniform() * (most - least + 1));
      const double radius = random.uniform(0.7, 1.3);
      Outline outline;
      if (k % 32 != 7) outline = scattered_polygon(random, radius, corners);
      bodies[k].radius = outline.empty() ? radius : circumradius_of(outline);
      shapes.add({radius, outline});
      bodies[k].velocity = {any(0.1), any(0.1)};
      bodies[k].spin = any(0.1);
      bodies[k].inverse_mass = k % 9 == 2 ? 0 : random.uniform(0.5, 2);
      bodies[k].inverse_inertia = 2 * bodies[k].inverse_mass;
    }
    batch.first = first.data();
    batch.second = second.data();
    batch.pair = order.data();
    for (int k = 0; k < kBatch; ++k) {
      const int i = k, j = kBatch + k;
      pairs[k] = {{any(k % 2 == 0 ? 1e5 : 10)}, j, {}};
      first[k] = i;
      second[k] = j;
      order[k] = k;
      ++batch.count;
      const double place = any(3), angle_i = any(3), angle_j = any(3);
      const auto put = [&](double distance, double turned) {
        bodies[i].position = {0.1, 0.2};
        bodies[j].position = {0.1 + distance * std::cos(place), 0.2 + distance * std::sin(place)};
        shapes.place(i, bodies[i], angle_i);
        shapes.place(j, bodies[j], angle_j + turned);
      };
      double touching = 0, apart = 3;
      for (int n = 0; n < 40; ++n) {
        const double middle = (touching + apart) / 2;
        put(middle, 0);
        (touches(i, j) ? touching : apart) = middle;
      }
      const double distance = apart + any(k % 4 == 0 ? 0.3 : 0.03);
      put(distance, 0);
      touches(i, j, &pairs[k].feature);
      if (k % 16 == 5) pairs[k].feature.hint = static_cast<std::int32_t>(random.bits());
      put(distance + any(0.01), any(0.01));
    }
  }

  bool touches(int i, int j, PairFeature* feature = nullptr, Overlap* o = nullptr) const {
    PairFeature none;
    Overlap any;
    return shapes.overlap<Measures::area>(
        i, bodies[i], j, bodies[j], feature != nullptr ? *feature : none, o != nullptr ? *o : any);
  }
  CrossingRows rows() const {
    CrossingRows rows = shapes.crossing_rows();
    rows.bodies = bodies.data()->position.data();
    rows.pairs = reinterpret_cast<const unsigned char*>(pairs.data());
    return rows;
  }
};

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

class PolygonPairLanes : public AtLaneWidth {};

TEST_P(PolygonPairLanes, OverlapAndForceAreThoseOfOnePair) {
  Rules<OverlapAreaLaw>::Rule rule;
  rule.law = OverlapAreaLaw{1e6, 0.75};
  rule.friction = 0.5;
  const double dt = 1e-3;
  Random random(7);
  int apart = 0, touching = 0, left = 0, sliding = 0;
  // Blocks of any length, of 8 numbers, of up to 12 with nobody of more than 8 corners, and others.
  const int least[] = {8, 3, 6, 3}, most[] = {40, 7, 8, 12};
  for (int n = 0; n < 152; ++n) {
    const Pairs scene(random, least[n % 4], most[n % 4]);
    PlaneOverlapBatch overlaps;
    crossing_overlaps(scene.rows(), scene.batch, overlaps);
    PlaneOverlapBatch two;  // no width leaves more than another
    crossing_overlaps_of<2>(scene.rows(), scene.batch, two);
    PlaneForceBatch forces;
    for (int k = 0; k < overlaps.count; ++k) {
      const int slot = overlaps.slot[k];
      forces.body_i[k] = scene.bodies[slot].position.data();
      forces.body_j[k] = scene.bodies[kBatch + slot].position.data();
      forces.spring[k] = scene.pairs[slot].memory.spring;
    }
    area_forces(rule.law.area_numbers(rule.friction, dt), overlaps, forces);
    for (int slot = 0; slot < kBatch; ++slot) {
      ASSERT_EQ(overlaps.state[slot], two.state[slot]) << n << " " << slot;
      PairFeature feature = scene.pairs[slot].feature;
      Overlap o;
      const int j = kBatch + slot;
      const bool touches = scene.touches(slot, j, &feature, &o);
      if (overlaps.state[slot] == PairFate::left) {
        ++left;
        continue;
      }
      // Nothing else is remembered than before.
      ASSERT_EQ(feature.hint, scene.pairs[slot].feature.hint) << n << " " << slot;
      ASSERT_EQ(overlaps.state[slot] == PairFate::touches, touches) << n << " " << slot;
      ++(touches ? touching : apart);
      if (!touches) continue;
      const int k = overlaps.place[slot];
      ASSERT_EQ(overlaps.slot[k], slot);
      const double one[] = {o.nx,    o.ny,      o.area,    o.chord,   o.length, o.arm_i,
                            o.arm_j, o.lever_i, o.lever_j, o.shift_i, o.shift_j};
      const double* many[] = {overlaps.nx,      overlaps.ny,      overlaps.area,   overlaps.chord,
                              overlaps.length,  overlaps.arm_i,   overlaps.arm_j,  overlaps.lever_i,
                              overlaps.lever_j, overlaps.shift_i, overlaps.shift_j};
      for (int m = 0; m < 11; ++m) {
        ASSERT_TRUE(same_bits(one[m], many[m][k])) << n << " " << slot << " number " << m;
      }
      SpringMemory<2> memory = scene.pairs[slot].memory;
      const ContactForce<2> f =
          Acting::force(rule, scene.bodies[slot], scene.bodies[j], o, dt, memory);
      const double force[] = {f.force.x(), f.force.y(), f.torque_i, f.torque_j};
      for (int m = 0; m < 4; ++m) {
        ASSERT_TRUE(same_bits(force[m], forces.force[k][m])) << n << " " << slot << " force " << m;
      }
      ASSERT_TRUE(same_bits(memory.spring, forces.spring[k])) << n << " " << slot;
      sliding += std::fabs(tangential_of(f.force, o)) >= 0.499 * repulsion_of(f.force, o);
    }
  }
  EXPECT_GT(touching, 1000);
  EXPECT_GT(apart, 1500);
  EXPECT_LT(left, 1500);
  EXPECT_GT(sliding, 400);
  EXPECT_LT(sliding, touching - 400);
}

INSTANTIATE_TEST_SUITE_P(Widths, PolygonPairLanes, testing::Values(2, 4, 8));

}  // namespace
}  // namespace grainfield::dem
