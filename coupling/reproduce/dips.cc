#include "coupling/reproduce/dips.h"

#include <algorithm>
#include <cmath>

#include "coupling/statistics/holm.h"

namespace grainfield::coupling {

std::vector<RecordedDip> recorded_dips(const Results& results) {
  std::vector<RecordedDip> out;
  std::vector<double> p_values;
  for (const auto& [study, summary] : results.all()) {
    const auto difference = results.number(study, "dip.difference");
    // One-sided, of no dip: whatever the rule for the word was when it was recorded.
    const auto p = results.plain(study, "dip.p_value");
    if (!difference || !p) continue;
    out.push_back({study, *difference, 2 * std::min(*p, 1 - *p), 0, ""});
    p_values.push_back(out.back().p_value);
  }
  const std::vector<double> corrected = holm(p_values);
  for (std::size_t k = 0; k < out.size(); ++k) {
    RecordedDip& dip = out[k];
    dip.p_holm = corrected[k];
    dip.word = std::isnan(dip.p_holm)       ? "undecided"
               : dip.p_holm >= 0.05         ? "neither"
               : dip.difference.value > 0.0 ? "dip"
                                            : "peak";
  }
  return out;
}

std::optional<RecordedDip> recorded_dip(const Results& results, const std::string& study) {
  for (const RecordedDip& dip : recorded_dips(results))
    if (dip.study == study) return dip;
  return std::nullopt;
}

}  // namespace grainfield::coupling
