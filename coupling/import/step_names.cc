#include "coupling/import/step_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

struct NameParts {
  std::string words;  // with "#" for each number
  std::vector<std::string> numbers;
};

NameParts parts_of(const std::string& text) {
  NameParts out;
  bool digits = false;
  for (const char ch : text) {
    const bool digit = std::isdigit(static_cast<unsigned char>(ch)) != 0;
    if (digit && !digits) {
      out.words += '#';
      out.numbers.emplace_back();
    }
    if (digit)
      out.numbers.back() += ch;
    else
      out.words += ch;
    digits = digit;
  }
  return out;
}

std::optional<long long> number_of(const std::string& digits) {
  return digits.size() <= 18 ? parse_integer(digits) : std::nullopt;
}

// Files whose names differ in their numbers only.
struct NameKind {
  std::vector<std::size_t> files;
  std::set<std::size_t> differ;      // places of numbers
  std::optional<std::size_t> place;  // of the step
  bool pieces = false;               // of one step
  bool grains = false;
};

class StepsOfNames {
 public:
  explicit StepsOfNames(const std::vector<NamedFile>& files) : files_(files) {
    for (std::size_t k = 0; k < files.size(); ++k) {
      names_.push_back(parts_of(files[k].name.substr(files[k].name.rfind('/') + 1)));
      NameKind& kind = kinds_[names_[k].words];
      for (std::size_t n = 0; !kind.files.empty() && n < names_[k].numbers.size(); ++n)
        if (names_[k].numbers[n] != names_[kind.files.front()].numbers[n]) kind.differ.insert(n);
      kind.files.push_back(k);
      kind.grains = kind.grains || files[k].grains;
    }
  }

  NamedSteps settle() {
    // Grains first: their ids tell pieces from steps.
    for (const bool grains : {true, false})
      for (auto& [words, kind] : kinds_)
        if (kind.grains == grains) settle_kind(kind);
    follow_others();
    warn_of_two_steps();
    for (const NameParts& name : names_) out_.steps.push_back(step_of(name));
    return std::move(out_);
  }

 private:
  // One file of grains and one of contacts, whose only numbers differ.
  void warn_of_two_steps() {
    if (files_.size() != 2 || files_[0].grains == files_[1].grains) return;
    const auto &first = names_[0].numbers, &second = names_[1].numbers;
    if (first.size() != 1 || second.size() != 1 || number_of(first[0]) == number_of(second[0]))
      return;
    out_.warnings.push_back(fmt::format(
        "the names of {} and {} have different numbers: are grains and contacts of one step?",
        files_[0].name, files_[1].name));
  }

  // A kind with as many numbers, the places of whose grains are known.
  const NameKind* leader_of(const NameKind& kind) const {
    const std::size_t count = names_[kind.files.front()].numbers.size();
    for (const auto& [words, other] : kinds_)
      if (&other != &kind && other.grains && (other.place || other.pieces) &&
          names_[other.files.front()].numbers.size() == count)
        return &other;
    return nullptr;
  }

  const RowKeys& keys_of(std::size_t file) {
    const auto [at, fresh] = keys_.try_emplace(file);
    if (fresh && files_[file].keys) at->second = files_[file].keys();
    return at->second;
  }

  // Whether no two of the files have rows in common.
  bool all_apart(const std::vector<std::size_t>& files) {
    for (std::size_t a = 0; a < files.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        if (!are_apart(keys_of(files[a]), keys_of(files[b]))) return false;
    return true;
  }

  // Whether the number at `place` is the step: files of one step are pieces, those of two are not.
  bool is_step(const NameKind& kind, std::size_t place) {
    std::map<std::string, std::vector<std::size_t>> groups;
    for (const std::size_t k : kind.files) groups[names_[k].numbers[place]].push_back(k);
    return std::all_of(groups.begin(), groups.end(),
                       [&](const auto& group) { return all_apart(group.second); });
  }

  void settle_kind(NameKind& kind) {
    if (kind.differ.empty()) return;
    const std::string &first = files_[kind.files.front()].name,
                      &last = files_[kind.files.back()].name;
    if (const NameKind* leader = kind.grains ? nullptr : leader_of(kind)) {
      kind.place = leader->place;
      kind.pieces = leader->pieces;
      return;
    }
    if (kind.grains && all_apart(kind.files)) {
      kind.pieces = true;
      out_.notes.push_back(fmt::format(
          "{} to {}: no two of the {} files have a grain in common: they are pieces of one step",
          first, last, kind.files.size()));
      return;
    }
    std::vector<std::size_t> places(kind.differ.begin(), kind.differ.end());
    if (places.size() > 1)
      std::erase_if(places, [&](std::size_t place) { return !is_step(kind, place); });
    if (places.size() != 1)
      throw std::invalid_argument(
          fmt::format("{} and {} differ in two numbers, each of which may be the step: give "
                      "files whose names differ in one",
                      first, last));
    kind.place = places.front();
    if (!kind.grains || !keys_of(kind.files.front()).empty()) return;
    const NamedFile &one = files_[kind.files.front()], &other = files_[kind.files.back()];
    if (one.places && other.places && are_apart(one.places(), other.places()))
      out_.warnings.push_back(fmt::format(
          "{} to {}: the numbers in their names are taken as steps, but their grains lie apart and "
          "have no ids: pieces of one step belong into one file (ParaView: Append Datasets)",
          first, last));
    else
      out_.notes.push_back(
          fmt::format("{} to {}: the numbers in their names are taken as steps", first, last));
  }

  // A name without others of its words goes by those of as many numbers.
  void follow_others() {
    for (auto& [words, kind] : kinds_) {
      if (kind.place || kind.pieces) continue;
      for (const auto& [others, other] : kinds_)
        if ((other.place || other.pieces) && names_[kind.files.front()].numbers.size() ==
                                                 names_[other.files.front()].numbers.size()) {
          kind.place = other.place;
          kind.pieces = other.pieces;
        }
    }
  }

  std::optional<long long> step_of(const NameParts& name) const {
    const NameKind& kind = kinds_.at(name.words);
    if (name.numbers.empty() || kind.pieces) return std::nullopt;
    return number_of(name.numbers[kind.place.value_or(name.numbers.size() - 1)]);
  }

  const std::vector<NamedFile>& files_;
  std::vector<NameParts> names_;
  std::map<std::string, NameKind> kinds_;
  std::map<std::size_t, RowKeys> keys_;  // that were read
  NamedSteps out_;
};

}  // namespace

NamedSteps steps_of_names(const std::vector<NamedFile>& files) {
  return StepsOfNames(files).settle();
}

std::map<std::string, std::string> series_of_files(
    const std::map<std::string, std::set<long long>>& steps) {
  std::map<std::string, std::string> out;
  struct Member {
    std::string file;
    NameParts name;
    long long step = 0;
  };
  std::map<std::string, std::vector<Member>> kinds;
  for (const auto& [file, own] : steps) {
    out[file] = file;
    if (own.size() != 1) continue;
    NameParts name = parts_of(file);
    kinds[name.words].push_back({file, std::move(name), *own.begin()});
  }
  for (const auto& [words, members] : kinds) {
    const std::size_t count = members.front().name.numbers.size();
    std::vector<bool> of_step(count);
    for (std::size_t n = 0; n < count; ++n) {
      std::map<std::string, long long> step_of;
      std::map<long long, std::string> number_of_step;
      bool one_to_one = true, equal = true;
      for (const Member& member : members) {
        const std::string& number = member.name.numbers[n];
        one_to_one = one_to_one &&
                     step_of.try_emplace(number, member.step).first->second == member.step &&
                     number_of_step.try_emplace(member.step, number).first->second == number;
        equal = equal && number_of(number) == member.step;
      }
      of_step[n] = equal || (one_to_one && step_of.size() > 1);
    }
    for (const Member& member : members) {
      std::string series;
      std::size_t n = 0;
      for (const char ch : words) {
        const bool number = ch == '#' && n < count;
        if (!number || of_step[n])
          series += ch;
        else
          series += member.name.numbers[n];
        n += number ? 1 : 0;
      }
      out[member.file] = series;
    }
  }
  return out;
}

}  // namespace grainfield::coupling
