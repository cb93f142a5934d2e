// Elasto-plastic plane strain, or a body of revolution, on triangles with quadratic displacements
// and three points of integration each, loaded in steps that are found as it goes. Internal to fe/;
// this header does without deal.II.
//
// In every load step the equations  sum_cells int B^T sigma(e_n + B du) dV = f  are solved for the
// displacement increment du by Newton's method with line search (dem/newton), the consistent
// tangent and a direct factorization (nested_factors.h). Strains are small. A step that does not
// converge is halved; one that converges quickly is followed by a larger one.
//
// A short step that does not converge is taken in viscoplastic time (Duvaut and Lions 1972; as a
// solver Zienkiewicz and Cormeau 1974): the stress of a time step relaxes from the trial stress
// towards its return P,  sigma = (trial + t P(trial)) / (1 + t),  t the step over the time of
// relaxation, and so does the friction of the ground. Its tangent is regular for small t, whatever
// the flow. Under a constant load such steps go on, t growing as Newton allows, until nothing is
// left of the overstress |sigma - P(sigma)|: the end is a state of the rate-independent material,
// one of several where the flow is not associated. Overstress that stays means flow without rest.
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
  bool revolution = false;          ///< about x = 0, x >= 0 the radius; zz is round the axis
  double force_scale = 1;           ///< a large residual of a node, N (2D: N/m)
  double tolerance = 1e-9;          ///< largest residual of a node over the force scale
  /// Where Newton's method stalls, at a corner of the yield surface, this residual will do.
  double stalled = 1e-5;
  int iterations = 25;            ///< most Newton iterations in a load step
  double first_step = 1;          ///< part of a stage's load that is tried first
  double least_step = 1e-3;       ///< a smaller one is given up
  double tangent_floor = 1e-9;    ///< of the elastic stiffness, added to the tangent alone
  double stress_scale = 1;        ///< a large stress, N/m^2 (2D: N/m)
  double displacement_scale = 1;  ///< a large displacement, m
  /// A step that fails is taken in viscoplastic time when it is not longer than this part of the
  /// stage's load; 0: never.
  double viscous_step = 0.25;
  int viscous_steps = 150;  ///< most steps of viscoplastic time in a load step
  /// Most Newton iterations in a call of load(), failed steps and viscoplastic time included: a
  /// body that neither rests nor clearly slides is given up.
  int work = 1000;
  double overstress = 1e-7;  ///< over the stress scale, at which the material is at rest
  std::function<void(double)> progress = {};  ///< part of the stage's load, at every step
};

/// One converged load step.
struct LoadStep {
  int stage = 0;                ///< calls of load() before this one
  double load = 0;              ///< part of the stage's load reached
  std::vector<double> history;  ///< largest residual before each Newton iteration, and at the end
  int viscous_steps = 0;        ///< of viscoplastic time that it took; history is the last one's
  int iterations = 0;           ///< of Newton's method, in steps that failed as well
  double overstress = 0;        ///< left, over the stress scale
};

/// State at a point of integration.
struct PointState {
  Eigen::Vector2d position;
  double area = 0;  ///< that it stands for; of a body of revolution the volume
  plasticity::Vector4 stress = plasticity::Vector4::Zero();
  plasticity::Vector4 elastic_strain = plasticity::Vector4::Zero();
  plasticity::Vector4 plastic_strain = plasticity::Vector4::Zero();
  double plastic_shear = 0;  ///< accumulated largest minus least principal plastic strain
  plasticity::Regime regime = plasticity::Regime::elastic;  ///< in the last load step
};

class PlasticSolver {
 public:
  using Supports = std::function<Support(const Eigen::Vector2d&)>;
  using Material = std::function<plasticity::MohrCoulomb(const Eigen::Vector2d&)>;

  /// `material` is asked at the centre of every cell, `supports` at every node (corners and middles
  /// of edges) on the boundary of the mesh.
  PlasticSolver(const TriangleMesh& mesh, const Material& material, const Supports& supports,
                const Ground& ground, PlasticSettings settings);
  ~PlasticSolver();

  /// Cells that take part from now on; those new come without stress and strain, whatever the
  /// displacement of their nodes so far. All take part at first.
  void activate(const std::vector<bool>& cells);

  /// Goes from the present load to this one along a straight line. `body_force` (N/m^3; 2D N/m^2)
  /// per cell; `displacement` of the prescribed components, added to what they are (none: zero);
  /// `traction` at the middle of every edge of the boundary (none: as it is). Throws
  /// ComputationFailed naming the last converged load.
  using Displacement = std::function<Eigen::Vector2d(const Eigen::Vector2d&)>;
  using Traction = std::function<Eigen::Vector2d(const Eigen::Vector2d&)>;
  void load(const std::vector<Eigen::Vector2d>& body_force, const Displacement& displacement = {},
            const Traction& traction = {});

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
