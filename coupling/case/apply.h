// One assignment into a case, checked against the key's declaration.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "coupling/base/mistakes.h"
#include "coupling/case/case.h"
#include "coupling/case/document.h"
#include "coupling/case/keys.h"

namespace grainfield::coupling {

/// A case while it is read.
struct Draft {
  std::string file;  ///< for keys that nobody wrote
  Case value;
  std::map<std::string, Assignment> last;  ///< by key path: the assignment that holds
  /// [model.LABEL] tables: parameter (and "name") by label.
  std::map<std::string, std::map<std::string, Assignment>> models;
  std::size_t members = 1;  ///< of the sweep that this draft is one member of
};

/// Where a key was written; a key that was not is blamed on the file as a whole.
Assignment written(const Draft& draft, const std::string& path);

/// Throws std::invalid_argument "ORIGIN: KEY: ..." for an unknown key or section (with the nearest
/// name), a wrong type or a value out of range.
void apply(Draft& draft, const Assignment& assignment);

/// Adds the mistakes of single keys and of tables of models, of those that apply() took: without
/// meaning for the study, unknown models and parameters.
void check_keys(const Draft& draft, MistakeList& mistakes);

/// What fits no single key: sections of another study, model names and parameters, sweep values,
/// limits between keys, the stable time step. Fills Case::models.
void finish(Draft& draft);

/// Those of finish() that concern the lists of one section alone.
void check_section(const Draft& draft, const std::string& section);

/// Where compare.models of the case's study lives.
std::vector<std::string>& model_names(Case& value);

/// `ORIGIN: KEY: what` as std::invalid_argument.
[[noreturn]] void reject(const Assignment& assignment, const std::string& key,
                         const std::string& what);

}  // namespace grainfield::coupling
