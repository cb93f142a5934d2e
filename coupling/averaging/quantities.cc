#include "coupling/averaging/quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "continuum/constants.h"
#include "coupling/base/unknown_name.h"

namespace grainfield::coupling {
namespace {

using F = GrainFacts;
using S = PointSums;

double ratio(double a, double b) { return b > 0 ? a / b : kNan; }
double own(const S& s, int, int, int k) { return s.own[k]; }

// Kinetic stress of the velocities about their local mean: density V V - sum m v v phi.
double kinetic(const S& s, int a, int b, int k) {
  return s.mass() == 0 ? 0 : s.momentum(a) * s.momentum(b) / s.mass() - s.own[k];
}

std::vector<std::pair<int, int>> pairs_of(Rank rank, int dim) {
  if (rank == Rank::scalar) return {{0, 0}};
  std::vector<std::pair<int, int>> out;
  if (rank == Rank::vector || rank == Rank::symmetric || rank == Rank::full)
    for (int a = 0; a < dim; ++a) out.emplace_back(a, rank == Rank::vector ? 0 : a);
  if (rank == Rank::vector) return out;
  const std::vector<std::pair<int, int>> mixed =
      dim == 2 ? std::vector<std::pair<int, int>>{{0, 1}}
               : std::vector<std::pair<int, int>>{{1, 2}, {0, 2}, {0, 1}};
  for (const auto& [a, b] : mixed) {
    out.emplace_back(a, b);
    if (rank == Rank::full) out.emplace_back(b, a);
  }
  return out;
}

}  // namespace

const std::vector<Quantity>& quantities() {
  // clang-format off
  static const std::vector<Quantity> all{
      {"sigma", Rank::full, "N/m", "N/m2", "contact stress; sigma_ab: force a, branch b",
       nullptr, [](const S& s, int a, int b, int) { return s.stress(a, b); }},
      {"sigma_antisymmetric", Rank::antisymmetric, "N/m", "N/m2", "(sigma_ab - sigma_ba)/2",
       nullptr, [](const S& s, int a, int b, int) { return (s.stress(a, b) - s.stress(b, a)) / 2; }},
      {"kinetic", Rank::symmetric, "N/m", "N/m2", "stress of the velocities about the local mean velocity",
       [](const F& f, int a, int b) { return f.grain->mass * f.grain->velocity[a] * f.grain->velocity[b]; }, kinetic},
      {"density", Rank::scalar, "kg/m2", "kg/m3", "mass density",
       nullptr, [](const S& s, int, int, int) { return s.mass(); }},
      {"volume_fraction", Rank::scalar, "1", "1", "grain area (volume) per area (volume)",
       nullptr, [](const S& s, int, int, int) { return s.volume(); }},
      {"traction", Rank::vector, "N/m2", "N/m3", "force density of walls and fixed grains",
       nullptr, [](const S& s, int a, int, int) { return s.traction(a); }},
      {"load", Rank::vector, "N/m2", "N/m3", "force density of the applied force",
       [](const F& f, int a, int) { return f.load[a]; }, own},
      {"momentum", Rank::vector, "kg/(m s)", "kg/(m2 s)", "momentum density",
       nullptr, [](const S& s, int a, int, int) { return s.momentum(a); }},
      {"coordination", Rank::scalar, "1", "1", "mean contacts per grain",
       [](const F& f, int, int) { return double(f.contacts); },
       [](const S& s, int, int, int k) { return ratio(s.own[k], s.weight()); }},
      {"coordination_bearing", Rank::scalar, "1", "1", "the same without rattlers and their contacts",
       [](const F& f, int, int) { return double(f.bearing_contacts); },
       [](const S& s, int, int, int k) { return ratio(s.own[k], s.bearing()); }},
      {"rattlers", Rank::scalar, "1", "1", "share of the grains that are rattlers",
       nullptr, [](const S& s, int, int, int) { return ratio(s.weight() - s.bearing(), s.weight()); }},
      {"fabric", Rank::symmetric, "1", "1", "(1/V) sum V_p sum n n, n along the branch (Roul 2.96)",
       [](const F& f, int a, int b) { return f.grain->volume * f.fabric(a, b); }, own},
      {"inertia", Rank::symmetric, "m4", "m5", "(1/V) sum V_p theta, inertia tensor of the grains (Roul 2.92)",
       [](const F& f, int a, int b) { return f.grain->volume * f.inertia(a, b); }, own},
      {"grains", Rank::scalar, "1", "1", "grains in the support (area_exact: sum of their shares)",
       nullptr, [](const S& s, int, int, int) { return s.count(); }},
  };
  // clang-format on
  return all;
}

std::string column_name(const Quantity& quantity, int dim, int a, int b, const char* axes) {
  const Rank rank = quantity.rank;
  if (rank == Rank::scalar || (rank == Rank::antisymmetric && dim == 2)) return quantity.name;
  if (rank == Rank::vector) return fmt::format("{}_{}", quantity.name, axes[a]);
  return fmt::format("{}_{}{}", quantity.name, axes[a], axes[b]);
}

Layout::Layout(int dim, const std::vector<std::string>& names) : dim_(dim) {
  std::vector<std::string> known;
  for (const Quantity& quantity : quantities()) known.push_back(quantity.name);
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw std::invalid_argument(unknown_name("quantity", name, known));
  size_ = carried() + 4 + dim;
  for (const Quantity& quantity : quantities()) {
    if (!names.empty() && std::find(names.begin(), names.end(), quantity.name) == names.end())
      continue;
    const auto pairs = pairs_of(quantity.rank, dim);
    int k = 0;
    for (const auto& [a, b] : pairs)
      components_.push_back({column_name(quantity, dim, a, b),
                             dim == 2 ? quantity.unit_2d : quantity.unit_3d, &quantity, a, b, k++,
                             size_});
    if (quantity.of_grain) size_ += static_cast<int>(pairs.size());
  }
}

void Layout::load(const GrainFacts& f, double* row) const {
  for (int a = 0; a < dim_; ++a)
    for (int b = 0; b < dim_; ++b) row[a * dim_ + b] = f.virial(a, b);
  double* at = row + dim_ * dim_;
  at[0] = 1;
  at[1] = f.grain->mass;
  at[2] = f.grain->volume;
  at[3] = f.bearing ? 1 : 0;
  for (int a = 0; a < dim_; ++a) at[4 + a] = f.grain->mass * f.grain->velocity[a];
  for (const Component& c : components_)
    if (c.quantity->of_grain) at[c.own - carried() + c.k] = c.quantity->of_grain(f, c.a, c.b);
}

double Layout::value(const Component& c, const double* row) const {
  const PointSums sums{row, row + c.own, dim_};
  return c.quantity->value(sums, c.a, c.b, c.k);
}

}  // namespace grainfield::coupling
