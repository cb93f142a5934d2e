#include "dem/collisions/gas.h"

#include <algorithm>
#include <numeric>

#include "dem/space/elementary.h"

namespace grainfield::dem {
namespace {

// Neighbours at the start are apart by this share of their distance at least: beyond round-off.
constexpr double kRoom = 1e-6;

/// A lattice that fills a box of side 1 with periodic neighbours.
template <int D>
struct Lattice {
  std::array<std::int64_t, D> cells{};
  std::vector<VectorOf<D>> basis;  // over a cell's edges
  double nearest = 0;              // of two sites

  std::int64_t sites() const {
    std::int64_t out = static_cast<std::int64_t>(basis.size());
    for (const std::int64_t n : cells) out *= n;
    return out;
  }
  VectorOf<D> site(std::int64_t k) const {
    VectorOf<D> out = basis[static_cast<std::size_t>(k) % basis.size()];
    k /= static_cast<std::int64_t>(basis.size());
    for (int a = 0; a < D; ++a) {
      out[a] = (out[a] + static_cast<double>(k % cells[a])) / static_cast<double>(cells[a]);
      k /= cells[a];
    }
    return out;
  }
};

// The lattice with the widest distance among those with sites enough.
Lattice<2> lattice_for(std::int64_t grains, std::integral_constant<int, 2>) {
  Lattice<2> best;
  for (std::int64_t columns = 1; columns * columns <= 4 * grains; ++columns) {
    Lattice<2> one;
    one.basis = {{0.25, 0.25}, {0.75, 0.75}};
    one.cells = {columns, (grains + 2 * columns - 1) / (2 * columns)};
    const double x = 1.0 / static_cast<double>(columns);
    const double y = 1.0 / static_cast<double>(one.cells[1]);
    one.nearest = std::min({x, y, 0.5 * std::sqrt(x * x + y * y)});
    if (one.nearest > best.nearest) best = one;
  }
  return best;
}

Lattice<3> lattice_for(std::int64_t grains, std::integral_constant<int, 3>) {
  Lattice<3> out;
  std::int64_t n = 1;
  while (4 * n * n * n < grains) ++n;
  out.cells = {n, n, n};
  out.basis = {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.25}, {0.75, 0.25, 0.75}, {0.25, 0.75, 0.75}};
  out.nearest = std::sqrt(0.5) / static_cast<double>(n);
  return out;
}

template <int D>
double side_of(const GasSetup& gas) {
  const double volume =
      static_cast<double>(gas.grains) * round_volume<D>(gas.radius) / gas.fraction;
  return D == 2 ? std::sqrt(volume) : cube_root(volume);
}

// Two numbers of the normal distribution of mean 0 and variance 1 (Box and Muller 1958).
std::array<double, 2> normal(Random& random) {
  const double size = std::sqrt(-2 * natural_log(1 - random.uniform()));
  const Rotation turn = rotation_of(2 * std::numbers::pi * random.uniform());
  return {size * turn.cosine, size * turn.sine};
}

}  // namespace

template <int D>
HardBox<D> gas_box(const GasSetup& gas) {
  HardBox<D> out;
  out.size.setConstant(side_of<D>(gas));
  out.periodic.fill(true);
  return out;
}

template <int D>
double largest_fraction(std::int64_t grains, double radius) {
  const auto lattice = lattice_for(grains, std::integral_constant<int, D>());
  const double side = 2 * radius * (1 + kRoom) / lattice.nearest;
  return static_cast<double>(grains) * round_volume<D>(radius) / std::pow(side, D);
}

template <int D>
std::vector<Body<D>> start_gas(const GasSetup& gas, Random& random) {
  const auto lattice = lattice_for(gas.grains, std::integral_constant<int, D>());
  // The first of all sites in an order that is drawn (Fisher and Yates).
  std::vector<std::int64_t> sites(static_cast<std::size_t>(lattice.sites()));
  std::iota(sites.begin(), sites.end(), 0);
  const auto n = static_cast<std::size_t>(gas.grains);
  for (std::size_t k = 0; k < n; ++k) {
    const double left = static_cast<double>(sites.size() - k);
    std::swap(sites[k], sites[k + static_cast<std::size_t>(random.uniform() * left)]);
  }
  std::sort(sites.begin(), sites.begin() + static_cast<std::ptrdiff_t>(n));

  Body<D> like;
  like.radius = gas.radius;
  like.inverse_mass = 1 / gas.mass;
  like.inverse_inertia = 1 / round_inertia<D>(gas.mass, gas.radius);
  std::vector<Body<D>> out(n, like);
  const double side = side_of<D>(gas);
  VectorOf<D> mean = VectorOf<D>::Zero();
  for (std::size_t k = 0; k < n; ++k) {
    out[k].position = side * lattice.site(sites[k]);
    const auto first = normal(random), second = D == 3 ? normal(random) : first;
    for (int a = 0; a < D; ++a) out[k].velocity[a] = a < 2 ? first[a] : second[0];
    mean += out[k].velocity / static_cast<double>(n);
  }
  for (Body<D>& g : out) g.velocity -= mean;
  const double scale = gas.speed / std::sqrt(temperature_of(out) / gas.mass);
  for (Body<D>& g : out) g.velocity *= scale;
  return out;
}

template <int D>
double temperature_of(const std::vector<Body<D>>& grains) {
  double sum = 0;
  for (const Body<D>& g : grains) sum += g.velocity.squaredNorm() / g.inverse_mass;
  return sum / (D * (static_cast<double>(grains.size()) - 1));
}

template <int D>
double spin_temperature_of(const std::vector<Body<D>>& grains) {
  double sum = 0;
  for (const Body<D>& g : grains) sum += square_of(g.spin) / g.inverse_inertia;
  return sum / ((D == 2 ? 1 : 3) * static_cast<double>(grains.size()));
}

#define GRAINFIELD_GAS(D)                                               \
  template HardBox<D> gas_box<D>(const GasSetup&);                      \
  template double largest_fraction<D>(std::int64_t, double);            \
  template std::vector<Body<D>> start_gas<D>(const GasSetup&, Random&); \
  template double temperature_of<D>(const std::vector<Body<D>>&);       \
  template double spin_temperature_of<D>(const std::vector<Body<D>>&);
GRAINFIELD_GAS(2)
GRAINFIELD_GAS(3)

}  // namespace grainfield::dem
