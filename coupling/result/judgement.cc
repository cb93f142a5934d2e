#include "coupling/result/judgement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "coupling/judge/words.h"
#include "coupling/result/text_table.h"
#include "coupling/store/atomic_file.h"

namespace grainfield::coupling {
namespace {

nlohmann::json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::json json_of(const JudgedModel& m) {
  return {{"name", m.name},
          {"label", m.label},
          {"family", m.family.empty() ? m.name : m.family},
          {"free", m.free},
          {"description", m.description},
          {"misfit", number_or_null(m.misfit)},
          {"chance", number_or_null(m.chance)},
          {"relative_l2", number_or_null(m.rel_l2)},
          {"behind", number_or_null(m.behind)},
          {"behind_error", number_or_null(m.behind_error)},
          {"heights_behind", number_or_null(m.heights_behind)},
          {"heights_error", number_or_null(m.heights_error)},
          {"aic_behind", number_or_null(m.aic_behind)},
          {"distinguishable", m.distinguishable_text()},
          {"realizations_needed", number_or_null(m.power.realizations)},
          {"realizations_least", number_or_null(m.power.least)},
          {"realizations_most", number_or_null(m.power.most)},
          {"agrees", text_of(m.agrees())},
          {"supported", text_of(m.supported())}};
}

}  // namespace

std::string judgement_text(const Judgement& j) {
  std::string out = fmt::format("{}\n", fmt::join(headlines(j), "\n\n"));
  if (const std::string line = agreement_line(j); !line.empty()) out += "\n" + line + "\n";
  const JudgementTable table = table_of(j);
  if (!table.rows.empty()) {
    out += fmt::format("\n{}\n{}\n", markdown_table(table.header, table.rows), table.note);
  }
  for (const std::string& line : note_lines(j)) out += "\n" + line + "\n";
  if (!j.doubts.empty()) out += "\n";
  for (const std::string& line : j.doubts) out += "- " + line + "\n";
  return out;
}

std::string judgement_latex(const Judgement& j) {
  std::string out = escape_latex(fmt::format("{}\n", fmt::join(headlines(j), "\n\n")));
  if (const std::string line = agreement_line(j); !line.empty()) {
    out += fmt::format("\n{}\n", escape_latex(line));
  }
  const JudgementTable table = table_of(j);
  if (!table.rows.empty()) {
    out +=
        fmt::format("\n{}\n{}\n", latex_table(table.header, table.rows), escape_latex(table.note));
  }
  for (const std::string& line : note_lines(j)) out += fmt::format("\n{}\n", escape_latex(line));
  if (j.doubts.empty()) return out;
  out += "\n\\begin{itemize}\n";
  for (const std::string& line : j.doubts) out += "  \\item " + escape_latex(line) + "\n";
  return out + "\\end{itemize}\n";
}

std::string judgement_json(const Judgement& j) {
  nlohmann::json models = nlohmann::json::array();
  for (const JudgedModel& m : j.models) models.push_back(json_of(m));
  nlohmann::json widths = nlohmann::json::array();
  for (const AtWidth& at : j.widths) {
    widths.push_back({{"diameters", at.diameters},
                      {"best_model", at.best},
                      {"distinguishable", text_of(at.distinguishable)},
                      {"agrees", text_of(at.agrees)},
                      {"why", at.why}});
  }
  const nlohmann::json out = {
      {"headlines", headlines(j)},
      {"agreement", agreement_line(j)},
      {"best_model", j.best},
      {"distinguishable", text_of(j.distinguishable)},
      {"equations", j.equations},
      {"realizations", j.realizations},
      {"errors_from", j.errors_from == ErrorsFrom::realizations ? "realizations"
                      : j.errors_from == ErrorsFrom::data       ? "data"
                                                                : "nothing"},
      {"position",
       {{"from", j.position.from},
        {"to", j.position.to},
        {"value", number_or_null(j.position.value)},
        {"error", number_or_null(j.position.error)}}},
      {"rival", j.rival},
      {"models", models},
      {"kernel_widths", widths},
      {"notes", note_lines(j)},
      {"doubts", j.doubts}};
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

void add_judgement(Summary& summary, const Judgement& j) {
  summary["verdict.sentence"] = sentence(j);
  if (!j.best.empty()) summary["verdict.best_model"] = j.best;
  if (!j.doubts.empty()) summary["verdict.doubts"] = fmt::format("{}", fmt::join(j.doubts, " "));
  if (j.models.empty()) return;
  summary["verdict.distinguishable"] = std::string(text_of(j.distinguishable));
  summary["verdict.agrees"] = std::string(text_of(j.best_model().agrees()));
  if (!j.equations.empty()) summary["verdict.equations"] = j.equations;
  if (!std::isnan(j.position.value)) {
    summary["verdict.position"] = j.position.value;
    summary["verdict.position_error"] = j.position.error;
  }
  if (const JudgedModel* rival = j.find(j.rival); rival && j.distinguishable != Answer::unknown) {
    summary["verdict.realizations_needed"] = rival->power.realizations;
  }
}

void write_judgement(const std::string& folder, const Judgement& j) {
  if (headlines(j).empty()) return;
  const std::filesystem::path at(folder);
  write_text_file((at / "verdict.md").string(), judgement_text(j));
  write_text_file((at / "verdict.tex").string(), judgement_latex(j));
  write_text_file((at / "verdict.json").string(), judgement_json(j));
}

}  // namespace grainfield::coupling
