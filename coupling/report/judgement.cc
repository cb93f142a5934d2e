#include "coupling/report/judgement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <variant>

#include "coupling/judge/words.h"

namespace grainfield::coupling {

void add_verdict(Report& report, const Judgement& j) {
  const std::vector<std::string> first = headlines(j);
  if (first.empty()) return;
  report.sections.emplace_back(Text{"", fmt::format("{}", fmt::join(first, "\n\n")), true});
  if (const std::string second = agreement_line(j); !second.empty())
    report.sections.emplace_back(Text{"", second, false});
  for (Section& section : judgement_tables(j)) report.sections.push_back(std::move(section));
  if (!j.doubts.empty()) {
    report.sections.emplace_back(
        Text{"Doubts", fmt::format("{}", fmt::join(j.doubts, "\n\n")), false, true});
  }
}

int picture_first(Report& report) {
  std::vector<Section>& all = report.sections;
  const auto lead = std::find_if(all.begin(), all.end(), [](const Section& section) {
    const Text* text = std::get_if<Text>(&section);
    return text == nullptr || !text->title.empty();
  });
  const auto curve = std::find_if(lead, all.end(), [](const Section& section) {
    const Picture* picture = std::get_if<Picture>(&section);
    return picture != nullptr && picture->curves;
  });
  const int paragraphs = static_cast<int>(lead - all.begin());
  if (curve == all.end()) return paragraphs;
  std::rotate(lead, curve, curve + 1);
  return paragraphs + 1;
}

std::vector<Section> judgement_tables(const Judgement& j, const std::string& of) {
  JudgementTable table = table_of(j);
  if (table.rows.empty()) return {};
  std::string note = table.note;
  for (const std::string& line : note_lines(j)) note += " " + line;
  std::vector<Section> out;
  out.emplace_back(Table{of + (of.empty() ? "Models" : "models"), note, std::move(table.header),
                         std::move(table.rows), std::move(table.meanings)});
  return out;
}

}  // namespace grainfield::coupling
