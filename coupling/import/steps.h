// The tables of many files by their time steps, and which of the steps are taken.
#pragma once
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coupling/import/import.h"
#include "coupling/import/row_keys.h"

namespace grainfield::coupling {

/// The tables of one time step; of a format without steps all of them.
struct StepTables {
  std::vector<ForeignTable> grains, contacts, walls;
  const std::vector<ForeignTable>& of(TableKind kind) const;
};

class StepList {
 public:
  /// `kind`: as the columns tell it where the table does not.
  void add(ForeignTable&& table, TableKind kind);
  /// Changes tables that were added, before settle().
  void for_each(const std::function<void(ForeignTable&)>& change);
  /// Once all are there: numbers steps that have times only, drops numbers that tell nothing apart,
  /// and keeps of a step that a file has more than once the last (with a warning each), or all
  /// where they are pieces with rows of their own.
  void settle(bool by_time, const ReadKeys& read_keys);

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
  /// What was decided, likewise.
  std::vector<std::string> take_notes();

 private:
  struct Entry {
    ForeignTable table;
    TableKind kind = TableKind::grains;
  };
  /// Files that say the same of a step keep one list of names.
  void share_names(ForeignTable& table);
  void number_by_time();
  void drop_step_numbers();
  void drop_repeated(std::vector<ForeignTable>& tables, TableKind kind);
  void find_series();
  void find_parts(TableKind kind);
  using SeriesSteps = std::map<std::string, std::vector<long long>>;
  enum class Relation { none, parts, continued };
  Relation relation_of(const std::string& a, const std::string& b, const SeriesSteps& steps,
                       TableKind kind);
  const RowKeys& keys_of(const ForeignTable& table, TableKind kind);
  RowKeys keys_of_series(const std::string& series, long long step, TableKind kind);
  bool has_all_parts(const std::vector<ForeignTable>& tables, TableKind kind) const;
  bool is_whole(const StepTables& tables, bool without_contacts) const;
  std::vector<long long> whole_steps(bool without_contacts) const;

  std::deque<Entry> entries_;
  std::vector<std::shared_ptr<const std::vector<std::string>>> names_;
  std::map<long long, StepTables> steps_;
  std::vector<std::string> warnings_, notes_;
  ReadKeys read_keys_;
  std::map<std::string, RowKeys> keys_;  ///< that were read, by file and line
  /// Kinds of tables of contacts: by their columns.
  std::vector<const std::vector<std::string>*> contact_kinds_;
  std::map<std::string, std::string> series_;  ///< of each file
  /// The run that each series continues, by the name of one of them.
  std::map<TableKind, std::map<std::string, std::string>> run_of_;
  /// Runs that are parts of one table: a step has all of them or none.
  std::map<TableKind, std::vector<std::set<std::string>>> parts_;
  /// Tables of a series with the same columns in one step, at most.
  using Pieces = std::map<std::pair<std::string, const std::vector<std::string>*>, std::size_t>;
  Pieces pieces_of(const std::vector<ForeignTable>& tables) const;
  std::map<TableKind, Pieces> most_pieces_;
  bool stepped_ = false;
  std::string without_step_;  // the first file that tells none
  std::string broken_;        ///< the first table that is truncated
};

}  // namespace grainfield::coupling
