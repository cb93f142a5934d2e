// What is wrong with the forces of a packing that was made elsewhere.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "coupling/import/import.h"

namespace grainfield::coupling {

/// Why the contacts of a packing pull where grains push: nearly all between grains, or nearly all
/// with walls, pull and the others push, or the stress along gravity, or the mean stress, pairs and
/// walls together, is tension (positive); one sentence with the remedy. Empty: none of these.
std::string tension_in(const PackingCheck& check);

/// What makes fits of it doubtful, a sentence each: an unbalanced force ratio above 0.1, walls and
/// fixed grains that carry another part of the weight than 0.9 to 1.1 (or one that is off by 2 %
/// and three of its errors), one in a hundred contacts or more that pull, contacts with walls more
/// than two radii off them, normals far off the line of centres, tangential forces beyond friction
/// or, where it is unknown, above the normal ones in a tenth of the pairs.
/// `tension_in` aside.
std::vector<std::string> warnings_of(const PackingCheck& check);

/// Sizes of the free grains; nan without one.
struct GrainSizes {
  double density = 0;             ///< all mass over all volume, kg/m3 (2D kg/m2)
  double density_as_spheres = 0;  ///< over the volume of spheres of their radii, kg/m3
  double diameter = 0;            ///< mean, m
};
GrainSizes grain_sizes(const dem::Snapshot& packing);

/// Why the units may not be SI: a mean density of the free grains (mass over volume) outside 10 to
/// 30,000 kg/m3 (2D kg/m2, unless it is within as that of spheres, in kg/m3) or a mean diameter
/// outside 0.1 um to 100 m, or moments of inertia that no mass within the radius has; one sentence.
/// Empty: none of them.
std::string strange_units(const dem::Snapshot& packing);

/// The warnings of several packings as one list: of each kind the first packing that has it, and
/// how many others do.
class PackingWarnings {
 public:
  /// Nothing where the text is empty.
  void add(std::size_t kind, const std::string& packing, const std::string& text);
  /// All of warnings_of, kinds from 0.
  void add(const std::string& packing, const PackingCheck& check);
  /// In the order of their kinds; `noun`: of the others.
  std::vector<std::string> lines(const std::string& noun = "other packing") const;

 private:
  struct Entry {
    std::string first;
    int others = 0;
  };
  std::map<std::size_t, Entry> entries_;
};

}  // namespace grainfield::coupling
