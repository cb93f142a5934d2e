// Synthetic increments of stress and strain for the tests of elastic constants.
#pragma once
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "coupling/averaging/average.h"
#include "coupling/elastic_constants/increments.h"
#include "dem/random/random.h"
#include "tests/refusal.h"

namespace grainfield::test {
inline double standard_normal(dem::Random& random) {
  const double u = 1 - random.uniform(), v = random.uniform();
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

/// xx, yy, xy of a random symmetric tensor whose entries are normal with this deviation in every
/// frame: the shear has 1/sqrt(2) of it.
inline Eigen::Vector3d random_tensor(dem::Random& random, double size) {
  const double a = standard_normal(random), b = standard_normal(random),
               c = standard_normal(random);
  return size * Eigen::Vector3d(a, b, c / std::numbers::sqrt2);
}

/// C11, C22, C12, C66 applied to a strain xx, yy, xy.
inline Eigen::Vector3d stress_of(const Eigen::Vector4d& c, const Eigen::Vector3d& e) {
  return {c[0] * e[0] + c[2] * e[1], c[2] * e[0] + c[1] * e[1], 2 * c[3] * e[2]};
}

inline Eigen::Vector4d isotropic(double k, double g) { return {k + g, k + g, k - g, g}; }

/// Strains of about 1e-4, stresses by C at each point plus isotropic noise of the stress and of the
/// measured strain. `shared`: one noise for all points of a realization.
struct Recipe {
  Eigen::MatrixXd points = coupling::grid_points(0, 1, 4, 0, 1, 3);
  std::function<Eigen::Vector4d(const Eigen::Vector2d&)> c = [](const Eigen::Vector2d&) {
    return isotropic(2e6, 1e6);
  };
  int realizations = 1;
  double stress_noise = 0, strain_noise = 0;
  bool shared = false;
};

inline coupling::Increments make_increments(std::uint64_t seed, const Recipe& recipe) {
  dem::Random random(seed);
  coupling::Increments all;
  all.points = recipe.points;
  for (int r = 0; r < recipe.realizations; ++r) {
    Eigen::MatrixX3d stress(recipe.points.rows(), 3), strain = stress;
    const Eigen::Vector3d of_all = random_tensor(random, recipe.stress_noise);
    for (Eigen::Index p = 0; p < recipe.points.rows(); ++p) {
      const Eigen::Vector3d e = random_tensor(random, 1e-4),
                            own = random_tensor(random, recipe.stress_noise);
      stress.row(p) = (stress_of(recipe.c(recipe.points.row(p).transpose()), e) +
                       (recipe.shared ? of_all : own))
                          .transpose();
      strain.row(p) = (e + random_tensor(random, recipe.strain_noise)).transpose();
    }
    all.stress.push_back(stress);
    all.strain.push_back(strain);
  }
  return all;
}

}  // namespace grainfield::test
