// Known truths through the whole pipeline: packings that carry a field (carried_stress_scene.h) are
// written as CSV, imported, averaged, compared or fitted, and judged.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "coupling/import/import.h"
#include "coupling/models/evaluate_model.h"
#include "coupling/models/parse_choices.h"
#include "coupling/tasks/average_task.h"
#include "coupling/tasks/compare_task.h"
#include "coupling/tasks/fit_task.h"
#include "tests/coupling/carried_stress_scene.h"
#include "tests/coupling/import_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling::test {

using grainfield::test::CarriedHeap;
using grainfield::test::CarriedLayer;
using grainfield::test::StressAt;

/// What the judge said of one ensemble whose truth is known.
struct KnownTally {
  int truths = 0;
  int refused = 0;              ///< the true model counts as behind the nearest
  int nearest = 0;              ///< it is the nearest
  int best = 0;                 ///< it is the best
  int supported = 0;            ///< it is supported
  int disagreeing = 0;          ///< it is said not to agree within the errors
  int named = 0;                ///< one model, or one family, distinguishable from all others
  int wrong = 0;                ///< of these: another one
  int constants = 0, held = 0;  ///< fitted constants of the true model; inside their 95 % intervals
  double pulling = 0;           ///< largest share of contacts that pull
  double imbalance = 0;         ///< largest of a grain, over the mean contact force
  double misfit = 0;            ///< sum of the true model's
  double noise = 0;             ///< sum over the ensembles: spread of a realization over the signal

  void add(const Judgement& j, const std::string& truth) {
    const JudgedModel& model = *j.find(truth);
    ++truths;
    refused += model.distinguishable == Answer::yes;
    nearest += j.models.front().name == truth;
    best += j.best == truth;
    supported += model.supported() == Answer::yes;
    disagreeing += model.agrees() == Answer::no;
    misfit += model.misfit;
    if (j.distinguishable != Answer::yes) return;
    ++named;
    const JudgedModel& winner = j.best_model();
    const bool same_family = !winner.family.empty() && winner.family == model.family;
    wrong += winner.name != truth && !same_family;
  }
  std::string text() const {
    return fmt::format(
        "{} truths: nearest {}, best {}, supported {}, refused {}, said not to agree {}, one model "
        "named {}, of these wrong {}, constants held {} of {}; mean misfit {:.2f}, noise {:.2f}, "
        "contacts that pull {:.3f}, imbalance {:.1e}",
        truths, nearest, best, supported, refused, disagreeing, named, wrong, held, constants,
        misfit / truths, noise / truths, pulling, imbalance);
  }
};

/// The packing as the import reads it from tables in CSV.
inline std::shared_ptr<const dem::Snapshot> through_import(const testing::Folder& folder,
                                                           const dem::Snapshot& packing) {
  ImportOptions options;
  options.format = "csv";
  options.files = {folder.write("grains.csv", grainfield::test::csv_grains(packing)),
                   folder.write("contacts.csv", grainfield::test::csv_contacts(packing)),
                   folder.write("walls.csv", grainfield::test::csv_walls(packing))};
  options.loaded_grain = packing.loaded_grain;
  options.applied_force = packing.applied_force;
  std::shared_ptr<const dem::Snapshot> out;
  import_snapshots(options, [&](ImportedSnapshot&& one) {
    out = std::make_shared<const dem::Snapshot>(std::move(one.snapshot));
  });
  return out;
}

/// The model that this text names, with what the packing knows.
inline StressAt stress_of(const std::string& text, const RunFacts& facts) {
  const ModelChoice choice = parse_choice(text);
  const std::shared_ptr<continuum::Model> model =
      continuum::make_model(choice.name, filled_settings(choice, facts));
  return [model](const Eigen::MatrixXd& points) { return model->stress(points); };
}

inline std::string label_of(const std::string& text) { return parse_choice(text).label; }

/// Layers under a load that carry the response of one of these models.
class KnownLayers {
 public:
  std::vector<std::string> models{"flamant", "smooth=layer:base=smooth",
                                  "rough=layer:base=rough,nu=0.3",
                                  "stiff=orthotropic_half_plane:r=1,t=0.5"};
  CarriedLayer setup;
  double width = 1.5;  ///< of the kernel, diameters

  /// Fields of so many realizations of the truth, model number `truth`.
  NamedFields fields(std::size_t truth, int realizations, std::uint64_t seed, KnownTally& tally) {
    RunFacts facts;
    facts.force = setup.load;
    facts.height = setup.depth();
    const StressAt response = stress_of(models[truth], facts);
    const testing::Folder folder;
    AverageRequest request;
    request.response = true;
    request.cuts = {0.25, 0.5, 0.75};
    request.nx = 61;  // with fewer places models are drawn through more
    request.options.width = width * setup.diameter;
    request.options.quantities = {"sigma"};
    for (int r = 0; r < realizations; ++r) {
      CarriedLayer one = setup;
      one.disorder.seed = seed + static_cast<std::uint64_t>(r);
      const auto made = grainfield::test::carried_layer(one, response);
      for (const auto& [name, state] :
           {std::pair{"unloaded", &made.unloaded}, std::pair{"loaded", &made.loaded}}) {
        tally.imbalance = std::max(tally.imbalance, grainfield::test::largest_imbalance(*state));
        tally.pulling = std::max(tally.pulling, grainfield::test::pulling_share(*state));
        request.snapshots.push_back(
            {"layers.h5", fmt::format("/{:03}/{}", r, name), through_import(folder, *state)});
      }
    }
    return run_average(request);
  }

  /// One more ensemble, judged with all its models.
  Judgement strike(std::size_t truth, int realizations, std::uint64_t seed, KnownTally& tally) {
    CompareRequest request;
    request.file = "layers.h5";
    request.held = fields(truth, realizations, seed, tally);
    request.models = models;
    const Comparison compared = run_compare(request).comparison;
    double spread = 0, signal = 0;
    for (const Profile& p : compared.profiles) {
      spread += realizations * p.error.array().isFinite().select(p.error, 0).squaredNorm();
      signal += p.mean.array().isFinite().select(p.mean, 0).squaredNorm();
    }
    tally.noise += std::sqrt(spread / signal);
    tally.add(compared.judgement, label_of(models[truth]));
    return compared.judgement;
  }
};

/// Heaps that carry a model's stress, fitted with these models.
class KnownHeaps {
 public:
  std::vector<std::string> models{"hydrostatic", "cantelaube_minus", "cantelaube_plus", "osl_yield",
                                  "osl"};
  CarriedHeap setup;

  struct Truth {
    std::string text;  ///< as of parse_choice
    std::string fit;   ///< the model of fits that has it
    std::vector<double> constants;
  };

  /// One more ensemble of heaps that carry the truth.
  FitOutcome strike(const Truth& truth, int realizations, std::uint64_t seed, KnownTally& tally) {
    RunFacts facts;
    facts.numbers = {{"phi_deg", setup.slope_deg}, {"rho_g", grainfield::test::carried_rho_g()}};
    const StressAt stress = stress_of(truth.text, facts);
    const testing::Folder folder;
    FitRequest request;
    for (int r = 0; r < realizations; ++r) {
      CarriedHeap one = setup;
      one.disorder.seed = seed + static_cast<std::uint64_t>(r);
      const dem::Snapshot heap = grainfield::test::carried_heap(one, stress);
      tally.imbalance = std::max(tally.imbalance, grainfield::test::largest_imbalance(heap));
      tally.pulling = std::max(tally.pulling, grainfield::test::pulling_share(heap));
      request.heaps.push_back(
          {"heaps.h5", fmt::format("/{:03}/pile", r), through_import(folder, heap)});
    }
    request.models = models;
    request.overrides = {"fit.bootstrap=0"};
    FitOutcome out = run_fit(request);
    const FitData& data = out.fits->observed.data;
    tally.noise += std::sqrt((data.samples.colwise() - data.mean()).squaredNorm() /
                             (realizations - 1) / data.mean().squaredNorm());
    tally.add(out.comparison.judgement, truth.fit);
    for (const Fit& fit : out.fits->fits) {
      if (fit.name != truth.fit) continue;
      for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
        const FittedParameter& p = fit.parameters[k];
        if (p.at_bound || !p.determined || !std::isfinite(p.low)) continue;
        ++tally.constants;
        tally.held += p.low <= truth.constants[k] && truth.constants[k] <= p.high;
      }
    }
    return out;
  }
};

/// `numbers`: constants of the model of fits.
inline std::vector<KnownHeaps::Truth> heap_truths() {
  return {{"osl:eta=0.85,mu=-0.31", "osl", {0.85, -0.31}},
          {"cantelaube:branch=plus", "cantelaube_plus", {}},
          {"cantelaube:branch=minus", "cantelaube_minus", {}}};
}

}  // namespace grainfield::coupling::test
