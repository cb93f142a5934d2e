#include "coupling/run/recorded.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <sstream>
#include <stdexcept>

#include "coupling/run/realization_file.h"
#include "dem/snapshot/number.h"

namespace grainfield::coupling {

RecordedColumns recorded_columns(const dem::Snapshot& state, const std::string& prefix,
                                 std::span<const char* const> names, const std::string& file) {
  RecordedColumns out;
  for (const char* name : names) {
    const std::string key = prefix + ":" + name;
    const auto at = state.attributes.find(key);
    if (at == state.attributes.end()) {
      throw std::invalid_argument(fmt::format("{}: has no attribute {}", file, key));
    }
    std::vector<double>& column = out[name];
    std::istringstream words(at->second);
    for (std::string word; words >> word;) {
      const auto number = dem::parse_number(word);
      if (!number) {
        throw std::invalid_argument(
            fmt::format("{}: {} holds \"{}\"; it must hold numbers", file, key, word));
      }
      column.push_back(*number);
    }
    const std::size_t rows = out.at(names.front()).size();
    if (column.empty() || column.size() != rows) {
      throw std::invalid_argument(fmt::format("{}: {} has {} numbers, {}:{} {}", file, key,
                                              column.size(), prefix, names.front(), rows));
    }
  }
  return out;
}

std::string recorded_csv(const RecordedColumns& columns, std::span<const char* const> names) {
  std::string out = fmt::format("{}\n", fmt::join(names, ","));
  for (std::size_t k = 0; k < columns.at(names.front()).size(); ++k) {
    std::vector<std::string> row;
    for (const char* name : names) row.push_back(fmt::format("{:.9g}", columns.at(name)[k]));
    out += fmt::format("{}\n", fmt::join(row, ","));
  }
  return out;
}

Chart recorded_chart(const RecordedColumns& columns, const std::string& title, const std::string& y,
                     const std::string& caption,
                     const std::vector<std::pair<const char*, const char*>>& lines) {
  const auto vector = [&](const char* name) -> Eigen::VectorXd {
    const std::vector<double>& all = columns.at(name);
    return Eigen::VectorXd::Map(all.data(), static_cast<Eigen::Index>(all.size()));
  };
  Chart out{title, "time / sqrt(d/g)", y, caption, {}, false};
  for (const auto& [name, label] : lines) {
    out.frames.push_back({label, {{"grains", vector("time"), vector(name), {}, true}}});
  }
  return out;
}

FigureSamples simulated_figures(const std::vector<std::string>& files) {
  FigureSamples out;
  for (const std::string& file : files) {
    for (const auto& [key, figure] : read_realization(file).figures) out[key].push_back(figure);
  }
  return out;
}

}  // namespace grainfield::coupling
