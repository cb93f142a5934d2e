#include "coupling/studies/point_load/layer_study.h"

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

}  // namespace grainfield::coupling
