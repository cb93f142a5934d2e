// Direct solution of equations assembled from cells in the plane by nested dissection: the cells
// are halved again and again where few unknowns are in cells on both sides, an unknown is
// eliminated in the smallest part that holds all its cells, and the unknowns of a part are a small
// dense matrix, its front (George 1973; multifrontal method: Duff and Reid 1983). What depends on
// the mesh alone is found once. Internal to fe/; without deal.II.
//
// The dense products are Eigen's, in pieces whose sums do not depend on the processor's caches: the
// same bits everywhere. Rows are exchanged inside a front alone: what that costs of accuracy is for
// the caller to refine, and a regular matrix is refused where a part has no pivot of its own, which
// the stiffness of a body always has.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace grainfield::continuum::fe {

/// An entry beside the cells' matrices; row and column are unknowns of one cell.
struct NestedEntry {
  unsigned int row, column;
  double value;
};

/// Scalar: of the fronts, float or double; unknowns and matrices are double.
template <typename Scalar>
class NestedFactors {
 public:
  /// Unknowns of each cell, each of them once, and its corners' mean; every unknown is in a cell.
  NestedFactors(std::vector<std::vector<unsigned int>> cells, std::vector<Eigen::Vector2d> centres,
                std::size_t unknowns);

  /// Factorizes the sum of the cells' matrices (each by rows, cell after cell) and the entries.
  /// False: a pivot is zero or not a number, among the rows of its front.
  bool factorize(const std::vector<double>& matrices, const std::vector<NestedEntry>& entries);
  /// In place, with the last factors.
  void solve(Eigen::VectorXd& x) const;

 private:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  struct Front {
    std::size_t begin = 0, end = 0;      ///< its cells in order_
    std::array<int, 2> parts{-1, -1};    ///< fronts inside it; a leaf has none
    std::vector<unsigned int> unknowns;  ///< own ones, eliminated here, then the rest
    Eigen::Index own = 0;                ///< how many are eliminated here
    std::vector<Eigen::Index> into;      ///< places of the rest in the outer front
    std::vector<std::size_t> entries;    ///< of the present factorization
    std::vector<Eigen::Index> exchange;  ///< row that each own one was exchanged with
    Matrix columns, rows;                ///< factors: own columns, own rows of the rest
  };
  using Sharing = std::pair<unsigned int, int>;  ///< unknown; its cells inside a part

  int split(std::size_t begin, std::size_t end);
  std::size_t cut(std::size_t begin, std::size_t end);
  void find_unknowns();
  void find_places();
  static bool eliminate(Front& front, Matrix& whole);

  std::vector<std::vector<unsigned int>> cells_;
  std::vector<Eigen::Vector2d> centres_;      ///< in units of the cells' mean extents
  std::vector<std::size_t> order_, offsets_;  ///< cells by parts; where matrices begin
  std::vector<int> inside_, left_;            ///< per unknown: cells of a part, and to come
  double scale_ = 1;                   ///< of the matrix in the fronts, whose largest entry is 1
  std::vector<Front> fronts_;          ///< inner ones first
  std::vector<std::size_t> front_of_;  ///< of each unknown
  std::vector<std::vector<Eigen::Index>> places_;  ///< of each cell's unknowns in its leaf
};

}  // namespace grainfield::continuum::fe
