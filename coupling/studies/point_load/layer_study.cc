#include "coupling/studies/point_load/layer_study.h"

#include <fmt/format.h>

#include <stdexcept>

#include "coupling/run/averaging_setup.h"
#include "coupling/run/grain_keys.h"
#include "coupling/studies/point_load/keys.h"
#include "coupling/studies/point_load/simulation.h"
#include "dem/run/setup.h"

namespace grainfield::coupling {

Study layer_study() {
  Study out;
  out.sections = {kGrainFilesKeys, kPackingKeys, kMaterialKeys, kMotionKeys,
                  kRestKeys,       kLoadKeys,    kAverageKeys};
  out.material = [](Case& c) -> dem::MaterialSetup& {
    return c.get<dem::PointLoadSetup>().material;
  };
  out.grain_radius = [](const Case& c) {
    return dem::mean_radius(c.get<dem::PointLoadSetup>().packing);
  };
  out.motion = [](Case& c) -> dem::MotionSetup& { return c.get<dem::PointLoadSetup>().motion; };
  out.rest = [](Case& c) -> dem::RestSetup& { return c.get<dem::PointLoadSetup>().rest; };
  out.fills = {"F", "h", "dim", "depth"};
  out.dimension = [](const Case& value) { return value.get<dem::PointLoadSetup>().packing.dim; };
  out.dimension_key = "packing.dim";
  return out;
}

void check_one_load(const Case& value) {
  const auto& setup = value.get<dem::PointLoadSetup>();
  const dem::LoadSetup &load = setup.load, standard;
  if (setup.packing.dim == 2 || load.weights == 0 || load.force == standard.force) return;
  throw std::invalid_argument(
      fmt::format("load.force: found {:g} beside load.weights = {:g}, the load in weights of a "
                  "sphere; allowed: one of both; to give N, add --set load.weights=0",
                  load.force, load.weights));
}

}  // namespace grainfield::coupling
