// Models as they are given beside observations: at the same places, through the same kernels.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "coupling/compare/compare.h"
#include "coupling/models/evaluate_model.h"
#include "coupling/observe/observations.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

struct LineOf {
  std::string component, name, key;  ///< of the field; for people; for summary keys
  Smoothing smoothing = Smoothing::kernel;
  bool both_sides = false;  ///< the points are radii from 0
};
/// The component along these points of a field (models' frame, m), or along all. Cells of a
/// laboratory count each by itself.
ObservedLine observed_line(const Field& field, const LineOf& line,
                           std::shared_ptr<const Kernel> kernel,
                           const std::vector<Eigen::Index>& at = {});
/// Pressures at these x (m) and this depth below the models' origin, as they are: not averaged. A
/// column for each realization.
ObservedLine pressure_line(const std::string& name, double depth, const Eigen::VectorXd& x,
                           const Eigen::MatrixXd& samples);

/// evaluate_model, or another way to the same.
using ModelEvaluator =
    std::function<Evaluation(const ModelChoice&, const RunFacts&, const std::vector<PointSet>&)>;

struct SeenModel {
  ModelChoice choice;
  RunFacts told;
  ModelProfiles profiles;                 ///< along the lines
  std::vector<Eigen::MatrixXd> stresses;  ///< all of them at each line's places
  Eigen::MatrixXd map;                    ///< and at observed.map, as the model has them
  std::map<std::string, double> figures;  ///< of heaps over rho g h of the grains' height
  double seconds = 0;                     ///< wall time
};

/// `told`: what this model is told instead of observed.told; may be empty. Lines with few places
/// are followed between them, for pictures. Throws as evaluate_model.
std::vector<SeenModel> see_models(
    const Observations& observed, const std::vector<ModelChoice>& choices,
    const ModelEvaluator& evaluate = evaluate_model,
    const std::function<RunFacts(const ModelChoice&)>& told = nullptr);

/// Grains or a measurement beside the models, judged; without models the profiles alone.
Comparison compared(const Observations& observed, const std::vector<SeenModel>& models);

/// Keys that follow from it. `main`: of a response, the profile that is told of in full.
void add_compared(Summary& summary, const Observations& observed, const Comparison& comparison,
                  std::size_t main);
/// The models' fields on observed.map, figures and times.
void add_models(StudyResult& out, const Observations& observed,
                const std::vector<SeenModel>& models);

}  // namespace grainfield::coupling
