#include "coupling/tasks/compare_task.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <set>
#include <stdexcept>

#include "continuum/settings.h"
#include "coupling/base/version.h"
#include "coupling/judge/words.h"
#include "coupling/models/parse_choices.h"
#include "coupling/models/subject.h"
#include "coupling/observe/seen_models.h"
#include "coupling/result/judgement.h"
#include "coupling/result/tables.h"
#include "coupling/run/comparison_page.h"
#include "coupling/run/study_result.h"
#include "coupling/run/summary_keys.h"
#include "coupling/specimen/heap_field.h"
#include "coupling/store/added_forces.h"
#include "coupling/store/field_io.h"
#include "coupling/store/output_folder.h"
#include "coupling/studies/pile/page.h"
#include "coupling/studies/point_load/page.h"
#include "coupling/tasks/measured_share.h"

namespace grainfield::coupling {
namespace {

bool starts_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

// Fields that hold the packing's stress as it is looked at first: no model, no other averaging.
bool is_candidate(const std::string& name, const Field& field) {
  return (field.find("sigma_yy") != nullptr || field.find("sigma_zz") != nullptr) &&
         field.has("method") && name != "base_unloaded" && !starts_with(name, "model_") &&
         name.find("_unloaded") == std::string::npos && !starts_with(name, "particle_centre") &&
         !starts_with(name, "area_exact");
}

std::vector<std::string> names_in(const CompareRequest& request) {
  if (request.held.empty()) return list_fields(request.file);
  std::vector<std::string> names;
  for (const auto& [name, field] : request.held) names.push_back(name);
  return names;
}

// A model beside itself would be the nearest and the next.
void require_different(const std::vector<ModelChoice>& models) {
  for (auto one = models.begin(); one != models.end(); ++one) {
    for (auto other = models.begin(); other != one; ++other) {
      if (one->name == other->name && one->settings == other->settings) {
        throw std::invalid_argument(
            fmt::format("model {}: found twice with the same settings, allowed: once", one->name));
      }
    }
  }
}

Field field_in(const CompareRequest& request, const std::string& name) {
  if (request.held.empty()) return read_field(request.file, name);
  for (const auto& [held, field] : request.held)
    if (held == name) return field;
  throw std::invalid_argument(fmt::format("{}: holds no field \"{}\"; there are: {}", request.file,
                                          name, fmt::join(names_in(request), ", ")));
}

std::vector<std::string> chosen(const CompareRequest& request) {
  if (!request.fields.empty()) return request.fields;
  std::vector<std::string> lines, maps, heap_lines, heap_maps, others;
  for (const auto& name : names_in(request)) {
    const Field field = field_in(request, name);
    if (!is_candidate(name, field)) continue;
    if (field.is_of_heap()) {
      // The base of a pile's run is "base"; averages of the same place stand beside it.
      if (name.size() > 5 && name.compare(name.size() - 5, 5, "_base") == 0) continue;
      (field.nx == 0 ? heap_lines : heap_maps).push_back(name);
    } else if (field.has("F")) {
      (field.nx == 0 ? lines : maps).push_back(name);
    } else {
      others.push_back(name);
    }
  }
  // Where a run has rings, averaged over the angle, its verdict goes by them and not by lines.
  const auto in_rings = [](const std::string& name) { return name.find("rings") != name.npos; };
  if (std::any_of(lines.begin(), lines.end(), in_rings)) {
    std::erase_if(lines, [&](const std::string& name) { return !in_rings(name); });
  }
  // A file of a run holds lines at its depths; one of `average` a map and the base.
  if (lines.empty() || (lines.size() == 1 && lines.front() == "base_response")) {
    lines.insert(lines.begin(), maps.begin(), maps.end());
  }
  if (!lines.empty()) return lines;
  if (!heap_lines.empty()) return heap_lines;
  if (!heap_maps.empty()) return {heap_maps.front()};
  if (!others.empty()) return {others.front()};
  throw std::invalid_argument(request.file +
                              ": holds no averaged stress to compare (`grainfield average` and "
                              "`grainfield import-field` make "
                              "it)");
}

// Whether the model has no answer without it: a weight may be 0 by default.
bool needs(const ModelChoice& choice, const std::string& name) {
  const auto& all = continuum::find_model(choice.name).parameters;
  return std::any_of(all.begin(), all.end(),
                     [&](const auto& p) { return p.name == name && p.value != 0; });
}

// A model that needs a load, or a weight, which the field does not tell and its user has not set.
void require_known(const ModelChoice& choice, const RunFacts& facts, const std::string& file) {
  const auto missing = [&](const char* name, bool known) {
    return !known && choice.settings.count(name) == 0 && needs(choice, name);
  };
  if (missing("F", std::isfinite(facts.force))) {
    throw std::invalid_argument(fmt::format(
        "model {}: needs the load F, and {} holds no response to a known load; import the states "
        "with their load (`grainfield import --load ID=FX,FY`) and average their difference "
        "(`grainfield average --response`), or set it: --model {}:F=...",
        choice.label, file, choice.name));
  }
  const auto& info = continuum::find_model(choice.name);
  const int dim = info.dim != 0 || choice.settings.count("dim") > 0
                      ? continuum::dimension(info, choice.settings)
                      : facts.dim;
  if (dim != facts.dim)
    throw std::invalid_argument(fmt::format("model {}: is {}D, the field in {} is {}D",
                                            choice.label, dim, file, facts.dim));
  const bool weighed = facts.numbers.count("rho_g") > 0 || choice.settings.count("map") > 0;
  if (missing("rho_g", weighed)) {
    throw std::invalid_argument(fmt::format(
        "model {}: needs rho_g, the weight per volume (N/m3, 2D: N/m2), and {} holds no heap; set "
        "it: --model {}:rho_g=..., or average heaps in their frame (`grainfield average --frame "
        "heap`)",
        choice.label, file, choice.name));
  }
}

// What a heap tells this model. Theories of one slope see both flanks at the mean of the two, as
// the fits do (fit/heap_rows.h), unless one of the models takes them apart. Of Liffman's lines only
// chi_g / spacing counts: they carry the weight of the heap, rho_g per area, when it is
// rho_g sqrt(3)/2 (lines at 60 degrees, a spacing d apart along the base).
RunFacts facts_for(const ModelChoice& choice, const RunFacts& facts, bool flanks_apart) {
  RunFacts out = facts;
  const auto slope = out.numbers.find("phi_deg");
  if (slope == out.numbers.end()) return out;
  if (!flanks_apart) out.numbers["left_deg"] = out.numbers["right_deg"] = slope->second;
  if (choice.name != "liffman") return out;
  const auto settings = continuum::complete(continuum::find_model(choice.name), choice.settings);
  const double alpha = choice.settings.count("alpha_deg") > 0
                           ? continuum::number_of(settings, "alpha_deg")
                           : slope->second;
  const double spacing = continuum::number_of(settings, "spacing");
  out.numbers["alpha_deg"] = alpha;
  out.numbers["width"] = 2 * out.height / std::tan(alpha * std::numbers::pi / 180);
  out.numbers["spacing"] = spacing;
  out.numbers["chi_g"] = out.numbers.at("rho_g") * std::numbers::sqrt3 / 2 * spacing;
  return out;
}

void add_figures_of(const Observations& observed, const Comparison& comparison, std::size_t main,
                    Summary& summary) {
  add_compared(summary, observed, comparison, main);
  const Scale& scale = observed.scale;
  if (observed.specimen == Specimen::heap) {
    summary["pile.height"] = scale.h;
    summary["heap.rho_g_h"] = scale.unit;
    return;
  }
  summary["layer.depth"] = scale.h;
  if (observed.specimen == Specimen::layer) {
    summary[observed.told.dim == 3 ? "layer.F_over_h2" : "layer.F_over_h"] = scale.unit;
  }
}

Report page_of(const CompareRequest& request, const Observations& observed,
               const Comparison& comparison, const std::vector<SeenModel>& models,
               const ReportRows& made) {
  const std::string title = "Comparison of " + request.file;
  if (observed.specimen == Specimen::layer) {
    PointLoadReport page;
    page.title = title;
    page.comparison = comparison;
    page.map = observed.map;
    if (observed.map.nx > 0) {
      for (const SeenModel& m : models) page.models.push_back({m.profiles.label, m.map.col(1)});
    }
    page.made = made;
    return point_load_report(page);
  }
  PileReport page;
  page.title = title;
  page.subtitle = comparison.scale.note;
  page.comparison = comparison;
  page.map = observed.map;
  page.averaged = observed.seen.front();
  page.made = made;
  return pile_report(page);
}

// Returns a line for each share that measured values carry, and adds the doubts to the verdict.
std::vector<std::string> carried_lines(const NamedFields& fields, Judgement& judgement) {
  std::vector<std::string> out;
  for (const auto& [name, field] : fields) {
    const auto share = carried_share(field);
    if (!share) continue;
    out.push_back(share_text(*share));
    if (const std::string doubt = share_doubt(*share); !doubt.empty()) {
      judgement.doubts.push_back(as_sentence(doubt));
    }
  }
  return out;
}

}  // namespace

CompareOutcome run_compare(const CompareRequest& request) {
  const std::vector<ModelChoice> choices = parse_choices(request.models);
  std::optional<OutputFolder> results;
  if (!request.folder.empty()) {
    results.emplace(request.folder, "grainfield compare " + request.file);
    if (request.held.empty()) results->require_other_than({request.file});
  }
  NamedFields fields;
  for (const auto& name : chosen(request)) fields.emplace_back(name, field_in(request, name));
  const Observations observed = observe_fields(fields, request.lines, request.file);
  CompareOutcome out;
  out.measured = observed.measured;
  std::size_t main = observed.lines.size() - 1;
  for (std::size_t l = 0; l < observed.lines.size(); ++l) {
    if (observed.lines[l].places.smoothing == Smoothing::marginal) main = l;
  }
  require_different(choices);
  std::vector<std::string> names;
  for (const auto& choice : choices) {
    names.push_back(choice.name);
    require_known(choice, observed.told, request.file);
    if (observed.specimen == Specimen::rest) continue;
    require_subject({choice}, observed.specimen == Specimen::heap ? Subject::heap : Subject::load,
                    observed.told.dim, "model");
  }
  const bool flanks_apart = takes_flanks_apart(names);
  const std::vector<SeenModel> models = see_models(
      observed, choices, evaluate_model,
      [&](const ModelChoice& choice) { return facts_for(choice, observed.told, flanks_apart); });
  Summary summary;
  for (const SeenModel& model : models) {
    const std::string prefix = "model." + model.choice.label + ".";
    summary[prefix + "name"] = model.choice.name;
    for (const auto& [key, figure] : model.figures) summary[prefix + key] = figure;
  }
  Comparison comparison = compared(observed, models);
  if (out.measured) out.carried = carried_lines(fields, comparison.judgement);
  if (const std::string note = added_forces_note(fields.front().second); !note.empty()) {
    comparison.judgement.doubts.push_back(as_sentence(note));
    comparison.scale.note += "; " + note;
  }
  summary["version"] = version_and_commit();
  summary["ensemble.realizations"] = static_cast<std::int64_t>(observed.realizations);
  add_figures_of(observed, comparison, main, summary);
  add_judgement(summary, comparison.judgement);
  require_documented(summary);

  if (results) {
    const ReportRows made{{"fields", request.file},
                          {"seen through", fmt::format("{}", fmt::join(observed.seen, "; "))},
                          {"version", version_and_commit()}};
    write_profiles(results->staging(), comparison);
    write_judgement(results->staging(), comparison.judgement);
    Report page = page_of(request, observed, comparison, models, made);
    write_profile_tables(results->staging(), page, comparison);
    out.lacks = write_report(results->staging("report.html"), page).complaint();
    write_summary(results->staging("summary.json"), summary);
    out.gone = gone_note(request.folder, results->publish());
  }
  out.comparison = std::move(comparison);
  out.summary = std::move(summary);
  return out;
}

}  // namespace grainfield::coupling
