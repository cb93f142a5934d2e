#pragma once
#include "coupling/case/study.h"
#include "coupling/fit/layer_report.h"

namespace grainfield::coupling {

/// Study "point-load-verdict": stress models fitted to layers under a point load, and ranked.
Study point_load_verdict_study();

/// The fits alone, from files of realizations ("unloaded", "loaded").
LayerFits fit_layers(const Case& value, const std::vector<std::string>& files, int threads);

}  // namespace grainfield::coupling
