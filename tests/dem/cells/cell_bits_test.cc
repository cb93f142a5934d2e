// Cells, at rest and flowing: the same bits on any number of threads and after a restart; sleeping.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "dem/laws/hertz.h"
#include "dem/space/moving_cell.h"
#include "tests/dem/bits_scene.h"
#include "tests/dem/cell_scene.h"
#include "tests/dem/damaged_checkpoint.h"

namespace grainfield::dem::cells {
namespace {

using bits::Hash;

/// With the cell and the images, which hash_of leaves out.
std::uint64_t hash_of(const Snapshot& s, const Engine& engine) {
  Hash h;
  h.add(bits::hash_of(s));
  for (int a = 0; a < 3; ++a) h.add(Vec3(s.cell.edges.col(a)));
  for (const Grain& g : s.grains) h.add(Vec3(g.image[0], g.image[1], g.image[2]));
  for (const Contact& contact : s.contacts)
    h.add(Vec3(contact.image[0], contact.image[1], contact.image[2]));
  h.add(engine.measure().cell_work);
  return h.value();
}

struct Case {
  EngineSettings settings;
  std::vector<Wall> walls;
  std::vector<NewGrain> grains;
  Matrix3d later = Matrix3d::Zero();  // the flow of the second half
  long half = 900;
};

// The hash of the end. `after`: threads of the engine that goes on from a checkpoint; 0: the same
// one goes on.
std::uint64_t end_of(const Case& c, int threads, int after = 0, bool one_by_one = false) {
  EngineSettings settings = c.settings;
  settings.threads = threads;
  const auto empty = [&] {
    auto engine = make_engine(settings);
    for (const Wall& wall : c.walls) engine->add_wall(wall);
    return engine;
  };
  auto engine = empty();
  for (const NewGrain& g : c.grains) engine->add(g);
  const auto on = [&](long steps) {
    for (long s = 0; s < steps && one_by_one; ++s) engine->step(1);
    if (!one_by_one) engine->step(steps);
  };
  on(c.half);
  engine->set_velocity_gradient(c.later);
  on(c.half / 3);
  if (after > 0) {
    const std::string checkpoint = engine->checkpoint();
    settings.threads = after;
    engine = empty();
    engine->restore(checkpoint);
  }
  on(c.half - c.half / 3);
  return hash_of(engine->snapshot(), *engine);
}

void expect_same_bits(const Case& c) {
  const std::uint64_t one = end_of(c, 1);
  EXPECT_EQ(end_of(c, 3, 8), one) << "restarted on other threads";
  EXPECT_EQ(end_of(c, 1, 3, true), one) << "one by one, restarted";
}

class CellBits : public testing::TestWithParam<ShapeKind> {
 protected:
  int dim() const {
    return GetParam().visit([](auto kind) { return kind.dim; });
  }
  Case made(const Matrix3d& first) const {
    Case r;
    Matrix3d edges = square(1);
    edges(0, 1) = 0.1;
    r.settings = settings_of(GetParam(), cell_of(dim(), {-0.2, 0.7, 0}, edges, first));
    r.grains = block(GetParam(), r.settings.cell, dim() == 2 ? 12 : 6, 21, 1);
    return r;
  }
};

INSTANTIATE_TEST_SUITE_P(Shapes, CellBits,
                         testing::Values(ShapeKind::disk, ShapeKind::polygon, ShapeKind::sphere),
                         [](const auto& shape) { return std::string(shape.param.name()); });

TEST_P(CellBits, AtRest) { expect_same_bits(made(Matrix3d::Zero())); }

TEST_P(CellBits, InAFlow) {
  Case r = made(simple_shear(8));
  r.later = simple_shear(-3);
  r.later(1, 1) = -0.5;
  expect_same_bits(r);
  r.settings.friction = 0.2;
  EXPECT_NE(end_of(r, 1), end_of(made(simple_shear(8)), 1));
}

TEST(CellBitsOf, Gear) {
  Case r;
  r.settings = settings_of(ShapeKind::disk, cell_of(2, {0, 0, 0}, square(1), simple_shear(8)));
  r.settings.integrator = IntegratorKind::gear;
  r.settings.time_step = 1e-4;
  r.grains = block(ShapeKind::disk, r.settings.cell, 10, 3, 1);
  r.later = simple_shear(2);
  expect_same_bits(r);
}

/// A grain among small ones in a cell that shrinks to little more than kLeastCell of its radius.
std::unique_ptr<Engine> narrow_cell(const ShapeKind& shape, bool with_grains) {
  const int dim = shape == ShapeKind::sphere ? 3 : 2;
  Matrix3d flow = Matrix3d::Zero();
  for (int a = 0; a < dim; ++a) flow(a, a) = -5;
  auto engine = make_engine(settings_of(shape, cell_of(dim, {0, 0, 0}, square(1.03125), flow)));
  Random random(7);
  for (int k = 0; with_grains && k < (dim == 2 ? 40 : 80); ++k) {
    const auto place = [&] { return random.uniform(0, 1.03125); };
    const auto speed = [&](double x) { return random.uniform(-4, 4) - 5 * x; };
    NewGrain g;
    g.x = place(), g.y = place(), g.z = dim == 2 ? 0 : place();
    g.vx = speed(g.x), g.vy = speed(g.y), g.vz = dim == 2 ? 0 : speed(g.z);
    g.radius = k == 0 ? 1.03125 / (1.045 * kLeastCell) : random.uniform(0.05, 0.09);
    g.density = 1000;
    engine->add(g);
  }
  return engine;
}

// The way across the cell is that of the last search, also after a restart: when to search, and
// which image is the nearest one, go by it.
TEST(CellBitsOf, ARestartInANarrowCell) {
  for (const ShapeKind& shape : {ShapeKind::disk, ShapeKind::sphere}) {
    constexpr long kEnd = 40;
    const auto whole = narrow_cell(shape, true);
    whole->step(kEnd);
    EXPECT_LT(whole->cell().edges(0, 0), 1.007 * kLeastCell * whole->snapshot().grains[0].radius);
    const std::uint64_t end = hash_of(whole->snapshot(), *whole);
    for (long cut = 1; cut < kEnd; cut += 3) {
      const auto first = narrow_cell(shape, true), then = narrow_cell(shape, false);
      first->step(cut);
      then->restore(first->checkpoint());
      EXPECT_TRUE(then->checkpoint() == first->checkpoint()) << cut;
      then->step(kEnd - cut);
      EXPECT_EQ(hash_of(then->snapshot(), *then), end) << cut;
    }
  }
}

TEST(CellBitsOf, ACheckpointWithoutAWayAcrossTheCellIsRefused) {
  const auto engine = narrow_cell(ShapeKind::disk, true);
  engine->step(1);
  const std::string checkpoint = engine->checkpoint();
  // The last number with the bits of the first edge: edges, then the way across.
  const double across = engine->cell().edges(0, 0);
  const std::size_t at = checkpoint.rfind(bytes_of(1.03125));
  ASSERT_NE(at, std::string::npos);
  ASSERT_NE(across, 1.03125);  // the edges have moved on since the search
  const auto refusal = [&](double value) {
    return refusal_with(*narrow_cell(ShapeKind::disk, false), checkpoint, at, value);
  };
  EXPECT_EQ(refusal(1.03125), "accepted");
  for (const double value : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(refusal(value), kBrokenCheckpoint) << value;
  }
}

// Layers on a floor with periodic sides: they come to rest, sleep across the faces, and are woken
// there by a grain that falls.
Case layers(const ShapeKind& shape) {
  Case r;
  Cell<3> cell;
  cell.periodic = {true, false, shape == ShapeKind::sphere};
  cell.edges.col(0) = Vec3(1, 0, 0);
  if (shape == ShapeKind::sphere) cell.edges.col(2) = Vec3(0.1, 0, 0.8);
  r.settings = settings_of(shape, cell);
  r.settings.law = LinearLaw{2e5, 6e4, 300, 150};
  r.settings.time_step = 5e-5;
  r.settings.gravity_y = -9.81;
  r.settings.sleep.on = true;
  r.settings.sleep.quiet_creep = 1;
  r.settings.sleep.quiet_force = 0.2;
  r.settings.sleep.wake_force = 0.3;
  r.walls = {{"floor", {0, 0, 0}, {0, 1, 0}, 0.5}};
  Random random(4);
  const int depth = shape == ShapeKind::sphere ? 6 : 1;
  for (int k = 0; k < 24 * depth; ++k) {
    NewGrain g;
    g.x = (k % 8 + random.uniform(0.3, 0.7)) / 8.0;
    g.y = (k / 8 % 3 + 0.6) / 7.0;
    g.z = (k / 24 + 0.5) * 0.8 / depth;
    g.radius = random.uniform(0.045, 0.06);
    g.density = 1000;
    r.grains.push_back(g);
  }
  r.half = 36000;
  return r;
}

TEST(CellSleep, AcrossTheFaces) {
  for (const ShapeKind& shape : {ShapeKind::disk, ShapeKind::sphere}) {
    const Case r = layers(shape);
    const auto engine = make_engine(r.settings);
    for (const Wall& wall : r.walls) engine->add_wall(wall);
    for (const NewGrain& g : r.grains) engine->add(g);
    engine->step(r.half);
    EXPECT_LT(engine->measure().awake, 0.2 * engine->grains());
    const Snapshot s = engine->snapshot();
    int crossing = 0;
    double floor = 0, weight = 0;
    for (const Contact& c : s.contacts) {
      if (c.j >= 0 && c.image != std::array<int, 3>{}) ++crossing;
      if (c.j < 0) floor += c.force.y();
    }
    for (const Grain& g : s.grains) weight += g.mass * 9.81;
    EXPECT_GT(crossing, 1);
    EXPECT_NEAR(floor, weight, 0.05 * weight);
    // Onto the face x = 0.
    NewGrain g;
    g.x = 1.999;
    g.y = 0.55;
    g.z = 0.4;
    g.vy = -2;
    g.radius = 0.06;
    g.density = 1000;
    engine->add(g);
    int most = 0;
    for (int k = 0; k < 60; ++k) {
      engine->step(100);
      most = std::max(most, engine->motion().awake);
    }
    EXPECT_GT(most, 4);
    engine->step(r.half);
    EXPECT_LT(engine->measure().awake, 0.2 * engine->grains());
  }
}

TEST(CellSleep, HasTheSameBits) {
  Case r = layers(ShapeKind::disk);
  r.half = 9000;
  const std::uint64_t one = end_of(r, 1);
  EXPECT_EQ(end_of(r, 3, 1), one);
}

}  // namespace
}  // namespace grainfield::dem::cells
