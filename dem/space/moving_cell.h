// The cell as the engine carries it: edges that move, images of places, and the flow of the space.
//
// The flow.  At a place x the space moves at G (x - low), G = edges' edges^-1. With a constant
// velocity gradient L, whatever moves with the flow obeys x'' = L^2 (x - low). All bodies get this
// acceleration beside that of their forces, so that a grain and its image feel the same and it does
// not matter which of the two is carried: for the fluctuation u = v - L (x - low),
//   u' = F/m - L u                         (SLLOD; Evans and Morriss 2008, section 6.2)
// In simple shear L^2 = 0, and these are the boundaries of Lees and Edwards (1972).
//
// In steps.  Edges and bodies take the same steps (half a kick of L^2 x, drift, half a kick), so
// that places x = edges s of fixed s stay the engine's own affine motion to round-off; it is that
// of exp(L t) exactly in simple shear and to second order in the time step otherwise.
//
// Which edges.  The same images have many cells. reduce() takes away whole edges from others where
// that makes the cell less slanting: simple shear turns over from tilt 1/2 to -1/2.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "dem/space/cell.h"
#include "dem/space/space.h"

namespace grainfield::dem {

/// Which image: whole edges, by axis; of grains that are near each other.
using PairImage = std::array<std::int8_t, 4>;
/// Not the thing itself but an image of it.
inline bool is_image(const PairImage& image) { return std::bit_cast<std::uint32_t>(image) != 0; }
inline PairImage opposite(const PairImage& n) {
  const auto turned = [](std::int8_t k) { return static_cast<std::int8_t>(-k); };
  return {turned(n[0]), turned(n[1]), turned(n[2]), 0};
}

/// The shortest way from a place to its own image is at least this many radii of the largest grain:
/// then no two grains can touch by two images, and no grain itself.
inline constexpr double kLeastCell = 4.2;
/// Images further away than this many edges are not looked for.
inline constexpr double kFarthest = 100;
/// Strain per step at most.
inline constexpr double kMostStrainPerStep = 1e-2;

/// Throws std::invalid_argument naming cell.periodic, cell.low, cell.edges or
/// cell.velocity_gradient when the cell is none in D dimensions: numbers that are not finite, edges
/// that lie in one plane or line, a flow without or across the periodic edges, or faster than
/// kMostStrainPerStep.
void check_cell(const Cell<3>& cell, int dim, double time_step);

template <int D>
class MovingCell {
 public:
  using Vector = PlainVector<D>;
  using Matrix = typename Cell<D>::Matrix;
  using Counts = std::array<int, D>;  ///< whole edges, by axis

  MovingCell() = default;
  /// Moves a cell that check_cell has passed; `time_step`, s.
  MovingCell(const Cell<3>& cell, double time_step);

  bool is_periodic() const { return periodic_; }
  bool flows() const { return flows_; }
  const Matrix& edges() const { return state_.edges; }
  /// In the words of a snapshot.
  Cell<3> told() const;

  // -- images

  template <class Image>
  Vector shift(const Image& n) const {
    return whole(state_.edges, n);
  }
  /// How much faster the image moves, m/s.
  template <class Image>
  Vector drift(const Image& n) const {
    return whole(state_.rates, n);
  }
  /// In which copy of the cell a place lies: place - shift(home(place)) is within. 0 along axes
  /// that do not repeat, and for what is not finite.
  Counts home(const Vector& place) const;
  /// The image of `other` nearest to `place`, when it is nearer than half of shortest(); else near.
  PairImage nearest(const Vector& place, const Vector& other) const;
  /// visit(n) for all images n != 0 of a place that lie within `reach` of the cell's faces.
  template <class Visit>
  void visit_images(const Vector& place, double reach, Visit visit) const;
  /// Whether the image counts as forward, one of two opposite ones.
  static bool is_forward(const PairImage& n) {
    for (int a = 0; a < D; ++a) {
      if (n[a] != 0) return n[a] > 0;
    }
    return false;
  }
  /// The shortest way from a place to an image of it, m; infinite without a periodic axis.
  double shortest() const { return state_.shortest; }
  /// Axis `to` has lost `times` edges of axis `from`.
  struct Exchange {
    int to = 0, from = 0, times = 0;
  };
  /// Less slanting edges of the same images, and what was done to them.
  std::vector<Exchange> reduce();

  // -- flow

  /// Velocity of the space, m/s; 0 without flow.
  Vector flow_at(const Vector& place) const {
    return flows_ ? Vector(flow_ * (place - state_.low)) : Vector::Zero();
  }
  /// Change of the flow along a way: G way.
  Vector flow_of(const Vector& way) const { return flow_ * way; }
  /// Half a step of the acceleration that goes with the flow, m/s.
  Vector kick(const Vector& place) const { return half_kick_ * (place - state_.low); }
  /// From now on. Bodies have to change their speed by change_of_flow(place).
  void set_gradient(const Matrix& gradient);
  Vector change_of_flow(const Matrix& gradient, const Vector& place) const {
    return gradient * (place - state_.low) - flow_at(place);
  }

  /// To the next step's places, by which bodies have been moved already.
  void advance();
  /// Ends the last step.
  void finish();
  /// A search has been made: strain counts from here.
  void set_listed();
  /// What carried() and strain() tell: of the places of the step after the present one.
  void look_ahead();
  /// Where the flow takes a place of the last search, until the next step.
  Vector carried(const Vector& place) const { return state_.low + ahead_ * (place - state_.low); }
  /// By how much the flow changes a distance since the last search, at most, as a share of it.
  double strain() const { return strain_; }

  template <class Self, class Each>
  static void visit(Self& self, Each each) {
    each(self.state_);
  }
  /// After the state has been read: false when it is none.
  bool settle();

 private:
  struct State {
    PlainVector<D> low = PlainVector<D>::Zero();
    Matrix edges = Matrix::Identity();   // also unit vectors across the periodic edges
    Matrix rates = Matrix::Zero();       // of the edges, m/s
    Matrix gradient = Matrix::Zero();    // L
    Matrix listed = Matrix::Identity();  // edges at the last search, inverted
    double shortest = std::numeric_limits<double>::infinity();  // way across the cell then, m
    double pad = 0;
  };
  template <class Image>
  Vector whole(const Matrix& columns, const Image& n) const {
    Vector sum = static_cast<double>(n[0]) * columns.col(0);
    for (int a = 1; a < D; ++a) sum += static_cast<double>(n[a]) * columns.col(a);
    return sum;
  }
  /// Shares of the edges.
  Vector shares(const Vector& way) const { return inverse_ * way; }
  void derive();
  /// Calls visit(n) for all whole n with low <= n <= high.
  template <class Visit>
  static void count(const std::array<int, D>& low, const std::array<int, D>& high, Visit visit);

  std::array<bool, D> axes_{};
  bool periodic_ = false, flows_ = false, in_step_ = false;
  double time_step_ = 0;
  State state_;
  // All that follows from the state.
  Matrix inverse_ = Matrix::Identity();  // of the edges
  Matrix flow_ = Matrix::Zero();         // G
  Matrix half_kick_ = Matrix::Zero();
  Matrix ahead_ = Matrix::Identity();
  double strain_ = 0;
  Vector per_width_ = Vector::Zero();  // 1 / distance between opposite faces, 1/m
};

template <int D>
template <class Visit>
void MovingCell<D>::count(const std::array<int, D>& low, const std::array<int, D>& high,
                          Visit visit) {
  for (int a = 0; a < D; ++a) {
    if (low[a] > high[a]) return;
  }
  std::array<int, D> at = low;
  while (true) {
    PairImage n{};
    for (int a = 0; a < D; ++a) n[a] = static_cast<std::int8_t>(at[a]);
    visit(n);
    int axis = 0;
    for (; axis < D && at[axis] == high[axis]; ++axis) at[axis] = low[axis];
    if (axis == D) return;
    ++at[axis];
  }
}

template <int D>
template <class Visit>
void MovingCell<D>::visit_images(const Vector& place, double reach, Visit visit) const {
  const Vector s = shares(place - state_.low);
  if (!s.allFinite()) return;
  std::array<int, D> low{}, high{};
  for (int a = 0; a < D; ++a) {
    if (!axes_[a]) continue;
    const double band = reach * per_width_[a];
    low[a] = static_cast<int>(std::clamp(std::ceil(-band - s[a]), -kFarthest, kFarthest));
    high[a] = static_cast<int>(std::clamp(std::floor(1 + band - s[a]), -kFarthest, kFarthest));
  }
  count(low, high, [&](const PairImage& n) {
    if (is_image(n)) visit(n);
  });
}

extern template class MovingCell<2>;
extern template class MovingCell<3>;

}  // namespace grainfield::dem
