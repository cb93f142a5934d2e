// Every key that summary.json may hold: those of all runs, of models and of each study;
// docs/summary-keys.md comes from it.
#pragma once
#include <string>
#include <vector>

#include "coupling/result/figure.h"
#include "coupling/result/tables.h"

namespace grainfield::coupling {

const std::vector<SummaryKey>& summary_keys();
/// The declaration of a key, or null. Errors and ranges over realizations (*.least, *.most,
/// *.standard_error) and differences in a sweep are declared where their figure is.
const SummaryKey* find_summary_key(const std::string& key);
/// Throws std::logic_error naming the first key that is not declared.
void require_documented(const Summary& summary);
std::string summary_keys_text();
std::string summary_keys_markdown();

}  // namespace grainfield::coupling
