// Fitted models before the judge (judge/judge.h): what each predicts of realizations and of heights
// that its constants have not seen.
#pragma once
#include <string>
#include <vector>

#include "coupling/fit/fit.h"
#include "coupling/judge/judge.h"

namespace grainfield::coupling {

struct SelectionOptions {
  double huber = 0;      ///< as FitOptions
  bool by_level = true;  ///< leaves out heights too, where there are two or more
};

/// Ranks the models. `fits`: of the same data and weights, in the order of `models`. Constants
/// whose sign hangs on one realization are among the doubts. Throws std::invalid_argument for no
/// model or sizes that differ.
Judgement select(const FitData& data, const Weights& weights, const std::vector<FitModel>& models,
                 const std::vector<Fit>& fits, const SelectionOptions& options = {});

/// Whether `special` is a special case of the layer model `general`, or the same: what they are
/// called says nothing of it.
bool contains(const Fit& general, const Fit& special);

}  // namespace grainfield::coupling
