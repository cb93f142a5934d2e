#include "coupling/studies/cone/finished_cones.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "coupling/averaging/base.h"
#include "dem/study/cone_file.h"

namespace grainfield::coupling {

dem::RunResult finished_cone(const FinishedRun& place, const dem::ConeSetup& setup) {
  const dem::Snapshot cone = dem::read_snapshot(place.file, place.group + "/pile");
  const std::string where = fmt::format("{}:{}/pile", place.file, place.group);
  if (cone.dim != 3) {
    throw std::invalid_argument(fmt::format("grains.files: {} is 2D, a 3D one is needed", where));
  }
  const auto free = std::count_if(cone.grains.begin(), cone.grains.end(),
                                  [](const dem::Grain& g) { return !g.fixed; });
  if (free == 0 || !has_base(cone)) {
    throw std::invalid_argument(
        fmt::format("grains.files: {} has no {}", where,
                    free > 0 ? "base: a wall \"floor\" or fixed grains" : "free grain"));
  }
  dem::check_same_cone(setup, cone, where);
  dem::RunResult out;
  out.snapshots.emplace_back("pile", cone);
  out.figures["dem.grains"] = static_cast<double>(free);
  return out;
}

}  // namespace grainfield::coupling
