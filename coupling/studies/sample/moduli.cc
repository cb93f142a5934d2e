#include "coupling/studies/sample/moduli.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/elastic_constants/probed.h"
#include "coupling/run/realization_file.h"
#include "coupling/run/study_result.h"
#include "dem/run/probe_record.h"

namespace grainfield::coupling {
namespace {

// One realization of a state.
struct Probed {
  const ProbedState& state;
  std::size_t r;
};

const std::vector<Figure<Probed>>& modulus_columns() {
  using M = const Probed&;
  // clang-format off
  static const std::vector<Figure<Probed>> columns{
      {"young", "Pa", "Young's modulus, isotropic fit", [](M m) { return m.state.moduli[m.r].young; }},
      {"poisson", "-", "Poisson's ratio, isotropic fit", [](M m) { return m.state.moduli[m.r].poisson; }},
      {"bulk", "Pa", "bulk modulus, isotropic fit", [](M m) { return m.state.moduli[m.r].bulk; }},
      {"shear", "Pa", "shear modulus, isotropic fit", [](M m) { return m.state.moduli[m.r].shear; }},
      {"e_h", "Pa", "Young's modulus in the level, transversely isotropic fit about z", [](M m) { return m.state.moduli[m.r].e_h; }},
      {"e_v", "Pa", "Young's modulus along z, likewise", [](M m) { return m.state.moduli[m.r].e_v; }},
      {"nu_h", "-", "Poisson's ratio in the level, likewise", [](M m) { return m.state.moduli[m.r].nu_h; }},
      {"nu_vh", "-", "strain of the level over that along z when z is loaded, likewise", [](M m) { return m.state.moduli[m.r].nu_vh; }},
      {"g_vh", "Pa", "shear modulus of planes along z, likewise; needs a probe xz", [](M m) { return m.state.moduli[m.r].g_vh; }},
      {"residual_isotropic", "-", "root of the squared stress that the isotropic fit leaves over all of it", [](M m) { return m.state.moduli[m.r].residual_isotropic; }},
      {"residual_transverse", "-", "the same of the transversely isotropic fit", [](M m) { return m.state.moduli[m.r].residual_transverse; }},
      {"asymmetry", "-", "largest |C_ab - C_ba| of the axes over the mean C_aa; 0 where the stress has a potential", [](M m) { return m.state.asymmetry[m.r]; }},
      {"nonlinear_share", "-", "nonlinear part of the stress changes over the linear one: |forth + back| / |forth - back|, 0 if linear", [](M m) { return m.state.nonlinear[m.r]; }},
      {"gained", "-", "contacts that are new after a probe over all, the largest of the probes", [](M m) { return m.state.gained[m.r]; }},
      {"lost", "-", "contacts that are gone after a probe over all, likewise", [](M m) { return m.state.lost[m.r]; }},
      {"newly_sliding", "-", "contacts that slide after a probe and did not before over all, likewise", [](M m) { return m.state.sliding[m.r]; }},
  };
  // clang-format on
  return columns;
}

void add_realization(const dem::StateProbes& probes, ProbedState& out, SpaceIncrements& all) {
  out.lacking.push_back(probes.lacking);
  if (!probes.lacking.empty()) {
    out.moduli.emplace_back();
    for (auto of : {&ProbedState::gained, &ProbedState::lost, &ProbedState::sliding,
                    &ProbedState::nonlinear, &ProbedState::asymmetry}) {
      (out.*of).push_back(kNan);
    }
    return;
  }
  ProbedPacking one = probed_packing(probes);
  all = std::move(one.increments);
  out.moduli.push_back(one.moduli);
  out.gained.push_back(one.gained);
  out.lost.push_back(one.lost);
  out.sliding.push_back(one.sliding);
  out.nonlinear.push_back(one.nonlinear);
  out.asymmetry.push_back(one.asymmetry);
}

std::size_t known_of(const ProbedState& state) {
  return static_cast<std::size_t>(std::count(state.lacking.begin(), state.lacking.end(), ""));
}

}  // namespace

std::vector<ProbedState> probed_moduli(const std::vector<std::string>& files) {
  std::vector<ProbedState> out;
  for (const std::string& state : dem::probed_states()) {
    ProbedState probed;
    probed.state = state;
    std::vector<SpaceIncrements> increments;
    for (const std::string& file : files) {
      const Realization one = read_realization(file);
      const dem::StateProbes probes = dem::probes_of(one.snapshots.front().second, state);
      if (probes.probes.empty() && probes.lacking.empty()) break;
      SpaceIncrements own;
      add_realization(probes, probed, own);
      if (probes.lacking.empty()) increments.push_back(std::move(own));
    }
    if (probed.moduli.size() != files.size()) continue;
    if (!increments.empty()) probed.symmetry = space_symmetry(increments, {});
    out.push_back(std::move(probed));
  }
  return out;
}

FigureSamples moduli_figures(const std::vector<ProbedState>& states) {
  FigureSamples out;
  for (const ProbedState& state : states) {
    for (std::size_t r = 0; r < state.moduli.size(); ++r) {
      if (!state.lacking[r].empty()) continue;
      add_samples(modulus_columns(), {state, r}, out, fmt::format("moduli.{}.", state.state));
    }
  }
  std::erase_if(out, [](const auto& entry) {
    return !std::all_of(entry.second.begin(), entry.second.end(),
                        [](double v) { return std::isfinite(v); });
  });
  return out;
}

void add_symmetry(const std::vector<ProbedState>& states, Summary& summary) {
  for (const ProbedState& state : states) {
    if (known_of(state) == 0) continue;
    const std::string begin = "moduli." + state.state + ".";
    summary[begin + "symmetry"] = state.symmetry.symmetry();
    const auto put = [&](const char* key, double value) {
      if (std::isfinite(value)) summary[begin + key] = value;
    };
    put("p_isotropic", state.symmetry.isotropic.p());
    put("p_transverse", state.symmetry.transverse.p());
  }
}

std::vector<Section> moduli_sections(const std::vector<ProbedState>& states,
                                     const Summary& summary) {
  std::vector<Section> out;
  for (const ProbedState& state : states) {
    const auto first = std::find_if(state.lacking.begin(), state.lacking.end(),
                                    [](const std::string& why) { return !why.empty(); });
    if (first == state.lacking.end()) continue;
    out.emplace_back(Text{"", fmt::format("The {} state could not be probed in {} of {} "
                                          "realizations: {}.",
                                          state.state, state.lacking.size() - known_of(state),
                                          state.lacking.size(), *first)});
  }
  Table table;
  table.title = "Elastic moduli from small strains";
  table.caption =
      "Each direction strained forth and back from the same grains at rest; least squares, mean "
      "over realizations and its standard error. The chances say how often samples of that "
      "symmetry would look as far from it; below 5 % it is refused.";
  table.header = {""};
  for (const ProbedState& state : states) table.header.push_back(state.state + " state");
  for (const SummaryKey& key : moduli_summary_keys()) {
    const std::string name = key.pattern.substr(key.pattern.rfind('.') + 1);
    std::vector<std::string> row{key.meaning + (key.unit == "Pa" ? " (Pa)" : "")};
    bool any = false;
    for (const ProbedState& state : states) {
      row.push_back(shown_with_error(summary, "moduli." + state.state + "." + name));
      any = any || !row.back().empty();
    }
    if (any) table.rows.push_back(std::move(row));
  }
  if (!table.rows.empty()) out.emplace_back(std::move(table));
  return out;
}

std::vector<SummaryKey> moduli_summary_keys() {
  std::vector<SummaryKey> out = declared(modulus_columns(), "moduli.*.");
  out.push_back({"moduli.*.p_isotropic", "-",
                 "chance of a fit this far from isotropy if the grains are isotropic: over "
                 "realizations where there are enough of them (Hotelling), else over all equations "
                 "(F test)"});
  out.push_back({"moduli.*.p_transverse", "-",
                 "the same of transverse isotropy about z within orthotropy along x, y, z"});
  out.push_back({"moduli.*.symmetry", "text",
                 "isotropic, transversely isotropic or less: the first that its chance does not "
                 "refuse at 5 %; not known where there is none"});
  return out;
}

}  // namespace grainfield::coupling
