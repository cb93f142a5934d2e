#include "coupling/case/doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "coupling/case/material.h"
#include "coupling/case/study.h"

namespace grainfield::coupling {
namespace {

constexpr double kLargeGrain = 0.5;                // m, of a radius or side: a boulder's
constexpr double kLightest = 10, kHeaviest = 1e5;  // kg/m3, kg/m2
// Roul's formula as printed amounts to 11, which is a study of its own.
constexpr double kLeastRatio = 0.09, kMostRatio = 1.5;  // k_t/k_n
constexpr double kLeastRestitution = 0.05, kMostRestitution = 0.99;
constexpr double kDeepFall = 1000;  // grain diameters

constexpr std::array kSizes{"shape.radius",       "shape.side",         "packing.radius",
                            "packing.radius_min", "packing.radius_max", "packing.radius_small",
                            "packing.side",       "cone.radius",        "sample.radius",
                            "lattice.radius",     "settling.radius"};
// A height from which grains fall, and the size of these.
constexpr std::array kFalls{std::pair{"source.height", "shape.radius"},
                            std::pair{"cone.drop", "cone.radius"},
                            std::pair{"packing.drop_height", "packing.radius_max"}};

// The value of a key that means something here; nothing for others.
std::optional<double> value_of(const Draft& draft, const std::string& path) {
  const Key* key = find_key(path);
  if (key == nullptr || !key_applies(*key, draft.value.study)) return std::nullopt;
  if (is_without_effect(*key, draft.value)) return std::nullopt;
  const auto* where = std::get_if<double& (*)(Case&)>(&key->where);
  if (where == nullptr) return std::nullopt;
  return (*where)(const_cast<Case&>(draft.value));  // only read
}

// Only what somebody wrote.
std::optional<double> written_value(const Draft& draft, const std::string& path) {
  return draft.last.contains(path) ? value_of(draft, path) : std::nullopt;
}

std::string in_millimetres(double value) {
  return fmt::format("the unit is m; {0:g} mm is written \"{0:g} mm\"", value);
}

// Stiffness along a contact over that across it, and what the dashpots leave, outside of what the
// laws' users take.
template <class Add>
void add_material_doubts(const Draft& draft, const Add& add) {
  const auto grain = nominal_grain(draft.value);
  const Study* study = find_study(draft.value.study);
  if (!grain || !(grain->radius > 0)) return;
  const dem::MaterialSetup& m = study->material(const_cast<Case&>(draft.value));  // only read
  const bool frictionless = m.friction == 0 && m.floor_friction == 0 && m.wall_friction == 0;
  const double ratio = dem::stiffness_ratio(m);
  for (const char* path : {"material.tangential_stiffness", "material.tangential_ratio"}) {
    if (frictionless || !written_value(draft, path) ||
        (ratio >= kLeastRatio && ratio <= kMostRatio)) {
      continue;
    }
    const bool absolute = std::string_view(path) == "material.tangential_stiffness";
    add(path,
        fmt::format("found {:g}, k_t/k_n = {:.3g}; usual: {:g} to {:g}{}{}",
                    *written_value(draft, path), ratio, kLeastRatio, kMostRatio,
                    ratio > kMostRatio ? fmt::format("; the time step is {:.3g} times shorter "
                                                     "than with the normal spring alone",
                                                     std::sqrt(ratio))
                                       : "",
                    absolute ? fmt::format("; without this key it is 2/7 of k_n, {:.4g} N/m",
                                           2 * m.normal_stiffness / 7)
                             : "; 2/7 by default"));
  }
  const char* damping = "material.normal_damping";
  const auto found = written_value(draft, damping);
  if (!found || *found == 0 || m.law != "linear") return;
  if (m.restitution >= kLeastRestitution && m.restitution <= kMostRestitution) return;
  add(damping,
      fmt::format("found {:g} 1/s, which leaves a restitution of {:.3g} of two grains of "
                  "radius {:.3g} mm; usual: {:g} to {:g}; without this key it follows "
                  "material.restitution",
                  *found, m.restitution, 1e3 * grain->radius, kLeastRestitution, kMostRestitution));
}

}  // namespace

std::vector<Doubt> doubts(const Draft& draft) {
  std::vector<Doubt> out;
  const auto add = [&](const std::string& path, const std::string& what) {
    out.push_back({path, fmt::format("{}: {}: {}", written(draft, path).origin, path, what)});
  };
  for (const char* path : kSizes) {
    const auto size = written_value(draft, path);
    if (!size || !(*size > kLargeGrain)) continue;
    add(path, fmt::format("found {:g} m, a boulder's size; {}", *size, in_millimetres(*size)));
  }
  const auto density = written_value(draft, "material.density");
  if (density && !(*density >= kLightest && *density <= kHeaviest)) {
    const bool space = dimension_of(draft.value) == 3;
    add("material.density",
        fmt::format("found {:g} {}, which no grain has (sand: {})", *density,
                    space ? "kg/m3" : "kg/m2", space ? "2650, or \"2.65 g/cm3\"" : "2650"));
  }
  for (const auto& [path, radius] : kFalls) {
    const auto height = written_value(draft, path), grain = value_of(draft, radius);
    if (!height || !grain || !(*height > kDeepFall * 2 * *grain)) continue;
    add(path, fmt::format("found {:g} m, a fall of {:.0f} grain diameters; {}", *height,
                          *height / (2 * *grain), in_millimetres(*height)));
  }
  add_material_doubts(draft, add);
  return out;
}

}  // namespace grainfield::coupling
