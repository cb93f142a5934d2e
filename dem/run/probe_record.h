// What small strains of a sample at rest have shown, and how a snapshot holds it.
#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// The sample at rest again after one small strain.
struct ProbeOutcome {
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();  ///< displacement of the edges, extension > 0
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();    ///< of the contacts, tension positive, Pa
  /// Shares of the contacts before: those that are new, those that are gone, and those that slide
  /// and did not.
  double gained = 0, lost = 0, sliding = 0;
};

/// One direction of strain, forth (extension, shear along the axes) and back.
struct Probe {
  std::string direction;  ///< "xx" ... "zz", "yz", "xz", "xy"
  std::array<ProbeOutcome, 2> outcomes;
};

/// All of one state.
struct StateProbes {
  std::string state;                                 ///< "prepared" | "first" | "layer"
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();  ///< before them, Pa
  std::vector<Probe> probes;
  std::string lacking;  ///< why there are none, where it could not be probed
};

/// Puts the outcome to its direction: forth for an even number of the probe, back for an odd one.
void add_outcome(StateProbes& probes, const std::string& direction, int number,
                 const ProbeOutcome& outcome);

/// Puts the probes into table "probes_STATE", a row for each direction and way: the axes of the
/// strain (1 to 3), the way (1 forth, -1 back), the stress before, and the members of the outcome,
/// matrices as nine columns. A state that could not be probed has attribute "probe.STATE.lacking"
/// instead.
void put_probes(const StateProbes& probes, Snapshot& snapshot);

/// The probes of a state, none where it has not been probed. Files of version 0.9.0 may hold them
/// in attributes "probe.STATE.before" and "probe.STATE.DIRECTION.forth" and ".back", the numbers as
/// text. Throws std::invalid_argument naming the table or the attribute that cannot be read.
StateProbes probes_of(const Snapshot& snapshot, const std::string& state);

/// States that samples can be probed in, in the order of their path.
const std::vector<std::string>& probed_states();

}  // namespace grainfield::dem
