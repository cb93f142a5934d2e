// What a simulation recorded over time, in a table of a state.
#pragma once
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "coupling/report/picture.h"
#include "coupling/result/figure.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Equally long columns by name.
using RecordedColumns = std::map<std::string, std::vector<double>>;
/// The state's table of that name. Throws std::invalid_argument naming the file and the column of
/// these that is missing, empty or as long as no other.
RecordedColumns recorded_columns(const dem::Snapshot& state, const std::string& table,
                                 std::span<const char* const> names, const std::string& file);

/// history.csv: a row a record, the columns in this order.
std::string recorded_csv(const RecordedColumns& columns, std::span<const char* const> names);
/// A frame for each of the columns {name, label} over "time", in sqrt(d/g).
Chart recorded_chart(const RecordedColumns& columns, const std::string& title, const std::string& y,
                     const std::string& caption,
                     const std::vector<std::pair<const char*, const char*>>& lines);

/// The figures that the simulations themselves left, by key, of all realizations.
FigureSamples simulated_figures(const std::vector<std::string>& files);

}  // namespace grainfield::coupling
