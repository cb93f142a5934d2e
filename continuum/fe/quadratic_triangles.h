// Quadratic displacements on triangles with straight edges: strains, nodal weights, boundary edges,
// and the matrix with its direct factorization. What plasticity needs of deal.II, behind a header
// that does without it. Internal to fe/.
//
// Plane strain, or a body of revolution about x = 0, of which the triangles are a half section,
// x the radius: an area then stands for the ring it makes, 2 pi x times itself, and there is a
// strain round the axis.
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

namespace grainfield::continuum::fe {

template <typename Scalar>
class NestedFactors;

/// Triangles of straight edges, corners counter-clockwise.
struct TriangleMesh {
  std::vector<Eigen::Vector2d> vertices;
  std::vector<std::array<int, 3>> triangles;
};

/// A triangle cut by lines along its sides into n^2 similar ones. Row r from the base (left, right)
/// to the apex, i from the left: corner (r, i) has index r (n + 1) - r (r - 1) / 2 + i; row r's
/// triangles begin at r (2 n - r) and alternate, the first one upright.
TriangleMesh triangle_lattice(const Eigen::Vector2d& left, const Eigen::Vector2d& right,
                              const Eigen::Vector2d& apex, int n);

/// Points of integration, nodes and unknowns of a cell. Three points integrate products of two
/// linear functions exactly: elastic cells are not underintegrated, plastic ones hardly lock.
inline constexpr int kPoints = 3, kNodes = 6, kUnknowns = 2 * kNodes;
using CellVector = Eigen::Matrix<double, kUnknowns, 1>;
using CellMatrix = Eigen::Matrix<double, kUnknowns, kUnknowns, Eigen::RowMajor>;

struct QuadraticCell {
  std::array<unsigned int, kUnknowns> unknowns;  ///< their numbers in the whole problem
  std::array<int, 3> corners;                    ///< vertices of the mesh
  std::array<Eigen::Vector2d, kPoints> points;
  std::array<double, kPoints> areas;  ///< of a body of revolution: volumes
  /// xx, yy and engineering xy strain at a point from the cell's displacements.
  std::array<Eigen::Matrix<double, 3, kUnknowns>, kPoints> strain;
  /// Strain across the section, u_x/x of a body of revolution; in the plane 0.
  std::array<Eigen::Matrix<double, 1, kUnknowns>, kPoints> hoop;
  Eigen::Matrix<double, kUnknowns, 2> weight;  ///< nodal forces of a unit body force along x, y

  CellVector gather(const Eigen::VectorXd& u) const;
  void scatter(const CellVector& f, Eigen::VectorXd& out) const;
};

/// An edge of the boundary: both ends, then the middle.
struct BoundaryEdge {
  std::array<std::array<unsigned int, 2>, 3> unknowns;  ///< x and y of the three nodes
  Eigen::Vector2d middle;
  double length = 0;
};

class QuadraticTriangles {
 public:
  /// The mesh of a body of revolution has x >= 0.
  explicit QuadraticTriangles(const TriangleMesh& mesh, bool revolution = false);
  ~QuadraticTriangles();

  std::vector<QuadraticCell> cells;  ///< in the order of the mesh's triangles
  std::vector<BoundaryEdge> edges;
  std::vector<Eigen::Vector2d> positions;                    ///< of each unknown's node
  std::vector<unsigned int> components;                      ///< of each unknown: 0 x, 1 y
  std::vector<std::array<unsigned int, 2>> corner_unknowns;  ///< x and y of each vertex

  std::size_t unknowns() const { return positions.size(); }
  /// Part of an edge (of a body of revolution: of its ring) that a node of it stands for: Simpson's
  /// weights, exact for a linear pressure.
  double share(const BoundaryEdge& edge, std::size_t node) const;
  void clear_matrix();
  /// Adds a cell's matrix to the rows and columns of unknowns that are free.
  void add(const QuadraticCell& cell, const CellMatrix& values, const std::vector<bool>& free);
  void add(unsigned int row, unsigned int column, double value);
  /// By nested dissection (nested_factors.h), in single precision where that is enough. False:
  /// singular, or a part of the cells has no pivot of its own.
  bool factorize();
  /// In place, refined with the matrix as it is. Factorizes in double precision where the single
  /// one does not come near; nan where that finds no pivot, or where x is not finite.
  void solve(Eigen::VectorXd& x) const;
  /// The matrix times x.
  Eigen::VectorXd product(const Eigen::VectorXd& x) const;

 private:
  struct Impl;
  template <typename Scalar>
  NestedFactors<Scalar> dissect() const;
  bool factorize_exactly() const;

  std::unique_ptr<Impl> impl_;
  bool revolution_;
};

}  // namespace grainfield::continuum::fe
