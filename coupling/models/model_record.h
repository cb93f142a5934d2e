// What a run keeps of each of its models.
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>

#include "coupling/base/field.h"
#include "coupling/models/choice.h"
#include "coupling/models/evaluate_model.h"
#include "coupling/result/tables.h"

namespace grainfield::coupling {

/// A model's stress, with its name and settings as attributes. `stress`: one row per point, three
/// columns in 2D (N/m), six in 3D (Pa); `columns` x `rows`: the points are the nodes of a grid.
Field model_field(const ModelChoice& choice, const RunFacts& facts, const Eigen::MatrixXd& points,
                  const Eigen::MatrixXd& stress, int columns = 0, int rows = 0);

/// Name, figures and wall time (s) of a model.
void add_model(Summary& summary, const ModelChoice& choice,
               const std::map<std::string, double>& figures, double seconds);

}  // namespace grainfield::coupling
