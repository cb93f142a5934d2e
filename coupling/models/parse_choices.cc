#include "coupling/models/parse_choices.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "coupling/models/fit_names.h"

namespace grainfield::coupling {
namespace {

constexpr const char* kLabelLetters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";

}  // namespace

std::vector<std::string> split_choices(const std::string& text) {
  std::vector<std::string> out;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    const std::string part = text.substr(from, to - from);
    const std::size_t equals = part.find('='), colon = part.find(':');
    const bool setting = equals != std::string::npos && equals < colon;
    if (!out.empty() && setting && out.back().find(':') != std::string::npos) {
      out.back() += "," + part;
    } else {
      out.push_back(part);
    }
    from = to + 1;
  }
  return out;
}

// "layer:nu=0.3,base=rough" or "rough=layer:nu=0.3": label, name and settings.
ModelChoice parse_choice(const std::string& text, const std::string& where) {
  const std::size_t colon = text.find(':');
  const std::string head = text.substr(0, colon);
  const std::size_t equals = head.find('=');
  ModelChoice out;
  out.name = equals == std::string::npos ? head : head.substr(equals + 1);
  out.label = equals == std::string::npos ? head : head.substr(0, equals);
  if (out.label.empty() || out.label.find_first_not_of(kLabelLetters) != std::string::npos) {
    throw std::invalid_argument(fmt::format(
        "{}: found the label '{}', allowed: letters, digits, _ and -", where, out.label));
  }
  if (find_fit_name(out.name) == nullptr) continuum::find_model(out.name);
  if (colon == std::string::npos) return in_registry(out);
  std::vector<std::string> items;
  std::string rest = text.substr(colon + 1);
  for (std::size_t at = 0; at <= rest.size();) {
    const std::size_t end = std::min(rest.find(',', at), rest.size());
    items.push_back(rest.substr(at, end - at));
    at = end + 1;
  }
  out.settings = parse_settings(items, where + " " + out.name);
  return in_registry(out);
}

std::string label_beside(std::set<std::string>& taken, const std::string& label) {
  std::string out = label;
  for (int n = 2; !taken.insert(out).second; ++n) out = fmt::format("{}_{}", label, n);
  return out;
}

continuum::Settings parse_settings(const std::vector<std::string>& texts,
                                   const std::string& where) {
  continuum::Settings out;
  for (const auto& text : texts) {
    const std::size_t at = text.find('=');
    if (at == 0 || at == std::string::npos || at + 1 == text.size()) {
      throw std::invalid_argument(
          fmt::format("{}: found \"{}\", expected parameter=value", where, text));
    }
    const auto [first, fresh] = out.emplace(text.substr(0, at), text.substr(at + 1));
    if (!fresh)
      throw std::invalid_argument(fmt::format("{}: {} is given twice, {} and {}; leave one out",
                                              where, first->first, first->second,
                                              text.substr(at + 1)));
  }
  return out;
}

std::vector<ModelChoice> parse_choices(const std::vector<std::string>& texts) {
  std::vector<ModelChoice> out;
  std::set<std::string> seen;
  for (const auto& text : texts) {
    for (const std::string& one : split_choices(text)) {
      ModelChoice choice = parse_choice(one);
      choice.label = label_beside(seen, choice.label);
      out.push_back(std::move(choice));
    }
  }
  return out;
}

}  // namespace grainfield::coupling
