// Displacements of layers under a small load beside those that a model of a layer predicts.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "continuum/moduli_by_depth.h"
#include "coupling/models/choice.h"
#include "coupling/models/evaluate_model.h"

namespace grainfield::coupling {

/// Displacements downwards, m: of the surface by distance from the load, and below the load by
/// depth. nan: not known.
struct Settlements {
  Eigen::VectorXd surface, axis;
};

/// Where, m: `surface` from the load, `axis` below the surface, the latter means over grains that
/// are up to `aside` from the axis.
struct SettlementPlaces {
  Eigen::VectorXd surface, axis;
  double aside = 0;
};

/// Settlements that a model of a layer predicts, from its stresses and the moduli of the grains:
/// the vertical strain integrated upwards from the base, which does not settle. nan nearer to the
/// load than a tenth of the depth, where it is singular. Throws as evaluate_model().
Settlements predicted_settlements(const ModelChoice& layer, const RunFacts& facts,
                                  const continuum::ModuliByDepth& moduli,
                                  const SettlementPlaces& places);

/// Means over the places far enough from the load to be compared: of the surface between a quarter
/// of the depth and the depth, of the axis between a quarter and three quarters; of `other` at the
/// places that `of` has. nan where there are none.
struct MeanSettlement {
  double of = 0, other = 0;
};
MeanSettlement mean_on_surface(const Settlements& of, const Settlements& other,
                               const SettlementPlaces& places, double depth);
MeanSettlement mean_on_axis(const Settlements& of, const Settlements& other,
                            const SettlementPlaces& places, double depth);

}  // namespace grainfield::coupling
