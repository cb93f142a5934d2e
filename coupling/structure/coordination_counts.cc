#include "coupling/structure/coordination_counts.h"

#include "continuum/constants.h"
#include "coupling/averaging/grain_facts.h"

namespace grainfield::coupling {

CoordinationCounts coordination_counts(const dem::Snapshot& snapshot) {
  CoordinationCounts out;
  const auto count = [](std::vector<int>& list, int contacts) {
    const auto k = static_cast<std::size_t>(contacts);
    if (list.size() <= k) list.resize(k + 1, 0);
    ++list[k];
  };
  double contacts = 0, bearing = 0;
  for (const GrainFacts& facts : grain_facts(snapshot)) {
    if (facts.grain->fixed) continue;
    ++out.grains;
    count(out.with, facts.contacts);
    contacts += facts.contacts;
    if (!facts.bearing) {
      ++out.rattlers;
      continue;
    }
    count(out.with_bearing, facts.bearing_contacts);
    bearing += facts.bearing_contacts;
  }
  const int bearers = out.grains - out.rattlers;
  out.mean = out.grains > 0 ? contacts / out.grains : kNan;
  out.mean_bearing = bearers > 0 ? bearing / bearers : kNan;
  return out;
}

}  // namespace grainfield::coupling
