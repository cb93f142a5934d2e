#include "coupling/structure/force_chains.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "continuum/constants.h"
#include "coupling/averaging/grain_facts.h"
#include "coupling/structure/tensor_axes.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;

// What a grain sees along +direction (0) and against it (1).
struct Ends {
  std::array<std::int64_t, 2> contact{-1, -1};
};

struct Stressed {
  Vec3 direction{0, 0, 0};
  double load = 0;
  bool chosen = false;
};

std::vector<Stressed> stresses(const dem::Snapshot& s, const ChainOptions& options,
                               ForceChains& out) {
  std::vector<Stressed> grains(s.grains.size());
  const std::vector<GrainFacts> facts = grain_facts(s);
  double sum = 0;
  for (std::size_t g = 0; g < facts.size(); ++g) {
    if (facts[g].grain->fixed || !facts[g].bearing) continue;
    const TensorAxes axes = tensor_axes(facts[g].virial / facts[g].grain->volume, s.dim);
    grains[g].direction.head(s.dim) = axes.axes.col(s.dim - 1).head(s.dim);
    grains[g].load = -axes.values[s.dim - 1];
    grains[g].chosen = true;
    sum += grains[g].load;
    ++out.bearing;
  }
  out.mean_load = out.bearing > 0 ? sum / out.bearing : kNan;
  for (Stressed& grain : grains) {
    grain.chosen = grain.chosen && grain.load > options.least_load * out.mean_load;
    if (grain.chosen) ++out.stressed;
  }
  return grains;
}

}  // namespace

std::vector<int> chain_of_contacts(const ForceChains& chains, std::size_t contacts) {
  std::vector<int> out(contacts, -1);
  for (std::size_t c = 0; c < chains.chains.size(); ++c)
    for (const std::int64_t k : chains.chains[c].contacts)
      out.at(static_cast<std::size_t>(k)) = static_cast<int>(c);
  return out;
}

ForceChains force_chains(const dem::Snapshot& s, const ChainOptions& options) {
  if (!(options.largest_turn_deg > 0 && options.largest_turn_deg <= 90))
    throw std::invalid_argument(
        fmt::format("force chains: found a largest turn of {:g} degrees, allowed: above 0 to 90",
                    options.largest_turn_deg));
  if (options.least_grains < 2)
    throw std::invalid_argument(
        fmt::format("force chains: found {} grains at least, allowed: 2 and "
                    "above",
                    options.least_grains));
  ForceChains out;
  out.chain_of.assign(s.grains.size(), -1);
  const std::vector<Stressed> grains = stresses(s, options, out);
  const double least = std::cos(options.largest_turn_deg * std::numbers::pi / 180);

  // Which end of its first (second) grain's direction the other grain lies at; -1: outside both
  // sectors.
  const auto end_towards = [&](const dem::Contact& c, bool second) {
    const std::int64_t g = second ? c.j : c.i;
    const Vec3 branch = (second ? -1 : 1) * (dem::second_place(s, c) -
                                             s.grains[static_cast<std::size_t>(c.i)].position);
    const double along = branch.dot(grains[static_cast<std::size_t>(g)].direction) / branch.norm();
    if (!(std::abs(along) > least)) return -1;
    return along > 0 ? 0 : 1;
  };
  std::vector<Ends> ends(s.grains.size());
  for (std::size_t k = 0; k < s.contacts.size(); ++k) {
    const dem::Contact& c = s.contacts[k];
    if (c.j < 0 || !(c.normal_force > 0)) continue;
    if (!grains[static_cast<std::size_t>(c.i)].chosen ||
        !grains[static_cast<std::size_t>(c.j)].chosen)
      continue;
    const int at_i = end_towards(c, false), at_j = end_towards(c, true);
    if (at_i < 0 || at_j < 0) continue;
    for (auto [grain, end] : {std::pair(c.i, at_i), std::pair(c.j, at_j)}) {
      std::int64_t& best =
          ends[static_cast<std::size_t>(grain)].contact[static_cast<std::size_t>(end)];
      if (best < 0 || c.normal_force > s.contacts[static_cast<std::size_t>(best)].normal_force)
        best = static_cast<std::int64_t>(k);
    }
  }
  // Links that both grains chose.
  const auto link = [&](std::int64_t g, std::size_t end) -> std::int64_t {
    const std::int64_t k = ends[static_cast<std::size_t>(g)].contact[end];
    if (k < 0) return -1;
    const dem::Contact& c = s.contacts[static_cast<std::size_t>(k)];
    const auto& back = ends[static_cast<std::size_t>(c.i == g ? c.j : c.i)].contact;
    return back[0] == k || back[1] == k ? k : -1;
  };
  std::vector<bool> met(s.grains.size(), false);
  const auto walk = [&](std::int64_t g, std::size_t end) {
    ForceChain chain;
    while (true) {
      met[static_cast<std::size_t>(g)] = true;
      chain.grains.push_back(g);
      const std::int64_t k = link(g, end);
      if (k < 0) return chain;
      const dem::Contact& c = s.contacts[static_cast<std::size_t>(k)];
      chain.contacts.push_back(k);
      g = c.i == g ? c.j : c.i;
      if (met[static_cast<std::size_t>(g)]) return chain;  // a ring has closed
      end = ends[static_cast<std::size_t>(g)].contact[0] == k ? 1 : 0;
    }
  };
  const auto keep = [&](ForceChain chain) {
    if (static_cast<int>(chain.grains.size()) < options.least_grains) return;
    for (const std::int64_t g : chain.grains)
      out.chain_of[static_cast<std::size_t>(g)] = static_cast<int>(out.chains.size());
    out.in_chains += static_cast<int>(chain.grains.size());
    out.chains.push_back(std::move(chain));
  };
  const auto n = static_cast<std::int64_t>(s.grains.size());
  for (const bool rings : {false, true}) {
    for (std::int64_t g = 0; g < n; ++g) {
      if (met[static_cast<std::size_t>(g)] || !grains[static_cast<std::size_t>(g)].chosen) continue;
      const bool first = link(g, 0) >= 0, second = link(g, 1) >= 0;
      if (first && second && !rings) continue;
      keep(walk(g, first ? 0 : 1));
    }
  }
  out.mean_length = out.chains.empty() ? kNan
                                       : static_cast<double>(out.in_chains) /
                                             static_cast<double>(out.chains.size());
  return out;
}

}  // namespace grainfield::coupling
