// Heaps of every closed-form model with random parameters.
#pragma once
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

#include "continuum/closed/cantelaube.h"
#include "continuum/closed/cantelaube_asymmetric.h"
#include "continuum/closed/heap_field.h"
#include "continuum/closed/ife.h"
#include "continuum/closed/osl.h"
#include "dem/random/random.h"

namespace grainfield::continuum::testing {

inline constexpr double kDegree = std::numbers::pi / 180;

struct Heap {
  std::string name;
  std::unique_ptr<HeapField> field;
  bool symmetric = true;
};

inline double random_phi(dem::Random& random) { return kDegree * random.uniform(15, 40); }

template <class Field>
Heap heap(std::string name, Field field, bool symmetric = true) {
  return {std::move(name), std::make_unique<Field>(std::move(field)), symmetric};
}

// Slopes from a third of phi up to phi itself, and now and then both phi.
inline AsymmetricHeap random_asymmetric(dem::Random& random) {
  AsymmetricHeap out;
  out.phi = random_phi(random);
  const double kind = random.uniform();
  out.left = kind < 0.1 ? out.phi : out.phi * random.uniform(0.34, 1);
  out.right = kind > 0.05 && kind < 0.15 ? out.phi : out.phi * random.uniform(0.34, 1);
  return out;
}

// A ray between the flanks for which a core of this branch exists.
inline double random_yield_ray(dem::Random& random, const AsymmetricHeap& heap, CoreBranch branch) {
  const SectorField linear = asymmetric_field(heap, CoreBranch::zero, 0, 1);
  const double from = linear.regions()[1].from, to = linear.regions()[1].to;
  for (int i = 0; i < 400; ++i) {
    const double ray = from + (to - from) * random.uniform();
    if (yielding_field(heap, branch, ray, 1)) return ray;
  }
  throw std::logic_error("no yield ray");
}

// One of the kinds whose parameters cost nothing; rho g over six orders of magnitude.
inline Heap random_heap(dem::Random& random) {
  const double phi = random_phi(random), rho_g = std::exp(random.uniform(-7, 7));
  switch (random.bits() % 7) {
    case 0: {
      const auto branch = static_cast<CoreBranch>(random.bits() % 3);
      return heap("cantelaube", cantelaube_field(phi, core_angle(phi, branch), rho_g));
    }
    case 1: {
      const double beta_hat = (std::numbers::pi / 2 - phi) * random.uniform(0.02, 0.98);
      return heap("cantelaube beta_hat", cantelaube_field(phi, beta_hat, rho_g));
    }
    case 2: {
      const AsymmetricHeap a = random_asymmetric(random);
      return heap("asymmetric", asymmetric_field(a, CoreBranch::zero, 0, rho_g), false);
    }
    case 3: {
      const AsymmetricHeap a = random_asymmetric(random);
      const auto branch = random.bits() % 2 == 0 ? CoreBranch::minus : CoreBranch::plus;
      return heap("asymmetric, yield ray",
                  asymmetric_field(a, branch, random_yield_ray(random, a, branch), rho_g), false);
    }
    case 4: {
      const double mu = random.uniform(-3, 0.95 / std::tan(phi));
      return heap("osl", osl_field(phi, {eta_at_yield(phi, mu), mu}, rho_g));
    }
    case 5: {
      const double cot = 1 / std::tan(phi), mu = random.uniform(-2, 0.5 * cot);
      return heap("osl eta mu",
                  osl_field(phi, {cot * (cot - mu) * random.uniform(0.01, 0.99), mu}, rho_g));
    }
    default:
      return heap("fpa", osl_field(phi, {1, -2 * std::tan(phi)}, rho_g));
  }
}

// A point of region k.
inline Eigen::Vector2d random_point(dem::Random& random, const HeapField& field, std::size_t k) {
  const HeapRegion& region = field.regions()[k];
  const double theta = random.uniform(region.from, region.to), r = std::exp(random.uniform(-5, 5));
  return {r * std::sin(theta), -r * std::cos(theta)};
}

}  // namespace grainfield::continuum::testing
