// What the run of a pile starts from, and its forecast (Groundwork).
#pragma once
#include <vector>

#include "coupling/studies/pile/simulation.h"
#include "dem/grains/grain_family.h"
#include "dem/run/groundwork.h"

namespace grainfield::dem {

struct PileGrains {
  std::vector<ShapedGrain> poured, floor;
};

struct PileGroundwork {
  using Setup = PileSetup;
  static constexpr const char* kName = "pile";
  static void check(const Setup& setup);
  static PileGrains draw(const Setup& setup, Random& random, Allowance& allowance);
  static EngineSettings settings(const Setup& setup, const PileGrains& grains, double reserve);
  static Outlook outlook(const Setup& setup, const EngineSettings& settings);
};

}  // namespace grainfield::dem
