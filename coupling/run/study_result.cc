#include "coupling/run/study_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "coupling/base/version.h"
#include "coupling/case/study.h"
#include "coupling/export/forms.h"
#include "coupling/judge/words.h"
#include "coupling/report/judgement.h"
#include "coupling/result/judgement.h"
#include "coupling/run/comparison_page.h"
#include "coupling/run/realization_file.h"
#include "coupling/run/summary_keys.h"
#include "coupling/statistics/spread.h"
#include "coupling/store/atomic_file.h"
#include "coupling/store/vtu.h"
#include "coupling/structure/force_chains.h"

namespace grainfield::coupling {
namespace {

// Figures that other parts of a page show: its verdict and how it was made; and what is declared of
// other figures.
constexpr const char* kElsewhere[] = {
    "case.", "version", "warnings", "ensemble.", "verdict.",  "compare.",     "model.",
    "time.", "memory.", "sweep.",   "*.",        "dem.steps", "dem.time_step"};

std::string figure_text(const Summary& summary, const std::string& key) {
  const auto at = summary.find(key);
  if (at == summary.end()) return "";
  if (const auto* number = std::get_if<double>(&at->second)) {
    return std::isnan(*number) ? "-" : fmt::format("{:.5g}", *number);
  }
  if (const auto* integer = std::get_if<std::int64_t>(&at->second)) return std::to_string(*integer);
  return std::get<std::string>(at->second);
}

void write_grains(const std::string& folder, const StudyResult& result) {
  const OutputSetup& want = result.value.output;
  const std::string states = folder + "/states";
  if (want.vtu && !result.realizations.empty()) std::filesystem::create_directories(states);
  for (std::size_t r = 0; r < result.realizations.size(); ++r) {
    if (!want.snapshots && !(want.vtu && r == 0)) break;
    const Realization grains = read_realization(result.realizations[r]);
    for (const auto& [name, state] : grains.snapshots) {
      if (want.snapshots) {
        dem::write_snapshot(folder + "/snapshots.h5", fmt::format("/realization_{:03}/{}", r, name),
                            state);
      }
      if (!want.vtu || r > 0) continue;
      // Displacements are seen from the first state; a pile that still grows has other grains.
      const dem::Snapshot& first = grains.snapshots.front().second;
      const bool moved = &state != &first && state.grains.size() == first.grains.size();
      write_grains_vtu(fmt::format("{}/grains_{}.vtu", states, name), state,
                       moved ? &first : nullptr);
      write_contacts_vtu(fmt::format("{}/contacts_{}.vtu", states, name), state);
      write_chains_vtu(fmt::format("{}/chains_{}.vtu", states, name), state,
                       chain_of_contacts(force_chains(state), state.contacts.size()));
    }
  }
}

// The page of a study without one of its own: its sentence and its figures.
Report plain_page(const StudyResult& result, const Realization*) {
  Report out;
  out.title = title_of(result.value);
  add_verdict(out, result.comparison.judgement);
  add_rows(out, "Figures", figure_rows(result, true));
  add_rows(out, "How it was made", origin_rows(result));
  return out;
}

std::string write_page(const std::string& folder, const StudyResult& result) {
  Realization first;
  if (!result.realizations.empty()) first = read_realization(result.realizations.front());
  const auto page = result.page ? result.page : plain_page;
  Report report = page(result, result.realizations.empty() ? nullptr : &first);
  if (!first.snapshots.empty()) {
    const auto& [name, state] = first.snapshots.back();
    write_text_file(folder + "/packing.html",
                    packing_page(state, fmt::format("{}: {}", title_of(result.value), name)));
    report.sections.emplace_back(
        Text{"Grain by grain",
             fmt::format(
                 "packing.html shows the {} state of the first realization; it zooms, and tells a "
                 "grain's numbers under the pointer.",
                 name),
             false});
  }
  write_profile_tables(folder, report, result.comparison);
  const int lead = picture_first(report);
  if (!result.warnings.empty()) {
    report.sections.insert(
        report.sections.begin() + lead,
        Text{"To mind", fmt::format("{}", fmt::join(result.warnings, "\n\n")), false, true});
  }
  return write_report(folder + "/report.html", report).complaint();
}

}  // namespace

std::string title_of(const Case& value) { return value.title.empty() ? value.name : value.title; }

std::string shown_with_error(const Summary& summary, const std::string& key,
                             std::string error_key) {
  if (error_key.empty()) error_key = key + ".standard_error";
  const auto at = summary.find(key), error = summary.find(error_key);
  const auto* value = at == summary.end() ? nullptr : std::get_if<double>(&at->second);
  const auto* spread = error == summary.end() ? nullptr : std::get_if<double>(&error->second);
  if (value == nullptr || spread == nullptr || std::isnan(*spread))
    return figure_text(summary, key);
  return with_error(*value, *spread);
}

ReportRows figure_rows(const StudyResult& result, bool families) {
  ReportRows rows;
  for (const SummaryKey& declared : summary_keys()) {
    const std::string& pattern = declared.pattern;
    const bool family = pattern.find('*') != std::string::npos;
    const bool elsewhere = std::any_of(std::begin(kElsewhere), std::end(kElsewhere),
                                       [&](const char* part) { return pattern.starts_with(part); });
    if (elsewhere || (family && !families && !pattern.starts_with("average."))) continue;
    const bool bare = declared.unit == "-" || declared.unit == "text";
    for (const auto& [key, unused] : result.summary) {
      if (family ? find_summary_key(key) != &declared : key != pattern) continue;
      rows.emplace_back(fmt::format("{} ({})", declared.meaning, key),
                        shown_with_error(result.summary, key) + (bare ? "" : " " + declared.unit));
    }
  }
  return rows;
}

std::vector<OverviewColumn> overview_of(const std::vector<StudyResult>& members) {
  std::vector<OverviewColumn> out = members.front().overview;
  for (const SummaryKey& declared : summary_keys()) {
    const bool known = !declared.heading.empty() &&
                       std::any_of(members.begin(), members.end(), [&](const StudyResult& member) {
                         return member.summary.count(declared.pattern) != 0;
                       });
    if (known) out.push_back({declared.heading, declared.pattern, declared.error_key});
  }
  return out;
}

ReportRows origin_rows(const StudyResult& result) {
  ReportRows rows;
  for (const char* key : {"case.command", "case.hash", "version", "ensemble.realizations",
                          "ensemble.seed", "dem.steps", "dem.time_step"}) {
    const std::string value = figure_text(result.summary, key);
    if (!value.empty()) rows.emplace_back(key, value);
  }
  for (const auto& model : result.value.models) {
    rows.emplace_back("model " + model.label,
                      figure_text(result.summary, "model." + model.label + ".name"));
  }
  return rows;
}

std::string hash_text(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char ch : text) {
    hash ^= static_cast<unsigned char>(ch);
    hash *= 0x100000001b3ULL;
  }
  return fmt::format("{:016x}", hash);
}

StudyResult begin_result(const Case& value, const std::vector<std::string>& realizations) {
  StudyResult out;
  out.value = value;
  out.realizations = realizations;
  add_identity(out.summary, value);
  return out;
}

void add_identity(Summary& summary, const Case& value) {
  summary["case.name"] = value.name;
  summary["case.study"] = value.study;
  if (!value.command.empty()) summary["case.command"] = value.command;
  summary["case.hash"] = hash_text(write_case(value));
  summary["version"] = version_and_commit();
  if (study_of(value).has_grains()) {
    summary["ensemble.realizations"] = value.ensemble.realizations;
    summary["ensemble.seed"] = value.ensemble.seed;
  }
}

void add_comparison(Summary& summary, const Comparison& comparison, std::size_t main) {
  for (const auto& [key, number] : summary_figures(comparison, main)) summary[key] = number;
  const double unit = comparison.scale.unit;
  summary["response.peak_over_F_per_h"] = comparison.shapes[main].peak / unit;
  if (const double error = comparison.shape_errors[main].peak; std::isfinite(error)) {
    summary["response.peak_over_F_per_h.standard_error"] = error / unit;
  }
  for (std::size_t p = 0; p < comparison.profiles.size(); ++p) {
    if (p == main) continue;
    const std::string prefix = "response." + comparison.profiles[p].key;
    summary[prefix + ".peaks"] = static_cast<double>(comparison.shapes[p].peaks);
    summary[prefix + ".peak"] = comparison.shapes[p].peak;
  }
  for (const auto& model : comparison.results) {
    summary["compare." + model.key + ".peak"] = model.shapes[main].peak;
    summary["compare." + model.key + ".peak_over_F_per_h"] = model.shapes[main].peak / unit;
  }
}

void add_figures(Summary& summary, const std::map<std::string, std::vector<double>>& figures) {
  for (const auto& [key, values] : figures) {
    const Spread spread = spread_of(values);
    summary[key] = spread.mean;
    if (values.size() < 2) continue;
    summary[key + ".least"] = *std::min_element(values.begin(), values.end());
    summary[key + ".most"] = *std::max_element(values.begin(), values.end());
    summary[key + ".standard_error"] = spread.standard_error;
  }
}

void add_warnings(StudyResult& result) {
  if (result.warnings.empty()) return;
  result.summary["warnings"] = fmt::format("{}", fmt::join(result.warnings, " "));
}

std::string write_study(const std::string& folder, const StudyResult& result) {
  require_documented(result.summary);
  if (!result.comparison.profiles.empty()) write_profiles(folder, result.comparison);
  write_judgement(folder, result.comparison.judgement);
  if (result.value.output.fields && !result.fields.empty()) {
    write_fields(folder + "/fields.h5", result.fields);
  }
  for (const auto& [name, text] : result.texts) write_text_file(folder + "/" + name, text);
  write_grains(folder, result);
  std::string lacks;
  if (result.value.output.report) lacks = write_page(folder, result);
  write_text_file(folder + "/case.toml", write_case(result.value));
  write_summary(folder + "/summary.json", result.summary);
  return lacks;
}

}  // namespace grainfield::coupling
