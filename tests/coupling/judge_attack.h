// Random synthetic truths for the judge: a heap of random slope carries the stresses of a random
// model with random constants, seen in a random number of realizations under random noise.
#pragma once
#include <fmt/format.h>

#include <array>
#include <map>

#include "fit_scene.h"

namespace grainfield::coupling::test {

/// What the judge said of ensembles whose truth is known.
struct JudgeTally {
  int truths = 0;
  int refused_truth = 0;  ///< the model that made the data counts as behind the nearest
  int named = 0;          ///< one model distinguishable from all others
  int wrong = 0;          ///< of these: one that cannot be the truth whatever its constants
  int no_agreement = 0;   ///< the true model is said not to agree within the errors
  int constants = 0,
      held = 0;  ///< determined constants of the true model; intervals that hold them

  std::string text() const {
    return fmt::format(
        "{} truths: true model refused {}, one model named {}, of these wrong {}, true model said "
        "not to agree {}, constants held {} of {}",
        truths, refused_truth, named, wrong, no_agreement, held, constants);
  }
};

class JudgeAttack {
 public:
  explicit JudgeAttack(std::uint64_t seed) : random_(seed) {}

  /// One more truth, counted in what it belongs to: the number of realizations.
  void strike(std::map<int, JudgeTally>& tallies) {
    const int realizations =
        std::array{3, 4, 6, 8, 12}[static_cast<std::size_t>(5 * random_.uniform())];
    const double slope = random_.uniform(20, 38);
    const double share = std::exp(random_.uniform(std::log(0.01), std::log(0.3)));
    const double length = random_.uniform(0.01, 0.06);
    FitData data = places(11, slope, slope);
    const std::vector<FitModel> models = models_at(slope);
    const Truth truth = draw_truth(data, models);
    fill_as_grains(data, truth.exact, realizations, share, random_, length);
    judge(data, models, truth, tallies[realizations]);
  }

  /// The same of one field, as a measurement is: independent noise of 1 to 10 %, which its errors
  /// tell. The seven free constants of cantelaube stand beside the others.
  void strike_one_field(JudgeTally& tally) {
    const double slope = random_.uniform(20, 38);
    const double share = std::exp(random_.uniform(std::log(0.01), std::log(0.1)));
    FitData data = places(11, slope, slope);
    std::vector<FitModel> models = models_at(slope);
    const Truth truth = draw_truth(data, models);
    models.push_back(find_fit_model(heap_models({slope, kRhoG, kHeight}), "cantelaube"));
    fill(data, truth.exact, 1, share, 1e-6, random_);
    data.error = Eigen::VectorXd::Constant(data.values(), share * kRhoG * kHeight);
    judge(data, models, truth, tally);
  }

 private:
  struct Truth {
    std::size_t model;
    Eigen::VectorXd constants, exact;
  };

  static std::vector<FitModel> models_at(double slope) {
    std::vector<FitModel> models;
    for (const FitModel& model : heap_models({slope, kRhoG, kHeight})) {
      for (const char* name : {"hydrostatic", "cantelaube_minus", "cantelaube_plus", "osl_yield",
                               "osl", "fpa", "bcc", "cantelaube_continuous"}) {
        if (model.name == name && model.absent.empty()) models.push_back(model);
      }
    }
    return models;
  }

  static void judge(const FitData& data, const std::vector<FitModel>& models, const Truth& made,
                    JudgeTally& tally) {
    const auto& [truth, constants, exact] = made;
    const Weights weights = weights_of(data);
    FitOptions options;
    options.bootstrap = 0;
    options.profile = false;
    std::vector<Fit> fits;
    for (const FitModel& model : models) fits.push_back(fit(data, weights, model, options));
    const Judgement judgement = select(data, weights, models, fits);

    ++tally.truths;
    tally.refused_truth += judgement.find(models[truth].name)->distinguishable == Answer::yes;
    const Fit& own = fits[truth];
    tally.no_agreement += std::isfinite(own.chance) && own.chi2_per_dof > own.chance;
    for (std::size_t k = 0; k < own.parameters.size(); ++k) {
      const FittedParameter& p = own.parameters[k];
      if (p.at_bound || !p.determined || !std::isfinite(p.low)) continue;
      ++tally.constants;
      tally.held += p.low <= constants[static_cast<Eigen::Index>(k)] &&
                    constants[static_cast<Eigen::Index>(k)] <= p.high;
    }
    if (judgement.distinguishable != Answer::yes) return;
    ++tally.named;
    tally.wrong += !can_be(find_fit_model(models, judgement.best), data, exact);
  }

  // Constants where the models of real heaps lie; again where the model has no field for them.
  Truth draw_truth(const FitData& data, const std::vector<FitModel>& models) {
    for (;;) {
      const auto m =
          static_cast<std::size_t>(random_.uniform() * static_cast<double>(models.size()));
      const std::vector<FitParameter>& parameters = models[m].parameters;
      Eigen::VectorXd constants(static_cast<Eigen::Index>(parameters.size()));
      for (std::size_t k = 0; k < parameters.size(); ++k) {
        double low = parameters[k].least, high = parameters[k].most;
        if (parameters[k].name == "eta") low = 0.5, high = 1.2;
        if (parameters[k].name == "mu") low = -0.6, high = std::min(high, 0.5);
        constants[static_cast<Eigen::Index>(k)] = random_.uniform(low, high);
      }
      int outside = 0;
      const Eigen::VectorXd exact = predict(data, models[m], constants, &outside);
      if (outside == 0 && exact.allFinite() && exact.norm() > 0) return {m, constants, exact};
    }
  }

  // Whether the model has constants that make these values.
  static bool can_be(const FitModel& model, const FitData& data, const Eigen::VectorXd& exact) {
    Weights weights;
    FitData known = data;
    known.samples = exact;
    weights = weights_of(known);
    const Eigen::VectorXd best = best_parameters(known, exact, weights, model, model.starts, 0);
    return (predict(known, model, best) - exact).norm() < 0.01 * exact.norm();
  }

  dem::Random random_;
};

}  // namespace grainfield::coupling::test
