// Numbers that describe a finished pile.
#pragma once
#include <map>
#include <string>

#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// "dem.repose_angle_left_deg", "pile.height", ... of a pile at rest. nan where the heap is too
/// small for a figure. `diameter`: mean diameter of the grains' bounding circles, m.
void add_heap_figures(const Snapshot& pile, double diameter,
                      std::map<std::string, double>& figures);

/// "relaxation.force_change", ...: from the poured pile, in which grains may sleep, to the pile at
/// rest (coupling/specimen/relaxation.h).
void add_relaxation_figures(const Snapshot& poured, const Snapshot& pile, double diameter,
                            std::map<std::string, double>& figures);

/// "change.NAME.contacts_gained" ... of a state against the pile at rest.
void add_change_figures(const Snapshot& pile, const Snapshot& changed, const std::string& name,
                        std::map<std::string, double>& figures);

}  // namespace grainfield::dem
