#include <algorithm>

#include "coupling/studies/hard_disks/keys.h"
#include "coupling/studies/hard_disks/page.h"

namespace grainfield::coupling {
namespace {

using Value = std::optional<FigureValue>;

// The largest of a number that every fraction has in every realization.
template <class Of>
double largest(const GasFacts& facts, const Of& of) {
  double out = 0;
  for (const double f : facts.results.setup.fractions) {
    const std::string name = "gas." + dem::name_of_fraction(f) + ".";
    const auto samples = [&](const char* key) -> const std::vector<double>& {
      return facts.figures.at(name + key);
    };
    for (std::size_t r = 0; r < samples("overlap").size(); ++r) {
      out = std::max(out, of(samples, r));
    }
  }
  return out;
}

bool pressed(const GasFacts& facts) { return facts.results.setup.kind == "pressure"; }

}  // namespace

const std::vector<RunFigure<GasFacts>>& gas_rows() {
  using F = const GasFacts&;
  static const std::vector<RunFigure<GasFacts>> all{
      {"pressure_largest_difference", "-",
       "largest of |Z over theory - 1| of all fractions, means over the realizations",
       [](F f) { return pressed(f) ? Value(gas_largest_difference(f.results)) : std::nullopt; }},
      {"haff_largest_difference", "-",
       "largest of |T over Haff's law - 1| of all fractions and times, likewise",
       [](F f) {
         const bool cools_freely = !pressed(f) && f.results.setup.friction == 0;
         return cools_freely ? Value(gas_largest_difference(f.results)) : std::nullopt;
       }},
      {"energy_drift_per_collision", "-",
       "largest drift of a fraction's energy over its collisions",
       [](F f) {
         return largest(f, [](const auto& samples, std::size_t r) {
           return samples("energy_drift")[r] / samples("collisions")[r];
         });
       }},
      {"overlap", "-", "deepest overlap at any collision, over the distance of the centres",
       [](F f) {
         return largest(f,
                        [](const auto& samples, std::size_t r) { return samples("overlap")[r]; });
       }},
      {"events", "-", "of a realization: collisions, crossings of cells and meetings in vain"},
  };
  return all;
}

std::vector<SummaryKey> gas_figures() {
  std::vector<SummaryKey> out = declared(gas_rows(), "gas.");
  const std::vector<SummaryKey> of_fractions{
      {"gas.*.compressibility", "-", "Z = p V/(n k T) by the virial of the collisions"},
      {"gas.*.theory", "-", "Z of Henderson 1975 (disks), Carnahan and Starling 1969 (spheres)"},
      {"gas.*.compressibility_over_theory", "-", "the one over the other"},
      {"gas.*.compressibility_over_virial_series", "-",
       "over the series of ten virial coefficients (Clisby and McCoy 2006), continued"},
      {"gas.*.collision_rate", "1/s", "collisions of a grain per second"},
      {"gas.*.collision_rate_over_enskog", "-", "over Enskog's, with the theory's Z"},
      {"gas.*.energy_drift", "-",
       "change of the energy over it; cooling: of the energy with what the collisions took"},
      {"gas.*.overlap", "-", "deepest overlap at a collision, over the distance of the centres"},
      {"gas.*.collisions", "-", "of pairs, since the lattice or since cooling began"},
      {"gas.*.elastic_share", "-", "of the collisions, without loss by the contact time"},
      {"gas.*.temperature", "-", "at the end of cooling, over that at its start"},
      {"gas.*.temperature_over_haff", "-", "at the end of cooling; without friction"},
  };
  out.insert(out.end(), of_fractions.begin(), of_fractions.end());
  return out;
}

}  // namespace grainfield::coupling
