// Synthetic ensembles of layers of each model: how often intervals hold the truth, and what the
// verdict names. Ensembles of 8 realizations.
#pragma once
#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "tests/coupling/layer_fit_scene.h"

namespace grainfield::coupling {

inline constexpr int kLayerRealizations = 8;

inline const LayerScene& scene() {
  static const LayerScene one = layer_scene(7);
  return one;
}

/// Each constant of each model lies in its 95 % interval in at least `least` of `trials` ensembles.
inline void expect_coverage_of_layers(int trials, int least) {
  FitOptions options;
  options.bootstrap = 0;
  options.profile = false;  // looked at by fit_test.cc
  for (const LayerTruth& truth : layer_truths()) {
    if (truth.parameters.size() == 0) continue;
    const FitModel& model = find_fit_model(scene().models, truth.model);
    FitModel near = model;
    near.starts = {truth.parameters};  // the search is not what is tested here
    std::vector<int> inside(model.parameters.size(), 0);
    dem::Random random(1);
    for (int trial = 0; trial < trials; ++trial) {
      const FitData data =
          with_noise(scene(), truth.model, truth.parameters, kLayerRealizations, 0.1, random);
      const Fit f = fit(data, weights_of(data), near, options);
      for (std::size_t k = 0; k < inside.size(); ++k) {
        const double v = truth.parameters[static_cast<Eigen::Index>(k)];
        inside[k] += f.parameters[k].low <= v && v <= f.parameters[k].high ? 1 : 0;
      }
    }
    for (std::size_t k = 0; k < inside.size(); ++k) {
      EXPECT_GE(inside[k], least) << truth.model << " " << model.parameters[k].name;
    }
  }
}

struct VerdictCount {
  int named = 0, type = 0, undecided = 0;
};

inline VerdictCount verdicts(const LayerTruth& truth, double noise, int trials,
                             bool among_all = false) {
  dem::Random random(7);
  FitOptions options;
  options.bootstrap = 0;
  options.profile = false;  // looked at by fit_test.cc
  // Two starts of the search are enough, the truth among them; the orthotropic layers, which take
  // longest, compete only in the runs by hand.
  std::vector<FitModel> models;
  for (const FitModel& m : scene().models) {
    if (!among_all && m.name.rfind("orthotropic_layer", 0) == 0) continue;
    models.push_back(m);
    auto& starts = models.back().starts;
    if (m.name == truth.model) starts.insert(starts.begin(), truth.parameters);
    if (starts.size() > 2) starts.resize(2);
  }
  VerdictCount out;
  for (int trial = 0; trial < trials; ++trial) {
    const FitData data =
        with_noise(scene(), truth.model, truth.parameters, kLayerRealizations, noise, random);
    const Weights weights = weights_of(data);
    std::vector<Fit> fits;
    for (const FitModel& m : models) fits.push_back(fit(data, weights, m, options));
    SelectionOptions selection;
    selection.by_level = false;
    const Judgement v = select(data, weights, models, fits, selection);
    const bool alone = v.distinguishable == Answer::yes;
    out.named += alone && v.best == truth.model ? 1 : 0;
    out.type += v.equations == find_fit_model(scene().models, truth.model).equations ? 1 : 0;
    out.undecided += v.equations == "not distinguishable" && !alone ? 1 : 0;
  }
  return out;
}

inline void expect_named(std::size_t k, int trials, int least, bool among_all = false) {
  const LayerTruth truth = layer_truths()[k];
  const VerdictCount c = verdicts(truth, 0.05, trials, among_all);
  std::printf("%s: named in %d of %d, its type in %d\n", truth.model.c_str(), c.named, trials,
              c.type);
  EXPECT_GE(c.named, least) << truth.model;
  EXPECT_GE(c.type, least) << truth.model;
}

inline void expect_undecided(std::size_t k, int trials, int least) {
  const VerdictCount c = verdicts(layer_truths()[k], 20, trials);
  std::printf("%s below the noise: not distinguishable in %d of %d\n",
              layer_truths()[k].model.c_str(), c.undecided, trials);
  EXPECT_GE(c.undecided, least) << layer_truths()[k].model;
}

}  // namespace grainfield::coupling
