#include "coupling/import/repeated_warnings.h"

#include <fmt/format.h>

#include <cctype>

namespace grainfield::coupling {
namespace {

// "ratio 9.86, above 1e-3" -> "ratio #, above #"
std::string without_numbers(const std::string& text) {
  std::string out;
  bool number = false;
  for (const char ch : text) {
    const bool digit = std::isdigit(static_cast<unsigned char>(ch)) != 0;
    const bool within = number && std::string("0123456789.eE+-").find(ch) != std::string::npos;
    if (digit && !number) out += '#';
    number = digit || within;
    if (!number) out += ch;
  }
  return out;
}

}  // namespace

bool RepeatedWarnings::is_first(const std::string& snapshot, const std::string& text) {
  const auto [at, fresh] = places_.try_emplace(without_numbers(text), kinds_.size());
  if (fresh) {
    kinds_.emplace_back();
    return true;
  }
  Kind& kind = kinds_[at->second];
  ++kind.others;
  kind.last = snapshot;
  kind.text = text;
  return false;
}

std::vector<std::string> RepeatedWarnings::lines() const {
  std::vector<std::string> out;
  for (const Kind& kind : kinds_) {
    if (kind.others == 0) continue;
    out.push_back(kind.others == 1
                      ? fmt::format("{}: {}", kind.last, kind.text)
                      : fmt::format("{} more snapshots have this warning, the last is {}: {}",
                                    kind.others, kind.last, kind.text));
  }
  return out;
}

}  // namespace grainfield::coupling
