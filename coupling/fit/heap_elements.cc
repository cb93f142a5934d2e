#include "coupling/fit/heap_elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "continuum/closed/osl.h"
#include "coupling/fit/fit_tables.h"

namespace grainfield::coupling {
namespace {

std::string text(double v) { return fmt::format("{}", v); }

const Fit* best_of(const HeapFits& fits, const std::vector<std::string>& names) {
  const Fit* best = nullptr;
  for (const Fit& f : fits.fits) {
    if (std::find(names.begin(), names.end(), f.name) == names.end()) continue;
    if (best == nullptr || better(f, *best)) best = &f;
  }
  return best;
}

}  // namespace

std::vector<FiniteElementFit> heap_elements(const HeapFits& fits,
                                            const std::vector<std::string>& names) {
  std::vector<FiniteElementFit> out;
  const double slope = fits.heaps.facts.slope_deg;
  for (const std::string& name : names) {
    FiniteElementFit e;
    e.name = name;
    continuum::Settings settings{{"phi_deg", text(slope)}, {"rho_g", "1"}, {"h", "1"}};
    const bool osl = name == "fe_osl_wedge";
    const Fit* fitted = osl ? best_of(fits, {"osl", "osl_yield"})
                            : best_of(fits, {"cantelaube_minus", "cantelaube_zero",
                                             "cantelaube_plus", "cantelaube_continuous"});
    if (fitted == nullptr) {
      e.why = "no fitted model that it represents";
      out.push_back(std::move(e));
      continue;
    }
    e.of = fitted->name;
    if (osl) {
      const bool both = fitted->parameters.size() == 2;
      const double mu = fitted->parameters.back().value;
      const double eta = both ? fitted->parameters.front().value
                              : continuum::eta_at_yield(slope * std::numbers::pi / 180, mu);
      settings["eta"] = text(eta);
      settings["mu"] = text(mu);
    } else {
      // A slope at the friction angle stands without dilation only by luck (theory-plasticity.md).
      settings.insert({{"dilation_deg", text(std::min(10.0, slope))},
                       {"history", "grow"},
                       {"layers", "12"},
                       {"cells", "24"}});
    }
    e.constants = constants_text(settings);
    try {
      const auto model = continuum::make_model(name, settings);
      judge_elements(e, fits.heaps.data, fits.weights, *fitted,
                     model->stress(fits.heaps.data.points));
    } catch (const continuum::ComputationFailed& failure) {
      e.why = failure.what();
    }
    out.push_back(std::move(e));
  }
  return out;
}

void add_heap_elements(StudyResult& result, const std::vector<FiniteElementFit>& elements) {
  if (elements.empty()) return;
  add_elements(result.summary, elements);
  for (auto& [name, content] : result.texts) {
    if (name == "fits.md") {
      content += '\n';
      content += markdown_table(elements_header(), element_rows(elements));
    }
    if (name == "fits.tex") content += tex_table(elements_header(), element_rows(elements));
  }
  const auto page = result.page;
  result.page = [page, elements](const StudyResult& r, const Realization* first) {
    Report out = page(r, first);
    Table table{"Finite elements with measured and fitted constants",
                "Solved by deal.II on the fit's points, with the fit's weights.", elements_header(),
                element_rows(elements)};
    // Before how it was made.
    out.sections.insert(out.sections.end() - 1, std::move(table));
    return out;
  };
}

}  // namespace grainfield::coupling
