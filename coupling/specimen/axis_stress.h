// How much a heap presses sideways on its axis.
#pragma once
#include "coupling/specimen/pile_frame.h"
#include "coupling/specimen/setup.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// sigma_xx over sigma_yy of the contact forces in a window on the axis: both stresses averaged
/// over the window first, then divided. The window is |x| < heap.centre half bases, from
/// heap.axis_from to heap.axis_to of the height above the floor. Every place in it weighs the
/// same: V sigma_ab = sum of F_a l_b times the share of the branch l inside (coarse graining, the
/// kernel being the window; Weinhart et al. 2012 eq. 13). Branches end at contact points with the
/// floor and with fixed grains. nan: the window carries no vertical force.
double axis_stress_ratio(const dem::Snapshot& pile, const PileFrame& frame, const HeapSetup& setup);

}  // namespace grainfield::coupling
