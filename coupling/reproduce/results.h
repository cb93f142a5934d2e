// Summaries of finished studies, by the name of their case.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coupling/output/tables.h"

namespace grainfield::coupling {

/// A measured number. `error`: standard error; nan with one realization.
struct Measured {
  double value = 0, error = 0;
};

class Results {
 public:
  /// Every *.json of the folder, named by its stem. Throws std::invalid_argument naming the folder
  /// or file.
  explicit Results(const std::string& folder);

  bool has(const std::string& name) const { return all_.count(name) > 0; }
  /// KEY with KEY.standard_error; nothing where the study was not run or has no such number.
  std::optional<Measured> number(const std::string& name, const std::string& key) const;
  /// A number without an error, or a text; nothing where there is none.
  std::optional<double> plain(const std::string& name, const std::string& key) const;
  std::optional<std::string> text(const std::string& name, const std::string& key) const;
  const std::map<std::string, Summary>& all() const { return all_; }
  /// Files beside CASE.json whose name begins with "CASE.": profiles and pictures; sorted.
  std::vector<std::string> beside(const std::string& name) const;

 private:
  std::map<std::string, Summary> all_;
  std::vector<std::string> others_;  // file names
};

}  // namespace grainfield::coupling
