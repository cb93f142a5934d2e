#include "coupling/run/summary_keys.h"

#include <fmt/format.h>

#include <stdexcept>

namespace grainfield::coupling {
namespace {

// '*' matches any text that is not empty.
bool matches(const char* pattern, const char* text) {
  if (*pattern == '\0') return *text == '\0';
  if (*pattern == '*') {
    for (const char* t = text; *t != '\0'; ++t) {
      if (matches(pattern + 1, t + 1)) return true;
    }
    return false;
  }
  return *pattern == *text && matches(pattern + 1, text + 1);
}

}  // namespace

const std::vector<SummaryKey>& summary_keys() {
  static const std::vector<SummaryKey> all = {
      {"case.name", "text", "name of the case file"},
      {"case.study", "text", "kind of study"},
      {"case.hash", "text", "FNV-1a hash of the written-out case (case.toml)"},
      {"version", "text", "of grainfield"},
      {"ensemble.realizations", "-", "independent packings"},
      {"ensemble.seed", "-", "seed from which the realizations' seeds are derived"},
      {"dem.grains", "-", "moving grains"},
      {"dem.contacts", "-", "contacts that transmit force, loaded state"},
      {"dem.sliding_contacts", "-", "of these, at the Coulomb limit"},
      {"dem.steps", "-", "time steps"},
      {"dem.time_step", "s", "time step"},
      {"dem.unbalanced_force_ratio", "-", "mean resultant over mean contact force at the end"},
      {"dem.unbalanced_force_max_ratio", "-",
       "largest resultant over mean contact force at the end"},
      {"dem.kinetic_to_elastic_energy", "-", "kinetic over elastic energy at the end"},
      {"dem.max_overlap_ratio", "-", "largest overlap over the smaller radius"},
      {"dem.layer_height", "m", "height of the layer from its columns' highest grains"},
      {"dem.layer_width", "m", "distance of the side walls"},
      {"dem.volume_fraction", "-", "area of the grains over width times height"},
      {"base.weight_ratio", "-", "vertical force on the base before loading over the weight"},
      {"base.response_over_load", "-", "vertical base force, loaded - unloaded, over the load"},
      {"load.force", "N", "applied force F"},
      {"load.x", "m", "abscissa of the loaded grain, packing's axes"},
      {"load.y", "m", "height of the loaded grain, packing's axes"},
      {"load.contacts_gained", "-", "contacts that the load closed"},
      {"load.contacts_lost", "-", "contacts that the load opened"},
      {"load.newly_sliding", "-", "contacts that the load brought to the Coulomb limit"},
      {"load.max_displacement_over_radius", "-",
       "largest displacement by the load over the radius"},
      {"load.no_rearrangement", "-", "share of realizations without a gained or lost contact"},
      {"layer.depth", "m", "h of the models: mean over realizations"},
      {"layer.F_over_h", "N/m", "load over depth: the unit of normalised responses"},
      {"layer.mean_diameter", "m", "of the moving grains"},
      {"average.width", "m", "w of the coarse-graining kernel"},
      {"average.rve_radius", "m", "of the particle-centre averaging"},
      {"average.*.balance_rms", "-",
       "rms of div sigma + rho g (and wall and load forces) over rho g, "
       "mean over realizations, by averaging method"},
      {"average.*.balance_largest", "-", "largest residual of the same kind"},
      {"average.*.fluctuation", "-",
       "mean standard error over the largest response, by method, at "
       "the profiles below the surface"},
      {"response.total_over_load", "-", "integral of the base response over F; mean"},
      {"response.peak", "N/m", "largest base pressure response"},
      {"response.peak_at", "m", "its distance from the load"},
      {"response.peak_over_F_per_h", "-",
       "largest base pressure response over F/h (half plane 0.637, "
       "smooth rigid base 0.920)"},
      {"response.width", "m", "between the outermost crossings of half the peak"},
      {"response.rms_width", "m", "root of the second central moment"},
      {"response.peaks", "-", "number of peaks of the base response"},
      {"response.integral", "N", "trapezoidal integral of the base response"},
      {"response.*.peaks", "-",
       "number of peaks of a profile, e.g. depth_0.5 (share of the depth)"},
      {"response.*.peak", "N/m", "largest pressure response there"},
      {"compare.*.rel_l2", "-", "relative L2 distance of model and simulation, all profiles"},
      {"compare.*.max", "N/m", "largest distance"},
      {"compare.*.chi2_per_dof", "-",
       "chi squared per degree of freedom with the ensemble's errors"},
      {"compare.*.dof", "-", "independent points"},
      {"compare.*.peak", "N/m", "the model's peak on the last profile"},
      {"compare.*.peak_over_F_per_h", "-", "the same over F/h"},
      {"verdict.best_model", "text", "label of the model nearest to the simulation"},
      {"verdict.sentence", "text", "the verdict for people"},
      {"verdict.position", "-", "0: the losing family's best model, 1: the winning family's"},
      {"verdict.position_error", "-", "its standard error over realizations"},
      {"model.*.name", "text", "registry name of a compared model"},
      {"model.*.*", "-", "figure of a model's evaluation, e.g. unknowns"},
      {"time.dem_s", "s", "wall time of the realizations (this start)"},
      {"time.analysis_s", "s", "wall time of averaging and comparison"},
      {"time.continuum_s", "s", "wall time of the models"},
      {"time.model.*_s", "s", "wall time of one model"},
      {"time.total_s", "s", "wall time of the run (this start)"},
      {"sweep.key", "text", "key that was swept"},
      {"sweep.members", "-",
       "its number of values; every other key carries .NAME_VALUE at its end"},
      {"*.least", "-", "least over realizations, in the unit of the figure"},
      {"*.most", "-", "largest over realizations, in the unit of the figure"},
      {"*.standard_error", "-", "standard error over realizations, in the unit of the figure"},
  };
  return all;
}

const SummaryKey* find_summary_key(const std::string& key) {
  for (const auto& entry : summary_keys()) {
    if (matches(entry.pattern.c_str(), key.c_str())) return &entry;
  }
  return nullptr;
}

void require_documented(const Summary& summary) {
  for (const auto& [key, value] : summary) {
    if (find_summary_key(key) == nullptr) {
      throw std::logic_error("summary key " + key + " is not declared in run/summary_keys.cc");
    }
  }
}

std::string summary_keys_text() {
  std::string out;
  for (const auto& key : summary_keys()) {
    out += fmt::format("{}  ({})\n    {}\n", key.pattern, key.unit == "-" ? "no unit" : key.unit,
                       key.meaning);
  }
  return out;
}

std::string summary_keys_markdown() {
  std::string out =
      "# Keys of summary.json\n\nGenerated by `grainfield keys --summary --markdown`. `*` stands "
      "for "
      "a name; SI units. Figures of the grains are means over realizations. In a sweep every key "
      "carries the member at its end, e.g. `response.peaks.friction_0.3`.\n\n"
      "| key | unit | meaning |\n|---|---|---|\n";
  for (const auto& key : summary_keys()) {
    out += fmt::format("| `{}` | {} | {} |\n", key.pattern, key.unit, key.meaning);
  }
  return out;
}

}  // namespace grainfield::coupling
