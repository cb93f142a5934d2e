#include "coupling/import/step_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <stdexcept>

#include "dem/snapshot/number.h"

namespace grainfield::coupling {
namespace {

struct Name {
  std::string words;  // with "#" for each number
  std::vector<std::string> numbers;
};

Name parts_of(const std::string& file) {
  Name out;
  bool digits = false;
  for (const char ch : file.substr(file.rfind('/') + 1)) {
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

}  // namespace

std::vector<std::optional<long long>> steps_of_names(const std::vector<std::string>& files) {
  std::vector<Name> names;
  for (const std::string& file : files) names.push_back(parts_of(file));
  // Place of the number that differs among names of the same words.
  struct Kind {
    std::size_t first = 0;
    std::optional<std::size_t> place;
  };
  std::map<std::string, Kind> kinds;
  for (std::size_t k = 0; k < names.size(); ++k) {
    Kind& kind = kinds.try_emplace(names[k].words, Kind{k, std::nullopt}).first->second;
    for (std::size_t n = 0; n < names[k].numbers.size(); ++n) {
      if (names[k].numbers[n] == names[kind.first].numbers[n] || kind.place == n) continue;
      if (kind.place)
        throw std::invalid_argument(
            fmt::format("{} and {} differ in two numbers, each of which may be the step: give "
                        "files whose names differ in one",
                        files[kind.first], files[k]));
      kind.place = n;
    }
  }
  // A name without others of its words goes by those of as many numbers.
  for (auto& [words, kind] : kinds)
    for (const auto& [others, other] : kinds)
      if (!kind.place && other.place &&
          names[kind.first].numbers.size() == names[other.first].numbers.size())
        kind.place = other.place;
  std::vector<std::optional<long long>> out;
  for (const Name& name : names) {
    std::optional<long long> step;
    if (!name.numbers.empty()) {
      const std::string& number =
          name.numbers[kinds.at(name.words).place.value_or(name.numbers.size() - 1)];
      if (number.size() <= 18) step = dem::parse_integer(number);
    }
    out.push_back(step);
  }
  return out;
}

}  // namespace grainfield::coupling
