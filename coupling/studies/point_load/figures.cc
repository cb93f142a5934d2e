#include "coupling/studies/point_load/figures.h"

#include "coupling/studies/point_load/keys.h"

namespace grainfield::coupling {
namespace {

using Value = std::optional<FigureValue>;

// A figure of realizations that are enough to compare a ring with the axis.
std::optional<ValueWithError> of_ring(const RingFacts& f, const FigureValue& value,
                                      std::optional<double> error = std::nullopt) {
  if (f.ring.word().empty()) return std::nullopt;
  return ValueWithError{value, error};
}

// What the simulation leaves.
std::vector<SummaryKey> simulated() {
  return {
      {"dem.layer_height", "m", "height of the layer from its columns' highest grains"},
      {"dem.layer_width", "m", "distance of the side walls"},
      {"base.response_over_load", "-", "vertical base force, loaded - unloaded, over the load"},
      {"rest.by_newton", "-",
       "share of realizations that Newton's method brought to rest before the load; in the others "
       "it failed, and damped dynamics did"},
      {"rest.unbalanced_force_ratio", "-",
       "mean resultant over mean contact force that it reached"},
      {"rest.load_steps", "-", "its load steps"},
      {"rest.iterations", "-", "its iterations in all of them"},
      {"load.force", "N", "applied force F"},
      {"load.force_over_weight", "-", "3D: F over the mean weight of a grain"},
      {"load.grains", "-", "3D: grains that share it"},
      {"load.time", "s",
       "load.control = speed: from the piston's touch until the grain resists with F"},
      {"load.x", "m", "abscissa of the loaded grain, packing's axes"},
      {"load.y", "m", "height of the loaded grain, packing's axes; 3D: its other abscissa"},
      {"load.z", "m", "3D: its height"},
      {"load.contacts_gained", "-", "contacts that the load closed"},
      {"load.contacts_lost", "-", "contacts that the load opened"},
      {"load.newly_sliding", "-", "contacts that the load brought to the Coulomb limit"},
      {"load.max_displacement_over_radius", "-",
       "largest displacement by the load over the radius"},
      {"load.unbalanced_force_ratio", "-",
       "mean resultant over mean contact force under the load, where Newton's method applied it"},
      {"load.load_steps", "-", "load steps of Newton's method"},
      {"load.iterations", "-", "its iterations in all of them"},
      {"load.no_rearrangement", "-", "share of realizations without a gained or lost contact"},
  };
}

}  // namespace

const std::vector<RunFigure<LayersFacts>>& layers_rows() {
  using F = const LayersFacts&;
  static const std::vector<RunFigure<LayersFacts>> all{
      {"layer.depth", "m", "h of the models: mean over realizations", [](F f) { return f.depth; }},
      {"layer.F_over_h", "N/m", "load over depth: the unit of normalised responses",
       [](F f) { return f.dim == 2 ? Value(f.force / f.depth) : std::nullopt; }},
      {"layer.F_over_h2", "Pa", "load over depth squared: the same in three dimensions",
       [](F f) { return f.dim == 3 ? Value(f.force / (f.depth * f.depth)) : std::nullopt; }},
      {"layer.mean_diameter", "m", "of the moving grains", [](F f) { return f.diameter; }},
  };
  return all;
}

const std::vector<ErrorFigure<RingFacts>>& ring_rows() {
  using F = const RingFacts&;
  static const std::vector<ErrorFigure<RingFacts>> all{
      {"response.ring_less_axis", "-",
       "3D: pressure on the base on a ring about the load less that below the load, over F/h^2; "
       "each realization's ring is where the others' mean is largest, beyond the averaging",
       [](F f) { return of_ring(f, f.ring.difference, f.ring.error); }},
      {"response.ring_at", "-", "3D: radius of that ring over h",
       [](F f) { return of_ring(f, f.ring.at / f.depth); }},
      {"response.ring_p", "-",
       "3D: two-sided chance of such a difference if there were none (Student's t over the "
       "realizations)",
       [](F f) { return of_ring(f, f.ring.p); }},
      {"response.ring", "text", "3D: \"ring\", \"peak\", or \"neither\" where that is 0.05 or more",
       [](F f) { return of_ring(f, f.ring.word()); }},
      {"response.within_radius", "m", "3D: where the profiles by radius end",
       [](F f) { return ValueWithError{f.within_radius}; }},
      {"response.within_over_load", "-",
       "3D: base response within that radius, from its profile, over F",
       [](F f) { return ValueWithError{f.within_force}; }},
  };
  return all;
}

std::vector<SummaryKey> point_load_figures() {
  return joined({simulated(), declared(layers_rows()), declared(ring_rows())});
}

}  // namespace grainfield::coupling
