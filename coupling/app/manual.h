// Pages of the manual and of docs/, and shell completion, written from the commands' own
// declarations.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace grainfield::coupling {

/// The commands of the program that --help lists, in that order.
std::vector<const CLI::App*> shown_commands(const CLI::App& app);

/// The options of a command (or of the program) with a dash, and those without, as declared.
std::vector<const CLI::Option*> dashed_options(const CLI::App& command);
std::vector<const CLI::Option*> positional_options(const CLI::App& command);

/// True for an option that stands alone, such as --quick.
bool is_flag(const CLI::Option& option);

/// grainfield(1) in man's markup: what the commands are, exit status, environment.
std::string manual_of_program(const CLI::App& app);

/// grainfield-NAME(1): synopsis, arguments and options of one command.
std::string manual_of_command(const CLI::App& command);

/// A file for bash: completes commands, their options, the values that an option's help lists,
/// names of shipped cases, of models and of studies, and else names of files.
std::string bash_completion(const CLI::App& app);

/// docs/commands.md: every command that --help lists, with its arguments and options.
std::string commands_markdown(const CLI::App& app);

/// docs/columns.md: the columns of snapshots, and those that import reads.
std::string columns_markdown();

}  // namespace grainfield::coupling
