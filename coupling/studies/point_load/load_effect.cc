#include "coupling/studies/point_load/load_effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "dem/snapshot/displacements.h"

namespace grainfield::coupling {
namespace {

// A loaded grain that moves by more radii has left its place: at the same contacts it moves by some
// overlaps, less than a tenth of that.
constexpr double kPushed = 0.5;
// Another grain may be loose and fall within its cage, so a larger share of the contacts must
// change as well. In a large layer the load reaches no such share, whatever it does at its point.
constexpr double kMoved = 0.5, kChanged = 0.05;

std::string what_moves(const LoadEffect& e) {
  const auto far =
      std::count_if(e.pushed.begin(), e.pushed.end(), [](double x) { return x > kPushed; });
  if (far > 0) {
    return fmt::format("a loaded grain by more than {:g} radii in {} of {} layers, by up to {:.2g}",
                       kPushed, far, e.pushed.size(),
                       *std::max_element(e.pushed.begin(), e.pushed.end()));
  }
  if (e.contacts > 0 && e.moved > kMoved && e.changed > kChanged * e.contacts) {
    return fmt::format("a grain by {:.2g} radii, and changes {:.0f} contacts of {:.0f}", e.moved,
                       e.changed, e.contacts);
  }
  return "";
}

}  // namespace

double pushed_over_radius(const dem::Snapshot& unloaded, const dem::Snapshot& loaded) {
  if (unloaded.grains.size() != loaded.grains.size()) {
    throw std::invalid_argument("snapshots do not belong together: different numbers of grains");
  }
  const dem::Displacements displacements(unloaded, loaded);
  double out = 0;
  for (std::size_t k = 0; k < unloaded.grains.size(); ++k) {
    const dem::Grain& grain = unloaded.grains[k];
    if (!dem::is_loaded(loaded, grain.id)) continue;
    out = std::max(out, displacements.of(k).norm() / grain.radius);
  }
  return out;
}

std::string rearrangement_doubt(const LoadEffect& effect, const std::string& key) {
  const std::string moves = what_moves(effect);
  if (moves.empty()) return "";
  return fmt::format(
      "The load of {:.3g} N moves {}: grains rearrange, so the models do not apply. Lower {}.",
      effect.force, moves, key);
}

}  // namespace grainfield::coupling
