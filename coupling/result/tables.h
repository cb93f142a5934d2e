// Tables that people and programs read: profiles.csv/.md/.tex and summary.json.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "coupling/compare/compare.h"
#include "coupling/result/text_table.h"

namespace grainfield::coupling {

/// One row per profile point: profile, depth, x, simulation mean, standard error, and of each model
/// its value, difference (simulation - model) and difference / standard error; header names carry
/// units; comment lines (#) before give the scale and the number of realizations. Profiles `beside`
/// follow, without models (nan).
std::string profiles_csv(const Comparison& comparison);
/// The same rows for reading, a table for each profile, normalised by the scale: position, value ±
/// standard error to two digits of it, and a column for each field with its value and, in brackets,
/// its distance from the value in errors. At most `rows` rows; the kModelsShown fields nearest to
/// the simulation and the nearest of another family, nearest first (in the order of the models
/// where there is no ranking).
std::vector<Table> profile_tables(const Comparison& comparison, int rows = 25);
/// The scale, what the cells are, and which models are left out: one paragraph.
std::string profiles_note(const Comparison& comparison);
std::string profiles_markdown(const Comparison& comparison, int rows = 25);
std::string profiles_latex(const Comparison& comparison, int rows = 25);
inline constexpr std::size_t kModelsShown = 3;
/// Writes folder/profiles.csv, .md and .tex, each complete or not at all.
void write_profiles(const std::string& folder, const Comparison& comparison);

/// Flat results of a run. What is not finite is written as null: JSON has no such number.
using Summary = std::map<std::string, std::variant<double, std::int64_t, std::string>>;
void write_summary(const std::string& file, const Summary& summary);
/// Throws std::invalid_argument naming the file: missing, not JSON, not flat. null comes back as
/// nan, and so do the words "nan", "inf" and "-inf" of older files as their numbers.
Summary read_summary(const std::string& file);

}  // namespace grainfield::coupling
