#include "coupling/studies/pile/pile_figures.h"

#include <cmath>
#include <limits>

#include "coupling/specimen/relaxation.h"
#include "coupling/specimen/volume_fraction.h"
#include "dem/snapshot/contact_changes.h"

namespace grainfield::dem {

void add_heap_figures(const Snapshot& pile, double diameter, std::map<std::string, double>& f) {
  const coupling::HeapShape heap = coupling::measure_heap(coupling::free_surface(pile, diameter));
  f["dem.repose_angle_left_deg"] = heap.repose_left_deg;
  f["dem.repose_angle_right_deg"] = heap.repose_right_deg;
  f["pile.repose_error_left_deg"] = heap.repose_left_error_deg;
  f["pile.repose_error_right_deg"] = heap.repose_right_error_deg;
  f["pile.height"] = heap.height;
  f["pile.apex_x"] = heap.apex_x;
  f["pile.half_base_left"] = heap.half_base_left();
  f["pile.half_base_right"] = heap.half_base_right();

  const auto fraction = [&](const Outline& window) {
    return window.empty() ? std::numeric_limits<double>::quiet_NaN()
                          : coupling::volume_fraction(pile, window);
  };
  const coupling::HeapWindows windows = coupling::windows_of(heap, diameter);
  f["dem.volume_fraction"] = fraction(windows.whole);
  f["pile.volume_fraction_centre"] = fraction(windows.centre);
  f["pile.volume_fraction_surface"] =
      0.5 * (fraction(windows.surface_left) + fraction(windows.surface_right));

  double weight = 0;
  for (const Grain& g : pile.grains) {
    if (!g.fixed) weight += g.mass * std::fabs(pile.gravity.y());
  }
  f["base.weight_ratio"] = base_force(pile).y() / weight;
}

void add_relaxation_figures(const Snapshot& poured, const Snapshot& pile, double diameter,
                            std::map<std::string, double>& f) {
  const coupling::Relaxation r = coupling::measure_relaxation(poured, pile, diameter);
  f["relaxation.base_weight_ratio_before"] = r.base_before;
  f["relaxation.level_error_before"] = r.levels_before;
  f["relaxation.level_error_after"] = r.levels_after;
  f["relaxation.force_change"] = r.forces;
  f["relaxation.mean_displacement"] = r.mean_displacement;
  f["relaxation.largest_displacement"] = r.largest_displacement;
}

void add_change_figures(const Snapshot& pile, const Snapshot& changed, const std::string& name,
                        std::map<std::string, double>& f) {
  const ContactChanges c = compare_contacts(pile, changed);
  const std::string prefix = "change." + name + ".";
  f[prefix + "contacts_gained"] = c.gained;
  f[prefix + "contacts_lost"] = c.lost;
  f[prefix + "newly_sliding"] = c.newly_sliding;
  f[prefix + "max_displacement_over_radius"] = c.max_displacement_over_radius;
}

}  // namespace grainfield::dem
