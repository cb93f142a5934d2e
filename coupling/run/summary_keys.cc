#include "coupling/run/summary_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <stdexcept>

#include "continuum/model.h"
#include "coupling/case/study.h"
#include "coupling/result/key_pattern.h"
#include "coupling/result/text_table.h"

namespace grainfield::coupling {
namespace {

// Whether the text is the key of a declared figure and, behind a dot, a member of a sweep.
bool of_a_member(const std::string& text) {
  for (std::size_t dot = text.rfind('.'); dot != std::string::npos && dot > 0;
       dot = text.rfind('.', dot - 1)) {
    if (find_summary_key(text.substr(0, dot)) != nullptr) return true;
  }
  return false;
}

// What models declare, a line for each figure with the models that have it. Which model has which
// figure is looked at where they are taken (models/model_record.cc).
std::vector<SummaryKey> model_figures() {
  struct Line {
    std::string name, unit, meaning;
    std::vector<std::string> models;
  };
  std::vector<Line> lines;
  for (const continuum::ModelInfo& info : continuum::registry()) {
    for (const continuum::Figure& f : info.figures) {
      const auto same = std::find_if(lines.begin(), lines.end(), [&](const Line& line) {
        return line.name == f.name && line.meaning == f.meaning;
      });
      if (same == lines.end()) {
        lines.push_back({f.name, f.unit, f.meaning, {info.name}});
      } else {
        same->models.push_back(info.name);
      }
    }
  }
  std::vector<SummaryKey> out{{"model.*.name", "text", "registry name of a compared model"}};
  for (const Line& line : lines) {
    const std::string pattern = "model.*." + line.name;
    const std::string text = fmt::format("{} ({})", line.meaning, fmt::join(line.models, ", "));
    const auto there = std::find_if(out.begin(), out.end(),
                                    [&](const SummaryKey& key) { return key.pattern == pattern; });
    if (there == out.end()) {
      out.push_back({pattern, line.unit, text});
    } else {
      there->meaning += "; " + text;
    }
  }
  return out;
}

std::vector<SummaryKey> declared_keys() {
  static const std::vector<SummaryKey> of_runs = {
      {"case.name", "text", "name of the case file"},
      {"case.command", "text", "what was run, without folder and threads (they change no number)"},
      {"case.study", "text", "kind of study"},
      {"case.hash", "text", "FNV-1a hash of the written-out case (case.toml)"},
      {"warnings", "text",
       "what to mind of these results, a sentence each; the key is missing where there is none"},
      {"version", "text",
       "of grainfield, with the commit it was built from (+: files were changed)"},
      {"ensemble.realizations", "-", "independent packings"},
      {"ensemble.seed", "-", "seed from which the realizations' seeds are derived"},
      {"dem.grains", "-", "moving grains"},
      {"dem.contacts", "-",
       "contacts that transmit force, in the last state (piles: before any change)"},
      {"dem.sliding_contacts", "-", "of these, at the Coulomb limit"},
      {"dem.steps", "-", "time steps"},
      {"dem.time_step", "s", "time step"},
      {"dem.unbalanced_force_ratio", "-", "mean resultant over mean contact force at the end"},
      {"dem.unbalanced_moment_ratio", "-",
       "mean |moment| on a grain over its radius, over mean contact force, at the end"},
      {"dem.unbalanced_force_max_ratio", "-",
       "largest resultant over mean contact force at the end"},
      {"dem.kinetic_to_elastic_energy", "-", "kinetic over elastic energy at the end"},
      {"dem.max_overlap_ratio", "-", "largest overlap over the smaller radius"},
      {"dem.volume_fraction", "-",
       "layer: area of the grains over width times height; pile: as heap.volume_fraction"},
      {"base.weight_ratio", "-",
       "vertical force on the base over the weight, before any load or change"},
      {"energy.kinetic", "J", "of the grains at the end; energy.*: with motion.energy_balance"},
      {"energy.elastic", "J", "stored in contacts at the end"},
      {"energy.lost_in_dashpots", "J", "in normal dashpots of contacts, since the start"},
      {"energy.lost_to_friction", "J", "by sliding, and in dashpots along contacts"},
      {"energy.lost_to_rolling", "J", "by rolling and twisting"},
      {"energy.lost_to_damping", "J", "to background and local damping"},
      {"energy.lost_to_sleep", "J", "kinetic, of grains when they fell asleep"},
      {"energy.brought", "J", "kinetic and elastic, with grains that were added"},
      {"energy.work_of_gravity", "J", "on the grains since they were added"},
      {"energy.work_of_load", "J", "of the force on a grain"},
      {"energy.work_of_walls", "J", "of walls that move"},
      {"energy.work_of_cell", "J", "of a cell that flows"},
      {"energy.work_of_law", "J",
       "done by a contact law whose force is no gradient (overlap_area of polygons), or whose "
       "spring changes its stiffness (hertz)"},
      {"energy.balance_error", "-",
       "energy that is there or lost, less the works, over the sum of their sizes"},
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
      {"response.peak", "N/m (3D: Pa)", "largest base pressure response"},
      {"response.peak_at", "m", "its distance from the load"},
      {"response.peak_over_F_per_h", "-",
       "largest base pressure response over F/h (half plane 0.637, "
       "smooth rigid base 0.920), 3D: over F/h^2"},
      {"response.width", "m", "between the outermost crossings of half the peak"},
      {"response.rms_width", "m", "root of the second central moment"},
      {"response.peaks", "-", "number of peaks of the base response"},
      {"response.integral", "N", "trapezoidal integral of the base response"},
      {"response.*.peaks", "-",
       "number of peaks of a profile, e.g. depth_0.5 (share of the depth)"},
      {"response.*.peak", "N/m (3D: Pa)", "largest pressure response there"},
      {"compare.*.rel_l2", "-", "relative L2 distance of model and simulation, all profiles"},
      {"compare.*.max", "N/m (3D: Pa)", "largest distance"},
      {"compare.*.chi2_per_dof", "-",
       "misfit: squared difference, each profile over its root mean square, over what the errors "
       "make of a true model's: 1 in the mean"},
      {"compare.*.chance", "-", "the misfit that a true model exceeds in 1 of 100 ensembles"},
      {"compare.*.dof", "-", "independent values behind the misfit"},
      {"compare.*.*.rel_l2", "-", "the same distance on one profile, e.g. height_0.1 or base"},
      {"compare.*.*.max", "N/m (3D: Pa)", "largest distance there"},
      {"compare.*.*.chi2_per_dof", "-", "misfit there"},
      {"compare.*.*.chance", "-", "the misfit there that a true model exceeds in 1 of 100"},
      {"compare.*.*.dof", "-", "independent values there"},
      {"compare.*.peak", "N/m (3D: Pa)", "the model's peak on the last profile"},
      {"compare.*.peak_over_F_per_h", "-", "the same over F/h, 3D: over F/h^2"},
      {"verdict.best_model", "text",
       "of the models that cannot be distinguished from the nearest the one with the fewest free "
       "numbers, the nearest of equals; without errors the nearest"},
      {"verdict.sentence", "text", "the verdict for people, and whether any model agrees"},
      {"verdict.doubts", "text", "what makes the verdict doubtful, with what to do"},
      {"verdict.distinguishable", "text",
       "yes: every other model is behind the nearest by more than chance, of the best model's "
       "family, or contains it; no; unknown: no errors"},
      {"verdict.agrees", "text",
       "yes: the best model's misfit is within chance; no; unknown: no errors"},
      {"verdict.equations", "text", "elliptic | hyperbolic | not distinguishable"},
      {"verdict.position", "-", "0: the other family's best model, 1: the nearest family's"},
      {"verdict.position_error", "-", "its standard error over realizations"},
      {"verdict.realizations_needed", "-",
       "that would distinguish the two best models at 95 % with a power of 80 %; null: none is "
       "foreseen"},
  };
  static const std::vector<SummaryKey> of_all = {
      {"time.dem_cpu_s", "s",
       "CPU time of the realizations, all starts together; of a sweep: of each member"},
      {"time.dem_s", "s",
       "wall time of the realizations (this start; of a sweep: of all members together)"},
      {"time.analysis_s", "s", "wall time of averaging and comparison"},
      {"time.continuum_s", "s", "wall time of the models"},
      {"time.model.*_s", "s", "wall time of one model"},
      {"time.total_s", "s", "wall time of the run (this start)"},
      {"memory.peak_MB", "MB", "most memory that the process had so far: simulation and analysis"},
      {"sweep.key", "text", "key that was swept"},
      {"sweep.sentence", "text", "which members differ beyond chance, and by how much"},
      {"sweep.difference.*", "-", "member minus the first, in the unit of the figure"},
      {"sweep.difference_error.*", "-", "its standard error"},
      {"sweep.p_value.*", "-", "two-sided p of that difference (Welch's t over realizations)"},
      {"sweep.p_holm.*", "-", "the same, corrected for all that are compared (Holm)"},
      {"sweep.members", "-",
       "its number of values; every other key carries .NAME_VALUE at its end"},
      {"*.least", "-", "least over realizations, in the unit of the figure"},
      {"*.most", "-", "largest over realizations, in the unit of the figure"},
      {"*.standard_error", "-", "standard error over realizations, in the unit of the figure"},
  };
  auto joined = of_runs;
  const auto add = [&](const std::vector<SummaryKey>& part) {
    for (const SummaryKey& key : part) {
      const bool there = std::any_of(joined.begin(), joined.end(), [&](const SummaryKey& other) {
        return other.pattern == key.pattern;
      });
      if (!there) joined.push_back(key);
    }
  };
  for (const Study& study : studies()) {
    for (const auto& figures : study.figures) add(figures());
  }
  add(model_figures());
  add(of_all);
  return joined;
}

std::vector<SummaryKey>& known_keys() {
  static std::vector<SummaryKey> known = declared_keys();
  return known;
}

}  // namespace

const std::vector<SummaryKey>& summary_keys() { return known_keys(); }

const SummaryKey* find_summary_key(const std::string& key) {
  for (const auto& entry : summary_keys()) {
    const std::string& pattern = entry.pattern;
    if (!matches(pattern, key)) continue;
    // What says something of another figure is declared where that figure is.
    if (pattern.front() == '*') {
      if (find_summary_key(key.substr(0, key.size() - pattern.size() + 1)) == nullptr) continue;
    } else if (pattern.starts_with("sweep.") && pattern.back() == '*') {
      if (!of_a_member(key.substr(pattern.size() - 1))) continue;
    }
    return &entry;
  }
  return nullptr;
}

void require_documented(const Summary& summary) {
  bool renewed = false;
  for (const auto& [key, value] : summary) {
    // Models that were added to the registry since bring constants of their own.
    if (!renewed && find_summary_key(key) == nullptr) {
      known_keys() = declared_keys();
      renewed = true;
    }
    if (find_summary_key(key) == nullptr) {
      throw std::logic_error("summary key " + key +
                             " is not declared among the figures of its study");
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
      "carries the member at its end, e.g. `response.peaks.friction_0.3`.\n\n";
  std::vector<std::vector<std::string>> rows;
  for (const auto& key : summary_keys()) {
    rows.push_back({fmt::format("`{}`", key.pattern), key.unit,
                    boost::replace_all_copy(key.meaning, "|", "\\|")});
  }
  return out + plain_markdown_table({"key", "unit", "meaning"}, rows);
}

}  // namespace grainfield::coupling
