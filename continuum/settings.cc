#include "continuum/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "dem/shared/number.h"

namespace grainfield::continuum {
namespace {

/// Letters by which a name is compared with others: the work grows with them, and beyond no name is
/// meant.
constexpr std::size_t kLongestMisspelt = 80;

/// Letters inserted, deleted or replaced, or neighbours swapped (optimal string alignment).
std::size_t edits(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] =
          std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before = last;
    last = row;
  }
  return last[b.size()];
}

double parse(const ModelInfo& info, const Parameter& parameter, const std::string& text) {
  if (text == "free")
    throw BadParameter(
        fmt::format("model {}: {} = free is for `grainfield fit` and for fit.models "
                    "of a case; here give a number: {}",
                    info.name, parameter.name, allowed(parameter)));
  const std::optional<double> value = parse_number(text);
  if (!value || !std::isfinite(*value))
    throw BadParameter(fmt::format("model {}: {} = '{}' is not a number; allowed: {}", info.name,
                                   parameter.name, text, allowed(parameter)));
  return *value;
}

/// The allowed range for a message about this text.
std::string missed(const Parameter& parameter, const std::string& text, double value) {
  if (std::fabs(value) > kUnbounded) {
    return fmt::format("{}, and no more than {} in size", allowed(parameter), kUnbounded);
  }
  const bool tiny =
      value >= 0 && value < parameter.least && parameter.least == kAboveZero &&
      text.substr(0, text.find_first_of("eEpP")).find_first_of("123456789") != std::string::npos;
  if (!tiny) return allowed(parameter);
  return fmt::format("at least {}{}", parameter.least,
                     parameter.unit == "-" ? "" : " " + parameter.unit);
}

}  // namespace

std::string nearest(const std::string& given, const std::vector<std::string>& names) {
  const std::string name = given.substr(0, kLongestMisspelt);
  const auto best = std::min_element(names.begin(), names.end(), [&](const auto& a, const auto& b) {
    return edits(name, a) < edits(name, b);
  });
  return best == names.end() ? std::string() : *best;
}

std::string misspelt(const std::string& name, const std::vector<std::string>& names) {
  if (name.size() > kLongestMisspelt) return "";
  const std::string best = nearest(name, names);
  return 3 * edits(name, best) <= name.size() ? best : std::string();
}

std::string allowed(const Parameter& parameter) {
  if (!parameter.choices.empty()) return fmt::format("{}", fmt::join(parameter.choices, ", "));
  if (is_text(parameter)) return "any text";
  const std::string unit = parameter.unit == "-" ? "" : " " + parameter.unit;
  const bool above_zero = parameter.least == kAboveZero;
  const bool bounded_below = parameter.least > -kUnbounded;
  const bool bounded_above = parameter.most < kUnbounded;
  if (above_zero && bounded_above)
    return fmt::format("above 0 and at most {}{}", parameter.most, unit);
  if (above_zero) return "above 0" + unit;
  if (bounded_below && bounded_above)
    return fmt::format("{}{} to {}{}", parameter.whole ? "whole numbers " : "", parameter.least,
                       parameter.most, unit);
  if (bounded_below) return fmt::format("at least {}{}", parameter.least, unit);
  if (bounded_above) return fmt::format("at most {}{}", parameter.most, unit);
  return "any number" + unit;
}

Parameter number(std::string name, std::string unit, std::string meaning, std::string source,
                 double value, double least, double most) {
  Parameter parameter;
  parameter.name = std::move(name);
  parameter.unit = std::move(unit);
  parameter.meaning = std::move(meaning);
  parameter.source = std::move(source);
  parameter.value = value;
  parameter.least = least;
  parameter.most = most;
  return parameter;
}

Parameter optional_number(std::string name, std::string unit, std::string meaning,
                          std::string source, double least, double most) {
  return number(std::move(name), std::move(unit), std::move(meaning), std::move(source),
                std::numeric_limits<double>::quiet_NaN(), least, most);
}

Parameter may_be_free(Parameter parameter, double least, double most, double floor) {
  parameter.free = SearchRange{least, most, floor};
  return parameter;
}

Parameter only_with(Parameter parameter, std::string other, std::vector<std::string> words) {
  parameter.only_with = Words{std::move(other), std::move(words)};
  return parameter;
}

std::vector<Parameter> joined(std::initializer_list<std::vector<Parameter>> parts) {
  std::vector<Parameter> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Parameter whole_number(std::string name, std::string meaning, std::string source, int value,
                       int least, int most) {
  Parameter parameter =
      number(std::move(name), "-", std::move(meaning), std::move(source), value, least, most);
  parameter.whole = true;
  return parameter;
}

Parameter choice(std::string name, std::string meaning, std::string source,
                 std::vector<std::string> choices) {
  return {std::move(name), "-", std::move(meaning), std::move(source), 0, 0, 0, std::move(choices)};
}

Parameter text(std::string name, std::string meaning, std::string source) {
  return {std::move(name), "text", std::move(meaning), std::move(source), 0, 0, 0, {}};
}

bool is_text(const Parameter& parameter) { return parameter.unit == "text"; }

Settings complete(const ModelInfo& info, const Settings& settings) {
  std::vector<std::string> names;
  for (const auto& parameter : info.parameters) names.push_back(parameter.name);
  for (const auto& [name, value] : settings) {
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw BadParameter(fmt::format("model {}: no parameter '{}'; did you mean '{}'? allowed: {}",
                                     info.name, name, nearest(name, names),
                                     fmt::join(names, ", ")));
  }
  Settings full;
  for (const auto& parameter : info.parameters) {
    const auto found = settings.find(parameter.name);
    if (!parameter.choices.empty()) {
      const auto& choices = parameter.choices;
      const std::string word = found == settings.end() ? choices.front() : found->second;
      if (std::find(choices.begin(), choices.end(), word) == choices.end())
        throw BadParameter(fmt::format("model {}: {} = '{}' is not one of {}; did you mean '{}'?",
                                       info.name, parameter.name, word, fmt::join(choices, ", "),
                                       nearest(word, choices)));
      full[parameter.name] = word;
    } else if (is_text(parameter)) {
      full[parameter.name] = found == settings.end() ? "" : found->second;
    } else if (found == settings.end()) {
      full[parameter.name] = fmt::format("{}", parameter.value);
    } else {
      const double value = parse(info, parameter, found->second);
      if (value < parameter.least || value > parameter.most ||
          (parameter.whole && value != std::round(value)))
        throw BadParameter(fmt::format("model {}: {} = {} is out of range; allowed: {}", info.name,
                                       parameter.name, found->second,
                                       missed(parameter, found->second, value)));
      full[parameter.name] = found->second;
    }
  }
  return full;
}

double number_of(const Settings& settings, const std::string& name) {
  return parse_number(settings.at(name)).value_or(0);
}

double nonzero_or(const Settings& settings, const std::string& name, double standard) {
  const double value = number_of(settings, name);
  return value == 0 ? standard : value;
}

}  // namespace grainfield::continuum
