#include "coupling/run/recorded.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <stdexcept>

#include "coupling/result/csv.h"
#include "coupling/run/realization_file.h"

namespace grainfield::coupling {

RecordedColumns recorded_columns(const dem::Snapshot& state, const std::string& table,
                                 std::span<const char* const> names, const std::string& file) {
  RecordedColumns out;
  if (const auto found = state.tables.find(table); found != state.tables.end()) {
    for (const dem::NumberColumn& column : found->second) out[column.name] = column.values;
  }
  for (const char* name : names) {
    const auto at = out.find(name);
    if (at == out.end()) {
      throw std::invalid_argument(fmt::format("{}: has no table {} with {}", file, table, name));
    }
    const std::size_t rows = at->second.size(), wanted = out.begin()->second.size();
    if (rows == 0 || rows != wanted) {
      throw std::invalid_argument(fmt::format("{}: {} of table {} has {} numbers, {} {}", file,
                                              name, table, rows, out.begin()->first, wanted));
    }
  }
  return out;
}

std::string recorded_csv(const RecordedColumns& columns, std::span<const char* const> names) {
  Csv out;
  out.row(names);
  for (std::size_t k = 0; k < columns.at(names.front()).size(); ++k) {
    for (const char* name : names) out.add(columns.at(name)[k]);
    out.end_row();
  }
  return out.text();
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
