#include "coupling/run/sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "coupling/judge/words.h"
#include "coupling/run/comparison_page.h"
#include "coupling/run/summary_keys.h"
#include "coupling/run/sweep_differences.h"
#include "coupling/store/atomic_file.h"

namespace grainfield::coupling {
namespace {

Table overview(const Case& value, const std::vector<SweepCase>& members,
               const std::vector<StudyResult>& results,
               const std::vector<OverviewColumn>& columns) {
  Table table;
  table.title = "Side by side";
  table.header = {value.sweep.key, "report"};
  for (const OverviewColumn& column : columns) table.header.push_back(column.heading);
  for (std::size_t m = 0; m < members.size(); ++m) {
    std::vector<std::string> row{value.sweep.values[m], members[m].suffix + "/report.html"};
    for (const OverviewColumn& column : columns) {
      row.push_back(shown_with_error(results[m].summary, column.key, column.error_key));
      if (row.back().empty()) row.back() = "-";
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table table_of(const std::vector<SweepDifference>& differences,
               const std::vector<std::string>& names) {
  Table table{"Differences",
              "",
              {"figure", "member", "against", "difference", "errors", "p", "p (Holm)"},
              {}};
  table.caption =
      "Member minus the first, with its standard error, and in units of it; two-sided p of Welch's "
      "t "
      "over realizations, then corrected for all rows (Holm): below 0.05 it is no accident.";
  for (const SweepDifference& d : differences) {
    table.rows.push_back({d.heading, names[d.member], names.front(),
                          fmt::format("{:+.4g} ± {:.2g}", d.difference, d.error),
                          fmt::format("{:+.1f}", d.difference / d.error),
                          fmt::format("{:.2g}", d.p_value), fmt::format("{:.2g}", d.p_holm)});
  }
  return table;
}

// Numbers of the table that could not be compared: " Not compared, without errors: peak (N/m)."
std::string left_out(const std::vector<OverviewColumn>& columns,
                     const std::vector<SweepDifference>& differences, const Summary& first) {
  std::vector<std::string> names;
  for (const OverviewColumn& column : columns) {
    const auto at = first.find(column.key);
    const bool is_number = at != first.end() && !std::holds_alternative<std::string>(at->second);
    const bool compared =
        std::any_of(differences.begin(), differences.end(),
                    [&](const SweepDifference& d) { return d.key == column.key; });
    if (is_number && !compared) names.push_back(column.heading);
  }
  return names.empty() ? ""
                       : fmt::format(" Not compared, without errors: {}.", fmt::join(names, ", "));
}

void add_differences(Summary& summary, const std::vector<SweepDifference>& differences,
                     const std::vector<SweepCase>& members) {
  for (const SweepDifference& d : differences) {
    const std::string end = d.key + "." + members[d.member].suffix;
    summary["sweep.difference." + end] = d.difference;
    summary["sweep.difference_error." + end] = d.error;
    summary["sweep.p_value." + end] = d.p_value;
    summary["sweep.p_holm." + end] = d.p_holm;
  }
}

// A variant's name as words.
std::string in_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

// "friction = 0.3", or the variant's name.
std::vector<std::string> names_of(const Case& value, std::size_t members) {
  std::vector<std::string> out;
  for (std::size_t m = 0; m < members; ++m) {
    out.push_back(value.sweep.key == "variant"
                      ? value.sweep.values[m]
                      : fmt::format("{} = {}", value.sweep.key, value.sweep.values[m]));
  }
  return out;
}

// Every member's own frames, grains beside models.
Picture side_by_side(const Case& value, const std::vector<StudyResult>& results) {
  std::vector<Frame> frames;
  for (std::size_t m = 0; m < results.size(); ++m) {
    for (Frame frame : results[m].sweep_frames) {
      if (value.sweep.key == "variant") {
        frame.title = in_words(value.sweep.values[m]) + ", " + frame.title;
      }
      frames.push_back(std::move(frame));
    }
  }
  Picture picture =
      curves("Grains beside the models", results.front().sweep_x, results.front().sweep_y, frames);
  picture.caption = "Points: the grains. Each member's own report says more.";
  return picture;
}

// Adds the nearest model of each member as a dashed line. Members often share one, such as the
// layer under several loads: it is drawn once, in the units of the first of them.
void add_nearest_models(const std::vector<StudyResult>& results,
                        const std::vector<std::string>& names, std::size_t profile, Frame& frame) {
  std::set<std::string> drawn;
  for (std::size_t m = 0; m < results.size(); ++m) {
    const Comparison& c = results[m].comparison;
    if (profile >= c.profiles.size()) continue;
    for (std::size_t k = 0; k < c.models.size(); ++k) {
      if (c.models[k].key != c.judgement.best || !drawn.insert(c.models[k].label).second) continue;
      const DrawnLine line = drawn_line(c, k, profile);
      Series series{fmt::format("{} ({})", legend_of(c.models[k]), names[m]),
                    line.x / c.scale.h,
                    line.y / c.scale.unit,
                    {},
                    false};
      series.colour = static_cast<int>(m);
      frame.series.push_back(std::move(series));
    }
  }
}

// Whether a member has units of its own: F/h of its load, rho g h of its pile.
bool has_scale(const Comparison& c) { return c.scale.h > 0 && c.scale.unit > 0; }

}  // namespace

Picture member_profiles(const Case& value, const std::vector<SweepCase>& members,
                        const std::vector<StudyResult>& results) {
  std::vector<Frame> frames;
  const std::vector<std::string> names = names_of(value, members.size());
  const Comparison& one = results.front().comparison;
  const bool scaled = std::all_of(results.begin(), results.end(),
                                  [](const StudyResult& r) { return has_scale(r.comparison); });
  for (std::size_t p = 0; p < one.profiles.size(); ++p) {
    Frame frame;
    frame.title = one.profiles[p].key == "base" ? "base" : one.profiles[p].name;
    for (std::size_t m = 0; m < members.size(); ++m) {
      const Comparison& c = results[m].comparison;
      if (p >= c.profiles.size()) continue;
      const Profile& own = c.profiles[p];
      const double length = scaled ? c.scale.h : 1, unit = scaled ? c.scale.unit : 1;
      frame.series.push_back({names[m], own.x / length, own.mean / unit, own.error / unit, m == 0});
    }
    if (scaled) add_nearest_models(results, names, p, frame);
    frames.push_back(std::move(frame));
  }
  const Profile& first = one.profiles.front();
  const char* const title =
      one.scale.x_from == "load" ? "Response of every member" : "Pressure of every member";
  const std::string normal = first.quantity == "-sigma_yy" ? "-σ_{yy}" : "-σ_{zz}";
  Picture picture =
      scaled ? curves(title, "x / h", fmt::format("{}  ({})", normal, one.scale.stress), frames)
             : curves(title, "x (m)", fmt::format("{}  ({})", normal, first.unit), frames);
  picture.caption = "Mean over realizations; the band is the first member's standard error.";
  if (scaled && !one.models.empty()) {
    picture.caption +=
        " A dashed line is the nearest model of the member in brackets; the members' "
        "own reports have the other models.";
  }
  return picture;
}

namespace {

// The member's curve of this title; without one an empty one, so that the next members keep their
// colours.
Series curve_of(const StudyResult& member, const std::string& title) {
  for (const MemberCurve& curve : member.member_curves) {
    if (curve.title == title) return curve.series;
  }
  return {};
}

std::vector<std::string> curve_titles(const std::vector<StudyResult>& results) {
  std::vector<std::string> out;
  for (const StudyResult& member : results) {
    for (const MemberCurve& curve : member.member_curves) {
      if (std::find(out.begin(), out.end(), curve.title) == out.end()) out.push_back(curve.title);
    }
  }
  return out;
}

// One frame per quantity, one curve per member.
Picture member_curves(const Case& value, const std::vector<SweepCase>& members,
                      const std::vector<StudyResult>& results) {
  std::vector<Frame> frames;
  const std::vector<std::string> names = names_of(value, members.size());
  for (const std::string& title : curve_titles(results)) {
    Frame frame{title, {}};
    for (std::size_t m = 0; m < members.size(); ++m) {
      Series series = curve_of(results[m], title);
      series.label = names[m];
      frame.series.push_back(std::move(series));
    }
    frames.push_back(std::move(frame));
  }
  Picture picture =
      curves("All members", results.front().member_curves.front().x_label, "", frames);
  picture.caption = "Means over realizations, with bands of one standard error.";
  return picture;
}

// None for members that have no profiles, only charts.
std::optional<Picture> beside_each_other(const Case& value, const std::vector<SweepCase>& members,
                                         const std::vector<StudyResult>& results) {
  const StudyResult& one = results.front();
  if (!one.member_curves.empty()) return member_curves(value, members, results);
  if (!one.sweep_frames.empty()) return side_by_side(value, results);
  if (one.comparison.profiles.empty()) return std::nullopt;
  return member_profiles(value, members, results);
}

}  // namespace

std::string write_sweep(const std::string& folder, const Case& value,
                        const std::vector<SweepCase>& members,
                        const std::vector<StudyResult>& results) {
  Summary all;
  add_identity(all, value);
  all["sweep.key"] = value.sweep.key;
  all["sweep.members"] = static_cast<std::int64_t>(members.size());
  Report report;
  report.title = title_of(value);
  report.subtitle = fmt::format("{} over {} values", value.sweep.key, members.size());
  const std::vector<std::string> names = names_of(value, members.size());
  std::vector<Summary> summaries;
  for (const StudyResult& result : results) summaries.push_back(result.summary);
  const std::vector<OverviewColumn> columns = overview_of(results);
  const auto differences = sweep_differences(columns, summaries);
  std::string sentence = differences_sentence(differences, names);
  if (!sentence.empty()) {
    sentence += left_out(columns, differences, summaries.front());
    add_differences(all, differences, members);
    all["sweep.sentence"] = sentence;
    report.sections.emplace_back(Text{"Between the members", sentence, true});
  }
  for (std::size_t m = 0; m < members.size(); ++m) {
    for (const auto& [key, figure] : results[m].summary) {
      all[key + "." + members[m].suffix] = figure;
    }
    report.sections.emplace_back(Text{names[m], coupling::sentence(results[m].comparison.judgement),
                                      m == 0 && sentence.empty()});
  }
  std::vector<std::vector<Chart>> charts;
  std::vector<std::string> legends;
  for (std::size_t m = 0; m < results.size(); ++m) {
    charts.push_back(results[m].sweep_charts);
    legends.push_back(value.sweep.key == "variant" ? in_words(names[m]) : names[m]);
  }
  for (Picture& picture : coupling::side_by_side(legends, charts)) {
    report.sections.emplace_back(std::move(picture));
  }
  if (auto picture = beside_each_other(value, members, results)) {
    report.sections.emplace_back(std::move(*picture));
  }
  const auto own = [&](auto part) {
    for (std::size_t m = 0; m < results.size(); ++m) {
      if (!(results[m].*part)) continue;
      for (Section& s : (results[m].*part)(value.sweep.values[m])) {
        report.sections.push_back(std::move(s));
      }
    }
  };
  own(&StudyResult::sweep_sections);
  report.sections.emplace_back(overview(value, members, results, columns));
  if (!differences.empty()) report.sections.emplace_back(table_of(differences, names));
  own(&StudyResult::sweep_tables);
  std::string lacks;
  if (value.output.report) lacks = write_report(folder + "/report.html", report).complaint();
  write_text_file(folder + "/case.toml", write_case(value));
  write_summary(folder + "/summary.json", all);
  return lacks;
}

}  // namespace grainfield::coupling
