// How far a packing's response to a small load (small_loads.h) may be multiplied before a contact
// opens or begins to slide.
//
// The response changes normal force f_n and tangential force f_t of a contact with friction mu by
// d_n and d_t. Multiplied by s it opens the contact at f_n + s d_n = 0, and brings one that sticks
// to Coulomb's limit at the least s > 0 with |f_t + s d_t| = mu (f_n + s d_n). With friction a
// contact slides before it opens; one at the limit to the last digit counts as sliding. Contacts
// that close, normals that turn, and rolling resistance are left out.
#pragma once
#include <limits>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

struct LinearRange {
  /// Factors at which the first contact is open, and at which the first one begins to slide;
  /// infinite: never.
  double opens = std::numeric_limits<double>::infinity();
  double slides = std::numeric_limits<double>::infinity();
  std::vector<double> changes{};  ///< of each contact the lesser of its two, ascending

  /// Where this share of the contacts, and at least one, has opened or begun to slide.
  double changed(double share) const;
};

/// `rest`: what the response started from (SmallLoads::start); `change`: SmallResponse::change.
LinearRange linear_range(const Snapshot& rest, const Snapshot& change);

}  // namespace grainfield::dem
