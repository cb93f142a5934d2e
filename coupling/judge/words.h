// A judgement in words: the same for terminal, report, Markdown, LaTeX, JSON and Python, which
// coupling/result/judgement.h and coupling/report/judgement.h write.
//
//   headline     what is supported or nearest, at most 25 words where names are short
//   agreement    whether any model agrees within the errors
//   table        the models, nearest first
//   notes        position between two families, equations, how many realizations more
//   doubts       a sentence each, with what to do
#pragma once
#include <string>
#include <vector>

#include "coupling/judge/judgement.h"
#include "coupling/statistics/value_text.h"

namespace grainfield::coupling {

/// A line for each finding of the study, then what is said of the models; empty: nothing was
/// judged.
std::vector<std::string> headlines(const Judgement& judgement);
/// "No model agrees within the errors: ..."; empty without models.
std::string agreement_line(const Judgement& judgement);
/// All of these in a row: summary.json's verdict.sentence.
std::string sentence(const Judgement& judgement);
/// Position, equations, power, other kernel widths and the judgement's own notes; may be empty.
std::vector<std::string> note_lines(const Judgement& judgement);

/// A warning as a doubt: with a capital letter, unless a key or a file begins it, and a full stop.
std::string as_sentence(std::string warning);

struct JudgementTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< nearest first
  std::vector<std::string> meanings;           ///< of the columns; empty: their name says it
  std::string note;                            ///< all meanings
};
/// Columns that hold nothing are left out. Empty without models.
JudgementTable table_of(const Judgement& judgement);
/// How many realizations would distinguish each model from the best.
JudgementTable power_table(const Judgement& judgement);

}  // namespace grainfield::coupling
