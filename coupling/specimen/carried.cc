#include "coupling/specimen/carried.h"

#include <algorithm>
#include <numeric>

#include "coupling/specimen/surface.h"

namespace grainfield::coupling {
namespace {

using dem::Contact;
using dem::Grain;
using dem::Snapshot;

// Groups of grains that touch, by the grain that stands for each (union by halving paths).
class Groups {
 public:
  explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::size_t of(std::size_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  void join(std::size_t a, std::size_t b) { parent_[of(a)] = of(b); }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace

std::vector<bool> carried_grains(const Snapshot& snapshot) {
  const std::size_t n = snapshot.grains.size();
  if (snapshot.contacts.empty()) return std::vector<bool>(n, true);
  // One more stands for the walls and fixed grains.
  Groups groups(n + 1);
  for (std::size_t k = 0; k < n; ++k) {
    if (snapshot.grains[k].fixed) groups.join(k, n);
  }
  bool tied = false;
  for (const Contact& c : snapshot.contacts) {
    const auto i = static_cast<std::size_t>(c.i);
    const auto j = c.j < 0 ? n : static_cast<std::size_t>(c.j);
    groups.join(i, j);
    tied = tied || c.j < 0 || snapshot.grains[i].fixed || snapshot.grains[j].fixed;
  }
  std::size_t heap = groups.of(n);
  if (!tied) {
    std::vector<std::size_t> size(n + 1, 0);
    for (std::size_t k = 0; k < n; ++k) ++size[groups.of(k)];
    heap = static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
  }
  std::vector<bool> out(n);
  for (std::size_t k = 0; k < n; ++k) out[k] = groups.of(k) == heap;
  return out;
}

std::vector<std::size_t> grains_in_flight(const Snapshot& snapshot, double column) {
  const std::vector<bool> carried = carried_grains(snapshot);
  Snapshot heap;
  for (std::size_t k = 0; k < carried.size(); ++k) {
    if (carried[k]) heap.grains.push_back(snapshot.grains[k]);
  }
  const Surface surface = free_surface(heap, column);
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < carried.size(); ++k) {
    const Grain& g = snapshot.grains[k];
    if (carried[k] || g.fixed) continue;
    const double at = (g.position.x() - surface.left) / column;
    const bool above = at < 0 || at >= static_cast<double>(surface.top.size()) ||
                       g.position.y() > surface.top[static_cast<std::size_t>(at)];
    if (above) out.push_back(k);
  }
  return out;
}

}  // namespace grainfield::coupling
