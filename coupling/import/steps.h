// The tables of many files by their time steps, and which of the steps are taken.
#pragma once
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coupling/import/import.h"

namespace grainfield::coupling {

/// The tables of one time step; of a format without steps all of them.
struct StepTables {
  std::vector<ForeignTable> grains, contacts, walls;
};

class StepList {
 public:
  /// `kind`: as the columns tell it where the table does not.
  void add(ForeignTable&& table, TableKind kind);
  /// Changes tables that were added, before settle().
  void for_each(const std::function<void(ForeignTable&)>& change);
  /// Once all are there: numbers steps that have times only, drops numbers that tell nothing apart,
  /// and keeps of a step that a file has more than once the last (with a warning each).
  void settle(bool by_time);

  /// Whether the files tell steps.
  bool stepped() const { return stepped_; }
  const StepTables& at(long long step) const { return steps_.at(step); }
  /// What options ask for, in the order of the steps. Without a choice the last step that has all
  /// kinds of tables; with all_steps all that have; the others are told as warnings. Throws
  /// std::invalid_argument where there is none, naming those that are.
  std::vector<StepChoice> choose(const ImportOptions& options);
  /// Throws std::invalid_argument saying what the step lacks, and which steps have it.
  void require_whole(long long step, const ImportOptions& options) const;

  /// What is doubtful, a sentence each; forgets them.
  std::vector<std::string> take_warnings();

 private:
  struct Entry {
    ForeignTable table;
    TableKind kind = TableKind::grains;
  };
  /// Files that say the same of a step keep one list of names.
  void share_names(ForeignTable& table);
  void number_by_time();
  void drop_step_numbers();
  void find_parts();
  void drop_repeated(std::vector<ForeignTable>& tables);
  bool is_whole(const StepTables& tables, bool without_contacts) const;
  std::vector<long long> whole_steps(bool without_contacts) const;

  std::deque<Entry> entries_;
  std::vector<std::shared_ptr<const std::vector<std::string>>> names_;
  std::map<long long, StepTables> steps_;
  std::vector<std::string> warnings_;
  /// Kinds of tables of contacts: by their columns.
  std::vector<const std::vector<std::string>*> contact_kinds_;
  std::vector<std::pair<std::string, std::string>> parts_;  ///< files that have all steps both
  bool stepped_ = false;
  std::string broken_;  ///< the first table that is truncated
};

}  // namespace grainfield::coupling
