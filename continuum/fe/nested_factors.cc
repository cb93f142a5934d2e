#include "continuum/fe/nested_factors.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace grainfield::continuum::fe {
namespace {

using Eigen::Index;

/// A part of so few cells is not halved: what is inside is eliminated together.
constexpr std::size_t kLeaf = 8;
/// A cut leaves between 1/2 - this and 1/2 + this of the cells on either side.
constexpr double kOffMiddle = 0.1;
/// Across which cuts are tried: with the cells' extents for units these are across the edges of a
/// lattice of triangles and of halved rectangles.
const Eigen::Vector2d kAcross[] = {{1, 0}, {0, 1}, {2, 1}, {2, -1}, {1, 1}, {1, -1}};
/// Columns eliminated together, and terms of a product summed in one go: Eigen does not cut so few
/// terms to the size of a cache.
constexpr Index kPanel = 32, kTerms = 128;

/// c -= a b.
template <typename C, typename A, typename B>
void subtract_product(C&& c, const A& a, const B& b) {
  for (Index k = 0; k < a.cols(); k += kTerms) {
    const Index n = std::min(kTerms, a.cols() - k);
    c.noalias() -= a.middleCols(k, n) * b.middleRows(k, n);
  }
}

}  // namespace

template <typename Scalar>
NestedFactors<Scalar>::NestedFactors(std::vector<std::vector<unsigned int>> cells,
                                     std::vector<Eigen::Vector2d> centres, std::size_t unknowns)
    : cells_(std::move(cells)),
      centres_(std::move(centres)),
      order_(cells_.size()),
      inside_(unknowns, 0),
      left_(unknowns, 0),
      front_of_(unknowns, 0),
      places_(cells_.size()) {
  std::size_t offset = 0;
  for (const auto& cell : cells_) {
    offsets_.push_back(offset);
    offset += cell.size() * cell.size();
  }
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  split(0, order_.size());
  find_unknowns();
  find_places();
}

template <typename Scalar>
int NestedFactors<Scalar>::split(std::size_t begin, std::size_t end) {
  Front front;
  front.begin = begin;
  front.end = end;
  if (end - begin > kLeaf) {
    const std::size_t middle = cut(begin, end);
    front.parts[0] = split(begin, middle);
    front.parts[1] = split(middle, end);
  }
  fronts_.push_back(std::move(front));
  return static_cast<int>(fronts_.size()) - 1;
}

/// Sorts the part's cells so that those before the position returned are one side: of all straight
/// cuts in the directions above the one with the fewest unknowns on both sides.
template <typename Scalar>
std::size_t NestedFactors<Scalar>::cut(std::size_t begin, std::size_t end) {
  const auto from = order_.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto to = order_.begin() + static_cast<std::ptrdiff_t>(end);
  std::vector<std::size_t> trial(from, to), best;
  for (const std::size_t c : trial)
    for (const unsigned int u : cells_[c]) inside_[u] = 0;
  for (const std::size_t c : trial)
    for (const unsigned int u : cells_[c]) ++inside_[u];
  const double size = static_cast<double>(trial.size());
  std::size_t least = 0, position = 0;
  for (const Eigen::Vector2d& across : kAcross) {
    std::sort(trial.begin(), trial.end(), [&](std::size_t a, std::size_t b) {
      const double x = across.dot(centres_[a]), y = across.dot(centres_[b]);
      return x < y || (x == y && a < b);
    });
    for (const std::size_t c : trial)
      for (const unsigned int u : cells_[c]) left_[u] = inside_[u];
    std::size_t shared = 0;
    for (std::size_t k = 0; k < trial.size(); ++k) {
      for (const unsigned int u : cells_[trial[k]]) {
        if (left_[u] == inside_[u]) ++shared;
        if (--left_[u] == 0) --shared;
      }
      const double share = static_cast<double>(k + 1) / size;
      if (std::abs(share - 0.5) > kOffMiddle) continue;
      if (!best.empty() && shared >= least) continue;
      best = trial;
      least = shared;
      position = k + 1;
    }
  }
  std::copy(best.begin(), best.end(), from);
  return begin + position;
}

/// An unknown is eliminated in the first front that has all its cells.
template <typename Scalar>
void NestedFactors<Scalar>::find_unknowns() {
  std::fill(inside_.begin(), inside_.end(), 0);
  for (const auto& cell : cells_)
    for (const unsigned int u : cell) ++inside_[u];
  std::vector<std::vector<Sharing>> rest(fronts_.size());
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    Front& front = fronts_[f];
    std::vector<Sharing> all;
    if (front.parts[0] < 0) {
      for (std::size_t c = front.begin; c < front.end; ++c)
        for (const unsigned int u : cells_[order_[c]]) all.emplace_back(u, 1);
    } else {
      for (const int part : front.parts) {
        auto& of_part = rest[static_cast<std::size_t>(part)];
        all.insert(all.end(), of_part.begin(), of_part.end());
        of_part.clear();
      }
    }
    std::sort(all.begin(), all.end());
    for (std::size_t k = 0; k < all.size();) {
      const unsigned int u = all[k].first;
      int cells = 0;
      for (; k < all.size() && all[k].first == u; ++k) cells += all[k].second;
      if (cells == inside_[u]) {
        front_of_[u] = f;
        front.unknowns.push_back(u);
      } else {
        rest[f].emplace_back(u, cells);
      }
    }
    front.own = static_cast<Index>(front.unknowns.size());
    for (const Sharing& sharing : rest[f]) front.unknowns.push_back(sharing.first);
  }
}

template <typename Scalar>
void NestedFactors<Scalar>::find_places() {
  std::vector<Index> place(front_of_.size(), 0);
  for (Front& front : fronts_) {
    for (std::size_t k = 0; k < front.unknowns.size(); ++k)
      place[front.unknowns[k]] = static_cast<Index>(k);
    if (front.parts[0] < 0) {
      for (std::size_t c = front.begin; c < front.end; ++c)
        for (const unsigned int u : cells_[order_[c]]) places_[order_[c]].push_back(place[u]);
      continue;
    }
    for (const int part : front.parts) {
      Front& inner = fronts_[static_cast<std::size_t>(part)];
      for (auto k = static_cast<std::size_t>(inner.own); k < inner.unknowns.size(); ++k)
        inner.into.push_back(place[inner.unknowns[k]]);
    }
  }
}

/// Turns the own columns and rows into factors and the rest into what it leaves to the outer front.
template <typename Scalar>
bool NestedFactors<Scalar>::eliminate(Front& front, Matrix& whole) {
  const Index own = front.own, size = whole.rows(), rest = size - own;
  front.exchange.clear();
  for (Index begin = 0; begin < own; begin += kPanel) {
    const Index n = std::min(kPanel, own - begin), end = begin + n;
    for (Index k = begin; k < end; ++k) {
      Index row = 0;
      const Scalar largest = whole.col(k).segment(k, own - k).cwiseAbs().maxCoeff(&row);
      if (!(largest > 0) || !std::isfinite(largest)) return false;
      front.exchange.push_back(k + row);
      if (row > 0) whole.row(k).swap(whole.row(k + row));
      const Index below = size - k - 1, right = end - k - 1;
      whole.col(k).tail(below) /= whole(k, k);
      whole.block(k + 1, k + 1, below, right).noalias() -=
          whole.col(k).tail(below) * whole.row(k).segment(k + 1, right);
    }
    auto beside = whole.block(begin, end, n, own - end);
    whole.block(begin, begin, n, n)
        .template triangularView<Eigen::UnitLower>()
        .solveInPlace(beside);
    subtract_product(whole.block(end, end, size - end, own - end),
                     whole.block(end, begin, size - end, n), beside);
  }
  for (Index begin = 0; begin < own; begin += kPanel) {
    const Index n = std::min(kPanel, own - begin);
    auto rows = whole.block(begin, own, n, rest);
    subtract_product(rows, whole.block(begin, 0, n, begin), whole.block(0, own, begin, rest));
    whole.block(begin, begin, n, n).template triangularView<Eigen::UnitLower>().solveInPlace(rows);
  }
  subtract_product(whole.bottomRightCorner(rest, rest), whole.bottomLeftCorner(rest, own),
                   whole.topRightCorner(own, rest));
  front.columns = whole.leftCols(own);
  front.rows = whole.topRightCorner(own, rest);
  return true;
}

template <typename Scalar>
bool NestedFactors<Scalar>::factorize(const std::vector<double>& matrices,
                                      const std::vector<NestedEntry>& entries) {
  double largest = 0;
  for (const double value : matrices) largest = std::max(largest, std::abs(value));
  scale_ = largest > 0 ? 1 / largest : 1;
  for (Front& front : fronts_) front.entries.clear();
  // The inner one of the fronts of two unknowns of a cell has both.
  for (std::size_t e = 0; e < entries.size(); ++e)
    fronts_[std::min(front_of_[entries[e].row], front_of_[entries[e].column])].entries.push_back(e);
  std::vector<Matrix> left;  // by fronts that are not yet in an outer one
  Matrix whole;
  for (Front& front : fronts_) {
    const auto size = static_cast<Index>(front.unknowns.size());
    whole.setZero(size, size);
    if (front.parts[0] < 0) {
      for (std::size_t c = front.begin; c < front.end; ++c) {
        const auto& place = places_[order_[c]];
        const double* value = matrices.data() + offsets_[order_[c]];
        for (const Index i : place)
          for (const Index j : place) whole(i, j) += static_cast<Scalar>(scale_ * *value++);
      }
    } else {
      for (const int part : {front.parts[1], front.parts[0]}) {
        const auto& into = fronts_[static_cast<std::size_t>(part)].into;
        const Matrix& from = left.back();
        for (std::size_t j = 0; j < into.size(); ++j)
          for (std::size_t i = 0; i < into.size(); ++i)
            whole(into[i], into[j]) += from(static_cast<Index>(i), static_cast<Index>(j));
        left.pop_back();
      }
    }
    const auto place = [&](unsigned int u) {
      return std::find(front.unknowns.begin(), front.unknowns.end(), u) - front.unknowns.begin();
    };
    for (const std::size_t e : front.entries)
      whole(place(entries[e].row), place(entries[e].column)) +=
          static_cast<Scalar>(scale_ * entries[e].value);
    if (!eliminate(front, whole)) return false;
    left.push_back(whole.bottomRightCorner(size - front.own, size - front.own));
  }
  return true;
}

template <typename Scalar>
void NestedFactors<Scalar>::solve(Eigen::VectorXd& x) const {
  x *= scale_;
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> part, rest;
  const auto own = [&](const Front& front) {
    part.resize(front.own);
    for (Index k = 0; k < front.own; ++k)
      part[k] = static_cast<Scalar>(x[front.unknowns[static_cast<std::size_t>(k)]]);
  };
  const auto put = [&](const Front& front) {
    for (Index k = 0; k < front.own; ++k) x[front.unknowns[static_cast<std::size_t>(k)]] = part[k];
  };
  for (const Front& front : fronts_) {
    const Index n = front.own, others = front.rows.cols();
    own(front);
    for (Index k = 0; k < n; ++k)
      std::swap(part[k], part[front.exchange[static_cast<std::size_t>(k)]]);
    rest.setZero(others);
    for (Index k = 0; k < n; ++k) {
      part.tail(n - k - 1) -= part[k] * front.columns.col(k).segment(k + 1, n - k - 1);
      rest += part[k] * front.columns.col(k).tail(others);
    }
    put(front);
    for (Index i = 0; i < others; ++i)
      x[front.unknowns[static_cast<std::size_t>(n + i)]] -= rest[i];
  }
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
    const Index n = front->own, others = front->rows.cols();
    own(*front);
    for (Index i = 0; i < others; ++i)
      part -= static_cast<Scalar>(x[front->unknowns[static_cast<std::size_t>(n + i)]]) *
              front->rows.col(i);
    for (Index k = n; k-- > 0;) {
      part[k] /= front->columns(k, k);
      part.head(k) -= part[k] * front->columns.col(k).head(k);
    }
    put(*front);
  }
}

template class NestedFactors<float>;
template class NestedFactors<double>;

}  // namespace grainfield::continuum::fe
