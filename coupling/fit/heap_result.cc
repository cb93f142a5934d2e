#include "coupling/fit/heap_result.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupling/fit/fit_report.h"
#include "coupling/fit/fit_tables.h"
#include "coupling/judge/judge.h"
#include "coupling/observe/setup.h"
#include "coupling/report/judgement.h"

namespace grainfield::coupling {
namespace {

Report page_of(const StudyResult& result, const Realization* first, const EnsembleFits& fits,
               const std::function<dem::Snapshot()>& drawn) {
  Report out;
  out.title = title_of(result.value);
  const HeapFacts& facts = fits.observed.facts;
  out.subtitle = fmt::format("{} pile{}, slope {:.1f} deg", fits.observed.frames.size(),
                             fits.observed.frames.size() == 1 ? "" : "s", facts.slope_deg);
  if (facts.left_deg > 0) {
    out.subtitle += fmt::format(" ({:.1f} left, {:.1f} right, friction angle {:.1f})",
                                facts.left_deg, facts.right_deg, facts.friction());
  }
  add_verdict(out, result.comparison.judgement);
  for (Section& section : fit_pictures(fits)) out.sections.push_back(std::move(section));
  for (Section& section : fit_tables(fits)) out.sections.push_back(std::move(section));
  if (first != nullptr) {
    out.sections.emplace_back(packing("Network of forces", (*first)["pile"]));
  } else if (drawn) {
    out.sections.emplace_back(packing("Network of forces", drawn()));
  }
  add_rows(out, "How it was made", origin_rows(result));
  picture_first(out);
  return out;
}

}  // namespace

HeapResult heap_result(const Case& value, Observations heaps, int threads,
                       const std::function<Observations(const FitSetup&)>& observe,
                       std::function<dem::Snapshot()> drawn) {
  StudyResult out;
  out.value = value;
  const auto fits =
      std::make_shared<EnsembleFits>(fit_heaps(value.get<FitSetup>(), std::move(heaps), threads));
  const auto at_width = [&](double width) {
    FitSetup setup = value.get<FitSetup>();
    setup.width_diameters = width;
    setup.finite_elements.clear();
    setup.bootstrap = 0;
    return fit_heaps(setup, observe(setup), threads).judgement;
  };
  judge_at_widths(value.get<FitSetup>().kernel, at_width, fits->judgement);
  out.comparison = profiles_of(*fits);
  add_fits(out, *fits);
  out.overview = {{"best model", "verdict.best_model", ""},
                  {"beta_hat (deg)", "fit.cantelaube.beta_hat_deg", ""},
                  {"b1", "fit.cantelaube.b1", ""},
                  {"eta", "fit.osl.eta", ""},
                  {"mu", "fit.osl.mu", ""}};
  out.page = [fits, drawn](const StudyResult& result, const Realization* first) {
    return page_of(result, first, *fits, drawn);
  };
  return {std::move(out), fits};
}

}  // namespace grainfield::coupling
