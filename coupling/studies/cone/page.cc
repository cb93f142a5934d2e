#include "coupling/studies/cone/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/judge/words.h"
#include "coupling/report/judgement.h"
#include "coupling/run/comparison_page.h"

namespace grainfield::coupling {
namespace {

constexpr const char* kPressure = "-σ_{zz}  (ρgh)";

void add_cone_profiles(Report& report, const StudyResult& result, const ConePage& page) {
  const Comparison& c = result.comparison;
  Picture picture = curves("Vertical pressure by radius", "radius / h, to both sides", kPressure,
                           profile_frames(c));
  picture.caption = fmt::format(
      "Mean over the angle about the axis; on the base the forces on the floor, above it {}. "
      "ρgh = {:.4g} Pa, h = {:.4g} m. Models are smoothed alike; their cone has the flanks of the "
      "grains', its apex above theirs where that is round.",
      page.averaged, c.scale.unit, c.scale.h);
  report.sections.emplace_back(std::move(picture));

  const Column& shear = *page.rings.find("sigma_rz");
  Series series{"grains", page.rings.points.col(0), shear.value,
                shear.error.size() ? shear.error : Eigen::VectorXd(), true};
  Picture drawn = curves("Radial shear on the base", "radius / h", "σ_{rz}  (ρgh)",
                         {{"", {std::move(series)}}});
  drawn.caption = "Above 0 the grains push the floor outwards.";
  report.sections.emplace_back(std::move(drawn));
}

// Pressure and shear on the base at a tenth of the radii, each with both errors.
void add_cone_base(Report& report, const ConePage& page) {
  Table table;
  table.title = "The base by radius";
  table.caption =
      "In rho g h, with the standard error over the cones. Beside it what one cone can tell of its "
      "own mean: the spread of eight sectors over the root of eight, mean of the cones. No number "
      "where a sector is narrower than the averaging, or nothing lies.";
  table.header = {"radius / h", "pressure", "over sectors", "radial shear", "over sectors"};
  const auto of = [&](const char* name, Eigen::Index k, double sign) {
    const Column& column = *page.rings.find(name);
    return with_error(sign * column.value[k], column.error.size() ? column.error[k] : std::nan(""));
  };
  const auto error = [&](const char* name, Eigen::Index k) {
    const double value = page.rings.find(name)->value[k];
    return std::isfinite(value) ? fmt::format("± {:.3f}", value) : std::string("-");
  };
  const Eigen::Index step = std::max<Eigen::Index>(1, page.rings.points.rows() / 10);
  for (Eigen::Index k = 0; k < page.rings.points.rows(); k += step) {
    table.rows.push_back({fmt::format("{:.2f}", page.rings.points(k, 0)), of("sigma_zz", k, -1),
                          error("sigma_zz_sector_error", k), of("sigma_rz", k, 1),
                          error("sigma_rz_sector_error", k)});
  }
  report.sections.emplace_back(std::move(table));
}

// The difference of ring and disk with its two errors, and what they are of.
void add_cone_dip(Report& report, const StudyResult& result) {
  Table table;
  table.title = "Pressure under the apex and around it";
  table.caption =
      "From the forces on the floor themselves. The difference, ring less disk, has two errors. "
      "Over the cones: how the difference varies from one cone to the next, over the root of their "
      "number; the chance of a dip is from this one. Over the sectors: how it varies among eight "
      "sectors of one cone, over the root of eight, mean of the cones; it is what one cone alone "
      "can tell, and no error of the ensemble. Where it is about the error over the cones times "
      "the "
      "root of their number, cones differ no more than sectors of one.";
  table.header = {"", "rho g h"};
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!value.empty() && value != "-") table.rows.push_back({name, value});
  };
  add("disk under the apex, mean over the cones", shown_with_error(result.summary, "dip.centre"));
  add("ring around it, mean over the cones", shown_with_error(result.summary, "dip.shoulder"));
  add("ring less disk", shown_with_error(result.summary, "dip.difference"));
  add("its error over the cones", shown_with_error(result.summary, "dip.standard_error"));
  add("its error over the sectors of one cone",
      shown_with_error(result.summary, "dip.sector_error"));
  report.sections.emplace_back(std::move(table));
}

void add_cone_maps(Report& report, const Comparison& c, const ConePage& page) {
  const Eigen::VectorXd on_base = -page.base.find("sigma_zz")->value;
  Eigen::MatrixXd square(page.base.points.rows(), 2);
  square << page.base.points.leftCols(2);
  Picture base = maps("Pressure on the base", "x / h", "y / h", kPressure,
                      {{"grains", page.base.nx, page.base.ny, square, on_base}}, false);
  base.caption = "Mean over the realizations, axes of the packing.";
  report.sections.emplace_back(std::move(base));

  Eigen::MatrixXd half(page.inside.points.rows(), 2);
  half << page.inside.points.col(0), page.inside.points.col(2);
  const Eigen::VectorXd grains = -page.inside.find("sigma_zz")->value;
  std::vector<Map> all{{"grains", page.inside.nx, page.inside.nz, half, grains}};
  for (const ConePage::Model& m : page.models) {
    if (m.key != c.judgement.best) continue;
    all.push_back({m.label, page.inside.nx, page.inside.nz, half, -m.inside});
    all.push_back({"grains - " + m.label, page.inside.nx, page.inside.nz, half, grains + m.inside});
  }
  Picture inside = maps("Inside, by radius and height", "radius / h", "z / h", kPressure, all);
  inside.caption =
      "Mean over the angle and the realizations; apex at 0, floor at -1. One colour scale for all; "
      "it ends at the 99 % quantile. The grains are seen through the kernel of the averaging, the "
      "models as they are.";
  report.sections.emplace_back(std::move(inside));
}

}  // namespace

Report cone_page(const StudyResult& result, const Realization* first, const ConePage& page) {
  const Comparison& c = result.comparison;
  Report report;
  report.title = title_of(result.value);
  report.subtitle = fmt::format("{} cone{}, h = {:.4g} m", c.realizations,
                                c.realizations == 1 ? "" : "s", c.scale.h);
  add_verdict(report, c.judgement);
  add_cone_profiles(report, result, page);
  if (first != nullptr) {
    report.sections.emplace_back(slice("The cone, cut in the middle", (*first)["pile"]));
  }
  add_cone_maps(report, c, page);
  add_cone_dip(report, result);
  add_cone_base(report, page);
  if (!c.models.empty()) {
    report.sections.emplace_back(distances_table(c, "ρgh", "r/h"));
    report.sections.emplace_back(shapes_table(c, "ρgh", "r/h"));
  }
  add_rows(report, "Figures", figure_rows(result));
  add_rows(report, "How it was made", origin_rows(result));
  return report;
}

}  // namespace grainfield::coupling
