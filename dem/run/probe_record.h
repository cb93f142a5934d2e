// What small strains of a sample at rest have shown, and how a snapshot's attributes hold it.
#pragma once
#include <Eigen/Core>
#include <array>
#include <map>
#include <string>
#include <vector>

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
  std::string state;                                 ///< "prepared" | "first"
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();  ///< before them, Pa
  std::vector<Probe> probes;
  std::string lacking;  ///< why there are none, where it could not be probed
};

using Attributes = std::map<std::string, std::string>;

/// As attributes "probe.STATE.before" and "probe.STATE.DIRECTION.forth" and ".back": the numbers in
/// the order of the members, matrices row by row. A state that could not be probed has
/// "probe.STATE.lacking" instead, and nothing else.
void put_probes(const StateProbes& probes, Attributes& attributes);

/// Those of a state, none where it has not been probed. Throws std::invalid_argument naming an
/// attribute that cannot be read.
StateProbes probes_of(const Attributes& attributes, const std::string& state);

/// States that samples can be probed in, in the order of their path.
const std::vector<std::string>& probed_states();

}  // namespace grainfield::dem
