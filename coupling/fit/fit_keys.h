// The section [fit] of piles and of layers under a point load: stress models with free constants.
#pragma once
#include <vector>

#include "coupling/case/study.h"
#include "coupling/result/figure.h"

namespace grainfield::coupling {

void declare_fit_keys(SectionKeys s);

inline constexpr KeySection kFitKeys{"fit", KeyRole::analysis, declare_fit_keys, "verdict"};

/// Makes a study one that fits models: section, words, figures, and fit.models in place of
/// compare.models. The study leaves the keys out that mean nothing to it.
void fit_heap_models(Study& study);
void fit_layer_models(Study& study);

/// Throws std::invalid_argument "fit.finite_elements: ..." for a model that this program lacks.
void check_fit(const Case& value);

/// Their keys in summary.json.
std::vector<SummaryKey> figures_of_fits();

}  // namespace grainfield::coupling
