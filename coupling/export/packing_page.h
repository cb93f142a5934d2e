// A packing as one page of HTML that needs nothing else: it zooms and pans (in space it turns), and
// shows a grain's numbers under the pointer.
#pragma once
#include <string>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// The page. Grains are drawn with their outlines, in space as balls of their radius (of a
/// superellipsoid: of its volume), coloured by mean stress, contacts, speed or size; contacts as
/// lines whose width grows with the normal force. Numbers have six digits.
std::string packing_page(const dem::Snapshot& packing, const std::string& title);

/// (1/V) sum of F (outer) x over a grain's contacts, x from its centre: minus its trace over the
/// dimension, of every grain, N/m2 (2D: N/m), compression positive; and its number of contacts.
struct GrainNumbers {
  std::vector<double> mean_stress;
  std::vector<int> contacts;
};
GrainNumbers grain_numbers(const dem::Snapshot& packing);

}  // namespace grainfield::coupling
