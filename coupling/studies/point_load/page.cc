#include "coupling/studies/point_load/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/fit/fit_report.h"
#include "coupling/fit/fit_tables.h"
#include "coupling/report/judgement.h"
#include "coupling/run/comparison_page.h"

namespace grainfield::coupling {
namespace {

void add_profiles(Report& report, const Comparison& c) {
  std::vector<Frame> depths, base;
  for (std::size_t k = 0; k < c.profiles.size(); ++k)
    (c.profiles[k].key == "base" ? base : depths).push_back(profile_frame(c, k));
  const std::string caption = fmt::format(
      "Vertical pressure added by the load, in units of F/h = {:.4g} N/m (F = {:.4g} N, h = {:.4g} "
      "m). The models are smoothed with the kernel of the averaging.",
      c.scale.unit, c.scale.load, c.scale.h);
  const auto add = [&](const std::string& title, const std::vector<Frame>& frames) {
    if (frames.empty()) return;
    Picture picture = curves(title, "x / h", "response of -σ_{yy}  (F/h)", frames);
    picture.caption = caption;
    report.sections.emplace_back(std::move(picture));
  };
  add("Response at depth, against the models", depths);
  add("Response on the base", base);
}

// The map of the model that the verdict names; the first where it names none.
const ModelMap& nearest(const std::vector<ModelMap>& maps, const Comparison& c) {
  for (std::size_t m = 0; m < std::min(maps.size(), c.models.size()); ++m) {
    if (c.models[m].key == c.judgement.best) return maps[m];
  }
  return maps.front();
}

void add_maps(Report& report, const PointLoadReport& in) {
  const Column* column = in.map.find("sigma_yy");
  if (!column || in.map.nx < 2 || in.map.ny < 2) return;
  const double unit = in.comparison.scale.unit, h = in.comparison.scale.h;
  const Eigen::VectorXd simulation = -column->value / unit;
  const auto map = [&](const std::string& title, const Eigen::VectorXd& value) {
    return Map{title, in.map.nx, in.map.ny, in.map.points / h, value};
  };
  std::vector<Map> all{map("grains", simulation)};
  if (!in.models.empty()) {
    const ModelMap& best = nearest(in.models, in.comparison);
    const Eigen::VectorXd model = -best.sigma_yy / unit;
    all.push_back(map(best.label, model));
    all.push_back(map("grains - " + best.label, simulation - model));
  }
  Picture picture = maps("Maps of the response", "x / h", "y / h", "-σ_{yy}  (F/h)", all);
  picture.caption =
      "One colour scale for all; it ends at the 99 % quantile. Points without enough grains around "
      "them are left white.";
  report.sections.emplace_back(std::move(picture));
}

void add_base_before(Report& report, const PointLoadReport& in) {
  const Column* column = in.base_unloaded.find("sigma_yy");
  if (!column || column->value.size() < 3) return;
  Series series{"grains before loading", in.base_unloaded.points.col(0), -column->value,
                column->error.size() ? column->error : Eigen::VectorXd(), true};
  Picture picture = curves("Pressure on the base before loading", "x (m)", "-σ_{yy}  (N/m)",
                           {{"", {std::move(series)}}});
  report.sections.emplace_back(std::move(picture));
}

void add_tables(Report& report, const PointLoadReport& in) {
  const Comparison& c = in.comparison;
  if (in.fits != nullptr) {
    for (Section& table : fit_tables(*in.fits)) report.sections.push_back(std::move(table));
  } else {
    report.sections.emplace_back(distances_table(c, "F/h"));
  }
  report.sections.emplace_back(shapes_table(c, "F/h"));
  add_rows(report, "Figures", in.figures);
  add_rows(report, "How it was made", in.made);
}

}  // namespace

Report point_load_report(const PointLoadReport& in) {
  const Comparison& c = in.comparison;
  Report report;
  report.title = in.title;
  report.subtitle =
      fmt::format("F = {:.4g} N on a layer {:.4g} m deep; {} realization{}", c.scale.load,
                  c.scale.h, c.realizations, c.realizations == 1 ? "" : "s");
  add_verdict(report, c.judgement);
  if (in.fits != nullptr) {
    for (Section& picture : fit_pictures(*in.fits)) report.sections.push_back(std::move(picture));
  }
  if (in.loaded) report.sections.emplace_back(packing("The loaded packing", *in.loaded));
  if (in.loaded && in.unloaded)
    report.sections.emplace_back(packing("What the load changes", *in.loaded, in.unloaded));
  if (in.fits == nullptr) {
    add_profiles(report, c);
    add_maps(report, in);
  }
  add_base_before(report, in);
  if (in.loaded)
    report.sections.emplace_back(contact_angles("Directions of the contacts", *in.loaded));
  add_tables(report, in);
  return report;
}

namespace {

PointLoadReport report_of(const StudyResult& result, const Realization* first) {
  PointLoadReport page;
  page.title = title_of(result.value);
  if (first != nullptr) {
    page.unloaded = &(*first)["unloaded"];
    page.loaded = &(*first)["loaded"];
  }
  page.comparison = result.comparison;
  page.base_unloaded = result.base_unloaded;
  page.map = result.map;
  page.models = result.model_maps;
  page.figures = figure_rows(result);
  page.made = origin_rows(result);
  return page;
}

}  // namespace

Report layer_page(const StudyResult& result, const Realization* first) {
  return point_load_report(report_of(result, first));
}

Report fitted_layer_page(const StudyResult& result, const Realization* first,
                         const EnsembleFits& fits) {
  PointLoadReport page = report_of(result, first);
  page.fits = &fits;
  return point_load_report(page);
}

std::vector<OverviewColumn> layer_overview() {
  return {{"peaks", "response.peaks", ""},
          {"peak (N/m)", "response.peak", ""},
          {"peak / (F/h)", "response.peak_over_F_per_h", ""},
          {"width (m)", "response.width", ""},
          {"integral / F", "response.total_over_load", ""},
          {"best model", "verdict.best_model", ""}};
}

}  // namespace grainfield::coupling
