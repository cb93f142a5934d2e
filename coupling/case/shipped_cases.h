// The case files that come with the program.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace grainfield::coupling {

/// Folder of the shipped cases: GRAINFIELD_CASES, or share/grainfield/cases beside an installed
/// program, or that of the sources the program was built from.
std::filesystem::path cases_folder();

/// The shipped case files, sorted by name. Throws std::invalid_argument naming the folder when it
/// holds none.
std::vector<std::filesystem::path> shipped_cases();

/// The shipped packings and tables, each sorted by name: the HDF5 and CSV files of `samples` below
/// the folder of the cases.
/// Throws std::invalid_argument naming the folder when it holds none.
std::vector<std::filesystem::path> shipped_samples();

/// The case file that `name` means: the file of that name or of that name with ".toml", else the
/// shipped case so called (with or without ".toml"). Throws std::invalid_argument for neither, with
/// the nearest shipped name.
std::string find_case(const std::string& name);

}  // namespace grainfield::coupling
