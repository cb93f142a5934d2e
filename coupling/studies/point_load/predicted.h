// What uniform strains of the layers before the load (load.probe_strain) predict of the response,
// without a fit.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "coupling/averaging/kernel.h"
#include "coupling/models/evaluate_model.h"
#include "coupling/report/report.h"
#include "coupling/result/figure.h"
#include "coupling/result/tables.h"

namespace grainfield::coupling {

struct PredictedResponse {
  /// By summary key predicted.*, a number for each layer. Empty: not probed.
  std::map<std::string, std::vector<double>> figures;
  /// transverse_layer with the mean moduli: "predicted" on a rough base, as floor contacts that
  /// stick hold the layer, "predicted_smooth" on a smooth one. Empty also where the moduli are
  /// refused.
  std::vector<ModelChoice> models;
  std::string refusal;  ///< why they are

  /// Largest pressure on the base by the model "predicted", over F/h^2, seen with the kernel, and
  /// its standard error by the jackknife over the layers: predicted.peak_over_F_per_h2. Nothing
  /// without models. `depth`: h of the facts.
  void add_peak(const RunFacts& facts, const Kernel& kernel, Summary& summary) const;
};

/// Labels of those models, which the case's own may not have where layers are probed.
const std::vector<std::string>& predicted_labels();

/// `files`: of the realizations. Throws std::invalid_argument when an attribute is broken.
PredictedResponse predicted_response(const std::vector<std::string>& files);

/// Table of the moduli, none where nothing was probed.
std::vector<Section> predicted_sections(const Summary& summary);

std::vector<SummaryKey> predicted_figures();

}  // namespace grainfield::coupling
