#include "continuum/fe/verification.h"

#include <deal.II/grid/grid_generator.h>

#include <cmath>

#include "continuum/closed/half_space.h"
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
  double lambda = 0, shear = 0;
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

/// Orthotropic constants that vary with the place, C(x) = m(x) C_0, m = 1 + sin(x + 2 y + 0.3) / 3,
/// and an initial stress sigma_0, on the displacement of Manufactured: the solution is chosen, the
/// force follows.
struct MappedManufactured {
  Manufactured<2> u{};
  fe::Stiffness<2> c0;

  explicit MappedManufactured(const PlaneModuli& moduli) : c0(stiffness(moduli)) {}
  static double phase(const Point<2>& p) { return p[0] + 2 * p[1] + 0.3; }
  static double factor(const Point<2>& p) { return 1 + std::sin(phase(p)) / 3; }
  static Stress<2> initial(const Point<2>& p) {
    Stress<2> s;
    s[0] = 0.2 * std::sin(3 * p[1]) + 0.1 * p[0] * p[0];
    s[1] = 0.3 * std::cos(2 * p[0] + p[1]);
    s[2] = 0.1 * std::exp(p[0] - p[1]);
    return s;
  }
  /// C_0 eps, or its derivative along an axis.
  Eigen::Vector3d plain(const Point<2>& p, int along = -1) const {
    return c0 * Eigen::Vector3d(Manufactured<2>::derivative(p, 0, 0, along),
                                Manufactured<2>::derivative(p, 1, 1, along),
                                Manufactured<2>::derivative(p, 0, 1, along) +
                                    Manufactured<2>::derivative(p, 1, 0, along));
  }
  Stress<2> stress(const Point<2>& p) const {
    Stress<2> s;
    for (int c = 0; c < 3; ++c) s[c] = factor(p) * plain(p)[c];
    return s;
  }
  Vector<2> force(const Point<2>& p) const {
    const double slope = std::cos(phase(p)) / 3;
    const Eigen::Vector3d s = plain(p), dx = factor(p) * plain(p, 0) + slope * s,
                          dy = factor(p) * plain(p, 1) + 2 * slope * s;
    Vector<2> f;
    f[0] = -(dx[0] + dy[2]) - 0.2 * p[0] + 0.1 * std::exp(p[0] - p[1]);
    f[1] = -(dx[2] + dy[1]) - 0.1 * std::exp(p[0] - p[1]) + 0.3 * std::sin(2 * p[0] + p[1]);
    return f;
  }
};

constexpr double kLoadNu = 0.3, kLoadGap = 0.05;

template <int dim>
Vector<dim> below_load_displacement(const Point<dim>& p) {
  Vector<dim> u;
  if constexpr (dim == 2) {
    const auto found = flamant_displacement(1, 1, kLoadNu, p[0], p[1]);
    for (unsigned int d = 0; d < 2; ++d) u[d] = found[d];
  } else {
    const auto found = boussinesq_displacement(1, 1, kLoadNu, p[0], p[1], p[2]);
    for (unsigned int d = 0; d < 3; ++d) u[d] = found[d];
  }
  return u;
}

template <int dim>
Stress<dim> below_load_stress(const Point<dim>& p) {
  Stress<dim> s;
  if constexpr (dim == 2) {
    const auto found = flamant_stress(1., p[0], p[1]);
    for (unsigned int c = 0; c < 3; ++c) s[c] = found[c];
  } else {
    const auto found = boussinesq_stress(1., kLoadNu, p[0], p[1], p[2]);
    for (unsigned int c = 0; c < 6; ++c) s[c] = found[c];
  }
  return s;
}

template <int dim>
ManufacturedErrors below_load(int degree, int cells) {
  fe::ElasticProblem<dim> problem;
  problem.nu = kLoadNu;
  for (unsigned int id = 0; id < 2 * dim; ++id) {
    problem.boundaries[id].fixed.fill(true);
    problem.boundaries[id].displacement = below_load_displacement<dim>;
  }
  fe::ElasticSolver<dim> solver(fe::communicator(fe::chosen_ranks()), degree, 500,
                                "box below a load");
  Point<dim> low, high;
  for (unsigned int d = 0; d + 1 < dim; ++d) {
    low[d] = -0.5;
    high[d] = 0.5;
  }
  low[dim - 1] = -1 - kLoadGap;
  high[dim - 1] = -kLoadGap;
  dealii::GridGenerator::subdivided_hyper_rectangle(
      solver.mesh(), std::vector<unsigned int>(dim, static_cast<unsigned int>(cells)), low, high,
      true);
  solver.solve(problem);
  const auto errors = solver.errors(below_load_displacement<dim>, below_load_stress<dim>);
  return {errors[0], errors[1], errors[2], solver.figures()};
}

}  // namespace

ManufacturedErrors solve_manufactured_map(int degree, const PlaneModuli& moduli, int refinement,
                                          bool uniform) {
  const MappedManufactured exact(moduli);
  fe::ElasticProblem<2> problem;
  const auto factor = [&](const Point<2>& p) {
    return uniform ? 1. : MappedManufactured::factor(p);
  };
  const auto stress = [&](const Point<2>& p) {
    return exact.stress(p) * (factor(p) / MappedManufactured::factor(p));
  };
  if (uniform) {
    problem.stiffness = exact.c0;
  } else {
    problem.stiffness_at = [&](const Point<2>& p) -> fe::Stiffness<2> {
      return factor(p) * exact.c0;
    };
    problem.initial_stress = MappedManufactured::initial;
  }
  problem.body_force = [&](const Point<2>& p) {
    if (!uniform) return exact.force(p);
    const Eigen::Vector3d dx = exact.plain(p, 0), dy = exact.plain(p, 1);
    Vector<2> f;
    f[0] = -(dx[0] + dy[2]);
    f[1] = -(dx[2] + dy[1]);
    return f;
  };
  // Springs under one side: the traction that the solution leaves for them beside its own.
  constexpr double kSpring = 2;
  for (int id = 0; id < 4; ++id) {
    auto& boundary = problem.boundaries[static_cast<unsigned int>(id)];
    boundary.displacement = [&](const Point<2>& p) { return exact.u.displacement(p); };
    boundary.fixed = {id == 0 || id == 2, id == 0};
    if (id == 1) boundary.spring[0] = boundary.spring[1] = kSpring;
    boundary.traction = [&, id, stress](const Point<2>& p, const Vector<2>& normal) {
      Vector<2> t = fe::traction<2>(
          stress(p) + (uniform ? Stress<2>() : MappedManufactured::initial(p)), normal);
      if (id == 1) t += kSpring * exact.u.displacement(p);
      return t;
    };
  }
  fe::ElasticSolver<2> solver(fe::communicator(fe::chosen_ranks()), degree, 500,
                              "manufactured problem");
  dealii::GridGenerator::hyper_cube(solver.mesh(), 0, 1, true);
  solver.mesh().refine_global(static_cast<unsigned int>(refinement));
  solver.solve(problem);
  const auto errors =
      solver.errors([&](const Point<2>& p) { return exact.u.displacement(p); }, stress);
  return {errors[0], errors[1], errors[2], solver.figures()};
}

ManufacturedErrors solve_below_load(int dim, int degree, int cells) {
  return dim == 2 ? below_load<2>(degree, cells) : below_load<3>(degree, cells);
}

ManufacturedErrors solve_manufactured(int dim, int degree, double nu, int refinement, bool mixed) {
  return dim == 2 ? solve<2>(degree, nu, refinement, mixed)
                  : solve<3>(degree, nu, refinement, mixed);
}

}  // namespace grainfield::continuum
