#include "coupling/run/comparison_page.h"

#include <fmt/format.h>

#include <cmath>

#include "continuum/constants.h"
#include "coupling/judge/words.h"
#include "coupling/report/judgement.h"
#include "coupling/result/tables.h"

namespace grainfield::coupling {
namespace {

std::string shown(double value, int digits = 3) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "-";
}

}  // namespace

std::string legend_of(const ModelProfiles& model) {
  return model.label.starts_with(model.key + "=") ? model.key : model.label;
}

Frame profile_frame(const Comparison& c, std::size_t profile) {
  const Profile& p = c.profiles[profile];
  Frame out{p.name, {{c.label(), p.x / c.scale.h, p.mean / c.scale.unit, {}, true}}};
  if (p.error.size() > 0) out.series.front().error = p.error / c.scale.unit;
  for (std::size_t m = 0; m < c.models.size(); ++m) {
    const DrawnLine line = drawn_line(c, m, profile);
    out.series.push_back(
        {legend_of(c.models[m]), line.x / c.scale.h, line.y / c.scale.unit, {}, false});
  }
  return out;
}

std::vector<Frame> profile_frames(const Comparison& c) {
  std::vector<Frame> out;
  for (std::size_t k = 0; k < c.profiles.size(); ++k) out.push_back(profile_frame(c, k));
  return out;
}

Table distances_table(const Comparison& c, const std::string& unit, const std::string& at) {
  Table out{
      fmt::format("Distance of the models from the {}", c.subject()),
      fmt::format("Relative L2: root of the sum of squared differences over that of the {}{}. "
                  "Misfit and verdict are above.",
                  c.subject(), at == "r/h" ? ", points evenly spaced in the radius" : ""),
      {"model", "relative L2", fmt::format("largest difference ({})", unit), "at " + at, "in"},
      {}};
  for (const std::size_t m : ranked(c)) {
    const ModelComparison& r = c.results[m];
    const double place = r.overall.largest_at / c.scale.h;
    out.rows.push_back({r.label, fmt::format("{:.1f} %", 100 * r.overall.rel_l2),
                        shown(r.overall.largest / c.scale.unit),
                        shown(at == "r/h" ? std::fabs(place) : place, 2), r.overall.largest_in});
  }
  return out;
}

Table shapes_table(const Comparison& c, const std::string& unit, const std::string& at) {
  const bool radial = at == "r/h";
  Table out{
      "Shape of the profiles",
      fmt::format("{}Peak in {}, widths and places in h{}; standard errors of the {} by "
                  "leaving one realization out at a time.",
                  radial ? "By radius, drawn to both sides: one peak is a peak on the axis, "
                           "two are a ring. "
                         : "",
                  unit, radial ? "" : ", integral over x in F", c.subject()),
      {"profile", "of", "peak", "at " + at, "full width at half maximum", "rms width", "peaks"},
      {}};
  if (!radial) out.header.emplace_back("integral");
  const auto row = [&](const std::string& profile, const std::string& of, const ProfileShape& s,
                       const ProfileShape& error) {
    const double place = s.peak_at / c.scale.h;
    out.rows.push_back({profile, of, with_error(s.peak / c.scale.unit, error.peak / c.scale.unit),
                        shown(radial ? std::fabs(place) : place, 2),
                        with_error(s.fwhm / c.scale.h, error.fwhm / c.scale.h),
                        with_error(s.rms_width / c.scale.h, error.rms_width / c.scale.h),
                        fmt::format("{}", s.peaks)});
    if (!radial) {
      out.rows.back().push_back(
          with_error(s.integral / c.scale.load, error.integral / c.scale.load));
    }
  };
  const ProfileShape exact{kNan, kNan, kNan, kNan, 0, kNan};
  for (std::size_t k = 0; k < c.profiles.size(); ++k) {
    row(c.profiles[k].name, c.subject(), c.shapes[k], c.shape_errors[k]);
    for (const ModelComparison& r : c.results) row("", r.label, r.shapes[k], exact);
  }
  return out;
}

void write_profile_tables(const std::string& folder, Report& report, const Comparison& c) {
  if (c.models.empty()) return;
  Report tables{
      report.title, fmt::format("The {} and the models, place by place", c.subject()), {}};
  tables.sections.emplace_back(Text{"", profiles_note(c), false});
  for (Table& table : profile_tables(c)) tables.sections.emplace_back(std::move(table));
  write_report(folder + "/tables.html", tables);
  report.sections.emplace_back(Text{
      "Place by place",
      fmt::format("tables.html has the {} and the models at every place.", c.subject()), false});
  picture_first(report);
}

Eigen::VectorXd both_sides(const Eigen::VectorXd& by_radius) {
  return both_sides(Eigen::MatrixXd(by_radius));
}
Eigen::MatrixXd both_sides(const Eigen::MatrixXd& by_radius) {
  const Eigen::Index n = by_radius.rows();
  Eigen::MatrixXd out(2 * n - 1, by_radius.cols());
  out << by_radius.bottomRows(n - 1).colwise().reverse(), by_radius;
  return out;
}

}  // namespace grainfield::coupling
