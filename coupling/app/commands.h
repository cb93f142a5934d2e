// The commands of the program. Each adds itself to the parser, with what it does when chosen.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace grainfield::coupling {

struct Case;

/// What the chosen command does; returns the exit code. Throws std::invalid_argument (exit 2),
/// the modules' ComputationFailed (exit 3) or anything else (exit 1).
using Action = std::function<int()>;

void add_run(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_keys(CLI::App& app, Action& action);
void add_cases(CLI::App& app, Action& action);
void add_model(CLI::App& app, Action& action);
void add_average(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_fit(CLI::App& app, Action& action);
void add_power(CLI::App& app, Action& action);
void add_import(CLI::App& app, Action& action);
void add_import_field(CLI::App& app, Action& action);
void add_export(CLI::App& app, Action& action);
void add_strain(CLI::App& app, Action& action);
void add_structure(CLI::App& app, Action& action);
void add_info(CLI::App& app, Action& action);
void add_samples(CLI::App& app, Action& action);
void add_manual(CLI::App& app, Action& action);

/// The option -o,--output of a command; an empty name is refused.
CLI::Option* add_output(CLI::App& command, std::string& output, const std::string& meaning);

/// One line on standard error for every key of the case that has no effect.
void warn_of_keys_without_effect(const Case& value);

}  // namespace grainfield::coupling
