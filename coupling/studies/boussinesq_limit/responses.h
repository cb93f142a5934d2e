// The mean response of a settled layer to a small load on many of its surface grains, one place
// after the other, by linear response (dem/quasistatic/small_loads.h).
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "coupling/averaging/kernel.h"
#include "coupling/averaging/layer.h"
#include "coupling/averaging/options.h"
#include "coupling/base/field.h"
#include "coupling/studies/boussinesq_limit/settlement.h"
#include "dem/laws/materials.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Grains that share a load, the middle of their places seen from above, and their mean depth below
/// the surface, m.
struct LoadPlace {
  std::vector<std::int64_t> grains;
  double x = 0, y = 0, depth = 0;
};

/// Places of the surface, evenly spread over the middle `span` of the width (in the plane) or over
/// the layer, each with `grains` free grains that no higher grain covers and that touch others.
/// Places that would have the same grains are one.
std::vector<LoadPlace> load_places(const dem::Snapshot& layer, const LayerFrame& frame,
                                   std::int64_t places, std::int64_t grains, double span);

/// From the outermost place to its side, m; in space half the width.
double reach_of(const std::vector<LoadPlace>& places, const LayerFrame& frame, int dim);

/// One width of averaging.
struct SeenThrough {
  AverageOptions options;
  std::shared_ptr<const Kernel> kernel;
};

/// Where linear response of a place ends, N, by its own numbers (dem/quasistatic/linear_range.h):
/// loads at which the first contact is open, begins to slide, does either, and at which a hundredth
/// of all contacts have; infinite: none.
struct LinearEnd {
  double opening = 0, sliding = 0, first = 0, hundredth = 0;
};

struct MeanResponse {
  /// For each averaging the stress along a line at each depth, and on the base behind them; models'
  /// frame; in space means over the angle.
  std::vector<std::vector<Field>> lines;
  double settlement = 0;  ///< of the loaded grains, m, mean
  /// At the places given: of the grains of the surface, and of those beside the axis; downwards.
  Settlements settled;
  LinearEnd end;              ///< medians over the places
  double out_of_balance = 0;  ///< largest share of a load that the base and the sides do not carry
  double base_share = 0;      ///< that the base carries, mean
  int places = 0;
};

/// `depths`: of the lines, m below the surface; `at`: their places are those of the surface, from
/// the load, in space radii from 0. `depth`: of the models, m. `force`: in all, N. Throws as
/// SmallLoads.
MeanResponse mean_response(const dem::Snapshot& rest, const dem::Materials& materials,
                           const LayerFrame& frame, const std::vector<LoadPlace>& places,
                           double force, const std::vector<double>& depths, double depth,
                           const SettlementPlaces& at, const std::vector<SeenThrough>& through);

/// Mean weight of the free grains, N.
double mean_weight(const dem::Snapshot& snapshot);

}  // namespace grainfield::coupling
