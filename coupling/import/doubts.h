// What is wrong with the forces of a packing that was made elsewhere.
#pragma once
#include <string>
#include <vector>

#include "coupling/import/import.h"

namespace grainfield::coupling {

/// Why the contacts of a packing under gravity pull where grains push: the stress along gravity,
/// pairs and walls together, is tension (positive); one sentence with the remedy. Empty: it is
/// compression, or there is no gravity or no contact.
std::string tension_in(const PackingCheck& check);

/// What makes fits of it doubtful, a sentence each: an unbalanced force ratio above 0.1, walls and
/// fixed grains that carry another part of the weight than 0.9 to 1.1, contacts with walls more
/// than two radii off them. `tension_in` aside.
std::vector<std::string> doubts_of(const PackingCheck& check);

/// Of the free grains; nan without one.
struct GrainSizes {
  double density = 0;   ///< all mass over all volume, kg/m3 (2D kg/m2)
  double diameter = 0;  ///< mean, m
};
GrainSizes grain_sizes(const dem::Snapshot& packing);

/// Why the units may not be SI: a mean density of the free grains (mass over volume) outside 10 to
/// 30,000 kg/m3 (2D kg/m2) or a mean diameter outside 0.1 um to 100 m; one sentence. Empty:
/// neither.
std::string strange_units(const dem::Snapshot& packing);

/// The doubts of several packings as one list: the first that has each, and how many others do.
class DoubtList {
 public:
  void add(const std::string& name, const PackingCheck& check);
  std::vector<std::string> lines() const;

 private:
  struct Entry {
    std::string first;
    int others = 0;
  };
  std::vector<Entry> entries_{3};  // in the order of doubts_of
};

}  // namespace grainfield::coupling
