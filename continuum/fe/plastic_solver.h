// Elasto-plastic plane strain on triangles with quadratic displacements and three points of
// integration each, loaded in steps that are found as it goes. Internal to fe/; this header does
// without deal.II.
//
// In every load step the equations  sum_cells int B^T sigma(e_n + B du) dV = f  are solved for the
// displacement increment du by Newton's method with line search (newton.h), the consistent tangent
// and a sparse direct factorization (UMFPACK). Strains are small. A step that does not converge is
// halved; one that converges quickly is followed by a larger one.
#pragma once
#include <Eigen/Core>
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "continuum/fe/quadratic_triangles.h"
#include "continuum/plasticity/mohr_coulomb.h"

namespace grainfield::continuum::fe {

/// What holds a node of the boundary.
struct Support {
  std::array<bool, 2> fixed{};  ///< components whose displacement is prescribed
  bool contact = false;  ///< rests on the ground below by stiff springs with Coulomb friction
};

/// The ground under the nodes whose Support says contact: normal and tangential springs, the
/// tangential force limited by friction, no tension.
struct Ground {
  double stiffness = 0;  ///< of both springs per length, N/m^2 (2D)
  double friction = 0;   ///< Coulomb coefficient
};

struct PlasticSettings {
  std::string name = "plasticity";  ///< begins the messages of failures
  double force_scale = 1;           ///< a large residual of a node, N (2D: N/m)
  double tolerance = 1e-9;          ///< largest residual of a node over the force scale
  /// Where Newton's method stalls, at a corner of the yield surface, this residual will do.
  double stalled = 1e-5;
  int iterations = 25;          ///< most Newton iterations in a load step
  double first_step = 1;        ///< part of a stage's load that is tried first
  double least_step = 1e-3;     ///< a smaller one is given up
  double tangent_floor = 1e-9;  ///< of the elastic stiffness, added to the tangent alone
};

/// One converged load step.
struct LoadStep {
  int stage = 0;                ///< calls of load() before this one
  double load = 0;              ///< part of the stage's load reached
  std::vector<double> history;  ///< largest residual before each Newton iteration, and at the end
};

/// State at a point of integration.
struct PointState {
  Eigen::Vector2d position;
  double area = 0;  ///< that it stands for
  plasticity::Vector4 stress = plasticity::Vector4::Zero();
  plasticity::Vector4 elastic_strain = plasticity::Vector4::Zero();
  plasticity::Vector4 plastic_strain = plasticity::Vector4::Zero();
  double plastic_shear = 0;  ///< accumulated largest minus least principal plastic strain
  plasticity::Regime regime = plasticity::Regime::elastic;  ///< in the last load step
};

class PlasticSolver {
 public:
  using Supports = std::function<Support(const Eigen::Vector2d&)>;

  /// `supports` is asked at every node (corners and middles of edges) on the boundary of the mesh.
  PlasticSolver(const TriangleMesh& mesh, const plasticity::MohrCoulomb& material,
                const Supports& supports, const Ground& ground, PlasticSettings settings);
  ~PlasticSolver();

  /// Cells that take part from now on; those new come without stress and strain, whatever the
  /// displacement of their nodes so far. All take part at first.
  void activate(const std::vector<bool>& cells);

  /// Goes from the present load to this one along a straight line. `body_force` (N/m^3; 2D N/m^2)
  /// per cell; `displacement` of the prescribed components, added to what they are (none: zero).
  /// Throws ComputationFailed naming the last converged load.
  using Displacement = std::function<Eigen::Vector2d(const Eigen::Vector2d&)>;
  void load(const std::vector<Eigen::Vector2d>& body_force, const Displacement& displacement = {});

  /// Three points per cell, cell by cell; those of cells not active keep zero stress.
  const std::vector<PointState>& points() const;
  /// Per corner of the mesh: stress xx, yy, zz, xy recovered as the mean of the active cells'
  /// linear fields (nan without active cell).
  Eigen::MatrixXd corner_stress() const;
  /// Per corner of the mesh: displacement since its first cell was active.
  Eigen::MatrixXd corner_displacement() const;
  /// Force of the supports and the ground on the body, summed over the nodes where `where` holds.
  Eigen::Vector2d reaction(const std::function<bool(const Eigen::Vector2d&)>& where) const;
  const std::vector<LoadStep>& steps() const;
  int unknowns() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace grainfield::continuum::fe
