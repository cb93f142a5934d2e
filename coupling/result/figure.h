// Declarations of the figures in summary.json, beside what computes them. docs/summary-keys.md, the
// page's table of figures and the columns of a sweep's table follow from them.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace grainfield::coupling {

struct SummaryKey {
  std::string pattern;  ///< '*' stands for one name without dots of its own meaning
  std::string unit;     ///< "-" for pure numbers, "text" for words
  std::string meaning;
  std::string heading = {};    ///< of its column in the table of a sweep; empty: it has none
  std::string error_key = {};  ///< of its standard error; empty: KEY.standard_error
};

/// What summary.json holds under a key.
using FigureValue = std::variant<double, std::int64_t, std::string>;

/// A figure with the function that computes it from `Facts`. Null: the simulation leaves it.
/// nullopt: these facts have none. `Value`: double of one realization, FigureValue of a whole run.
template <class Facts, class Value = double>
struct Figure {
  std::string key, unit, meaning;
  std::function<std::optional<Value>(const Facts&)> of = nullptr;
  std::string heading = {};
  std::string error_key = {};  ///< as of SummaryKey
};

/// A figure of a whole run.
template <class Facts>
using RunFigure = Figure<Facts, FigureValue>;

/// What a whole run has under KEY and KEY.standard_error; nullopt: it has no error.
struct ValueWithError {
  FigureValue value;
  std::optional<double> error = std::nullopt;
};
template <class Facts>
using ErrorFigure = Figure<Facts, ValueWithError>;

/// By summary key, a number for each realization that has one.
using FigureSamples = std::map<std::string, std::vector<double>>;

/// The declarations; `prefix` comes before every key.
template <class Facts, class Value>
std::vector<SummaryKey> declared(const std::vector<Figure<Facts, Value>>& rows,
                                 const std::string& prefix = "") {
  std::vector<SummaryKey> out;
  for (const auto& row : rows) {
    out.push_back({prefix + row.key, row.unit, row.meaning, row.heading, row.error_key});
  }
  return out;
}

/// Declarations of several lists, one list after the other.
inline std::vector<SummaryKey> joined(const std::vector<std::vector<SummaryKey>>& parts) {
  std::vector<SummaryKey> out;
  for (const auto& part : parts) out.insert(out.end(), part.begin(), part.end());
  return out;
}

/// Adds what the rows compute from one realization's facts.
template <class Facts>
void add_samples(const std::vector<Figure<Facts>>& rows, const Facts& facts, FigureSamples& out,
                 const std::string& prefix = "") {
  for (const Figure<Facts>& row : rows) {
    if (!row.of) continue;
    if (const auto value = row.of(facts)) out[prefix + row.key].push_back(*value);
  }
}

/// Sets what the rows compute from a run's facts.
template <class Facts>
void add_values(const std::vector<RunFigure<Facts>>& rows, const Facts& facts,
                std::map<std::string, FigureValue>& out, const std::string& prefix = "") {
  for (const RunFigure<Facts>& row : rows) {
    if (!row.of) continue;
    if (const auto value = row.of(facts)) out[prefix + row.key] = *value;
  }
}

template <class Facts>
void add_values(const std::vector<ErrorFigure<Facts>>& rows, const Facts& facts,
                std::map<std::string, FigureValue>& out, const std::string& prefix = "") {
  for (const ErrorFigure<Facts>& row : rows) {
    if (!row.of) continue;
    const auto found = row.of(facts);
    if (!found) continue;
    out[prefix + row.key] = found->value;
    if (found->error) out[prefix + row.key + ".standard_error"] = *found->error;
  }
}

}  // namespace grainfield::coupling
