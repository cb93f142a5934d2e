// Lattice piles: their rows, and the forces on the base against Liffman's closed forms.
#include "dem/grains/lattice_pile.h"

#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>

#include "coupling/studies/lattice_pile/simulation.h"
#include "dem/run/run.h"
#include "tests/coupling/lattice_pile_scene.h"

namespace grainfield::dem {
namespace {

using testing::HasSubstr;

LatticeSetup lattice(int base, double slope, double gap = 5e-4) {
  LatticeSetup s;
  s.base_grains = base;
  s.slope_deg = slope;
  s.gap = gap;
  return s;
}

int total(const std::vector<int>& rows) { return std::accumulate(rows.begin(), rows.end(), 0); }

// Liffman's piles: 1035 disks in 45 layers, 360 and 5490 at 30 degrees.
TEST(LatticePile, HasLiffmansNumbersOfDisks) {
  EXPECT_EQ(lattice_rows(lattice(45, 60)).size(), 45U);
  EXPECT_EQ(total(lattice_rows(lattice(45, 60))), 1035);
  EXPECT_EQ(total(lattice_rows(lattice(45, 30))), 360);
  EXPECT_EQ(total(lattice_rows(lattice(180, 30))), 5490);
  EXPECT_THAT(lattice_rows(lattice(1, 17)), testing::ElementsAre(1));
}

// Every disk stands on two of the row below, touches both and no other, and lies under the slope;
// one more disk at either end of a row would not.
TEST(LatticePile, DisksStandOnTwoAndFollowTheSlope) {
  for (const double slope : {12.0, 30.0, 32.6, 45.0, 50.0, 55.0, 59.9, 60.0}) {
    for (const double gap : {0.0, 1e-3, 0.1}) {
      const LatticeSetup s = lattice(31, slope, gap);
      const auto rows = lattice_rows(s);
      const auto grains = lattice_pile_grains(s, 5000);
      ASSERT_EQ(static_cast<int>(grains.size()), total(rows));
      const double d = 2 * s.radius, cotangent = 1 / std::tan(slope * std::acos(-1.0) / 180);
      std::size_t first = 0;
      for (std::size_t j = 0; j < rows.size(); ++j) {
        const double room = 15 - 0.5 * std::sqrt(3.0) * static_cast<double>(j) * cotangent;
        EXPECT_LE(0.5 * (rows[j] - 1), room + 1e-6) << slope << " row " << j;
        if (j > 0 && rows[j] < rows[j - 1] - 1) {
          EXPECT_GT(0.5 * (rows[j] + 1), room - 1e-6);
        }
        for (int k = 0; k < rows[j]; ++k) {
          const NewGrain& g = grains[first + k];
          EXPECT_EQ(g.rotates, j > 0);
          if (j == 0) {
            EXPECT_EQ(g.y, s.radius);
            continue;
          }
          int touching = 0;
          for (std::size_t b = first - rows[j - 1]; b < first; ++b) {
            const double away = std::hypot(g.x - grains[b].x, g.y - grains[b].y) / d;
            if (std::fabs(away - 1) < 1e-12) {
              ++touching;
            } else {
              EXPECT_GT(away, 1.2);
            }
          }
          EXPECT_EQ(touching, 2) << slope << " row " << j << " disk " << k;
        }
        first += static_cast<std::size_t>(rows[j]);
      }
    }
  }
}

// The error against hard disks is that of the geometry under load: proportional to the overlaps,
// which grow with the compliance (linear law), and with its power 2/3 (area of a lens).
TEST(LatticePile, ApproachesTheClosedFormAsDisksHarden) {
  for (const char* law : {"linear", "overlap_area"}) {
    const double order = law[0] == 'l' ? 1 : 2.0 / 3;
    double previous = 0;
    for (const double softness : {1e-3, 1e-4, 1e-5}) {
      LatticePileSetup s = pile_of(12, 60, softness, law);
      s.lattice.gap = 0;
      const BaseErrors errors = base_errors(s, at_rest(s));
      EXPECT_EQ(errors.row_contacts, 0);
      EXPECT_NEAR(errors.weight_ratio, 1, 1e-7);
      const double error = std::max(errors.normal, errors.horizontal);
      if (previous > 0) {
        EXPECT_NEAR(std::log10(previous / error), order, 0.2 * order) << law << " " << softness;
      }
      previous = error;
    }
    EXPECT_LT(previous, law[0] == 'l' ? 2e-4 : 2e-3) << law;
  }
}

// Any slope: N and H count the disks on the lattice lines through a base disk. A gap in the rows
// opens the lattice: tan(theta) grows by 4/3 of it.
TEST(LatticePile, SlopesFollowTheLatticeLines) {
  for (const double slope : {18.0, 30.0, 41.3, 52.0, 57.0}) {
    for (const char* law : {"linear", "overlap_area"}) {
      LatticePileSetup s = pile_of(14, slope, 1e-6, law);
      if (law[0] == 'o') s.lattice.gap = 1e-3;
      const BaseErrors errors = base_errors(s, at_rest(s));
      EXPECT_EQ(errors.row_contacts, 0) << slope;
      EXPECT_LT(errors.normal, 1e-3) << slope << law;
      EXPECT_LT(errors.horizontal, 4.0 / 3 * s.lattice.gap + 1e-3) << slope << law;
      EXPECT_LT(errors.asymmetry, 1e-6) << slope << law;
    }
  }
}

// Largest m g/(K d) at which the frictionless equilateral pile is stable: there the stiffness of
// the contacts, K n n', less the softening by the forces they carry, (F/d) t t', loses its positive
// definiteness.
double stability_limit(int layers, double floor_tangential) {
  std::vector<Eigen::Vector2d> at;
  const auto index = [layers](int row, int k) { return row * layers - row * (row - 1) / 2 + k; };
  for (int row = 0; row < layers; ++row) {
    for (int k = 0; k < layers - row; ++k) {
      at.emplace_back(k - 0.5 * (layers - row - 1), row * 0.5 * std::numbers::sqrt3);
    }
  }
  const auto n = static_cast<Eigen::Index>(2 * at.size());
  Eigen::MatrixXd elastic = Eigen::MatrixXd::Zero(n, n), softening = elastic;
  const auto contact = [&](int a, int b, double force) {
    const Eigen::Vector2d normal = (at[b] - at[a]).normalized();
    const Eigen::Matrix2d along = normal * normal.transpose();
    const Eigen::Matrix2d across = force * (Eigen::Matrix2d::Identity() - along);
    for (const auto& [i, j, sign] : {std::tuple{a, a, 1}, {b, b, 1}, {a, b, -1}, {b, a, -1}}) {
      elastic.block<2, 2>(2 * i, 2 * j) += sign * along;
      softening.block<2, 2>(2 * i, 2 * j) += sign * across;
    }
  };
  const double share = 0.5 / std::cos(std::numbers::pi / 6);  // of a grain's weight, on each line
  for (int row = 1; row < layers; ++row) {
    for (int k = 0; k < layers - row; ++k) {
      contact(index(row, k), index(row - 1, k), share * (layers - row - k));
      contact(index(row, k), index(row - 1, k + 1), share * (k + 1));
    }
  }
  for (int k = 0; k < layers; ++k) {
    elastic(2 * k, 2 * k) += floor_tangential;
    elastic(2 * k + 1, 2 * k + 1) += 1;
  }
  const Eigen::LLT<Eigen::MatrixXd> root(elastic);
  Eigen::MatrixXd m = root.matrixL().solve(softening);
  m = root.matrixL().solve(m.transpose().eval());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> values(0.5 * (m + m.transpose()),
                                                              Eigen::EigenvaluesOnly);
  return 1 / values.eigenvalues().maxCoeff();
}

// Without friction the lattice buckles when its disks are too soft for its height; until then it
// carries the closed form.
TEST(LatticePile, BucklesWhereItsTangentStiffnessSays) {
  const int layers = 16;
  const double limit = stability_limit(layers, 2.0 / 7);
  LatticePileSetup s = pile_of(layers, 60, 0.8 * limit, "linear");
  s.lattice.gap = 0.01;
  EXPECT_LT(base_errors(s, at_rest(s)).normal, 0.02);
  s = pile_of(layers, 60, 1.5 * limit, "linear");
  s.lattice.gap = 0.01;
  EXPECT_GT(base_errors(s, at_rest(s)).normal, 0.05);
}

TEST(LatticePile, SameBitsOnAnyThreadsAndAfterARestart) {
  const LatticePileSetup s = pile_of(9, 47, 1e-5, "linear");
  const Snapshot whole = at_rest(s).snapshots.front().second;
  const std::string file = testing::TempDir() + "lattice_pile.checkpoint";
  for (const long cut : {1L, 333L, 1000L}) {
    {
      const auto run = make_lattice_pile_run(s, 1, 1);
      run->advance(cut);
      run->save(file);
    }
    const auto run = make_lattice_pile_run(s, 1, 3);
    run->restore(file);
    while (!run->done()) run->advance(777);
    run->save(file);  // a finished run can be saved and restored as well
    const auto again = make_lattice_pile_run(s, 1, 1);
    again->restore(file);
    EXPECT_TRUE(again->done());
    const RunResult result = again->result();
    const Snapshot& other = result.snapshots.front().second;
    ASSERT_EQ(other.grains.size(), whole.grains.size());
    ASSERT_EQ(other.contacts.size(), whole.contacts.size());
    for (std::size_t i = 0; i < whole.grains.size(); ++i) {
      EXPECT_EQ(other.grains[i].position, whole.grains[i].position);
    }
    for (std::size_t c = 0; c < whole.contacts.size(); ++c) {
      EXPECT_EQ(other.contacts[c].force, whole.contacts[c].force);
    }
  }
  LatticePileSetup other = s;
  other.lattice.gap = 0.01;
  EXPECT_THROW(make_lattice_pile_run(other, 1, 1)->restore(file), std::invalid_argument);
  std::filesystem::remove(file);
}

TEST(LatticePile, SaysWhenItCannotComeToRest) {
  LatticePileSetup s = pile_of(9, 60, 1e-5, "linear");
  s.rest.max_time = 1e-3;
  try {
    at_rest(s);
    ADD_FAILURE();
  } catch (const ComputationFailed& e) {
    EXPECT_THAT(e.what(), HasSubstr("rest.max_time = 0.001 s"));
  }
}

TEST(LatticePile, RefusesWhatCannotBe) {
  const auto refusal = [](LatticeSetup s) {
    try {
      check_lattice(s);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal(lattice(45, 61)), "lattice.slope_deg: found 61, allowed: above 0, at most 60");
  EXPECT_EQ(refusal(lattice(0, 60)), "lattice.base_grains: found 0, allowed: 1 or more");
  EXPECT_THAT(refusal(lattice(4, 60, -0.1)), HasSubstr("lattice.gap: found -0.1"));
  EXPECT_THAT(refusal(lattice(4, 60, 0.6)), HasSubstr("allowed: 0 to 0.5"));
  LatticeSetup s;
  s.radius = 0;
  EXPECT_THAT(refusal(s), HasSubstr("lattice.radius: found 0, allowed: above 0"));
}

}  // namespace
}  // namespace grainfield::dem
