// Models fitted to the response of two tiny packings.
#pragma once
#include <string>

namespace grainfield::coupling::testing {

inline std::string tiny_verdict(const std::string& more = "") {
  return R"(title = "tiny verdict"
study = "point-load"
[packing]
kind = "triangular"
sizes = "mono"
columns = 11
rows = 5
[rest]
background_damping = 300
unbalanced_force_ratio = 1e-4
kinetic_to_elastic_energy = 1e-7
[load]
force = 1
ramp_time = 0.01
[ensemble]
realizations = 3
[average]
methods = ["coarse_graining"]
depths = [0.5]
points = 11
map_columns = 9
map_rows = 5
[fit]
models = ["flamant", "layer_smooth", "layer_rough", "osl_layer_absorbing"]
finite_elements = []
bootstrap = 0
[sweep]
key = "variant"
values = ["even", "uneven"]
[variant.even]
packing.jitter = 0.01
[variant.uneven.packing]
jitter = 0.04
)" + more;
}

}  // namespace grainfield::coupling::testing
