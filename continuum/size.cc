#include "continuum/size.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "continuum/settings.h"

namespace grainfield::continuum {

Parameter most_unknowns() {
  return number("most_unknowns", "-",
                "of equations that adaptive refinement may come to; a million take about a "
                "gigabyte of memory",
                "numerics", kMostUnknowns, 100, 1e9);
}

void require_possible(const ModelInfo& info, const Settings& complete) {
  if (!info.first_mesh) return;
  const FirstMesh mesh = info.first_mesh(complete);
  if (mesh.unknowns <= kMostUnknowns) return;
  std::vector<std::string> given;
  for (const std::string& name : mesh.parameters)
    given.push_back(fmt::format("{} = {}", name, complete.at(name)));
  throw BadParameter(fmt::format(
      "model {}: {} ask for {:.2g} unknowns; allowed: up to {:g}; lower {}", info.name,
      fmt::join(given, ", "), mesh.unknowns, kMostUnknowns, fmt::join(mesh.parameters, ", ")));
}

void require_unknowns(const std::string& name, double unknowns, double most, const char* by) {
  if (unknowns <= most) return;
  throw ComputationFailed(fmt::format(
      "{}: the next refinement would have about {:.2g} unknowns, allowed: up to most_unknowns = "
      "{:g}; lower {}, or raise most_unknowns where there is memory",
      name, unknowns, most, by));
}

}  // namespace grainfield::continuum
