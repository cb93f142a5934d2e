// What is told of a sample at each of its recorded states.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "coupling/structure/coordination_counts.h"
#include "coupling/structure/tensor_axes.h"
#include "coupling/studies/sample/simulation/state.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// One recorded state beside the first one of its realization.
struct StateFacts {
  const dem::Snapshot* snapshot = nullptr;
  int dim = 2;
  dem::SampleState now, first;
  TensorAxes stress;                                 ///< of now.contact_stress, tension positive
  Eigen::Matrix3d fabric = Eigen::Matrix3d::Zero();  ///< (1/V) sum V_p sum n n (Roul 2.96)
  TensorAxes fabric_axes;
  CoordinationCounts counts;
  double strain = 0, strain_rate = 0;  ///< imposed; -, 1/s
  double kinetic = 0, elastic = 0;     ///< J
  double work = 0;                     ///< of the cell or the walls since the first state, J
  // Since the first state, J; nan where the run did not follow them.
  double in_dashpots = 0, to_friction = 0, to_rolling = 0, to_damping = 0;  ///< lost
  double law_work = 0;  ///< work of the law (dem/engine/energy_balance.h)
  double balance = 0;   ///< what the balance of energies has changed by
  double unbalanced_force_ratio = 0;
  double diameter = 0, density = 0;  ///< of the grains: mean, m; kg/m3 (kg/m2)

  double pressure() const;  ///< -trace/dim of the stress, compression positive
  double dissipated() const { return in_dashpots + to_friction + to_rolling + to_damping; }
};

/// Facts of a state of coupling/studies/sample/simulation/sample.h; `first`: "state_000" of its
/// realization. Keeps a pointer to `snapshot`. Throws std::invalid_argument naming an attribute
/// that is missing.
StateFacts state_facts(const dem::Snapshot& snapshot, const dem::Snapshot& first);

/// A column of states.csv.
struct StateColumn {
  std::string name;
  std::string unit_2d, unit_3d;  ///< "1": none
  std::string meaning;
  std::function<double(const StateFacts&)> of;
  bool in_space = false;  ///< in three dimensions only

  const std::string& unit(int dim) const { return dim == 2 ? unit_2d : unit_3d; }
};

/// Those of so many dimensions, in the order of the table.
std::vector<StateColumn> state_columns(int dim);

}  // namespace grainfield::coupling
