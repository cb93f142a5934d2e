#include "continuum/fe/verification.h"

#include <deal.II/grid/grid_generator.h>

#include <cmath>

#include "continuum/fe/elastic_solver.h"
#include "continuum/fe/parallel.h"

namespace grainfield::continuum {
namespace {

using fe::Stress;
using fe::Vector;
template <int dim>
using Point = dealii::Point<dim>;

/// u_i = a_i prod_j sin(k x_j + i + j / 2): no symmetry that could hide an error.
template <int dim>
struct Manufactured {
  double lambda, shear;
  static constexpr double k = 2;

  static double amplitude(int i) { return 1 + 0.5 * i; }
  /// Product over j of the factor's derivative of order orders[j].
  static double product(const Point<dim>& p, int i, const std::array<int, dim>& orders) {
    double value = amplitude(i);
    for (int j = 0; j < dim; ++j)
      value *= std::pow(k, orders[j]) * std::sin(k * p[j] + i + 0.5 * j + orders[j] * M_PI / 2);
    return value;
  }
  static double derivative(const Point<dim>& p, int i, int a, int b = -1) {
    std::array<int, dim> orders{};
    ++orders[a];
    if (b >= 0) ++orders[b];
    return product(p, i, orders);
  }
  Vector<dim> displacement(const Point<dim>& p) const {
    Vector<dim> u;
    for (int i = 0; i < dim; ++i) u[i] = product(p, i, {});
    return u;
  }
  Stress<dim> stress(const Point<dim>& p) const {
    double divergence = 0;
    for (int i = 0; i < dim; ++i) divergence += derivative(p, i, i);
    Stress<dim> s;
    const auto components = fe::stress_components<dim>();
    for (int c = 0; c < fe::kStresses<dim>; ++c) {
      const auto [i, j] = components[c];
      s[c] =
          shear * (derivative(p, i, j) + derivative(p, j, i)) + (i == j ? lambda * divergence : 0);
    }
    return s;
  }
  /// f = -div sigma = -(lambda + G) grad div u - G lap u.
  Vector<dim> force(const Point<dim>& p) const {
    Vector<dim> f;
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        f[i] -= (lambda + shear) * derivative(p, j, i, j) + shear * derivative(p, i, j, j);
    return f;
  }
};

template <int dim>
ManufacturedErrors solve(int degree, double nu, int refinement, bool mixed) {
  const Manufactured<dim> exact{nu / ((1 + nu) * (1 - 2 * nu)), 1 / (2 * (1 + nu))};
  fe::ElasticProblem<dim> problem;
  problem.nu = nu;
  problem.body_force = [&](const Point<dim>& p) { return exact.force(p); };
  const int top = 2 * dim - 1;
  for (int id = 0; id < 2 * dim; ++id) {
    auto& boundary = problem.boundaries[id];
    if (id == top) {
      boundary.traction = [&](const Point<dim>& p, const Vector<dim>& normal) {
        return fe::traction<dim>(exact.stress(p), normal);
      };
    } else {
      boundary.fixed.fill(true);
      boundary.displacement = [&](const Point<dim>& p) { return exact.displacement(p); };
    }
  }
  fe::ElasticSolver<dim> solver(fe::communicator(fe::chosen_ranks()), degree, 500,
                                "manufactured problem");
  dealii::GridGenerator::hyper_cube(solver.mesh(), 0, 1, true);
  solver.mesh().refine_global(refinement);
  if (mixed) {
    for (const auto& cell : solver.mesh().active_cell_iterators())
      if (cell->is_locally_owned() && cell->center().norm() < 0.5) cell->set_refine_flag();
    solver.mesh().execute_coarsening_and_refinement();
  }
  solver.solve(problem);
  const auto errors = solver.errors([&](const Point<dim>& p) { return exact.displacement(p); },
                                    [&](const Point<dim>& p) { return exact.stress(p); });
  return {errors[0], errors[1], errors[2], solver.figures()};
}

}  // namespace

ManufacturedErrors solve_manufactured(int dim, int degree, double nu, int refinement, bool mixed) {
  return dim == 2 ? solve<2>(degree, nu, refinement, mixed)
                  : solve<3>(degree, nu, refinement, mixed);
}

}  // namespace grainfield::continuum
