#include "coupling/import/steps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "coupling/import/step_names.h"

namespace grainfield::coupling {
namespace {

// Times of two files are one up to what was rounded in printing: of all digits; and of six, where
// the next step is farther off than some times that.
constexpr double kSameTime = 1e-9, kPrintedTime = 5e-6, kShareOfGap = 0.2;

// Briefly.
std::string list_of(const std::vector<long long>& all) {
  if (all.size() <= 8) return fmt::format("{}", fmt::join(all, ", "));
  return fmt::format("{}, {}, {}, ..., {} ({} steps)", all[0], all[1], all[2], all.back(),
                     all.size());
}

// None, or of an emptied box.
bool hold_no_row(const std::vector<ForeignTable>& tables) {
  return std::all_of(tables.begin(), tables.end(),
                     [](const ForeignTable& table) { return table.rows == 0; });
}

}  // namespace

void StepList::share_names(ForeignTable& table) {
  for (const auto& names : names_) {
    if (*names != *table.columns) continue;
    table.columns = names;
    return;
  }
  names_.push_back(table.columns);
}

void StepList::add(ForeignTable&& table, TableKind kind) {
  share_names(table);
  entries_.push_back({std::move(table), kind});
}

void StepList::for_each(const std::function<void(ForeignTable&)>& change) {
  for (Entry& entry : entries_) change(entry.table);
}

void StepList::number_by_time() {
  std::vector<double> times;
  for (const Entry& entry : entries_)
    if (entry.kind == TableKind::grains) times.push_back(entry.table.time.value_or(0));
  std::sort(times.begin(), times.end());
  const auto same = [](double a, double b) { return b - a <= kSameTime * std::abs(b); };
  times.erase(std::unique(times.begin(), times.end(), same), times.end());
  std::vector<double> others;  // of contacts without grains
  // Where the time is in `all`: the nearest, where the times between are farther apart.
  const auto place_in = [](const std::vector<double>& all, double time) {
    const auto above = std::lower_bound(all.begin(), all.end(), time);
    auto best = above;
    if (above == all.end() || (above != all.begin() && time - *(above - 1) < *above - time))
      best = above == all.begin() ? above : above - 1;
    if (best == all.end()) return all.end();
    double gap = std::numeric_limits<double>::infinity();
    if (best != all.begin()) gap = std::min(gap, *best - *(best - 1));
    if (best + 1 != all.end()) gap = std::min(gap, *(best + 1) - *best);
    const double off = std::abs(*best - time);
    const bool good = off <= kSameTime * std::abs(time) ||
                      (off <= kPrintedTime * std::abs(time) && off < kShareOfGap * gap);
    return good ? best : all.end();
  };
  for (const Entry& entry : entries_) {
    const double time = entry.table.time.value_or(0);
    if (place_in(times, time) == times.end()) others.push_back(time);
  }
  times.insert(times.end(), others.begin(), others.end());
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end(), same), times.end());
  for (Entry& entry : entries_)
    entry.table.step = place_in(times, entry.table.time.value_or(0)) - times.begin();
}

// Numbers at the ends of files' names: of one file for each kind they tell nothing.
void StepList::drop_step_numbers() {
  std::set<std::string> files[2];
  for (const Entry& entry : entries_) {
    if (entry.table.arrays == nullptr) return;
    files[entry.kind == TableKind::contacts ? 1 : 0].insert(entry.table.file);
  }
  if (files[0].size() > 1 || files[1].size() > 1) return;
  for (Entry& entry : entries_) entry.table.step.reset();
}

const RowKeys& StepList::keys_of(const ForeignTable& table, TableKind kind) {
  const auto [at, fresh] = keys_.try_emplace(
      fmt::format("{}:{}:{}", table.file, table.header_line, table.step.value_or(0)));
  if (fresh) at->second = read_keys_(table, kind);
  return at->second;
}

void StepList::drop_repeated(std::vector<ForeignTable>& tables, TableKind kind) {
  for (std::size_t k = 0; k < tables.size();) {
    bool pieces = false;
    const auto again = [&](const ForeignTable& other) {
      if (other.file != tables[k].file || *other.columns != *tables[k].columns ||
          other.header_line <= tables[k].header_line || !other.broken.empty() ||
          other.arrays != nullptr)
        return false;
      const bool apart = are_apart(keys_of(tables[k], kind), keys_of(other, kind));
      pieces = pieces || apart;
      return !apart;
    };
    const auto last = std::find_if(tables.rbegin(), tables.rend(), again);
    if (last == tables.rend()) {
      if (pieces)
        notes_.push_back(fmt::format(
            "{}: step {} is there more than once, each time with other {}: "
            "files that were joined; all of them count",
            tables[k].file, *tables[k].step, kind == TableKind::grains ? "grains" : "contacts"));
      ++k;
      continue;
    }
    warnings_.push_back(
        fmt::format("{}: step {} is there more than once (its columns at the lines {} and {}), as "
                    "where a run was "
                    "continued: the last one counts",
                    tables[k].file, *tables[k].step, tables[k].header_line, last->header_line));
    tables.erase(tables.begin() + static_cast<std::ptrdiff_t>(k));
  }
  keys_.clear();
}

void StepList::settle(bool by_time, const ReadKeys& read_keys) {
  read_keys_ = read_keys;
  if (by_time) number_by_time();
  drop_step_numbers();
  bool stepless = false, zero = false;  // besides tables of walls
  for (; !entries_.empty(); entries_.pop_front()) {
    Entry& entry = entries_.front();
    ForeignTable& table = entry.table;
    if (broken_.empty()) broken_ = table.broken;
    if (!table.broken.empty() && !table.step) {
      warnings_.push_back(table.broken + "; the steps before are read");
      continue;
    }
    stepped_ = stepped_ || table.step.has_value();
    if (!table.step && without_step_.empty()) without_step_ = table.file;
    if (entry.kind != TableKind::walls)
      (table.step ? zero : stepless) |= table.step.value_or(0) == 0;
    StepTables& tables = steps_[table.step.value_or(0)];
    const bool contacts = entry.kind == TableKind::contacts;
    if (contacts && std::find(contact_kinds_.begin(), contact_kinds_.end(), table.columns.get()) ==
                        contact_kinds_.end())
      contact_kinds_.push_back(table.columns.get());
    auto& list = contacts                         ? tables.contacts
                 : entry.kind == TableKind::walls ? tables.walls
                                                  : tables.grains;
    list.push_back(std::move(table));
  }
  // One file, of which nothing is whole:
  if (steps_.empty()) throw std::invalid_argument(broken_);
  if (!stepped_) return;
  if (stepless && zero && steps_.size() > 1) {
    std::vector<long long> all;
    for (const auto& [step, tables] : steps_) all.push_back(step);
    throw std::invalid_argument(fmt::format(
        "{}: tells no step, and there are the steps {}: of which is it? Give the tables "
        "of its state alone",
        without_step_, list_of(all)));
  }
  for (auto& [step, tables] : steps_) {
    drop_repeated(tables.grains, TableKind::grains);
    drop_repeated(tables.contacts, TableKind::contacts);
  }
  find_series();
  for (const TableKind kind : {TableKind::grains, TableKind::contacts}) find_parts(kind);
  keys_.clear();
}

const std::vector<ForeignTable>& StepTables::of(TableKind kind) const {
  return kind == TableKind::grains ? grains : kind == TableKind::walls ? walls : contacts;
}

void StepList::find_series() {
  std::map<std::string, std::set<long long>> steps;
  for (const auto& [step, tables] : steps_)
    for (const TableKind kind : {TableKind::grains, TableKind::contacts})
      for (const ForeignTable& table : tables.of(kind)) steps[table.file].insert(step);
  series_ = series_of_files(steps);
}

StepList::Pieces StepList::pieces_of(const std::vector<ForeignTable>& tables) const {
  Pieces out;
  for (const ForeignTable& table : tables) ++out[{series_.at(table.file), table.columns.get()}];
  return out;
}

RowKeys StepList::keys_of_series(const std::string& series, long long step, TableKind kind) {
  RowKeys out;
  for (const ForeignTable& table : steps_.at(step).of(kind)) {
    if (series_.at(table.file) != series) continue;
    const RowKeys& some = keys_of(table, kind);
    out.insert(out.end(), some.begin(), some.end());
  }
  std::sort(out.begin(), out.end());
  return out;
}

StepList::Relation StepList::relation_of(const std::string& a, const std::string& b,
                                         const SeriesSteps& steps, TableKind kind) {
  const std::vector<long long>&of_a = steps.at(a), &of_b = steps.at(b);
  std::vector<long long> both;
  std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                        std::back_inserter(both));
  for (const long long step : both) {
    const RowKeys one = keys_of_series(a, step, kind), other = keys_of_series(b, step, kind);
    if (one.empty() || other.empty()) continue;
    return are_apart(one, other) ? Relation::parts : Relation::continued;
  }
  return both.size() >= 2 && of_a.front() == of_b.front() ? Relation::parts : Relation::none;
}

// Series with common rows at a step are runs that continue each other, and go on as one. Those with
// rows of their own are parts of one table (a file for each processor or kind of pairs). Where no
// rows tell it, parts begin with one step and share more.
void StepList::find_parts(TableKind kind) {
  SeriesSteps steps;
  for (const auto& [step, tables] : steps_) {
    for (const ForeignTable& table : tables.of(kind)) {
      std::vector<long long>& own = steps[series_.at(table.file)];
      if (own.empty() || own.back() != step) own.push_back(step);
    }
    for (const auto& [table, count] : pieces_of(tables.of(kind))) {
      std::size_t& most = most_pieces_[kind][table];
      most = std::max(most, count);
    }
  }
  // Groups of series, and of two that are related the groups joined.
  using Groups = std::vector<std::set<std::string>>;
  const auto join = [](Groups& groups, const std::string& a, const std::string& b) {
    std::set<std::string> all{a, b};
    for (auto at = groups.begin(); at != groups.end();) {
      const bool with = at->contains(a) || at->contains(b);
      if (with) all.merge(*at);
      at = with ? groups.erase(at) : std::next(at);
    }
    groups.push_back(std::move(all));
  };
  Groups runs, parts;
  std::vector<std::pair<std::string, std::string>> apart;
  for (auto a = steps.begin(); a != steps.end(); ++a)
    for (auto b = std::next(a); b != steps.end(); ++b) {
      // What has the same steps lacks none of them.
      if (a->second == b->second) continue;
      const Relation relation = relation_of(a->first, b->first, steps, kind);
      if (relation == Relation::continued) join(runs, a->first, b->first);
      if (relation == Relation::parts) apart.emplace_back(a->first, b->first);
    }
  std::map<std::string, std::string>& run_of = run_of_[kind];
  std::map<std::string, std::set<long long>> of_run;
  for (const auto& [series, own] : steps) {
    run_of[series] = series;
    for (const auto& run : runs)
      if (run.contains(series)) run_of[series] = *run.begin();
    of_run[run_of[series]].insert(own.begin(), own.end());
  }
  for (const auto& [a, b] : apart)
    if (of_run[run_of[a]] != of_run[run_of[b]]) join(parts, run_of[a], run_of[b]);
  parts_[kind] = std::move(parts);
}

bool StepList::has_all_parts(const std::vector<ForeignTable>& tables, TableKind kind) const {
  if (series_.empty()) return true;
  for (const auto& [table, count] : pieces_of(tables))
    if (count < most_pieces_.at(kind).at(table)) return false;
  std::set<std::string> there;
  for (const ForeignTable& table : tables)
    there.insert(run_of_.at(kind).at(series_.at(table.file)));
  for (const std::set<std::string>& all : parts_.at(kind)) {
    const auto met = std::count_if(all.begin(), all.end(),
                                   [&](const std::string& one) { return there.contains(one); });
    if (met != 0 && met != static_cast<std::ptrdiff_t>(all.size())) return false;
  }
  return true;
}

bool StepList::is_whole(const StepTables& tables, bool without_contacts) const {
  const auto good = [](const ForeignTable& table) { return table.broken.empty(); };
  if (hold_no_row(tables.grains) ||
      !std::all_of(tables.grains.begin(), tables.grains.end(), good) ||
      !std::all_of(tables.contacts.begin(), tables.contacts.end(), good) ||
      !has_all_parts(tables.grains, TableKind::grains))
    return false;
  if (without_contacts && tables.contacts.empty()) return true;
  return !tables.contacts.empty() && has_all_parts(tables.contacts, TableKind::contacts) &&
         std::all_of(contact_kinds_.begin(), contact_kinds_.end(), [&](const auto* kind) {
           return std::any_of(
               tables.contacts.begin(), tables.contacts.end(),
               [&](const ForeignTable& table) { return table.columns.get() == kind; });
         });
}

std::vector<long long> StepList::whole_steps(bool without_contacts) const {
  std::vector<long long> out;
  for (const auto& [step, tables] : steps_)
    if (is_whole(tables, without_contacts)) out.push_back(step);
  return out;
}

std::vector<StepChoice> StepList::choose(const ImportOptions& options) {
  std::vector<StepChoice> out = options.steps;
  const std::vector<long long> whole = whole_steps(options.without_contacts);
  if (options.all_steps)
    for (const long long step : whole) out.push_back({step, ""});
  if (out.empty() && !whole.empty()) out.push_back({whole.back(), ""});
  // What it lacks is told by require_whole.
  if (out.empty()) out.push_back({steps_.rbegin()->first, ""});
  const bool by_default = options.steps.empty() && stepped_ && !whole.empty();
  if (by_default && whole.size() < steps_.size()) {
    std::vector<long long> without;
    for (const auto& [step, tables] : steps_)
      if (!std::binary_search(whole.begin(), whole.end(), step) &&
          (options.all_steps || step > whole.back()))
        without.push_back(step);
    if (!without.empty())
      warnings_.push_back(fmt::format(
          "{} of {} steps have not all of the tables and are left out: {}; those that have: {}",
          without.size(), steps_.size(), list_of(without), list_of(whole)));
    if (!without.empty() && !broken_.empty()) warnings_.push_back(broken_);
  }
  for (StepChoice& choice : out) {
    if (steps_.find(choice.step) == steps_.end()) {
      std::vector<long long> all;
      for (const auto& [step, tables] : steps_) all.push_back(step);
      throw std::invalid_argument(
          fmt::format("--step {}: no such time step; there are: {}", choice.step, list_of(all)));
    }
    if (choice.group.empty() && out.size() == 1) choice.group = options.group;
  }
  return out;
}

void StepList::require_whole(long long step, const ImportOptions& options) const {
  const StepTables& tables = steps_.at(step);
  if (is_whole(tables, options.without_contacts)) return;
  const std::vector<long long> whole = whole_steps(options.without_contacts);
  const std::string others =
      !stepped_ || whole.empty() ? "" : "; steps that have all tables: " + list_of(whole);
  for (const auto* list : {&tables.grains, &tables.contacts, &tables.walls})
    for (const ForeignTable& table : *list)
      if (!table.broken.empty()) throw std::invalid_argument(table.broken + others);
  const std::string which = stepped_ ? fmt::format(" of step {}", step) : "";
  const std::string files = fmt::format("{}", fmt::join(options.files, ", "));
  const auto steps_with = [&](bool grains) {
    std::vector<long long> out;
    for (const auto& [number, all] : steps_)
      if (!(grains ? all.grains : all.contacts).empty()) out.push_back(number);
    return out;
  };
  const std::string there =
      stepped_ && whole.empty()
          ? fmt::format("; grains are there of the steps {}, contacts of {}{}",
                        list_of(steps_with(true)), list_of(steps_with(false)),
                        without_step_.empty() ? ""
                                              : fmt::format("; {} tells no step and counts as "
                                                            "step 0: give the grains of its "
                                                            "state alone",
                                                            without_step_))
          : others;
  if (tables.grains.empty())
    throw std::invalid_argument(fmt::format("no table of grains{} in {}{}", which, files, there));
  if (hold_no_row(tables.grains))
    throw std::invalid_argument(
        fmt::format("{}: the tables of grains{} hold no row, expected one of each grain{}",
                    tables.grains.front().file, which, others));
  if (!has_all_parts(tables.grains, TableKind::grains))
    throw std::invalid_argument(
        fmt::format("not all tables of grains{} in {}{}", which, files, others));
  if (!tables.contacts.empty() && options.without_contacts) return;
  if (contact_kinds_.empty())
    throw std::invalid_argument(
        fmt::format("no table of contacts in {}: give its file, too (a table is one of contacts by "
                    "columns such "
                    "as i and j, id1 and id2); --without-contacts imports the grains alone",
                    files));
  if (!tables.contacts.empty()) {
    // Some tables of contacts are of other steps: what there is would pass for all.
    if (whole.empty()) return;
    throw std::invalid_argument(
        fmt::format("not all tables of contacts{} in {}{}", which, files, others));
  }
  throw std::invalid_argument(fmt::format("no table of contacts{} in {}{}", which, files, there));
}

std::vector<std::string> StepList::take_notes() { return std::exchange(notes_, {}); }
std::vector<std::string> StepList::take_warnings() { return std::exchange(warnings_, {}); }

}  // namespace grainfield::coupling
