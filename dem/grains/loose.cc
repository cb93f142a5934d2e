#include "dem/grains/loose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/shared/computation_failed.h"

namespace grainfield::dem {
namespace {

// Places that are tried for one ball. Near the limits above a ball needs some hundred.
constexpr int kTries = 100000;
// Bins along an edge.
constexpr int kMostBins = 400;

/// Balls in bins at least as wide as the largest ball, so that only neighbouring bins matter.
class Bins {
 public:
  Bins(const std::array<double, 3>& size, int dim, bool periodic, double diameter)
      : size_(size), dim_(dim), periodic_(periodic) {
    std::size_t all = 1;
    for (int a = 0; a < dim; ++a) {
      const double fit = std::floor(size[a] / diameter);
      count_[a] = static_cast<int>(std::clamp(fit, 1.0, 1.0 * kMostBins));
      all *= static_cast<std::size_t>(count_[a]);
    }
    balls_.resize(all);
  }

  bool is_free(const std::array<double, 3>& x, double radius) const {
    const auto home = bin_of(x);
    std::array<int, 3> low{}, high{};
    for (int a = 0; a < dim_; ++a) {
      // Each of fewer than three bins is looked at once.
      const bool few = count_[a] < 3;
      low[a] = few ? 0 : home[a] - 1;
      high[a] = few ? count_[a] - 1 : home[a] + 1;
    }
    for (int k = low[2]; k <= high[2]; ++k) {
      for (int j = low[1]; j <= high[1]; ++j) {
        for (int i = low[0]; i <= high[0]; ++i) {
          if (touches_in({i, j, k}, x, radius)) return false;
        }
      }
    }
    return true;
  }
  void add(const std::array<double, 3>& x, double radius) {
    balls_[place_of(bin_of(x))].push_back({x, radius});
  }

 private:
  struct Ball {
    std::array<double, 3> x;
    double radius;
  };

  std::array<int, 3> bin_of(const std::array<double, 3>& x) const {
    std::array<int, 3> bin{};
    for (int a = 0; a < dim_; ++a) {
      bin[a] = std::clamp(static_cast<int>(x[a] / size_[a] * count_[a]), 0, count_[a] - 1);
    }
    return bin;
  }
  std::size_t place_of(const std::array<int, 3>& bin) const {
    std::size_t place = 0;
    for (int a = dim_ - 1; a >= 0; --a) {
      place = place * static_cast<std::size_t>(count_[a]) + static_cast<std::size_t>(bin[a]);
    }
    return place;
  }
  bool touches_in(std::array<int, 3> bin, const std::array<double, 3>& x, double radius) const {
    for (int a = 0; a < dim_; ++a) {
      if (bin[a] >= 0 && bin[a] < count_[a]) continue;
      if (!periodic_) return false;
      bin[a] = (bin[a] + count_[a]) % count_[a];
    }
    for (const Ball& ball : balls_[place_of(bin)]) {
      double squared = 0;
      for (int a = 0; a < dim_; ++a) {
        double way = std::fabs(ball.x[a] - x[a]);
        if (periodic_) way = std::min(way, size_[a] - way);
        squared += way * way;
      }
      const double reach = ball.radius + radius;
      if (squared < reach * reach) return true;
    }
    return false;
  }

  std::array<double, 3> size_;
  int dim_;
  bool periodic_;
  std::array<int, 3> count_{1, 1, 1};
  std::vector<std::vector<Ball>> balls_;
};

}  // namespace

std::vector<std::array<double, 3>> place_loosely(const std::vector<double>& radii,
                                                 const std::array<double, 3>& size, int dim,
                                                 bool periodic, Random& random) {
  std::vector<std::size_t> order(radii.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return radii[a] > radii[b]; });
  std::vector<std::array<double, 3>> places(radii.size());
  if (radii.empty()) return places;
  Bins bins(size, dim, periodic, 2 * radii[order.front()]);
  std::size_t placed = 0;
  for (const std::size_t k : order) {
    const double margin = periodic ? 0 : radii[k];
    std::array<double, 3> x{};
    int tries = 0;
    do {
      if (++tries > kTries) {
        throw ComputationFailed(
            fmt::format("found room for {} of {} grains placed at random; lower "
                        "sample.start_fraction",
                        placed, radii.size()));
      }
      for (int a = 0; a < dim; ++a) x[a] = random.uniform(margin, size[a] - margin);
    } while (!bins.is_free(x, radii[k]));
    bins.add(x, radii[k]);
    places[k] = x;
    ++placed;
  }
  return places;
}

}  // namespace grainfield::dem
