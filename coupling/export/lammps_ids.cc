#include "coupling/export/lammps_ids.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "coupling/result/csv.h"

namespace grainfield::coupling {

LammpsIds::LammpsIds(const dem::Snapshot& packing) {
  constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
  std::int64_t least = most, largest = 0;
  for (const dem::Grain& g : packing.grains) {
    least = std::min(least, g.id);
    largest = std::max(largest, g.id);
  }
  kept_ = least >= 1 && largest <= most;
  shifted_ = least == 0 && largest < most;
  std::int64_t number = 0;
  for (const dem::Grain& g : packing.grains) {
    ++number;
    ids_[g.id] = kept_ ? g.id : shifted_ ? g.id + 1 : number;
  }
}

std::string LammpsIds::note(bool copied) const {
  return fmt::format("ids are {} (LAMMPS' are 1 to 2147483647){}",
                     shifted_ ? "one more than the packing's" : "numbers from 1",
                     copied ? "; the way back keeps LAMMPS' ids, for it makes those of the copies"
                            : ": ids.csv has both, and the import in in.lammps gives the packing's "
                              "back (--ids)");
}

std::string LammpsIds::csv(const dem::Snapshot& packing) const {
  Csv out;
  out.row("id", "original");
  for (const dem::Grain& g : packing.grains) out.row(of(g.id), g.id);
  return out.text();
}

}  // namespace grainfield::coupling
