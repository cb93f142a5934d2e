#include "coupling/fit/layer_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "coupling/fit/fit_tables.h"
#include "coupling/statistics/spread.h"

namespace grainfield::coupling {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (k > 0) out += k + 1 == names.size() ? " and " : ", ";
    out += names[k];
  }
  return out;
}

FitVerdict without_spread(const std::vector<Fit>& fits, int realizations) {
  std::vector<const Fit*> order;
  for (const Fit& f : fits) order.push_back(&f);
  std::stable_sort(order.begin(), order.end(),
                   [](const Fit* a, const Fit* b) { return a->rel_l2 < b->rel_l2; });
  FitVerdict out;
  out.model = order.front()->name;
  out.equations = "not distinguishable";
  out.sentence = fmt::format(
      "{}{} realization{}: without a spread nothing is distinguishable. Nearest is {} (relative L2 "
      "{:.1f} %)",
      realizations < least_for_significance ? "" : "All equal, ", realizations,
      realizations == 1 ? "" : "s", out.model, 100 * order.front()->rel_l2);
  if (order.size() > 1) {
    out.sentence += fmt::format(", then {} ({:.1f} %)", order[1]->name, 100 * order[1]->rel_l2);
  }
  for (const Fit* f : order) {
    if (f->equations == order.front()->equations) continue;
    out.sentence += fmt::format("; the nearest {} one is {} ({:.1f} %)", f->equations, f->name,
                                100 * f->rel_l2);
    break;
  }
  out.sentence += ".";
  return out;
}

}  // namespace

bool contains(const Fit& general, const Fit& special) {
  if (general.name == special.name) return true;
  if (general.kind.empty() || special.kind.empty()) return false;
  if (general.kind == special.kind) return general.parameters.size() >= special.parameters.size();
  // With both of its moduli's ratios free. The smooth base is no special case of the rough one.
  if (general.parameters.size() < 2) return false;
  return (general.kind == "orthotropic_half_plane" && special.kind == "flamant") ||
         (general.kind == "orthotropic_layer smooth" && special.kind == "layer smooth") ||
         (general.kind == "orthotropic_layer rough" && special.kind == "layer rough");
}

FitVerdict layer_verdict(const std::vector<Fit>& fits, const Selection& selection,
                         int realizations) {
  if (fits.empty() || selection.ranking.empty()) {
    throw std::invalid_argument("verdict: no fitted model");
  }
  if (realizations < least_for_significance || std::isnan(fits.front().chi2_per_dof)) {
    return without_spread(fits, realizations);
  }
  FitVerdict out;
  std::vector<std::string> supported;
  std::set<std::string> types;
  const Fit* simplest = nullptr;
  for (const Score& s : selection.ranking) {  // the first of equals stays
    if (!s.supported) continue;
    const Fit& f = fit_named(fits, s.name);
    supported.push_back(s.name);
    types.insert(f.equations);
    if (simplest == nullptr || f.parameters.size() < simplest->parameters.size()) simplest = &f;
  }
  out.model = simplest->name;
  out.equations = types.size() == 1 ? *types.begin() : "not distinguishable";
  out.alone = std::all_of(supported.begin(), supported.end(), [&](const std::string& name) {
    return contains(fit_named(fits, name), *simplest);
  });
  out.agrees = !disagrees(*simplest);
  const std::string nearness = fmt::format("chi2/dof {:.3g}, relative L2 {:.1f} %",
                                           simplest->chi2_per_dof, 100 * simplest->rel_l2);
  if (out.alone) {
    out.sentence = fmt::format("{}: {} ({})", out.agrees ? "Supported" : "Nearest of those asked",
                               out.model, nearness);
    for (const Score& s : selection.ranking) {
      if (s.supported || contains(fit_named(fits, s.name), *simplest)) continue;
      out.sentence +=
          fmt::format("; {}, the next, is {}; {} realizations", s.name, evidence(s), realizations);
      break;
    }
    out.sentence += ".";
  } else {
    out.sentence = fmt::format("Not distinguishable: {}; the simplest is {} ({}).",
                               joined(supported), out.model, nearness);
  }
  if (out.equations == "not distinguishable") {
    out.sentence += " Elliptic or hyperbolic: not distinguishable.";
  } else {
    out.sentence += fmt::format(" The response is {}", out.equations);
    for (const Score& s : selection.ranking) {
      const std::string& equations = fit_named(fits, s.name).equations;
      if (equations == out.equations) continue;
      out.sentence += fmt::format(": the best {} model, {}, is {}", equations, s.name, evidence(s));
      break;
    }
    out.sentence += ".";
  }
  if (!out.agrees) {
    out.sentence += fmt::format(
        " No agreement within the errors: chi2/dof {:.3g}, where up to {:.3g} would be chance.",
        simplest->chi2_per_dof, simplest->chance);
  }
  out.sentence += sign_warnings(fits, supported);
  return out;
}

}  // namespace grainfield::coupling
