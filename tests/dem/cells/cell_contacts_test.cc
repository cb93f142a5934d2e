// Contacts across the faces of a cell against all pairs with all images; the same scene moved, and
// without periodic axes among its own copies.
#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <set>
#include <tuple>

#include "tests/dem/cell_scene.h"

namespace grainfield::dem::cells {
namespace {

using Name = std::tuple<std::int64_t, std::int64_t, std::array<int, 3>>;

/// Every pair of round grains that overlaps by more than `margin`, with the image.
std::set<Name> overlapping(const Snapshot& s, double margin) {
  std::set<Name> found;
  const int most = 2, third = s.dim == 3 ? most : 0;
  for (const Grain& a : s.grains) {
    for (const Grain& b : s.grains) {
      if (b.id <= a.id) continue;
      for (int nx = -most; nx <= most; ++nx) {
        for (int ny = -most; ny <= most; ++ny) {
          for (int nz = -third; nz <= third; ++nz) {
            const std::array<int, 3> n{nx, ny, nz};
            const Vec3 way = b.position + shift_of(s.cell, n) - a.position;
            if (way.norm() < a.radius + b.radius - margin) found.insert({a.id, b.id, n});
          }
        }
      }
    }
  }
  return found;
}

std::set<Name> names_of(const Snapshot& s) {
  std::set<Name> found;
  for (const Contact& c : s.contacts) found.insert({c.i, c.j, c.image});
  return found;
}

/// Weak springs, so that the grains fly through each other; all contacts at several times. `stops`:
/// the flow rests every other time.
void expect_all_contacts(const ShapeKind& shape, double largest, double ratio,
                         const Matrix3d& gradient, std::uint64_t seed, std::size_t least_crossing,
                         bool stops = false) {
  const int dim = shape.visit([](auto kind) { return kind.dim; });
  Random random(seed);
  std::size_t crossing = 0, contacts = 0;
  for (int trial = 0; trial < 12; ++trial) {
    Matrix3d edges = Matrix3d::Zero();
    for (int a = 0; a < dim; ++a) {
      edges(a, a) = random.uniform(1.0, 1.6);
      for (int b = a + 1; b < dim; ++b) edges(a, b) = random.uniform(-2, 2);
    }
    const Vec3 low(random.uniform(-9, 9), random.uniform(-9, 9), 0);
    EngineSettings settings = settings_of(shape, cell_of(dim, low, edges, gradient));
    settings.law = LinearLaw{1e-9, 0, 0, 0};
    settings.friction = 0;
    settings.time_step = 2.5e-4;
    std::vector<NewGrain> grains;
    for (int k = 0; k < 60; ++k) {
      NewGrain g;
      g.radius = largest * (k < 2 ? 1 : std::pow(ratio, -random.uniform()));
      const Vec3 share(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
      const Vec3 x = low + edges * share, v = gradient * (x - low);
      g.x = x[0], g.y = x[1], g.z = x[2];
      g.vx = v[0] + random.uniform(-2, 2);
      g.vy = v[1] + random.uniform(-2, 2);
      g.vz = dim == 3 ? v[2] + random.uniform(-2, 2) : 0;
      g.density = 1000;
      grains.push_back(g);
    }
    const auto engine = engine_with(settings, grains);
    for (int part = 0; part < 12; ++part) {
      if (stops) engine->set_velocity_gradient(part % 2 == 0 ? Matrix3d::Zero() : gradient);
      engine->step(150);
      const Snapshot s = engine->snapshot();
      const std::set<Name> found = names_of(s);
      // Contacts that touch by round-off may be there or not.
      const std::set<Name> sure = overlapping(s, 1e-9), all = overlapping(s, -1e-9);
      for (const Name& name : sure) ASSERT_TRUE(found.contains(name)) << "trial " << trial;
      for (const Name& name : found) ASSERT_TRUE(all.contains(name)) << "trial " << trial;
      for (const Name& name : found) crossing += std::get<2>(name) != std::array<int, 3>{};
      contacts += found.size();
    }
  }
  EXPECT_GT(crossing, least_crossing) << contacts;
}

TEST(CellContacts, OfDisksAreAllThereAre) {
  expect_all_contacts(ShapeKind::disk, 0.2, 2, Matrix3d::Zero(), 1, 2000);
  expect_all_contacts(ShapeKind::disk, 0.2, 20, Matrix3d::Zero(), 2, 500);
}
TEST(CellContacts, OfDisksInAFlowAreAllThereAre) {
  Matrix3d other = Matrix3d::Zero();
  other << 0.2, 3, 0, -1, -0.2, 0, 0, 0, 0;
  expect_all_contacts(ShapeKind::disk, 0.2, 2, simple_shear(6), 3, 2000);
  expect_all_contacts(ShapeKind::disk, 0.1, 20, other, 4, 150);
}
TEST(CellContacts, OfDisksInAFlowThatStopsAndGoesOn) {
  expect_all_contacts(ShapeKind::disk, 0.2, 2, simple_shear(6), 7, 1500, true);
}
TEST(CellContacts, OfSpheresAreAllThereAre) {
  Matrix3d flow = simple_shear(5);
  flow(1, 2) = 2;
  expect_all_contacts(ShapeKind::sphere, 0.2, 2, Matrix3d::Zero(), 5, 1000);
  expect_all_contacts(ShapeKind::sphere, 0.2, 20, flow, 6, 100);
}

struct Block {
  std::string name;
  ShapeKind shape;
  int n;
};
void PrintTo(const Block& block, std::ostream* out) { *out << block.name; }

class CellBlock : public testing::TestWithParam<Block> {
 protected:
  int dim() const {
    return GetParam().shape.visit([](auto kind) { return kind.dim; });
  }
  Matrix3d slanting() const {
    Matrix3d edges = square(1);
    edges(0, 1) = 0.2;
    if (dim() == 3) edges(1, 2) = -0.15;
    return edges;
  }
};

INSTANTIATE_TEST_SUITE_P(Shapes, CellBlock,
                         testing::Values(Block{"Disks", ShapeKind::disk, 12},
                                         Block{"Polygons", ShapeKind::polygon, 10},
                                         Block{"Spheres", ShapeKind::sphere, 6}),
                         [](const auto& made) { return made.param.name; });

// What forces say does not depend on where the faces are.
TEST_P(CellBlock, MovedAnywhereIsTheSame) {
  const ShapeKind shape = GetParam().shape;
  EngineSettings settings = settings_of(shape, cell_of(dim(), {0, 0, 0}, slanting()));
  settings.time_step = 2e-5;
  const std::vector<NewGrain> grains = block(shape, settings.cell, GetParam().n, 7);
  std::vector<NewGrain> moved = grains;
  for (NewGrain& g : moved) {
    g.x += 0.3712;
    g.y -= 2.2345;
    if (dim() == 3) g.z += 0.77;
  }
  const auto one = engine_with(settings, grains), other = engine_with(settings, moved);
  for (const int steps : {1, 40}) {
    one->step(steps);
    other->step(steps);
    const Snapshot a = one->snapshot(), b = other->snapshot();
    const double mean = one->measure().mean_contact_force;
    ASSERT_GT(a.contacts.size(), 0.9 * static_cast<double>(a.grains.size()));
    ASSERT_EQ(a.contacts.size(), b.contacts.size());
    int differ = 0;
    for (std::size_t k = 0; k < a.contacts.size(); ++k) {
      ASSERT_EQ(a.contacts[k].i, b.contacts[k].i);
      ASSERT_EQ(a.contacts[k].j, b.contacts[k].j);
      EXPECT_LT((a.contacts[k].force - b.contacts[k].force).norm(),
                (steps == 1 ? 1e-12 : 1e-10) * mean);
      differ += a.contacts[k].image != b.contacts[k].image ? 1 : 0;
      // The point lies between the first grain and the image of the second.
      const Contact& c = b.contacts[k];
      const Grain &i = b.grains[c.i], &j = b.grains[c.j];
      EXPECT_LE((c.point - i.position).norm(), i.radius * (1 + 1e-9));
      EXPECT_LE((c.point - j.position - shift_of(b.cell, c.image)).norm(), j.radius * (1 + 1e-9));
    }
    EXPECT_GT(differ, 10);
  }
}

// In the middle of 3^D copies of itself without periodic axes nothing tells the difference.
TEST_P(CellBlock, IsItselfAmongItsCopies) {
  const ShapeKind shape = GetParam().shape;
  EngineSettings settings = settings_of(shape, cell_of(dim(), {0, 0, 0}, slanting()));
  const std::vector<NewGrain> grains = block(shape, settings.cell, GetParam().n, 8);
  const auto periodic = engine_with(settings, grains);
  const Cell<3> cell = settings.cell;
  settings.cell = {};
  const auto copies = engine_with(settings, grains);  // ids of the middle ones come first
  const int third = dim() == 3 ? 1 : 0;
  for (int nx = -1; nx <= 1; ++nx) {
    for (int ny = -1; ny <= 1; ++ny) {
      for (int nz = -third; nz <= third; ++nz) {
        if (nx == 0 && ny == 0 && nz == 0) continue;
        const Vec3 way = shift_of(cell, {nx, ny, nz});
        for (NewGrain g : grains) {
          g.x += way[0], g.y += way[1], g.z += way[2];
          copies->add(g);
        }
      }
    }
  }
  periodic->step(1);
  copies->step(1);
  const Snapshot a = periodic->snapshot(), b = copies->snapshot();
  const double mean = periodic->measure().mean_contact_force;
  const std::vector<Vec3> force_a = resultants(a), force_b = resultants(b);
  for (std::size_t k = 0; k < grains.size(); ++k) {
    EXPECT_LT((force_a[k] - force_b[k]).norm(), 1e-12 * mean) << k;
    EXPECT_LT((a.grains[k].velocity - b.grains[k].velocity).norm(), 1e-13);
    EXPECT_LT(std::fabs(a.grains[k].spin - b.grains[k].spin), 1e-11);
  }
}

TEST_P(CellBlock, KeepsItsMomentum) {
  const ShapeKind shape = GetParam().shape;
  for (const auto& how : {IntegratorKind::verlet, IntegratorKind::gear}) {
    if (dim() == 3 && how == IntegratorKind::gear) continue;
    EngineSettings settings = settings_of(shape, cell_of(dim(), {-1, 2, 3}, slanting()));
    settings.integrator = how;
    const auto engine = engine_with(settings, block(shape, settings.cell, GetParam().n, 9, 2));
    engine->step(1);
    const auto momentum = [&](double& size) {
      Vec3 sum = Vec3::Zero();
      size = 0;
      const Snapshot s = engine->snapshot();
      for (const Grain& g : s.grains) {
        sum += g.mass * g.velocity;
        size += g.mass * g.velocity.norm();
      }
      return sum;
    };
    double size = 0, size_now = 0;
    const Vec3 start = momentum(size);
    const Snapshot first = engine->snapshot();
    engine->step(4000);
    EXPECT_LT((momentum(size_now) - start).norm(), 1e-13 * size);
    // They have moved through the faces, and lost energy against each other.
    const Snapshot s = engine->snapshot();
    int carried = 0;
    for (const Grain& g : s.grains) {
      carried += g.image != std::array<int, 3>{} ? 1 : 0;
      const Eigen::VectorXd share = s.cell.edges.topLeftCorner(dim(), dim()).inverse() *
                                    (g.position - s.cell.low).head(dim());
      EXPECT_GE(share.minCoeff(), -1e-12);
      EXPECT_LE(share.maxCoeff(), 1 + 1e-12);
    }
    EXPECT_GT(carried, 5);
    EXPECT_LT(size_now, 0.7 * size);
  }
}

}  // namespace
}  // namespace grainfield::dem::cells
