// Tables of grains, contacts and walls in foreign files: where they stand, and their columns under
// our names.
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "coupling/base/unit.h"
#include "coupling/import/lines.h"
#include "coupling/import/unit_system.h"
#include "dem/space/cell.h"

namespace grainfield::coupling {

/// Largest coefficient of friction that a file may tell: what stands for "never slides" in
/// practice.
inline constexpr double kMostFriction = 1e6;

enum class TableKind { unknown, grains, contacts, walls };

/// A column in memory: numbers (nan: not told), whole numbers, or words.
struct ArrayColumn {
  std::vector<double> numbers;
  std::vector<std::string> words;
  std::vector<std::int64_t> whole;
  bool single = false;  ///< numbers were of four bytes: whole ones from 2^24 on are rounded

  std::size_t rows() const { return std::max({numbers.size(), words.size(), whole.size()}); }
};

/// A table as a format's scan() finds it. Its rows are not read yet.
struct ForeignTable {
  std::string file;
  TableKind kind = TableKind::unknown;  ///< unknown: told from the columns
  std::optional<long long> step;        ///< time step of a dump
  std::optional<double> time;           ///< s, where the file says it
  /// All edges of a dump, and which axes are periodic. One for all steps where it is the
  /// same.
  std::shared_ptr<const dem::Cell<3>> box;
  std::shared_ptr<const std::vector<std::string>> columns;  ///< names in the file's order
  long long header_line = 0;                                ///< line that holds the names
  Lines::Place first;                                       ///< of the rows
  long long rows = -1;                                      ///< -1: up to the end of the file
  char separator = ' ';
  bool decimal_commas = false;  ///< numbers are written as 0,005
  char thousands = 0;           ///< sign between three digits and three, 50'000.0; 0: none
  bool prefixes = false;        ///< "c_", "f_", "v_", "i_", "d_" say what made a column (dumps)
  bool any_names = false;       ///< names that other programs have for our columns are taken, too
  std::string told_units;       ///< "FILE:LINE" where the file itself says what it is in
  UnitSystem units;             ///< of columns that tell none
  /// "FILE:2: found the units lj": what the file says it is in, where that is none of SI.
  std::string unknown_units;
  std::string broken;  ///< not empty: why the table cannot be read (truncated)
  /// "FILE:LINE: found "lengths in mm"": a unit in a line that is no row of units.
  std::string unit_remark;
  std::vector<std::string> doubts;  ///< what makes the reading of its numbers doubtful
  /// Not null: the table is in memory and `file` only names it. One for each of `columns`, all as
  /// long as `rows`.
  std::shared_ptr<const std::vector<ArrayColumn>> arrays;
};

/// Our column names and what they mean; the first list is of grains, then contacts, then walls.
struct OurColumn {
  std::string name, unit, meaning;
  std::string plane_unit = unit;  ///< in 2D
};
const std::vector<OurColumn>& our_columns(TableKind kind);

/// Their names for our columns. The choices of the user come before those of the format.
class ColumnNames {
 public:
  /// `format`: ours to theirs, any number for one of ours.
  explicit ColumnNames(std::vector<std::pair<std::string, std::string>> format);
  /// All --column: "ours=theirs", "ours=number", "ours=number unit", or lists "i,j=c_id[1..2]";
  /// names with commas in quotation marks. Throws std::invalid_argument: no "=", lists of different
  /// length, and all unknown names with their nearest.
  void choose(const std::vector<std::string>& texts);
  /// Throws std::invalid_argument naming all chosen names that were met in no table at all.
  void require_all_used() const;

  struct Candidate {
    std::string theirs;
    bool chosen = false;
  };
  std::vector<Candidate> candidates(const std::string& ours) const;
  /// Whether the user names a column for ours.
  bool chose(const std::string& ours) const;
  void mark_used(const std::string& ours, const std::string& theirs);
  /// Whether the user or the format names this column of theirs as one of ours.
  bool claims(const std::string& theirs) const;
  /// Whether a column of theirs stays away from `ours`: the user has chosen it for another column
  /// of a table of the same kind (--column y=z), or `of_format` the format names it so.
  bool is_taken_for_another(const std::string& ours, const std::string& theirs,
                            bool of_format) const;
  /// Remembers that a name of another program was taken: "FILE: i = end1".
  void mark_taken(const std::string& file, const std::string& ours, const std::string& theirs);
  /// Those remembered, a sentence per file, and forgets them.
  std::vector<std::string> take_taken();

 private:
  std::vector<std::pair<std::string, std::string>> chosen_, format_;
  std::set<std::string> used_;
  std::map<std::string, std::vector<std::string>> taken_;  // by file
};

/// A column's name with a unit in brackets behind it: "value (kPa)", "x [mm]", "r {um}". A whole
/// number in square brackets, "c_p[1]", is part of the name.
struct Heading {
  std::string name, unit;
  int index = -1;
};
Heading heading_of(const std::string& text, int index);

/// A column of a table, or a constant for every row, or nothing.
struct ForeignColumn {
  std::string name;  ///< ours
  int index = -1;
  std::optional<double> constant;  ///< SI
  std::optional<Unit> unit;        ///< of the numbers; none: SI
  explicit operator bool() const { return index >= 0 || constant.has_value(); }
};

/// The columns of one table under our names.
class TableColumns {
 public:
  TableColumns(const ForeignTable& table, ColumnNames& names);
  /// Empty when the table has no such column. Throws std::invalid_argument "FILE:LINE: ..." for one
  /// that is there twice, for a constant that is not finite, or without a unit where lengths are
  /// not in m, and for a unit that is unknown or of another kind than ours.
  ForeignColumn find(const std::string& ours) const;
  /// Whether the table has it; it does not count as taken by this.
  bool has(const std::string& ours) const;
  /// Throws std::invalid_argument "FILE:LINE: no column ...; found: ...; nearest ...".
  ForeignColumn need(const std::string& ours) const;
  /// Throws std::invalid_argument naming all that are missing where more than one is. Each: names
  /// of ours one of which is enough; the first is the one in the message.
  void require_all(const std::vector<std::vector<std::string>>& wanted) const;
  /// By the file's own name, with numbers such as our column `like` has; throws as need().
  ForeignColumn need_theirs(const std::string& theirs, const std::string& like = "") const;
  /// A column of the file by its name, as it is, with the unit behind it; it does not count as
  /// taken.
  ForeignColumn peek_theirs(const std::string& theirs) const;
  /// What else would do: as an option of the program; as an argument, for a table in memory.
  [[noreturn]] void missing(const std::string& what, const std::string& option = "",
                            const std::string& argument = "") const;
  /// Names of the table's columns, without units.
  std::vector<std::string> names() const;
  /// Throws std::invalid_argument where of the lengths (forces, velocities ...) that were found
  /// some have a unit other than the table's and others none. Returns a doubt where a table cannot
  /// give the units of its places (VTK); else "".
  std::string require_units() const;
  /// Names of the columns that nobody took, without units.
  std::vector<std::string> untaken() const;
  /// A line for each column that nobody took and whose name is nearly one of ours.
  std::vector<std::string> misspelled() const;
  /// Whether any column that was taken has a unit of its own.
  bool tells_units() const;
  /// Whether the user has chosen others of the vector "c_fc[1]" ... of a column.
  bool chose_of(const std::string& name) const;

 private:
  ForeignColumn look_up(const std::string& ours) const;
  bool is_row_number(const std::string& ours, const Heading& heading) const;
  void note_unit(const std::string& unit, const Heading& heading) const;
  /// What the user may have meant by one of ours, "" or "nearest: NAME": by another program's name,
  /// a slip of the pen, or the columns that are left.
  std::string suggestion(const std::string& ours) const;
  std::optional<Unit> unit_of(const std::string& ours, const Heading& heading) const;
  std::optional<double> constant_of(const std::string& ours, const std::string& text) const;
  /// The heading that plainly is ours, or the only one of another program's name for it; else end.
  std::vector<Heading>::const_iterator plainly(const std::string& ours) const;

  const ForeignTable& table_;
  ColumnNames& names_;
  std::vector<Heading> headings_;
  struct Told {
    std::vector<std::string> bare;  // found, without a unit
    std::string name, unit;         // the first with another than the table's
  };
  mutable std::map<std::string, Told> told_;  // by our unit
  mutable std::set<int> taken_;               // places of columns
};

/// An id as a file tells it.
struct ToldId {
  std::int64_t id = 0;
  /// 0: all digits are there. Otherwise it was printed with so many, as 1.23457e+06.
  int digits = 0;
};

/// A row of a table being read.
class ForeignRow {
 public:
  const std::string* file = nullptr;
  long long line = 0;
  const std::vector<std::string>* columns = nullptr;
  const std::vector<std::string_view>* fields = nullptr;  ///< of a file's row
  bool decimal_commas = false;                            ///< of a file's numbers
  char thousands = 0;                                     ///< likewise
  const std::vector<ArrayColumn>* arrays = nullptr;       ///< of a table in memory
  std::size_t place = 0;                                  ///< of the row in it

  /// "" for a constant. Valid until the next call or row.
  std::string_view text(const ForeignColumn& column) const;
  bool empty(const ForeignColumn& column) const;
  /// In SI. Throws std::invalid_argument naming file, line and column unless it is a finite number.
  double number(const ForeignColumn& column) const;
  /// The same for whole numbers ("7", "7.0", "7.000e+00"), to the last of 64 bits. Throws for what
  /// is written as a floating-point number and beyond 2^53, where such numbers leave some out.
  ToldId told_id(const ForeignColumn& column) const;
  /// Digits that a number has; 17 where it cannot be told.
  int digits(const ForeignColumn& column) const;
  /// The same for flags: 1 or 0; false where it is empty.
  bool flag(const ForeignColumn& column) const;
  /// The same for coefficients of friction, 0 to kMostFriction.
  double coefficient(const ForeignColumn& column) const;
  /// Throws std::invalid_argument "FILE:LINE: what".
  [[noreturn]] void refuse(const std::string& what) const;

 private:
  /// A number's text with a point and without signs of thousands; refuses those that do not fit.
  std::string plain_number(const ForeignColumn& column) const;
  std::string name_of(const ForeignColumn& column) const;
  const ArrayColumn* array_of(const ForeignColumn& column) const;

  mutable std::string shown_;  // a number in memory as text
};

/// Calls take(row) for every row; comments (#), blank lines and rows of empty values are passed
/// over. Throws std::invalid_argument for rows of another length than the header, but for empty
/// values at the end, and for what `take` throws.
class TableReader {
 public:
  void read(const ForeignTable& table, const std::function<void(const ForeignRow&)>& take);
  /// Why the end of the table that was read last may be cut off, a sentence; "": no doubt.
  const std::string& doubt_of_end() const { return doubt_of_end_; }

 private:
  /// Compares the last value of a file without a line end with the shortest before it.
  void check_end(const Lines& lines, std::string_view last, std::size_t shortest);
  void read_arrays(const ForeignTable& table, const std::function<void(const ForeignRow&)>& take);
  /// The file, opened or as it was left; of many files the last few stay open.
  Lines& lines_of(const std::string& file);

  std::list<Lines> files_;  // the one that was read last first
  std::string doubt_of_end_;
};

}  // namespace grainfield::coupling
