// A heap of Mohr-Coulomb material under its own weight, solved by finite elements: plane strain,
// triangular outline with slopes left_deg and right_deg, apex at (0, 0), base y = -height, on a
// rough, frictional or smooth ground. Or a cone with the slope right_deg: a body of revolution
// about x = 0, of which the right half is solved; x is the radius, zz round the axis.
//
// Cohesionless material at its angle of repose has no strength to spare: a cohesion of the stated
// part of rho g h keeps the equations solvable, and is to be taken to zero by the user (all the
// stresses scale with rho g h, so only cohesion/(rho g h) and E/(rho g h) matter, the latter
// hardly).
#pragma once
#include <Eigen/Core>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "continuum/fe/plastic_solver.h"
#include "continuum/model.h"
#include "continuum/size.h"

namespace grainfield::continuum {

enum class WedgeBase { rough, frictional, smooth };

/// How the weight comes onto the heap.
enum class WedgeHistory {
  at_once,  ///< gravity is raised on the whole heap, in `steps` steps
  rise,     ///< horizontal layers are laid one on another
  grow      ///< similar heaps on the final base: layers along the slopes, as from a source above
};

struct WedgeProblem {
  bool cone = false;                     ///< left_deg does not count
  double left_deg = 28, right_deg = 28;  ///< slopes, above 0, at most the friction angle + cohesion
  double height = 1;                     ///< of the apex above the base, m
  double rho_g = 1;                      ///< weight per volume, N/m^3 (2D: N/m^2)
  double young = 1000, poisson = 0.3;    ///< young in units of rho g h
  double friction_deg = 28, dilation_deg = 0;
  double cohesion = 1e-3;  ///< in units of rho g h
  WedgeBase base = WedgeBase::rough;
  double base_friction_deg = 28;  ///< of a frictional base
  double base_stiffness = 100;    ///< of its springs, in units of young/h
  WedgeHistory history = WedgeHistory::at_once;
  int steps = 1;   ///< at_once: equal steps of gravity; layers: steps for the weight of each
  int layers = 8;  ///< of rise and grow
  /// Triangles along each side of the heap. Mesh lines lie between layers: a multiple of them, of
  /// twice as many where equal slopes grow.
  int cells = 32;
  /// Adaptive refinement: so many times the triangles with the largest estimated errors of stress,
  /// which hold `refine_share` of the sum of squares, are cut, and the heap is laid anew.
  int refinements = 0;
  double most_unknowns = kMostUnknowns;  ///< that refinement may come to
  double refine_share = 0.5;
  /// Measured Young's modulus (N/m^2; 2D N/m) and Poisson's ratio at a place in place of young and
  /// poisson; empty: those. The springs of the ground go by young all the same.
  std::function<Eigen::Vector2d(const Eigen::Vector2d&)> elasticity;
  double viscous_step = 0.25;  ///< PlasticSettings::viscous_step
  int work = 1000;             ///< PlasticSettings::work, for the heap's or a layer's weight
  double tolerance = 1e-9;
  int iterations = 25;
};

struct WedgeResult {
  WedgeProblem problem;
  fe::TriangleMesh mesh;
  Eigen::MatrixXd stress;              ///< per corner: xx, yy, zz, xy, tension positive
  Eigen::MatrixXd displacement;        ///< per corner: x, y since the corner was laid
  std::vector<fe::PointState> points;  ///< three per triangle
  std::vector<fe::LoadStep> steps;     ///< with each step's Newton history
  double weight = 0;                   ///< of the heap
  /// Each triangle's 2-norm over its area of the stress minus the recovered, continuous one
  /// (Zienkiewicz and Zhu 1987); and all of them over the 2-norm of the stress.
  std::vector<double> errors;
  double relative_error = 0;
  /// Parts into which each triangle of the lattice was cut.
  std::vector<std::vector<int>> pieces;
  /// Force of the ground on the heap; a cone's radial forces are summed without regard to
  /// direction.
  Eigen::Vector2d base_force = Eigen::Vector2d::Zero();
  int unknowns = 0;

  /// Index of the triangle that holds the point; -1 outside.
  int triangle_at(const Eigen::Vector2d& point) const;
  /// Stress xx, yy, zz, xy at a point, linear between the corners; nan outside.
  plasticity::Vector4 stress_at(const Eigen::Vector2d& point) const;
  Eigen::Vector2d displacement_at(const Eigen::Vector2d& point) const;
  /// Mobilized part of the strength, (s1 - s3) / (2 c cos phi - (s1 + s3) sin phi): 1 at the limit,
  /// the cone's tip included; nan outside.
  double mobilized_at(const Eigen::Vector2d& point) const;
};

/// The boundary between the plastic flanks and the elastic core: seen from the slopes, at each
/// depth the first place where the friction is no longer mobilized. Inside, about the axis, the
/// heap may yield again (Cantelaube's branches with a yield line there).
struct WedgeCore {
  std::vector<double> depth, left, right;  ///< boundary's x <= 0 and >= 0; nan: all at the limit
  /// Share of the depths and sides that have a boundary; a cone has the right side alone.
  double share = 0;
  double axis_mobilized = 0;  ///< mobilized friction on the axis, mean over the depths
  /// Angle from the vertical, in degrees, of the line from the apex that has half of the boundary
  /// on either side (Cantelaube's beta_hat): the arc tangent of the median of |x|/depth. Misfit:
  /// the median distance from it in |x|/depth; large, there is no such line. Both nan where fewer
  /// than half of the depths have a boundary.
  double left_deg = 0, right_deg = 0, left_misfit = 0, right_misfit = 0;
};

/// Throws BadParameter naming the value found and what is allowed.
void check_wedge(const WedgeProblem& problem);

/// The problem of complete settings of fe_mohr_coulomb_wedge and fe_cone. Throws as check_wedge.
WedgeProblem heap_problem(const Settings& settings, bool cone);
/// Figures of the solution that both have.
std::map<std::string, double> heap_figures(const WedgeResult& result, const WedgeCore& core);

/// Share of a triangle's points that yielded last, and means of their plastic strains.
struct CellMeans {
  double plastic = 0, shear = 0, volume = 0;
};
CellMeans cell_means(const WedgeResult& result, int triangle);

/// Throws BadParameter, or ComputationFailed naming the last converged load and what to try.
WedgeResult solve_wedge(const WedgeProblem& problem);

/// `mobilized`: part of the sine of the friction angle beyond which a place counts as plastic.
/// Between 0.3 and 0.9 of the height: above there are too few cells, below the base holds the
/// material.
WedgeCore wedge_core(const WedgeResult& result, double mobilized = 0.99);

}  // namespace grainfield::continuum
