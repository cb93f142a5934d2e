#include "coupling/run/radial_page.h"

#include <fmt/format.h>

#include <cmath>

namespace grainfield::coupling {
namespace {

std::string shown_or_dash(double value, int digits = 3) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "-";
}

std::string with_spread(double value, double error) {
  return std::isfinite(error) ? shown_or_dash(value) + " ± " + shown_or_dash(error, 1)
                              : shown_or_dash(value);
}

// Profile k and the models there, lengths in h and stresses in the comparison's unit.
Frame radial_frame(const Comparison& c, std::size_t k) {
  const Profile& p = c.profiles[k];
  Frame out;
  out.title = p.name;
  Series grains;
  grains.label = c.label();
  grains.simulation = true;
  grains.x = p.x / c.depth;
  grains.y = p.mean / c.unit();
  if (p.error.size() > 0) grains.error = p.error / c.unit();
  out.series.push_back(std::move(grains));
  for (const ModelProfiles& m : c.models) {
    out.series.push_back({m.label, p.x / c.depth, m.values[k] / c.unit(), {}, false});
  }
  return out;
}

}  // namespace

Eigen::VectorXd both_sides(const Eigen::VectorXd& by_radius) {
  const Eigen::Index n = by_radius.size();
  Eigen::VectorXd out(2 * n - 1);
  out << by_radius.tail(n - 1).reverse(), by_radius;
  return out;
}
Eigen::MatrixXd both_sides(const Eigen::MatrixXd& by_radius) {
  const Eigen::Index n = by_radius.rows();
  Eigen::MatrixXd out(2 * n - 1, by_radius.cols());
  out << by_radius.bottomRows(n - 1).colwise().reverse(), by_radius;
  return out;
}

Picture radial_profiles(const std::string& title, const std::string& x_label,
                        const std::string& y_label, const Comparison& c) {
  std::vector<Frame> frames;
  for (std::size_t k = 0; k < c.profiles.size(); ++k) frames.push_back(radial_frame(c, k));
  return curves(title, x_label, y_label, frames);
}

void add_radial_tables(Report& report, const Comparison& c, const std::string& unit) {
  Table distances{
      fmt::format("Distance of the models from the {}", c.subject()),
      fmt::format("Relative L2: root of the sum of squared differences over that of the {}, "
                  "points evenly spaced in the radius. Misfit and verdict are above.",
                  c.subject()),
      {"model", "relative L2", fmt::format("largest difference ({})", unit), "at r/h", "in"},
      {}};
  for (const std::size_t m : ranked(c)) {
    const ModelComparison& r = c.results[m];
    distances.rows.push_back({r.label, fmt::format("{:.1f} %", 100 * r.overall.rel_l2),
                              shown_or_dash(r.overall.largest / c.unit()),
                              shown_or_dash(std::fabs(r.overall.largest_at) / c.depth, 2),
                              r.overall.largest_in});
  }
  report.sections.emplace_back(std::move(distances));
  Table shapes{
      "Shape of the profiles",
      fmt::format(
          "By radius, drawn to both sides: one peak is a peak on the axis, two are a ring. "
          "Peak in {}, widths in h; standard errors of the grains by leaving one realization "
          "out at a time.",
          unit),
      {"profile", "of", "peak", "at r/h", "full width at half maximum", "peaks"},
      {}};
  const auto row = [&](const std::string& profile, const std::string& of, const ProfileShape& s,
                       double peak_error, double width_error) {
    shapes.rows.push_back({profile, of, with_spread(s.peak / c.unit(), peak_error / c.unit()),
                           shown_or_dash(std::fabs(s.peak_at) / c.depth, 2),
                           with_spread(s.fwhm / c.depth, width_error / c.depth),
                           fmt::format("{}", s.peaks)});
  };
  for (std::size_t k = 0; k < c.profiles.size(); ++k) {
    row(c.profiles[k].name, c.subject(), c.shapes[k], c.shape_errors[k].peak,
        c.shape_errors[k].fwhm);
    for (const ModelComparison& r : c.results) {
      row("", r.label, r.shapes[k], std::nan(""), std::nan(""));
    }
  }
  report.sections.emplace_back(std::move(shapes));
}

}  // namespace grainfield::coupling
