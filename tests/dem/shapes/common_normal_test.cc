// The contact of two superellipsoids: against a global search, against the contact condition of
// ellipsoids, along paths, and of faces and edges that lie on each other.
#include "dem/shapes/common_normal.h"

#include <gmock/gmock.h>

#include "tests/dem/superellipsoid_scene.h"

namespace grainfield::dem {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Body {
  Superellipsoid shape;
  Matrix3d turn = Matrix3d::Identity();

  TurnedBody turned() const { return {shape, turn, farthest_of(shape), nearest_of(shape)}; }
};
Body random_body(Random& random, double least, double most) {
  const Superellipsoid shape = random_superellipsoid(random, least, most);
  return {shape, random_rotation(random).toRotationMatrix()};
}
Body box(double e, double x = 1, double y = 1, double z = 1) {
  return {superellipsoid({x, y, z}, {e, e})};
}

struct Found {
  bool touches = false;
  CommonNormal at;
};
Found contact(const Body& i, const Body& j, const Vector3d& across, PairNormal& memory) {
  Found out;
  out.touches = common_normal(i.turned(), j.turned(), across, memory, out.at);
  return out;
}
Found contact(const Body& i, const Body& j, const Vector3d& across) {
  PairNormal memory;
  return contact(i, j, across, memory);
}

/// The distance along `way` at which they overlap by `depth`.
Vector3d across_with(const Body& i, const Body& j, const Vector3d& way, double depth) {
  double low = 0, high = i.turned().farthest + j.turned().farthest;
  for (int k = 0; k < 30; ++k) {
    const double middle = 0.5 * (low + high);
    const Found found = contact(i, j, middle * way);
    (found.touches && found.at.depth > depth ? low : high) = middle;
  }
  return low * way;
}

/// Least thickness of all directions, by trial and then by smaller and smaller steps across it: it
/// knows nothing of derivatives.
struct Global {
  double depth = 1e300;
  Vector3d normal = Vector3d::Zero();
};
Global search_all(const Body& i, const Body& j, const Vector3d& across, Random& random) {
  const TurnedBody a = i.turned(), b = j.turned();
  std::array<Global, 3> best;
  const auto offer = [&](const Vector3d& n) {
    const double f = thickness(a, b, across, n);
    if (f >= best[2].depth) return;
    best[2] = {f, n};
    for (int k = 2; k > 0 && best[k].depth < best[k - 1].depth; --k)
      std::swap(best[k], best[k - 1]);
  };
  for (int k = 0; k < 300; ++k) {
    const Vector3d n = random_direction(random);
    offer(n.dot(across) < 0 ? Vector3d(-n) : n);
  }
  Global out;
  for (Global g : best) {
    for (double step = 0.2; step > 1e-6;) {
      const Vector3d x = g.normal.unitOrthogonal(), y = g.normal.cross(x);
      const double turn = random.uniform(0, 3.2);
      Global next = g;
      for (int k = 0; k < 6; ++k) {
        const double angle = turn + k * 1.0471975511965976;
        const Vector3d n =
            (g.normal + step * (std::cos(angle) * x + std::sin(angle) * y)).normalized();
        const double f = thickness(a, b, across, n);
        if (f < next.depth) next = {f, n};
      }
      if (next.depth < g.depth - 1e-14) {
        g = next;
        step *= 1.5;
      } else {
        step *= 0.5;
      }
    }
    if (g.depth < out.depth) out = g;
  }
  return out;
}

/// Of H_i + H_j.
PlanePrincipal radii_at(const Body& i, const Body& j, const Vector3d& n) {
  const Tangents t = tangents_of(n);
  const auto bend = [&](const Body& b) {
    return bend_of(support_of(b.shape, b.turn.transpose() * n), b.turned().in_body(t));
  };
  return principal_of(sum_of(bend(i), bend(j)));
}

struct Score {
  int pairs = 0, unsettled = 0, beside = 0;  // beside: not the least that there is
  double gap = 0, normal = 0, points = 0, middle = 0;
};
/// `pairs` that overlap by up to `depth`, against the search.
Score score(std::uint64_t seed, double least, double most, double depth, int pairs) {
  Random random(seed);
  Score out;
  for (int k = 0; k < pairs; ++k) {
    const Body i = random_body(random, least, most), j = random_body(random, least, most);
    const Vector3d across =
        across_with(i, j, random_direction(random), depth * random.uniform(0.01, 1));
    const Found found = contact(i, j, across);
    if (!found.touches) continue;
    ++out.pairs;
    out.unsettled += found.at.settled ? 0 : 1;
    const Global global = search_all(i, j, across, random);
    if (global.depth < found.at.depth - 1e-7) {
      ++out.beside;
      continue;
    }
    out.gap = std::max(out.gap, found.at.depth - global.depth);
    // Where the surfaces bend least, the search's normal is known best; across a flat face it may
    // have stopped short.
    const PlanePrincipal radii = radii_at(i, j, found.at.normal);
    const double off = found.at.normal.cross(global.normal).norm();
    if (found.at.settled && global.depth - found.at.depth < 1e-10) {
      out.normal = std::max(out.normal, off * std::sqrt(std::max(radii.lesser - depth, 0.0)));
    }
    // The nearest points lie across each other by d n, the acting one in their middle.
    const auto [a, b] = std::pair(i.turned(), j.turned());
    const Vector3d on_i = a.turn * support_of(i.shape, a.turn.transpose() * found.at.normal).point;
    const Vector3d on_j =
        across - b.turn * support_of(j.shape, b.turn.transpose() * found.at.normal).point;
    const double bend = 1 / (1 + radii.greater);
    out.points =
        std::max(out.points, bend * (on_i - on_j - found.at.depth * found.at.normal).norm());
    const double middle = 0.5 * (on_i + on_j).dot(found.at.normal);
    out.middle = std::max(out.middle, std::fabs(found.at.point.dot(found.at.normal) - middle));
  }
  return out;
}

// 6,000 pairs of the source's shapes. The search ends with steps of 1e-6, so f is good to 1e-11 and
// the normal to about that step.
TEST(CommonNormal, IsTheLeastOfAGlobalSearch) {
  for (const double depth : {1e-3, 3e-2}) {
    const Score s = score(1, 0.7, 1.3, depth, 3000);
    EXPECT_EQ(s.pairs, 3000);
    EXPECT_EQ(s.unsettled, 0);
    EXPECT_EQ(s.beside, 0);
    EXPECT_LT(s.gap, 1e-10);
    EXPECT_LT(s.normal, 2e-5);
    EXPECT_LT(s.points, 1e-5);
    EXPECT_LT(s.middle, 1e-9);
  }
}

// 4,000 of all exponents: at edges (e near 1.9, radius 0) a shallow overlap has several least
// thicknesses, and the search starts from the axes, too.
TEST(CommonNormal, IsNoOtherOneWithSharpEdgesAndFlatFaces) {
  for (const auto& [least, most, beside] : {std::tuple(0.1, 0.3, 0), {0.1, 1.9, 0}}) {
    const Score s = score(2, least, most, 1e-2, 2000);
    EXPECT_GT(s.pairs, 1990);
    EXPECT_LE(s.unsettled, 4) << least;
    EXPECT_LE(s.beside, beside) << least;
    EXPECT_LT(s.gap, 1e-7);
    EXPECT_LT(s.normal, 1e-3);
  }
}

// Perram and Wertheim 1985: two ellipsoids overlap where max over l in (0, 1) of
// l (1 - l) D'((1 - l) A + l B)^-1 D is below 1, A and B their matrices of squared semi-axes.
double perram_wertheim(const Body& i, const Body& j, const Vector3d& across) {
  const auto matrix = [](const Body& b) {
    const Vector3d squares = b.shape.axes.cwiseProduct(b.shape.axes);
    return Matrix3d(b.turn * squares.asDiagonal() * b.turn.transpose());
  };
  const Matrix3d a = matrix(i), b = matrix(j);
  const auto value = [&](double l) {
    const Matrix3d sum = (1 - l) * a + l * b;
    return l * (1 - l) * across.dot(sum.inverse() * across);
  };
  double low = 0, high = 1;
  for (int k = 0; k < 100; ++k) {
    const double one = low + (high - low) / 3, two = high - (high - low) / 3;
    (value(one) < value(two) ? low : high) = value(one) < value(two) ? one : two;
  }
  return value(0.5 * (low + high));
}

TEST(CommonNormal, EllipsoidsTouchWhereTheirContactConditionSays) {
  Random random(3);
  for (int k = 0; k < 3000; ++k) {
    const Body i = random_body(random, 1, 1), j = random_body(random, 1, 1);
    const Vector3d way = random_direction(random);
    // F is of second degree in the distance.
    const double touching = 1 / std::sqrt(perram_wertheim(i, j, way));
    EXPECT_TRUE(contact(i, j, touching * (1 - 1e-9) * way).touches) << k;
    EXPECT_FALSE(contact(i, j, touching * (1 + 1e-9) * way).touches) << k;
  }
}

TEST(CommonNormal, OfSpheresIsTheLineOfCentres) {
  Random random(4);
  for (int k = 0; k < 100; ++k) {
    const Body i{superellipsoid({0.7, 0.7, 0.7}, {1, 1}),
                 random_rotation(random).toRotationMatrix()};
    const Body j{superellipsoid({0.4, 0.4, 0.4}, {1, 1}),
                 random_rotation(random).toRotationMatrix()};
    const Vector3d way = random_direction(random);
    const Found found = contact(i, j, 1.09 * way);
    ASSERT_TRUE(found.touches);
    EXPECT_NEAR(found.at.depth, 0.01, 1e-14);
    EXPECT_NEAR((found.at.normal - way).norm(), 0, 1e-8);
    EXPECT_NEAR((found.at.point - 0.695 * way).norm(), 0, 1e-8);
    EXPECT_EQ(found.at.evaluations, 1);
  }
}

TEST(CommonNormal, LooksTheSameFromBothSides) {
  Random random(5);
  for (int k = 0; k < 1000; ++k) {
    const Body i = random_body(random, 0.4, 1.6), j = random_body(random, 0.4, 1.6);
    const Vector3d across = across_with(i, j, random_direction(random), 1e-3);
    PairNormal memory, other;
    const Found one = contact(i, j, across, memory), two = contact(j, i, -across, other);
    ASSERT_TRUE(one.touches && two.touches);
    EXPECT_NEAR(one.at.depth, two.at.depth, 1e-11);
    // What the last step leaves goes by the root of what it leaves of the depth.
    EXPECT_NEAR((memory.normal - other.reversed().normal).norm(), 0, 1e-4);
  }
}

TEST(CommonNormal, OfAPairApartCostsOneLookAtItsThickness) {
  Random random(6);
  const Body i = random_body(random, 0.7, 1.3), j = random_body(random, 0.7, 1.3);
  const Vector3d way = random_direction(random);
  const Vector3d across = across_with(i, j, way, 1e-6);
  PairNormal memory;
  EXPECT_TRUE(contact(i, j, across, memory).touches);
  // The normal of the contact proves that they have come apart.
  Found found = contact(i, j, across + 1e-3 * memory.normal, memory);
  EXPECT_FALSE(found.touches);
  EXPECT_EQ(found.at.evaluations, 0);
  EXPECT_EQ(memory.touching, 0);
  const PairNormal before = memory;
  found = contact(i, j, across + 2e-3 * memory.normal, memory);
  EXPECT_EQ(found.at.evaluations, 0);
  EXPECT_EQ(memory.normal, before.normal);
  // In contact, and hardly moved, one evaluation is enough.
  contact(i, j, across, memory);
  found = contact(i, j, across - 1e-9 * way, memory);
  EXPECT_TRUE(found.touches);
  EXPECT_EQ(found.at.evaluations, 1);
}

/// A path of two bodies that turn and of which one moves beside the other.
struct Path {
  Body i, j;
  Vector3d start, slide, spin_i, spin_j;

  Found at(double t, PairNormal& memory) const {
    const auto turned = [t](const Body& b, const Vector3d& spin) {
      return Body{b.shape, Matrix3d(quaternion_of(t * spin).toRotationMatrix() * b.turn)};
    };
    return contact(turned(i, spin_i), turned(j, spin_j), start + t * slide, memory);
  }
  /// Bounds how fast the depth changes: no point of a body moves faster.
  double speed() const {
    return slide.norm() + i.turned().farthest * spin_i.norm() + j.turned().farthest * spin_j.norm();
  }
};
Path random_path(Random& random, double least, double most, double depth) {
  Path out{random_body(random, least, most), random_body(random, least, most), {}, {}, {}, {}};
  out.start = across_with(out.i, out.j, random_direction(random), depth);
  const Vector3d across = out.start.cross(random_direction(random)).normalized();
  out.slide = random.uniform(0, 0.3) * across;
  out.spin_i = random.uniform(0, 0.3) * random_direction(random);
  out.spin_j = random.uniform(0, 0.3) * random_direction(random);
  return out;
}

// Along 200 paths with 400 steps and with four times as many: the depth changes by no more than the
// points of the surfaces move, and what force (depth along the normal) and contact point change by
// in a step falls with the step.
TEST(CommonNormal, ChangesWithTheStepAlongPaths) {
  Random random(7);
  double most_coarse = 0, most_fine = 0, point_coarse = 0, point_fine = 0;
  for (int k = 0; k < 200; ++k) {
    const Path path = random_path(random, 0.7, 1.3, 5e-3);
    const auto walk = [&](int steps, double& most, double& most_point) {
      PairNormal memory;
      Vector3d force = Vector3d::Zero(), point = Vector3d::Zero();
      double depth = 0;
      for (int s = 0; s <= steps; ++s) {
        const Found now = path.at(1.0 * s / steps, memory);
        const double d = now.touches ? now.at.depth : 0;
        const Vector3d f = d * now.at.normal;
        if (s > 0) {
          EXPECT_LE(std::fabs(d - depth), path.speed() / steps * (1 + 1e-9) + 1e-12);
          most = std::max(most, (f - force).norm() * 400);
          if (d > 0 && depth > 0) {
            most_point = std::max(most_point, (now.at.point - point).norm() * 400);
          }
        }
        depth = d;
        force = f;
        point = now.at.point;
      }
    };
    walk(400, most_coarse, point_coarse);
    walk(1600, most_fine, point_fine);
  }
  EXPECT_NEAR(most_fine / most_coarse, 0.25, 0.02);
  EXPECT_NEAR(point_fine / point_coarse, 0.25, 0.1);
}

// All exponents and ten times as deep: the force leaps nowhere, because the normal turns by at
// most kMostTurn a step, also where the least thickness that it stands in ends.
TEST(CommonNormal, ForceLeapsNowhereAlsoWhereALeastEnds) {
  Random random(8);
  int held = 0;
  for (int k = 0; k < 300; ++k) {
    const Path path = random_path(random, 0.1, 1.9, 5e-2);
    constexpr int kSteps = 200;
    PairNormal memory;
    Vector3d normal = Vector3d::Zero();
    double depth = 0;
    for (int s = 0; s <= kSteps; ++s) {
      const PairNormal before = memory;
      const Found now = path.at(1.0 * s / kSteps, memory);
      if (!now.touches) {
        EXPECT_LE(depth, path.speed() / kSteps + 1e-9);
        depth = 0;
        continue;
      }
      if (s > 0 && before.touching != 0) {
        const double turn = std::acos(std::min(1.0, normal.dot(now.at.normal)));
        EXPECT_LE(turn, kMostTurn * (1 + 1e-9));
        // Another normal: the thickness goes with the points' distance across it.
        const double reach = path.i.turned().farthest + path.j.turned().farthest;
        EXPECT_LE(std::fabs(now.at.depth - depth), path.speed() / kSteps + turn * reach);
        held += turn > 0.999 * kMostTurn ? 1 : 0;
      }
      normal = now.at.normal;
      depth = now.at.depth;
    }
  }
  EXPECT_GT(held, 0);  // it was needed
}

TEST(CommonNormal, OfFacesThatLieOnEachOther) {
  for (const double e : {0.1, 0.3, 0.5}) {
    // Aligned, with and without an offset, of different sizes; the normal is that of the faces.
    for (const Vector3d& offset : {Vector3d(0, 0, 0), Vector3d(0.3, 0.1, 0), Vector3d(0.9, 0, 0)}) {
      const Found found = contact(box(e), box(e, 1, 0.7, 0.5), offset + Vector3d(0, 0, 1.499));
      if (e > 0.2 && offset.x() > 0.5) {  // so far out they have bent away from each other
        EXPECT_FALSE(found.touches);
        continue;
      }
      ASSERT_TRUE(found.touches) << e << " " << offset.transpose();
      // Rounded faces offset by s lie on each other where both have the same slope.
      EXPECT_LE(found.at.depth, 1e-3 + 1e-15) << e << " " << offset.transpose();
      if (offset.isZero(0)) {
        EXPECT_NEAR(found.at.depth, 1e-3, 1e-15);
        EXPECT_NEAR((found.at.normal - Vector3d::UnitZ()).norm(), 0, 1e-12);
        EXPECT_NEAR((found.at.point - Vector3d(0, 0, 0.9995)).norm(), 0, 1e-9);
      }
      EXPECT_GT(found.at.normal.z(), 0.99);
    }
    // Tilted by next to nothing and by a little: never deeper than flat by more than the tilt.
    PairNormal memory;
    double before = -1;
    for (int k = -40; k <= 40; ++k) {
      const double tilt = std::copysign(k == 0 ? 0 : std::pow(10, -12 + std::abs(k) / 4.0), k);
      if (std::fabs(tilt) > 0.02) continue;
      Body upper = box(e);
      upper.turn = quaternion_of(Vector3d(tilt, 0, 0)).toRotationMatrix();
      const Found found = contact(box(e), upper, {0.2, 0.1, 1.999}, memory);
      ASSERT_TRUE(found.touches) << e << " " << tilt;
      if (before >= 0) {
        EXPECT_LE(std::fabs(found.at.depth - before), 4 * std::fabs(tilt) + 1e-12);
      }
      before = found.at.depth;
    }
  }
}

TEST(CommonNormal, OfEdgesAndCorners) {
  // An edge across a face, an edge across an edge, a corner on a face: of boxes whose edges are
  // rounded, and of bodies whose edges are sharp.
  const Matrix3d edge_up =
      quaternion_of(Vector3d(0.25 * std::numbers::pi, 0, 0)).toRotationMatrix();
  const Matrix3d quarter = quaternion_of(Vector3d(0, 0, 0.5 * std::numbers::pi)).toRotationMatrix();
  Body on_edge = box(0.2);
  on_edge.turn = edge_up;
  Body across_it = on_edge;
  across_it.turn = quarter * edge_up;
  const double reach = height_of(on_edge.shape, edge_up.transpose() * Vector3d::UnitZ());
  for (const auto& [lower, upper, up] :
       {std::tuple(box(0.2), on_edge, 1 + reach), {on_edge, across_it, 2 * reach}}) {
    const Found found = contact(lower, upper, {0.1, 0.05, up - 1e-3});
    ASSERT_TRUE(found.touches);
    EXPECT_TRUE(found.at.settled);
    EXPECT_NEAR(found.at.depth, 1e-3, 5e-4);
    EXPECT_GT(found.at.normal.z(), 0.95);
  }
  // e = 1.9: an octahedron's corner on a face of a box.
  const Found corner = contact(box(0.2), box(1.9), {0.1, 0.05, 2 - 1e-3});
  ASSERT_TRUE(corner.touches);
  EXPECT_NEAR(corner.at.depth, 1e-3, 1e-4);
  // Corner on corner: no least, a saddle; they part beside each other.
  const Found corners = contact(box(1.9), box(1.9), {0, 0, 1.9});
  ASSERT_TRUE(corners.touches);
  EXPECT_LT(corners.at.depth, 0.1);
  EXPECT_LT(corners.at.normal.z(), 0.99);
}

// One inside the other, and with one centre: some least thickness, and no nonsense.
TEST(CommonNormal, OfBodiesInsideEachOther) {
  Random random(9);
  for (int k = 0; k < 300; ++k) {
    const Body i = random_body(random, 0.1, 1.9), j = random_body(random, 0.1, 1.9);
    const Vector3d across =
        k % 3 == 0 ? Vector3d(0, 0, 0) : Vector3d(0.1 * random_direction(random));
    const Found found = contact(i, j, across);
    ASSERT_TRUE(found.touches);
    EXPECT_NEAR(found.at.normal.norm(), 1, 1e-12);
    const Global global = search_all(i, j, across, random);
    EXPECT_LE(found.at.depth, 1.3 * global.depth);
    EXPECT_GT(found.at.depth, 0);
    EXPECT_TRUE(found.at.point.allFinite());
  }
}

}  // namespace
}  // namespace grainfield::dem
