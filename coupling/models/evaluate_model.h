// The case's models, with what the run knows filled in, evaluated once for all points.
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "coupling/models/choice.h"
#include "coupling/models/observation_operator.h"

namespace grainfield::coupling {

/// What the run tells the models.
struct RunFacts {
  double force = 0;   ///< N: parameter F
  double height = 0;  ///< m: parameter h
  int dim = 2;        ///< parameter dim
  double depth = 0;   ///< m: parameter depth, the least depth one looks at
  std::string base;   ///< parameter base of models that know this word; empty: their default
  std::map<std::string, double> numbers;  ///< further parameters by name, e.g. rho_g, phi_deg
};

/// The choice's settings with what the facts know filled in where the model has it and the user did
/// not set it; a filled phi_deg is at least left_deg and right_deg of a model that has them. Throws
/// continuum::BadParameter where a number that would be filled in is nan (not measurable).
continuum::Settings filled_settings(const ModelChoice& choice, const RunFacts& facts);
/// Throws continuum::BadParameter for a model that refuses these facts beside its settings.
/// Finite-element models are not made: of them only ranges and settings without effect are seen.
void require_models(const std::vector<ModelChoice>& choices, const RunFacts& facts);
/// The same before a run that will fill in F, h, slopes and weight, of grains in `dim` dimensions:
/// what is refused whatever they will be.
void require_models(const std::vector<ModelChoice>& choices, int dim = 2);
/// For people: "layer (base=rough)".
std::string model_label(const ModelChoice& choice);

/// Stress of the choice's model at points of the grains' frame, tension positive; none above its
/// surface.
Eigen::MatrixXd stress_at(const ModelChoice& choice, continuum::Model& model,
                          Eigen::MatrixXd points);

struct Evaluation {
  std::vector<Eigen::MatrixXd> stresses;  ///< one per point set, tension positive
  std::map<std::string, double> figures;  ///< of the model
  double seconds = 0;                     ///< wall time
};

/// Figures of a heap's model that are over rho g h of its own height, over that of the grains,
/// which is 1/spanned of it.
std::map<std::string, double> over_grains_height(std::map<std::string, double> figures,
                                                 double spanned);

/// Stresses of one model on all point sets, with a single call of the model. Throws
/// continuum::BadParameter and ComputationFailed.
Evaluation evaluate_model(const ModelChoice& choice, const RunFacts& facts,
                          const std::vector<PointSet>& sets);

}  // namespace grainfield::coupling
