// The strongest and the weakest force on every grain (Liffman et al. 1992, figures 10 and 16).
#pragma once
#include <string>
#include <vector>

#include "coupling/report/picture.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

enum class Extreme { strongest, weakest };

/// Contacts between grains, indices into Snapshot::contacts in ascending order, that carry the
/// largest or the smallest normal force of those on one of their two grains. Forces that differ by
/// less than `alike` of the larger one count as equal: all such contacts are taken. Contacts that
/// carry less than `least` of the mean force are none.
std::vector<std::size_t> extreme_contacts(const dem::Snapshot& snapshot, Extreme which,
                                          double alike = 1e-6, double least = 1e-6);

/// Share of these contacts whose normal is within 15 degrees of the horizontal.
double horizontal_share(const dem::Snapshot& snapshot, const std::vector<std::size_t>& contacts);

/// The packing with lines between the centres of these contacts' grains.
Picture force_lines(const std::string& title, const dem::Snapshot& snapshot, Extreme which);

}  // namespace grainfield::coupling
