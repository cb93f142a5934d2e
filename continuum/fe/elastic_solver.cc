#include "continuum/fe/elastic_solver.h"

#include <Epetra_MultiVector.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/grid_refinement.h>
#include <deal.II/dofs/dof_renumbering.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/numerics/error_estimator.h>
#include <deal.II/numerics/vector_tools_boundary.h>
#include <fmt/format.h>

#include <Teuchos_ParameterList.hpp>
#include <chrono>

#include "continuum/model.h"
#include "continuum/size.h"

namespace grainfield::continuum::fe {
namespace {

using namespace dealii;

/// |b - A x| over |b|: far below any discretization error of interest.
constexpr double kResidual = 1e-10;
/// A vertex this part of a cell's diameter from a pin is the one meant.
constexpr double kAtVertex = 1e-6;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// deal.II wants a class where a function is meant.
template <int dim>
class BoundaryValues : public Function<dim> {
 public:
  explicit BoundaryValues(const BoundaryCondition<dim>& condition)
      : Function<dim>(dim), condition_(condition) {}
  void vector_value(const Point<dim>& p, dealii::Vector<double>& values) const override {
    const fe::Vector<dim> u =
        condition_.displacement ? condition_.displacement(p) : fe::Vector<dim>();
    for (int d = 0; d < dim; ++d) values(d) = u[d];
  }

 private:
  const BoundaryCondition<dim>& condition_;
};

/// Recognizes cells that are scaled copies of an earlier one: their stiffness is that one's times
/// the size to the power dim - 2.
template <int dim>
class SimilarCells {
 public:
  /// The size relative to the cell whose matrix is to be reused; 0: this one is to be integrated,
  /// and is what later cells are compared with.
  template <typename Cell>
  double operator()(const Cell& cell) {
    std::array<Tensor<1, dim>, GeometryInfo<dim>::vertices_per_cell> shape;
    for (const unsigned int v : cell.vertex_indices()) shape[v] = cell.vertex(v) - cell.vertex(0);
    const double size = shape.back().norm();
    bool same = reference_size_ > 0;
    for (unsigned int v = 0; same && v < shape.size(); ++v)
      same = (shape[v] / size - reference_[v]).norm() < kSameShape;
    if (same) return size / reference_size_;
    for (unsigned int v = 0; v < shape.size(); ++v) reference_[v] = shape[v] / size;
    reference_size_ = size;
    return 0;
  }

 private:
  /// Part of the diagonal: round-off of coordinates, amplified for cells far smaller than the
  /// domain.
  static constexpr double kSameShape = 1e-10;
  std::array<Tensor<1, dim>, GeometryInfo<dim>::vertices_per_cell> reference_;
  double reference_size_ = 0;
};

/// Translations and rotations of the nodes, one column each: what the coarse levels must represent.
template <int dim>
std::unique_ptr<Epetra_MultiVector> rigid_motions(const Mapping<dim>& mapping,
                                                  const DoFHandler<dim>& dofs,
                                                  const TrilinosWrappers::SparseMatrix& matrix) {
  constexpr int rotations = dim == 2 ? 1 : 3;
  auto modes =
      std::make_unique<Epetra_MultiVector>(matrix.trilinos_matrix().DomainMap(), dim + rotations);
  const auto& element = dofs.get_fe();
  const Quadrature<dim> nodes(element.base_element(0).get_unit_support_points());
  FEValues<dim> values(mapping, element, nodes, update_quadrature_points);
  std::vector<types::global_dof_index> indices(element.n_dofs_per_cell());
  const auto& owned = dofs.locally_owned_dofs();
  for (const auto& cell : dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    values.reinit(cell);
    cell->get_dof_indices(indices);
    for (unsigned int i = 0; i < indices.size(); ++i) {
      if (!owned.is_element(indices[i])) continue;
      const auto row = static_cast<int>(owned.index_within_set(indices[i]));
      const auto [component, node] = element.system_to_component_index(i);
      const auto& p = values.quadrature_point(node);
      const int c = static_cast<int>(component);
      for (int d = 0; d < dim; ++d) (*modes)[d][row] = c == d ? 1. : 0.;
      if constexpr (dim == 2) {
        (*modes)[2][row] = c == 0 ? -p[1] : p[0];
      } else {
        for (int axis = 0; axis < 3; ++axis) {
          const int a = (axis + 1) % 3, b = (axis + 2) % 3;
          (*modes)[3 + axis][row] = c == a ? -p[b] : (c == b ? p[a] : 0.);
        }
      }
    }
  }
  return modes;
}

}  // namespace

template <int dim>
ElasticSolver<dim>::ElasticSolver(MPI_Comm comm, int degree, int max_iterations, std::string name)
    : comm_(comm),
      degree_(degree),
      max_iterations_(max_iterations),
      name_(std::move(name)),
      mesh_(comm),
      element_(FE_Q<dim>(degree), dim),
      stress_element_(FE_Q<dim>(degree), kStresses<dim>),
      dofs_(mesh_),
      stress_dofs_(mesh_) {}

template <int dim>
void ElasticSolver<dim>::pin(const ElasticProblem<dim>& problem) {
  if (problem.pins.empty()) return;
  for (const auto& cell : dofs_.active_cell_iterators()) {
    if (cell->is_artificial()) continue;
    for (const unsigned int v : cell->vertex_indices()) {
      for (const auto& [point, held] : problem.pins) {
        if (cell->vertex(v).distance(point) > kAtVertex * cell->diameter()) continue;
        for (int d = 0; d < dim; ++d)
          if (held[d]) constraints_.add_line(cell->vertex_dof_index(v, d));
      }
    }
  }
}

template <int dim>
void ElasticSolver<dim>::distribute(const ElasticProblem<dim>& problem) {
  dofs_.distribute_dofs(element_);
  // The components of a node side by side: the multigrid coarsens nodes, not single components.
  DoFRenumbering::support_point_wise(dofs_);
  owned_ = dofs_.locally_owned_dofs();
  DoFTools::extract_locally_relevant_dofs(dofs_, relevant_);
  constraints_.clear();
  constraints_.reinit(relevant_);
  DoFTools::make_hanging_node_constraints(dofs_, constraints_);
  for (const auto& [id, condition] : problem.boundaries) {
    ComponentMask mask(dim, false);
    for (int d = 0; d < dim; ++d) mask.set(d, condition.fixed[d]);
    if (mask.n_selected_components() == 0) continue;
    VectorTools::interpolate_boundary_values(mapping_, dofs_, id, BoundaryValues<dim>(condition),
                                             constraints_, mask);
  }
  pin(problem);
  constraints_.close();
}

template <int dim>
void ElasticSolver<dim>::assemble(const ElasticProblem<dim>& problem) {
  TrilinosWrappers::SparsityPattern pattern(owned_, owned_, relevant_, comm_);
  DoFTools::make_sparsity_pattern(dofs_, pattern, constraints_, false,
                                  Utilities::MPI::this_mpi_process(comm_));
  pattern.compress();
  matrix_.reinit(pattern);
  rhs_.reinit(owned_, comm_);

  const QGauss<dim> quadrature(degree_ + 1);
  // Boundary and body data are arbitrary functions: two points more than the elements need.
  const QGauss<dim> force_quadrature(degree_ + 3);
  const QGauss<dim - 1> face_quadrature(degree_ + 3);
  FEValues<dim> values(
      mapping_, element_, quadrature,
      update_gradients | update_JxW_values | (varies_ ? update_quadrature_points : update_default));
  FEValues<dim> force_values(
      mapping_, element_, force_quadrature,
      update_values | update_gradients | update_quadrature_points | update_JxW_values);
  FEFaceValues<dim> face_values(
      mapping_, element_, face_quadrature,
      update_values | update_quadrature_points | update_JxW_values | update_normal_vectors);

  const int n = static_cast<int>(element_.n_dofs_per_cell());
  const auto components = stress_components<dim>();
  // K = sum_q B^T D B with B the strain of each shape function in Voigt's order, shear doubled.
  Eigen::Matrix<double, kStresses<dim>, Eigen::Dynamic> strain(kStresses<dim>, n), stress = strain;
  Eigen::MatrixXd k(n, n);
  FullMatrix<double> cell_matrix(n, n);
  dealii::Vector<double> cell_rhs(n);
  std::vector<types::global_dof_index> indices(n);
  SimilarCells<dim> similar_size;

  for (const auto& cell : dofs_.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const double size = varies_ ? 0 : similar_size(*cell);
    if (size == 0) {
      values.reinit(cell);
      k.setZero();
      for (const unsigned int q : values.quadrature_point_indices()) {
        strain.setZero();
        for (int i = 0; i < n; ++i) {
          const int component = static_cast<int>(element_.system_to_component_index(i).first);
          const auto& gradient = values.shape_grad(i, q);
          for (int c = 0; c < kStresses<dim>; ++c) {
            const auto [a, b] = components[c];
            if (a == component) strain(c, i) += gradient[b];
            if (a != b && b == component) strain(c, i) += gradient[a];
          }
        }
        if (varies_)
          stress.noalias() = values.JxW(q) * varies_(values.quadrature_point(q)) * strain;
        else
          stress.noalias() = values.JxW(q) * stiffness_ * strain;
        k.noalias() += strain.transpose() * stress;
      }
    }
    const double scale = size == 0 ? 1 : std::pow(size, dim - 2);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) cell_matrix(i, j) = scale * k(i, j);

    cell_rhs = 0;
    if (problem.body_force || problem.initial_stress) force_values.reinit(cell);
    if (problem.body_force) {
      for (const unsigned int q : force_values.quadrature_point_indices()) {
        const auto f = problem.body_force(force_values.quadrature_point(q));
        for (int i = 0; i < n; ++i)
          cell_rhs(i) += f[element_.system_to_component_index(i).first] *
                         force_values.shape_value(i, q) * force_values.JxW(q);
      }
    }
    if (problem.initial_stress) {
      for (const unsigned int q : force_values.quadrature_point_indices()) {
        const auto s0 = problem.initial_stress(force_values.quadrature_point(q));
        // sigma_0 : grad v of a shape function is its component of sigma_0 times the gradient.
        for (int i = 0; i < n; ++i)
          cell_rhs(i) -= traction<dim>(s0, force_values.shape_grad(
                                               i, q))[element_.system_to_component_index(i).first] *
                         force_values.JxW(q);
      }
    }
    for (const auto& face : cell->face_iterators()) {
      if (!face->at_boundary()) continue;
      const auto found = problem.boundaries.find(face->boundary_id());
      if (found == problem.boundaries.end()) continue;
      const auto& spring = found->second.spring;
      const bool springs = spring.norm() > 0;
      if (!found->second.traction && !springs) continue;
      face_values.reinit(cell, face);
      for (const unsigned int q : face_values.quadrature_point_indices()) {
        if (!springs) break;
        for (int i = 0; i < n; ++i) {
          const auto component = element_.system_to_component_index(i).first;
          const double weighted =
              spring[component] * face_values.shape_value(i, q) * face_values.JxW(q);
          if (weighted == 0) continue;
          for (int j = 0; j < n; ++j)
            if (element_.system_to_component_index(j).first == component)
              cell_matrix(i, j) += weighted * face_values.shape_value(j, q);
        }
      }
      if (!found->second.traction) continue;
      for (const unsigned int q : face_values.quadrature_point_indices()) {
        const auto t =
            found->second.traction(face_values.quadrature_point(q), face_values.normal_vector(q));
        for (int i = 0; i < n; ++i)
          cell_rhs(i) += t[element_.system_to_component_index(i).first] *
                         face_values.shape_value(i, q) * face_values.JxW(q);
      }
    }
    cell->get_dof_indices(indices);
    constraints_.distribute_local_to_global(cell_matrix, cell_rhs, indices, matrix_, rhs_);
  }
  matrix_.compress(VectorOperation::add);
  rhs_.compress(VectorOperation::add);
}

template <int dim>
void ElasticSolver<dim>::solve_linear() {
  TrilinosWrappers::PreconditionAMG::AdditionalData data;
  data.elliptic = true;
  data.higher_order_elements = degree_ > 1;
  data.smoother_sweeps = 2;
  data.aggregation_threshold = 0;  // every coupling counts: regular grids have no weak ones
  Teuchos::ParameterList parameters;
  std::unique_ptr<Epetra_MultiVector> constant;
  data.set_parameters(parameters, constant, matrix_);
  const auto modes = rigid_motions(mapping_, dofs_, matrix_);
  parameters.set("PDE equations", dim);
  parameters.set("null space: type", "pre-computed");
  parameters.set("null space: dimension", modes->NumVectors());
  parameters.set("null space: vectors", modes->Values());
  // Solved directly; its dense factor costs the cube of this.
  parameters.set("coarse: max size", 400);

  TrilinosWrappers::MPI::Vector x(owned_, comm_);
  const double size = rhs_.l2_norm();
  SolverControl control(max_iterations_, kResidual * size);
  try {
    TrilinosWrappers::PreconditionAMG preconditioner;
    preconditioner.initialize(matrix_, parameters);
    PrimitiveVectorMemory<TrilinosWrappers::MPI::Vector> memory;
    SolverCG<TrilinosWrappers::MPI::Vector>(control, memory)
        .solve(matrix_, x, rhs_, preconditioner);
  } catch (const SolverControl::NoConvergence& failure) {
    throw ComputationFailed(fmt::format(
        "{}: conjugate gradients stopped after {} iterations at {:.1e} of the load, {:.0e} is "
        "asked; "
        "raise iterations, or lower nu or degree",
        name_, failure.last_step, failure.last_residual / (size > 0 ? size : 1), kResidual));
  }
  TrilinosWrappers::MPI::Vector residual(owned_, comm_);
  figures_["residual"] = size > 0 ? matrix_.residual(residual, x, rhs_) / size : 0;
  figures_["cg_iterations"] = control.last_step();
  constraints_.distribute(x);
  solution_.reinit(owned_, relevant_, comm_);
  solution_ = x;
}

template <int dim>
void ElasticSolver<dim>::solve(const ElasticProblem<dim>& problem) {
  stiffness_ =
      problem.stiffness ? *problem.stiffness : isotropic_stiffness<dim>(problem.E, problem.nu);
  varies_ = problem.stiffness_at;
  const double start = now();
  distribute(problem);
  assemble(problem);
  const double assembled = now();
  solve_linear();
  const double solved = now();
  recover_stress();
  figures_["unknowns"] = static_cast<double>(dofs_.n_dofs());
  figures_["cells"] = static_cast<double>(mesh_.n_global_active_cells());
  figures_["assemble_s"] += assembled - start;
  figures_["solve_s"] += solved - assembled;
  figures_["solves"] += 1;
}

template <int dim>
void ElasticSolver<dim>::refine_worst(double share, double most, const char* by,
                                      const std::function<double(const Point<dim>&)>& weight) {
  dealii::Vector<float> indicator(mesh_.n_active_cells());
  KellyErrorEstimator<dim>::estimate(mapping_, dofs_, QGauss<dim - 1>(degree_ + 1), {}, solution_,
                                     indicator);
  if (weight) {
    for (const auto& cell : mesh_.active_cell_iterators())
      if (cell->is_locally_owned())
        indicator(cell->active_cell_index()) *= static_cast<float>(weight(cell->center()));
  }
  parallel::distributed::GridRefinement::refine_and_coarsen_fixed_fraction(mesh_, indicator, share,
                                                                           0);
  double cut = 0;
  for (const auto& cell : mesh_.active_cell_iterators())
    if (cell->is_locally_owned() && cell->refine_flag_set()) ++cut;
  cut = dealii::Utilities::MPI::sum(cut, comm_);
  const auto cells = static_cast<double>(mesh_.n_global_active_cells());
  const double more = (1 << dim) - 1;
  require_unknowns(name_, static_cast<double>(dofs_.n_dofs()) * (1 + more * cut / cells), most, by);
  mesh_.execute_coarsening_and_refinement();
}

// The members that elastic_stress.cc defines are instantiated there.
template class ElasticSolver<2>;
template class ElasticSolver<3>;

}  // namespace grainfield::continuum::fe
