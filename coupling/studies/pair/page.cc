#include "coupling/studies/pair/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainfield::coupling {
namespace {

constexpr Eigen::Index kDots = 160;  // at most, of a curve drawn with points, evenly chosen
constexpr int kSmooth = 181;         // points of a line that is known everywhere
constexpr double kNoWork = 1e-16;    // below it a loop's work is round-off
constexpr double kLogOfSpeeds = 10;  // a logarithmic axis for a wider range
constexpr const char* kClosed = "closed form";

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Series points_of(const std::string& label, const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  Series out{label, x, y, {}, true};
  out.points = true;
  return out;
}

// At most kDots of the rows, the first and the last among them.
Series thinned(const std::string& label, const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const Eigen::Index n = std::min(x.size(), kDots);
  if (n < 2) return points_of(label, x, y);
  std::vector<Eigen::Index> rows;
  for (Eigen::Index k = 0; k < n; ++k) rows.push_back(k * (x.size() - 1) / (n - 1));
  return points_of(label, x(rows), y(rows));
}

Series line_of(const std::string& label, const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  return {label, x, y, {}, false};
}

// The impacts of a list, sorted by it.
std::vector<PairImpact> sorted_impacts(const PairResults& results, bool by_speed) {
  std::vector<PairImpact> out;
  for (const PairImpact& i : results.impacts) {
    if (by_speed ? i.of_speeds : i.of_angles) out.push_back(i);
  }
  std::sort(out.begin(), out.end(), [&](const PairImpact& a, const PairImpact& b) {
    return by_speed ? a.speed < b.speed : a.angle < b.angle;
  });
  return out;
}

template <class Value>
Eigen::VectorXd each(const std::vector<PairImpact>& impacts, const Value& value) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(impacts.size()));
  for (std::size_t k = 0; k < impacts.size(); ++k) {
    out[static_cast<Eigen::Index>(k)] = value(impacts[k]);
  }
  return out;
}

struct Against {
  const char *title, *y_label;
  double PairImpact::*found;
  double PairClosedForm::*closed;
};

void add_speed_charts(const PairResults& results, std::vector<Chart>& out) {
  if (results.setup.speeds.empty() || results.impacts.empty()) return;
  const std::vector<PairImpact> rows = sorted_impacts(results, true);
  const Eigen::VectorXd speed = each(rows, [](const PairImpact& i) { return i.speed; });
  for (const Against& a :
       {Against{"Normal restitution against speed", "normal restitution",
                &PairImpact::restitution_normal, &PairClosedForm::restitution_normal},
        {"Duration against speed", "duration (s)", &PairImpact::duration,
         &PairClosedForm::duration},
        {"Largest force against speed", "largest normal force (N)", &PairImpact::max_force,
         &PairClosedForm::max_force},
        {"Largest depth against speed", "largest depth (m)", &PairImpact::max_depth,
         &PairClosedForm::max_depth}}) {
    Chart chart{a.title,   "speed (m/s)",
                a.y_label, "",
                {},        speed.maxCoeff() > kLogOfSpeeds * speed.minCoeff()};
    Frame frame;
    frame.series.push_back(
        points_of("impacts", speed, each(rows, [&](const auto& i) { return i.*a.found; })));
    const Eigen::VectorXd known = each(rows, [&](const auto& i) { return i.closed.*a.closed; });
    if (known.array().isFinite().any()) frame.series.push_back(line_of(kClosed, speed, known));
    chart.frames.push_back(std::move(frame));
    chart.caption = "Points: impacts; dashed: closed form, where there is one.";
    out.push_back(std::move(chart));
  }
}

void add_angle_chart(const PairResults& results, std::vector<Chart>& out) {
  if (results.setup.angles.empty() || results.impacts.empty()) return;
  std::vector<PairImpact> rows = sorted_impacts(results, false);
  std::erase_if(rows, [](const PairImpact& i) { return std::isnan(i.restitution_tangential); });
  if (rows.size() < 2) return;
  const Eigen::VectorXd angle = each(rows, [](const PairImpact& i) { return i.angle; });
  Chart chart{"Tangential restitution against angle",
              "angle of incidence (deg)",
              "tangential restitution",
              "",
              {},
              false};
  Frame frame;
  frame.series.push_back(points_of(
      "impacts", angle, each(rows, [](const auto& i) { return i.restitution_tangential; })));
  const Eigen::VectorXd fine =
      Eigen::VectorXd::LinSpaced(kSmooth, angle.minCoeff(), angle.maxCoeff());
  Eigen::VectorXd known(fine.size()), slip(angle.size());
  for (Eigen::Index k = 0; k < fine.size(); ++k) {
    known[k] = pair_closed_form(results.setup, rows.front().speed, fine[k]).restitution_tangential;
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double e = restitution_of_slip(results.setup, rows[k].restitution_normal, rows[k].angle);
    slip[static_cast<Eigen::Index>(k)] = e < 1 ? e : PairClosedForm::kNone;
  }
  if (known.array().isFinite().any()) {
    frame.series.push_back(line_of(kClosed, fine, known));
  } else if (slip.array().isFinite().any()) {
    frame.series.push_back(line_of("slip throughout", angle, slip));
  }
  chart.frames.push_back(std::move(frame));
  chart.caption =
      "Closed form, of linear springs without dashpots: slip throughout, or springs in step; "
      "elsewhere there is none. Slip "
      "throughout alone, with the normal restitution that was found, holds for every law at large "
      "angles.";
  out.push_back(std::move(chart));
}

void add_loop_chart(const PairResults& results, std::vector<Chart>& out) {
  if (results.loops.empty()) return;
  std::vector<double> work;
  for (const double share : results.loops.at("work_over_energy")) {
    work.push_back(std::log10(std::max(std::fabs(share), kNoWork)));
  }
  std::sort(work.begin(), work.end());
  const auto n = static_cast<Eigen::Index>(work.size());
  const Eigen::VectorXd part =
      Eigen::VectorXd::LinSpaced(n, 1, static_cast<double>(n)) / static_cast<double>(n);
  Chart chart{"Work of closed loops",
              "log_{10}(|work| / largest stored energy)",
              "share of the loops with at most this",
              "Every loop is one of a pair of its own. Left of -14 is round-off.",
              {},
              false};
  Frame frame;
  frame.series.push_back(thinned("loops", vector_of(work), part));
  chart.frames.push_back(std::move(frame));
  out.push_back(std::move(chart));
}

// Time, or where the path is passed without time the row.
std::pair<Eigen::VectorXd, std::string> clock_of(const PairResults& results) {
  const Eigen::VectorXd time = vector_of(results.profile.at("time"));
  if (time.maxCoeff() > 0) return {time, "time (s)"};
  return {Eigen::VectorXd::LinSpaced(time.size(), 0, 1), "share of the path"};
}

Chart force_depth(const PairResults& results) {
  const Eigen::VectorXd depth = vector_of(results.profile.at("depth")),
                        force = vector_of(results.profile.at("normal_force"));
  Chart chart{"Force against depth", "depth (m)", "normal force (N)", "", {}, false};
  Frame frame;
  Eigen::Index deepest = 0;
  const double most = depth.maxCoeff(&deepest);
  if (results.setup.kind == "collision") {
    frame.series.push_back(points_of("loading", depth.head(deepest + 1), force.head(deepest + 1)));
    const Eigen::Index rest = depth.size() - deepest;
    frame.series.push_back(line_of("unloading", depth.tail(rest), force.tail(rest)));
    const Eigen::VectorXd fine = Eigen::VectorXd::LinSpaced(kSmooth, 0, most);
    const Eigen::VectorXd known =
        fine.unaryExpr([&](double d) { return pair_elastic_force(results.setup, d); });
    if (known.array().isFinite().all()) {
      frame.series.push_back(line_of("elastic part, closed form", fine, known));
    }
  } else {
    frame.series.push_back(points_of("on the path", depth, force));
  }
  chart.frames.push_back(std::move(frame));
  return chart;
}

Chart force_time(const PairResults& results) {
  const auto [time, label] = clock_of(results);
  Chart chart{"Forces against time", label, "force (N)", "", {}, false};
  Frame frame;
  frame.series.push_back(points_of("normal", time, vector_of(results.profile.at("normal_force"))));
  frame.series.push_back(line_of("tangential, on the first body", time,
                                 vector_of(results.profile.at("tangential_force"))));
  chart.frames.push_back(std::move(frame));
  return chart;
}

Chart energies(const PairResults& results) {
  const auto [time, label] = clock_of(results);
  Chart chart{"Energies against time", label, "energy (J)", "", {}, false};
  const bool collision = results.setup.kind == "collision";
  Frame frame;
  const Eigen::VectorXd stored = vector_of(results.profile.at("stored")),
                        lost = vector_of(results.profile.at("dissipated"));
  if (collision) {
    frame.series.push_back(line_of("kinetic", time, vector_of(results.profile.at("kinetic"))));
  }
  frame.series.push_back(line_of("stored", time, stored));
  frame.series.push_back(
      line_of(collision ? "dissipated" : "work done and not stored", time, lost));
  chart.caption =
      collision ? "Dissipated is what is missing of the kinetic energy before the impact; of a law "
                  "whose force is not the gradient of the energy it states it holds the difference."
                : "Round a closed path the energy that is not stored is lost, or made.";
  chart.frames.push_back(std::move(frame));
  return chart;
}

Chart path_chart(const PairResults& results) {
  Chart chart{"The path", "x of the first body (m)", "y (m)", "", {}, false};
  Frame frame;
  frame.series.push_back(points_of("centroid of the first body", vector_of(results.profile.at("x")),
                                   vector_of(results.profile.at("y"))));
  chart.frames.push_back(std::move(frame));
  if (!results.loops.empty()) chart.caption = "Of the first pair.";
  return chart;
}

std::string text_of(double value) { return std::isnan(value) ? "-" : fmt::format("{:.4g}", value); }

}  // namespace

std::vector<Chart> pair_charts(const PairResults& results) {
  std::vector<Chart> out{force_depth(results), force_time(results), energies(results)};
  add_speed_charts(results, out);
  add_angle_chart(results, out);
  if (results.setup.kind == "path") out.push_back(path_chart(results));
  add_loop_chart(results, out);
  return out;
}

std::vector<Chart> pair_sweep_charts(const PairResults& results) {
  std::vector<Chart> out;
  add_speed_charts(results, out);
  add_angle_chart(results, out);
  add_loop_chart(results, out);
  if (!results.loops.empty()) return out;
  const Eigen::VectorXd depth = vector_of(results.profile.at("depth")),
                        force = vector_of(results.profile.at("normal_force"));
  Chart chart{"Force against depth",
              "depth / largest depth",
              "normal force / largest force",
              "Of each member over its own largest depth and force.",
              {},
              false};
  Frame frame;
  frame.series.push_back(thinned("", depth / std::max(depth.maxCoeff(), kNoWork),
                                 force / std::max(force.maxCoeff(), kNoWork)));
  chart.frames.push_back(std::move(frame));
  out.push_back(std::move(chart));
  return out;
}

Table pair_impact_table(const std::vector<PairImpact>& impacts) {
  Table out;
  out.title = "Impacts";
  out.header = {"speed (m/s)",      "angle (deg)", "e_n",
                "e_n, closed form", "e_t",         "e_t, closed form",
                "duration (s)",     "closed form", "largest depth (m)",
                "closed form",      "energy lost"};
  out.caption =
      "e_n, e_t: velocity at the contact after over before, with the sign turned, along and across "
      "the first normal. Energy lost: of the kinetic energy before.";
  if (impacts.size() < 2) return out;
  for (const PairImpact& i : impacts) {
    out.rows.push_back({text_of(i.speed), text_of(i.angle), text_of(i.restitution_normal),
                        text_of(i.closed.restitution_normal), text_of(i.restitution_tangential),
                        text_of(i.closed.restitution_tangential), text_of(i.duration),
                        text_of(i.closed.duration), text_of(i.max_depth),
                        text_of(i.closed.max_depth), text_of(i.energy_lost)});
  }
  return out;
}

std::string pair_subtitle(const dem::PairSetup& s) {
  const std::string bodies = s.partner == "wall" ? fmt::format("{} and wall", s.shape)
                                                 : fmt::format("two bodies of shape {}", s.shape);
  const std::string what = s.kind == "path" ? fmt::format("path {}", s.path)
                                            : fmt::format("collision at {:g} m/s", s.speed);
  return fmt::format("{}, law {}, {}", bodies, s.material.law, what);
}

}  // namespace grainfield::coupling
