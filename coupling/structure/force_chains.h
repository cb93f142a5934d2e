// Force chains: lines of stressed grains along the direction in which they are pressed.
//
// Peters, Muthuswamy, Wibowo, Tordesillas, Phys. Rev. E 72 (2005) 041307:
// - a grain's stress is that of its contacts, sum F (outer) x / V_p; its direction d is the axis of
//   the greatest compression, its load the greatest compression p;
// - only grains with p above the mean over all grains that bear can be in a chain;
// - the next grain touches it, and the line of centres turns from the direction of either by less
//   than 45 degrees;
// - at least three grains make a chain.
// Where several grains lie in the sector, the one across the contact of the largest normal force
// follows, and it must choose back: chains do not branch, and a grain is in at most one. Fixed
// grains and walls end chains. 2D and 3D.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

struct ChainOptions {
  double largest_turn_deg = 45;  ///< above 0, at most 90; less: fewer, straighter chains
  int least_grains = 3;          ///< 2 or more
  double least_load = 1;         ///< of the mean greatest compression
};

struct ForceChain {
  std::vector<std::int64_t> grains;    ///< indices into the snapshot, from end to end
  std::vector<std::int64_t> contacts;  ///< indices of the contacts between them, one fewer; a
                                       ///< closed ring has as many as grains
};

struct ForceChains {
  std::vector<ForceChain> chains;  ///< by their first grain; the lower end index first
  std::vector<int> chain_of;       ///< per grain of the snapshot: index of its chain, or -1
  int bearing = 0;                 ///< free grains that are no rattlers
  int stressed = 0;                ///< of them: load above least_load times the mean
  int in_chains = 0;
  double mean_load = 0;    ///< mean greatest compression of the bearing grains, N/m (N/m2)
  double mean_length = 0;  ///< grains per chain; nan without chains
};

/// Per contact of a snapshot with so many: the index of the chain that it links, or -1.
std::vector<int> chain_of_contacts(const ForceChains& chains, std::size_t contacts);

/// Throws std::invalid_argument for options out of range.
ForceChains force_chains(const dem::Snapshot& snapshot, const ChainOptions& options = {});

}  // namespace grainfield::coupling
