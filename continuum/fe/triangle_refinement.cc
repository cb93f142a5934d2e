#include "continuum/fe/triangle_refinement.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

namespace grainfield::continuum::fe {
namespace {

using Edge = std::pair<int, int>;
Edge edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

class Cutter {
 public:
  Cutter(const TriangleMesh& mesh, std::vector<int>& parent)
      : mesh_(mesh), parent_(parent), cut_(mesh.triangles.size(), false) {
    parent_.resize(mesh.triangles.size());
    std::iota(parent_.begin(), parent_.end(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) enter(static_cast<int>(t));
  }

  /// Until no cut of triangle t as it was given is left, t keeps its number with one of its halves.
  void cut(int t) {
    for (;;) {
      const Edge edge = longest(t);
      const int other = across(edge, t);
      if (other < 0 || longest(other) == edge) {
        split(edge, t, other);
        return;
      }
      cut(other);
    }
  }

  bool was_cut(std::size_t t) const { return cut_[t]; }
  TriangleMesh take() { return std::move(mesh_); }

 private:
  std::array<int, 3>& triangle(int t) { return mesh_.triangles[static_cast<std::size_t>(t)]; }

  void enter(int t) {
    for (std::size_t k = 0; k < 3; ++k) {
      auto& both = beside_[edge_of(triangle(t)[k], triangle(t)[(k + 1) % 3])];
      both.push_back(t);
    }
  }
  void leave(int t) {
    for (std::size_t k = 0; k < 3; ++k) {
      auto& both = beside_[edge_of(triangle(t)[k], triangle(t)[(k + 1) % 3])];
      both.erase(std::find(both.begin(), both.end(), t));
    }
  }

  /// The longest edge; among equally long ones (up to round-off) that with the least numbers.
  Edge longest(int t) {
    constexpr double kEqual = 1e-9;
    Edge best{-1, -1};
    double most = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge edge = edge_of(triangle(t)[k], triangle(t)[(k + 1) % 3]);
      const double length = (mesh_.vertices[static_cast<std::size_t>(edge.first)] -
                             mesh_.vertices[static_cast<std::size_t>(edge.second)])
                                .norm();
      if (length > most * (1 + kEqual) || (length > most * (1 - kEqual) && edge < best)) {
        best = edge;
        most = std::max(most, length);
      }
    }
    return best;
  }

  int across(const Edge& edge, int t) {
    for (const int other : beside_[edge])
      if (other != t) return other;
    return -1;
  }

  void split(const Edge& edge, int t, int other) {
    const int middle = static_cast<int>(mesh_.vertices.size());
    mesh_.vertices.push_back((mesh_.vertices[static_cast<std::size_t>(edge.first)] +
                              mesh_.vertices[static_cast<std::size_t>(edge.second)]) /
                             2);
    for (const int old : {t, other}) {
      if (old < 0) continue;
      leave(old);
      if (static_cast<std::size_t>(old) < cut_.size()) cut_[static_cast<std::size_t>(old)] = true;
      std::array<int, 3> first = triangle(old), second = first;
      // Both keep the order of the corners; each has one of the edge's ends replaced.
      std::replace(first.begin(), first.end(), edge.first, middle);
      std::replace(second.begin(), second.end(), edge.second, middle);
      triangle(old) = first;
      mesh_.triangles.push_back(second);
      parent_.push_back(parent_[static_cast<std::size_t>(old)]);
      enter(old);
      enter(static_cast<int>(mesh_.triangles.size()) - 1);
    }
  }

  TriangleMesh mesh_;
  std::vector<int>& parent_;
  std::vector<bool> cut_;                    ///< of the triangles as given
  std::map<Edge, std::vector<int>> beside_;  ///< triangles at an edge
};

}  // namespace

TriangleMesh refined(const TriangleMesh& mesh, const std::vector<bool>& marked,
                     std::vector<int>& parent) {
  Cutter cutter(mesh, parent);
  for (std::size_t t = 0; t < marked.size(); ++t)
    if (marked[t] && !cutter.was_cut(t)) cutter.cut(static_cast<int>(t));
  return cutter.take();
}

std::vector<bool> largest_errors(const std::vector<double>& errors, double share) {
  std::vector<std::size_t> order(errors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return errors[a] > errors[b]; });
  double all = 0, held = 0;
  for (const double e : errors) all += e * e;
  std::vector<bool> out(errors.size(), false);
  for (const std::size_t t : order) {
    if (held >= share * all) break;
    out[t] = true;
    held += errors[t] * errors[t];
  }
  return out;
}

}  // namespace grainfield::continuum::fe
