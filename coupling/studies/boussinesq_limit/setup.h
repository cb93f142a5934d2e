// [response] of boussinesq-limit: how moduli and linear responses of settled layers are measured.
#pragma once
#include <cstdint>

#include "coupling/case/study.h"

namespace grainfield::coupling {

struct ResponseSetup {
  std::int64_t loads = 50;    ///< places of the load on each layer
  std::int64_t grains = 1;    ///< that share it
  double span = 0.5;          ///< in the plane: share of the width that the places are spread over
  double width_depths = 0.1;  ///< second width of averaging, over h
  double strain = 1e-6;
  std::int64_t slabs = 4, strips = 4;
  bool finite_elements = true;
};

void declare_response_keys(SectionKeys s);
inline constexpr KeySection kResponseKeys{"response", KeyRole::analysis, declare_response_keys};

}  // namespace grainfield::coupling
