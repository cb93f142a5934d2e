#include "coupling/studies/cone/figures.h"

#include <numbers>

#include "coupling/studies/cone/keys.h"
#include "coupling/studies/pile/pile_ensemble.h"

namespace grainfield::coupling {
namespace {

// N, of the cone with the flank's line and the grains' rho g.
double model_weight(const ConeFrame& f) {
  return f.pressure() / f.height * std::numbers::pi / 3 * f.foot * f.foot * f.apex_height();
}

}  // namespace

const std::vector<Figure<ConeFacts>>& cone_rows() {
  using F = const ConeFacts&;
  static const std::vector<Figure<ConeFacts>> all{
      {"cone.grains_lost", "-", "grains that left the floor"},
      {"cone.pour_time", "s", "simulated time of pouring"},
      {"cone.awake_mean", "-", "grains awake, mean over the pouring"},
      {"cone.height", "m", "h of a cone: its highest point above the floor",
       [](F f) { return f.frame.height; }, "h (m)"},
      {"cone.foot", "m", "radius at which the flank's line meets the floor",
       [](F f) { return f.frame.foot; }},
      {"cone.apex_height", "m",
       "height of the cone that the flank's line spans, which is the models': above cone.height "
       "where the apex is round",
       [](F f) { return f.frame.apex_height(); }},
      {"cone.model_over_height", "-", "cone.apex_height over cone.height",
       [](F f) { return f.frame.apex_height() / f.frame.height; }},
      {"cone.model_over_weight", "-",
       "weight of that cone, of the grains' density and volume fraction, over that of the grains",
       [](F f) { return model_weight(f.frame) / f.weight; }},
      {"cone.repose_deg", "deg",
       "slope of the flank: line through the surface between 15 % and 85 % of the height",
       [](F f) { return f.frame.repose_deg; }, "repose (deg)"},
      {"cone.sector_repose_deviation_deg", "deg",
       "standard deviation of the slopes of eight sectors; nan where half of them have too few "
       "columns for a line",
       [](F f) { return f.sector_deviation_deg; }},
      {"cone.volume_fraction", "-", "mean of the inside",
       [](F f) { return f.frame.volume_fraction; }, "volume fraction"},
      {"cone.rho_g_h", "Pa",
       "unit of pressure: grain density times cone.volume_fraction times g times height",
       [](F f) { return f.frame.pressure(); }},
      {"cone.mean_diameter", "m", "of the grains", [](F f) { return f.frame.diameter; }},
      {"cone.coordination", "-", "contacts of a grain", [](F f) { return coordination(f.cone); }},
      {"cone.base_over_weight", "-", "force on the base from its rings, over that on the floor",
       [](F f) { return f.on_rings / f.on_floor; }},
      {"dip.contacts_in_disk", "-",
       "contacts with a cone's base within heap.centre of the foot's radius; with fewer than five "
       "its dip is nan",
       [](F f) { return f.windows.in_disk; }},
      {"dip.sector_error", "rho g h",
       "standard error of shoulder - centre over the eight sectors of a cone: what one cone alone "
       "tells; dip.standard_error is over the cones",
       [](F f) { return f.windows.sector_error; }},
  };
  return all;
}

const std::vector<RunFigure<ConesFacts>>& cones_rows() {
  using F = const ConesFacts&;
  static const std::vector<RunFigure<ConesFacts>> all{
      {"cone.source", "text", "point | rain | cylinder; of grains.files what they say",
       [](F f) -> std::optional<FigureValue> {
         return f.source.empty() ? std::nullopt : std::optional<FigureValue>(f.source);
       }},
      {"base.largest_shear", "rho g h",
       "largest radial shear stress sigma_rz on the base, ensemble mean, smeared; above 0 the "
       "grains push the floor outwards",
       [](F f) { return f.largest_shear; }},
      {"base.largest_shear_at", "h", "its distance from the axis",
       [](F f) { return f.largest_shear_at; }},
  };
  return all;
}

std::vector<SummaryKey> cone_figures() {
  std::vector<SummaryKey> out = declared(cone_rows());
  for (SummaryKey& key : declared(cones_rows())) out.push_back(std::move(key));
  return out;
}

}  // namespace grainfield::coupling
