// Figures of elastic-plastic heaps.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "coupling/output/figure.h"
#include "coupling/studies/wedge/analysis.h"

namespace grainfield::coupling {

struct WedgeFacts {
  const WedgeMember& member;
  double unit = 1;    ///< rho g h, N/m
  double height = 1;  ///< m
};
/// "wedge.LABEL." comes before their keys.
const std::vector<RunFigure<WedgeFacts>>& wedge_member_rows();

/// Of all heaps of a case.
struct WedgeCounts {
  std::int64_t heaps = 0, equilibria = 0;
  std::map<std::string, std::int64_t> words = {};  ///< by the shape of the base's pressure

  std::int64_t of(const std::string& word) const {
    const auto at = words.find(word);
    return at == words.end() ? 0 : at->second;
  }
};
const std::vector<RunFigure<WedgeCounts>>& wedge_rows();

}  // namespace grainfield::coupling
