// All that is kept by body: kinematics, inertia, shape, what the integrator remembers.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "dem/engine/thread_team.h"
#include "dem/space/body.h"

namespace grainfield::dem {

/// Bodies change their order; `ids` tell who is who (0, 1, 2, ... in the order of adding).
template <class Shape, class Integrator>
struct Grains {
  static constexpr int dim = Shape::dim;
  using Body = dem::Body<dim>;
  using Memory = typename Integrator::Memory;
  using Store = Shape;

  std::vector<Body> bodies;
  std::vector<Memory> memory;  ///< the integrator's, with the rotation
  std::vector<Inertia<dim>> inertias;
  std::vector<std::int64_t> ids;
  std::vector<std::uint8_t> kinds;  ///< material
  // Empty without a cell:
  std::vector<std::array<int, dim>> images;  ///< whole edges that a body has been carried back by
  std::vector<double> cell_work;             ///< done by the cell's flow, J
  Shape shapes;

  int size() const { return static_cast<int>(bodies.size()); }
  bool is_fixed(int i) const { return bodies[i].inverse_mass == 0; }

  /// The first order.size() bodies in this order, by all threads: most of what one of them works on
  /// later is then near its core.
  void sort(const std::vector<int>& order, ThreadTeam& team) {
    const auto permute = [&](auto& values) { sort_values(values, order, team); };
    permute(bodies);
    permute(memory);
    permute(inertias);
    permute(ids);
    permute(kinds);
    permute(images);
    permute(cell_work);
    shapes.sort(order);
  }
  void swap(int i, int j) {
    std::swap(bodies[i], bodies[j]);
    std::swap(memory[i], memory[j]);
    std::swap(inertias[i], inertias[j]);
    std::swap(ids[i], ids[j]);
    std::swap(kinds[i], kinds[j]);
    if (!images.empty()) {
      std::swap(images[i], images[j]);
      std::swap(cell_work[i], cell_work[j]);
    }
    shapes.swap(i, j);
  }
  /// Where each id is.
  std::vector<int> index() const {
    std::vector<int> at(ids.size());
    for (int i = 0; i < size(); ++i) at[ids[i]] = i;
    return at;
  }

  template <class Self, class Each>
  static void visit(Self& self, Each each) {
    each(self.bodies);
    each(self.memory);
    each(self.inertias);
    each(self.ids);
    each(self.kinds);
    each(self.images);
    each(self.cell_work);
  }
  bool fits() const {
    return memory.size() == bodies.size() && inertias.size() == bodies.size() &&
           ids.size() == bodies.size() && kinds.size() == bodies.size() &&
           cell_work.size() == images.size();
  }

 private:
  template <class T>
  static void sort_values(std::vector<T>& values, const std::vector<int>& order, ThreadTeam& team) {
    if (values.empty()) return;
    const int n = static_cast<int>(order.size());
    std::vector<std::vector<T>> parts(static_cast<std::size_t>(team.size()));
    team.together([&](int rank) {
      const auto [first, last] = share(n, rank, team.size());
      std::vector<T> sorted;
      sorted.reserve(static_cast<std::size_t>(last - first));
      for (int k = first; k < last; ++k) sorted.push_back(values[order[k]]);
      parts[rank].swap(sorted);
    });
    team.together([&](int rank) {
      std::copy(parts[rank].begin(), parts[rank].end(),
                values.begin() + share(n, rank, team.size()).first);
    });
  }
};

}  // namespace grainfield::dem
