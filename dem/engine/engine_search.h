// Neighbour search of the step loop: who is near whom, in which order, on which thread.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "dem/engine/engine_loop.h"

namespace grainfield::dem {

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::locate_applied() {
  applied_index_ = -1;
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (ids_[i] == applied_.id) applied_index_ = static_cast<int>(i);
  }
}

/// The first order.size() grains, those awake, in this order.
template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::sort_bodies(const std::vector<int>& order) {
  const std::size_t n = order.size();
  const auto permute = [&order, n](auto& values) {
    std::vector sorted(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n));
    for (std::size_t k = 0; k < n; ++k) sorted[k] = values[order[k]];
    std::copy(sorted.begin(), sorted.end(), values.begin());
  };
  permute(bodies_);
  permute(memory_);
  permute(inertias_);
  permute(ids_);
  permute(quiet_);
  shapes_.sort(order);
}

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::swap_bodies(int i, int j) {
  std::swap(bodies_[i], bodies_[j]);
  std::swap(memory_[i], memory_[j]);
  std::swap(inertias_[i], inertias_[j]);
  std::swap(ids_[i], ids_[j]);
  std::swap(quiet_[i], quiet_[j]);
  std::swap(rests_[i], rests_[j]);
  std::swap(touches_[i], touches_[j]);
  std::swap(asleep_[i], asleep_[j]);
  shapes_.swap(i, j);
}

/// Those awake first, sleepers and (when there is sleeping) fixed grains behind them.
template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::part_sleepers() {
  int low = 0, high = static_cast<int>(bodies_.size()) - 1;
  while (true) {
    while (low <= high && !asleep_[low]) ++low;
    while (low <= high && asleep_[high]) --high;
    if (low >= high) break;
    swap_bodies(low, high);
    sleepers_changed_ = true;
  }
  if (low != awake_) sleepers_changed_ = true;
  awake_ = low;
}

template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::adapt_skin(bool by_motion) {
  if (by_motion) {
    const long since = steps_ - last_by_motion_;
    last_by_motion_ = steps_;
    if (since < kOften) {
      skin_share_ = std::min(1.5 * skin_share_, kMostSkin);
    } else if (since >= kSeldom) {
      skin_share_ = std::max(0.5 * skin_share_, kLeastSkin);
    }
  }
  double sum = 0;
  for (int i = 0; i < awake_; ++i) sum += bodies_[i].radius;
  const double mean = awake_ == 0 ? 0 : sum / awake_;
  skin_ = settings_.skin > 0 ? settings_.skin : skin_share_ * mean;
}

template <class Shape, class Law, class Integrator>
auto EngineLoop<Shape, Law, Integrator>::pair_key(std::int64_t a, std::int64_t b) -> Key {
  const auto low = static_cast<Key>(std::min(a, b)), high = static_cast<Key>(std::max(a, b));
  return low << 32 | high;
}

/// Walls count down from the largest number, where no id comes.
template <class Shape, class Law, class Integrator>
auto EngineLoop<Shape, Law, Integrator>::wall_key(std::int64_t id, int wall) -> Key {
  return static_cast<Key>(id) << 32 | (0xFFFFFFFFu - static_cast<Key>(wall));
}

/// The pair of grain i with grain or wall j, its spring from the last pairs or from the frozen
/// contacts, which it leaves then.
template <class Shape, class Law, class Integrator>
auto EngineLoop<Shape, Law, Integrator>::recalled(int i, int j, bool wall,
                                                  const std::vector<std::pair<Key, double>>& kept)
    -> Pair {
  Pair pair;
  pair.j = j;
  const Key key = wall ? wall_key(ids_[i], j) : pair_key(ids_[i], ids_[j]);
  const auto it = std::lower_bound(kept.begin(), kept.end(), key,
                                   [](const auto& a, Key b) { return a.first < b; });
  if (it != kept.end() && it->first == key) {
    pair.spring = it->second;
    return pair;
  }
  if (frozen_.empty()) return pair;
  const auto at = frozen_.find(key);
  if (at == frozen_.end()) return pair;
  const Frozen& f = at->second;
  pair.spring = f.spring;
  if (!wall && j >= awake_) {  // the sleeper feels this contact anew from now on
    const double sign = ids_[j] < ids_[i] ? -1 : 1;  // f acts on the lower id
    Sum& rest = rests_[j];
    rest.fx += sign * f.fx;
    rest.fy += sign * f.fy;
    rest.torque -= ids_[j] < ids_[i] ? f.torque_low : f.torque_high;
    rest.press -= std::fabs(f.fx) + std::fabs(f.fy);
  }
  frozen_.erase(at);
  return pair;
}

/// How far turning by one radian carries a point of the grain, m; 0 where its circle is what the
/// search goes by.
template <class Shape, class Law, class Integrator>
double EngineLoop<Shape, Law, Integrator>::turning_of(int i) const {
  if constexpr (Shape::outlines) return shapes_.slender(i) ? bodies_[i].radius : 0;
  return 0;
}

/// How far any point of the grain may go until the next search, m.
template <class Shape, class Law, class Integrator>
double EngineLoop<Shape, Law, Integrator>::way_of(int i) const {
  const Body& b = bodies_[i];
  const double speed = std::hypot(b.vx, b.vy) + turning_of(i) * std::fabs(b.spin);
  const double ahead = kStepsAhead * settings_.time_step;
  return 0.5 * skin_ + std::min(ahead * speed, kMostAhead * b.radius);
}

/// The bounds of these bodies: of those awake with the way that they may go.
template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::find_bounds(int first, int last) {
  if constexpr (Shape::outlines) {
    if (!shapes_.any_slender()) return;
    bounds_.resize(bodies_.size());
    for (int i = first; i < last; ++i) {
      const double gap = i < awake_ ? reaches_[i].reach - bodies_[i].radius : 0;
      bounds_[i] = shapes_.bound(i, bodies_[i], memory_[i].angle, gap);
    }
  }
}

/// True when the two, whose circles meet, cannot touch until the next search: one of them is
/// slender and lies beside the other.
template <class Shape, class Law, class Integrator>
bool EngineLoop<Shape, Law, Integrator>::out_of_reach(int i, int j) const {
  if constexpr (Shape::outlines) return shapes_.any_slender() && apart(bounds_[i], bounds_[j]);
  return false;
}

/// Of the bodies from awake_ on.
template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::build_sleepers_grid() {
  std::vector<Reach> still;
  still.reserve(bodies_.size() - static_cast<std::size_t>(awake_));
  for (std::size_t j = static_cast<std::size_t>(awake_); j < bodies_.size(); ++j) {
    const Body& b = bodies_[j];
    still.push_back({b.x, b.y, b.radius, b.inverse_mass == 0});
  }
  sleepers_grid_.build(still);
  find_bounds(awake_, static_cast<int>(bodies_.size()));
  sleepers_changed_ = false;
}

/// by_motion: because grains have left their margins, or have not for long.
template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::search(bool by_motion) {
  // The springs in use, by the grains' ids: the order of the bodies changes below. A spring is the
  // same seen from either of its grains. What has frozen since is not among them.
  const auto keep = [&](const std::vector<Pair>& pairs, const std::vector<int>& start, bool wall) {
    std::vector<std::pair<Key, double>> kept;
    for (int i = 0; i + 1 < static_cast<int>(start.size()); ++i) {
      for (int k = start[i]; k < start[i + 1]; ++k) {
        if (pairs[k].spring == 0 || (asleep_[i] && (wall || asleep_[pairs[k].j]))) continue;
        kept.emplace_back(
            wall ? wall_key(ids_[i], pairs[k].j) : pair_key(ids_[i], ids_[pairs[k].j]),
            pairs[k].spring);
      }
    }
    std::sort(kept.begin(), kept.end());
    return kept;
  };
  const auto kept = keep(pairs_, pair_start_, false);
  const auto wall_kept = keep(wall_pairs_, wall_start_, true);
  gather_touches();

  part_sleepers();
  adapt_skin(by_motion);
  const int n = awake_, all = static_cast<int>(bodies_.size());
  const auto reach_of = [&](int i) {
    const Body& b = bodies_[i];
    return Reach{b.x, b.y, b.radius + way_of(i), b.inverse_mass == 0};
  };
  reaches_.resize(n);
  for (int i = 0; i < n; ++i) reaches_[i] = reach_of(i);
  grid_.build(reaches_);
  if (n > 0) {
    sort_bodies(grid_.order());
    for (int i = 0; i < n; ++i) reaches_[i] = reach_of(i);
    grid_.build(reaches_);
  }
  locate_applied();
  if (sleepers_changed_) build_sleepers_grid();
  find_bounds(0, n);

  std::vector<std::pair<int, int>> found;
  grid_.pairs(found);
  std::vector<int> near;
  pairs_.clear();
  pair_start_.assign(n + 1, 0);
  std::size_t next = 0;
  for (int i = 0; i < n; ++i) {
    for (; next < found.size() && found[next].first == i; ++next) {
      if (out_of_reach(i, found[next].second)) continue;
      pairs_.push_back(recalled(i, found[next].second, false, kept));
    }
    if (all > n) {
      near.clear();
      sleepers_grid_.near(reaches_[i], near);
      for (const int j : near) {
        if (!out_of_reach(i, n + j)) pairs_.push_back(recalled(i, n + j, false, kept));
      }
    }
    pair_start_[i + 1] = static_cast<int>(pairs_.size());
  }
  pairs_.resize(pairs_.size() + kAhead);

  wall_pairs_.clear();
  wall_start_.assign(1, 0);
  for (int i = 0; i < n; ++i) {
    const Body& b = bodies_[i];
    for (int w = 0; w < static_cast<int>(walls_.size()) && b.inverse_mass != 0; ++w) {
      const Wall& wall = walls_[w];
      const double height =
          (b.x - wall.point.x()) * wall.normal.x() + (b.y - wall.point.y()) * wall.normal.y();
      if (height < reaches_[i].reach) wall_pairs_.push_back(recalled(i, w, true, wall_kept));
    }
    wall_start_.push_back(static_cast<int>(wall_pairs_.size()));
  }
  index_contacts();
  pair_forces_.assign(pairs_.size(), {});
  wall_forces_.assign(wall_pairs_.size(), {});
  felt_.assign(pairs_.size(), {});
  reference_.resize(n);
  for (int i = 0; i < n; ++i) {
    const double way = reaches_[i].reach - bodies_[i].radius;
    reference_[i] = {bodies_[i].x, bodies_[i].y, memory_[i].angle, turning_of(i), way};
  }
  search_needed_ = false;
}

/// Blocks of the threads, with about the same number of pairs in each, and what crosses them.
template <class Shape, class Law, class Integrator>
void EngineLoop<Shape, Law, Integrator>::index_contacts() {
  const int n = awake_, size = team_.size();
  blocks_.assign(size + 1, n);
  blocks_[0] = 0;
  const auto work = [&](int i) { return static_cast<long long>(pair_start_[i]) + 2LL * i; };
  for (int rank = 1, i = 0; rank < size; ++rank) {
    while (i < n && work(i) * size < work(n) * rank) ++i;
    blocks_[rank] = i;
  }
  incoming_.assign(size, {});
  for (int from = 0; from + 1 < size; ++from) {
    for (int i = blocks_[from]; i < blocks_[from + 1]; ++i) {
      for (int k = pair_start_[i]; k < pair_start_[i + 1]; ++k) {
        if (pairs_[k].j < blocks_[from + 1] || pairs_[k].j >= n) continue;
        int to = from + 1;
        while (pairs_[k].j >= blocks_[to + 1]) ++to;
        incoming_[to].emplace_back(i, k);
      }
    }
  }
  sums_.assign(bodies_.size(), Sum{});
}

}  // namespace grainfield::dem
