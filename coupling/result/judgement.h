// A judgement as files and summary keys.
#pragma once
#include <string>

#include "coupling/judge/judgement.h"
#include "coupling/result/tables.h"

namespace grainfield::coupling {

/// Headline, agreement, table, its legend, notes and doubts, one paragraph each, as Markdown whose
/// table is aligned: the terminal's text and verdict.md.
std::string judgement_text(const Judgement& judgement);
/// The same for LaTeX: verdict.tex.
std::string judgement_latex(const Judgement& judgement);
/// The same as JSON, one object: verdict.json, and what Python shows. Not-a-number is null.
std::string judgement_json(const Judgement& judgement);

/// The keys
/// verdict.{sentence,doubts,best_model,distinguishable,agrees,position,position_error,equations,
/// realizations_needed}, as far as they are known.
void add_judgement(Summary& summary, const Judgement& judgement);
/// Writes folder/verdict.md, .tex and .json, each complete or not at all.
void write_judgement(const std::string& folder, const Judgement& judgement);

}  // namespace grainfield::coupling
