// A judgement on a page.
#pragma once
#include "coupling/judge/judgement.h"
#include "coupling/report/report.h"

namespace grainfield::coupling {

/// Appends the headline, shown large, whether any model agrees, the table, and the doubts.
void add_verdict(Report& report, const Judgement& judgement);
/// The table of the models with what its columns mean, and the notes. Empty without models. `of`
/// stands before the title: "mono: ".
std::vector<Section> judgement_tables(const Judgement& judgement, const std::string& of = "");

/// Moves the first picture of curves behind the paragraphs that the report begins with, and returns
/// how many sections then lead it: what a reader sees first.
int picture_first(Report& report);

}  // namespace grainfield::coupling
