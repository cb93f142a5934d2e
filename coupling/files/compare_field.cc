#include "coupling/files/compare_field.h"

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
#include "coupling/files/measured_share.h"
#include "coupling/fit/observations.h"
#include "coupling/heap/heap_field.h"
#include "coupling/judge/words.h"
#include "coupling/models/parse_choices.h"
#include "coupling/models/subject.h"
#include "coupling/output/field_io.h"
#include "coupling/output/judgement.h"
#include "coupling/output/output_folder.h"
#include "coupling/output/tables.h"
#include "coupling/run/study_result.h"
#include "coupling/run/summary_keys.h"
#include "coupling/studies/pile/page.h"
#include "coupling/studies/point_load/page.h"
#include "coupling/version.h"
#include "dem/snapshot/added_forces_mark.h"

namespace grainfield::coupling {
namespace {

constexpr double kSame = 1e-9;  // relative: loads and sizes of fields that belong together

bool starts_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

// Fields that hold the packing's stress as it is looked at first: no model, no other averaging.
bool is_candidate(const std::string& name, const Field& field) {
  return (field.find("sigma_yy") != nullptr || field.find("sigma_zz") != nullptr) &&
         field.attributes.count("method") > 0 && name != "base_unloaded" &&
         !starts_with(name, "model_") && name.find("_unloaded") == std::string::npos &&
         !starts_with(name, "particle_centre") && !starts_with(name, "area_exact");
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
    if (is_heap_field(field)) {
      // The base of a pile's run is "base"; averages of the same place stand beside it.
      if (name.size() > 5 && name.compare(name.size() - 5, 5, "_base") == 0) continue;
      (field.nx == 0 ? heap_lines : heap_maps).push_back(name);
    } else if (field.attributes.count("F") > 0) {
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

void require_same(const SceneField& first, const SceneField& next, const std::string& file) {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument(
        fmt::format("{}: fields {} and {} differ in {}; compare one of them (--field)", file,
                    first.name, next.name, what));
  };
  const auto differ = [](double a, double b) {
    return std::isfinite(a) != std::isfinite(b) || std::fabs(a - b) > kSame * std::fabs(a);
  };
  if (first.scene != next.scene) refuse("what they show (load, heap, layer)");
  if (differ(first.facts.force, next.facts.force)) {
    refuse(fmt::format("F ({:g} and {:g} N)", first.facts.force, next.facts.force));
  }
  if (differ(first.facts.height, next.facts.height)) {
    refuse(fmt::format("h ({:g} and {:g} m)", first.facts.height, next.facts.height));
  }
  if (first.field.realizations != next.field.realizations) {
    refuse(
        fmt::format("realizations ({} and {})", first.field.realizations, next.field.realizations));
  }
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

Comparison compared(const SceneField& scene, std::vector<Profile> profiles,
                    std::vector<ModelProfiles> models) {
  const double h = scene.facts.height;
  const int n = scene.field.realizations;
  const Scale scale =
      scene.scene == Scene::response ? scale_of_load(scene.facts.force, h, scene.facts.dim)
      : scene.scene == Scene::heap
          ? scale_of_heaps(h, scene.unit, scaled_alone(n))
          : Scale{h,     scene.unit, kNan,
                  "N/m", "origin",   fmt::format("h = {:.6g} m; realizations: {}", h, n)};
  return compare(std::move(profiles), std::move(models), scale, n);
}

void add_figures_of(const SceneField& scene, const Comparison& comparison, std::size_t main,
                    Summary& summary) {
  const double h = scene.facts.height;
  if (scene.scene == Scene::response) {
    summary["layer.depth"] = h;
    summary[scene.facts.dim == 3 ? "layer.F_over_h2" : "layer.F_over_h"] = scene.unit;
    add_comparison(summary, comparison, main);
    return;
  }
  for (const auto& [key, figure] : summary_figures(comparison, main)) {
    // The response.* keys speak of a load.
    if (!starts_with(key, "response.")) summary[key] = figure;
  }
  if (scene.scene == Scene::heap) {
    summary["pile.height"] = h;
    summary["heap.rho_g_h"] = scene.unit;
  } else {
    summary["layer.depth"] = h;
  }
}

Report page_of(const CompareRequest& request, const SceneField& scene, const Comparison& comparison,
               const Field& map, const std::vector<ModelMap>& models, const ReportRows& made) {
  const std::string title = "Comparison of " + request.file;
  if (scene.scene == Scene::response) {
    PointLoadReport page;
    page.title = title;
    page.comparison = comparison;
    page.map = map;
    page.models = models;
    page.made = made;
    return point_load_report(page);
  }
  PileReport page;
  page.title = title;
  page.subtitle = comparison.scale.note;
  page.comparison = comparison;
  page.map = map;
  page.averaged = scene.seen;
  page.made = made;
  return pile_report(page);
}

// Of the first `lines` sets those with few places again, through kDrawnPlaces: appended; their
// numbers.
std::vector<std::size_t> add_drawn_sets(std::size_t lines, std::vector<PointSet>& sets) {
  std::vector<std::size_t> out;
  for (std::size_t l = 0; l < lines; ++l) {
    if (sets[l].points.rows() >= kFewPlaces) continue;
    PointSet set = sets[l];
    set.points = drawn_places(set.points);
    sets.push_back(std::move(set));
    out.push_back(l);
  }
  return out;
}

void add_drawn_lines(const std::vector<FieldLine>& lines, const std::vector<std::size_t>& drawn,
                     std::size_t first, const std::vector<PointSet>& sets, const Evaluation& e,
                     ModelProfiles& out) {
  out.line_x.resize(lines.size());
  out.line.resize(lines.size());
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    const FieldLine& line = lines[drawn[k]];
    out.line_x[drawn[k]] = sets[first + k].points.col(0);
    out.line[drawn[k]] = line.sign * e.stresses[first + k].col(line.component);
  }
}

// Returns a line for each share that measured values carry, and adds the doubts to the verdict.
std::vector<std::string> carried_lines(const std::vector<SceneField>& scenes,
                                       Judgement& judgement) {
  std::vector<std::string> out;
  for (const SceneField& scene : scenes) {
    const auto share = carried_share(scene.field);
    if (!share) continue;
    out.push_back(share_text(*share));
    if (const std::string doubt = share_doubt(*share); !doubt.empty()) {
      judgement.doubts.push_back(as_sentence(doubt));
    }
  }
  return out;
}

}  // namespace

CompareOutcome compare_field(const CompareRequest& request) {
  const std::vector<ModelChoice> choices = parse_choices(request.models);
  std::optional<OutputFolder> results;
  if (!request.folder.empty()) {
    results.emplace(request.folder, "grainfield compare " + request.file);
    if (request.held.empty()) results->require_other_than({request.file});
  }
  std::vector<SceneField> scenes;
  std::vector<FieldLine> lines;
  Field map;
  std::set<std::string> kernels;
  std::vector<std::string> seen;
  for (const auto& name : chosen(request)) {
    const std::string where = request.file + ":" + name;
    SceneField scene = scene_field(field_in(request, name), name, request.lines, where);
    if (!scenes.empty()) require_same(scenes.front(), scene, request.file);
    for (auto& line : lines_of(scene, request.lines, where)) lines.push_back(std::move(line));
    if (scene.field.nx > 0 && scene.facts.dim == 2) map = scene.field;
    kernels.insert(scene.seen);
    seen.push_back(fmt::format("{}: {}", name, scene.seen));
    scenes.push_back(std::move(scene));
  }
  const SceneField& scene = scenes.front();
  const bool measured = scene.field.is_measured();
  CompareOutcome out;
  RunFacts facts = scene.facts;
  facts.depth = lines.front().profile.depth;
  std::vector<PointSet> sets;
  std::vector<Profile> profiles;
  std::size_t main = lines.size() - 1;
  const bool heap = scene.scene == Scene::heap;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const FieldLine& line = lines[l];
    Eigen::MatrixXd points = line.points;
    points.rightCols<1>().array() -= scene.apex;
    sets.push_back(
        {points, line.flat ? Smoothing::marginal : Smoothing::kernel, line.kernel.get(), heap});
    facts.depth = std::min(facts.depth, line.profile.depth);
    profiles.push_back(line.profile);
    profiles.back().measured = measured;
    if (line.flat) main = l;
  }
  const double spanned = heap && facts.height > 0 ? 1 + scene.apex / facts.height : 1;
  if (heap) facts.depth = facts.height += scene.apex;
  if (map.nx > 0) {
    Eigen::MatrixXd points = map.points;
    points.rightCols<1>().array() -= scene.apex;
    sets.push_back({points, Smoothing::none, nullptr, heap});
  }
  const std::size_t first_drawn = sets.size();
  const std::vector<std::size_t> drawn = add_drawn_sets(lines.size(), sets);

  Summary summary;
  std::vector<ModelProfiles> models;
  std::vector<ModelMap> model_maps;
  std::vector<std::string> names;
  for (const auto& choice : choices) names.push_back(choice.name);
  require_different(choices);
  const bool flanks_apart = takes_flanks_apart(names);
  for (const auto& choice : choices) {
    require_known(choice, facts, request.file);
    if (scene.scene != Scene::layer) {
      require_subject({choice}, heap ? Subject::heap : Subject::load, facts.dim, "model");
    }
    const Evaluation e = evaluate_model(choice, facts_for(choice, facts, flanks_apart), sets);
    ModelProfiles m{choice.label, model_label(choice), family_of(choice.name), {}};
    for (std::size_t l = 0; l < lines.size(); ++l) {
      m.values.emplace_back(lines[l].sign * e.stresses[l].col(lines[l].component));
    }
    add_drawn_lines(lines, drawn, first_drawn, sets, e, m);
    models.push_back(std::move(m));
    if (map.nx > 0) {
      model_maps.push_back({model_label(choice), e.stresses[first_drawn - 1].col(1)});
    }
    summary["model." + choice.label + ".name"] = choice.name;
    for (const auto& [key, figure] : over_grains_height(e.figures, spanned)) {
      summary["model." + choice.label + "." + key] = figure;
    }
  }
  Comparison comparison = compared(scene, std::move(profiles), std::move(models));
  if (scene.scene == Scene::response) comparison.judgement.noun = "layer";
  if (heap) comparison.judgement.noun = facts.dim == 3 ? "cone" : "pile";
  if (measured) out.carried = carried_lines(scenes, comparison.judgement);
  if (const auto note = dem::added_forces_note(scene.field.attributes); !note.empty()) {
    comparison.judgement.doubts.push_back(as_sentence(note));
  }
  if (kernels.size() > 1) {
    comparison.judgement.notes.push_back(
        fmt::format("Fields are seen through different kernels, models through each one's own: {}.",
                    fmt::join(seen, "; ")));
  }
  summary["version"] = version_and_commit();
  summary["ensemble.realizations"] = static_cast<std::int64_t>(scene.field.realizations);
  add_figures_of(scene, comparison, main, summary);
  add_judgement(summary, comparison.judgement);
  require_documented(summary);

  out.measured = measured;
  if (results) {
    const ReportRows made{{"fields", request.file},
                          {"seen through", fmt::format("{}", fmt::join(seen, "; "))},
                          {"version", version_and_commit()}};
    write_profiles(results->staging(), comparison);
    write_judgement(results->staging(), comparison.judgement);
    out.lacks = write_report(results->staging("report.html"),
                             page_of(request, scene, comparison, map, model_maps, made))
                    .complaint();
    write_summary(results->staging("summary.json"), summary);
    out.gone = told_of_gone(request.folder, results->publish());
  }
  out.comparison = std::move(comparison);
  out.summary = std::move(summary);
  return out;
}

}  // namespace grainfield::coupling
