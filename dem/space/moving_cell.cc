#include "dem/space/moving_cell.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "dem/shared/refuse.h"

namespace grainfield::dem {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
// Edges whose volume is a smaller share of the product of their lengths are taken for degenerate.
constexpr double kLeastVolumeShare = 1e-6;
// Round-off of what a user writes as 0 or as perpendicular, relative.
constexpr double kRoundOff = 1e-9;
// A tilt is turned over beyond one half by more than this, so that no two searches do it in turn.
constexpr double kTilt = 0.5 + 1e-9;
constexpr int kMostRounds = 1000;

int whole_number(double value) { return static_cast<int>(std::clamp(value, -1e9, 1e9)); }

/// Takes whole columns `b` from columns `a` until no column is shorter without. `scaled`: the
/// columns as their lengths are measured; what is done to them is done to `each` as well.
template <class Columns, class Each>
void shorten(Columns& scaled, const std::vector<int>& axes, Each each) {
  bool changed = true;
  for (int round = 0; changed && round < kMostRounds; ++round) {
    changed = false;
    for (const int a : axes) {
      for (const int b : axes) {
        if (a == b) continue;
        const double tilt = scaled.col(a).dot(scaled.col(b)) / scaled.col(b).squaredNorm();
        if (!(std::fabs(tilt) > kTilt) || !(std::fabs(tilt) < 1e9)) continue;
        const int times = static_cast<int>(std::lround(tilt));
        scaled.col(a) -= times * scaled.col(b);
        each(a, b, times);
        changed = true;
      }
    }
  }
}

/// Length of the shortest sum of whole columns but 0.
template <class Columns>
double shortest_of(Columns columns, const std::vector<int>& axes) {
  if (axes.empty()) return kInf;
  double least = kInf;
  for (int round = 0; round < kMostRounds; ++round) {
    shorten(columns, axes, [](int, int, int) {});
    // In three dimensions pairs may leave a sum of all three that is shorter than the longest.
    int longest = axes.front();
    for (const int a : axes) {
      if (columns.col(a).squaredNorm() > columns.col(longest).squaredNorm()) longest = a;
      least = std::min(least, columns.col(a).norm());
    }
    if (axes.size() < 3) return least;
    bool changed = false;
    for (int signs = 0; signs < 4 && !changed; ++signs) {
      const auto sum = (columns.col(axes[0]) + ((signs & 1) != 0 ? 1 : -1) * columns.col(axes[1]) +
                        ((signs & 2) != 0 ? 1 : -1) * columns.col(axes[2]))
                           .eval();
      least = std::min(least, sum.norm());
      if (sum.squaredNorm() < columns.col(longest).squaredNorm() * (1 - kRoundOff)) {
        columns.col(longest) = sum;
        changed = true;
      }
    }
    if (!changed) return least;
  }
  return least;
}

template <int D>
std::vector<int> periodic_axes(const std::array<bool, D>& axes) {
  std::vector<int> list;
  for (int a = 0; a < D; ++a) {
    if (axes[a]) list.push_back(a);
  }
  return list;
}

/// The periodic edges made perpendicular, in units of 1; the columns of the others are left out.
Eigen::MatrixXd directions_of(const Cell<3>& cell) {
  Eigen::MatrixXd out(3, 0);
  for (int a = 0; a < 3; ++a) {
    if (!cell.periodic[a]) continue;
    Eigen::Vector3d rest = cell.edges.col(a);
    for (int k = 0; k < 2; ++k) rest -= out * (out.transpose() * rest).eval();
    out.conservativeResize(3, out.cols() + 1);
    out.col(out.cols() - 1) = rest.normalized();
  }
  return out;
}

std::string text_of(double value) { return fmt::format("{:.6g}", value); }
std::string text_of(const Eigen::Vector3d& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v[0], v[1], v[2]);
}

}  // namespace

void check_cell(const Cell<3>& cell, int dim, double time_step) {
  const bool flows = !cell.velocity_gradient.isZero(0);
  if (dim == 2 && cell.periodic[2]) {
    refuse("cell.periodic: found the third axis, allowed for a shape of two dimensions: x and y");
  }
  if (!cell.low.allFinite() || !cell.edges.allFinite() || !cell.velocity_gradient.allFinite()) {
    refuse(
        "cell: found low, edges or velocity_gradient that is not a finite number, allowed: finite");
  }
  if (!cell.is_periodic()) {
    if (flows) refuse("cell.velocity_gradient: found one, allowed where some axis is periodic");
    return;
  }
  double lengths = 1;
  for (int a = 0; a < 3; ++a) {
    if (!cell.periodic[a]) continue;
    if (dim == 2 && cell.edges(2, a) != 0) {
      refuse("cell.edges: found " + text_of(cell.edges.col(a)) +
             " m, allowed in two dimensions: no third component");
    }
    lengths *= cell.edges.col(a).norm();
  }
  const Eigen::MatrixXd directions = directions_of(cell);
  double volume = 1;
  int k = 0;
  for (int a = 0; a < 3; ++a) {
    if (cell.periodic[a]) volume *= std::fabs(directions.col(k++).dot(cell.edges.col(a)));
  }
  if (!(lengths > 0) || !(volume > kLeastVolumeShare * lengths)) {
    std::string edges;
    for (int a = 0; a < 3; ++a) {
      if (cell.periodic[a]) edges += (edges.empty() ? "" : ", ") + text_of(cell.edges.col(a));
    }
    refuse("cell.edges: found " + edges +
           " m, allowed: edges of the periodic axes that are not 0 and do not lie in one line or "
           "plane");
  }
  if (!flows) return;
  const Cell<3>::Matrix& l = cell.velocity_gradient;
  const Eigen::Matrix3d span = directions * directions.transpose();
  if ((span * l * span - l).norm() > kRoundOff * l.norm()) {
    refuse(
        "cell.velocity_gradient: found a flow that goes or changes across the periodic edges, "
        "allowed: along them and by them alone; make these axes periodic or set the components 0");
  }
  if (!(l.norm() * time_step <= kMostStrainPerStep)) {
    refuse("cell.velocity_gradient: found " + text_of(l.norm()) + " 1/s, allowed: at most " +
           text_of(kMostStrainPerStep / time_step) + " 1/s at a time step of " +
           text_of(time_step) + " s");
  }
}

template <int D>
MovingCell<D>::MovingCell(const Cell<3>& cell, double time_step) : time_step_(time_step) {
  for (int a = 0; a < D; ++a) axes_[a] = cell.periodic[a];
  periodic_ = cell.is_periodic();
  if (!periodic_) return;
  state_.low = cell.low.template head<D>();
  // Across the periodic edges: unit vectors perpendicular to all before, those of the axes first.
  Eigen::MatrixXd basis = directions_of(cell).topRows(D);
  for (int a = 0; a < D; ++a) {
    if (axes_[a]) {
      state_.edges.col(a) = cell.edges.col(a).template head<D>();
      continue;
    }
    Eigen::Matrix<double, D, 1> best = Eigen::Matrix<double, D, 1>::Zero();
    for (int k = 0; k < D; ++k) {
      const Eigen::Matrix<double, D, 1> unit = Eigen::Matrix<double, D, 1>::Unit((a + k) % D);
      const Eigen::Matrix<double, D, 1> rest = unit - basis * (basis.transpose() * unit);
      if (rest.norm() > best.norm() + kRoundOff) best = rest;
    }
    basis.conservativeResize(D, basis.cols() + 1);
    basis.col(basis.cols() - 1) = best.normalized();
    state_.edges.col(a) = best.normalized();
  }
  set_gradient(cell.velocity_gradient.template topLeftCorner<D, D>());
  reduce();
  set_listed();
}

template <int D>
Cell<3> MovingCell<D>::told() const {
  Cell<3> cell;
  if (!periodic_) return cell;
  cell.low.template head<D>() = state_.low;
  for (int a = 0; a < D; ++a) {
    cell.periodic[a] = axes_[a];
    if (axes_[a]) cell.edges.col(a).template head<D>() = state_.edges.col(a);
  }
  cell.velocity_gradient.template topLeftCorner<D, D>() = state_.gradient;
  return cell;
}

template <int D>
auto MovingCell<D>::home(const Vector& place) const -> Counts {
  Counts n{};
  const Vector s = shares(place - state_.low);
  if (!s.allFinite()) return n;
  for (int a = 0; a < D; ++a) {
    if (axes_[a]) n[a] = whole_number(std::floor(s[a]));
  }
  return n;
}

template <int D>
PairImage MovingCell<D>::nearest(const Vector& place, const Vector& other) const {
  PairImage best{};
  if (!periodic_) return best;
  const Vector way = other - place, s = shares(way);
  if (!s.allFinite()) return best;
  std::array<int, D> low{}, high{};
  for (int a = 0; a < D; ++a) {
    if (!axes_[a]) continue;
    const double band = 0.5 * state_.shortest * per_width_[a];
    low[a] = static_cast<int>(std::clamp(std::ceil(-s[a] - band), -kFarthest, kFarthest));
    high[a] = static_cast<int>(std::clamp(std::floor(-s[a] + band), -kFarthest, kFarthest));
  }
  double least = way.squaredNorm();
  count(low, high, [&](const PairImage& n) {
    const double distance = (way + shift(n)).squaredNorm();
    if (distance < least) {
      least = distance;
      best = n;
    }
  });
  return best;
}

template <int D>
auto MovingCell<D>::reduce() -> std::vector<Exchange> {
  const std::vector<int> axes = periodic_axes<D>(axes_);
  std::vector<Exchange> done;
  // Lengths along each direction of space are measured in the cell's own extent: half a tilt is
  // half of the cell's width, however flat the cell.
  Matrix scaled = state_.edges;
  for (int a = 0; a < D; ++a) {
    double extent = 0;
    for (const int b : axes) extent += state_.edges(a, b) * state_.edges(a, b);
    if (extent > 0) scaled.row(a) /= std::sqrt(extent);
  }
  shorten(scaled, axes, [&](int a, int b, int times) {
    state_.edges.col(a) -= times * state_.edges.col(b);
    state_.rates.col(a) -= times * state_.rates.col(b);
    done.push_back({a, b, times});
  });
  derive();
  for (int a = 0; a < D; ++a) per_width_[a] = inverse_.row(a).norm();
  state_.shortest = shortest_of(state_.edges, axes);
  return done;
}

template <int D>
void MovingCell<D>::set_gradient(const Matrix& gradient) {
  state_.gradient = gradient;
  flows_ = periodic_ && !gradient.isZero(0);
  state_.rates = gradient * state_.edges;
  for (int a = 0; a < D; ++a) {
    if (!axes_[a]) state_.rates.col(a).setZero();
  }
  derive();
}

template <int D>
void MovingCell<D>::derive() {
  inverse_ = state_.edges.inverse();
  flow_ = state_.rates * inverse_;
  half_kick_ = 0.5 * time_step_ * state_.gradient * state_.gradient;
}

template <int D>
void MovingCell<D>::advance() {
  if (in_step_) finish();
  state_.rates += half_kick_ * state_.edges;
  state_.edges += time_step_ * state_.rates;
  in_step_ = true;
  derive();
  look_ahead();
}

template <int D>
void MovingCell<D>::finish() {
  state_.rates += half_kick_ * state_.edges;
  in_step_ = false;
  derive();
}

template <int D>
void MovingCell<D>::set_listed() {
  state_.listed = inverse_;
  look_ahead();
}

template <int D>
void MovingCell<D>::look_ahead() {
  if (!flows_) {
    ahead_ = Matrix::Identity();
    strain_ = 0;
    return;
  }
  Matrix rates = state_.rates;
  if (in_step_) rates += half_kick_ * state_.edges;
  rates += half_kick_ * state_.edges;
  ahead_ = (state_.edges + time_step_ * rates) * state_.listed;
  strain_ = (ahead_ - Matrix::Identity()).norm();
}

template <int D>
bool MovingCell<D>::settle() {
  if (!periodic_) return true;
  if (!state_.edges.allFinite() || !state_.rates.allFinite() || !state_.listed.allFinite() ||
      !state_.gradient.allFinite() || !state_.low.allFinite() || state_.edges.determinant() == 0) {
    return false;
  }
  flows_ = !state_.gradient.isZero(0);
  derive();
  for (int a = 0; a < D; ++a) per_width_[a] = state_.listed.row(a).norm();
  look_ahead();
  return state_.shortest > 0 && std::isfinite(state_.shortest);
}

template class MovingCell<2>;
template class MovingCell<3>;

}  // namespace grainfield::dem
