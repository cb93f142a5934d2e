// Linear elasticity on distributed adaptive meshes of quadrilaterals or hexahedra, isotropic or
// not, uniform or not; the same code in 2D (plane strain) and 3D. Internal to fe/: needs deal.II.
//
// div sigma + f = 0, sigma = C eps + sigma_0, continuous elements of any degree. The
// assembled matrix is solved by conjugate gradients, preconditioned by smoothed-aggregation
// algebraic multigrid (Trilinos ML) that knows the rigid motions: iterations, and with them the
// time per unknown, hardly grow with the mesh.
#pragma once
#include <deal.II/base/function.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

#include <Eigen/Core>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace grainfield::continuum::fe {

template <int dim>
using Vector = dealii::Tensor<1, dim>;
/// Components of a symmetric stress: xx, yy, xy or xx, yy, zz, yz, xz, xy.
template <int dim>
inline constexpr int kStresses = dim*(dim + 1) / 2;
template <int dim>
using Stress = dealii::Tensor<1, kStresses<dim>>;
/// Row and column of each stored component.
template <int dim>
constexpr std::array<std::pair<int, int>, kStresses<dim>> stress_components() {
  if constexpr (dim == 2)
    return {{{0, 0}, {1, 1}, {0, 1}}};
  else
    return {{{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};
}
/// C: stored stress of the strains xx, yy, 2 xy (3D likewise in the order of Stress).
template <int dim>
using Stiffness = Eigen::Matrix<double, kStresses<dim>, kStresses<dim>>;
/// lambda tr(eps) I + 2 G eps of Young's modulus and Poisson's ratio.
template <int dim>
Stiffness<dim> isotropic_stiffness(double E, double nu);
/// The traction of a stress on a surface.
template <int dim>
Vector<dim> traction(const Stress<dim>& stress, const Vector<dim>& normal);

/// What holds on one part of the boundary (a face of the box).
template <int dim>
struct BoundaryCondition {
  std::array<bool, dim> fixed{};  ///< components of the displacement that are given
  /// Their values; none = 0.
  std::function<Vector<dim>(const dealii::Point<dim>&)> displacement = {};
  /// Traction of the components that are not fixed, with an initial stress that of the whole
  /// stress; none = free.
  std::function<Vector<dim>(const dealii::Point<dim>&, const Vector<dim>& normal)> traction = {};
  /// Springs under the components that are not fixed: traction -spring u more, N/m3.
  Vector<dim> spring = {};
};

template <int dim>
struct ElasticProblem {
  double E = 1, nu = 0.3;
  std::map<dealii::types::boundary_id, BoundaryCondition<dim>> boundaries = {};
  std::function<Vector<dim>(const dealii::Point<dim>&)> body_force = {};
  /// Instead of E and nu: the same everywhere, or from place to place.
  std::optional<Stiffness<dim>> stiffness = {};
  std::function<Stiffness<dim>(const dealii::Point<dim>&)> stiffness_at = {};
  /// sigma_0; not part of the stress that the solver returns.
  std::function<Stress<dim>(const dealii::Point<dim>&)> initial_stress = {};
  /// Vertices of the mesh of which these components are held at 0, against rigid motions.
  std::vector<std::pair<dealii::Point<dim>, std::array<bool, dim>>> pins = {};
};

template <int dim>
class ElasticSolver {
 public:
  /// `name` begins the messages of failures.
  ElasticSolver(MPI_Comm comm, int degree, int max_iterations, std::string name);

  dealii::parallel::distributed::Triangulation<dim>& mesh() { return mesh_; }
  /// Assembles and solves on the present mesh, recovers the stress C eps. Throws ComputationFailed.
  void solve(const ElasticProblem<dim>& problem);
  /// Refines the cells that carry `share` of the jumps of the gradient (Kelly et al. 1983), each
  /// weighted by the function at the cell's centre. Throws ComputationFailed, naming most_unknowns
  /// and `by`, the parameter that asks for it, before the mesh has more than `most` unknowns.
  void refine_worst(double share, double most, const char* by,
                    const std::function<double(const dealii::Point<dim>&)>& weight = {});
  /// Recovered stress at points inside the mesh, one row each; the same on every rank.
  Eigen::MatrixXd stress_at(const std::vector<dealii::Point<dim>>& points) const;
  /// L2 norms of the errors of displacement, stress and recovered stress.
  std::array<double, 3> errors(
      const std::function<Vector<dim>(const dealii::Point<dim>&)>& displacement,
      const std::function<Stress<dim>(const dealii::Point<dim>&)>& stress) const;
  const std::map<std::string, double>& figures() const { return figures_; }

 private:
  void distribute(const ElasticProblem<dim>& problem);
  void assemble(const ElasticProblem<dim>& problem);
  void solve_linear();
  void recover_stress();
  void pin(const ElasticProblem<dim>& problem);
  Stiffness<dim> stiffness_at(const dealii::Point<dim>& point) const {
    return varies_ ? varies_(point) : stiffness_;
  }

  MPI_Comm comm_;
  int degree_, max_iterations_;
  std::string name_;
  Stiffness<dim> stiffness_;
  std::function<Stiffness<dim>(const dealii::Point<dim>&)> varies_;
  dealii::MappingQ1<dim> mapping_;
  dealii::parallel::distributed::Triangulation<dim> mesh_;
  dealii::FESystem<dim> element_, stress_element_;
  dealii::DoFHandler<dim> dofs_, stress_dofs_;
  dealii::IndexSet owned_, relevant_;
  dealii::AffineConstraints<double> constraints_;
  dealii::TrilinosWrappers::SparseMatrix matrix_;
  dealii::TrilinosWrappers::MPI::Vector rhs_, solution_;
  dealii::LinearAlgebra::distributed::Vector<double> stress_;
  std::map<std::string, double> figures_;
};

}  // namespace grainfield::continuum::fe
