// Cells that flow: affine motion, stress of lattices, work, shear through several turns.
#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <numbers>

#include "dem/space/moving_cell.h"
#include "tests/dem/cell_scene.h"

namespace grainfield::dem::cells {
namespace {

/// Grains apart from each other that move with the flow.
std::vector<NewGrain> floating(const Cell<3>& cell, int dim) {
  Random random(3);
  std::vector<NewGrain> grains;
  for (int k = 0; k < (dim == 2 ? 16 : 64); ++k) {
    const Vec3 share((k % 4 + 0.3) / 4, (k / 4 % 4 + 0.6) / 4, dim == 2 ? 0 : (k / 16 + 0.1) / 4);
    const Vec3 way = cell.edges * share, v = cell.velocity_gradient * way;
    NewGrain g;
    g.x = cell.low[0] + way[0], g.y = cell.low[1] + way[1], g.z = cell.low[2] + way[2];
    g.vx = v[0], g.vy = v[1], g.vz = v[2];
    g.radius = 0.01 * random.uniform(0.1, 1);
    g.density = 1000;
    grains.push_back(g);
  }
  return grains;
}

Vec3 place_of(const NewGrain& g) { return {g.x, g.y, g.z}; }

TEST(CellFlow, AffineMotionInSimpleShearIsExact) {
  for (const ShapeKind& shape : {ShapeKind::disk, ShapeKind::polygon, ShapeKind::sphere}) {
    const int dim = shape == ShapeKind::sphere ? 3 : 2;
    Matrix3d flow = simple_shear(2.5);
    if (dim == 3) flow(0, 2) = -1;
    for (const auto& how : {IntegratorKind::verlet, IntegratorKind::gear}) {
      if (dim == 3 && how == IntegratorKind::gear) continue;
      EngineSettings settings = settings_of(shape, cell_of(dim, {0.3, -0.2, 0}, square(1), flow));
      settings.time_step = 1e-3;
      settings.integrator = how;
      auto grains = floating(settings.cell, dim);
      for (std::size_t k = 0; k < grains.size(); k += 3) {  // images of themselves
        const Vec3 way(1, k % 2 == 0 ? 2 : -1, dim == 3 ? 1 : 0), drift = flow * way;
        grains[k].x += way[0], grains[k].y += way[1], grains[k].z += way[2];
        grains[k].vx += drift[0], grains[k].vy += drift[1], grains[k].vz += drift[2];
      }
      const auto engine = engine_with(settings, grains);
      engine->step(2000);  // a strain of 5: five turns
      const Snapshot s = engine->snapshot();
      EXPECT_LE(std::fabs(s.cell.edges(0, 1)), 0.5);
      for (const Grain& g : s.grains) {
        const Vec3 start = place_of(grains[g.id]) - settings.cell.low;
        const Vec3 exact = settings.cell.low + start + 2.0 * flow * start;
        EXPECT_LT((continuous(s, g) - exact).norm(), 1e-12);
        EXPECT_LT((g.velocity - flow * (g.position - s.cell.low)).norm(), 1e-12);
      }
      EXPECT_TRUE(s.contacts.empty());
      EXPECT_LT(engine->motion().kinetic_energy, 1e-24);
    }
  }
}

TEST(CellFlow, AffineMotionIsThatOfTheEdges) {
  for (const ShapeKind& shape : {ShapeKind::disk, ShapeKind::sphere}) {
    const int dim = shape == ShapeKind::sphere ? 3 : 2;
    Matrix3d flow = Matrix3d::Zero();
    flow << -0.6, 0.1, 0, 0.2, -0.3, 0, 0, 0, dim == 3 ? 0.5 : 0;
    EngineSettings settings = settings_of(shape, cell_of(dim, {0.3, -0.2, 0}, square(1), flow));
    settings.time_step = 1e-3;
    const auto grains = floating(settings.cell, dim);
    const auto engine = engine_with(settings, grains);
    engine->step(500);
    engine->set_velocity_gradient(0.5 * flow);
    engine->step(500);
    const Snapshot s = engine->snapshot();
    Matrix3d edges = s.cell.edges;
    if (dim == 2) edges(2, 2) = 1;
    for (const Grain& g : s.grains) {
      const Vec3 exact = s.cell.low + edges * (place_of(grains[g.id]) - s.cell.low);
      EXPECT_LT((continuous(s, g) - exact).norm(), 1e-13);
    }
    EXPECT_LT(engine->motion().kinetic_energy, 1e-15);
    // exp of the traces: -0.9 (and 0.5) for half a second, then half of it.
    const double trace = flow.trace();
    EXPECT_NEAR(cell_volume(s.cell, dim), std::exp(0.75 * trace), 1e-6);
  }
}

// With forces: where the faces are, and which image of a grain is given or carried, does not
// matter.
TEST(CellFlow, AnyPlaceIsTheSame) {
  for (const ShapeKind& shape : {ShapeKind::disk, ShapeKind::polygon, ShapeKind::sphere}) {
    const int dim = shape == ShapeKind::sphere ? 3 : 2;
    Matrix3d flow = Matrix3d::Zero();
    flow << -2, 20, 0, 5, 1, 0, 0, 0, 0;
    EngineSettings settings = settings_of(shape, cell_of(dim, {0, 0, 0}, square(1)));
    settings.time_step = 3e-5;
    const auto grains = block(shape, settings.cell, dim == 2 ? 10 : 5, 4);
    auto moved = grains;
    Random random(8);
    const auto number = [&] { return std::floor(random.uniform(-2, 3)); };
    for (NewGrain& g : moved) {
      g.x += number() + 0.37, g.y += number() - 0.46;
      if (dim == 3) g.z += number() + 0.22;
    }
    const auto one = engine_with(settings, grains), other = engine_with(settings, moved);
    for (const auto& engine : {one.get(), other.get()}) {
      engine->set_velocity_gradient(flow);
      engine->set_background_damping(3);
    }
    for (const int steps : {1, 300}) {
      one->step(steps);
      other->step(steps);
      const Snapshot a = one->snapshot(), b = other->snapshot();
      const double tolerance = steps == 1 ? 1e-12 : 1e-9;
      ASSERT_EQ(a.contacts.size(), b.contacts.size());
      const auto fluctuation = [&](const Snapshot& of, std::size_t k) {
        const Grain& g = of.grains[k];
        return Vec3(g.velocity - of.cell.velocity_gradient * (g.position - of.cell.low));
      };
      for (std::size_t k = 0; k < a.grains.size(); ++k) {
        // Up to the step's own error of the flow, L^2 dt relative to L.
        EXPECT_LT((fluctuation(a, k) - fluctuation(b, k)).norm(), 100 * tolerance + 1e-6) << k;
        EXPECT_LT(std::fabs(a.grains[k].spin - b.grains[k].spin), 1e4 * tolerance) << k;
      }
      double worst = 0;
      const double mean = one->measure().mean_contact_force;
      for (std::size_t k = 0; k < a.contacts.size(); ++k) {
        worst = std::max(worst, (a.contacts[k].force - b.contacts[k].force).norm());
      }
      EXPECT_LT(worst, 100 * tolerance * mean);
      EXPECT_NEAR(one->measure().cell_work, other->measure().cell_work,
                  1e4 * tolerance * std::fabs(one->measure().cell_work));
    }
  }
}

// The neighbour list is renewed in time: a list that holds all from the start says the same.
TEST(CellFlow, AWiderListFindsNoMore) {
  for (const ShapeKind& shape : {ShapeKind::disk, ShapeKind::polygon, ShapeKind::sphere}) {
    const int dim = shape == ShapeKind::sphere ? 3 : 2;
    Matrix3d flow = Matrix3d::Zero();
    flow << -4, 45, 0, -10, 4, 0, 0, 0, 0;
    EngineSettings settings = settings_of(shape, cell_of(dim, {0, 0, 0}, square(1), flow));
    settings.time_step = 4e-5;
    auto grains = block(shape, settings.cell, dim == 2 ? 10 : 5, 4, 1);
    for (NewGrain& g : grains) {
      const Vec3 v = flow * place_of(g);
      g.vx += v[0], g.vy += v[1], g.vz += v[2];
    }
    const auto narrow = engine_with(settings, grains);
    settings.skin = 0.1;
    const auto wide = engine_with(settings, grains);
    narrow->step(400);
    wide->step(400);
    const Snapshot a = narrow->snapshot(), b = wide->snapshot();
    ASSERT_EQ(a.contacts.size(), b.contacts.size());
    for (std::size_t k = 0; k < a.grains.size(); ++k) {
      EXPECT_LT((continuous(a, a.grains[k]) - continuous(b, b.grains[k])).norm(), 1e-9) << k;
    }
  }
}

/// A lattice of equal grains that touch, then compressed by about 1 %; its stress.
void expect_lattice_stress(const ShapeKind& shape, const Matrix3d& edges,
                           const std::vector<Vec3>& shares, double neighbours) {
  const int dim = shape == ShapeKind::sphere ? 3 : 2;
  Matrix3d flow = Matrix3d::Zero();
  for (int a = 0; a < dim; ++a) flow(a, a) = -10;
  EngineSettings settings = settings_of(shape, cell_of(dim, {5, -7, 0.3}, edges, flow));
  settings.time_step = 2e-5;
  const double k = 1e4;
  settings.law = LinearLaw{k, 0, 0, 0};
  std::vector<NewGrain> grains;
  for (const Vec3& share : shares) {
    const Vec3 way = edges * share, v = flow * way;
    NewGrain g;
    g.x = 5 + way[0], g.y = -7 + way[1], g.z = dim == 3 ? 0.3 + way[2] : 0;
    g.vx = v[0], g.vy = v[1], g.vz = v[2];
    g.radius = 0.5;
    g.density = 1000;
    grains.push_back(g);
  }
  const auto engine = engine_with(settings, grains);
  engine->step(50);
  const Snapshot s = engine->snapshot();
  const double share = s.cell.edges.col(0).norm() / edges.col(0).norm();
  EXPECT_NEAR(share, 0.99, 1e-4);
  EXPECT_EQ(static_cast<double>(s.contacts.size()),
            neighbours / 2 * static_cast<double>(grains.size()));
  // sum over contacts f (x) l of f = -k (1 - share) n, l = share n, unit diameter; sum n (x) n is
  // isotropic in all three lattices.
  const double volume = cell_volume(s.cell, dim);
  const double exact =
      -k * (1 - share) * share * neighbours / 2 * static_cast<double>(grains.size()) / dim / volume;
  const CellStress stress = cell_stress(s);
  Matrix3d expected = Matrix3d::Zero();
  for (int a = 0; a < dim; ++a) expected(a, a) = exact;
  EXPECT_LT((stress.contacts - expected).norm(), 1e-11 * std::fabs(exact));
  EXPECT_LT(stress.motion.norm(), 1e-11 * std::fabs(exact));
}

TEST(CellFlow, StressOfLatticesIsThatOfTheirBonds) {
  std::vector<Vec3> shares;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) shares.emplace_back(0.2 * i, 0.2 * j + 0.07, 0);
  }
  expect_lattice_stress(ShapeKind::disk, square(5), shares, 4);
  Matrix3d triangles = square(5);
  triangles.col(1) = Vec3(2.5, 2.5 * std::numbers::sqrt3, 0);
  expect_lattice_stress(ShapeKind::disk, triangles, shares, 6);
  // Face-centred cubic: rhombohedral edges between nearest neighbours.
  Matrix3d edges;
  edges << 0, 1, 1, 1, 0, 1, 1, 1, 0;
  shares.clear();
  for (int k = 0; k < 64; ++k) shares.emplace_back(k % 4 / 4.0, k / 4 % 4 / 4.0, k / 16 / 4.0);
  expect_lattice_stress(ShapeKind::sphere, 4 / std::numbers::sqrt2 * edges, shares, 12);
}

// Without friction and dashpots all that the flow puts in is there, as motion or in springs.
TEST(CellFlow, ItsWorkIsTheEnergyGained) {
  for (const ShapeKind& shape : {ShapeKind::disk, ShapeKind::sphere}) {
    const int dim = shape == ShapeKind::sphere ? 3 : 2;
    Matrix3d flow = Matrix3d::Zero();
    flow << -1.5, 6, 0, 0, -1.5, 0, 0, 0, 0;
    double before = 0;
    for (const double step : {2e-5, 1e-5}) {
      EngineSettings settings = settings_of(shape, cell_of(dim, {0, 0, 0}, square(1)));
      settings.law = LinearLaw{1e4, 0, 0, 0};
      settings.time_step = step;
      const auto engine = engine_with(settings, block(shape, settings.cell, dim == 2 ? 10 : 5, 6));
      engine->step(1);
      engine->set_velocity_gradient(flow);
      const auto energy = [&] {
        const Diagnostics d = engine->measure();
        return d.kinetic_energy + d.elastic_energy;
      };
      const double start = energy(), work = engine->measure().cell_work;
      engine->step(std::lround(0.1 / step));
      const double gained = energy() - start, done = engine->measure().cell_work - work;
      EXPECT_GT(gained, 0.5 * start);
      EXPECT_NEAR(gained, done, 2e-3 * gained) << step;
      const double error = std::fabs(gained - done);
      if (before > 0) {
        EXPECT_LT(error, 0.7 * before);
      }
      before = error;
      // The power is that of the stress.
      const Snapshot s = engine->snapshot();
      const double power = cell_volume(s.cell, dim) *
                           cell_stress(s).total().cwiseProduct(s.cell.velocity_gradient).sum();
      const CellStress own = engine->cell_stress(), told = cell_stress(s);
      EXPECT_LT((own.contacts - told.contacts).norm(), 1e-11 * told.contacts.norm());
      // Speeds against the flow are small differences of the speeds that a snapshot tells.
      EXPECT_LT((own.motion - told.motion).norm(), 1e-8 * told.motion.norm());
      const double last = engine->measure().cell_work;
      engine->step(1);
      EXPECT_NEAR((engine->measure().cell_work - last) / step, power, 2e-2 * std::fabs(power));
    }
  }
}

// Damping acts against the flow: what it takes is damped energy, none of it work of the flow.
TEST(CellFlow, ItsBooksCloseWithDamping) {
  for (const ShapeKind& shape : {ShapeKind::disk, ShapeKind::sphere}) {
    const int dim = shape == ShapeKind::sphere ? 3 : 2;
    for (const bool local : {false, true}) {
      double before = 0;
      for (const double step : {2e-5, 1e-5}) {
        EngineSettings settings = settings_of(shape, cell_of(dim, {0, 0, 0}, square(1)));
        settings.law = LinearLaw{1e4, 0, 0, 0};
        settings.time_step = step;
        settings.energy_balance = true;
        settings.local_damping = local ? 0.3 : 0;
        const auto engine =
            engine_with(settings, block(shape, settings.cell, dim == 2 ? 10 : 5, 6));
        engine->set_background_damping(local ? 0 : 20);
        engine->step(1);
        engine->set_velocity_gradient(simple_shear(20));
        const Diagnostics first = engine->measure();
        engine->step(std::lround(0.1 / step));
        const Diagnostics last = engine->measure();
        const double damped = last.damped_energy - first.damped_energy;
        EXPECT_GT(damped, 0.5 * first.kinetic_energy);
        EXPECT_GT(last.cell_work - first.cell_work, 0.1 * damped);
        const double error = std::fabs(last.energy_balance() - first.energy_balance());
        EXPECT_LT(error, 2e-3 * damped) << dim << local;
        if (before > 0) {
          EXPECT_LT(error, 0.7 * before) << dim << local;
        }
        before = error;
      }
    }
  }
}

// Gravity works on what moves with the flow, wherever a grain has been carried from.
TEST(CellFlow, ItsBooksCloseWithGravity) {
  for (const ShapeKind& shape : {ShapeKind::disk, ShapeKind::sphere}) {
    const int dim = shape == ShapeKind::sphere ? 3 : 2;
    const Matrix3d flow = simple_shear(2.5);
    EngineSettings settings = settings_of(shape, cell_of(dim, {0.3, -0.2, 0}, square(1), flow));
    settings.gravity_x = 3;
    settings.gravity_y = -1;
    settings.energy_balance = true;
    auto grains = floating(settings.cell, dim);
    for (NewGrain& g : grains) g.image = {0, 2, 0};  // two cells above
    const auto engine = engine_with(settings, grains);
    const Diagnostics first = engine->measure();
    engine->step(1000);
    const Diagnostics last = engine->measure();
    const double fallen = first.potential_energy - last.potential_energy;
    EXPECT_GT(fallen, 10 * last.kinetic_energy);
    EXPECT_NEAR(last.energy_balance(), first.energy_balance(), 2e-3 * fallen) << dim;
  }
}

class CellShear : public testing::TestWithParam<ShapeKind> {};

INSTANTIATE_TEST_SUITE_P(Shapes, CellShear,
                         testing::Values(ShapeKind::disk, ShapeKind::polygon, ShapeKind::sphere),
                         [](const auto& shape) { return std::string(shape.param.name()); });

// A dense block sheared by 2.2: the tilt turns over twice; contacts remember through it.
TEST_P(CellShear, TurnsOverAndContactsRemember) {
  const ShapeKind shape = GetParam();
  const int dim = shape == ShapeKind::sphere ? 3 : 2;
  const double rate = 10;
  EngineSettings settings = settings_of(shape, cell_of(dim, {0, 0, 0}, square(1)));
  settings.time_step = 4e-5;
  const auto engine = engine_with(settings, block(shape, settings.cell, dim == 2 ? 12 : 6, 5, 0.1));
  engine->set_velocity_gradient(simple_shear(rate));
  engine->step(1000);
  double ordinary = 0, at_turns = 0, springs = 0;
  int turns = 0, with_spring = 0;
  Snapshot before = engine->snapshot();
  const auto jump = [&](const Snapshot& now) {
    std::map<std::pair<std::int64_t, std::int64_t>, Contact> old;
    for (const Contact& c : before.contacts) old[{c.i, c.j}] = c;
    double most = 0;
    for (const Contact& c : now.contacts) {
      const auto at = old.find({c.i, c.j});
      if (at == old.end()) continue;
      const Contact& was = at->second;
      const double change = dim == 2 ? std::fabs(c.spring - was.spring)
                                     : (c.spring_vector - was.spring_vector).norm();
      most = std::max(most, change);
      springs += std::fabs(c.spring);
      ++with_spring;
    }
    return most;
  };
  while (turns < 2 && engine->steps() < 6000) {
    const double tilt = engine->cell().edges(0, 1);
    const bool close = tilt > 0.49;
    engine->step(close || engine->steps() % 500 == 0 ? 1 : 20);
    const Snapshot now = engine->snapshot();
    EXPECT_LT((engine->cell_stress().total() - cell_stress(now).total()).norm(),
              1e-11 * cell_stress(now).total().norm());
    const bool turned = now.cell.edges(0, 1) < tilt;
    turns += turned ? 1 : 0;
    if (close || turned) {
      (turned ? at_turns : ordinary) = std::max(turned ? at_turns : ordinary, jump(now));
      EXPECT_LT((cell_stress(now).contacts - cell_stress(before).contacts).norm(),
                0.3 * cell_stress(now).contacts.norm());
    }
    before = now;
  }
  EXPECT_EQ(turns, 2);
  EXPECT_GT(with_spring, 100);
  EXPECT_GT(ordinary, 0);
  // Slip changes springs a little in a step; forgotten ones would jump by all they are.
  EXPECT_LT(at_turns, 1.5 * ordinary);
  EXPECT_LT(ordinary, 0.3 * springs / with_spring) << ordinary << " " << springs / with_spring;
  const Diagnostics d = engine->measure();
  EXPECT_GT(d.contacts, 1.2 * engine->grains());
  // Friction and dashpots take what the flow puts in.
  EXPECT_GT(d.cell_work, 0);
  EXPECT_LT(d.kinetic_energy, d.cell_work);
}

TEST(CellFlow, StopsAndGoesOnWithoutAJumpOfFluctuations) {
  EngineSettings settings = settings_of(ShapeKind::disk, cell_of(2, {0, 0, 0}, square(1)));
  const auto engine = engine_with(settings, block(ShapeKind::disk, settings.cell, 8, 2));
  engine->step(10);
  const double still = engine->motion().kinetic_energy;
  engine->set_velocity_gradient(simple_shear(20));
  EXPECT_NEAR(engine->motion().kinetic_energy, still, 1e-12 * still);
  engine->step(100);
  const double flowing = engine->motion().kinetic_energy;
  engine->set_velocity_gradient(Matrix3d::Zero());
  EXPECT_NEAR(engine->motion().kinetic_energy, flowing, 1e-12 * flowing);
  const Cell<3> stopped = engine->cell();
  EXPECT_NEAR(stopped.edges(0, 1), 20 * 100 * settings.time_step, 1e-12);
  engine->step(100);
  EXPECT_EQ(engine->cell().edges(0, 1), stopped.edges(0, 1));
}

}  // namespace
}  // namespace grainfield::dem::cells
