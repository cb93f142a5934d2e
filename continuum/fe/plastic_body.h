// The body that a PlasticSolver loads: cells with their laws and stresses, supports, nodes on the
// ground, and its equations  internal forces(displacement increment) = external forces  with their
// tangent. Internal to fe/.
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "continuum/fe/plastic_solver.h"
#include "continuum/fe/quadratic_triangles.h"
#include "continuum/plasticity/mohr_coulomb.h"

namespace grainfield::continuum::fe {

/// A node on the ground.
struct ContactNode {
  std::array<unsigned int, 2> unknowns;
  double length = 0;  ///< of the base that it stands for
  double gap = 0;     ///< vertical displacement of the ground's spring, below 0 under pressure
  double shear = 0;   ///< horizontal displacement of the spring, without what has slipped
  bool active = true;
};

/// xx, yy, xy of a stress.
inline Eigen::Vector3d in_plane(const plasticity::Vector4& s) { return {s[0], s[1], s[3]}; }

struct PlasticBody {
  /// As PlasticSolver's.
  PlasticBody(const TriangleMesh& mesh, const PlasticSolver::Material& material,
              const PlasticSolver::Supports& supports, const Ground& ground_,
              PlasticSettings settings_);

  /// One zero for each unknown.
  Eigen::VectorXd zeros() const;

  /// Fixed unknowns, and nodes on the ground with Simpson's weights along it.
  void find_supports(const PlasticSolver::Supports& supports);

  /// Unknowns that are solved for: not prescribed, and of a node of an active cell.
  void find_free();

  /// Nodal forces of tractions on the boundary, with Simpson's weights.
  Eigen::VectorXd forces_of(const PlasticSolver::Traction& traction) const;

  /// Nodal forces of forces per area, one for each cell; cells not active have none.
  Eigen::VectorXd forces_of(const std::vector<Eigen::Vector2d>& force) const;

  /// Elastic strain at point q of cell c if all that its nodes move by u were elastic.
  plasticity::Vector4 trial(std::size_t c, std::size_t q, const CellVector& u) const;
  /// Nodal forces of a stress at point q of cell c.
  CellVector forces_of(std::size_t c, std::size_t q, const plasticity::Vector4& stress) const;
  /// The cell's stiffness of a tangent at point q.
  CellMatrix stiffness_of(std::size_t c, std::size_t q, const plasticity::Matrix4& tangent) const;

  /// Stress and tangent at point q of cell c after the cell's nodes have moved by u.
  plasticity::Returned update(std::size_t c, std::size_t q, const CellVector& u) const;

  /// Internal forces less what the ground gives.
  Eigen::VectorXd internal(const Eigen::VectorXd& u) const;

  /// Assembles and factorizes the tangent at u, or with elastic cells; false: singular.
  bool factorize(const Eigen::VectorXd& u, bool elastic = false);

  /// Zero for the unknowns that are not solved for.
  void clear_held(Eigen::VectorXd& x) const;

  /// Spreads the prescribed values of u as elastic cells would: without that the cells at the
  /// border take the whole increment, and Newton starts far off.
  void elastic_guess(const Eigen::VectorXd& target, Eigen::VectorXd& u);

  /// Takes the increment u over into stresses, plastic strains, the ground's springs.
  void accept(const Eigen::VectorXd& u);

  /// Largest difference of the stress from what the material bears, in the heap and in friction on
  /// the ground, over the stress scale.
  double overstress() const;

  PlasticSettings settings;
  Ground ground;
  QuadraticTriangles grid;
  std::vector<plasticity::MohrCoulombLaw> laws;  ///< of the cells
  std::vector<bool> active, fixed, free;         ///< cells; unknowns
  std::vector<PointState> points;
  std::vector<ContactNode> contacts;
  Eigen::VectorXd displacement;
  std::vector<Eigen::Vector2d> body;  ///< force on each cell now
  Eigen::VectorXd surface;            ///< of the tractions, now
  double relaxed =
      1;  ///< t / (1 + t) of the present step of viscoplastic time; 1: rate-independent
};

}  // namespace grainfield::continuum::fe
