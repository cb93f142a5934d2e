#include "coupling/run/sweep.h"

#include <fmt/format.h>

#include <cmath>

#include "coupling/output/atomic_file.h"
#include "coupling/run/summary_keys.h"

namespace grainfield::coupling {
namespace {

std::string number(const Summary& summary, const std::string& key) {
  const auto at = summary.find(key);
  if (at == summary.end()) return "-";
  if (const auto* value = std::get_if<double>(&at->second)) {
    return std::isnan(*value) ? "-" : fmt::format("{:.4g}", *value);
  }
  if (const auto* text = std::get_if<std::string>(&at->second)) return *text;
  return std::to_string(std::get<std::int64_t>(at->second));
}

Table overview(const Case& value, const std::vector<SweepCase>& members,
               const std::vector<StudyResult>& results) {
  Table table;
  table.title = "Side by side";
  table.caption = "The last profile's figures; each folder holds the member's own report.html.";
  table.header = {value.sweep.key, "folder",    "peaks",        "peak (N/m)",
                  "peak / (F/h)",  "width (m)", "integral / F", "best model"};
  for (std::size_t m = 0; m < members.size(); ++m) {
    const Summary& s = results[m].summary;
    table.rows.push_back({value.sweep.values[m], members[m].suffix, number(s, "response.peaks"),
                          number(s, "response.peak"), number(s, "response.peak_over_F_per_h"),
                          number(s, "response.width"), number(s, "response.total_over_load"),
                          number(s, "verdict.best_model")});
  }
  return table;
}

// One frame per profile, one curve per member. Members differ in depth by a little: the profiles
// are the same by number.
Picture profiles(const Case& value, const std::vector<SweepCase>& members,
                 const std::vector<StudyResult>& results) {
  std::vector<Frame> frames;
  const auto& first = results.front().comparison.profiles;
  for (std::size_t p = 0; p < first.size(); ++p) {
    Frame frame;
    frame.title = first[p].key == "base" ? "base" : first[p].name;
    for (std::size_t m = 0; m < members.size(); ++m) {
      const auto& own = results[m].comparison.profiles;
      if (p >= own.size()) continue;
      frame.series.push_back({fmt::format("{} = {}", value.sweep.key, value.sweep.values[m]),
                              own[p].x, own[p].mean, own[p].error, m == 0});
    }
    frames.push_back(std::move(frame));
  }
  Picture picture = curves("Response of every member", "x from the load (m)",
                           (first.front().quantity == "-sigma_yy" ? "-σ_{yy} (" : "-σ_{zz} (") +
                               first.front().unit + ")",
                           frames);
  picture.caption = "Mean over realizations.";
  return picture;
}

}  // namespace

void write_sweep(const std::string& folder, const Case& value,
                 const std::vector<SweepCase>& members, const std::vector<StudyResult>& results) {
  Summary all;
  add_identity(all, value);
  all["sweep.key"] = value.sweep.key;
  all["sweep.members"] = static_cast<std::int64_t>(members.size());
  Report report;
  report.title = value.title.empty() ? value.name : value.title;
  report.subtitle = fmt::format("{} over {} values", value.sweep.key, members.size());
  for (std::size_t m = 0; m < members.size(); ++m) {
    for (const auto& [key, figure] : results[m].summary) {
      all[key + "." + members[m].suffix] = figure;
    }
    report.sections.emplace_back(
        Text{fmt::format("{} = {}", value.sweep.key, value.sweep.values[m]),
             results[m].comparison.verdict.sentence, m == 0});
  }
  report.sections.emplace_back(profiles(value, members, results));
  report.sections.emplace_back(overview(value, members, results));
  if (value.output.report) write_report(folder + "/report.html", report);
  write_text_file(folder + "/case.toml", write_case(value));
  write_summary(folder + "/summary.json", all);
}

}  // namespace grainfield::coupling
