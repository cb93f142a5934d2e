// Figures of loaded layers, in the plane and in space.
#pragma once
#include <map>
#include <string>

#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// dem.layer_height, dem.layer_width, dem.volume_fraction (of base area times height), what the
/// base carries of weight and load, and where the load acts. `area`: of the base, m2 (in the plane
/// its width, m).
void add_layer_figures(const Snapshot& unloaded, const Snapshot& loaded, double height,
                       double width, double area, std::map<std::string, double>& figures);

/// load.contacts_gained and the like: compare_contacts.
void add_contact_changes(const Snapshot& unloaded, const Snapshot& loaded,
                         std::map<std::string, double>& figures);

}  // namespace grainfield::dem
