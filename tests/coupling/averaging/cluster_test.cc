// Clusters of grains: their stress from the forces on the boundary and from the contacts inside,
// and where their grains go in a cell that flows.
#include "coupling/averaging/cluster.h"

#include <gmock/gmock.h>

#include <Eigen/Dense>

#include "coupling/averaging/average.h"
#include "coupling/strain/hull.h"
#include "dem/random/random.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kEdge = 10, kReach = 2.6;

// Balls at random places that touch whoever is near, with forces of any direction: in a periodic
// cell, or between nothing.
dem::Snapshot network(bool periodic, std::uint64_t seed) {
  dem::Random random(seed);
  dem::Snapshot s;
  s.dim = 3;
  if (periodic) {
    s.cell.periodic = {true, true, true};
    s.cell.edges = kEdge * Matrix3d::Identity();
  }
  for (int k = 0; k < 120; ++k) {
    dem::Grain g;
    g.id = k;
    g.radius = 1;
    g.mass = 1;
    g.volume = 4.19;
    for (double& x : g.position) x = kEdge * random.uniform();
    s.grains.push_back(g);
  }
  for (std::int64_t i = 0; i < 120; ++i) {
    for (std::int64_t j = i + 1; j < 120; ++j) {
      dem::Contact c;
      c.i = i;
      c.j = j;
      const dem::Vec3 at = s.grains[static_cast<std::size_t>(i)].position;
      dem::Vec3 branch = s.grains[static_cast<std::size_t>(j)].position - at;
      if (periodic) {
        c.image = dem::nearest_image(s.cell, branch);
        branch += dem::shift_to(s.cell, c.image);
      }
      if (branch.norm() > kReach) continue;
      c.point = at + 0.4 * branch;
      c.normal = branch.normalized();
      for (double& f : c.force) f = random.uniform(-1, 1);
      s.contacts.push_back(c);
    }
  }
  return s;
}

// The nearest forces that leave every grain at rest.
void balance(dem::Snapshot& s) {
  const auto n = static_cast<Eigen::Index>(s.grains.size());
  const auto m = static_cast<Eigen::Index>(s.contacts.size());
  MatrixXd sums = MatrixXd::Zero(n, m);
  for (Eigen::Index c = 0; c < m; ++c) {
    sums(s.contacts[static_cast<std::size_t>(c)].i, c) = 1;
    sums(s.contacts[static_cast<std::size_t>(c)].j, c) = -1;
  }
  const Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver(sums);
  for (int a = 0; a < 3; ++a) {
    VectorXd f(m);
    for (Eigen::Index c = 0; c < m; ++c) f[c] = s.contacts[static_cast<std::size_t>(c)].force[a];
    for (int twice = 0; twice < 2; ++twice) f -= solver.solve(VectorXd(sums * f));
    for (Eigen::Index c = 0; c < m; ++c) s.contacts[static_cast<std::size_t>(c)].force[a] = f[c];
  }
}

ClusterForces forces_of(const dem::Snapshot& s, const dem::Vec3& centre, double radius) {
  const Cluster cluster(s, centre, radius);
  return ContactsOfGrains(s).of(cluster, cluster.places(s));
}

TEST(ClusterStress, OfTheBoundaryIsThatInsideAndWhatMovesTheGrains) {
  for (const bool periodic : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const dem::Snapshot s = network(periodic, seed);
      const ClusterForces f = forces_of(s, {7, 2, 4}, 2.4 + 0.1 * static_cast<double>(seed));
      EXPECT_GT(f.unbalanced.norm(), 0.1);
      EXPECT_LT((f.boundary - f.inside - f.unbalanced).norm(), 1e-12 * f.boundary.norm()) << seed;
      EXPECT_GT(f.boundary_grains, 3);
    }
  }
}

// Wellmann eq. 29 for any RVE of grains at rest: to round-off.
TEST(ClusterStress, OfTheBoundaryIsThatInsideAtRest) {
  for (const bool periodic : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      dem::Snapshot s = network(periodic, seed);
      balance(s);
      for (const double radius : {2.0, 3.0, 4.5}) {
        // In the cell across two of its faces.
        const dem::Vec3 centre = periodic ? dem::Vec3(9.5, 0.5, 5) : dem::Vec3(5.5, 4.5, 5);
        const ClusterForces f = forces_of(s, centre, radius);
        EXPECT_LT((f.boundary - f.inside).norm(), 1e-12 * std::max(f.inside.norm(), 0.1))
            << seed << " " << radius;
        if (radius > 2) {
          EXPECT_GT(f.inside.norm(), 0.1);
        }
      }
    }
  }
}

TEST(ClusterStress, OfTheGrainsIsTheAverageOverTheSphere) {
  const dem::Snapshot s = network(true, 4);
  const dem::Vec3 centre(0.7, 9.2, 5);
  const double radius = 3;
  AverageOptions options;
  options.method = "particle_centre";
  options.kernel = "circle";
  options.width = radius;
  const Field field = average(s, centre.transpose(), options);
  const Matrix3d mine =
      forces_of(s, centre, radius).grains / (4.0 / 3 * std::numbers::pi * radius * radius * radius);
  for (const auto& [name, a, b] :
       {std::tuple("sigma_xx", 0, 0), {"sigma_yz", 1, 2}, {"sigma_zz", 2, 2}, {"sigma_zx", 2, 0}}) {
    EXPECT_NEAR(field.find(name)->value[0], mine(a, b), 1e-12) << name;
  }
}

TEST(ClusterPlaces, FollowTheImagesOfACellThatFlows) {
  const dem::Snapshot before = network(true, 6);
  Matrix3d gradient = Matrix3d::Zero();
  gradient(0, 2) = 0.2;
  gradient(2, 2) = -0.05;
  dem::Snapshot after = before;
  after.cell.edges = (Matrix3d::Identity() + gradient) * before.cell.edges;
  for (dem::Grain& g : after.grains) {
    g.position += gradient * g.position;
  }
  // Across three faces.
  const Cluster cluster(before, {0.5, 9.8, 0.2}, 3);
  const MatrixXd places = cluster.places(before), moved = cluster.places(after);
  ASSERT_GT(cluster.size(), 8);
  EXPECT_LT((places.rowwise() - Eigen::RowVector3d(0.5, 9.8, 0.2)).rowwise().norm().maxCoeff(), 3);
  const Hull hull = convex_hull(places);
  EXPECT_LT((hull_gradient(hull, places, moved - places) - gradient).norm(), 1e-12);
}

}  // namespace
}  // namespace grainfield::coupling
