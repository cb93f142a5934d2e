#include "coupling/reproduce/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <cmath>
#include <vector>

#include "coupling/reproduce/dips.h"
#include "coupling/reproduce/figures.h"
#include "coupling/reproduce/misprints.h"

namespace grainfield::coupling {
namespace {

constexpr const char* kNotRun = "not run";
constexpr const char* kNoCommand = "run before commands were stored: see the case's page";

std::string with_error(const SourceFigure& figure, const Measured& m) {
  int digits = figure.unit == "deg" ? 1 : 3;
  const std::string unit = figure.unit.empty() ? "" : " " + figure.unit;
  if (std::isnan(m.error)) return fmt::format("{:.{}f}{}", m.value, digits, unit);
  // An error that is not 0 is not shown as 0.
  while (digits < 6 && m.error > 0 && m.error < 0.5 * std::pow(10, -digits)) ++digits;
  return fmt::format("{:.{}f} ± {:.{}f}{}", m.value, digits, m.error, digits, unit);
}

// Ours and the agreement.
std::pair<std::string, std::string> row_of(const SourceFigure& figure, const Results& results) {
  const bool was_run = results.has(figure.study);
  const std::string lacking = figure.missing.empty() || !was_run ? kNotRun : figure.missing;
  if (figure.number) {
    const auto ours = figure.number(results);
    if (!ours) return {lacking, ""};
    return {with_error(figure, *ours), agreement(figure, *ours)};
  }
  const auto ours = figure.word(results);
  if (!ours) return {lacking, ""};
  const std::string word = ours->substr(0, ours->find(':'));
  if (word == "undecided") return {*ours, "too few realizations to tell"};
  if (word == "between") return {*ours, kWideSpread};
  // What is not there beyond the spread says nothing of a dip, nor of none.
  if (word == "neither") return {*ours, "uninformative"};
  const bool same = std::find(figure.words.begin(), figure.words.end(), word) != figure.words.end();
  return {*ours, same ? "agrees" : "differs"};
}

// Of a run, or of all members of a sweep where they have the same.
std::optional<double> grains_of(const Results& r, const std::string& study) {
  if (const auto own = r.plain(study, "dem.grains")) return own;
  std::optional<double> out;
  const std::string begin = "dem.grains.least.";
  for (const auto& [key, value] : r.all().at(study)) {
    if (!key.starts_with(begin)) continue;
    const auto grains = r.plain(study, key);
    if (out && grains != out) return std::nullopt;
    out = grains;
  }
  return out;
}

// "`box-shear`", of a quick run "`box-shear` (quick, 200 grains)".
std::string study_cell(const Results& r, const std::string& study) {
  const auto command = r.text(study, "case.command");
  if (!command || command->find(" --quick") == std::string::npos) return "`" + study + "`";
  const auto grains = grains_of(r, study);
  return fmt::format("`{}` (quick{})", study,
                     grains ? fmt::format(", {:.0f} grains", *grains) : "");
}

std::string optional_number(const Results& r, const std::string& study, const std::string& key,
                            const char* format) {
  const auto value = r.plain(study, key);
  return value && !std::isnan(*value) ? fmt::format(fmt::runtime(format), *value) : "";
}

// What the grains took: CPU time where every start was counted.
std::string grain_seconds(const Results& r, const std::string& study) {
  if (const auto cpu = r.plain(study, "time.dem_cpu_s"); cpu && !std::isnan(*cpu)) {
    return fmt::format("{:.0f} CPU", *cpu);
  }
  if (r.plain(study, "time.dem_s").value_or(1) < 1) return "taken up again, not counted";
  const std::string wall = optional_number(r, study, "time.dem_s", "{:.0f}");
  return wall.empty() ? "" : wall + " wall";
}

// What the studies themselves conclude.
std::string verdicts(const Results& results, const std::vector<std::string>& studies) {
  std::string out;
  for (const std::string& study : studies) {
    const auto sentence = results.text(study, "verdict.sentence");
    const bool judged = study.starts_with("fit-") || results.text(study, "dip.verdict");
    if (sentence && judged) out += fmt::format("- `{}`: {}\n", study, *sentence);
  }
  if (out.empty()) return out;
  return "\n## Which theory the grains support\n\n"
         "As each study said when it was run, by itself and by the rules of its version. Where no "
         "model agrees, \"supported\" meant the nearest of those asked.\n\n" +
         out +
         "\nLayers under a point load: [verdict over all "
         "packings](cases/point-load-verdict.md); lattice piles: "
         "[Liffman](cases/liffman-lattice.md).\n";
}

// All ensembles' dips, also those that disagree.
std::string dips(const Results& results) {
  const std::vector<RecordedDip> all = recorded_dips(results);
  if (all.empty()) return "";
  std::string out = fmt::format(
      "\n## Dips and peaks of all pours\n\n"
      "Mean base pressure beside the apex minus that under it, over ρ g h of each pile; p: chance "
      "of "
      "so large a difference either way if there were none (Student's t over realizations), and "
      "the "
      "same corrected for all {} pours of this table (Holm). The last column counts. Ensembles of "
      "which only the states are kept are not in it ([which "
      "they are](reproduction/results/README.md)).\n\n"
      "| study | realizations | shoulder − centre (ρgh) | p | p (Holm) | at 5 % |\n"
      "|---|---|---|---|---|---|\n",
      all.size());
  for (const RecordedDip& dip : all) {
    out +=
        fmt::format("| `{}` | {} | {:.3f} ± {:.3f} | {:.2g} | {:.2g} | {} |\n", dip.study,
                    optional_number(results, dip.study, "ensemble.realizations", "{:g}"),
                    dip.difference.value, dip.difference.error, dip.p_value, dip.p_holm, dip.word);
  }
  return out;
}

// Links to the profiles and the pictures themselves, of the studies that have them.
std::string profiles_and_maps(const Results& results, const std::vector<std::string>& studies) {
  std::string out;
  for (const std::string& study : studies) {
    std::string links, pictures;
    for (const std::string& file : results.beside(study)) {
      const std::string path = "reproduction/results/" + file;
      if (file.ends_with(".md")) {
        links += fmt::format(" ([profiles as tables]({}))", path);
      } else if (file.ends_with(".svg") || file.ends_with(".png")) {
        const std::string what = file.substr(study.size() + 1);
        pictures += fmt::format("![{}]({})\n", what.substr(0, what.rfind('.')), path);
      }
    }
    if (!pictures.empty()) out += fmt::format("`{}`{}:\n\n{}\n", study, links, pictures);
  }
  if (out.empty()) return out;
  return "\n## Base pressure and volume fraction\n\n"
         "To be laid beside Roul 3.3 and 3.4: mean over the piles with standard errors, the "
         "pressure "
         "in units of each pile's own ρ g h.\n\n" +
         out;
}

}  // namespace

std::string reproduction_page(const Results& results) {
  std::string out = fmt::format(
      "# Figures of the sources beside ours\n\n"
      "Generated from the summaries in `docs/reproduction/results/` (`CASE.json` is the "
      "`summary.json` of `grainfield run cases/CASE.toml`) by\n\n"
      "    build/release/grainfield reproduce docs/reproduction/results -o docs/reproduction.md\n\n"
      "`--add DIR` takes the summary, the profiles and the pictures of a finished run in.\n\n"
      "Errors are standard errors over realizations. A number agrees when the source's value with "
      "its reading error (angles 1°, fractions 0.01, \"about\" 25 %) and ours ± 2 standard errors "
      "meet; the spread is too wide to tell when 2 standard errors exceed {:.0f} % of the value, "
      "or, for the ratios of volume fraction and coordination, of the effect that the source "
      "reports "
      "(0.09, 0.08, 0.04). The steeper flank is the one with the larger mean, whichever side it "
      "is: the study's page says which was meant. The error of a ratio of two ensembles is "
      "that of the one minus the source's ratio times the other. The error of a fitted "
      "constant is the larger of the fit's own and the bootstrap's over piles. The fit's "
      "own is the jackknife's, of fits recorded under older weights (point source, OSL, "
      "asymmetric) the covariance's. A fit is beyond the errors when its χ²/dof exceeds "
      "what a true model's does by chance: in 1 of 100, under the older weights in 1.35 of "
      "1000. A dip or peak is one at 5 % over [all pours "
      "together](#dips-and-peaks-of-all-pours); a peak meets \"no dip\" too; neither is "
      "uninformative: it agrees with a dip as with none. A stress ratio hardly changes where it "
      "does by less than a tenth also with 2 standard errors more, and changes where it does by "
      "more "
      "than a tenth also with 2 less; between, the spread is too wide to tell. Nothing was tuned "
      "to agree, but for "
      "the window of Liffman's H at 32.6°, of which its row tells; the value over the whole way "
      "to the bend is not among the stored results.\n\n"
      "| source | figure | theirs | ours | agreement | realizations | study |\n"
      "|---|---|---|---|---|---|---|\n",
      100 * kTooWide);
  std::vector<std::string> studies;
  for (const SourceFigure& figure : source_figures()) {
    const auto [ours, word] = row_of(figure, results);
    const std::string unit = figure.unit.empty() ? "" : " " + figure.unit;
    const std::string note = figure.note && ours != kNotRun ? figure.note(results) : "";
    out +=
        fmt::format("| {} | {} | {}{} | {} | {}{} | {} | {} |\n", figure.source, figure.what,
                    figure.theirs, unit, ours, word, note.empty() ? "" : "; " + note,
                    ours == kNotRun || ours == figure.missing
                        ? ""
                        : optional_number(results, figure.study, "ensemble.realizations", "{:g}"),
                    study_cell(results, figure.study));
    if (std::find(studies.begin(), studies.end(), figure.study) == studies.end()) {
      studies.push_back(figure.study);
    }
  }
  out += dips(results);
  out += verdicts(results, studies);
  out += profiles_and_maps(results, studies);
  out +=
      "\n## How they were run\n\n"
      "Grain-steps count every grain, asleep or not. Roul's interval was 0.1 s, his time "
      "step 2e-6 s. `pile-line-source` and `pile-asymmetric-line` were poured with today's "
      "default of sleeping: sleepers hide at most 1 % of their load. That [gains "
      "nothing](benchmarks.md) on piles of hundreds and 6 times on a heap of 6,500. "
      "`pile-point-source`, `pile-elliptic` and `pile-asymmetric-point` were poured with "
      "the earlier default, whose sleepers hid up to about 20 %; so were the piles that "
      "`pile-fields-line` took. The case `liffman-dropped` sets its own limit, 5 %. With "
      "the earlier default small piles came out denser than with all grains awake, by 0.3 % from "
      "a line source and by 1 % from a funnel at 0.1 s, and without a reach of waking "
      "denser still ([what sleeping changes](cases/pile-rest-detection.md)).\n\n"
      "| study | grains | realizations | interval (s) | reach of waking | time step (s) | steps | "
      "grain-steps | time of the grains (s) | base force / weight | version | command |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const std::string& study : studies) {
    if (!results.has(study)) {
      out += fmt::format("| `{}` | {} | | | | | | | | | | |\n", study, kNotRun);
      continue;
    }
    const auto value = [&](const char* key, const char* format) {
      return optional_number(results, study, key, format);
    };
    const auto command = results.text(study, "case.command");
    out += fmt::format(
        "| `{}` | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", study,
        value("dem.grains", "{:.0f}"), value("ensemble.realizations", "{:g}"),
        value("source.interval", "{:g}"), value("sleep.wake_reach", "{:g}"),
        value("dem.time_step", "{:.3g}"), value("dem.steps", "{:.4g}"),
        value("dem.grain_steps", "{:.3g}"), grain_seconds(results, study),
        value("base.weight_ratio", "{:.6f}"), results.text(study, "version").value_or(""),
        command ? fmt::format("`{}`", boost::replace_all_copy(*command, "|", "\\|")) : kNoCommand);
  }
  out +=
      "\n## Misprints and inconsistencies of the sources\n\n"
      "Re-derived from the field equations; the program uses what holds.\n\n"
      "| where | printed | holds |\n|---|---|---|\n";
  for (const Misprint& m : misprints()) {
    out += fmt::format("| {} | {} | {} |\n", m.where, m.printed, m.holds);
  }
  return out;
}

}  // namespace grainfield::coupling
