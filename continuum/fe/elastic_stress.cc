// The stress of an ElasticSolver: recovered at the nodes, at points, its errors.
#include <deal.II/base/mpi_remote_point_evaluation.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/numerics/vector_tools_evaluate.h>

#include "continuum/fe/elastic_solver.h"

namespace grainfield::continuum::fe {

using namespace dealii;

template <int dim>
Stiffness<dim> isotropic_stiffness(double E, double nu) {
  const double shear = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  Stiffness<dim> c = Stiffness<dim>::Zero();
  c.template topLeftCorner<dim, dim>().setConstant(lambda);
  for (int i = 0; i < kStresses<dim>; ++i) c(i, i) += i < dim ? 2 * shear : shear;
  return c;
}

template <int dim>
fe::Vector<dim> traction(const Stress<dim>& stress, const fe::Vector<dim>& normal) {
  fe::Vector<dim> t;
  const auto components = stress_components<dim>();
  for (int c = 0; c < kStresses<dim>; ++c) {
    const auto [i, j] = components[c];
    t[i] += stress[c] * normal[j];
    if (i != j) t[j] += stress[c] * normal[i];
  }
  return t;
}

namespace {

/// C eps of a displacement gradient.
template <int dim>
Stress<dim> stress_of(const Stiffness<dim>& stiffness, const Tensor<2, dim>& gradient) {
  const auto components = stress_components<dim>();
  Eigen::Matrix<double, kStresses<dim>, 1> strain;
  for (int c = 0; c < kStresses<dim>; ++c) {
    const auto [i, j] = components[c];
    strain[c] = i == j ? gradient[i][i] : gradient[i][j] + gradient[j][i];
  }
  const Eigen::Matrix<double, kStresses<dim>, 1> stress = stiffness * strain;
  Stress<dim> s;
  for (int c = 0; c < kStresses<dim>; ++c) s[c] = stress[c];
  return s;
}

}  // namespace

/// The stress is most accurate at the Gauss points of one order less than the element's; on each
/// cell the polynomial through them is carried on to the nodes, where the cells' values are
/// averaged.
template <int dim>
void ElasticSolver<dim>::recover_stress() {
  stress_dofs_.distribute_dofs(stress_element_);
  IndexSet relevant;
  DoFTools::extract_locally_relevant_dofs(stress_dofs_, relevant);
  const auto& owned = stress_dofs_.locally_owned_dofs();
  stress_.reinit(owned, relevant, comm_);
  LinearAlgebra::distributed::Vector<double> count(owned, relevant, comm_);

  const FE_DGQArbitraryNodes<dim> through{QGauss<1>(degree_)};
  const auto& nodes = stress_element_.base_element(0).get_unit_support_points();
  const Quadrature<dim> gauss(through.get_unit_support_points());
  Eigen::MatrixXd extrapolate(nodes.size(), gauss.size());
  for (unsigned int i = 0; i < nodes.size(); ++i)
    for (unsigned int q = 0; q < gauss.size(); ++q)
      extrapolate(i, q) = through.shape_value(q, nodes[i]);

  FEValues<dim> values(mapping_, element_, gauss, update_gradients | update_quadrature_points);
  std::vector<Tensor<2, dim>> gradients(gauss.size());
  std::vector<types::global_dof_index> indices(stress_element_.n_dofs_per_cell());
  Eigen::MatrixXd at_gauss(gauss.size(), kStresses<dim>);
  for (const auto& cell : dofs_.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    values.reinit(cell);
    values[FEValuesExtractors::Vector(0)].get_function_gradients(solution_, gradients);
    for (unsigned int q = 0; q < gauss.size(); ++q) {
      const auto s = stress_of<dim>(stiffness_at(values.quadrature_point(q)), gradients[q]);
      for (int c = 0; c < kStresses<dim>; ++c) at_gauss(q, c) = s[c];
    }
    const Eigen::MatrixXd at_nodes = extrapolate * at_gauss;
    typename DoFHandler<dim>::cell_iterator(&mesh_, cell->level(), cell->index(), &stress_dofs_)
        ->get_dof_indices(indices);
    for (unsigned int i = 0; i < indices.size(); ++i) {
      const auto [component, node] = stress_element_.system_to_component_index(i);
      stress_(indices[i]) += at_nodes(node, component);
      count(indices[i]) += 1;
    }
  }
  stress_.compress(VectorOperation::add);
  count.compress(VectorOperation::add);
  for (unsigned int i = 0; i < stress_.locally_owned_size(); ++i)
    stress_.local_element(i) /= count.local_element(i);
  AffineConstraints<double> hanging(relevant);
  DoFTools::make_hanging_node_constraints(stress_dofs_, hanging);
  hanging.close();
  hanging.distribute(stress_);
  stress_.update_ghost_values();
}

template <int dim>
Eigen::MatrixXd ElasticSolver<dim>::stress_at(const std::vector<Point<dim>>& points) const {
  // Rank 0 asks, the owners of the cells answer, everybody gets the same copy.
  const bool root = Utilities::MPI::this_mpi_process(comm_) == 0;
  // Part of a cell by which a point on its border may lie outside through round-off.
  Utilities::MPI::RemotePointEvaluation<dim> cache(1e-9);
  const auto found = VectorTools::point_values<kStresses<dim>>(
      mapping_, stress_dofs_, stress_, root ? points : std::vector<Point<dim>>(), cache);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> out(points.size(),
                                                                             kStresses<dim>);
  if (root) {
    for (std::size_t i = 0; i < points.size(); ++i)
      for (int c = 0; c < kStresses<dim>; ++c) out(i, c) = found[i][c];
  }
  MPI_Bcast(out.data(), static_cast<int>(out.size()), MPI_DOUBLE, 0, comm_);
  return out;
}

template <int dim>
std::array<double, 3> ElasticSolver<dim>::errors(
    const std::function<fe::Vector<dim>(const Point<dim>&)>& displacement,
    const std::function<Stress<dim>(const Point<dim>&)>& stress) const {
  const QGauss<dim> quadrature(degree_ + 3);
  FEValues<dim> values(
      mapping_, element_, quadrature,
      update_values | update_gradients | update_quadrature_points | update_JxW_values);
  FEValues<dim> stress_values(mapping_, stress_element_, quadrature, update_values);
  const FEValuesExtractors::Vector u(0);
  std::vector<fe::Vector<dim>> found(quadrature.size());
  std::vector<Tensor<2, dim>> gradients(quadrature.size());
  std::vector<dealii::Vector<double>> recovered(quadrature.size(),
                                                dealii::Vector<double>(kStresses<dim>));
  std::array<double, 3> sums{};
  for (const auto& cell : dofs_.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    values.reinit(cell);
    values[u].get_function_values(solution_, found);
    values[u].get_function_gradients(solution_, gradients);
    stress_values.reinit(typename DoFHandler<dim>::cell_iterator(&mesh_, cell->level(),
                                                                 cell->index(), &stress_dofs_));
    stress_values.get_function_values(stress_, recovered);
    for (unsigned int q = 0; q < quadrature.size(); ++q) {
      const auto& p = values.quadrature_point(q);
      const auto exact = stress(p);
      sums[0] += (found[q] - displacement(p)).norm_square() * values.JxW(q);
      sums[1] +=
          (stress_of<dim>(stiffness_at(p), gradients[q]) - exact).norm_square() * values.JxW(q);
      for (int c = 0; c < kStresses<dim>; ++c)
        sums[2] += std::pow(recovered[q][c] - exact[c], 2) * values.JxW(q);
    }
  }
  for (auto& sum : sums) sum = std::sqrt(Utilities::MPI::sum(sum, comm_));
  return sums;
}

template Stiffness<2> isotropic_stiffness<2>(double, double);
template Stiffness<3> isotropic_stiffness<3>(double, double);
template fe::Vector<2> traction<2>(const Stress<2>&, const fe::Vector<2>&);
template fe::Vector<3> traction<3>(const Stress<3>&, const fe::Vector<3>&);
template void ElasticSolver<2>::recover_stress();
template void ElasticSolver<3>::recover_stress();
template Eigen::MatrixXd ElasticSolver<2>::stress_at(const std::vector<Point<2>>&) const;
template Eigen::MatrixXd ElasticSolver<3>::stress_at(const std::vector<Point<3>>&) const;
template std::array<double, 3> ElasticSolver<2>::errors(
    const std::function<fe::Vector<2>(const Point<2>&)>&,
    const std::function<Stress<2>(const Point<2>&)>&) const;
template std::array<double, 3> ElasticSolver<3>::errors(
    const std::function<fe::Vector<3>(const Point<3>&)>&,
    const std::function<Stress<3>(const Point<3>&)>&) const;

}  // namespace grainfield::continuum::fe
