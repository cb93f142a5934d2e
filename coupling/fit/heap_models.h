// The models that are fitted to heaps and to layers under a point load.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "coupling/fit/model.h"
#include "coupling/fit/registry_entry.h"
#include "coupling/models/observation_operator.h"
#include "coupling/observe/data.h"
#include "coupling/observe/heap_facts.h"

namespace grainfield::coupling {

/// Models of a heap, apex at (0, 0), y up; of symmetric ones:
///   hydrostatic            no parameter
///   cantelaube_minus, _zero, _plus   the branches of the theory, no parameter
///   cantelaube_continuous  beta_hat free, the core follows from continuity
///   cantelaube             a description, Roul's fit: a1, a2, b1 of the core, a_xx, a_yy, a_xy of
///   the flanks,
///                          beta_hat
///   osl_yield              mu free, eta from yield at the slope
///   osl                    eta and mu free
///   fpa, bcc               members of the family, no parameter
/// and those of heaps with two slopes (two_sided_models.h).
std::vector<RegistryEntry> heap_entries(const HeapFacts& facts);
std::vector<FitModel> heap_models(const HeapFacts& facts);
/// What the heaps tell this model of the registry.
RunFacts facts_of(const HeapFacts& facts, const std::string& registry);

/// What a heap is looked at with: places of the data through the operator made for them.
struct HeapSight {
  Places places;
  ObservationOperator through;
};
/// The model as it is seen, at these places alone.
FitModel seen_through(FitModel model, std::shared_ptr<const HeapSight> sight);

/// The one of that name; throws std::invalid_argument with the names there are.
const FitModel& find_fit_model(const std::vector<FitModel>& models, const std::string& name);

}  // namespace grainfield::coupling
