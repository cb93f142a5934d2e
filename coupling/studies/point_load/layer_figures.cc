#include "coupling/studies/point_load/layer_figures.h"

#include "dem/snapshot/contact_changes.h"

namespace grainfield::dem {

void add_layer_figures(const Snapshot& unloaded, const Snapshot& loaded, double height,
                       double width, double area, std::map<std::string, double>& f) {
  const int up = unloaded.dim - 1;
  double weight = 0, solid = 0;
  for (const Grain& g : unloaded.grains) {
    if (g.fixed) continue;
    weight += g.mass * -unloaded.gravity[up];
    solid += g.volume;
  }
  f["dem.layer_height"] = height;
  f["dem.layer_width"] = width;
  f["dem.volume_fraction"] = solid / (area * height);
  f["base.weight_ratio"] = base_force(unloaded)[up] / weight;
  f["base.response_over_load"] =
      (base_force(loaded) - base_force(unloaded))[up] / -total_applied_force(loaded)[up];
  const Grain& grain = unloaded.grains[static_cast<std::size_t>(loaded.loaded_grain)];
  f["load.x"] = grain.position.x();
  f["load.y"] = grain.position.y();
  if (unloaded.dim == 3) f["load.z"] = grain.position.z();
}

void add_contact_changes(const Snapshot& unloaded, const Snapshot& loaded,
                         std::map<std::string, double>& f) {
  const ContactChanges c = compare_contacts(unloaded, loaded);
  f["load.contacts_gained"] = c.gained;
  f["load.contacts_lost"] = c.lost;
  f["load.newly_sliding"] = c.newly_sliding;
  f["load.max_displacement_over_radius"] = c.max_displacement_over_radius;
  f["load.no_rearrangement"] = c.gained == 0 && c.lost == 0 ? 1 : 0;
}

}  // namespace grainfield::dem
