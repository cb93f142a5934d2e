#include "coupling/observe/declaration.h"

#include <utility>

#include "coupling/observe/seen_models.h"
#include "coupling/report/judgement.h"
#include "coupling/run/comparison_page.h"

namespace grainfield::coupling {
namespace {

void add_pictures(Report& page, const StudyResult& result, const Realization& first,
                  const Declaration& d) {
  if (d.pictures) {
    for (Section& one : d.pictures(result, first)) page.sections.push_back(std::move(one));
  } else if (const dem::Snapshot& last = first.snapshots.back().second; last.dim == 2) {
    page.sections.emplace_back(packing("Network of forces", last));
  }
  const Comparison& c = result.comparison;
  if (c.profiles.empty()) return;
  page.sections.emplace_back(
      curves("Profiles", "x / h", "stress / (" + c.scale.stress + ")", profile_frames(c)));
  if (!c.models.empty()) page.sections.emplace_back(distances_table(c, c.scale.stress));
}

Report page_of(const StudyResult& result, const Realization* first, const Declaration& d) {
  Report page;
  page.title = title_of(result.value);
  if (d.subtitle) page.subtitle = d.subtitle(result);
  add_verdict(page, result.comparison.judgement);
  if (first != nullptr) add_pictures(page, result, *first, d);
  add_rows(page, "Figures", figure_rows(result));
  add_rows(page, "How it was made", origin_rows(result));
  return page;
}

StudyResult analysed(const Case& value, const std::vector<std::string>& files, int threads,
                     const Declaration& d) {
  StudyResult out = begin_result(value, files);
  FigureSamples figures;
  for (const std::string& file : files) {
    const Realization one = read_realization(file);
    for (const auto& [key, figure] : one.figures) figures[key].push_back(figure);
    add_samples(d.observed, one, figures);
  }
  add_figures(out.summary, figures);
  if (d.compared || d.predicted) {
    std::vector<ModelChoice> choices = value.models;
    const Observations observed =
        d.predicted ? d.predicted(out, choices, threads) : d.compared(value, files, threads);
    const std::vector<SeenModel> models = see_models(observed, choices);
    out.comparison = compared(observed, models);
    add_compared(out.summary, observed, out.comparison, 0);
    add_models(out, observed, models);
  }
  add_values(d.found, out, out.summary);
  if (d.more) d.more(out);
  if (d.told) out.comparison.judgement.findings = {d.told(out)};
  out.page = [d](const StudyResult& result, const Realization* first) {
    return page_of(result, first, d);
  };
  return out;
}

}  // namespace

void declare(Study& study, Declaration d) {
  study.figures.emplace_back([rows = d.observed] { return declared(rows); });
  study.figures.emplace_back([rows = d.found] { return declared(rows); });
  study.analyse = [d = std::move(d)](const Case& value, const std::vector<std::string>& files,
                                     int threads) { return analysed(value, files, threads, d); };
}

}  // namespace grainfield::coupling
