// Oriented stress linearity as a field problem, as the registry lists it. The same problem is
// solved by finite elements (solver = dg; continuum/fe) or by marching in depth (solver = march).
#pragma once
#include "continuum/model.h"
#include "continuum/osl/march.h"

namespace grainfield::continuum {

/// A heap under its weight, and a layer under its weight and a load spread over a stated width.
std::vector<ModelInfo> osl_models();

namespace osl {

/// What a model's settings ask for.
struct Task {
  Problem problem;
  StripMesh mesh;
  int order = 0;        ///< dg
  MarchSettings march;  ///< march
  double slope = 0;     ///< cot of a heap's slope, whatever its mesh; 0: a layer
  /// c1, c2 (dx/dy of the characteristics from (0, 0), y down, on the right), half_width.
  std::map<std::string, double> figures;
};

/// The task of "fe_osl_wedge" or "fe_osl_layer" with complete settings. Throws BadParameter.
Task make_task(const std::string& name, const Settings& settings);

/// Stress in the project's axes (y up, tension positive) at (x, y); nan outside of a heap.
Eigen::RowVector3d in_project_axes(const Task& task, const State& state, double x, double y);

}  // namespace osl
}  // namespace grainfield::continuum
