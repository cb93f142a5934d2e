// Local refinement of triangles: area, conformity, angles, over random marks; adaptive heaps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>

#include "continuum/fe/triangle_refinement.h"
#include "continuum/fe/wedge.h"

using namespace grainfield::continuum;
using fe::TriangleMesh;

namespace {

double area(const TriangleMesh& mesh, std::size_t t) {
  const auto& c = mesh.triangles[t];
  const auto at = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(c[k])]; };
  const Eigen::Vector2d a = at(1) - at(0), b = at(2) - at(0);
  return (a[0] * b[1] - a[1] * b[0]) / 2;
}

double least_angle(const TriangleMesh& mesh) {
  double least = 4;
  for (const auto& c : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = [&](std::size_t j) {
        return mesh.vertices[static_cast<std::size_t>(c[(k + j) % 3])];
      };
      const Eigen::Vector2d a = (at(1) - at(0)).normalized(), b = (at(2) - at(0)).normalized();
      least = std::min(least, std::acos(std::clamp(a.dot(b), -1., 1.)));
    }
  }
  return least;
}

/// Length of the boundary; edges between more than two triangles: nan.
double boundary(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> count;
  for (const auto& c : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++count[std::minmax(c[k], c[(k + 1) % 3])];
  double length = 0;
  for (const auto& [edge, times] : count) {
    if (times > 2) return std::nan("");
    if (times == 1)
      length += (mesh.vertices[static_cast<std::size_t>(edge.first)] -
                 mesh.vertices[static_cast<std::size_t>(edge.second)])
                    .norm();
  }
  return length;
}

}  // namespace

TEST(FeRefinement, RandomMarksKeepAreaBoundaryAndAngles) {
  std::mt19937 random(7);
  for (const double slope : {15., 28., 45., 70.}) {
    const double half = 1 / std::tan(slope * 3.14159265358979 / 180);
    TriangleMesh mesh = fe::triangle_lattice({-half, -1}, {1.3 * half, -1}, {0, 0}, 5);
    const double first_angle = least_angle(mesh), outline = boundary(mesh);
    for (int cycle = 0; cycle < 6; ++cycle) {
      std::vector<bool> marks(mesh.triangles.size());
      for (std::size_t t = 0; t < marks.size(); ++t) marks[t] = random() % 7 == 0;
      std::vector<int> parent;
      const TriangleMesh next = fe::refined(mesh, marks, parent);
      ASSERT_EQ(parent.size(), next.triangles.size());
      std::vector<double> covered(mesh.triangles.size(), 0);
      std::vector<int> pieces(mesh.triangles.size(), 0);
      for (std::size_t t = 0; t < next.triangles.size(); ++t) {
        ASSERT_GT(area(next, t), 0);
        covered[static_cast<std::size_t>(parent[t])] += area(next, t);
        ++pieces[static_cast<std::size_t>(parent[t])];
      }
      for (std::size_t t = 0; t < marks.size(); ++t) {
        EXPECT_NEAR(covered[t], area(mesh, t), 1e-12);
        if (marks[t]) {
          EXPECT_GE(pieces[t], 2);
        }
      }
      // A hanging node would be an edge that one triangle has alone.
      EXPECT_NEAR(boundary(next), outline, 1e-9);
      mesh = next;
    }
    EXPECT_GE(least_angle(mesh), first_angle / 2 - 1e-9) << slope;
    EXPECT_GT(mesh.triangles.size(), 60u);
  }
}

TEST(FeRefinement, LargestErrorsHoldTheirShare) {
  const auto marks = fe::largest_errors({1, 3, 0, 2}, 0.6);  // squares 1, 9, 0, 4 of 14
  EXPECT_EQ(marks, (std::vector<bool>{false, true, false, false}));
  EXPECT_EQ(fe::largest_errors({1, 3, 0, 2}, 0.9), (std::vector<bool>{false, true, false, true}));
  EXPECT_EQ(fe::largest_errors({0, 0}, 0.5), (std::vector<bool>{false, false}));
}

TEST(FeRefinement, StopsBeforeItTakesAllMemory) {
  WedgeProblem p;
  p.cells = 8;
  p.dilation_deg = 28;
  p.refinements = 12;
  p.most_unknowns = 1000;
  try {
    solve_wedge(p);
    FAIL() << "1000 unknowns were exceeded";
  } catch (const grainfield::ComputationFailed& e) {
    EXPECT_NE(std::string(e.what()).find("allowed: up to most_unknowns = 1000; lower refinements"),
              std::string::npos)
        << e.what();
  }
}

TEST(FeRefinement, AdaptiveHeap) {
  WedgeProblem p;
  p.cells = 8;
  p.dilation_deg = 28;
  p.right_deg = 24;
  const WedgeResult coarse = solve_wedge(p);
  p.refinements = 3;
  const WedgeResult fine = solve_wedge(p);
  EXPECT_LT(fine.relative_error, 0.6 * coarse.relative_error);
  EXPECT_GT(fine.unknowns, coarse.unknowns);
  EXPECT_NEAR(fine.base_force[1] / fine.weight, 1, 1e-8);
  // Points find their piece: the interpolated stress is that of the triangle's corners.
  for (std::size_t t = 0; t < fine.mesh.triangles.size(); t += 7) {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    for (const int c : fine.mesh.triangles[t])
      centre += fine.mesh.vertices[static_cast<std::size_t>(c)] / 3;
    EXPECT_EQ(fine.triangle_at(centre), static_cast<int>(t));
  }
  // The same heap, solved with uniform triangles of the same least size, is near.
  p.refinements = 0;
  p.cells = 24;
  const WedgeResult uniform = solve_wedge(p);
  for (const double x : {-1., -0.3, 0., 0.5, 1.4})
    EXPECT_NEAR(fine.stress_at({x, -0.95})[1], uniform.stress_at({x, -0.95})[1], 0.015) << x;
}
