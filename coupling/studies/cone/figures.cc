#include "coupling/studies/cone/keys.h"

namespace grainfield::coupling {

std::vector<SummaryKey> cone_figures() {
  return {
      {"cone.source", "text", "point | rain | cylinder; of grains.files what they say"},
      {"cone.grains_lost", "-", "grains that left the floor"},
      {"cone.pour_time", "s", "simulated time of pouring"},
      {"cone.awake_mean", "-", "grains awake, mean over the pouring"},
      {"cone.height", "m", "h of a cone: its highest point above the floor", "h (m)"},
      {"cone.foot", "m", "radius at which the flank's line meets the floor"},
      {"cone.apex_height", "m",
       "height of the cone that the flank's line spans, which is the models': above cone.height "
       "where the apex is round"},
      {"cone.model_over_height", "-", "cone.apex_height over cone.height"},
      {"cone.model_over_weight", "-",
       "weight of that cone, of the grains' density and volume fraction, over that of the grains"},
      {"cone.repose_deg", "deg",
       "slope of the flank: line through the surface between 15 % and 85 % of the height",
       "repose (deg)"},
      {"cone.sector_repose_deviation_deg", "deg",
       "standard deviation of the slopes of eight sectors; nan where half of them have too few "
       "columns for a line"},
      {"cone.volume_fraction", "-", "mean of the inside", "volume fraction"},
      {"cone.rho_g_h", "Pa",
       "unit of pressure: grain density times cone.volume_fraction times g times height"},
      {"cone.mean_diameter", "m", "of the grains"},
      {"cone.coordination", "-", "contacts of a grain"},
      {"cone.base_over_weight", "-", "force on the base from its rings, over that on the floor"},
      {"dip.contacts_in_disk", "-",
       "contacts with a cone's base within heap.centre of the foot's radius; with fewer than five "
       "its dip is nan"},
      {"dip.sector_error", "rho g h",
       "standard error of shoulder - centre over the eight sectors of a cone: what one cone alone "
       "tells; dip.standard_error is over the cones"},
      {"base.largest_shear", "rho g h",
       "largest radial shear stress sigma_rz on the base, ensemble mean, smeared; above 0 the "
       "grains "
       "push the floor outwards"},
      {"base.largest_shear_at", "h", "its distance from the axis"},
  };
}

}  // namespace grainfield::coupling
