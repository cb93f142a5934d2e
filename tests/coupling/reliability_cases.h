// Runs of a second or two that pass through every phase: grains, analysis, pictures, publishing.
#pragma once
#include <string>
#include <vector>

#include "program.h"

namespace grainfield::coupling::testing {

struct TinyStudy {
  std::string name;
  std::string text;     ///< the case file
  std::string another;  ///< --set that makes it another run with the same names of files
};

/// About 60 disks under a load.
inline std::string small_layer(const std::string& more = "") {
  return R"(title = "small layer"
[packing]
kind = "triangular"
sizes = "mono"
columns = 9
rows = 7
jitter = 0.02
[rest]
background_damping = 300
unbalanced_force_ratio = 1e-4
kinetic_to_elastic_energy = 1e-7
[load]
force = 1
ramp_time = 0.8
[ensemble]
realizations = 3
[average]
depths = [0.5]
points = 11
map_columns = 5
map_rows = 4
[compare]
models = ["flamant"]
)" + more;
}

inline std::string small_pile() {
  return R"(title = "small pile"
study = "pile"
[shape]
radius = 0.0275
[source]
grains = 30
height = 0.4
interval = 0.11
[floor]
length = 4.0
[material]
young = 1e6
[rest]
background_damping = 300
unbalanced_force_ratio = 1e-3
kinetic_to_elastic_energy = 1e-5
[ensemble]
realizations = 2
[average]
points = 21
map_columns = 9
map_rows = 5
[heap]
heights = [0.25]
)";
}

inline std::string models_alone() {
  return R"(title = "models alone"
study = "osl-layer"
[problem]
force = 300
height = 0.15
half_width = 0.2
depths = [0.075, 0.15]
points = 241
[compare]
models = ["closed_form", "march"]
[model.closed_form]
name = "osl_layer"
eta = 0.5
mu = 0
width = 0.03
[model.march]
name = "fe_osl_layer"
eta = 0.5
mu = 0
width = 0.03
half_width = 1.4
solver = "march"
columns = 100
)";
}

inline const std::vector<TinyStudy>& tiny_studies() {
  static const std::vector<TinyStudy> all{
      {"layer", small_layer(), "ensemble.seed=2"},
      {"sweep", small_layer("[sweep]\nkey = \"material.friction\"\nvalues = [0.2, 0.5]\n"),
       "ensemble.seed=2"},
      {"pile", small_pile(), "ensemble.seed=2"},
      {"models", models_alone(), "problem.force=200"}};
  return all;
}

}  // namespace grainfield::coupling::testing
