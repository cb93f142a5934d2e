#include "coupling/studies/point_load/space_page.h"

#include <fmt/format.h>

#include "coupling/report/judgement.h"
#include "coupling/run/comparison_page.h"
#include "coupling/studies/point_load/page.h"
#include "coupling/studies/point_load/predicted.h"

namespace grainfield::coupling {
namespace {

constexpr const char* kStressLabel = "response of -σ_{zz}  (F/h²)";

void add_radial(Report& report, const Comparison& c) {
  Picture picture = curves("Response by radius, against the models", "radius / h, to both sides",
                           kStressLabel, profile_frames(c));
  picture.caption = fmt::format(
      "Vertical pressure added by the load, mean over the angle about it, in units of F/h² = "
      "{:.4g} "
      "Pa (F = {:.4g} N, h = {:.4g} m). The models are smoothed with the kernel of the averaging.",
      c.scale.unit, c.scale.load, c.scale.h);
  report.sections.emplace_back(std::move(picture));
}

// The nearest model by the verdict.
const SpaceLoadPage::Model& nearest_of(const SpaceLoadPage& page, const Comparison& c) {
  for (const auto& m : page.models) {
    if (m.key == c.judgement.best) return m;
  }
  return page.models.front();
}

// Grains, the nearest model and their difference on a grid of columns a and b of its points.
Picture side_views(const std::string& title, const Field& grains, const std::string& vertical,
                   int rows, int column, const std::string& label, const Eigen::VectorXd* model,
                   const Comparison& c, const std::string& seen) {
  Eigen::MatrixXd points(grains.points.rows(), 2);
  points << grains.points.col(0), grains.points.col(column);
  points /= c.scale.h;
  const Eigen::VectorXd simulation = -grains.find("sigma_zz")->value / c.scale.unit;
  std::vector<Map> all{{"grains", grains.nx, rows, points, simulation}};
  if (model != nullptr) {
    const Eigen::VectorXd there = -*model / c.scale.unit;
    all.push_back({label, grains.nx, rows, points, there});
    all.push_back({"grains - " + label, grains.nx, rows, points, simulation - there});
  }
  Picture picture = maps(title, "x / h", vertical, "-σ_{zz}  (F/h²)", all);
  picture.caption =
      "One colour scale for all; it ends at the 99 % quantile. Points without enough grains around "
      "them are left white. " +
      seen;
  return picture;
}

void add_maps(Report& report, const SpaceLoadPage& page, const Comparison& c) {
  const SpaceLoadPage::Model* model = page.models.empty() ? nullptr : &nearest_of(page, c);
  const std::string label = model ? model->label : "";
  report.sections.emplace_back(side_views("Pressure on the base", page.base, "y / h", page.base.ny,
                                          1, label, model ? &model->base : nullptr, c,
                                          model ? "The model is smoothed as the grains are." : ""));
  report.sections.emplace_back(side_views("Vertical cut through the load", page.cut, "z / h",
                                          page.cut.nz, 2, label, model ? &model->cut : nullptr, c,
                                          model
                                              ? "The grains are seen through the kernel of the "
                                                "averaging, the model as it is: within a kernel of "
                                                "the load it is steeper."
                                              : ""));
}

void add_before(Report& report, const SpaceLoadPage& page) {
  const Column* column = page.base_unloaded.find("sigma_zz");
  Series series{"grains before loading", page.base_unloaded.points.col(0), -column->value,
                column->error.size() ? column->error : Eigen::VectorXd(), true};
  report.sections.emplace_back(curves("Pressure on the base before loading", "radius (m)",
                                      "-σ_{zz}  (Pa)", {{"", {std::move(series)}}}));
}

}  // namespace

Report space_load_page(const StudyResult& result, const Realization* first,
                       const SpaceLoadPage& page) {
  const Comparison& c = result.comparison;
  Report report;
  report.title = title_of(result.value);
  report.subtitle =
      fmt::format("F = {:.4g} N on a layer {:.4g} m deep; {} realization{}", c.scale.load,
                  c.scale.h, c.realizations, c.realizations == 1 ? "" : "s");
  add_verdict(report, c.judgement);
  add_radial(report, c);
  add_maps(report, page, c);
  if (first != nullptr) {
    report.sections.emplace_back(
        slice("The loaded packing, cut in the middle", (*first)["loaded"]));
  }
  add_before(report, page);
  report.sections.emplace_back(distances_table(c, "F/h²", "r/h"));
  report.sections.emplace_back(shapes_table(c, "F/h²", "r/h"));
  for (Section& section : predicted_sections(result.summary)) {
    report.sections.push_back(std::move(section));
  }
  ReportRows figures = figure_rows(result);
  add_rows(report, "Figures", figures);
  add_rows(report, "How it was made", origin_rows(result));
  return report;
}

}  // namespace grainfield::coupling
