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

void StepList::drop_repeated(std::vector<ForeignTable>& tables) {
  for (std::size_t k = 0; k < tables.size();) {
    const auto again = [&](const ForeignTable& other) {
      return other.file == tables[k].file && *other.columns == *tables[k].columns &&
             other.header_line > tables[k].header_line && other.broken.empty() &&
             other.arrays == nullptr;
    };
    const auto last = std::find_if(tables.rbegin(), tables.rend(), again);
    if (last == tables.rend()) {
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
}

void StepList::settle(bool by_time) {
  if (by_time) number_by_time();
  drop_step_numbers();
  for (; !entries_.empty(); entries_.pop_front()) {
    Entry& entry = entries_.front();
    ForeignTable& table = entry.table;
    if (broken_.empty()) broken_ = table.broken;
    if (!table.broken.empty() && !table.step) {
      warnings_.push_back(table.broken + "; the steps before are read");
      continue;
    }
    stepped_ = stepped_ || table.step.has_value();
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
  // Of one file, of which nothing is whole.
  if (steps_.empty()) throw std::invalid_argument(broken_);
  if (!stepped_) return;
  for (auto& [step, tables] : steps_) {
    drop_repeated(tables.grains);
    drop_repeated(tables.contacts);
  }
  find_parts();
}

// Files of contacts that begin with one step and share more are parts of one table (a file for each
// processor or kind of pairs). A continued run's begin later.
void StepList::find_parts() {
  std::map<std::string, std::vector<long long>> steps;
  for (const auto& [step, tables] : steps_)
    for (const ForeignTable& table : tables.contacts)
      if (steps[table.file].empty() || steps[table.file].back() != step)
        steps[table.file].push_back(step);
  std::erase_if(steps, [](const auto& file) { return file.second.size() < 2; });
  for (auto a = steps.begin(); a != steps.end(); ++a)
    for (auto b = std::next(a); b != steps.end(); ++b) {
      if (a->second.front() != b->second.front()) continue;
      std::vector<long long> both;
      std::set_intersection(a->second.begin(), a->second.end(), b->second.begin(), b->second.end(),
                            std::back_inserter(both));
      if (both.size() >= 2) parts_.emplace_back(a->first, b->first);
    }
}

bool StepList::is_whole(const StepTables& tables, bool without_contacts) const {
  const auto good = [](const ForeignTable& table) { return table.broken.empty(); };
  if (tables.grains.empty() || !std::all_of(tables.grains.begin(), tables.grains.end(), good) ||
      !std::all_of(tables.contacts.begin(), tables.contacts.end(), good))
    return false;
  if (without_contacts && tables.contacts.empty()) return true;
  const auto of_file = [&](const std::string& file) {
    return std::any_of(tables.contacts.begin(), tables.contacts.end(),
                       [&](const ForeignTable& table) { return table.file == file; });
  };
  for (const auto& [a, b] : parts_)
    if (of_file(a) != of_file(b)) return false;
  return !tables.contacts.empty() &&
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
  if (tables.grains.empty())
    throw std::invalid_argument(fmt::format("no table of grains{} in {}{}", which, files, others));
  if (!tables.contacts.empty() && options.without_contacts) return;
  const auto steps_with = [&](bool grains) {
    std::vector<long long> out;
    for (const auto& [number, all] : steps_)
      if (!(grains ? all.grains : all.contacts).empty()) out.push_back(number);
    return out;
  };
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
  throw std::invalid_argument(
      fmt::format("no table of contacts{} in {}{}", which, files,
                  whole.empty() ? fmt::format("; grains are there of the steps {}, contacts of {}",
                                              list_of(steps_with(true)), list_of(steps_with(false)))
                                : others));
}

std::vector<std::string> StepList::take_warnings() { return std::exchange(warnings_, {}); }

}  // namespace grainfield::coupling
