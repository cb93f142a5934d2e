// A study as the user describes it in a TOML file, with every default filled in.
#pragma once
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "coupling/case/setups.h"
#include "coupling/models/choice.h"

namespace grainfield::coupling {

struct EnsembleSetup {
  std::int64_t realizations = 4;
  std::int64_t seed = 1;
};

struct OutputSetup {
  bool snapshots = true;
  bool vtu = true;
  bool fields = true;
  bool report = true;
};

struct SweepSetup {
  std::string key;                  ///< empty: no sweep
  std::vector<std::string> values;  ///< as TOML text
};

/// A named set of keys that differ from the rest of the case: [variant.NAME.SECTION].
struct Variant {
  std::string name;
  std::vector<std::string> keys;  ///< "packing.kind=\"layered\"", as on the command line
};

/// How models = [...] and [model.LABEL] were written, before they are put together.
struct CompareSetup {
  std::vector<std::string> models = {"flamant", "layer", "fe_elastic_layer"};
  std::vector<std::string> optional;  ///< the same for studies that do without models
};

/// The study of a case that names none.
std::string default_study();

struct Case {
  std::string name;     ///< of the file, without folder and ".toml"
  std::string command;  ///< that asked for the run, for the record; may be empty
  std::string title;
  std::string study = default_study();
  EnsembleSetup ensemble;
  CompareSetup compare;
  OutputSetup output;
  SweepSetup sweep;
  std::vector<Variant> variants;    ///< members of a sweep whose key is "variant"
  std::vector<ModelChoice> models;  ///< in the order of compare.models
  std::set<std::string> given;      ///< paths of the keys that somebody wrote
  /// Warnings of keys that were written: those without effect with what the case chooses elsewhere,
  /// and values that are hardly meant (case/doubts.h), a line each: "FILE:LINE: KEY: ...".
  std::vector<std::string> without_effect;
  /// What studies and what they share hold: each part's own type, with its defaults.
  Setups setups;

  template <class T>
  T& get() {
    return setups.get<T>();
  }
  template <class T>
  const T& get() const {
    return setups.get<T>();
  }
};

/// One member of a sweep: the value as folder and key suffix ("friction_0.3") and its case.
struct SweepCase {
  std::string suffix;  ///< empty: the case has no sweep
  Case value;
};

/// An override from the command line: "key.path=value".
using Overrides = std::vector<std::string>;

/// Reads and validates a case file. With `quick`, the tables under [quick] override the rest.
/// Throws std::invalid_argument, one line "FILE:LINE: KEY: ..." (overrides: "--set: KEY: ...").
Case read_case(const std::string& file, bool quick, const Overrides& overrides);
/// The cases of its sweep in order, or the case itself.
std::vector<SweepCase> sweep_cases(const Case& value);
/// The whole case as TOML: every key of its study with unit and meaning as a comment. Reading it
/// back gives the same case.
std::string write_case(const Case& value);
/// Those keys, one a line, that the simulated grains depend on: a run that differs in others only
/// (averaging, models, outputs, the number of realizations) can use the same grains.
std::string grain_keys_text(const Case& value);
/// Whether the run fills this parameter of a model in where the user does not set it.
bool filled_by_run(const std::string& parameter, const std::string& study);
/// Only the title of a case file; throws as read_case when it is not TOML.
std::string case_title(const std::string& file);

}  // namespace grainfield::coupling
